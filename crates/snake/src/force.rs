//! Forces from outside: what they are asked, and the world's list of them.

mod acting;
mod curve;
mod edge;
mod freeze;
mod gravity;
mod image;
mod path;
mod pressure;
mod region;
mod repulsor;
mod spring;
mod turned;

pub use acting::Acting;
pub use curve::Curve;
pub use edge::SignedEdgeForce;
pub use freeze::Freeze;
pub use gravity::Gravity;
pub use image::{ImageForce, Sampling};
pub use path::Path;
pub use pressure::Pressure;
pub use region::RegionForce;
pub use repulsor::Repulsor;
pub use spring::Spring;
pub use turned::Turned;

use std::any::Any;
use std::fmt;

use glam::{DMat2, DVec2};
use integrator::Fault;

use crate::SnakeError;

/// How stiff a force may become at one node, for step limits.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pull {
    /// The largest −∂f/∂x along any direction. M T⁻².
    pub stiffness: f64,
    /// The largest −∂f/∂v. M T⁻¹.
    pub damping: f64,
}

/// A force on the nodes of a snake from outside, per unit of arc length at rest.
///
/// A world holds any number of them, each with a weight along the curve ([`Acting`]). A new kind
/// needs no change anywhere else: what it answers here is all that a run, its ledger and its
/// certificate ask.
pub trait Force: fmt::Debug + Send + Sync {
    /// The word for it: its column in the ledger.
    fn name(&self) -> &'static str;

    /// Add the force on every node to `force`.
    ///
    /// # Errors
    ///
    /// A [`Fault`] at the first node at which the force has no value.
    fn add(&mut self, curve: &Curve<'_>, force: &mut [DVec2]) -> Result<(), Fault>;

    /// Settle what depends on the curve that a run begins with, unless it is settled; by default nothing does.
    fn settle(&mut self, curve: &Curve<'_>) {
        let _ = curve;
    }

    /// Add ∂fᵢ/∂xᵢ of every node to `slope`; false, with `slope` as it was, where it is not known.
    fn add_slope(&mut self, curve: &Curve<'_>, slope: &mut [DMat2]) -> bool {
        let _ = (curve, slope);
        false
    }

    /// The energy `E` of the whole curve with `h f = −∂E/∂x`, if there is one. M L³ T⁻².
    ///
    /// It may not change with time by itself: what moves or fades is booked as work.
    fn energy(&self, curve: &Curve<'_>) -> Option<f64> {
        let _ = curve;
        None
    }

    /// Whether the force is the same whatever place, velocity and time.
    fn is_constant(&self) -> bool {
        false
    }

    /// Whether the force depends on the velocities of the nodes.
    fn depends_on_velocity(&self) -> bool {
        true
    }

    /// Bounds of its slopes for nodes of that spacing at rest: at `curve`, or anywhere without one.
    ///
    /// Where the force on a node depends on others ([`Force::couples`]), of all its slopes together.
    fn pull(&self, spacing: f64, curve: Option<&Curve<'_>>) -> Pull {
        let _ = (spacing, curve);
        Pull::default()
    }

    /// How stiff it is whatever the curve does, for step limits: of elastic forces that are in no matrix. M T⁻².
    fn stiffness(&self) -> f64 {
        0.0
    }

    /// Whether the force on a node depends on where others are, so that [`Force::add_slope`] is not
    /// all of its slope and an implicit scheme has a largest step.
    fn couples(&self) -> bool {
        false
    }

    /// Whether it means nothing on an open curve.
    fn needs_closed(&self) -> bool {
        false
    }

    /// Check every value against a curve of `n` nodes.
    ///
    /// # Errors
    ///
    /// The first one that will not do, by name.
    fn validate(&self, n: usize) -> Result<(), SnakeError> {
        let _ = n;
        Ok(())
    }

    /// The curve has other nodes, made of the old ones as `plan` says: for forces that know nodes by
    /// their numbers.
    fn carry(&mut self, plan: &outline::Plan) {
        let _ = plan;
    }

    /// The same force once more.
    fn boxed(&self) -> Box<dyn Force>;

    /// Itself, for those who look for a kind they know.
    fn as_any(&self) -> &dyn Any;
}

impl Clone for Box<dyn Force> {
    fn clone(&self) -> Self {
        self.boxed()
    }
}

/// The largest eigenvalue of −½ (J + Jᵀ), at least 0.
pub(crate) fn push_back(slope: DMat2) -> f64 {
    let (a, d) = (-slope.x_axis.x, -slope.y_axis.y);
    let b = -0.5 * (slope.x_axis.y + slope.y_axis.x);
    (0.5 * (a + d) + (0.5 * (a - d)).hypot(b)).max(0.0)
}

/// A fault at the first node that is no place.
pub(crate) fn nowhere(x: &[DVec2]) -> Option<Fault> {
    let node = x.iter().position(|p| !p.is_finite())?;
    Some(Fault {
        node,
        at: x[node],
        kind: integrator::FaultKind::NotFinite,
    })
}
