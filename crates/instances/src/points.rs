//! Objects of which a place inside is known: regions of all sizes and levels that hold one of the places.

use field::Pixels;
use glam::DVec2;

use crate::auto::{fields, with_points};
use crate::jobs;
use crate::spans::Spans;

/// The region about each point that is worth most, of the polarity that is worth more for all together; None where
/// none is worth anything.
pub(crate) fn about_points(pixels: &dyn Pixels, points: &[DVec2]) -> Vec<Option<Spans>> {
    let both = fields(pixels);
    let found = jobs::map(both.len(), |at| with_points(&both[at].all, points));
    let mut best: (f64, Vec<Option<Spans>>) = (0.0, vec![None; points.len()]);
    for (sum, list) in found {
        if sum > best.0 {
            best = (sum, list);
        }
    }
    best.1
}
