//! Newmark's method and the family it belongs to.

use glam::DVec2;

use crate::contact::Contacts;
use crate::impulse::{Moment, Pace};
use crate::solver::Solver;
use crate::stepper::{self, Clock, Mass};
use crate::{Fault, SchemeError, State, Stepper, System, each};

/// Generalized-α: Newmark's method with as much damping of the highest frequencies as is asked for.
///
/// ```text
/// μ a(t + (1 − αm) dt) + γ v(t + (1 − αf) dt) = elastic + f   at t + (1 − αf) dt
/// x⁺ = x + dt v + dt² ((½ − β) a + β a⁺),   v⁺ = v + dt ((1 − g) a + g a⁺)
/// αm = (2ρ − 1)/(ρ + 1),   αf = ρ/(ρ + 1),   g = ½ − αm + αf,   β = ¼ (1 − αm + αf)²
/// ```
///
/// The fastest motions are multiplied by ρ (ρ∞ in the paper) each step: ρ = 1 keeps them, ρ = 0 removes them at
/// once. The external force is taken once, at `x + (1 − αf) dt v`.
///
/// [chung93].
#[derive(Debug, Clone)]
pub(crate) struct GeneralizedAlpha {
    weights: Weights,
    clock: Clock,
    solver: Solver,
    /// Whether `a` holds the acceleration at the state.
    ready: bool,
    a: Vec<DVec2>,
    force: Vec<DVec2>,
    external: Vec<DVec2>,
    next_x: Vec<DVec2>,
    next_v: Vec<DVec2>,
    contacts: Contacts,
}

/// αm, αf, g and β.
#[derive(Debug, Clone, Copy)]
struct Weights {
    m: f64,
    f: f64,
    g: f64,
    b: f64,
}

impl Weights {
    fn new(rho: f64) -> Self {
        let m = (2.0 * rho - 1.0) / (rho + 1.0);
        let f = rho / (rho + 1.0);
        Self {
            m,
            f,
            g: 0.5 - m + f,
            b: 0.25 * (1.0 - m + f) * (1.0 - m + f),
        }
    }
}

impl GeneralizedAlpha {
    pub(crate) const NAME: &'static str = "generalized-alpha";

    pub(crate) fn new(
        system: &mut dyn System,
        state: &State,
        dt: f64,
        rho: f64,
    ) -> Result<Self, SchemeError> {
        if !(0.0..=1.0).contains(&rho) {
            let (scheme, name, range) = (Self::NAME, "damping at infinity", "between 0 and 1");
            return Err(SchemeError::BadParameter {
                scheme,
                name,
                range,
                value: rho,
            });
        }
        system.advance(state.t, &state.x);
        stepper::check(Self::NAME, system, state, dt, Mass::Needed)?;
        let weights = Weights::new(rho);
        let Weights { m, f, g, b } = weights;
        let p = (1.0 - m) / ((1.0 - f) * b * dt * dt);
        let zeros = || vec![DVec2::ZERO; state.len()];
        Ok(Self {
            weights,
            clock: Clock::new(state, dt),
            solver: Solver::new(Self::NAME, Mass::Needed, system, (p, g / (b * dt)))?,
            ready: false,
            a: zeros(),
            force: zeros(),
            external: zeros(),
            next_x: zeros(),
            next_v: zeros(),
            contacts: Contacts::new(state.len()),
        })
    }

    fn accelerate(&mut self, system: &mut dyn System, state: &State) -> Result<(), Fault> {
        stepper::external(
            system,
            self.clock.now(),
            &state.x,
            &state.v,
            &mut self.external,
        )?;
        for i in 0..state.len() {
            let drag = system.damping()[i] * state.v[i];
            self.a[i] = if system.held()[i] {
                DVec2::ZERO
            } else {
                (self.force[i] + self.external[i] - drag) / system.mass()[i]
            };
        }
        self.ready = true;
        Ok(())
    }
}

