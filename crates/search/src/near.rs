//! The tethered search: the best curve in a band about the start.

use field::Grid;
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

/// The band about the start, with the strength of the edge at each of its places: the same for every tether.
pub(crate) struct Tethered<'a> {
    view: &'a View,
    rules: &'a Rules,
    band: Band,
    /// Offset of the innermost places from the start.
    from: f64,
    strengths: Vec<f64>,
    /// How much likelier each pixel is inside than outside, before anything is found.
    likelihood: Grid,
}

impl<'a> Tethered<'a> {
    pub(crate) fn new(view: &'a View, rules: &'a Rules) -> Self {
        let r = view.radius;
        let (from, to) = (-rules.inward * r, rules.outward * r);
        let band = Band::along(&view.start, NODES, (from, to), STEP);
        let unsigned = if view.is_forced() { 0.0 } else { UNSIGNED };
        let strength = |node: usize, k: usize| {
            let across = view
                .edges
                .across(band.place(node, k as f64), band.nodes[node].normal);
            let slope = unsigned * size(across) + (1.0 - unsigned) * view.signed(across).max(0.0);
            view.edges.strength(slope)
        };
        let places = (0..NODES).flat_map(|node| (0..band.states).map(move |k| (node, k)));
        let strengths = places.map(|(node, k)| strength(node, k)).collect();
        Self {
            view,
            rules,
            from,
            strengths,
            likelihood: view.likelihood(&view.core()),
            band,
        }
    }

    /// The best curve with `tether` as the price of one that is a radius from the start.
    pub(crate) fn best(&self, tether: f64) -> Option<Near> {
        let Self { view, band, .. } = self;
        let r = view.radius;
        let spacing = view.start.length() / NODES as f64;
        let steps = Steps {
            bend: bend(STEP, spacing),
            reach: REACH,
        };
        let searched = |likelihood: &Grid| -> Option<Path> {
            let costs = band.costs(view, likelihood, self.rules.region, |node, k, _, _| {
                let away = (self.from + k as f64 * STEP) / r;
                tether * away * away - self.strengths[node * band.states + k]
            });
            costs.closed_path(steps)
        };
        let mut path = searched(&self.likelihood)?;
        for _ in 1..ROUNDS {
            path = searched(&view.likelihood(&view.inside(&band.curve(&path))))?;
        }
        let end = |&&k: &&usize| k == 0 || k + 1 == band.states;
        let limited = path.states.iter().filter(end).count() as f64 / NODES as f64;
        Some(Near {
            points: band.curve(&path),
            limited,
        })
    }
}
