//! How the first frame is looked at: which levels are light and dark, and which features a palette is learnt from.

use field::Pixels;
use glam::DVec2;

use crate::palette::{Feature, SAMPLE};
use crate::ring;
use crate::window::{Lightness, Window, to_pixels};

/// How levels near an object become lightness.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the frame"
)]
pub(crate) fn lightness(pixels: &dyn Pixels, block: usize, low: DVec2, high: DVec2) -> Lightness {
    let size = block as f64;
    let (width, height) = pixels.size();
    let clamped = |v: f64, most: usize| v.clamp(0.0, (most - 1) as f64) as usize;
    let (low, high) = (to_pixels(low - 15.0, size), to_pixels(high + 15.0, size));
    let (left, right) = (clamped(low.x, width), clamped(high.x, width));
    let (top, bottom) = (clamped(low.y, height), clamped(high.y, height));
    let mut levels = Vec::new();
    for y in (top..=bottom).step_by(block) {
        levels.extend(
            (left..=right)
                .step_by(block)
                .map(|x| pixels.level(x, y))
                .filter(|v| v.is_finite()),
        );
    }
    levels.sort_by(f64::total_cmp);
    let at = |share: f64| {
        levels
            .get(((levels.len().max(1) - 1) as f64 * share) as usize)
            .copied()
            .unwrap_or(0.0)
    };
    let (low, high) = (at(0.01), at(0.99));
    let span = high - low;
    let factor = if span > 1e-9 { 100.0 / span } else { 0.0 };
    Lightness {
        low,
        factor,
        color: pixels.is_color(),
    }
}

/// Features of the object and of its surroundings, at most so many of each.
pub(crate) fn sample(window: &Window, curve: &[DVec2], radius: f64) -> Vec<Feature> {
    let inside = window.inside(curve);
    let reach = 20.0_f64.max(1.5 * radius);
    let (low, high) = ring::bounds(curve);
    let near = |at: usize| {
        let p = DVec2::new(
            (window.left + at % window.width) as f64,
            (window.top + at / window.width) as f64,
        );
        p.cmpge(low - reach).all() && p.cmple(high + reach).all()
    };
    let mut features = Vec::new();
    for side in [true, false] {
        let list: Vec<usize> = (0..inside.len())
            .filter(|&at| inside[at] == side && near(at))
            .collect();
        features.extend(
            list.iter()
                .step_by(list.len().div_ceil(SAMPLE).max(1))
                .map(|&at| window.features[at]),
        );
    }
    features
}
