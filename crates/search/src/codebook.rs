//! What the inside and the outside of a curve look like: colors and texture sorted into few classes.

use field::Grid;

use crate::edges::{blurred, dot};
use crate::frame::Frame;

/// Classes that the pixels of a window are sorted into.
const CLASSES: usize = 24;

/// Pixels that the classes are found from, at most.
const SAMPLE: usize = 12000;

/// Rounds of moving the middles of the classes.
const ROUNDS: usize = 12;

/// Channels of a pixel: three of color and one of texture.
type Features = [f32; 4];

/// σ of the blur of the colors, and of the neighbourhood whose spread is the texture.
const COLOR_SIGMA: f64 = 1.0;
const TEXTURE_SIGMA: f64 = 2.5;

/// The logarithm of a ratio of likelihoods is cut at this size.
pub(crate) const MOST: f64 = 2.0;

/// Share of a uniform distribution in each, and counts added to each class.
const UNIFORM: f64 = 0.01;
const ADDED: f64 = 0.5;

/// A window with the class of each pixel.
#[derive(Debug)]
pub(crate) struct Codebook {
    classes: Vec<u8>,
}

impl Codebook {
    /// Sort a window; the classes are found from pixels where `counts` is true.
    pub(crate) fn of(frame: &Frame, counts: impl Fn(usize) -> bool) -> Self {
        let features = features(frame);
        let counted: Vec<usize> = (0..features.len()).filter(|&at| counts(at)).collect();
        let share = SAMPLE as f64 / counted.len().max(1) as f64;
        let sample: Vec<Features> = counted
            .iter()
            .filter(|&&at| share >= 1.0 || drawn(at, frame.dim()) < share)
            .map(|&at| features[at])
            .collect();
        let centers = k_means(&sample);
        let mut classes = vec![0; features.len()];
        sort(&features, &centers, &mut classes);
        Self { classes }
    }

    /// The logarithm of how much likelier each class is inside than outside, cut at ±2; `side` says of each pixel
    /// whether it is inside, None where it does not count.
    pub(crate) fn ratios(&self, side: impl Fn(usize) -> Option<bool>) -> Ratios {
        // inside, outside, and what does not count
        let mut numbers = [[0_u32; CLASSES]; 3];
        for (at, &class) in self.classes.iter().enumerate() {
            let side = side(at).map_or(2, |inside| usize::from(!inside));
            numbers[side][usize::from(class)] += 1;
        }
        let counts = numbers.map(|side| side.map(|number| f64::from(number) + ADDED));
        let share = |side: usize, class: usize| {
            let total: f64 = counts[side].iter().sum();
            (1.0 - UNIFORM) * counts[side][class] / total + UNIFORM / CLASSES as f64
        };
        Ratios(std::array::from_fn(|class| {
            (share(0, class) / share(1, class)).ln().clamp(-MOST, MOST)
        }))
    }

    /// The ratio of each pixel.
    pub(crate) fn map(&self, ratios: &Ratios, dim: (usize, usize)) -> Grid {
        let values = self
            .classes
            .iter()
            .map(|&class| ratios.0[usize::from(class)]);
        Grid::from_shape_vec(dim, values.collect()).unwrap_or_else(|_| Grid::zeros(dim))
    }
}

/// How much likelier each class is inside than outside, as a logarithm.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ratios([f64; CLASSES]);

fn features(frame: &Frame) -> Vec<Features> {
    let colors: Vec<Grid> = frame
        .channels
        .iter()
        .map(|one| blurred(one, COLOR_SIGMA))
        .collect();
    let light = &frame.channels[0];
    let mean = blurred(light, TEXTURE_SIGMA);
    let squares = blurred(&(light * light), TEXTURE_SIGMA);
    let spread = ndarray::Zip::from(&mean)
        .and(&squares)
        .map_collect(|m, s| (s - m * m).max(0.0).sqrt());
    #[allow(clippy::cast_possible_truncation, reason = "classes need few digits")]
    let value = |grid: &Grid, at: usize| grid.as_slice().map_or(0.0, |list| list[at] as f32);
    (0..spread.len())
        .map(|at| {
            let mut one = [0.0; 4];
            for (feature, color) in one.iter_mut().zip(&colors) {
                *feature = value(color, at);
            }
            one[3] = value(&spread, at);
            one
        })
        .collect()
}

fn apart(a: &Features, b: &Features) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

/// Pixels that are sorted at once.
const LANES: usize = 16;

lanes::wide! {
    /// The class of the nearest middle of each pixel, the first of equals.
    #[allow(clippy::cast_possible_truncation, reason = "classes need few digits")]
    fn sort(features: &[Features], centers: &[Features], classes: &mut [u8]) {
        for (pixels, classes) in features.chunks(LANES).zip(classes.chunks_mut(LANES)) {
            // channel by channel
            let mut channels = [[0.0_f32; LANES]; 4];
            for (at, pixel) in pixels.iter().enumerate() {
                for (channel, value) in channels.iter_mut().zip(pixel) {
                    channel[at] = *value;
                }
            }
            let [a, b, c, d] = &channels;
            let mut nearest = [f32::INFINITY; LANES];
            let mut found = [0_u32; LANES];
            for (class, [e, f, g, h]) in (0_u32..).zip(centers) {
                for at in 0..LANES {
                    let (a, b, c, d) = (a[at] - e, b[at] - f, c[at] - g, d[at] - h);
                    let apart = a * a + b * b + c * c + d * d;
                    let nearer = apart < nearest[at];
                    nearest[at] = if nearer { apart } else { nearest[at] };
                    found[at] = if nearer { class } else { found[at] };
                }
            }
            for (to, class) in classes.iter_mut().zip(found) {
                *to = class as u8;
            }
        }
    }
}

