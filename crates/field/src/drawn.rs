//! Pictures for tests: drawn, blurred, made noisy and rounded as the shared synthetic cases say.

use crate::grid::Grid;
use glam::DVec2;
use std::f64::consts::TAU;

/// `inside` or `outside` by the share of 8 × 8 points of each pixel, then blurred.
pub(crate) fn drawn(
    (height, width): (usize, usize),
    inside: impl Fn(DVec2) -> bool,
    (bright, dark): (f64, f64),
    blur: f64,
) -> Grid {
    let sharp = Grid::from_shape_fn((height, width), |(y, x)| {
        let part = |k: u32| (2.0 * f64::from(k) + 1.0) / 16.0 - 0.5;
        let at = |k: u32| DVec2::new(x as f64 + part(k % 8), y as f64 + part(k / 8));
        let share = (0..64).filter(|&k| inside(at(k))).count() as f64 / 64.0;
        dark + (bright - dark) * share
    });
    if blur > 0.0 {
        crate::Smoothing::Gaussian(blur).apply(&sharp)
    } else {
        sharp
    }
}

/// Adds noise of standard deviation `sigma` from a seed.
pub(crate) fn noisy(image: &Grid, sigma: f64, seed: u64) -> Grid {
    let width = image.ncols();
    Grid::from_shape_fn(image.dim(), |(y, x)| {
        image[[y, x]] + sigma * gauss((seed << 31) + (y * width + x) as u64)
    })
}

/// Rounded to 8 bits, halves upwards.
pub(crate) fn rounded(image: &Grid) -> Grid {
    image.mapv(|v| (v.clamp(0.0, 255.0) + 0.5).floor())
}

/// The n-th number of a normal distribution: splitmix64 and Box–Muller.
pub(crate) fn gauss(n: u64) -> f64 {
    let mix = |z: u64| {
        let z = z.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64
    };
    let unit = 2.0_f64.powi(-53);
    let (a, b) = ((mix(2 * n) + 1.0) * unit, mix(2 * n + 1) * unit);
    (-2.0 * a.ln()).sqrt() * (TAU * b).cos()
}
