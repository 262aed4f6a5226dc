//! The best outline about a seed along rays from its center.

use glam::DVec2;
use search::path::{Costs, Steps};

use crate::model::{Model, Seed, strength};
use crate::rules::Rules;

/// Rays, and places on each.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Grain {
    rays: usize,
    places: usize,
    /// Price of a step by one place, against that of the finest.
    bend: f64,
}

/// For outlines to keep.
pub(crate) const FINE: Grain = Grain {
    rays: 48,
    places: 40,
    bend: 1.0,
};

/// Where the places on a ray begin and end, in inner radii.
const FROM: f64 = 0.6;
const TO: f64 = 3.2;

/// Places that a step may lead from one ray to the next.
const REACH: usize = 3;

/// The points of the best outline, and the slope that counts as half an edge there.
pub(crate) fn rays(
    model: &Model<'_>,
    seed: &Seed,
    grain: Grain,
    rules: &Rules,
) -> Option<(Vec<DVec2>, f64)> {
    let (count, places) = (grain.rays, grain.places);
    let step = (TO - FROM) * seed.inner / (places - 1) as f64;
    let turns: Vec<DVec2> = (0..count)
        .map(|i| DVec2::from_angle(i as f64 * std::f64::consts::TAU / count as f64))
        .collect();
    let place = |ray: DVec2, k: usize| seed.center + (FROM * seed.inner + k as f64 * step) * ray;
    let mut slopes: Vec<f64> = turns
        .iter()
        .flat_map(|&ray| (0..places).step_by(2).map(move |k| place(ray, k)))
        .map(|p| model.whole.slope(p))
        .collect();
    let half = model.half(&mut slopes);
    let worth = rules.region * step / (0.1 * seed.inner);
    let mut list = Vec::with_capacity(count * places);
    for &ray in &turns {
        let mut gained = 0.0;
        for k in 0..places {
            let p = place(ray, k);
            let part = 0.5 * worth * model.likelihood(seed, p);
            gained += part;
            list.push(-strength(model.signed(p, ray), half) - gained);
            gained += part;
        }
    }
    let steps = Steps {
        bend: grain.bend * rules.bend,
        reach: REACH,
    };
    let path = Costs::new(places, list).closed_path(steps)?;
    let both = turns.iter().zip(&path.states);
    Some((both.map(|(&ray, &k)| place(ray, k)).collect(), half))
}
