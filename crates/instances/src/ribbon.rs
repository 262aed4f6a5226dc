//! The best outline in a band about one that is found: what rays are too coarse for.

use glam::DVec2;
use search::along::Polygon;
use search::path::{Costs, Steps};
use search::smooth::smoothed;
use search::whole::{at, signed};

use crate::model::{Model, Seed, strength};
use crate::rules::Rules;

/// Half width of the band in inner radii, and distances of nodes and places in pixels of the model.
const WIDTH: f64 = 0.4;
const SPACING: f64 = 1.0;
const STEP: f64 = 0.5;

const BEND: f64 = 0.02;
const REACH: usize = 3;

/// The best outline in a band about another.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the length of an outline in pixels"
)]
pub(crate) fn ribbon(
    model: &Model<'_>,
    seed: &Seed,
    curve: &[DVec2],
    half: f64,
    rules: &Rules,
) -> Option<Vec<DVec2>> {
    let polygon = Polygon {
        points: curve.to_vec(),
        closed: true,
    }
    .outwards();
    let wide = (WIDTH * seed.inner).max(2.0);
    let count = (polygon.length() / SPACING).round().max(16.0) as usize;
    let even = polygon.evenly(count);
    let normals = even.normals(0.7 * wide / SPACING);
    let polarity = local_polarity(model, &even);
    let states = (2.0 * wide / STEP).round() as usize + 1;
    let worth = rules.region * STEP / (0.1 * seed.inner);
    let mut list = Vec::with_capacity(count * states);
    let place = |i: usize, k: usize| {
        let p: DVec2 = even.points[i];
        p + (k as f64 * STEP - wide) * normals[i]
    };
    for i in 0..count {
        let mut gained = 0.0;
        for k in 0..states {
            let p = place(i, k);
            let part = 0.5 * worth * model.likelihood(seed, p);
            gained += part;
            let slope = signed(model.whole.across(p, normals[i]), polarity[i]);
            list.push(-strength(slope, half) - gained);
            gained += part;
        }
    }
    let steps = Steps {
        bend: BEND,
        reach: REACH,
    };
    let path = Costs::new(states, list).closed_path(steps)?;
    let nodes = path.states.iter().enumerate();
    Some(nodes.map(|(i, &k)| place(i, k)).collect())
}

/// Direction of color across a curve, inside less outside, smoothed over a twelfth of its length.
fn local_polarity(model: &Model<'_>, curve: &Polygon) -> Vec<Option<[f64; 3]>> {
    let normals = curve.normals(1.0);
    let count = curve.points.len();
    let mut difference = vec![[0.0; 3]; count];
    for (c, channel) in model.whole.channels().iter().enumerate() {
        let both = curve.points.iter().zip(&normals);
        let list: Vec<f64> = both
            .map(|(p, normal)| {
                let side = |sign: f64| {
                    let ways = [1.5, 2.5, 3.5].map(|way| at(channel, *p + sign * way * normal));
                    ways.iter().sum::<f64>() / 3.0
                };
                side(-1.0) - side(1.0)
            })
            .collect();
        let smooth = smoothed(&list, count as f64 / 12.0, true);
        for (one, value) in difference.iter_mut().zip(smooth) {
            one[c] = value;
        }
    }
    difference
        .into_iter()
        .map(|d| {
            let length = d.iter().map(|v| v * v).sum::<f64>().sqrt();
            (length > 0.0).then(|| d.map(|v| v / length))
        })
        .collect()
}
