//! To rest by the shortest way: the step grows as the forces die, and in the end it is Newton's.
//!
//! A scheme of equal steps takes as many of them as the slowest part of a curve takes time. Where
//! only the rest matters, the step can grow when little moves: this is pseudo-transient
//! continuation.

use glam::DVec2;

use crate::contact::Contacts;
use crate::impulse::{Moment, Pace};
use crate::linear::{Counts, Sloped};
use crate::solver::Solver;
use crate::stepper::{self, Clock, Mass};
use crate::{Fault, SchemeError, State, Stepper, System};

/// What mass and damping add to the matrix is at least this share of its largest entry, so that a
/// motion that nothing resists still has a solution. It bounds the step.
const LEAST_SHARE: f64 = 1e-6;

/// A step that ends where the forces, along it, are below minus this share of what they were at its
/// start has gone too far.
const OVERSHOT: f64 = 0.1;

/// So many steps that have not gone too far must follow one that has before a step grows again: at
/// a kink of the force, shorter steps have come to its place of balance by then.
const PAUSE: u32 = 8;

/// The factor by which a step grows when it may.
const GROWS: f64 = 2.0;

/// How often a step may be tried again with a shorter one.
const TRIES: usize = 60;

/// To a place of rest, in steps that grow.
///
/// ```text
/// (μ/(θ dt)² + γ/(θ dt) − G + A) δ = (elastic(x) + f(t, x))/θ + μ v/(θ² dt)
/// x⁺ = x + δ,   v⁺ = v + (δ/dt − v)/θ
/// ```
///
/// `G` is the symmetric part of ∂f/∂x, or where the matrix is then not positive definite, the part
/// of it that pulls back, as in [`Scheme::LinearlyImplicit`](crate::Scheme). Short steps, up to 2
/// μ/γ, follow the motion to second order, inertia included (θ = ½): which of several places of
/// rest is found is up to the motion. Longer ones are Euler's (θ = 1), and in the end Newton's step
/// towards rest, which converges as fast. The step is chosen so that
///
/// - no node is moved farther than `reach`, within which the force may be taken for linear;
/// - it doubles where the nodes move by less than half of that, and a long one is halved where the
///   forces at its end point back: Σ F(x⁺)·δ < −0.1 Σ F(x)·δ; then it waits a while before it
///   doubles again.
///
/// Time goes on by the chosen steps. A place of rest is one of the system, whatever `reach`, mass
/// and damping; which one is found may depend on them. Without damping there is no rest. One force,
/// its slope and one or more factors of a wide band a step: O(n p²).
///
/// \[kelley98\]; for short steps \[rosenbrock63\] with one stage.
#[derive(Debug, Clone)]
pub struct Relaxation {
    clock: Clock,
    /// Without the slopes: for contacts, and for systems that know none.
    solver: Solver,
    sloped: Sloped,
    reach: f64,
    /// The first step, also after a change of the system.
    first: f64,
    /// The longest step that follows inertia, and the longest of all.
    inertial: f64,
    most: f64,
    /// Begin with the first step again.
    again: bool,
    /// What the last step was, and what the forces did along it; None before.
    last: Option<f64>,
    /// Steps to go until one may grow.
    pause: u32,
    /// How far the nodes have been moved by the last step, at most.
    moved: f64,
    solves: u64,
    /// The net force at the beginning of the step.
    net: Vec<DVec2>,
    /// The right-hand side of the step.
    force: Vec<DVec2>,
    step: Vec<DVec2>,
    next_x: Vec<DVec2>,
    next_v: Vec<DVec2>,
    contacts: Contacts,
}

impl Relaxation {
    /// The word for it.
    pub const NAME: &'static str = "relaxation";

