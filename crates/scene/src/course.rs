//! A scene in motion, step by step: what a window or a program of one's own moves.

use std::ops::ControlFlow;

use integrator::State;
use snake::{Member, Outcome, Simulation};

use crate::{Hand, Scene, SceneError};

/// A scene in motion: everything that moves in it, and its hands, which take hold and let go where it is time.
///
/// A copy goes on as the original does, to the last bit.
///
/// ```
/// let scene = scene::Scene::named("soft-ball")?;
/// let mut course = scene.course(false)?;
/// for _ in 0..100 {
///     course.step()?;
/// }
/// assert_eq!(course.simulation().steps(), 100);
/// # Ok::<(), scene::SceneError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Course {
    simulation: Simulation,
    hand: Hand,
    slack: f64,
}

impl Scene {
    /// The scene at its start, ready to be stepped; `energies`: whether an account of energies is kept.
    ///
    /// # Errors
    ///
    /// As [`Scene::simulation`], and a hand that cannot take hold at the start.
    pub fn course(&self, energies: bool) -> Result<Course, SceneError> {
        let mut scene = self.clone();
        scene.plan.recording.energies = energies;
        let mut course = Course {
            simulation: scene.simulation()?,
            hand: self.hand.clone(),
            slack: 1e-9 * self.plan.dt,
        };
        let ids: Vec<usize> = course.simulation.members().iter().map(Member::id).collect();
        for id in ids.into_iter().filter(|id| course.hand.acts_on(*id)) {
            let waited = course.simulation.expect_edits_until(id, course.hand.end());
            waited.map_err(|error| SceneError::key("hand", error))?;
        }
        course.hands()?;
        Ok(course)
    }
}

impl Course {
    /// Move everything one step on, and let hands take hold and let go. It breaks where a step cannot be made.
    ///
    /// # Errors
    ///
    /// As [`Simulation::step`], and a hand that cannot do what it is to do.
    pub fn step(&mut self) -> Result<ControlFlow<Outcome>, SceneError> {
        let stepped = self.simulation.step();
        let flow = stepped.map_err(|error| SceneError::key("run", error))?;
        if flow.is_continue() && !self.hand.is_empty() {
            self.hands()?;
        }
        Ok(flow)
    }

    fn hands(&mut self) -> Result<(), SceneError> {
        let (t, members) = (self.simulation.t(), self.simulation.members());
        let of = |id| -> Option<&State> {
            let mut members = members.iter();
            members.find(|member| member.id() == id).map(Member::state)
        };
        for (id, edit, _) in self.hand.act(t, self.slack, of)? {
            let done = self.simulation.edit(id, edit);
            done.map_err(|error| SceneError::key("hand", error))?;
        }
        Ok(())
    }

    /// What moves.
    #[must_use]
    pub const fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// What moves, to be edited between two steps.
    pub const fn simulation_mut(&mut self) -> &mut Simulation {
        &mut self.simulation
    }
}
