//! The workhorse: two steps back, one solve, strong damping of what is too fast to follow.

use glam::DVec2;

use crate::contact::Contacts;
use crate::impulse::{Moment, Pace};
use crate::solver::Solver;
use crate::stepper::{self, Clock, Mass};
use crate::{Fault, SchemeError, State, Stepper, System, each};

/// Backward differences of order 2, with the external force extrapolated.
///
/// ```text
/// v⁺ = (3 x⁺ − 4 x + x₋) / (2 dt)
/// μ (3 v⁺ − 4 v + v₋) / (2 dt) + γ v⁺ = elastic(x⁺) + 2 f − f₋
/// (9μ/(4dt²) + 3γ/(2dt) + A) δ = elastic(x) + 2 f − f₋ + μ (3 d/(4dt²) + (4v − v₋)/(2dt)) + γ d/(2dt)
/// ```
///
/// with `δ = x⁺ − x` and `d = x − x₋`, which keeps what `x` and `x₋` would lose to rounding. The first
/// step is Euler's, whose single error of order dt² costs no order. Does without mass where there
/// is damping. A touch is an impulse: its change of velocity is added to the past as well, so that the
/// acceleration that the past stands for stays.
///
/// [ascher95].
#[derive(Debug, Clone)]
pub(crate) struct Sbdf2 {
    clock: Clock,
    solver: Solver,
    /// Euler's matrix, for the first step.
    starter: Solver,
    starts: bool,
    /// Whether a schedule has left it behind.
    stale: bool,
    /// x − x₋, v₋ and f₋.
    last_x: Vec<DVec2>,
    last_v: Vec<DVec2>,
    last_f: Vec<DVec2>,
    /// x and v at the end of the last step, v as someone else has changed it since.
    ended: (Vec<DVec2>, Vec<DVec2>),
    force: Vec<DVec2>,
    external: Vec<DVec2>,
    next_x: Vec<DVec2>,
    next_v: Vec<DVec2>,
    contacts: Contacts,
}

impl Sbdf2 {
    pub(crate) const NAME: &'static str = "sbdf2";

    pub(crate) fn new(
        system: &mut dyn System,
        state: &State,
        dt: f64,
    ) -> Result<Self, SchemeError> {
        system.advance(state.t, &state.x);
        stepper::check(Self::NAME, system, state, dt, Mass::Optional)?;
        let solver = |p: f64, q: f64| {
            Solver::new(Self::NAME, Mass::Optional, system, (p / (dt * dt), q / dt))
        };
        let zeros = || vec![DVec2::ZERO; state.len()];
        Ok(Self {
            clock: Clock::new(state, dt),
            solver: solver(2.25, 1.5)?,
            starter: solver(1.0, 1.0)?,
            starts: true,
            stale: false,
            last_x: zeros(),
            last_v: zeros(),
            last_f: zeros(),
            ended: (zeros(), zeros()),
            force: zeros(),
            external: zeros(),
            next_x: zeros(),
            next_v: zeros(),
            contacts: Contacts::new(state.len()),
        })
    }

    /// Sum up the right-hand side of the first step or a later one.
    fn gather(&mut self, system: &dyn System, state: &State) {
        let dt = self.clock.dt;
        let densities = self.solver.densities(system);
        let (v, f) = (&state.v[..], &self.external[..]);
        if self.starts {
            each::weighted_onto(
                densities,
                [v, f],
                &mut self.force,
                move |[mass, _], [v, f], force| force + (f + mass / dt * v),
            );
        } else {
            let from = [&self.last_x[..], v, &self.last_v, f, &self.last_f];
            let (per_dt2, per_dt) = (0.75 / (dt * dt), 1.0 / (2.0 * dt));
            each::weighted_onto(
                densities,
                from,
                &mut self.force,
                move |[mass, damping], [d, v, last_v, f, last_f], force| {
                    let inertia = per_dt2 * d + (4.0 * v - last_v) * per_dt;
                    force + ((2.0 * f - last_f + mass * inertia) + damping * per_dt * d)
                },
            );
        }
        stepper::release(system.held(), &mut self.force);
    }
}

impl Stepper for Sbdf2 {
    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }

    fn step(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), Fault> {
        let (dt, t) = (self.clock.dt, self.clock.now());
        self.stale |= self.solver.advance(system, t, &state.x)?;
        if self.starts && self.stale {
            self.starter.rebuild(system, &state.x)?;
            self.stale = false;
        }
        system.elastic(&state.x, &mut self.force);
        stepper::external(system, t, &state.x, &state.v, &mut self.external)?;
        self.gather(system, state);
        let starts = self.starts;
        let solver = if starts {
            &mut self.starter
        } else {
            &mut self.solver
        };
        solver.solve(&mut self.force);
        let from = [&state.x[..], &self.force, &self.last_x];
        let to = [&mut self.next_x[..], &mut self.next_v];
        let per_dt = if starts { 1.0 / dt } else { 1.0 / (2.0 * dt) };
        let (now, before) = if starts { (1.0, 0.0) } else { (3.0, 1.0) };
        let finite = each::both(from, to, move |[x, step, last]| {
            (x + step, (now * step - before * last) * per_dt)
        });
        if !finite {
            stepper::finite(&self.next_x)?;
        }
        let moment = Moment {
            t: t + dt,
            dt,
            pace: Pace::Together { way: 0.5 },
        };
        let (x, v) = (&mut self.next_x, &mut self.next_v);
        let touched = self
            .contacts
            .meet_with(system, moment, &state.x, x, v, Some(solver))?;
        each::onto([x, &state.x], &mut self.last_x, |[x, before], _| x - before);
        self.last_v.copy_from_slice(&state.v);
        if touched {
            // the past as if the node had always had what the touch gave it: its acceleration stays
            let (free_x, free_v) = self.contacts.before();
            for i in 0..v.len() {
                let given = v[i] - free_v[i];
                if given != DVec2::ZERO {
                    self.last_x[i] = free_x[i] - state.x[i] + dt * given;
                    self.last_v[i] += given;
                }
            }
        }
        std::mem::swap(&mut self.last_f, &mut self.external);
        std::mem::swap(&mut state.x, x);
        std::mem::swap(&mut state.v, v);
        self.ended.0.copy_from_slice(&state.x);
        self.ended.1.copy_from_slice(&state.v);
        self.starts = false;
        self.clock.tick(state);
        Ok(())
    }

    fn dt(&self) -> f64 {
        self.clock.dt
    }

    fn resume(&mut self, _system: &mut dyn System, state: &State) {
        if (self.clock.now() - state.t).abs() > 1e-9 * self.clock.dt {
            self.starts = true;
        } else if state.x == self.ended.0 {
            // a kick from outside is given to the past as well, as a touch is
            let dt = self.clock.dt;
            for i in 0..state.len() {
                let given = state.v[i] - self.ended.1[i];
                self.last_x[i] += dt * given;
                self.last_v[i] += given;
                self.ended.1[i] = state.v[i];
            }
        } else {
            // x₋ is where the last step began
            for i in 0..state.len() {
                self.last_x[i] = state.x[i] - self.next_x[i];
            }
        }
        self.clock.restart(state);
    }
}
