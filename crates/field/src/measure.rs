//! Noise, contrast and blur of a picture from the picture itself, so that forces have units a person can set.
//!
//! Not here yet: noise that depends on the brightness, and noise of neighbours that hang together (after a
//! demosaicing or a JPEG), which comes out too small.

use crate::canny::{Slopes, hang_together};
use crate::error::FieldError;
use crate::grid::{Grid, admit};
use std::f64::consts::{PI, TAU};

/// The third quartile of a normal distribution: half of all are nearer to the mean.
const QUARTILE: f64 = 0.674_489_750_196_081_7;

/// What a picture says about itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImageScale {
    /// Standard deviation of the noise, grey levels: [`noise_sigma`].
    pub noise: f64,
    /// Height of the strong steps, grey levels; 0 if there are none.
    pub contrast: f64,
    /// Blur of the strong steps: σ of their Gaussian in pixels, with the pixel's own share of 1/12 px²; 0 if there are none.
    pub blur: f64,
    /// At how many pixels these were measured.
    pub edge_pixels: usize,
}

impl ImageScale {
    /// Contrast over noise; infinite without noise, 0 without steps.
    #[must_use]
    pub fn contrast_to_noise(&self) -> f64 {
        if self.contrast > 0.0 {
            self.contrast / self.noise
        } else {
            0.0
        }
    }
}

