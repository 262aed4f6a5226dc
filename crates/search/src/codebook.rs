//! What the inside and the outside of a curve look like: colors and texture sorted into few classes.

use field::Grid;

use crate::edges::{blurred, dot};
use crate::frame::Frame;

/// Classes that the pixels of a window are sorted into.
const CLASSES: usize = 24;

/// Pixels that the classes are found from, at most.
const SAMPLE: usize = 4000;

/// Rounds of moving the middles of the classes.
const ROUNDS: usize = 12;

/// Channels of a pixel: three of color and one of texture.
type Features = [f32; 4];

/// σ of the blur of the colors, and of the neighbourhood whose spread is the texture.
const COLOR_SIGMA: f64 = 1.0;
const TEXTURE_SIGMA: f64 = 2.5;

/// The logarithm of a ratio of likelihoods is cut at this size.
const MOST: f64 = 2.0;

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
        let stride = counted.len().div_ceil(SAMPLE).max(1);
        let sample: Vec<Features> = counted
            .iter()
            .step_by(stride)
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

/// Lloyd's rounds from starts drawn far from each other (k-means++, \[arthur07\]), the same every
/// time.
fn k_means(sample: &[Features]) -> Vec<Features> {
    let mut centers = starts(sample);
    let mut classes = vec![0; sample.len()];
    for _ in 0..ROUNDS {
        sort(sample, &centers, &mut classes);
        let mut sums = vec![([0.0_f32; 4], 0.0_f32); centers.len()];
        for (one, &class) in sample.iter().zip(&classes) {
            let (sum, count) = &mut sums[usize::from(class)];
            for (sum, value) in sum.iter_mut().zip(one) {
                *sum += value;
            }
            *count += 1.0;
        }
        let mut moved = 0.0_f32;
        for (center, (sum, count)) in centers.iter_mut().zip(sums) {
            if count > 0.0 {
                let mean = sum.map(|sum| sum / count);
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

fn starts(sample: &[Features]) -> Vec<Features> {
    let mut centers = Vec::with_capacity(CLASSES);
    let mut away = vec![f32::INFINITY; sample.len()];
    let mut next = sample.first().copied();
    while let Some(last) = next.take() {
        centers.push(last);
        let mut total = 0.0_f64;
        for (away, one) in away.iter_mut().zip(sample) {
            *away = away.min(apart(one, &last));
            total += f64::from(*away);
        }
        if centers.len() == CLASSES || total <= 0.0 {
            break;
        }
        let mut left = chance(centers.len() as u64) * total;
        let chosen = away.iter().position(|away| {
            left -= f64::from(*away);
            left < 0.0
        });
        next = sample.get(chosen.unwrap_or(sample.len() - 1)).copied();
    }
    centers
}

/// The n-th number of splitmix64, in [0, 1).
fn chance(n: u64) -> f64 {
    let mut z = n.wrapping_mul(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 / 2.0_f64.powi(53)
}

/// A difference of colors as a unit vector; None where there is none.
pub(crate) fn unit(difference: [f64; 3]) -> Option<[f64; 3]> {
    let length = dot(difference, difference).sqrt();
    (length > 0.0).then(|| difference.map(|v| v / length))
}
