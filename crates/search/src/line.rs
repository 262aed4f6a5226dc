//! The search about an open curve.

use crate::along::Polygon;
use crate::band::{Band, bend};
use crate::edges::{Across, dot, size};
use crate::evidence::support;
use crate::find::{Found, Search, Searched};
use crate::near::STEP;
use crate::path::Steps;
use crate::rules::Rules;
use crate::smooth::smoothed;
use crate::view::View;
use std::f64::consts::TAU;

use field::Pixels;

/// Nodes along an open curve.
const NODES: usize = 160;

/// Half width of the band, in radii of a circle as long as the curve.
const WIDTH: f64 = 0.5;

/// Half width of the band at least. Pixels.
const LEAST_WIDTH: f64 = 8.0;

/// σ along the curve over which its polarity is smoothed, as a share of it.
const POLARITY: f64 = 1.0 / 12.0;

/// The best open curve in a band about another, its ends on the normals of the other's ends.
///
/// First the strongest edge of any polarity; then again, of the polarity that each stretch was found to have.
pub(crate) fn find_line(pixels: &dyn Pixels, start: &Polygon, rules: &Rules) -> Option<Searched> {
    let width = WIDTH.max(LEAST_WIDTH * TAU / start.length());
    let view = View::along(pixels, start, width)?;
    let r = view.radius;
    let wide = width * r;
    let band = Band::along(&view.start, NODES, (-wide, wide), STEP);
    let steps = Steps {
        bend: bend(STEP, view.start.length() / NODES as f64),
        reach: 2,
    };
    let mut polarity: Option<Vec<Across>> = None;
    let mut curve = Vec::new();
    for _ in 0..2 {
        let costs = band.costs(&view, &view.none(), 0.0, |i, k, p, normal| {
            let away = (k as f64 * STEP - wide) / r;
            let across = view.edges.across(p, normal);
            let slope = match &polarity {
                Some(list) => dot(across, list[i]).max(0.0),
                None => size(across),
            };
            // a line has no far side that could be taken for it: half the tether of an area
            // of a short curve the tether counts the band, not the length
            let away = away * WIDTH / width;
            0.5 * rules.tether * away * away - view.edges.strength(slope)
        });
        curve = band.curve(&costs.open_path(steps, None)?);
        let found: Vec<Across> = curve
            .iter()
            .zip(&band.nodes)
            .map(|(p, node)| view.edges.across(*p, node.normal))
            .collect();
        polarity = Some(directions(&found));
    }
    let points = curve.iter().map(|p| view.frame.to_picture(*p)).collect();
    let found = Found {
        search: Search::Near,
        points,
        support: support(&view, &curve, false, false),
        window: curve,
    };
    Some(Searched::of(view, vec![found], 0))
}

/// Unit vectors of slopes across a curve, smoothed along it.
fn directions(slopes: &[Across]) -> Vec<Across> {
    let sigma = POLARITY * slopes.len() as f64;
    let channels: [Vec<f64>; 3] = std::array::from_fn(|c| {
        let list: Vec<f64> = slopes.iter().map(|one| one[c]).collect();
        smoothed(&list, sigma, false)
    });
    (0..slopes.len())
        .map(|i| {
            let mean = std::array::from_fn(|c| channels[c][i]);
            let length = size(mean);
            if length > 0.0 {
                mean.map(|v| v / length)
            } else {
                mean
            }
        })
        .collect()
}
