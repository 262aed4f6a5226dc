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
    /// β. T.
    time: f64,
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
        Ok(Some(Self {
            damper,
            mass,
            time: body.internal,
            seen: vec![DVec2::ZERO; n],
            force: vec![DVec2::ZERO; n],
        }))
    }

    /// β: no motion is damped more than this times its stiffness. T.
    pub(crate) const fn time(&self) -> f64 {
        self.time
    }

    fn fill(&mut self, body: &Body, held: Option<&[bool]>, x: &[DVec2], v: &[DVec2]) {
        let damping = InternalDamping {
            topology: body.topology,
            damper: &self.damper,
            // the same factor at every node drops out
            mass: &self.mass,
            spacing: body.spacing,
        };
        let Some(held) = held else {
            return damping.force(x, v, &mut self.seen, &mut self.force);
        };
        // what is held stands still, whatever velocity it had when it was taken hold of
        let pairs = v.iter().zip(held);
        let moving: Vec<DVec2> = pairs
            .map(|(&v, &held)| if held { DVec2::ZERO } else { v })
            .collect();
        damping.force(x, &moving, &mut self.seen, &mut self.force);
    }
}

impl Snake {
    /// Add the internal damping force.
    pub(crate) fn add_inner(&mut self, x: &[DVec2], v: &[DVec2], force: &mut [DVec2]) {
        if let Some(inner) = &mut self.inner {
            let held = self.any_held.then_some(&self.held[..]);
            inner.fill(&self.body, held, x, v);
            for (force, &own) in force.iter_mut().zip(&inner.force) {
                *force += own;
            }
        }
    }

    /// What internal damping takes, per unit of time and length of curve a node.
    pub(crate) fn inner_loss(&self, state: &State) -> f64 {
        self.inner.clone().map_or(0.0, |mut inner| {
            let held = self.any_held.then_some(&self.held[..]);
            inner.fill(&self.body, held, &state.x, &state.v);
            let pairs = inner.force.iter().zip(&state.v);
            -pairs.map(|(f, v)| f.dot(*v)).sum::<f64>()
        })
    }
}
