//! A spring from a point of the curve to a point in space, as with the mouse in [kass88].

use std::any::Any;

use glam::{DMat2, DVec2};
use integrator::Fault;
use outline::Plan;

use super::{Curve, Force, Path, Pull};
use crate::SnakeError;
use crate::error::finite_at_least;

/// A spring and a damper from a point of the curve to a point in space, which may move.
///
/// ```text
/// p = (1 − w) x[i] + w x[i+1],   F = k (q − p) − c (ṗ − q̇)
/// f[i] = (1 − w) F / h,   f[i+1] = w F / h                  E = ½ k |p − q|²
/// ```
///
/// k is the stiffness of the whole spring, M L T⁻², and c its damper, M L T⁻¹: the pull on the curve
/// does not depend on the number of nodes. There is an energy while q stays and c is 0; otherwise the
/// work is booked.
///
/// \[kass88\]
#[derive(Debug, Clone, PartialEq)]
pub struct Spring {
    node: usize,
    share: f64,
    target: Path,
    stiffness: f64,
    damping: f64,
    name: &'static str,
}

impl Spring {
    /// A spring from node `node` to `target`.
    #[must_use]
    pub fn at_node(node: usize, target: impl Into<Path>, stiffness: f64) -> Self {
        Self {
            node,
            share: 0.0,
            target: target.into(),
            stiffness,
            damping: 0.0,
            name: "spring",
        }
    }

    /// A spring from the point of the curve through `nodes` that is nearest to `from`. O(n), once:
    /// afterwards it stays at that point of the material.
    ///
    /// # Errors
    ///
    /// Refused: fewer than two nodes, a position that is not finite.
    pub fn at_nearest(
        nodes: &[DVec2],
        closed: bool,
        from: DVec2,
        target: impl Into<Path>,
        stiffness: f64,
    ) -> Result<Self, SnakeError> {
        crate::error::place("the place of a grip", from)?;
        if nodes.len() < 2 {
            let (needed, got) = (2, nodes.len());
            return Err(SnakeError::TooFewNodes { needed, got });
        }
        let edges = if closed { nodes.len() } else { nodes.len() - 1 };
        let mut best = (f64::INFINITY, 0, 0.0);
        for i in 0..edges {
            let (a, b) = (nodes[i], nodes[(i + 1) % nodes.len()]);
            let along = (from - a).dot(b - a) / (b - a).length_squared();
            // an edge of no length is its first node
            let along = if along.is_finite() {
                along.clamp(0.0, 1.0)
            } else {
                0.0
            };
            let away = (a + along * (b - a)).distance_squared(from);
            if away < best.0 {
                best = (away, i, along);
            }
        }
        let (node, share) = if best.2 >= 1.0 {
            ((best.1 + 1) % nodes.len(), 0.0)
        } else {
            (best.1, best.2)
        };
        Ok(Self {
            share,
            ..Self::at_node(node, target, stiffness)
        })
    }

    /// A spring that keeps node `node` where it is among `nodes`. The hard form is
    /// [`Snake::hold`](crate::Snake::hold).
    ///
    /// # Errors
    ///
    /// Refused: no such node.
    pub fn pin(nodes: &[DVec2], node: usize, stiffness: f64) -> Result<Self, SnakeError> {
        let place = nodes.get(node).ok_or(SnakeError::NoSuchNode {
            node,
            nodes: nodes.len(),
        })?;
        let spring = Self::at_node(node, *place, stiffness);
        Ok(Self {
            name: "pin",
            ..spring
        })
    }

    /// The same with a damper. M L T⁻¹.
    #[must_use]
    pub const fn with_damping(mut self, damping: f64) -> Self {
        self.damping = damping;
        self
    }

    /// The node it is at, and how far from there towards the next: 0 to 1.
    #[must_use]
    pub const fn grip(&self) -> (usize, f64) {
        (self.node, self.share)
    }

    /// Where it pulls to.
    #[must_use]
    pub const fn target(&self) -> &Path {
        &self.target
    }

