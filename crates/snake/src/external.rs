//! What acts on a snake from outside.

use std::sync::Arc;

use elastic::{Bound, Profile};
use field::ForceField;
use glam::DVec2;
use integrator::{Fault, FaultKind};

use crate::error::finite_at_least;
use crate::{SnakeError, Wall, WallLaw};

/// How the force of a picture is read between its pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sampling {
    /// Bilinear in the four pixels around; the position is clamped to the picture.
    Bilinear,
    /// The report's rule: along one axis only, from the rounded pixel, and a fault off the picture
    /// (D51, D54).
    OneAxis,
}

/// The force field of a picture, felt by the nodes.
#[derive(Debug, Clone)]
pub struct ImageForce {
    /// The field; shared, since it is large and never changes.
    pub field: Arc<ForceField>,
    /// How it is read.
    pub sampling: Sampling,
    /// Weight along the curve, 1 for the field as it is. Dimensionless.
    pub weight: Profile,
}

impl ImageForce {
    /// Force on a node at `p`, without the weight.
    ///
    /// # Errors
    ///
    /// [`FaultKind::OutsideField`] under the report's rule off the picture;
    /// [`FaultKind::NotFinite`] if `p` is no place.
    pub fn at(&self, node: usize, p: DVec2) -> Result<DVec2, Fault> {
        let fault = |kind| Fault { node, at: p, kind };
        match self.sampling {
            Sampling::Bilinear if p.is_finite() => Ok(self.field.at(p)),
            Sampling::Bilinear => Err(fault(FaultKind::NotFinite)),
            Sampling::OneAxis => self
                .field
                .at_report(p)
                .map_err(|_| fault(FaultKind::OutsideField)),
        }
    }
}

/// One force from outside. All are per unit of arc length.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum External {
    /// A uniform acceleration `g`: force `μ g` on every node. L T⁻².
    Gravity(DVec2),
    /// A picture's force field.
    Image(ImageForce),
}

/// Everything a snake lives among: forces and walls, any number of each.
#[derive(Debug, Clone, Default)]
pub struct World {
    /// The forces; they add up.
    pub externals: Vec<External>,
    /// The walls, applied in this order.
    pub walls: Vec<Wall>,
}

impl World {
    /// The same world with a uniform acceleration.
    #[must_use]
    pub fn with_gravity(mut self, g: DVec2) -> Self {
        self.externals.push(External::Gravity(g));
        self
    }

    /// The same world with a picture's field, weight 1.
    #[must_use]
    pub fn with_image(mut self, field: Arc<ForceField>, sampling: Sampling) -> Self {
        let weight = Profile::Uniform(1.0);
        self.externals.push(External::Image(ImageForce {
            field,
            sampling,
            weight,
        }));
        self
    }

    /// The same world with one more wall.
    #[must_use]
    pub fn with_wall(mut self, wall: Wall) -> Self {
        self.walls.push(wall);
        self
    }

    /// The first image force, if there is one.
    #[must_use]
    pub fn image(&self) -> Option<&ImageForce> {
        self.externals.iter().find_map(|external| match external {
            External::Image(image) => Some(image),
            External::Gravity(_) => None,
        })
    }

    /// Stiffness and damping that penalty walls may add to one node: in a corner they add up.
    #[must_use]
    pub fn contact_stiffness(&self) -> (f64, f64) {
        self.walls
            .iter()
            .fold((0.0, 0.0), |(k, c), wall| match wall.law() {
                WallLaw::Penalty { stiffness, damping } => (k + stiffness, c + damping),
                WallLaw::Clamp | WallLaw::Impact { .. } => (k, c),
            })
    }

    /// Check every value against a body of `n` nodes.
    ///
    /// # Errors
    ///
    /// The first one that will not do, by name.
    pub fn validate(&self, n: usize) -> Result<(), SnakeError> {
        for external in &self.externals {
            match external {
                External::Gravity(g) => {
                    finite_at_least("gravity", f64::MIN, "an acceleration", g.x)?;
                    finite_at_least("gravity", f64::MIN, "an acceleration", g.y)?;
                }
                External::Image(image) => {
                    image
                        .weight
                        .validate("image weight", n, Bound::AtLeast(0.0))?;
                }
            }
        }
        Ok(())
    }
}
