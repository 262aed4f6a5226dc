//! The outline that a track begins with.

use fit::{Contour, Fit, FitError, Image, Options, Prepared};
use glam::DVec2;

use crate::Start;
use crate::ring;

/// A start that shares this much with the outline found about it is kept.
const NEARLY: f64 = 0.9;

/// Cells of the raster by which outlines are compared, each way.
const RASTER: usize = 128;

/// The outline that a start stands for.
pub(crate) fn begun(
    image: &Image,
    start: &Contour,
    rule: Start,
    options: &Options,
) -> Result<Vec<DVec2>, FitError> {
    let own = || start.points.clone();
    if rule == Start::Exact && start.points.len() > 2 {
        return Ok(own());
    }
    let found = Prepared::of(image, options)?.fit(start)?;
    if rule == Start::Rough || start.points.len() < 3 {
        return Ok(found.contour.points);
    }
    let sure = Fit::is_outline(&found);
    let differs = overlap(&start.points, &found.contour.points) < NEARLY;
    Ok(if sure && differs {
        found.contour.points
    } else {
        own()
    })
}

/// Intersection over union of two closed curves.
pub(crate) fn overlap(a: &[DVec2], b: &[DVec2]) -> f64 {
    let both = || a.iter().chain(b).copied();
    let low = both().fold(DVec2::INFINITY, DVec2::min);
    let high = both().fold(DVec2::NEG_INFINITY, DVec2::max);
    let step = (high - low).max_element().max(1e-9) / RASTER as f64;
    let (mut shared, mut all) = (0.0, 0.0);
    for row in 0..RASTER {
        let y = low.y + (row as f64 + 0.5) * step;
        let (a, b) = (ring::spans(a, y), ring::spans(b, y));
        let length = |spans: &[[f64; 2]]| spans.iter().map(|[from, to]| to - from).sum::<f64>();
        let common: f64 = a
            .iter()
            .flat_map(|[from, to]| {
                b.iter()
                    .map(move |[start, end]| (to.min(*end) - from.max(*start)).max(0.0))
            })
            .sum();
        shared += common;
        all += length(&a) + length(&b) - common;
    }
    if all > 0.0 { shared / all } else { 0.0 }
}
