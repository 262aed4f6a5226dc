//! Spacing within bounds: nodes inserted where edges are long, removed where they are short.
//!
//! The bounds lie so far apart that what was just divided is not short and what was just joined is not
//! long; between them nothing happens. So a curve that breathes does not flicker, and a second call at
//! once changes nothing. What cannot be done yet: bounds that differ along the curve.

use crate::error::{check_points, check_positive};
use crate::plan::place;
use crate::{OutlineError, Plan};
use glam::DVec2;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Rounding that does not yet make a length too long or too short.
const ROUNDING: f64 = 1e-9;

/// So near to a node, as a fraction of an edge, that it is the node.
const SNAP: f64 = 1e-12;

/// The most the sizes of a stencil's weights may add up to: 1.25 on even nodes, more where it would swing.
const SWING: f64 = 1.5;

/// Between which lengths edges are left alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Shorter edges lose a node. L.
    pub least: f64,
    /// Longer edges gain some. L. At least [`Bounds::RATIO`] times the least.
    pub most: f64,
    /// No node is removed if fewer would be left.
    pub fewest: usize,
}

impl Bounds {
    /// How many times the least spacing the most must be: half of an edge too long is then well above the least.
    pub const RATIO: f64 = 2.5;

    /// From half to one and a half of a spacing, and never fewer than eight nodes.
    #[must_use]
    pub fn around(spacing: f64) -> Self {
        Self {
            least: 0.5 * spacing,
            most: 1.5 * spacing,
            fewest: 8,
        }
    }
}

/// Where a new node stands between old ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Between {
    /// On the cubic through the two nodes before and the two after; at an open end the parabola through
    /// three. Fourth order on a smooth curve. Where uneven spacing would make it swing, on the chord.
    #[default]
    Cubic,
    /// On the chord.
    Chord,
}

/// How to bring all edges of a curve within bounds.
///
/// First every edge below the least loses one of its nodes, the shortest edge first: the node that lies
/// nearer to the chord of its neighbours. Then every edge above the most is divided evenly into as few
/// parts as will do. Other nodes are not moved. `kept` lists nodes that must stay (pinned ones, corners);
/// so do the ends of an open curve. Afterwards all edges are within the bounds (to 1e-9), unless kept nodes
/// or the fewest stood in the way, and the same bounds ask for nothing more.
///
/// O(n log n), in the same way however the curve is placed.
///
/// # Errors
/// Fewer than two nodes (three of a closed curve); coordinates that are not finite; bounds not positive,
/// or closer than [`Bounds::RATIO`]; a kept node that is none; more than a million parts of one edge.
pub fn respace(
    nodes: &[DVec2],
    closed: bool,
    bounds: &Bounds,
    between: Between,
    kept: &[usize],
) -> Result<Plan, OutlineError> {
    let least_count = if closed { 3 } else { 2 };
    check_curve(nodes, closed)?;
    check_positive("the least spacing", bounds.least)?;
    check_positive("the most spacing", bounds.most)?;
    if bounds.most < Bounds::RATIO * bounds.least {
        let Bounds { least, most, .. } = *bounds;
        return Err(OutlineError::NarrowBounds { least, most });
    }
    let mut locked = vec![false; nodes.len()];
    for &node in kept {
        let needed = node.saturating_add(1);
        *locked.get_mut(node).ok_or(OutlineError::TooFewNodes {
            what: "a list of kept nodes",
            needed,
            got: nodes.len(),
        })? = true;
    }
    if !closed {
        locked[0] = true;
        locked[nodes.len() - 1] = true;
    }
    let fewest = bounds.fewest.max(least_count);
    let left = remove(
        nodes,
        closed,
        bounds.least * (1.0 - ROUNDING),
        fewest,
        &locked,
    );
    let mut plan = Plan::new(nodes.len());
    plan.removed = nodes.len() - left.len();
    let polygon: Vec<DVec2> = left.iter().map(|&i| nodes[i]).collect();
    let curve = Curve {
        nodes: &polygon,
        closed,
        between,
    };
    for (k, &i) in left.iter().enumerate() {
        plan.push_both(&[(place(i), 1.0)]);
        if k + 1 < left.len() || closed {
            let (parts, way) = curve.parts(k, bounds)?;
            for part in 1..parts {
                let t = part as f64 / parts as f64;
                let old = |terms: &Stencil| terms.map(|(j, w)| (place(left[j]), w));
                plan.drawn.push(&old(&curve.stencil(k, t, way)));
                plan.poured.push(&old(&curve.stencil(k, t, Between::Chord)));
                plan.inserted += 1;
            }
        }
    }
    Ok(plan)
}

