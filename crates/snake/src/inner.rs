//! Internal damping of a snake: what it takes from bending and stretching, and how fast.

use elastic::{InternalDamping, Material, Profile};
use glam::DVec2;
use integrator::State;

use crate::{Body, Snake, SnakeError};

/// The damper of a body at its present factors.
///
/// It is a force on velocities and not part of an operator: an operator that the schemes solve with has
/// one damping a node, and the rigid motion that is to stay free turns with the body. So it counts in the
/// step limit of every scheme.
#[derive(Debug, Clone)]
pub(crate) struct Inner {
    damper: Material,
    /// Masses up to a factor that all share.
    mass: Profile,
    bound: f64,
    seen: Vec<DVec2>,
    force: Vec<DVec2>,
}

impl Inner {
    /// None for a body without.
    pub(crate) fn new(
        body: &Body,
        mass: Profile,
        material: &Material,
    ) -> Result<Option<Self>, SnakeError> {
        if body.internal <= 0.0 {
            return Ok(None);
        }
        let n = body.len();
        let damper = material.damper(body.internal);
        let rows = elastic::greatest_stiffness(body.topology, &damper, body.spacing, n)?;
        let rate = |i: usize| rows[i] / mass.at(i);
        let fastest = (0..n).map(rate).fold(0.0, f64::max);
        let heaviest = (0..n).map(|i| mass.at(i)).fold(0.0, f64::max);
        Ok(Some(Self {
            damper,
            mass,
            bound: fastest * heaviest,
            seen: vec![DVec2::ZERO; n],
            force: vec![DVec2::ZERO; n],
        }))
    }

    /// As much damping as any node can feel. M T⁻¹.
    pub(crate) const fn bound(&self) -> f64 {
        self.bound
    }

    fn fill(&mut self, body: &Body, x: &[DVec2], v: &[DVec2]) {
        let damping = InternalDamping {
            topology: body.topology,
            damper: &self.damper,
            // the same factor at every node drops out
            mass: &self.mass,
            spacing: body.spacing,
        };
        damping.force(x, v, &mut self.seen, &mut self.force);
    }
}

impl Snake {
    /// Add the internal damping force.
    pub(crate) fn add_inner(&mut self, x: &[DVec2], v: &[DVec2], force: &mut [DVec2]) {
        if let Some(inner) = &mut self.inner {
            inner.fill(&self.body, x, v);
            for (force, &own) in force.iter_mut().zip(&inner.force) {
                *force += own;
            }
        }
    }

    /// What internal damping takes, per unit of time and length of curve a node.
    pub(crate) fn inner_loss(&self, state: &State) -> f64 {
        self.inner.clone().map_or(0.0, |mut inner| {
            inner.fill(&self.body, &state.x, &state.v);
            let pairs = inner.force.iter().zip(&state.v);
            -pairs.map(|(f, v)| f.dot(*v)).sum::<f64>()
        })
    }
}
