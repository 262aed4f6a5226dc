//! The free searches: along rays from the middle of the start, and about a curve that is already found.

use glam::DVec2;

use crate::along::Polygon;
use crate::band::{Band, Node, bend, local_polarity, signed_strength};
use crate::near::STEP;
use crate::path::Steps;
use crate::rules::Rules;
use crate::view::View;

/// Rays, and places on each.
const RAYS: usize = 96;
const PLACES: usize = 56;

/// Where the places on a ray begin and end, in radii of the start in its direction.
const FROM: f64 = 0.2;
const TO: f64 = 1.06;

const STEPS: Steps = Steps {
    bend: 0.02,
    reach: 3,
};

/// Rounds of learning what the inside looks like; it is learnt when fewer pixels than these change sides.
const ROUNDS: usize = 3;
const SETTLED: usize = 4;

/// The bands about a curve that is found: nodes a pixel, half width in radii of the start.
const SPACING: f64 = 1.0;
const FIRST_WIDTH: f64 = 0.1;
pub(crate) const WIDTH: f64 = 0.2;
const FREE_STEPS: Steps = Steps {
    bend: 0.02,
    reach: 4,
};
const FREE_ROUNDS: usize = 2;

/// The best curve along rays from the middle of the start.
pub(crate) fn within(view: &View, rules: &Rules) -> Option<Vec<DVec2>> {
    let band = rays(view, (FROM, TO))?;
    let mut inside = view.core();
    let mut curve = Vec::new();
    for _ in 0..ROUNDS {
        let likelihood = view.likelihood(&inside);
        let costs = band.costs(view, &likelihood, rules.region, |_, k, p, normal| {
            let out = FROM + (TO - FROM) * k as f64 / (PLACES - 1) as f64;
            let slope = view.signed(view.edges.across(p, normal)).max(0.0);
            -view.edges.strength(slope) - rules.outer * out.min(1.0)
        });
        curve = band.curve(&costs.closed_path(STEPS)?);
        let now = view.inside(&curve);
        let changed = now.iter().zip(&inside).filter(|(a, b)| a != b).count();
        inside = now;
        if changed < SETTLED {
            break;
        }
    }
    // once about the result, still with a preference for what is farther out
    let polygon = Polygon {
        points: curve,
        closed: true,
    };
    let r = view.radius;
    let wide = FIRST_WIDTH * r;
    let count = 160;
    let even = polygon.evenly(count);
    let band = Band::along(&polygon, count, (-wide, wide), STEP);
    let steps = Steps {
        bend: bend(STEP, even.length() / count as f64),
        reach: 2,
    };
    let polarity = local_polarity(view, &even);
    let likelihood = view.likelihood(&inside);
    let costs = band.costs(view, &likelihood, rules.region, |i, k, p, normal| {
        let away = (k as f64 * STEP - wide) / r;
        -signed_strength(view, p, normal, polarity[i]) - rules.outer * away
    });
    let curve = band.curve(&costs.closed_path(steps)?);
    Some(free(view, rules, curve, WIDTH))
}

/// The best curve in a band about one that is found, unrolled again about its own result: what leaves the rays, as legs
/// and horns do, is entered. The band is `width` radii of the start wide on either side.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the length of a curve in a window of some hundred pixels"
)]
pub(crate) fn free(view: &View, rules: &Rules, mut curve: Vec<DVec2>, width: f64) -> Vec<DVec2> {
    let wide = width * view.radius;
    for _ in 0..FREE_ROUNDS {
        let likelihood = view.likelihood(&view.inside(&curve));
        let polygon = Polygon {
            points: curve.clone(),
            closed: true,
        };
        let count = (polygon.length() / SPACING).round().max(16.0) as usize;
        let polarity = local_polarity(view, &polygon.evenly(count));
        let band = Band::along(&polygon, count, (-wide, wide), STEP);
        let costs = band.costs(view, &likelihood, rules.region, |i, _, p, normal| {
            -signed_strength(view, p, normal, polarity[i])
        });
        match costs.closed_path(FREE_STEPS) {
            Some(path) => curve = band.curve(&path),
            None => break,
        }
    }
    curve
}

/// Rays from the start's middle; each place is a share of the way to the outermost point of the start in its direction.
pub(crate) fn rays(view: &View, (from, to): (f64, f64)) -> Option<Band> {
    let points = &view.start.points;
    let center = elastic::centroid(points)?;
    let n = points.len();
    let out = |ray: DVec2| {
        let crossing = |j: usize| {
            let (a, b) = (points[j] - center, points[(j + 1) % n] - center);
            let (before, behind) = (ray.perp_dot(a), ray.perp_dot(b));
            let crosses = (before > 0.0) != (behind > 0.0);
            if crosses {
                ray.dot(a.lerp(b, before / (before - behind)))
            } else {
                0.0
            }
        };
        (0..n).map(crossing).fold(0.0, f64::max)
    };
    // the first through the start's first point, so that they turn with it
    let first = (*points.first()? - center)
        .try_normalize()
        .unwrap_or(DVec2::X);
    let rays: Vec<(DVec2, f64)> = (0..RAYS)
        .map(|i| DVec2::from_angle(i as f64 * std::f64::consts::TAU / RAYS as f64).rotate(first))
        .map(|ray| (ray, out(ray)))
        .collect();
    let outer = Polygon {
        points: rays
            .iter()
            .map(|(ray, radius)| center + *radius * *ray)
            .collect(),
        closed: true,
    };
    let normals = outer.normals(1.0);
    let node = |((ray, radius), normal): (&(DVec2, f64), &DVec2)| Node {
        inner: center + from * *radius * *ray,
        step: (to - from) * *radius / (PLACES - 1) as f64 * *ray,
        normal: *normal,
    };
    let nodes = rays.iter().zip(&normals).map(node).collect();
    Some(Band {
        nodes,
        states: PLACES,
    })
}
