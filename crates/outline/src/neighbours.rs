//! Who is near whom: stretches of other curves, and far stretches of the same one, around every node.
//!
//! All edges of all curves are filed in one grid, in the same memory each time. For every node a list is kept of the
//! edges within reach and a margin more ([verlet67]); as long as no node has moved by half the margin the lists hold
//! all that can be within reach, and the grid is not built again. What is found is the same with lists and without.
//! What cannot be done yet: a sweep through the time of a step; a node that passes through a curve within one step is
//! seen on the other side.

use crate::error::{check_not_negative, check_points};
use crate::grid::Grid;
use crate::segments::{Segment, push_curve, side};
use crate::{OutlineError, Spot};
use glam::DVec2;

/// The nearest point of an edge within reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Near {
    /// Which curve, in the order they were filed.
    pub curve: usize,
    /// Where on it.
    pub spot: Spot,
    /// Where that is. L.
    pub at: DVec2,
    /// How far. L.
    pub distance: f64,
    /// +1 outside of a closed curve of positive area, −1 inside, 0 on it: as the nearest point of *this*
    /// edge says it. The nearest of a whole curve says it truly.
    pub side: f64,
    /// Unit vector from the curve outwards, through the point asked about if that is not on the curve.
    pub outward: DVec2,
}

impl Near {
    /// Distance with its sign: negative inside. L.
    #[must_use]
    pub fn signed(&self) -> f64 {
        if self.side < 0.0 {
            -self.distance
        } else {
            self.distance
        }
    }
}

/// Edges of many curves, filed by where they are.
#[derive(Debug, Clone, Default)]
pub struct Neighbours {
    grid: Grid,
    segments: Vec<Segment>,
    nodes: Vec<DVec2>,
    /// For each curve: its first node, how many, whether it is closed.
    curves: Vec<(usize, usize, bool)>,
    lists: Lists,
}

/// For every node the segments that may be within reach, and for how long that holds.
#[derive(Debug, Clone, Default)]
struct Lists {
    /// What the grid and the lists were made for: the curves, the number of segments, the nodes, the reach.
    curves: Vec<(usize, usize, bool)>,
    segments: usize,
    origin: Vec<DVec2>,
    reach: f64,
    /// Where the list of each node starts in `items`; empty where there are no lists.
    starts: Vec<u32>,
    items: Vec<u32>,
    /// Whether edges have been filed before: who files them once needs no lists.
    again: bool,
    /// How often the present lists have served, and how many builds go without lists because the last did not last.
    served: u64,
    without: u32,
}

/// The margin of the lists, as a share of the reach.
const MARGIN: f64 = 0.5;

/// Builds without lists after lists that served no second time: curves that move too fast for them.
const WITHOUT: u32 = 8;

impl Neighbours {
    /// Files the edges of the curves, each with whether it is closed; forgets those filed before.
    ///
    /// `reach` is the distance that will usually be asked about, and only a matter of speed. Linear in the
    /// nodes. Allocates nothing once the memory has grown to what is needed.
    ///
    /// # Errors
    /// Coordinates that are not finite or beyond 1e75; a reach that is negative; more than 2³¹ nodes. Nothing is
    /// filed then.
    pub fn rebuild<'a>(
        &mut self,
        curves: impl IntoIterator<Item = (&'a [DVec2], bool)>,
        reach: f64,
    ) -> Result<(), OutlineError> {
        self.segments.clear();
        self.nodes.clear();
        self.curves.clear();
        let filed = self.file(curves, reach);
        if filed.is_err() {
            self.segments.clear();
            self.nodes.clear();
            self.curves.clear();
        }
        if self.lists_hold(reach) {
            self.lists.served += 1;
            return filed;
        }
        self.grid.build(&self.segments, reach);
        self.list(reach);
        filed
    }

    /// Whether the grid and the lists, made for nodes that were elsewhere, still hold all that may be within reach.
    fn lists_hold(&self, reach: f64) -> bool {
        let Lists {
            curves,
            segments,
            origin,
            starts,
            reach: listed,
            ..
        } = &self.lists;
        // an edge of no length is not filed, which numbers the segments anew
        let same = !starts.is_empty()
            && listed.to_bits() == reach.to_bits()
            && *curves == self.curves
            && *segments == self.segments.len();
        let most = 0.25 * MARGIN * MARGIN * reach * reach;
        let stays = |(p, q): (&DVec2, &DVec2)| p.distance_squared(*q) < most;
        same && self
            .nodes
            .iter()
            .zip(origin)
            .fold(true, |all, pair| all & stays(pair))
    }

    /// Make the lists, unless curves move too fast for them or an edge has no length.
    #[allow(clippy::cast_possible_truncation, reason = "the door counts the nodes")]
    fn list(&mut self, reach: f64) {
        let edges = |&(_, count, closed): &(usize, usize, bool)| {
            if closed {
                count
            } else {
                count.saturating_sub(1)
            }
        };
        let whole: usize = self.curves.iter().map(edges).sum();
        let lists = &mut self.lists;
        let short = !lists.starts.is_empty() && lists.served == 0;
        lists.without = if short {
            WITHOUT
        } else {
            lists.without.saturating_sub(1)
        };
        lists.starts.clear();
        lists.items.clear();
        lists.served = 0;
        let first = !std::mem::replace(&mut lists.again, true);
        if first || lists.without > 0 || whole != self.segments.len() || reach <= 0.0 {
            return;
        }
        lists.curves.clone_from(&self.curves);
        lists.segments = self.segments.len();
        lists.origin.clone_from(&self.nodes);
        lists.reach = reach;
        let wide = (1.0 + MARGIN) * reach;
        let mut near: Vec<u32> = Vec::new();
        for &p in &self.nodes {
            lists.starts.push(lists.items.len() as u32);
            near.clear();
            let room = DVec2::splat(wide * (1.0 + 1e-9)) + 1e-15 * p.abs();
            self.grid.visit_box(p - room, p + room, |k| {
                let squared = self.segments[k as usize].nearest(p).squared;
                // a little more than the margin, for rounding
                if squared <= wide * wide * (1.0 + 1e-9) {
                    near.push(k);
                }
            });
            near.sort_unstable();
            near.dedup();
            lists.items.extend_from_slice(&near);
            if lists.items.len() > (u32::MAX / 2) as usize {
                lists.starts.clear();
                return;
            }
        }
        lists.starts.push(lists.items.len() as u32);
    }

