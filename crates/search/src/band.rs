//! A band about a curve, unrolled: what it costs to lead the outline through each place.

use field::Grid;
use glam::DVec2;

use crate::along::{Polygon, sample};
use crate::codebook::unit;
use crate::edges::{dot, size};
use crate::path::{Costs, Path};
use crate::smooth::smoothed;
use crate::view::View;

/// A curve pays for its bends as if nodes and states were at these distances: state, and nodes as times of that.
const BEND: f64 = 0.02;
const SLANT: f64 = 0.35;

/// Normals are smoothed along the curve over this share of the band's width, so that they do not cross.
const CALM: f64 = 0.35;

/// The price of a step between nodes of some distance by one state.
pub(crate) fn bend(step: f64, spacing: f64) -> f64 {
    BEND * (step / spacing / SLANT).powi(2)
}

/// Places of a band: nodes of a curve, and for each a way out along its normal.
#[derive(Debug)]
pub(crate) struct Band {
    /// Where the states of a node lie, from the innermost to the outermost: `from + k · step`.
    pub nodes: Vec<Node>,
    pub states: usize,
}

/// A node of a band.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node {
    /// The innermost place, and the way to the next one.
    pub inner: DVec2,
    pub step: DVec2,
    /// Unit normal of the outline that is looked for.
    pub normal: DVec2,
}

impl Band {
    pub(crate) fn place(&self, node: usize, state: f64) -> DVec2 {
        let node = self.nodes[node];
        node.inner + state * node.step
    }

    pub(crate) fn curve(&self, path: &Path) -> Vec<DVec2> {
        let states = path.states.iter().enumerate();
        states
            .map(|(node, &state)| self.place(node, state as f64))
            .collect()
    }

    /// A band about a curve of given offsets along its normals.
    pub(crate) fn along(curve: &Polygon, count: usize, (from, to): (f64, f64), step: f64) -> Self {
        let even = curve.evenly(count);
        let spacing = even.length() / count as f64;
        let normals = even.normals(CALM * (to - from) / spacing);
        let nodes = even.points.iter().zip(&normals).map(|(p, &normal)| Node {
            inner: *p + from * normal,
            step: step * normal,
            normal,
        });
        let nodes = nodes.collect();
        Self {
            nodes,
            states: count_of(to - from, step),
        }
    }

    /// Costs of all places: `price` of an edge there, less what the inside is worth.
    ///
    /// What is inside of a place is summed from the innermost place on, the last by half.
    pub(crate) fn costs(
        &self,
        view: &View,
        likelihood: &Grid,
        region: f64,
        mut price: impl FnMut(usize, usize, DVec2, DVec2) -> f64,
    ) -> Costs {
        let mut list = Vec::with_capacity(self.nodes.len() * self.states);
        for (i, node) in self.nodes.iter().enumerate() {
            let worth = region * node.step.length() / (0.1 * view.radius);
            let mut gained = 0.0;
            for k in 0..self.states {
                let p = node.inner + k as f64 * node.step;
                let half = 0.5 * worth * sample(likelihood, p);
                gained += half;
                list.push(price(i, k, p, node.normal) - gained);
                gained += half;
            }
        }
        Costs::new(self.states, list)
    }
}

/// States from one end of a range to the other.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a band of some hundred pixels at most"
)]
fn count_of(range: f64, step: f64) -> usize {
    (range / step).round().max(1.0) as usize + 1
}

/// Direction of color across a curve, node by node: inside less outside, smoothed over a twelfth of its length.
pub(crate) fn local_polarity(view: &View, curve: &Polygon) -> Vec<Option<[f64; 3]>> {
    let normals = curve.normals(1.0);
    let count = curve.points.len();
    let mut difference = vec![[0.0; 3]; count];
    for (c, channel) in view.frame.channels.iter().enumerate() {
        let list: Vec<f64> = curve
            .points
            .iter()
            .zip(&normals)
            .map(|(p, normal)| {
                let side = |sign: f64| {
                    let ways = [1.5, 2.5, 3.5].map(|way| sample(channel, *p + sign * way * normal));
                    ways.iter().sum::<f64>() / 3.0
                };
                side(-1.0) - side(1.0)
            })
            .collect();
        for (one, value) in
            difference
                .iter_mut()
                .zip(smoothed(&list, count as f64 / 12.0, curve.closed))
        {
            one[c] = value;
        }
    }
    difference.into_iter().map(unit).collect()
}

/// How much of an edge there is, of the polarity at a place.
pub(crate) fn signed_strength(
    view: &View,
    p: DVec2,
    normal: DVec2,
    polarity: Option<[f64; 3]>,
) -> f64 {
    let across = view.edges.across(p, normal);
    let slope = polarity.map_or_else(|| size(across), |direction| -dot(across, direction));
    view.edges.strength(slope)
}
