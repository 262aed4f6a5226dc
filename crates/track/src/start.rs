//! The outline that a track begins with.

use fit::{Contour, Fit, FitError, Image, Options, Prepared};
use glam::DVec2;
use search::along::Polygon;

use crate::Start;
use crate::ring;

/// A start that shares this much with the outline found about it is kept.
const NEARLY: f64 = 0.95;

/// A start lies on an edge if its own is at least this share of those so far beside it, in radii.
const PEAK: f64 = 0.86;
const BESIDE: f64 = 0.05;
const LEAST_BESIDE: f64 = 3.5;

/// … and if its own is at least this share of that of the outline found.
const SHARE: f64 = 0.72;

/// Points by which starts are compared with what is beside them, and the smoothing of their normals.
const POINTS: usize = 200;
const CALM: f64 = 4.0;

/// Cells of the raster by which outlines are compared, each way.
const RASTER: usize = 128;

/// The outline that a start stands for.
#[derive(Debug)]
pub(crate) struct Begun {
    pub points: Vec<DVec2>,
    /// Whether it was looked for, and nothing speaks for what was found.
    pub doubtful: bool,
}

/// The outline that a start stands for.
pub(crate) fn begun(
    image: &Image,
    start: &Contour,
    rule: Start,
    options: &Options,
) -> Result<Begun, FitError> {
    let own = || Begun {
        points: start.points.clone(),
        doubtful: false,
    };
    if rule == Start::Exact && start.points.len() > 2 {
        return Ok(own());
    }
    let found = Prepared::of(image, options)?.fit(start)?;
    let is_outline = Fit::is_outline(&found);
    if rule == Start::Rough || start.points.len() < 3 {
        return Ok(Begun {
            points: found.contour.points,
            doubtful: !is_outline,
        });
    }
    let taken = is_outline
        && overlap(&start.points, &found.contour.points) < NEARLY
        && !is_on_edge(image, start, &found.contour, options);
    Ok(if taken {
        Begun {
            points: found.contour.points,
            doubtful: false,
        }
    } else {
        own()
    })
}

/// Whether a start lies on an edge as it is drawn: whether there is as much of one on it as beside it.
fn is_on_edge(image: &Image, start: &Contour, found: &Contour, options: &Options) -> bool {
    let closed = true;
    let drawn = Polygon {
        points: start.points.clone(),
        closed,
    }
    .outwards();
    let Some(searched) = search::find(image.pixels(), &drawn, &options.search) else {
        return false;
    };
    let found = &Polygon {
        points: found.points.clone(),
        closed,
    }
    .outwards();
    let drawn = drawn.evenly(POINTS);
    let normals = drawn.normals(CALM);
    let radius = ring::radius(&drawn.points);
    let edge = |offset: f64| {
        let beside = drawn.points.iter().zip(&normals);
        let points = beside
            .map(|(p, normal)| *p + offset * radius * *normal)
            .collect();
        searched.support(&Polygon { points, closed }).edge
    };
    let beside = BESIDE.max(LEAST_BESIDE * searched.pixel / radius);
    let own = edge(0.0);
    own >= PEAK * edge(-beside).max(edge(beside)) && own >= SHARE * searched.support(found).edge
}

/// Intersection over union of two closed curves.
pub fn overlap(a: &[DVec2], b: &[DVec2]) -> f64 {
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
