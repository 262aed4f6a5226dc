//! A uniform acceleration.

use std::any::Any;

use glam::DVec2;
use integrator::Fault;

use super::{Curve, Force};
use crate::SnakeError;
use crate::error::finite_at_least;

/// A uniform acceleration `g`: force `μ g` on every node. L T⁻².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gravity(pub DVec2);

impl Force for Gravity {
    fn name(&self) -> &'static str {
        "gravity"
    }

    fn add(&mut self, curve: &Curve<'_>, force: &mut [DVec2]) -> Result<(), Fault> {
        for (f, &mass) in force.iter_mut().zip(curve.mass) {
            *f += self.0 * mass;
        }
        Ok(())
    }

    /// `−h Σ μ g·x`.
    fn energy(&self, curve: &Curve<'_>) -> Option<f64> {
        let mut energy = 0.0;
        for (&x, &mass) in curve.x.iter().zip(curve.mass) {
            energy -= curve.spacing * mass * self.0.dot(x);
        }
        Some(energy)
    }

    fn is_constant(&self) -> bool {
        true // but for a schedule of the mass, of which the schemes are told
    }

    fn validate(&self, _n: usize) -> Result<(), SnakeError> {
        finite_at_least("gravity", f64::MIN, "an acceleration", self.0.x)?;
        finite_at_least("gravity", f64::MIN, "an acceleration", self.0.y)?;
        Ok(())
    }

    fn depends_on_velocity(&self) -> bool {
        false
    }

    fn boxed(&self) -> Box<dyn Force> {
        Box::new(*self)
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