/// Standard deviation of white noise, from what is left when the picture is taken away.
///
/// ```text
///     ⎡ 1 −2  1⎤
/// r = ⎢−2  4 −2⎥ ∗ I        σ = median |r| / (6 · 0.67449)
///     ⎣ 1 −2  1⎦
/// ```
///
/// The mask is blind to planes and to edges along either axis, 6 is the root of its squared sum, and the median is not moved by the edges
/// that are left. Where all pixels are multiples of one step (whole numbers, say), the median is taken as if each r were spread evenly over that
/// step, and the variance of rounding, step²/12, is taken off: so noise of half a step is still found to 5 %. Less is
/// lost in the rounding: a third of a step shows as a fifth, a quarter not at all.
///
/// For white normal noise the estimate is unbiased, and good to about 1.6 / √pixels of itself. Texture counts as noise;
/// clipped pixels count as quiet. One row or column: by the mask [1 −2 1]. Fewer than three pixels each way: 0.
/// O(pixels · log pixels).
///
/// \[immerkaer96\], with the median of \[donoho94\]
///
/// # Errors
/// An image without pixels, or with one that is not finite or too large.
pub fn noise_sigma(image: &Grid) -> Result<f64, FieldError> {
    let image = admit(image, 1.0)?;
    let mut residual = image.clone();
    let mut gain = 1.0;
    for _ in 0..2 {
        if residual.nrows() > 2 {
            residual = second_difference(&residual);
            gain *= 6.0;
        }
        residual = residual.t().to_owned();
    }
    if gain <= 1.0 {
        return Ok(0.0);
    }
    let step = step_of(&image);
    let mut sizes: Vec<f64> = residual.iter().map(|r| r.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let median = spread_median(&sizes, step) / QUARTILE;
    // the residual is spread over a step of its own, and each pixel was rounded
    let variance = (median * median - step * step / 12.0) / gain - step * step / 12.0;
    Ok(variance.max(0.0).sqrt())
}

/// `I(y − 1) − 2 I(y) + I(y + 1)`, without the first and the last row.
fn second_difference(image: &Grid) -> Grid {
    Grid::from_shape_fn((image.nrows() - 2, image.ncols()), |(y, x)| {
        image[[y, x]] - 2.0 * image[[y + 1, x]] + image[[y + 2, x]]
    })
}

/// The step all grey levels are multiples of, counted from the smallest; 0 if there is none or only one level.
fn step_of(image: &Grid) -> f64 {
    let mut levels: Vec<f64> = image.iter().copied().collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    let (Some(&low), Some(&high)) = (levels.first(), levels.last()) else {
        return 0.0;
    };
    let gaps = levels.windows(2).map(|pair| pair[1] - pair[0]);
    let step = gaps.fold(f64::INFINITY, f64::min);
    // more levels than 16 bits, or values between them: not rounded
    let whole = |v: &f64| {
        let n = (v - low) / step;
        (n - n.round()).abs() < 1e-6
    };
    let rounded = step.is_finite() && (high - low) / step < 65_536.5 && levels.iter().all(whole);
    if rounded { step } else { 0.0 }
}

/// The median of sorted sizes, each of which stands for an even spread over `step` about it (and about its negative).
fn spread_median(sizes: &[f64], step: f64) -> f64 {
    let half = sizes.len() as f64 / 2.0;
    let middle = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
    if step <= 0.0 {
        return middle;
    }
    // how many are smaller, and how many in the same bin; that of 0 has its other half on the other side
    let near = |v: f64| (v - middle).abs() < 0.25 * step;
    let below = sizes
        .iter()
        .take_while(|v| **v < middle && !near(**v))
        .count() as f64;
    let here = sizes.iter().filter(|v| near(**v)).count() as f64;
    let (from, width) = if middle < 0.25 * step {
        (0.0, 0.5 * step)
    } else {
        (middle - 0.5 * step, step)
    };
    from + width * (half - below) / here
}

/// Fine and coarse σ by whose ratio of strengths blur is told.
const FINE: f64 = 1.5;
const COARSE: f64 = 3.0;

/// Noise, contrast and blur of a picture.
///
/// Contrast and blur are medians over the strong edges: ridges of |∇(G ∗ I)| at σ = 1.5, five times as strong as noise makes
/// them, and at least half as strong as the strongest tenth. A straight step of contrast A and blur b has strength
/// `A / √(2π (σ² + b²))` at scale σ, so strengths at two scales (1.5 and 3 px) give both:
///
/// ```text
/// b² = (9 − 2.25 r²) / (r² − 1)        r = strength at 1.5 / strength at 3
/// A  = strength at 1.5 · √(2π (2.25 + b²))
/// ```
///
/// Measured on a disk of radius 60 and contrast 140 in 8 bits, blurred by 1 px (1.041 with the pixel's share):
///
/// | noise | 0 | 0.5 | 1 | 5 | 10 | 20 | 40, clipped |
/// | --- | --- | --- | --- | --- | --- | --- | --- |
/// | noise found | 0 | 0.48 | 1.01 | 4.99 | 9.98 | 19.96 | 38.0 |
/// | contrast | 140.0 | 139.9 | 139.9 | 140.1 | 140.2 | 139.7 | 136.9 |
/// | blur | 1.046 | 1.047 | 1.046 | 1.041 | 1.031 | 1.000 | 0.893 |
///
/// Needs edges that run straight and alone for some 6 px: small or crowded things look lower and less blurred than they are.
///
/// # Errors
/// An image without pixels, or with one that is not finite or too large.
pub fn image_scale(image: &Grid) -> Result<ImageScale, FieldError> {
    let noise = noise_sigma(image)?;
    let (fine, coarse) = (Slopes::new(image, FINE)?, Slopes::new(image, COARSE)?);
    // noise alone: each component of the gradient has this standard deviation
    let alone = noise / ((8.0 * PI).sqrt() * FINE * FINE);
    // and rounding, of numbers as large as these, even less
    let rounding = 1e-9 * image.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let least = (5.0 * alone).max(rounding).max(f64::MIN_POSITIVE);
    let mut edges: Vec<(f64, f64)> = hang_together(&fine, least, least)
        .into_iter()
        .filter_map(|at| fine.refined(at))
        .map(|edge| (edge.strength, coarse.at(edge.position).length()))
        .collect();
    edges.sort_by(|a, b| b.0.total_cmp(&a.0));
    let strong = edges.get(edges.len() / 10).map_or(0.0, |edge| 0.5 * edge.0);
    edges.retain(|edge| edge.0 >= strong);
    let median = |mut numbers: Vec<f64>| {
        numbers.sort_by(f64::total_cmp);
        numbers.get(numbers.len() / 2).copied().unwrap_or(0.0)
    };
    let ratio = |&(fine, coarse): &(f64, f64)| (fine / coarse.max(f64::MIN_POSITIVE)).powi(2);
    // a ratio of 1 is no step at all: bounded, so that the blur stays a number
    let squared = |r: f64| (COARSE * COARSE - r * FINE * FINE) / (r - 1.0).max(1e-3);
    let blur = median(edges.iter().map(|edge| squared(ratio(edge))).collect()).max(0.0);
    let strength = median(edges.iter().map(|edge| edge.0).collect());
    Ok(ImageScale {
        noise,
        contrast: strength * (TAU * (FINE * FINE + blur)).sqrt(),
        blur: blur.sqrt(),
        edge_pixels: edges.len(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawn::{drawn, noisy, rounded};
    use glam::DVec2;

    fn disk(blur: f64) -> Grid {
        let center = DVec2::new(127.3, 128.6);
        drawn(
            (256, 256),
            |p| p.distance(center) < 60.0,
            (200.0, 60.0),
            blur,
        )
    }

    #[test]
    fn noise_is_found_within_its_own_scatter() {
        // an edge of 400 pixels among 65000 moves the median by a per cent
        for (sigma, bound) in [(0.5, 0.06), (1.0, 0.02), (5.0, 0.02), (20.0, 0.02)] {
            for blur in [0.0, 1.0, 3.0] {
                let image = noisy(&disk(blur), sigma, 3);
                let (float, byte) = (
                    noise_sigma(&image).unwrap() / sigma,
                    noise_sigma(&rounded(&image)).unwrap() / sigma,
                );
                assert!(
                    (float - 1.0).abs() < 0.03 && (byte - 1.0).abs() < bound,
                    "{sigma} {blur}: {float} {byte}"
                );
            }
        }
        // rounding is known even when the levels were scaled
        let scaled = rounded(&noisy(&disk(1.0), 1.0, 3)).mapv(|v| v / 255.0);
        assert!((noise_sigma(&scaled).unwrap() * 255.0 - 1.0).abs() < 0.02);
        assert!(noise_sigma(&rounded(&disk(1.0))).unwrap() <= 0.0);
    }

    #[test]
    fn white_noise_alone_is_measured_without_bias() {
        let mut sum = 0.0;
        for seed in 0..20 {
            let found = noise_sigma(&noisy(&Grid::zeros((64, 64)), 3.0, seed)).unwrap() / 3.0;
            // 1.6 / 64, four of them
            assert!((found - 1.0).abs() < 0.1, "{found}");
            sum += found / 20.0;
        }
        // 20 pictures of 4096 pixels: 0.6 %
        assert!((sum - 1.0).abs() < 0.018, "{sum}");
        for shape in [(1, 5000), (5000, 1), (2, 3000)] {
            let found = noise_sigma(&noisy(&Grid::zeros(shape), 3.0, 1)).unwrap() / 3.0;
            assert!((found - 1.0).abs() < 0.1, "{shape:?}: {found}");
        }
    }

    #[test]
    fn contrast_and_blur_are_those_the_disk_was_drawn_with() {
        for blur in [0.0, 0.5, 1.0, 2.0, 3.0] {
            for (noise, bound) in [(0.0, 0.005), (5.0, 0.03), (10.0, 0.07)] {
                let found = image_scale(&rounded(&noisy(&disk(blur), noise, 3))).unwrap();
                let expected = (blur * blur + 1.0 / 12.0).sqrt();
                let b = found.blur;
                // a sharp step is not a Gaussian one: a box of one pixel has its variance, not its shape
                assert!(
                    (b - expected).abs() < 0.04 + bound * expected,
                    "{blur} {noise}: {b}"
                );
                assert!(
                    (found.contrast / 140.0 - 1.0).abs() < 0.005 + 0.6 * bound,
                    "{found:?}"
                );
                assert!(found.edge_pixels > 350);
            }
        }
        let found = image_scale(&rounded(&noisy(&disk(1.0), 20.0, 20))).unwrap();
        assert!((found.contrast_to_noise() / 7.0 - 1.0).abs() < 0.03);
    }

    #[test]
    fn pictures_without_steps_or_noise_say_so() {
        for (height, width) in [(1, 1), (1, 40), (40, 1), (3, 3), (2, 2), (3, 100_000)] {
            let found = image_scale(&Grid::from_elem((height, width), 0.1)).unwrap();
            let nothing = ImageScale {
                noise: 0.0,
                contrast: 0.0,
                blur: 0.0,
                edge_pixels: 0,
            };
            assert_eq!(found, nothing);
            assert!(found.contrast_to_noise() <= 0.0);
            let wild =
                Grid::from_shape_fn((height, width), |(y, x)| ((x * 37 + y * 91) % 101) as f64);
            let found = image_scale(&wild).unwrap();
            assert!(
                found.noise.is_finite() && found.contrast.is_finite() && found.blur.is_finite()
            );
        }
        let ramp = Grid::from_shape_fn((40, 40), |(y, x)| 0.3 * x as f64 + 0.7 * y as f64);
        assert!(noise_sigma(&ramp).unwrap() < 1e-12);
        assert!(noise_sigma(&Grid::zeros((0, 4))).is_err());
        assert!(image_scale(&Grid::from_elem((4, 4), f64::NAN)).is_err());
    }
}
