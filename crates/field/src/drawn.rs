//! Pictures whose truth is a formula: regions drawn, made noisy and rounded to whole levels.
//!
//! ```
//! use field::drawn::{covered, noisy, rounded};
//! use glam::DVec2;
//!
//! // a bright disc on a dark ground, with noise from the seed 7
//! let disc = |p: DVec2| p.distance(DVec2::new(15.2, 16.4)) <= 9.0;
//! let picture = rounded(&noisy(&covered((32, 32), disc, (200.0, 60.0)), 5.0, 7));
//! assert!(picture[[16, 15]] > 170.0 && picture[[2, 2]] < 90.0);
//! ```

use crate::grid::Grid;
use glam::DVec2;
use std::f64::consts::TAU;

/// Levels `bright` in a region and `dark` around it: of each pixel by the share of an 8 × 8 grid of points
/// in its square
/// that lies in the region.
#[must_use]
pub fn covered(
    (height, width): (usize, usize),
    inside: impl Fn(DVec2) -> bool,
    (bright, dark): (f64, f64),
) -> Grid {
    let part = |k: u32| (2.0 * f64::from(k) + 1.0) / 16.0 - 0.5;
    Grid::from_shape_fn((height, width), |(y, x)| {
        let at = |k: u32| DVec2::new(x as f64 + part(k % 8), y as f64 + part(k / 8));
        let share = (0..64).filter(|&k| inside(at(k))).count() as f64 / 64.0;
        dark + (bright - dark) * share
    })
}

/// The same blurred.
#[cfg(test)]
pub(crate) fn drawn(
    dim: (usize, usize),
    inside: impl Fn(DVec2) -> bool,
    levels: (f64, f64),
    blur: f64,
) -> Grid {
    let sharp = covered(dim, inside, levels);
    if blur > 0.0 {
        crate::Smoothing::Gaussian(blur).apply(&sharp)
    } else {
        sharp
    }
}

/// Adds white noise of standard deviation `sigma`: to each pixel its number of the seed, row by row.
#[must_use]
pub fn noisy(image: &Grid, sigma: f64, seed: u64) -> Grid {
    let width = image.ncols();
    Grid::from_shape_fn(image.dim(), |(y, x)| {
        let (size, turn) = polar(seed, (y * width + x) as u64);
        image[[y, x]] + sigma * size * turn
    })
}

/// Whole levels of 8 bits, halves upwards.
#[must_use]
pub fn rounded(image: &Grid) -> Grid {
    image.mapv(|v| (v.clamp(0.0, 255.0) + 0.5).floor())
}

/// Size and cosine of the number of a place in the stream of a seed, of a standard normal distribution: Box and Muller.
fn polar(seed: u64, place: u64) -> (f64, f64) {
    let [a, b] = [0, 1].map(|k| uniform(seed, 2 * place + k));
    let size = (-2.0 * (a + 2.0_f64.powi(-53)).ln()).sqrt();
    (size, (TAU * b).cos())
}

/// The number of a place in the stream of a seed, even in [0, 1): splitmix64. Noise takes two of them a
/// pixel.
#[must_use]
pub fn uniform(seed: u64, place: u64) -> f64 {
    let z = (seed << 32)
        .wrapping_add(place)
        .wrapping_add(0x9E37_79B9_7F4A_7C15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 / 2.0_f64.powi(53)
}

/// The n-th number of a normal distribution.
#[cfg(test)]
pub(crate) fn gauss(n: u64) -> f64 {
    let (size, turn) = polar(0, n);
    size * turn
}