    /// From `state`, with a first step of `dt` and no node moved by more than `reach` in a step. T,
    /// L.
    ///
    /// # Errors
    ///
    /// As [`Scheme::start`](crate::Scheme::start); a `reach` that is not finite and above 0.
    pub fn new(
        system: &mut dyn System,
        state: &State,
        dt: f64,
        reach: f64,
    ) -> Result<Self, SchemeError> {
        system.advance(state.t, &state.x);
        stepper::check(Self::NAME, system, state, dt, Mass::Optional)?;
        if !(reach.is_finite() && reach > 0.0) {
            return Err(SchemeError::BadReach { reach });
        }
        let n = state.len();
        let zeros = || vec![DVec2::ZERO; n];
        let mut made = Self {
            clock: Clock::new(state, dt),
            solver: Solver::new(Self::NAME, Mass::Optional, system, (1.0, 1.0))?,
            sloped: Sloped::new(system)?,
            reach,
            first: dt,
            inertial: 0.0,
            most: f64::INFINITY,
            again: true,
            last: None,
            pause: 0,
            moved: 0.0,
            solves: 0,
            net: zeros(),
            force: zeros(),
            step: zeros(),
            next_x: zeros(),
            next_v: zeros(),
            contacts: Contacts::new(n),
        };
        made.bound(system);
        Ok(made)
    }

    /// How often a matrix has been factored and solved so far: once a step, and once more for each
    /// step that was tried again.
    #[must_use]
    pub const fn solves(&self) -> u64 {
        self.solves
    }

    /// How far the last step has moved the nodes at most. L.
    #[must_use]
    pub const fn moved(&self) -> f64 {
        self.moved
    }

    /// The longest step that follows inertia, and the longest at which every node is still
    /// resisted.
    fn bound(&mut self, system: &dyn System) {
        let stiff = system.stiffness().band().diagonal();
        let stiffest = stiff.iter().copied().fold(0.0, f64::max);
        let least = LEAST_SHARE * stiffest;
        let held = system.held();
        let free = (0..system.len()).filter(|&i| !held[i]);
        (self.inertial, self.most) = (f64::INFINITY, f64::INFINITY);
        for i in free {
            let (mass, damping) = (system.mass()[i], system.damping()[i]);
            if damping > 0.0 {
                self.inertial = self.inertial.min(2.0 * mass / damping);
            }
            // mass/dt² + damping/dt = least
            let rate = 2.0 * least / (damping + (damping * damping + 4.0 * mass * least).sqrt());
            self.most = self.most.min(1.0 / rate);
        }
        // without stiffness any step will do, and the first is as good
        if !self.most.is_finite() {
            self.most = self.first;
        }
        self.most = self.most.max(self.first);
    }

    /// θ of a step.
    fn theta(&self, dt: f64) -> f64 {
        if dt <= self.inertial { 0.5 } else { 1.0 }
    }

    /// Steps of that length from now on.
    fn change(&mut self, system: &dyn System, dt: f64, state: &State) -> Result<(), Fault> {
        self.clock = Clock::new(state, dt);
        // what mass and damping count in the matrix
        let rate = 1.0 / (self.theta(dt) * dt);
        self.solver.reweigh(system, (rate * rate, rate), &state.x)
    }

    /// How long the next step is to be, by what the last one has come to.
    fn chosen(&mut self) -> f64 {
        let dt = self.clock.dt;
        let Some(before) = self.last.filter(|_| !self.again) else {
            self.pause = 0;
            return self.first;
        };
        let waits = self.pause > 0;
        self.pause = self.pause.saturating_sub(1);
        let long = self.theta(dt) >= 1.0;
        if long && dot(&self.net, &self.step) < -OVERSHOT * before {
            self.pause = PAUSE;
            0.5 * dt
        } else if !waits && 2.0 * self.moved <= self.reach {
            (GROWS * dt).min(self.most)
        } else {
            dt
        }
    }

    /// The right-hand side of a step.
    fn gather(&mut self, system: &dyn System, v: &[DVec2]) {
        let (dt, theta) = (self.clock.dt, self.theta(self.clock.dt));
        let (push, carry) = (1.0 / theta, 1.0 / (theta * theta * dt));
        let mass = system.mass();
        for (i, force) in self.force.iter_mut().enumerate() {
            *force = push * self.net[i] + carry * mass[i] * v[i];
        }
        stepper::release(system.held(), &mut self.force);
    }

