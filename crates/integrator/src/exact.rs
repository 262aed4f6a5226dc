//! Elastic motion without any error of the step.

use glam::DVec2;

use crate::contact::Contacts;
use crate::modes::Modes;
use crate::newmark::StandIn;
use crate::oscillator::Oscillator;
use crate::stepper::{self, Clock, Mass, Seen};
use crate::{Fault, SchemeError, State, Stepper, System};

/// How external forces join the exact motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Join {
    /// Half a kick, the motion, half a kick ([strang68]).
    Kicks,
    /// Constant over the step, then corrected by how it changed ([cox02]).
    Ramp,
}

impl Join {
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Kicks => "exact",
            Self::Ramp => "etd2",
        }
    }
}

/// Each mode as the damped oscillator it is.
///
/// ```text
/// x⁺ = x + G v + Q a,   v⁺ = Ġ v + G a,   a = elastic(x)/μ,   G̈ + c Ġ + λ G = 0 per mode
/// ```
///
/// Exact for any step when no external force acts; all regimes and the double root. With
/// [`Join::Kicks`], v gets half of `dt f / μ` before and half after. With [`Join::Ramp`], `a` holds `f` as
/// well, and the step is corrected by `W Δf / dt` and `Q Δf / dt` with `Δf` its change over the step, so
/// that constant forces are exact too. Where the system knows that they are constant, both are the same
/// scheme, without an error and at the cost of a free step.
#[derive(Debug, Clone)]
pub(crate) struct Exact {
    join: Join,
    clock: Clock,
    modes: Modes,
    responses: Vec<Oscillator>,
    /// Whether `external` holds the force at the state.
    ready: bool,
    external: Vec<DVec2>,
    later: Vec<DVec2>,
    force: Vec<DVec2>,
    mode_v: Vec<DVec2>,
    mode_a: Vec<DVec2>,
    next_x: Vec<DVec2>,
    next_v: Vec<DVec2>,
    /// For the steps in which something is touched.
    stand_in: StandIn,
    seen: Seen,
    contacts: Contacts,
}

impl Exact {
    pub(crate) fn new(
        join: Join,
        system: &mut dyn System,
        state: &State,
        dt: f64,
    ) -> Result<Self, SchemeError> {
        system.advance(state.t, &state.x);
        stepper::check(join.name(), system, state, dt, Mass::Needed)?;
        let modes = Modes::new(join.name(), system)?;
        let zeros = || vec![DVec2::ZERO; state.len()];
        let mut stepper = Self {
            join,
            clock: Clock::new(state, dt),
            modes,
            responses: Vec::with_capacity(state.len()),
            ready: false,
            external: zeros(),
            later: zeros(),
            force: zeros(),
            mode_v: zeros(),
            mode_a: zeros(),
            next_x: zeros(),
            next_v: zeros(),
            stand_in: StandIn::new(join.name(), Mass::Needed, dt),
            seen: Seen::of(system),
            contacts: Contacts::new(state.len()),
        };
        stepper.respond();
        Ok(stepper)
    }

    fn respond(&mut self) {
        let (c, dt) = (self.modes.damping, self.clock.dt);
        let stiffness = &self.modes.stiffness;
        self.responses.clear();
        for (i, &k) in stiffness.iter().enumerate() {
            // a wave and the one that runs the other way
            let twin = stiffness.len() - i;
            let known = self.responses.get(twin).copied();
            let response = match known {
                Some(known) if stiffness[twin].to_bits() == k.to_bits() => known,
                _ => Oscillator::new(c, k, dt),
            };
            self.responses.push(response);
        }
    }

    /// Bring the system to time `t`, and the modes with it.
    fn advance(&mut self, system: &mut dyn System, t: f64, x: &[DVec2]) -> Result<(), Fault> {
        if !self.seen.left_behind(system, t, x) {
            return Ok(());
        }
        self.seen = Seen::of(system);
        self.stand_in.rebuild(system, x)?;
        let name = self.join.name();
        self.modes = Modes::new(name, system).map_err(|_| stepper::unsolvable(x))?;
        self.respond();
        if system.external_is_constant() {
            self.ready = false;
        }
        Ok(())
    }