    fn file<'a>(
        &mut self,
        curves: impl IntoIterator<Item = (&'a [DVec2], bool)>,
        reach: f64,
    ) -> Result<(), OutlineError> {
        check_not_negative("the reach", reach)?;
        for (nodes, closed) in curves {
            check_points("node", nodes)?;
            push_curve(&mut self.segments, self.curves.len(), nodes, closed);
            self.curves.push((self.nodes.len(), nodes.len(), closed));
            self.nodes.extend_from_slice(nodes);
            if self.nodes.len() > (u32::MAX / 2) as usize {
                return Err(OutlineError::TooManyNodes {
                    got: self.nodes.len(),
                });
            }
        }
        Ok(())
    }

    /// All edges within `reach` of a node, of other curves and of its own beyond `apart` nodes away.
    ///
    /// `found` is cleared and then holds one entry an edge, by curve and edge. An edge of the node's own
    /// curve counts if both its ends are more than `apart` nodes from the node, the shorter way round.
    /// Edges of no length are not filed. A node or curve that is none has no neighbours.
    ///
    /// Exact up to rounding of the distance. Takes the time of what is in the cells around.
    pub fn near_node(
        &self,
        curve: usize,
        node: usize,
        apart: usize,
        reach: f64,
        found: &mut Vec<Near>,
    ) {
        found.clear();
        let Some(&(first, count, closed)) = self.curves.get(curve) else {
            return;
        };
        if node >= count {
            return;
        }
        let far = |other: usize| {
            let steps = other.abs_diff(node);
            let steps = if closed {
                steps.min(count - steps)
            } else {
                steps
            };
            steps > apart
        };
        let wanted = |segment: &Segment| {
            let edge = segment.edge as usize;
            segment.curve as usize != curve || (far(edge) && far((edge + 1) % count))
        };
        let p = self.nodes[first + node];
        let lists = &self.lists;
        let list = (reach <= lists.reach)
            .then(|| lists.starts.get(first + node..first + node + 2))
            .flatten();
        let Some(&[from, to]) = list else {
            return self.collect(p, reach, found, wanted);
        };
        for &k in &lists.items[from as usize..to as usize] {
            self.look(k, p, reach, found, &wanted);
        }
    }

    /// All edges within `reach` of a point, as [`near_node`](Self::near_node); none of one not finite.
    pub fn near_point(&self, p: DVec2, reach: f64, found: &mut Vec<Near>) {
        found.clear();
        self.collect(p, reach, found, |_| true);
    }

    fn collect(
        &self,
        p: DVec2,
        reach: f64,
        found: &mut Vec<Near>,
        wanted: impl Fn(&Segment) -> bool,
    ) {
        if !p.is_finite() || reach.is_nan() || reach < 0.0 {
            return;
        }
        // a little more, so that what is just within reach is not cut off by the rounding of a corner; and what nodes
        // may have moved since the grid was built
        let moved = if self.lists.starts.is_empty() {
            0.0
        } else {
            0.5 * MARGIN * self.lists.reach
        };
        let room = DVec2::splat((reach + moved) * (1.0 + 1e-12)) + 1e-15 * p.abs();
        self.grid.visit_box(p - room, p + room, |k| {
            self.look(k, p, reach, found, &wanted);
        });
        // cells share edges: the same one may be there more than once
        found.sort_unstable_by_key(|near| (near.curve, near.spot.edge));
        found.dedup_by_key(|near| (near.curve, near.spot.edge));
    }

    /// Add segment `k` to what is found, if it is wanted and within reach.
    fn look(
        &self,
        k: u32,
        p: DVec2,
        reach: f64,
        found: &mut Vec<Near>,
        wanted: &impl Fn(&Segment) -> bool,
    ) {
        let segment = &self.segments[k as usize];
        if !wanted(segment) {
            return;
        }
        let nearest = segment.nearest(p);
        if nearest.squared > reach * reach || nearest.squared.is_nan() {
            return;
        }
        let spot = Spot {
            edge: segment.edge as usize,
            along: nearest.along,
        };
        let distance = nearest.squared.sqrt();
        let side = side(&self.segments, k, &nearest, p);
        let away = (p - nearest.at) / distance;
        let outward = if away.is_finite() && side.abs() > 0.0 {
            side * away
        } else {
            segment.normal()
        };
        found.push(Near {
            curve: segment.curve as usize,
            spot,
            at: nearest.at,
            distance,
            side,
            outward,
        });
    }
}

/// Leaves of each curve the nearest entry only; of equals the first.
///
/// Its side is then the truth about the point, if its reach did not end before. `found` is as
/// [`Neighbours::near_node`] leaves it.
pub fn keep_nearest(found: &mut Vec<Near>) {
    found.dedup_by(|next, kept| {
        let same = next.curve == kept.curve;
        if same && next.distance < kept.distance {
            *kept = *next;
        }
        same
    });
}

#[cfg(test)]
mod tests;
