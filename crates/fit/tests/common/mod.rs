//! Drawn images whose outlines are known.
#![allow(dead_code, reason = "each test file uses its part")]
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use fit::force::Computing;
use fit::{Contour, Fit, Image, Options, fit};
use glam::DVec2;

pub(crate) const DARK: f64 = 40.0;
pub(crate) const BRIGHT: f64 = 200.0;

/// Levels of which each pixel is the mean over 16 × 16 points: bright where `inside`.
pub(crate) fn drawn(
    (width, height): (usize, usize),
    inside: impl Fn(DVec2) -> bool,
) -> field::Grid {
    field::Grid::from_shape_fn((height, width), |(y, x)| {
        let mut count = 0.0;
        for v in 0..16 {
            for u in 0..16 {
                let part = (DVec2::new(f64::from(u), f64::from(v)) + 0.5) / 16.0 - 0.5;
                if inside(DVec2::new(x as f64, y as f64) + part) {
                    count += 1.0;
                }
            }
        }
        DARK + (BRIGHT - DARK) * count / 256.0
    })
}

pub(crate) fn disc(center: DVec2, radius: f64) -> field::Grid {
    drawn((97, 91), |p| p.distance(center) < radius)
}

/// Doubles throughout, so that only the arithmetic of the fit is compared.
pub(crate) fn whole() -> Options {
    Options {
        computing: Computing::Whole,
        ..Options::motion()
    }
}

pub(crate) fn found(levels: field::Grid, start: &Contour, options: &Options) -> Fit {
    fit(&Image::grey(levels), start, options).unwrap()
}

/// The largest distance of two curves, node by node.
pub(crate) fn apart(a: &Contour, b: &Contour) -> f64 {
    assert_eq!(a.points.len(), b.points.len());
    let both = a.points.iter().zip(&b.points);
    both.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}
