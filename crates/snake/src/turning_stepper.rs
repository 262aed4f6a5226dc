//! A turning frame at work: steps of its three equations, seen in space.

use integrator::{Fault, Scheme, SchemeError, Start, State, Stepper, System};

use crate::Turning;

/// Moves a snake in space by the equations of its [`Turning`] frame.
///
/// ```text
/// q, c, θ  →  x = c + R(θ) q                             (report Eq. 5.2)
/// ```
///
/// So simulations take it as any other stepper; give them the snake in [`Frame::turning`](crate::Frame::turning),
/// whose angle is the same, and its energies are those of the turned rest shape. The snake that moves is the one the frame was
/// made of: what a hand changes during the run is not felt.
#[derive(Debug, Clone)]
pub struct TurningStepper {
    turning: Turning,
    inner: Box<dyn Stepper>,
    state: State,
}

impl TurningStepper {
    /// The scheme at work on that frame, from a motion in space.
    ///
    /// # Errors
    ///
    /// Whatever [`Scheme::start`] refuses.
    pub fn new(
        mut turning: Turning,
        scheme: Scheme,
        space: &State,
        dt: f64,
        start: Start,
    ) -> Result<Self, SchemeError> {
        let needed = turning.snake().len();
        if space.x.len() != needed || space.v.len() != needed {
            let (what, got) = ("state.x", space.x.len());
            return Err(SchemeError::Length { what, needed, got });
        }
        let state = turning.enter(space);
        let inner = scheme.start(&mut turning, &state, dt, start)?;
        Ok(Self {
            turning,
            inner,
            state,
        })
    }

    /// Work over the last step of the inertial forces that are left out, by Simpson's rule on the
    /// cubic through both ends.
    fn absent(&mut self, before: &State) -> Result<f64, Fault> {
        let (turning, after) = (&mut self.turning, &self.state);
        let dt = after.t - before.t;
        let mut middle = before.clone();
        middle.t = before.t + 0.5 * dt;
        for i in 0..middle.x.len() {
            let way = after.x[i] - before.x[i];
            let (from, to) = (before.v[i], after.v[i]);
            middle.x[i] = before.x[i] + 0.5 * way + dt / 8.0 * (from - to);
            middle.v[i] = 1.5 / dt * way - 0.25 * (from + to);
        }
        let ends = turning.power_of_absence(before)? + turning.power_of_absence(after)?;
        Ok(dt / 6.0 * (ends + 4.0 * turning.power_of_absence(&middle)?))
    }

    /// θ now, not reduced to one turn.
    #[must_use]
    pub fn angle(&self) -> f64 {
        self.turning.angle(&self.state)
    }

    /// ω now. T⁻¹.
    #[must_use]
    pub fn angular_velocity(&self) -> f64 {
        self.turning.angular_velocity(&self.state)
    }
}

impl Stepper for TurningStepper {
    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }

    fn step(&mut self, system: &mut dyn System, space: &mut State) -> Result<(), Fault> {
        let before = self.turning.lacks_any().then(|| self.state.clone());
        if let Err(mut fault) = self.inner.step(&mut self.turning, &mut self.state) {
            // the last two of this system are no nodes
            fault.node = fault.node.min(space.x.len().saturating_sub(1));
            fault.at = space.x.get(fault.node).copied().unwrap_or_default();
            return Err(fault);
        }
        *space = self.turning.leave(&self.state);
        if let Some(before) = before {
            system.frame_work(self.absent(&before)?);
        }
        Ok(())
    }

    fn dt(&self) -> f64 {
        self.inner.dt()
    }

    fn resume(&mut self, _: &mut dyn System, space: &State) {
        self.state = self.turning.enter(space);
        self.inner.resume(&mut self.turning, &self.state);
    }
}