    /// Both nodes with their shares; the second one's may be 0.
    fn ends(&self, n: usize) -> [(usize, f64); 2] {
        [
            (self.node, 1.0 - self.share),
            ((self.node + 1) % n, self.share),
        ]
    }

    /// From the curve to the target, and how fast that grows.
    fn gap(&self, curve: &Curve<'_>) -> (DVec2, DVec2) {
        let (mut gap, mut growth) = self.target.at(curve.t);
        for (i, share) in self.ends(curve.x.len()) {
            gap -= share * curve.x[i];
            growth -= share * curve.velocity(i);
        }
        (gap, growth)
    }
}

impl Force for Spring {
    fn name(&self) -> &'static str {
        self.name
    }

    fn add(&mut self, curve: &Curve<'_>, force: &mut [DVec2]) -> Result<(), Fault> {
        let (gap, growth) = self.gap(curve);
        let pull = (self.stiffness * gap + self.damping * growth) / curve.spacing;
        for (i, share) in self.ends(curve.x.len()) {
            force[i] += share * pull;
        }
        Ok(())
    }

    /// Of each of both nodes alone: what one does to the other is left out.
    fn add_slope(&mut self, curve: &Curve<'_>, slope: &mut [DMat2]) -> bool {
        for (i, share) in self.ends(curve.x.len()) {
            let back = share * share * self.stiffness / curve.spacing;
            slope[i] -= DMat2::from_diagonal(DVec2::splat(back));
        }
        true
    }

    fn energy(&self, curve: &Curve<'_>) -> Option<f64> {
        let lossless = self.damping == 0.0 && self.target.is_still();
        lossless.then(|| 0.5 * self.stiffness * self.gap(curve).0.length_squared())
    }

    fn pull(&self, spacing: f64, _curve: Option<&Curve<'_>>) -> Pull {
        // of both nodes together: the square of the length of (1 − w, w)
        let both = self.share * self.share + (1.0 - self.share) * (1.0 - self.share);
        Pull {
            stiffness: both * self.stiffness / spacing,
            damping: both * self.damping / spacing,
        }
    }

    fn couples(&self) -> bool {
        self.share > 0.0
    }

    fn validate(&self, n: usize) -> Result<(), SnakeError> {
        if self.node >= n {
            let (node, nodes) = (self.node, n);
            return Err(SnakeError::NoSuchNode { node, nodes });
        }
        finite_at_least("a spring's stiffness", 0.0, "at least 0", self.stiffness)?;
        finite_at_least("a spring's damping", 0.0, "at least 0", self.damping)?;
        self.target.validate("a spring's target")
    }

    /// To the nearest of the new nodes; a grip of whose nodes nothing is left lets go.
    fn carry(&mut self, plan: &Plan) {
        let (near, n) = (self.share.round(), plan.old_len().max(1));
        let node = if near > 0.0 { self.node + 1 } else { self.node } % n;
        // a node that was left out has its neighbors' heirs
        let around = [0, 1, n - 1, 2, 2 * n - 2].map(|by| (node + by) % n);
        let heir = around.iter().find_map(|&old| heir(plan, old));
        if heir.is_none() {
            (self.stiffness, self.damping) = (0.0, 0.0);
        }
        (self.node, self.share) = (heir.unwrap_or(0), 0.0);
    }

    fn depends_on_velocity(&self) -> bool {
        self.damping > 0.0
    }

    fn boxed(&self) -> Box<dyn Force> {
        Box::new(self.clone())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

/// The new node that has most of an old one.
fn heir(plan: &Plan, old: usize) -> Option<usize> {
    let mut best = (0.0, None);
    for node in 0..plan.len() {
        let of_it = plan
            .convex(node)
            .iter()
            .filter(|(from, _)| *from as usize == old);
        let weight: f64 = of_it.map(|(_, weight)| weight).sum();
        if weight > best.0 {
            best = (weight, Some(node));
        }
    }
    best.1
}
