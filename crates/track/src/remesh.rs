//! More nodes for a curve that has grown, fewer for one that has shrunk; all that nodes have learnt is carried over.

use crate::body::{Body, NODES, SPACING};
use crate::ring;

/// Distances of nodes at which their number changes, as times of the usual one.
const WIDEST: f64 = 1.5;
const NARROWEST: f64 = 0.6;

impl Body {
    /// Change the number of nodes where their distance asks for it; returns whether it did.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped counts"
    )]
    pub(crate) fn remesh(&mut self) -> bool {
        let n = self.curve.len();
        let length = elastic::length(&self.curve, true);
        let spacing = length / n as f64 / SPACING;
        let count = (length / SPACING).round().clamp(NODES[0], NODES[1]) as usize;
        if (NARROWEST..=WIDEST).contains(&spacing) || count == n {
            return false;
        }
        let (curve, places) = ring::evenly(&self.curve, count);
        self.curve = curve;
        self.respaced(&places);
        true
    }
}
