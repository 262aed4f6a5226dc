//! Implicit schemes of order 1, which forget: stable for any step, and dissipative.

use glam::DVec2;

use crate::contact::Contacts;
use crate::impulse::{Moment, Pace};
use crate::solver::Solver;
use crate::stepper::{self, Clock, Mass};
use crate::{Fault, SchemeError, State, Stepper, System, each};

/// How often [`Rule::Backward`] asks again for the external force at the step's end.
const ROUNDS: usize = 12;

/// When the agreement between two rounds is good enough, relative to the largest increment.
const AGREEMENT: f64 = 1e-11;

/// Which Euler.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Rule {
    /// All forces at the end of the step.
    Backward,
    /// External forces at its start, all others at its end.
    Imex,
    /// The same without mass.
    GradientFlow,
}

impl Rule {
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Backward => "backward-euler",
            Self::Imex => "imex",
            Self::GradientFlow => "gradient-flow",
        }
    }
}

/// Euler's method with the elastic force and the damping at the end of the step.
///
/// ```text
/// (μ/dt² + γ/dt + A) δ = elastic(x) + f + μ v / dt,   x⁺ = x + δ,   v⁺ = δ / dt
/// ```
///
/// `f` is at the start of the step, or at its end ([`Rule::Backward`]): then the same factor is used
/// in a few rounds, until two agree. Where they do not (an external force that changes more
/// over one step than the step's own inertia and stiffness resist), the first round stands, which is a step of
/// [`Rule::Imex`]; the system is told of each ([`System::gave_up`]).
/// [`Rule::GradientFlow`] leaves out μ whatever it is.
#[derive(Debug, Clone)]
pub(crate) struct Euler {
    rule: Rule,
    clock: Clock,
    solver: Solver,
    /// Everything on the right but the external force.
    base: Vec<DVec2>,
    force: Vec<DVec2>,
    first: Vec<DVec2>,
    next_x: Vec<DVec2>,
    next_v: Vec<DVec2>,
    contacts: Contacts,
}

impl Euler {
    pub(crate) fn new(
        rule: Rule,
        system: &mut dyn System,
        state: &State,
        dt: f64,
    ) -> Result<Self, SchemeError> {
        system.advance(state.t, &state.x);
        let (need, p) = match rule {
            Rule::GradientFlow => (Mass::Optional, 0.0),
            Rule::Backward | Rule::Imex => (Mass::Needed, 1.0 / (dt * dt)),
        };
        stepper::check(rule.name(), system, state, dt, need)?;
        let zeros = || vec![DVec2::ZERO; state.len()];
        Ok(Self {
            rule,
            clock: Clock::new(state, dt),
            solver: Solver::new(rule.name(), need, system, (p, 1.0 / dt))?,
            base: zeros(),
            force: zeros(),
            first: zeros(),
            next_x: zeros(),
            next_v: zeros(),
            contacts: Contacts::new(state.len()),
        })
    }

    /// Solve with the external force in `force`, and leave the increment there.
    fn increment(&mut self) {
        each::onto([&self.base], &mut self.force, |[base], force| force + base);
        self.solver.solve(&mut self.force);
    }

    /// Where the increment leads; whether to a place.
    fn place(&mut self, x: &[DVec2]) -> bool {
        let rate = 1.0 / self.clock.dt;
        let to = [&mut self.next_x[..], &mut self.next_v[..]];
        each::both([x, &self.force], to, move |[x, step]| {
            (x + step, step * rate)
        })
    }

    /// Inertia joins the forces.
    fn carry(&mut self, system: &dyn System, v: &[DVec2]) {
        if self.rule != Rule::GradientFlow {
            let rate = 1.0 / self.clock.dt;
            let mass = self.solver.masses(system);
            each::weighted_onto(mass, [v], &mut self.force, move |[mass], [v], force| {
                force + (mass * rate) * v
            });
        }
        stepper::release(system.held(), &mut self.force);
    }

    /// Rounds with the external force where the last round ended.
    fn settle(&mut self, system: &mut dyn System, x: &[DVec2]) -> Result<(), Fault> {
        self.first.copy_from_slice(&self.force);
        let mut change = f64::INFINITY;
        for _ in 0..ROUNDS {
            let (next_x, next_v) = (&self.next_x, &self.next_v);
            if stepper::finite(next_x).is_err() {
                break;
            }
            stepper::external(system, self.clock.next(), next_x, next_v, &mut self.force)?;
            self.increment();
            let (mut moved, mut size) = (0.0_f64, 0.0_f64);
            for i in 0..x.len() {
                let before = self.next_x[i] - x[i];
                moved = moved.max((self.force[i] - before).abs().max_element());
                size = size.max(self.force[i].abs().max_element());
            }
            self.place(x);
            if moved <= AGREEMENT * size {
                return Ok(());
            }
            if moved.is_nan() || moved >= change {
                break;
            }
            change = moved;
        }
        self.force.copy_from_slice(&self.first);
        self.place(x);
        system.gave_up();
        Ok(())
    }
}

impl Stepper for Euler {
    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }

    fn step(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), Fault> {
        let (dt, t) = (self.clock.dt, self.clock.now());
        let end = self.clock.next();
        let at = if self.rule == Rule::Backward { end } else { t };
        self.solver.advance(system, at, &state.x)?;
        let mut finite = false;
        if self.rule == Rule::Backward && !system.external_is_constant() {
            system.elastic(&state.x, &mut self.force);
            self.carry(system, &state.v);
            self.base.copy_from_slice(&self.force);
            stepper::external(system, at, &state.x, &state.v, &mut self.force)?;
            self.increment();
            self.place(&state.x);
            self.settle(system, &state.x)?;
        } else {
            stepper::force(system, at, &state.x, &state.v, &mut self.force)?;
            self.carry(system, &state.v);
            self.solver.solve(&mut self.force);
            finite = self.place(&state.x);
        }
        if !finite {
            stepper::finite(&self.next_x)?;
        }
        let moment = Moment {
            t: end,
            dt,
            pace: Pace::Together { way: 1.0 },
        };
        let (x, v) = (&mut self.next_x, &mut self.next_v);
        self.contacts
            .meet_with(system, moment, &state.x, x, v, Some(&mut self.solver))?;
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
    }
}
