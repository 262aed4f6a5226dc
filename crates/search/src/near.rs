//! The tethered search: the best curve in a band about the start.

use glam::DVec2;

use crate::band::{Band, bend};
use crate::edges::size;
use crate::path::{Path, Steps};
use crate::rules::Rules;
use crate::view::View;

/// Nodes of the band, and pixels of the window from one state to the next.
const NODES: usize = 160;
pub(crate) const STEP: f64 = 0.6;

/// States that a step may lead.
const REACH: usize = 2;

/// Share of the slope that counts whatever its polarity.
const UNSIGNED: f64 = 0.35;

/// Rounds of learning what the inside looks like.
const ROUNDS: usize = 2;

/// A curve of the tethered search.
pub(crate) struct Near {
    pub points: Vec<DVec2>,
    /// Share of its nodes at either limit of the band.
    pub limited: f64,
}

/// With `tether` as the price of a curve one radius from the start.
pub(crate) fn near(view: &View, rules: &Rules, tether: f64) -> Option<Near> {
    let r = view.radius;
    let (from, to) = (-rules.inward * r, rules.outward * r);
    let band = Band::along(&view.start, NODES, (from, to), STEP);
    let spacing = view.start.length() / NODES as f64;
    let steps = Steps {
        bend: bend(STEP, spacing),
        reach: REACH,
    };
    let unsigned = if view.is_forced() { 0.0 } else { UNSIGNED };
    let mut inside = view.core();
    let mut found: Option<Path> = None;
    for _ in 0..ROUNDS {
        let likelihood = view.likelihood(&inside);
        let costs = band.costs(view, &likelihood, rules.region, |_, k, p, normal| {
            let away = (from + k as f64 * STEP) / r;
            let across = view.edges.across(p, normal);
            let slope = unsigned * size(across) + (1.0 - unsigned) * view.signed(across).max(0.0);
            tether * away * away - view.edges.strength(slope)
        });
        let path = costs.closed_path(steps)?;
        inside = view.inside(&band.curve(&path));
        found = Some(path);
    }
    let path = found?;
    let end = |&&k: &&usize| k == 0 || k + 1 == band.states;
    let limited = path.states.iter().filter(end).count() as f64 / NODES as f64;
    Some(Near {
        points: band.curve(&path),
        limited,
    })
}
