//! What acts on a snake from outside.

use std::sync::Arc;

use elastic::{Bound, Profile};
use field::{ForceField, Interpolation};
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
    /// Add the weighted force on every node to `force`; `scratch` is as long and overwritten.
    ///
    /// # Errors
    ///
    /// [`FaultKind::OutsideField`] under the report's rule off the picture;
    /// [`FaultKind::NotFinite`] for a node that is no place; by the first such node.
    pub fn add(
        &self,
        x: &[DVec2],
        scratch: &mut [DVec2],
        force: &mut [DVec2],
    ) -> Result<(), Fault> {
        match self.sampling {
            Sampling::Bilinear => {
                self.field.sample_into(x, Interpolation::Bilinear, scratch);
                // a place that is none has a force that is none; found by the sum, once
                if !scratch.iter().sum::<DVec2>().is_finite()
                    && let Some(node) = x.iter().position(|p| !p.is_finite())
                {
                    return Err(Fault {
                        node,
                        at: x[node],
                        kind: FaultKind::NotFinite,
                    });
                }
            }
            Sampling::OneAxis => {
                for (node, (out, &at)) in scratch.iter_mut().zip(x).enumerate() {
                    let fault = |_| Fault {
                        node,
                        at,
                        kind: FaultKind::OutsideField,
                    };
                    *out = self.field.at_report(at).map_err(fault)?;
                }
            }
        }
        match &self.weight {
            Profile::Uniform(weight) => {
                for (f, &sampled) in force.iter_mut().zip(&*scratch) {
                    *f += sampled * *weight;
                }
            }
            Profile::PerNode(weights) => {
                for ((f, &sampled), &weight) in force.iter_mut().zip(&*scratch).zip(weights) {
                    *f += sampled * weight;
                }
            }
        }
        Ok(())
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