    /// From `x` and the velocities in `next_v` with the forces in `force`, into `next_x`, `next_v`.
    fn flow(&mut self, system: &dyn System, x: &[DVec2]) {
        let (mass, held) = (system.mass(), system.held());
        for i in 0..x.len() {
            if held[i] {
                (self.force[i], self.next_v[i]) = (DVec2::ZERO, DVec2::ZERO);
            } else {
                self.force[i] /= mass[i];
            }
        }
        // at rest there is nothing to transform
        if self.next_v.iter().all(|v| *v == DVec2::ZERO) {
            self.mode_v.fill(DVec2::ZERO);
        } else {
            self.modes.amplitudes(&self.next_v, &mut self.mode_v);
        }
        self.modes.amplitudes(&self.force, &mut self.mode_a);
        for (response, (v, a)) in self
            .responses
            .iter()
            .zip(self.mode_v.iter_mut().zip(&mut self.mode_a))
        {
            let (speed, push) = (*v, *a);
            *v = response.kick * speed + response.push * push;
            *a = response.keep * speed + response.kick * push;
        }
        self.modes.points(&self.mode_v, &mut self.next_x);
        self.modes.points(&self.mode_a, &mut self.next_v);
        for i in 0..x.len() {
            // transforms leave rounding where nothing may move
            self.next_x[i] = if held[i] { x[i] } else { x[i] + self.next_x[i] };
            if held[i] {
                self.next_v[i] = DVec2::ZERO;
            }
        }
    }

    /// Add what the change of the external force from `external` to `later` does.
    fn correct(&mut self, system: &dyn System) {
        let dt = self.clock.dt;
        let (mass, held) = (system.mass(), system.held());
        for i in 0..self.later.len() {
            self.force[i] = if held[i] {
                DVec2::ZERO
            } else {
                (self.later[i] - self.external[i]) / (mass[i] * dt)
            };
        }
        self.modes.amplitudes(&self.force, &mut self.mode_a);
        for (i, response) in self.responses.iter().enumerate() {
            self.mode_v[i] = response.ramp * self.mode_a[i];
            self.mode_a[i] *= response.push;
        }
        self.modes.points(&self.mode_v, &mut self.force);
        for i in (0..self.force.len()).filter(|&i| !held[i]) {
            self.next_x[i] += self.force[i];
        }
        self.modes.points(&self.mode_a, &mut self.force);
        for i in (0..self.force.len()).filter(|&i| !held[i]) {
            self.next_v[i] += self.force[i];
        }
    }

    fn kick(&mut self, system: &dyn System) {
        let half = 0.5 * self.clock.dt;
        for (i, v) in self.next_v.iter_mut().enumerate() {
            if !system.held()[i] {
                *v += half / system.mass()[i] * self.external[i];
            }
        }
    }

    /// Whether something was touched on the way; then the step is made again by the stand-in.
    fn met(&mut self, system: &mut dyn System, state: &mut State) -> Result<bool, Fault> {
        stepper::finite(&self.next_x)?;
        let (x, v) = (&self.next_x, &self.next_v);
        if !self.contacts.find(system, self.clock.dt, &state.x, x, v) {
            return Ok(false);
        }
        self.ready = false;
        self.stand_in.take(system, self.clock.now(), state)?;
        self.clock.tick(state);
        Ok(true)
    }
}

impl Stepper for Exact {
    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }

    fn step(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), Fault> {
        let t = self.clock.now();
        self.advance(system, t, &state.x)?;
        let constant = system.external_is_constant();
        if !(self.ready && (constant || self.join == Join::Kicks)) {
            stepper::external(system, t, &state.x, &state.v, &mut self.external)?;
        }
        self.next_v.copy_from_slice(&state.v);
        system.elastic(&state.x, &mut self.force);
        match self.join {
            _ if constant => {
                for (force, external) in self.force.iter_mut().zip(&self.external) {
                    *force += external;
                }
                self.flow(system, &state.x);
                if self.met(system, state)? {
                    return Ok(());
                }
                self.ready = true;
            }
            Join::Kicks => {
                self.kick(system);
                self.flow(system, &state.x);
                if self.met(system, state)? {
                    return Ok(());
                }
                let (x, v) = (&self.next_x, &self.next_v);
                // where the force fails at the end, the next step must ask again at the start
                self.ready = false;
                stepper::external(system, self.clock.next(), x, v, &mut self.external)?;
                self.ready = true;
                self.kick(system);
            }
            Join::Ramp => {
                for (force, external) in self.force.iter_mut().zip(&self.external) {
                    *force += external;
                }
                self.flow(system, &state.x);
                stepper::finite(&self.next_x)?;
                let (x, v) = (&self.next_x, &self.next_v);
                stepper::external(system, self.clock.next(), x, v, &mut self.later)?;
                self.correct(system);
                if self.met(system, state)? {
                    return Ok(());
                }
            }
        }
        std::mem::swap(&mut state.x, &mut self.next_x);
        std::mem::swap(&mut state.v, &mut self.next_v);
        self.clock.tick(state);
        Ok(())
    }

    fn dt(&self) -> f64 {
        self.clock.dt
    }

    fn resume(&mut self, _system: &mut dyn System, state: &State) {
        self.clock.restart(state);
        self.ready = false;
    }
}
