//! The report's scheme with the damping in the middle of the step.

use glam::DVec2;

use crate::contact::Contacts;
use crate::impulse::{Moment, Pace};
use crate::stepper::{self, Clock, Mass, Seen};
use crate::{Fault, SchemeError, Start, State, Stepper, System, each};

/// Leapfrog with centred damping, in increments.
///
/// ```text
/// v½ = (1 − a/2) v + dt/(2μ) F(t, x)          a = γ dt / μ
/// x⁺ = x + dt v½
/// v⁺ = (v½ + dt/(2μ) F(t⁺, x⁺)) / (1 + a/2)
/// ```
///
/// The positions are those of `x⁺ = [2x − (1 − a/2) x₋ + dt²/μ F] / (1 + a/2)`, without its
/// cancellation (D18, D21). Forces that depend on velocity see `v½`. Obstacles are met at `x⁺` with `v½`, and
/// hold the touched nodes against the second half of the forces.
#[derive(Debug, Clone)]
pub(crate) struct Leapfrog {
    clock: Clock,
    /// Whether `force` holds the force at the state.
    ready: bool,
    force: Vec<DVec2>,
    next: Vec<DVec2>,
    half: Vec<DVec2>,
    coefficients: Vec<Coefficients>,
    /// Those of all nodes, where they are the same.
    common: Option<Coefficients>,
    /// Velocities at the first of a start of first order.
    early: Vec<DVec2>,
    seen: Seen,
    contacts: Contacts,
}

/// One node's share: all zero for a held one.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Coefficients {
    /// 1 − a/2.
    keep: f64,
    /// dt / (2 μ).
    kick: f64,
    /// 1 / (1 + a/2).
    settle: f64,
}

impl Coefficients {
    fn new(mass: f64, damping: f64, held: bool, dt: f64) -> Self {
        if held {
            return Self {
                keep: 0.0,
                kick: 0.0,
                settle: 0.0,
            };
        }
        let a = damping * dt / mass;
        Self {
            keep: 1.0 - 0.5 * a,
            kick: 0.5 * dt / mass,
            settle: 1.0 / (1.0 + 0.5 * a),
        }
    }
}

impl Leapfrog {
    pub(crate) const NAME: &'static str = "leapfrog";

    pub(crate) fn new(
        system: &mut dyn System,
        state: &State,
        dt: f64,
        start: Start,
    ) -> Result<Self, SchemeError> {
        system.advance(state.t, &state.x);
        stepper::check(Self::NAME, system, state, dt, Mass::Needed)?;
        let n = state.len();
        let zeros = || vec![DVec2::ZERO; n];
        let mut stepper = Self {
            clock: Clock::new(state, dt),
            ready: false,
            force: zeros(),
            next: zeros(),
            half: zeros(),
            coefficients: Vec::with_capacity(n),
            common: None,
            early: if start == Start::FirstOrder {
                state.v.clone()
            } else {
                Vec::new()
            },
            seen: Seen::default(),
            contacts: Contacts::new(n),
        };
        stepper.prepare(system);
        Ok(stepper)
    }

    /// A start of first order means v₀ half a step ago: what it is at the start.
    fn catch_up(&self, early: &mut [DVec2]) {
        for (i, v) in early.iter_mut().enumerate() {
            let c = self.coefficients[i];
            *v = c.settle * (*v + c.kick * self.force[i]);
        }
    }

    /// From the velocity at the start to the one half a step later, and with it to `next`.
    fn drift(&mut self, x: &[DVec2], v: &[DVec2]) -> Result<(), Fault> {
        let (n, dt) = (x.len(), self.clock.dt);
        let (v, force, coefficients) = (&v[..n], &self.force[..n], &self.coefficients[..n]);
        let (half, next) = (&mut self.half[..n], &mut self.next[..n]);
        let finite = if let Some(c) = self.common {
            each::both([x, v, force], [&mut *next, half], move |[x, v, force]| {
                let speed = c.keep * v + c.kick * force;
                (x + dt * speed, speed)
            })
        } else {
            let mut finite = true;
            for i in 0..n {
                let c = coefficients[i];
                let speed = c.keep * v[i] + c.kick * force[i];
                let place = x[i] + dt * speed;
                half[i] = speed;
                next[i] = place;
                // no early way out: one comparison a number
                finite &= place.x.is_finite() & place.y.is_finite();
            }
            finite
        };
        if finite {
            Ok(())
        } else {
            stepper::finite(next)
        }
    }

    /// From the velocity in `half` to the one at the end of the step, in its place.
    fn arrive(&mut self) {
        let (half, force) = (&mut self.half, &self.force);
        if let Some(c) = self.common {
            each::onto([force], half, move |[force], half| {
                c.settle * (half + c.kick * force)
            });
            return;
        }
        for ((v, &force), c) in half.iter_mut().zip(force).zip(&self.coefficients) {
            *v = c.settle * (*v + c.kick * force);
        }
    }

    fn prepare(&mut self, system: &dyn System) {
        let (mass, damping, held) = (system.mass(), system.damping(), system.held());
        self.seen = Seen::of(system);
        self.coefficients.clear();
        for i in 0..mass.len() {
            self.coefficients.push(Coefficients::new(
                mass[i],
                damping[i],
                held[i],
                self.clock.dt,
            ));
        }
        let first = self.coefficients.first().copied();
        self.common = first.filter(|first| self.coefficients.iter().all(|c| c == first));
    }
}

impl Stepper for Leapfrog {
    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }

    fn step(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), Fault> {
        let dt = self.clock.dt;
        if !self.ready {
            stepper::force(
                system,
                self.clock.now(),
                &state.x,
                &state.v,
                &mut self.force,
            )?;
        }
        if self.early.is_empty() {
            self.drift(&state.x, &state.v)?;
        } else {
            let mut early = std::mem::take(&mut self.early);
            self.catch_up(&mut early);
            self.drift(&state.x, &early)?;
        }
        let t = self.clock.next();
        let moment = Moment {
            t,
            dt,
            pace: Pace::Catching,
        };
        let (next, half) = (&mut self.next, &mut self.half);
        let touched = self
            .contacts
            .meet_halfway(system, moment, &state.x, next, half)?;
        // the force of the old place is lost if the new one has none, so a fault starts afresh
        self.ready = false;
        if self.seen.left_behind(system, t, &self.next) {
            if stepper::densities(Self::NAME, system, Mass::Needed).is_err() {
                return Err(stepper::unsolvable(&state.x));
            }
            self.prepare(system);
        }
        let (next, half) = (&mut self.next, &mut self.half);
        stepper::force(system, t, next, half, &mut self.force)?;
        self.ready = true;
        self.arrive();
        if touched {
            let (next, half) = (&self.next, &mut self.half);
            self.contacts.support(system, moment, next, half);
        }
        std::mem::swap(&mut state.v, &mut self.half);
        std::mem::swap(&mut state.x, &mut self.next);
        self.clock.tick(state);
        Ok(())
    }

    fn dt(&self) -> f64 {
        self.clock.dt
    }

    fn resume(&mut self, system: &mut dyn System, state: &State) {
        self.clock.restart(state);
        self.ready = false;
        self.early.clear();
        system.advance(self.clock.now(), &state.x);
        self.prepare(system);
    }

    fn kicked(&mut self, system: &mut dyn System, state: &State) {
        if self.ready && self.early.is_empty() && !system.external_depends_on_velocity() {
            self.clock.restart(state);
        } else {
            self.resume(system, state);
        }
    }
}
