//! The classical method of Runge and Kutta.

use glam::DVec2;

use crate::contact::Contacts;
use crate::impulse::{Moment, Pace};
use crate::stepper::{self, Clock, Mass, Seen};
use crate::{Fault, SchemeError, State, Stepper, System, each};

/// Runge and Kutta's method of order 4, four forces a step.
///
/// ```text
/// y = (x, v),  y' = (v, (F(t, x, v) − γ v) / μ)
/// y⁺ = y + dt/6 (k₁ + 2 k₂ + 2 k₃ + k₄)
/// ```
///
/// Stiffness and mass stay as they are during a step.
#[derive(Debug, Clone)]
pub(crate) struct Rk4 {
    clock: Clock,
    rates: Rates,
    /// Where the stage is.
    x: Vec<DVec2>,
    v: Vec<DVec2>,
    /// The step so far.
    next_x: Vec<DVec2>,
    next_v: Vec<DVec2>,
    rate: Vec<DVec2>,
    contacts: Contacts,
}

/// Accelerations from forces, for every explicit method of several stages.
#[derive(Debug, Clone, Default)]
pub(crate) struct Rates {
    /// 1/μ, and γ/μ; zero at held nodes.
    inverse: Vec<(f64, f64)>,
    /// Those of all nodes, where they are the same and none is held.
    common: Option<(f64, f64)>,
    seen: Seen,
}

impl Rates {
    pub(crate) fn prepare(&mut self, system: &dyn System) {
        let (mass, damping, held) = (system.mass(), system.damping(), system.held());
        self.seen = Seen::of(system);
        self.inverse.clear();
        for i in 0..mass.len() {
            let rates = if held[i] {
                (0.0, 0.0)
            } else {
                (1.0 / mass[i], damping[i] / mass[i])
            };
            self.inverse.push(rates);
        }
        let first = self.inverse.first().copied();
        self.common =
            first.filter(|first| first.0 > 0.0 && self.inverse.iter().all(|rates| rates == first));
    }

    /// Bring the system to time `t` and the rates with it.
    pub(crate) fn advance(
        &mut self,
        name: &'static str,
        system: &mut dyn System,
        t: f64,
        x: &[DVec2],
    ) -> Result<bool, Fault> {
        if !self.seen.left_behind(system, t, x) {
            return Ok(false);
        }
        if stepper::densities(name, system, Mass::Needed).is_err() {
            return Err(stepper::unsolvable(x));
        }
        self.prepare(system);
        Ok(true)
    }

    /// Acceleration of every node; none at held ones.
    pub(crate) fn acceleration(
        &self,
        system: &mut dyn System,
        t: f64,
        x: &[DVec2],
        v: &[DVec2],
        rate: &mut [DVec2],
    ) -> Result<(), Fault> {
        stepper::force(system, t, x, v, rate)?;
        if let Some((inverse, fade)) = self.common {
            each::onto([v], rate, move |[v], rate| inverse * rate - fade * v);
            return Ok(());
        }
        for ((rate, &v), &(inverse, fade)) in rate.iter_mut().zip(v).zip(&self.inverse) {
            *rate = if inverse > 0.0 {
                inverse * *rate - fade * v
            } else {
                DVec2::ZERO
            };
        }
        Ok(())
    }
}

/// Nodes that may not move have no velocity.
pub(crate) fn stop_held(system: &dyn System, v: &mut [DVec2]) {
    stepper::release(system.held(), v);
}

impl Rk4 {
    pub(crate) const NAME: &'static str = "rk4";

    pub(crate) fn new(
        system: &mut dyn System,
        state: &State,
        dt: f64,
    ) -> Result<Self, SchemeError> {
        system.advance(state.t, &state.x);
        stepper::check(Self::NAME, system, state, dt, Mass::Needed)?;
        let n = state.len();
        let zeros = || vec![DVec2::ZERO; n];
        let mut rates = Rates {
            inverse: Vec::with_capacity(n),
            ..Rates::default()
        };
        rates.prepare(system);
        Ok(Self {
            clock: Clock::new(state, dt),
            rates,
            x: zeros(),
            v: zeros(),
            next_x: zeros(),
            next_v: zeros(),
            rate: zeros(),
            contacts: Contacts::new(n),
        })
    }
}

impl Stepper for Rk4 {
    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }

    fn step(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), Fault> {
        let dt = self.clock.dt;
        let t = self.clock.now();
        self.x.copy_from_slice(&state.x);
        self.v.copy_from_slice(&state.v);
        stop_held(system, &mut self.v);
        self.next_x.copy_from_slice(&self.x);
        self.next_v.copy_from_slice(&self.v);
        // where in the step the stage is, what it counts for, how far from the start the next one is
        for (at, weight, ahead) in [
            (0.0, 1.0, 0.5),
            (0.5, 2.0, 0.5),
            (0.5, 2.0, 1.0),
            (1.0, 1.0, 0.0),
        ] {
            let now = t + at * dt;
            self.rates.advance(Self::NAME, system, now, &self.x)?;
            self.rates
                .acceleration(system, now, &self.x, &self.v, &mut self.rate)?;
            let (share, reach) = (dt * weight / 6.0, dt * ahead);
            each::onto([&self.v], &mut self.next_x, move |[v], x| x + share * v);
            each::onto([&self.rate], &mut self.next_v, move |[a], v| v + share * a);
            each::onto([&state.x, &self.v], &mut self.x, move |[x, v], _| {
                x + reach * v
            });
            each::onto([&state.v, &self.rate], &mut self.v, move |[v, a], _| {
                v + reach * a
            });
            stop_held(system, &mut self.v);
        }
        stepper::finite(&self.next_x)?;
        let moment = Moment {
            t: t + dt,
            dt,
            pace: Pace::Together { way: 0.5 },
        };
        self.contacts
            .meet(system, moment, &state.x, &mut self.next_x, &mut self.next_v)?;
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
    }
}
