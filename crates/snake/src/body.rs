//! The body: a rest shape, what it is made of, and the frame its deformation is measured in.

use elastic::{Bound, Material, Profile, SpacingRule, Topology};
use glam::DVec2;

use crate::error::finite_at_least;
use crate::{Maps, Schedules, SnakeError, Turn};

/// Where the body frame has its origin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Center {
    /// The plain mean of the nodes: what the report's program takes (D9).
    Mean,
    /// The center of mass, `Σ μᵢ xᵢ / Σ μᵢ`.
    Mass,
}

/// How the body frame enters the elastic force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame {
    /// Its origin.
    pub center: Center,
    /// Whether the force is the energy's gradient, `−Pᵀ K e`, which never pushes the body along,
    /// or `−K e` as the report's program has it, which may (D4, D5).
    pub reaction: bool,
    /// Whether the rest shape turns with the body.
    pub turn: Turn,
}

impl Frame {
    /// As the report's program: plain mean, no reaction.
    #[must_use]
    pub const fn report() -> Self {
        Self {
            center: Center::Mean,
            reaction: false,
            turn: Turn::None,
        }
    }

    /// Center of mass, and the force that is the gradient of the energy; it does not turn.
    #[must_use]
    pub const fn corrected() -> Self {
        Self {
            center: Center::Mass,
            reaction: true,
            turn: Turn::None,
        }
    }

    /// The corrected frame, turning with the body (report §5.2).
    #[must_use]
    pub const fn turning() -> Self {
        Self {
            turn: Turn::Fit,
            ..Self::corrected()
        }
    }
}

/// A curve's body: its shape at rest and everything that resists motion or deformation.
///
/// Dimensions with M the unit of mass density, L the pixel and T the unit of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Closed, or open with its two ends.
    pub topology: Topology,
    /// The rest shape `r`, one offset a node from the body frame's origin. L.
    pub rest: Vec<DVec2>,
    /// Spacing `h` of the nodes at rest. L.
    pub spacing: f64,
    /// ω₀, ω₁, ω₂ along the curve, and the orders above, if any.
    pub material: Material,
    /// μ: mass density. M. Above 0 for every scheme with inertia.
    pub mass: Profile,
    /// γ: damping density. M T⁻¹.
    pub damping: Profile,
    /// β: internal damping, a time that the stiffness is multiplied by. T. It brakes bending and
    /// stretching and leaves rigid motion alone ([`elastic::InternalDamping`]).
    pub internal: f64,
    /// The rules of the body frame.
    pub frame: Frame,
    /// Factors of the parameters as functions of time.
    pub schedules: Schedules,
    /// Factors of the five parameters as functions of place.
    pub maps: Maps,
}

impl Body {
    /// A body of unit mass density at rest in the shape of `nodes`, without elasticity or damping,
    /// in the corrected frame.
    ///
    /// `mass` is the uniform mass density. The spacing is the mean distance of neighbours (of all
    /// `n` segments when closed, D8).
    ///
    /// # Errors
    ///
    /// Refused: too few nodes for the topology, nodes that are not finite or all coincide, a mass
    /// that is negative or not finite.
    pub fn of(nodes: &[DVec2], topology: Topology, mass: f64) -> Result<Self, SnakeError> {
        elastic::validate_nodes(nodes, topology)?;
        let spacing = elastic::spacing(nodes, topology.is_closed(), SpacingRule::Closed);
        let mut body = Self {
            topology,
            rest: nodes.to_vec(),
            spacing,
            material: Material::uniform(0.0, 0.0, 0.0),
            mass: Profile::Uniform(mass),
            damping: Profile::Uniform(0.0),
            internal: 0.0,
            frame: Frame::corrected(),
            schedules: Schedules::default(),
            maps: Maps::default(),
        };
        body.recenter()?;
        body.validate()?;
        Ok(body)
    }

    /// The same body of another material.
    #[must_use]
    pub fn with_material(mut self, material: Material) -> Self {
        self.material = material;
        self
    }

    /// The same body with uniform damping density `gamma`.
    #[must_use]
    pub fn with_damping(mut self, gamma: f64) -> Self {
        self.damping = Profile::Uniform(gamma);
        self
    }

    /// The same body in another frame.
    #[must_use]
    pub const fn with_frame(mut self, frame: Frame) -> Self {
        self.frame = frame;
        self
    }

    /// Number of nodes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rest.len()
    }

    /// Whether there is no node; never true of a valid body.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    /// The weights of the nodes in the body frame's origin; they sum to 1.
    ///
    /// # Errors
    ///
    /// [`SnakeError::NoMass`] for the center of mass of a body without any.
    pub fn weights(&self) -> Result<Vec<f64>, SnakeError> {
        let n = self.len();
        match self.frame.center {
            Center::Mean => Ok(vec![1.0 / n as f64; n]),
            // a body without mass anywhere (gradient flow) has equal weights, as a uniform one
            Center::Mass => {
                let mass = self.mass.to_vec(n);
                let total: f64 = mass.iter().sum();
                if self.mass.is_uniform() {
                    return Ok(vec![1.0 / n as f64; n]);
                }
                if total > 0.0 {
                    Ok(mass.iter().map(|m| m / total).collect())
                } else {
                    Err(SnakeError::NoMass)
                }
            }
        }
    }

    /// Move the rest shape so that the body frame's origin is at zero.
    ///
    /// # Errors
    ///
    /// As [`Body::weights`].
    pub fn recenter(&mut self) -> Result<(), SnakeError> {
        let center = match self.frame.center {
            Center::Mean => elastic::center(&self.rest, None),
            Center::Mass if self.mass.is_uniform() => elastic::center(&self.rest, None),
            Center::Mass => {
                let weights = self.weights()?;
                elastic::center(&self.rest, Some(&weights))
            }
        };
        for r in &mut self.rest {
            *r -= center;
        }
        Ok(())
    }

    /// Check every value.
    ///
    /// # Errors
    ///
    /// The first one that will not do, by name.
    pub fn validate(&self) -> Result<(), SnakeError> {
        let n = self.len();
        elastic::validate_nodes(&self.rest, self.topology)?;
        self.material.validate(n)?;
        self.mass.validate("mass", n, Bound::AtLeast(0.0))?;
        self.damping.validate("damping", n, Bound::AtLeast(0.0))?;
        self.maps.validate()?;
        finite_at_least("internal damping", 0.0, "at least 0", self.internal)?;
        finite_at_least("spacing", f64::MIN_POSITIVE, "above 0", self.spacing)?;
        self.weights()?;
        Ok(())
    }
}