impl Stepper for GeneralizedAlpha {
    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }

    fn step(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), Fault> {
        let (dt, t) = (self.clock.dt, self.clock.now());
        let Weights { m, f, g, b } = self.weights;
        self.solver.advance(system, t, &state.x)?;
        system.elastic(&state.x, &mut self.force);
        if !self.ready {
            self.accelerate(system, state)?;
        }
        let reach = (1.0 - f) * dt;
        for i in 0..state.len() {
            self.next_x[i] = state.x[i]
                + if system.held()[i] {
                    DVec2::ZERO
                } else {
                    reach * state.v[i]
                };
        }
        stepper::external(
            system,
            t + reach,
            &self.next_x,
            &state.v,
            &mut self.external,
        )?;
        let (mass, damping) = (system.mass(), system.damping());
        for i in 0..state.len() {
            let (v, a) = (state.v[i], self.a[i]);
            let inertia = (1.0 - m) * (v / (b * dt) + (0.5 - b) / b * a) - m * a;
            let drag = (1.0 - f) * ((1.0 - g / b) * v + dt * (1.0 - 0.5 * g / b) * a) + f * v;
            let sum = self.force[i] + self.external[i] + mass[i] * inertia - damping[i] * drag;
            self.force[i] = sum / (1.0 - f);
        }
        stepper::release(system.held(), &mut self.force);
        self.solver.solve(&mut self.force);
        for i in 0..state.len() {
            let (v, a, step) = (state.v[i], self.a[i], self.force[i]);
            let held = system.held()[i];
            self.next_x[i] = state.x[i] + step;
            let later = (step - dt * v) / (b * dt * dt) - (0.5 - b) / b * a;
            self.external[i] = if held { DVec2::ZERO } else { later };
            let fast = v + dt * ((1.0 - g) * a + g * later);
            self.next_v[i] = if held { DVec2::ZERO } else { fast };
        }
        stepper::finite(&self.next_x)?;
        let moment = Moment {
            t: t + dt,
            dt,
            pace: Pace::Together { way: 0.5 },
        };
        let (x, v) = (&mut self.next_x, &mut self.next_v);
        // accelerations are those of the forces: what obstacles do stands in the velocities alone
        self.contacts
            .meet_with(system, moment, &state.x, x, v, Some(&mut self.solver))?;
        std::mem::swap(&mut self.a, &mut self.external);
        std::mem::swap(&mut state.x, x);
        std::mem::swap(&mut state.v, v);
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

/// Newmark's method with β = ¼: the mean of the accelerations, the trapezoidal rule.
///
/// ```text
/// (4μ/dt² + 2γ/dt + A) δ = 2 (elastic(x) + f) + 4 μ v / dt,   v⁺ = 2 δ / dt − v
/// ```
///
/// `f` is taken once, in the middle: at `t + dt/2` and `x + dt v / 2`. A mode with stiffness λ and an
/// external slope κ then has a step of determinant 1 whatever λ is, and is stable while `κ dt² < 4 μ`:
/// nothing is lost but what the damping takes. Forces that depend on velocity see the one at
/// the start of the step, which costs them an order.
///
/// [newmark59].
#[derive(Debug, Clone)]
pub(crate) struct Newmark {
    clock: Clock,
    solver: Solver,
    force: Vec<DVec2>,
    /// Velocities at the end.
    late: Vec<DVec2>,
    next_x: Vec<DVec2>,
    next_v: Vec<DVec2>,
    contacts: Contacts,
}

impl Newmark {
    pub(crate) const NAME: &'static str = "newmark";

    pub(crate) fn new(
        system: &mut dyn System,
        state: &State,
        dt: f64,
    ) -> Result<Self, SchemeError> {
        system.advance(state.t, &state.x);
        stepper::check(Self::NAME, system, state, dt, Mass::Needed)?;
        Self::named(Self::NAME, Mass::Needed, system, state, dt)
    }

    fn named(
        name: &'static str,
        need: Mass,
        system: &dyn System,
        state: &State,
        dt: f64,
    ) -> Result<Self, SchemeError> {
        let weights = (4.0 / (dt * dt), 2.0 / dt);
        let zeros = || vec![DVec2::ZERO; state.len()];
        Ok(Self {
            clock: Clock::new(state, dt),
            solver: Solver::new(name, need, system, weights)?,
            force: zeros(),
            late: zeros(),
            next_x: zeros(),
            next_v: zeros(),
            contacts: Contacts::new(state.len()),
        })
    }
}

impl Stepper for Newmark {
    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }

    fn step(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), Fault> {
        let (t, half) = (self.clock.now(), 0.5 * self.clock.dt);
        let mut x = &state.x;
        if system.depends_on_place() {
            each::onto([x, &state.v], &mut self.next_x, move |[x, v], _| {
                x + half * v
            });
            x = &self.next_x;
        }
        self.solver.advance(system, t + half, x)?;
        self.take(system, t, state)?;
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

impl Newmark {
    /// The same step at another's time `t`, which the other counts.
    fn take(&mut self, system: &mut dyn System, t: f64, state: &mut State) -> Result<(), Fault> {
        let dt = self.clock.dt;
        let (x, v) = (&mut self.next_x, &mut self.next_v);
        v.copy_from_slice(&state.v);
        stepper::release(system.held(), v);
        each::onto([&state.x, v], x, move |[x, v], _| x + 0.5 * dt * v);
        system.elastic(&state.x, &mut self.force);
        system.external(t + 0.5 * dt, x, v, &mut self.force)?;
        let (mass, rate) = (self.solver.masses(system), 4.0 / dt);
        each::weighted_onto(mass, [v], &mut self.force, move |[mass], [v], force| {
            2.0 * force + (rate * mass) * v
        });
        stepper::release(system.held(), &mut self.force);
        self.solver.solve(&mut self.force);
        let rate = 2.0 / dt;
        let to = [&mut x[..], &mut self.late[..]];
        let finite = each::both([&state.x, &self.force, v], to, move |[x, step, v]| {
            (x + step, rate * step - v)
        });
        if !finite {
            stepper::finite(x)?;
        }
        std::mem::swap(v, &mut self.late);
        let moment = Moment {
            t: t + dt,
            dt,
            pace: Pace::Together { way: 0.5 },
        };
        self.contacts
            .meet_with(system, moment, &state.x, x, v, Some(&mut self.solver))?;
        std::mem::swap(&mut state.x, x);
        std::mem::swap(&mut state.v, v);
        Ok(())
    }
}

/// Newmark's method for the steps of another scheme in which something is touched.
///
/// A contact in the middle of a long exact or high-order step would be met at its end with all
/// the energy of a deformation that never was. Here the step is solved with it. Made at the first
/// touch: many runs have none.
#[derive(Debug, Clone)]
pub(crate) struct StandIn {
    name: &'static str,
    need: Mass,
    dt: f64,
    made: Option<Newmark>,
}

impl StandIn {
    pub(crate) const fn new(name: &'static str, need: Mass, dt: f64) -> Self {
        Self {
            name,
            need,
            dt,
            made: None,
        }
    }

    /// A step at time `t`, which the other scheme counts.
    pub(crate) fn take(
        &mut self,
        system: &mut dyn System,
        t: f64,
        state: &mut State,
    ) -> Result<(), Fault> {
        let mut stepper = match self.made.take() {
            Some(made) => made,
            None => Newmark::named(self.name, self.need, system, state, self.dt)
                .map_err(|_| stepper::unsolvable(&state.x))?,
        };
        let outcome = stepper.take(system, t, state);
        self.made = Some(stepper);
        outcome
    }

    /// Make the factor again from the system as it is.
    pub(crate) fn rebuild(&mut self, system: &dyn System, x: &[DVec2]) -> Result<(), Fault> {
        match &mut self.made {
            Some(made) => made.solver.rebuild(system, x),
            None => Ok(()),
        }
    }
}