/// How to space `count` nodes evenly along a curve.
///
/// Even in the length of the polygon. Ends stay. On a closed curve with as many nodes as before, the row
/// starts where nodes slide least; otherwise at node 0. `positions` may be any curve with the old nodes:
/// the rest shape, say, to space that evenly and let the present shape follow.
///
/// O(n). Even arcs of the polygon are even chords up to the square of the turn at a node; a second call
/// takes out most of the rest.
///
/// # Errors
/// Fewer than two nodes (three of a closed curve), before or after; coordinates that are not finite; a
/// curve without length.
pub fn slide(
    positions: &[DVec2],
    closed: bool,
    count: usize,
    between: Between,
) -> Result<Plan, OutlineError> {
    check_curve(positions, closed)?;
    let needed = if closed { 3 } else { 2 };
    if count < needed {
        return Err(OutlineError::TooFewNodes {
            what: "a curve",
            needed,
            got: count,
        });
    }
    let curve = Curve {
        nodes: positions,
        closed,
        between,
    };
    let n = positions.len();
    let edges = if closed { n } else { n - 1 };
    let mut starts = vec![0.0; edges + 1];
    for k in 0..edges {
        starts[k + 1] = starts[k] + curve.length(k);
    }
    let total = starts[edges];
    if total <= 0.0 {
        return Err(OutlineError::NoLength { at: positions[0] });
    }
    let step = total / if closed { count } else { count - 1 } as f64;
    // the mean of how far each node is ahead of its even place
    let ahead: f64 = (0..n).map(|i| starts[i] - i as f64 * step).sum::<f64>() / n as f64;
    let phase = if closed && count == n {
        ahead.clamp(-step, step)
    } else {
        0.0
    };
    let mut plan = Plan::new(n);
    for i in 0..count {
        let s = phase + i as f64 * step;
        let s = if closed { s.rem_euclid(total) } else { s };
        let k = starts.partition_point(|&start| start <= s).clamp(1, edges) - 1;
        let length = starts[k + 1] - starts[k];
        let t = if length > 0.0 {
            ((s - starts[k]) / length).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let t = if (t - t.round()).abs() < SNAP {
            t.round()
        } else {
            t
        };
        let old = |terms: &Stencil| terms.map(|(j, w)| (place(j), w));
        plan.drawn.push(&old(&curve.stencil(k, t, between)));
        plan.poured.push(&old(&curve.stencil(k, t, Between::Chord)));
    }
    plan.inserted = count.saturating_sub(n);
    plan.removed = n.saturating_sub(count);
    Ok(plan)
}

fn check_curve(nodes: &[DVec2], closed: bool) -> Result<(), OutlineError> {
    let needed = if closed { 3 } else { 2 };
    if nodes.len() < needed {
        return Err(OutlineError::TooFewNodes {
            what: "a curve",
            needed,
            got: nodes.len(),
        });
    }
    check_points("node", nodes)
}

/// Which nodes are left once no edge is shorter than the least, in order.
fn remove(nodes: &[DVec2], closed: bool, least: f64, fewest: usize, locked: &[bool]) -> Vec<usize> {
    let n = nodes.len();
    let mut next: Vec<usize> = (1..=n).map(|i| i % n).collect();
    let mut before: Vec<usize> = (0..n).map(|i| (i + n - 1) % n).collect();
    let mut alive = vec![true; n];
    let mut count = n;
    let length = |i: usize, j: usize| nodes[i].distance(nodes[j]);
    // lengths are positive, so their bits sort as they do
    let entry = |i: usize, j: usize| Reverse((length(i, j).to_bits(), i, j));
    let edges = if closed { n } else { n - 1 };
    let mut short: BinaryHeap<_> = (0..edges)
        .filter(|&i| length(i, next[i]) < least)
        .map(|i| entry(i, next[i]))
        .collect();
    while let Some(Reverse((_, i, j))) = short.pop() {
        if count <= fewest {
            break;
        }
        if !alive[i] || !alive[j] || next[i] != j {
            continue;
        }
        let aside = |k: usize| {
            let (a, b) = (nodes[before[k]], nodes[next[k]]);
            (nodes[k] - a).perp_dot(b - a).abs() / a.distance(b)
        };
        let gone = match (locked[i], locked[j]) {
            (true, true) => continue,
            (true, false) => j,
            (false, true) => i,
            (false, false) if aside(i) < aside(j) => i,
            (false, false) => j,
        };
        let (a, b) = (before[gone], next[gone]);
        (next[a], before[b]) = (b, a);
        alive[gone] = false;
        count -= 1;
        if length(a, b) < least {
            short.push(entry(a, b));
        }
    }
    (0..n).filter(|&i| alive[i]).collect()
}

/// Four nodes and their weights; those not used weigh nothing.
type Stencil = [(usize, f64); 4];

/// A curve to stand between the nodes of.
struct Curve<'a> {
    nodes: &'a [DVec2],
    closed: bool,
    between: Between,
}

