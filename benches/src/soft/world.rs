//! A scene under one of the methods, moved by steps of its own.

use super::model::Model;
use super::{mass_spring, touch, xpbd};
use sandbox::prelude::*;
use scene::Scene;

/// The steps of both ways of positions, in those of the snake: the same number of passes.
const SMALL: f64 = 0.25;
const LONG: f64 = 2.0;

/// A way to move soft bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Method {
    /// This project's.
    Snake,
    /// Masses and springs.
    Springs,
    /// Positions, one pass a step.
    Positions,
    /// Positions, as many passes in steps eight times as long.
    Passes,
}

impl Method {
    pub(super) const ALL: [Self; 4] = [Self::Snake, Self::Springs, Self::Positions, Self::Passes];

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Snake => "snake",
            Self::Springs => "springs",
            Self::Positions => "positions",
            Self::Passes => "8 passes",
        }
    }
}

/// A scene being moved.
#[derive(Debug)]
pub(super) struct World {
    how: How,
    pub dt: f64,
    steps: u64,
}

#[derive(Debug)]
enum How {
    Snake(Box<Group>),
    Springs(Model),
    Positions(Model, usize),
}

impl World {
    /// The scene under a method, at `share` of the method's own step: the scene's; nine fortieths of the springs' limit at
    /// the start, the longest of its halves that gets through; of positions four passes in the time of a step of the snake.
    pub(super) fn new(scene: &Scene, method: Method, share: f64) -> Result<Self> {
        let mut scene = scene.clone();
        let usual = scene.plan.dt;
        let (how, dt) = match method {
            Method::Snake => {
                scene.plan.dt = share * usual;
                (How::Snake(Box::new(group(&scene)?)), usual)
            }
            Method::Springs => {
                let mut model = Model::of(&scene);
                // it has no stop: with four times the stiffness the deepest of the pile stays above it
                if let Some(contact) = &mut model.contact {
                    contact.stiffness *= 4.0;
                }
                let limit = 2.0 / model.fastest().sqrt();
                (How::Springs(model), 0.225 * limit)
            }
            Method::Positions => (How::Positions(Model::of(&scene), 1), SMALL * usual),
            Method::Passes => (How::Positions(Model::of(&scene), 8), LONG * usual),
        };
        Ok(Self {
            how,
            dt: share * dt,
            steps: 0,
        })
    }

    pub(super) fn t(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "some hundred thousand")]
        let steps = self.steps as f64;
        steps * self.dt
    }

    pub(super) fn step(&mut self) -> Result<()> {
        match &mut self.how {
            How::Snake(group) => advance(group)?,
            How::Springs(model) => mass_spring::step(model, self.dt),
            How::Positions(model, passes) => xpbd::step(model, self.dt, *passes),
        }
        self.steps += 1;
        Ok(())
    }

    /// Steps until that time.
    #[cfg(test)]
    pub(super) fn go(&mut self, time: f64) -> Result<()> {
        while self.t() < time - 0.5 * self.dt {
            self.step()?;
        }
        Ok(())
    }

    /// Nodes of curve `k`.
    pub(super) fn curve(&self, k: usize) -> &[DVec2] {
        match &self.how {
            How::Snake(group) => &group.members()[k].state().x,
            How::Springs(model) | How::Positions(model, _) => model.nodes(k),
        }
    }

    pub(super) fn curves(&self) -> usize {
        match &self.how {
            How::Snake(group) => group.members().len(),
            How::Springs(model) | How::Positions(model, _) => model.curves.len(),
        }
    }

    pub(super) fn closed(&self, k: usize) -> bool {
        match &self.how {
            How::Snake(group) => group.members()[k].is_closed(),
            How::Springs(model) | How::Positions(model, _) => model.curves[k].closed,
        }
    }

    pub(super) fn momentum(&self) -> DVec2 {
        match &self.how {
            How::Snake(group) => group.momentum(),
            How::Springs(model) | How::Positions(model, _) => model.momentum(),
        }
    }

    /// Energy of motion, and with it that of springs, gas and gravity; between bodies left out.
    pub(super) fn energy(&mut self) -> (f64, f64) {
        match &mut self.how {
            How::Snake(group) => {
                let all = group.energies();
                let kept = all.kinetic + all.elastic() + all.forces[0];
                (all.kinetic, kept)
            }
            How::Springs(model) | How::Positions(model, _) => {
                let kinetic = model.kinetic();
                (kinetic, kinetic + model.potential())
            }
        }
    }

    /// All curves as they are now, under a time of one's own.
    pub(super) fn frame(&self, t: f64) -> Frame {
        let curve = |k| Curve {
            id: k,
            closed: self.closed(k),
            nodes: self.curve(k).to_vec(),
        };
        let curves = (0..self.curves()).map(curve).collect();
        Frame { t, curves }
    }

    /// How deep the deepest node is in another curve.
    pub(super) fn deepest(&self) -> f64 {
        match &self.how {
            How::Snake(group) => group.deepest(),
            How::Springs(model) | How::Positions(model, _) => touch::deepest(model),
        }
    }

    /// Whether every place is one.
    pub(super) fn is_fine(&self) -> bool {
        (0..self.curves()).all(|k| {
            let near = |x: &DVec2| x.is_finite() && x.abs().max_element() < 1e4;
            self.curve(k).iter().all(near)
        })
    }
}