/// Lloyd's rounds (\[lloyd82\]) from the means of parts. Nothing in it depends on the order of the sample, so that a
/// picture that is turned has the same classes.
fn k_means(sample: &[Features]) -> Vec<Features> {
    let mut centers = starts(sample);
    let mut classes = vec![0; sample.len()];
    for _ in 0..ROUNDS {
        sort(sample, &centers, &mut classes);
        let mut sums = vec![([0.0_f64; 4], 0.0_f64); centers.len()];
        for (one, &class) in sample.iter().zip(&classes) {
            let (sum, count) = &mut sums[usize::from(class)];
            for (sum, value) in sum.iter_mut().zip(one) {
                *sum += f64::from(*value);
            }
            *count += 1.0;
        }
        let mut moved = 0.0_f32;
        for (center, (sum, count)) in centers.iter_mut().zip(sums) {
            if count > 0.0 {
                #[allow(clippy::cast_possible_truncation, reason = "classes need few digits")]
                let mean = sum.map(|sum| (sum / count) as f32);
                moved = moved.max(apart(center, &mean));
                *center = mean;
            }
        }
        if moved < 1e-4 {
            break;
        }
    }
    centers
}

/// The means of parts: the part that is spread most along a channel is cut there at its mean, again and again.
fn starts(sample: &[Features]) -> Vec<Features> {
    let mut parts: Vec<Part> = Part::of(sample.to_vec()).into_iter().collect();
    while parts.len() < CLASSES {
        let widest = (0..parts.len()).max_by(|&a, &b| parts[a].spread.total_cmp(&parts[b].spread));
        let Some(widest) = widest.filter(|&at| parts[at].spread > 0.0) else {
            break;
        };
        let part = &parts[widest];
        let above = |one: &Features| f64::from(one[part.channel]) > part.mean[part.channel];
        let (above, below): (Vec<_>, Vec<_>) = part.pixels.iter().copied().partition(above);
        match (Part::of(above), Part::of(below)) {
            (Some(above), Some(below)) => {
                parts[widest] = above;
                parts.push(below);
            }
            // equal values, whose mean differs from them by its rounding
            _ => parts[widest].spread = 0.0,
        }
    }
    #[allow(clippy::cast_possible_truncation, reason = "classes need few digits")]
    let center = |part: &Part| part.mean.map(|value| value as f32);
    parts.iter().map(center).collect()
}

/// Some pixels.
struct Part {
    pixels: Vec<Features>,
    mean: [f64; 4],
    /// The sum of the squares of what they differ from their mean in one channel, the largest of all channels.
    spread: f64,
    channel: usize,
}

impl Part {
    /// None of no pixel.
    fn of(pixels: Vec<Features>) -> Option<Self> {
        let count = pixels.len() as f64;
        let mut mean = [0.0; 4];
        for one in &pixels {
            for (mean, value) in mean.iter_mut().zip(one) {
                *mean += f64::from(*value) / count;
            }
        }
        let spread = |channel: usize| -> f64 {
            let away = pixels
                .iter()
                .map(|one| f64::from(one[channel]) - mean[channel]);
            away.map(|away| away * away).sum()
        };
        let spreads: [f64; 4] = std::array::from_fn(spread);
        let channel = (0..4).max_by(|&a, &b| spreads[a].total_cmp(&spreads[b]))?;
        (count > 0.0).then_some(Self {
            pixels,
            mean,
            spread: spreads[channel],
            channel,
        })
    }
}

/// A number of a pixel from 0 to 1 (splitmix64), the same for the places that turning or mirroring the window about its
/// middle leads it to.
fn drawn(at: usize, (height, width): (usize, usize)) -> f64 {
    let (x, y) = (
        (2 * (at % width)).abs_diff(width - 1),
        (2 * (at / width)).abs_diff(height - 1),
    );
    let mut z = ((x.min(y) as u64) << 32 | x.max(y) as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 / 2.0_f64.powi(53)
}

/// A difference of colors as a unit vector; None where there is none.
pub(crate) fn unit(difference: [f64; 3]) -> Option<[f64; 3]> {
    let length = dot(difference, difference).sqrt();
    (length > 0.0).then(|| difference.map(|v| v / length))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_values_are_as_many_classes_whatever_their_mean_is_rounded_to() {
        for count in [1, 3, 7, 1000, 12000] {
            let one = [0.1_f32, 33.3, -7.7, 1e-3];
            assert_eq!(k_means(&vec![one; count]).len(), 1);
        }
        let values = [0.1_f32, 33.3, 99.9];
        let sample: Vec<Features> = (0..3000).map(|i| [values[i % 3], 0.0, 0.0, 0.7]).collect();
        let mut centers: Vec<f32> = k_means(&sample).iter().map(|center| center[0]).collect();
        centers.sort_by(f32::total_cmp);
        assert_eq!(centers, values);
    }
}