impl Curve<'_> {
    fn node(&self, i: usize) -> usize {
        if i >= self.nodes.len() {
            i - self.nodes.len()
        } else {
            i
        }
    }

    fn length(&self, edge: usize) -> f64 {
        self.nodes[edge].distance(self.nodes[self.node(edge + 1)])
    }

    /// Into how many parts an edge must fall, and whether along the cubic or the chord.
    fn parts(&self, edge: usize, bounds: &Bounds) -> Result<(usize, Between), OutlineError> {
        const MANY: f64 = 1e6;
        let (length, most) = (self.length(edge), bounds.most * (1.0 + ROUNDING));
        let parts = (length / most).ceil().max(1.0);
        if parts > MANY {
            return Err(OutlineError::BadNumber {
                name: "the longest edge over the most spacing",
                bound: "at most a million",
                value: parts,
            });
        }
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "1 to a million"
        )]
        let parts = parts as usize;
        if parts == 1 || self.between == Between::Chord {
            return Ok((parts, Between::Chord));
        }
        // the cubic is a little longer than its chord, and not quite evenly so
        for parts in parts..=parts + 1 {
            let at = |part: usize| self.at(edge, part as f64 / parts as f64);
            let fits = (0..parts).all(|part| {
                let length = at(part).distance(at(part + 1));
                (bounds.least..=bounds.most).contains(&length)
            });
            if fits {
                return Ok((parts, Between::Cubic));
            }
        }
        Ok((parts, Between::Chord))
    }

    fn at(&self, edge: usize, t: f64) -> DVec2 {
        let stencil = self.stencil(edge, t, Between::Cubic);
        let base = self.nodes[stencil[0].0];
        stencil[1..]
            .iter()
            .fold(base, |sum, &(i, w)| sum + w * (self.nodes[i] - base))
    }

    /// The weights of a point some way along an edge.
    fn stencil(&self, edge: usize, t: f64, between: Between) -> Stencil {
        let (n, from, to) = (self.nodes.len(), edge, self.node(edge + 1));
        let chord = [(from, 1.0 - t), (to, t), (from, 0.0), (to, 0.0)];
        if between == Between::Chord || t <= 0.0 || t >= 1.0 {
            return chord;
        }
        let before = if edge > 0 {
            Some(edge - 1)
        } else {
            self.closed.then_some(n - 1)
        };
        let after = if edge + 2 < n || self.closed {
            Some((edge + 2) % n)
        } else {
            None
        };
        let h = self.length(edge);
        // chord lengths as the parameter, from the start of this edge
        let mut knots = [(from, 0.0); 4];
        knots[1] = (to, h);
        let mut count = 2;
        if let Some(i) = before.filter(|&i| i != to) {
            knots[count] = (i, -self.nodes[i].distance(self.nodes[from]));
            count += 1;
        }
        if let Some(i) = after.filter(|&i| i != from && Some(i) != before) {
            knots[count] = (i, h + self.nodes[to].distance(self.nodes[i]));
            count += 1;
        }
        let s = t * h;
        let mut out = chord;
        let mut swing = 0.0;
        for k in 0..count {
            let (i, own) = knots[k];
            let factor = |&(_, other): &(usize, f64)| (s - other) / (own - other);
            let others = knots[..count].iter().enumerate().filter(|(j, _)| *j != k);
            let weight: f64 = others.map(|(_, knot)| factor(knot)).product();
            out[k] = (i, weight);
            swing += weight.abs();
        }
        // not a number where nodes coincide
        if swing <= SWING { out } else { chord }
    }
}

#[cfg(test)]
mod tests;
