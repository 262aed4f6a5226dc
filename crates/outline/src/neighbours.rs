//! Who is near whom: stretches of other curves, and far stretches of the same one, around every node.
//!
//! All edges of all curves are filed in one grid, anew in every step and in the same memory. Whoever asks
//! for a node's neighbours looks at the few cells within reach. What cannot be done yet: a sweep through the
//! time of a step; a node that passes through a curve within one step is seen on the other side.

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
}

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
        self.grid.build(&self.segments, reach);
        filed
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
        self.collect(self.nodes[first + node], reach, found, |segment| {
            let edge = segment.edge as usize;
            segment.curve as usize != curve || (far(edge) && far((edge + 1) % count))
        });
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
        let squared = reach * reach;
        // a little more, so that what is just within reach is not cut off by the rounding of a corner
        let room = DVec2::splat(reach * (1.0 + 1e-12)) + 1e-15 * p.abs();
        self.grid.visit_box(p - room, p + room, |k| {
            let segment = &self.segments[k as usize];
            let nearest = segment.nearest(p);
            if nearest.squared <= squared && wanted(segment) {
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
                let curve = segment.curve as usize;
                found.push(Near {
                    curve,
                    spot,
                    at: nearest.at,
                    distance,
                    side,
                    outward,
                });
            }
        });
        // cells share edges: the same one may be there more than once
        found.sort_unstable_by_key(|near| (near.curve, near.spot.edge));
        found.dedup_by_key(|near| (near.curve, near.spot.edge));
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
