//! Everything a snake lives among.

use std::sync::Arc;

use field::ForceField;
use glam::DVec2;

use crate::{Acting, Force, Gravity, ImageForce, Sampling, SnakeError, Wall, WallLaw};

/// Everything a snake lives among: forces and walls, any number of each.
#[derive(Debug, Clone, Default)]
pub struct World {
    /// The forces; they add up.
    pub forces: Vec<Acting>,
    /// The walls, applied in this order.
    pub walls: Vec<Wall>,
}

impl World {
    /// The same world with one more force, weight 1.
    #[must_use]
    pub fn with(self, force: impl Force + 'static) -> Self {
        self.with_acting(Acting::new(force))
    }

    /// The same world with one more force, with its weight.
    #[must_use]
    pub fn with_acting(mut self, acting: Acting) -> Self {
        self.forces.push(acting);
        self
    }

    /// The same world with a uniform acceleration.
    #[must_use]
    pub fn with_gravity(self, g: DVec2) -> Self {
        self.with(Gravity(g))
    }

    /// The same world with a picture's field, weight 1.
    #[must_use]
    pub fn with_image(self, field: Arc<ForceField>, sampling: Sampling) -> Self {
        self.with(ImageForce::new(field, sampling))
    }

    /// The same world with one more wall.
    #[must_use]
    pub fn with_wall(mut self, wall: Wall) -> Self {
        self.walls.push(wall);
        self
    }

    /// What its forces are called, in their order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.forces.iter().map(Acting::name)
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

    /// The first force that means nothing on an open curve.
    pub(crate) fn needs_closed(&self) -> Option<&Acting> {
        self.forces
            .iter()
            .find(|acting| acting.force().needs_closed())
    }

    /// Check every value against a body of `n` nodes.
    ///
    /// # Errors
    ///
    /// The first one that will not do, by name.
    pub fn validate(&self, n: usize) -> Result<(), SnakeError> {
        self.forces.iter().try_for_each(|acting| acting.validate(n))
    }
}
