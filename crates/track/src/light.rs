//! Light that changes for the whole frame: a lamp that flickers, a sun behind a cloud, a dye that bleaches.
//!
//! Most of a frame shows the same as the one before, a little moved. So the gain is the median of the ratios of both,
//! place by place in the coarsest of the halved pictures. An object that fades by itself does not move that median.

use field::Grid;
use fit::Image;
use flow::Pyramid;
use ndarray::Array2;

/// How often a frame is halved for flow.
const SIZES: usize = 5;

/// Levels below this say little of a ratio.
const DARK: f32 = 4.0;

/// Fewer places say nothing.
const LEAST: usize = 24;

/// The median counts if it is more than this, and so many of its own standard errors.
const SMALL: f64 = 0.004;
const ERRORS: f64 = 4.0;

/// Ratios that scatter more than this say nothing: another scene.
const SCATTER: f64 = 0.25;

/// The halved picture that is compared: places of 16 pixels, where there are so many.
const LEVEL: usize = 4;

/// A frame in the light of the one before, and its halved pictures.
pub(crate) fn levelled(before: &Pyramid, frame: &Image) -> (Image, Pyramid) {
    let own = pyramid(frame);
    let gain = gain(before, &own);
    if (gain - 1.0).abs() < f64::EPSILON {
        return (frame.clone(), own);
    }
    let pixels = frame.pixels();
    let image = if pixels.is_color() {
        let (width, height) = pixels.size();
        let channel = |k: usize| {
            let level = |(y, x)| pixels.color(x, y)[k] / gain;
            Grid::from_shape_fn((height, width), level)
        };
        Image::color([0, 1, 2].map(channel)).unwrap_or_else(|_| frame.clone())
    } else {
        Image::grey(pixels.levels().mapv(|level| level / gain))
    };
    let image = match pixels.valid() {
        Some(valid) => image
            .with_mask(valid.clone())
            .unwrap_or_else(|_| frame.clone()),
        None => image,
    };
    let own = pyramid(&image);
    (image, own)
}

/// A frame as flow sees it.
#[allow(
    clippy::cast_possible_truncation,
    reason = "levels in f32 are enough for flow"
)]
pub(crate) fn pyramid(frame: &Image) -> Pyramid {
    let pixels = frame.pixels();
    let (width, height) = pixels.size();
    let levels = Array2::from_shape_fn((height, width), |(y, x)| {
        let level = pixels.level(x, y) as f32;
        if level.is_finite() { level } else { 0.0 }
    });
    Pyramid::of(levels, SIZES)
}

/// How many times brighter a frame is than the one before; 1 where that cannot be told from no change.
fn gain(before: &Pyramid, now: &Pyramid) -> f64 {
    let level = LEVEL
        .min(before.levels().len() - 1)
        .min(now.levels().len() - 1);
    let pairs = before.levels()[level].iter().zip(&now.levels()[level]);
    let mut ratios: Vec<f64> = pairs
        .filter(|(a, b)| **a > DARK && **b > DARK)
        .map(|(a, b)| f64::from(b / a).ln())
        .collect();
    if ratios.len() < LEAST {
        return 1.0;
    }
    let middle = median(&mut ratios);
    let mut off: Vec<f64> = ratios.iter().map(|ratio| (ratio - middle).abs()).collect();
    let scatter = 1.4826 * median(&mut off);
    let error = 1.2533 * scatter / (ratios.len() as f64).sqrt();
    if scatter < SCATTER && middle.abs() > SMALL.max(ERRORS * error) {
        middle.exp()
    } else {
        1.0
    }
}

fn median(values: &mut [f64]) -> f64 {
    let at = values.len() / 2;
    *values.select_nth_unstable_by(at, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(gain: f32, object: f32) -> Pyramid {
        let level = |(y, x): (usize, usize)| {
            let inside = (x as f32 - 90.0).hypot(y as f32 - 90.0) < 30.0;
            gain * if inside {
                object
            } else {
                60.0 + (x % 7) as f32
            }
        };
        Pyramid::of(Array2::from_shape_fn((192, 192), level), 5)
    }

    #[test]
    fn light_that_changes_for_all_is_seen_and_an_object_that_fades_is_not() {
        let first = drawn(1.0, 180.0);
        for want in [0.8, 0.97, 1.2] {
            let got = gain(&first, &drawn(want, 180.0));
            assert!((got - f64::from(want)).abs() < 0.01, "{got} for {want}");
        }
        assert!((gain(&first, &drawn(1.0, 150.0)) - 1.0).abs() < 1e-12);
        assert!((gain(&first, &first) - 1.0).abs() < 1e-12);
    }
}