    /// Solve with all of the slopes, or where that has no least, with what pulls back.
    fn newton(&mut self, system: &dyn System) -> Result<(), SchemeError> {
        let (matrix, held) = (self.solver.matrix(), system.held());
        for counts in [Counts::All, Counts::PullingBack] {
            self.step.copy_from_slice(&self.force);
            self.solves += 1;
            let solved = self.sloped.solve(matrix, held, counts, &mut self.step);
            let downhill = solved.is_ok() && dot(&self.force, &self.step) > 0.0;
            if downhill || counts == Counts::PullingBack {
                return solved;
            }
        }
        Ok(())
    }

    /// Find the increment of the present step, and where it leads.
    fn place(&mut self, system: &dyn System, state: &State, known: bool) -> Result<(), Fault> {
        for tried in 0..TRIES {
            self.gather(system, &state.v);
            if known {
                self.newton(system)
                    .map_err(|_| stepper::unsolvable(&state.x))?;
            } else {
                self.step.copy_from_slice(&self.force);
                self.solver.solve(&mut self.step);
                self.solves += 1;
            }
            stepper::finite(&self.step)?;
            self.moved = longest(&self.step);
            if self.moved <= self.reach || tried + 1 == TRIES {
                break;
            }
            // a step of few nodes is as long as their inertia allows: at most a quarter at a time
            let share = (0.9 * self.reach / self.moved).clamp(0.25, 0.9);
            self.change(system, share * self.clock.dt, state)?;
        }
        let (rate, turn) = (1.0 / self.clock.dt, 1.0 / self.theta(self.clock.dt));
        for i in 0..state.len() {
            self.next_x[i] = state.x[i] + self.step[i];
            self.next_v[i] = state.v[i] + (self.step[i] * rate - state.v[i]) * turn;
        }
        stepper::finite(&self.next_x)
    }
}

fn longest(steps: &[DVec2]) -> f64 {
    let squares = steps.iter().map(|step| step.length_squared());
    squares.fold(0.0, f64::max).sqrt()
}

fn dot(a: &[DVec2], b: &[DVec2]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}

impl Stepper for Relaxation {
    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }

    fn step(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), Fault> {
        let t = self.clock.now();
        if self.solver.advance(system, t, &state.x)? {
            let renewed = self.sloped.renew(system);
            renewed.map_err(|_| stepper::unsolvable(&state.x))?;
            self.bound(system);
        }
        stepper::force(system, t, &state.x, &state.v, &mut self.net)?;
        stepper::release(system.held(), &mut self.net);
        let dt = self.chosen();
        if self.again || (dt - self.clock.dt).abs() > 0.0 {
            self.change(system, dt, state)?;
            self.again = false;
        }
        let known = self.sloped.look(system, t, &state.x);
        self.place(system, state, known)?;
        let moment = Moment {
            t: self.clock.next(),
            dt: self.clock.dt,
            pace: Pace::Together {
                way: self.theta(self.clock.dt),
            },
        };
        let (x, v) = (&mut self.next_x, &mut self.next_v);
        let touched =
            self.contacts
                .meet_with(system, moment, &state.x, x, v, Some(&mut self.solver))?;
        if touched {
            // what a wall has stopped has not moved
            for i in 0..state.len() {
                self.step[i] = x[i] - state.x[i];
            }
        }
        self.moved = longest(&self.step);
        self.last = Some(dot(&self.force, &self.step));
        std::mem::swap(&mut state.x, x);
        std::mem::swap(&mut state.v, v);
        self.clock.tick(state);
        Ok(())
    }

    fn dt(&self) -> f64 {
        self.clock.dt
    }

    fn resume(&mut self, _system: &mut dyn System, state: &State) {
        self.again = true;
        self.clock.restart(state);
    }
}
