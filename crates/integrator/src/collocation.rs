//! High order at one complex solve a step.
//!
//! A collocation method solves for all its stages at once. For `μ v̇ + γ v + A x = f` its equations
//! fall apart into one banded system for each eigenvalue `z` of the inverse of its coefficients,
//! `(z² μ/dt² + z γ/dt + A) ξ = …`, and of a complex pair only one is needed.

use banded::{Complex, ComplexOperatorFactor, ComplexPoint};
use glam::DVec2;

use crate::contact::Contacts;
use crate::newmark::StandIn;
use crate::solver::Solver;
use crate::stepper::{self, Clock, Mass, Seen};
use crate::tableau::{Eigenpair, Method, Tableau};
use crate::{Fault, SchemeError, State, Stepper, System, each};

/// How often the external forces at the stages are asked for again.
const ROUNDS: usize = 30;

/// When two rounds agree, relative to the largest external force.
const AGREEMENT: f64 = 1e-13;

/// How the end of a step depends on the solution of each eigenvalue's system.
#[derive(Debug, Clone, Copy)]
struct Share {
    /// Twice the weight of which the real part counts.
    complex: Complex,
    real: f64,
}

/// Where a step ends: `x⁺ = x + place`, `v⁺ = keep v + speed`.
#[derive(Debug, Clone, Copy)]
struct Landing {
    place: Share,
    speed: Share,
    keep: f64,
}

impl Landing {
    fn new(method: Method, tableau: &Tableau, dt: f64) -> Self {
        // in terms of the stages' offsets; velocities at the stages are B times those, over dt
        let (end, keep) = match method {
            Method::Radau5 => ([0.0, 0.0, 1.0], 0.0),
            Method::Gauss4 => ([-3.0_f64.sqrt(), 3.0_f64.sqrt(), 0.0], 1.0),
        };
        let fast = |j: usize| (0..3).map(|i| end[i] * tableau.inverse[i][j]).sum::<f64>() / dt;
        let share = |weights: [f64; 3]| {
            let right = tableau.complex.right;
            let pair = |k: usize| right[k] * (2.0 * weights[k]);
            let own = |real: Eigenpair<f64>| (0..3).map(|k| real.right[k] * weights[k]).sum();
            Share {
                complex: pair(0) + pair(1) + pair(2),
                real: tableau.real.map_or(0.0, own),
            }
        };
        Self {
            place: share(end),
            speed: share([fast(0), fast(1), fast(2)]),
            keep,
        }
    }
}

/// Gauss's method of order 4 or Radau's of order 5, external forces at every stage.
///
/// External forces are found in rounds with the same factors: one when they are constant, two when they
/// do not depend on positions, a few when they change less over a step than inertia and stiffness resist. Where they
/// change more, rounds stop when they no longer approach each other, and order is lost.
#[derive(Debug, Clone)]
pub(crate) struct Collocation {
    method: Method,
    tableau: Tableau,
    landing: Landing,
    clock: Clock,
    /// The real eigenvalue's system, which Gauss's method has none of.
    real: Option<Solver>,
    complex: ComplexOperatorFactor,
    /// For the steps in which something is touched.
    stand_in: StandIn,
    shift: Vec<Complex>,
    elastic: Vec<DVec2>,
    /// External forces at the stages.
    forces: Vec<Vec<DVec2>>,
    /// How far each stage is from the start.
    offsets: Vec<Vec<DVec2>>,
    fresh: Vec<DVec2>,
    real_part: Vec<DVec2>,
    complex_part: Vec<ComplexPoint>,
    next_x: Vec<DVec2>,
    next_v: Vec<DVec2>,
    seen: Seen,
    contacts: Contacts,
}

impl Collocation {
    pub(crate) fn new(
        method: Method,
        system: &mut dyn System,
        state: &State,
        dt: f64,
    ) -> Result<Self, SchemeError> {
        system.advance(state.t, &state.x);
        let name = method.name();
        stepper::check(name, system, state, dt, method.need())?;
        let tableau = Tableau::new(method);
        let n = state.len();
        let real = tableau.real.map(|Eigenpair { z, .. }| {
            Solver::new(name, method.need(), system, (z * z / (dt * dt), z / dt))
        });
        let mut shift = vec![Complex::default(); n];
        fill(&mut shift, system, tableau.complex.z, dt);
        let zeros = || vec![DVec2::ZERO; n];
        Ok(Self {
            method,
            clock: Clock::new(state, dt),
            real: real.transpose()?,
            stand_in: StandIn::new(name, method.need(), dt),
            complex: system.stiffness().factor_shifted(&shift)?,
            shift,
            elastic: zeros(),
            forces: vec![zeros(); tableau.stages],
            offsets: vec![zeros(); tableau.stages],
            fresh: zeros(),
            real_part: zeros(),
            complex_part: vec![ComplexPoint::default(); n],
            next_x: zeros(),
            next_v: zeros(),
            seen: Seen::of(system),
            contacts: Contacts::new(n),
            landing: Landing::new(method, &tableau, dt),
            tableau,
        })
    }

    fn advance(&mut self, system: &mut dyn System, t: f64, x: &[DVec2]) -> Result<(), Fault> {
        if self.seen.left_behind(system, t, x) {
            self.seen = Seen::of(system);
            self.stand_in.rebuild(system, x)?;
            if let Some(real) = &mut self.real {
                real.rebuild(system, x)?;
            }
            fill(
                &mut self.shift,
                system,
                self.tableau.complex.z,
                self.clock.dt,
            );
            let factor = system.stiffness().factor_shifted(&self.shift);
            self.complex = factor.map_err(|_| stepper::unsolvable(x))?;
        }
        Ok(())
    }

    /// Solve for all stages with the external forces as they are.
    fn solve(&mut self, system: &dyn System, v: &[DVec2]) {
        let (mass, held, dt) = (system.mass(), system.held(), self.clock.dt);
        let stages = self.tableau.stages;
        let complex = self.tableau.complex;
        let total = complex.left[..stages]
            .iter()
            .fold(Complex::default(), |sum, &p| sum + p);
        for i in 0..v.len() {
            let mut sum = ComplexPoint::default();
            if !held[i] {
                let start = self.elastic[i];
                sum = ComplexPoint::from(start) * total
                    + ComplexPoint::from(mass[i] / dt * v[i]) * (complex.z * total);
                for (force, &p) in self.forces.iter().zip(&complex.left) {
                    sum = sum + ComplexPoint::from(force[i]) * p;
                }
            }
            self.complex_part[i] = sum;
        }
        self.complex.solve(&mut self.complex_part);
        if let (Some(real), Some(solver)) = (self.tableau.real, &self.real) {
            let total: f64 = real.left[..stages].iter().sum();
            for i in 0..v.len() {
                let mut sum = DVec2::ZERO;
                if !held[i] {
                    sum = total * (self.elastic[i] + real.z * mass[i] / dt * v[i]);
                    for (force, &p) in self.forces.iter().zip(&real.left) {
                        sum += p * force[i];
                    }
                }
                self.real_part[i] = sum;
            }
            solver.solve(&mut self.real_part);
        }
        for (stage, offset) in self.offsets.iter_mut().enumerate() {
            let u = complex.right[stage];
            for i in 0..v.len() {
                let pair = self.complex_part[i];
                offset[i] = 2.0 * (u.re * pair.re - u.im * pair.im);
            }
            if let Some(real) = self.tableau.real {
                for (offset, part) in offset.iter_mut().zip(&self.real_part) {
                    *offset += real.right[stage] * *part;
                }
            }
        }
    }

    /// Position and velocity at a stage, in `next_x` and `next_v`.
    fn place(&mut self, stage: usize, x: &[DVec2]) {
        let dt = self.clock.dt;
        for i in 0..x.len() {
            let mut v = DVec2::ZERO;
            for (j, offset) in self.offsets.iter().enumerate() {
                v += self.tableau.inverse[stage][j] * offset[i];
            }
            self.next_x[i] = x[i] + self.offsets[stage][i];
            self.next_v[i] = v / dt;
        }
    }

    /// Solve, ask for the external forces again, and so on until they stay the same.
    fn settle(&mut self, system: &mut dyn System, state: &State) -> Result<(), Fault> {
        let (t, dt) = (self.clock.now(), self.clock.dt);
        let mut change = f64::INFINITY;
        for _ in 0..ROUNDS {
            self.solve(system, &state.v);
            let (mut moved, mut size) = (0.0_f64, 0.0_f64);
            for stage in 0..self.tableau.stages {
                self.place(stage, &state.x);
                stepper::finite(&self.next_x)?;
                let at = t + self.tableau.nodes[stage] * dt;
                stepper::external(system, at, &self.next_x, &self.next_v, &mut self.fresh)?;
                for (old, &new) in self.forces[stage].iter_mut().zip(&self.fresh) {
                    moved = moved.max((new - *old).abs().max_element());
                    size = size.max(new.abs().max_element());
                    *old = new;
                }
            }
            if moved <= AGREEMENT * size {
                return Ok(());
            }
            if moved >= change {
                break;
            }
            change = moved;
        }
        system.gave_up();
        self.solve(system, &state.v);
        Ok(())
    }

    /// The whole step under forces that stay the same, which `elastic` holds: one round, and the end from
    /// the solutions without the stages between.
    fn straight(&mut self, system: &dyn System, state: &State) {
        let (mass, held, dt) = (system.mass(), system.held(), self.clock.dt);
        let n = state.len();
        let (x, v, force) = (&state.x[..n], &state.v[..n], &self.elastic[..n]);
        let complex = self.tableau.complex;
        let sum = complex
            .left
            .iter()
            .fold(Complex::default(), |sum, &p| sum + p);
        let moved = complex.z * sum * (1.0 / dt);
        for (i, part) in self.complex_part[..n].iter_mut().enumerate() {
            let (push, carried) = if held[i] {
                (DVec2::ZERO, DVec2::ZERO)
            } else {
                (force[i], mass[i] * v[i])
            };
            *part = ComplexPoint::new(
                sum.re * push + moved.re * carried,
                sum.im * push + moved.im * carried,
            );
        }
        self.complex.solve(&mut self.complex_part);
        let (place, speed) = (self.landing.place, self.landing.speed);
        let keep = self.landing.keep;
        let parts = &self.complex_part[..n];
        let (next_x, next_v) = (&mut self.next_x[..n], &mut self.next_v[..n]);
        for i in 0..n {
            let part = parts[i];
            next_x[i] = x[i] + (place.complex.re * part.re - place.complex.im * part.im);
            next_v[i] = keep * v[i] + (speed.complex.re * part.re - speed.complex.im * part.im);
        }
        if let (Some(real), Some(solver)) = (self.tableau.real, &self.real) {
            let sum: f64 = real.left.iter().sum();
            let moved = sum * real.z / dt;
            for (i, part) in self.real_part[..n].iter_mut().enumerate() {
                *part = if held[i] {
                    DVec2::ZERO
                } else {
                    sum * force[i] + moved * mass[i] * v[i]
                };
            }
            solver.solve(&mut self.real_part);
            let parts = &self.real_part[..n];
            for i in 0..n {
                next_x[i] += place.real * parts[i];
                next_v[i] += speed.real * parts[i];
            }
        }
    }

    /// The end of the step from its stages.
    fn finish(&mut self, state: &State) {
        if self.method == Method::Radau5 {
            self.place(2, &state.x);
            return;
        }
        // x⁺ = x + √3 (ξ₂ − ξ₁), and the same for velocities
        let root = 3.0_f64.sqrt();
        self.place(0, &state.x);
        for i in 0..state.len() {
            self.fresh[i] = self.next_v[i];
        }
        self.place(1, &state.x);
        for i in 0..state.len() {
            self.next_x[i] = state.x[i] + root * (self.offsets[1][i] - self.offsets[0][i]);
            self.next_v[i] = state.v[i] + root * (self.next_v[i] - self.fresh[i]);
        }
    }
}

impl Stepper for Collocation {
    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }

    fn step(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), Fault> {
        let (dt, t) = (self.clock.dt, self.clock.now());
        if system.depends_on_place() {
            let mut middle = std::mem::take(&mut self.next_x);
            each::onto([&state.x, &state.v], &mut middle, move |[x, v], _| {
                x + 0.5 * dt * v
            });
            let advanced = self.advance(system, t + 0.5 * dt, &middle);
            self.next_x = middle;
            advanced?;
        } else {
            self.advance(system, t + 0.5 * dt, &state.x)?;
        }
        system.elastic(&state.x, &mut self.elastic);
        if system.external_is_constant() {
            system.external(t, &state.x, &state.v, &mut self.elastic)?;
            self.straight(system, state);
        } else {
            for (stage, force) in self.forces.iter_mut().enumerate() {
                let at = t + self.tableau.nodes[stage] * dt;
                stepper::external(system, at, &state.x, &state.v, force)?;
            }
            self.settle(system, state)?;
            self.finish(state);
        }
        for (v, &held) in self.next_v.iter_mut().zip(system.held()) {
            if held {
                *v = DVec2::ZERO;
            }
        }
        stepper::finite(&self.next_x)?;
        if self
            .contacts
            .find(system, dt, &state.x, &self.next_x, &self.next_v)
        {
            self.stand_in.take(system, t, state)?;
            self.clock.tick(state);
            return Ok(());
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
    }
}

fn fill(shift: &mut [Complex], system: &dyn System, z: Complex, dt: f64) {
    let (p, q) = (z * z * (1.0 / (dt * dt)), z * (1.0 / dt));
    for (i, shift) in shift.iter_mut().enumerate() {
        *shift = if system.held()[i] {
            Complex::from(1.0)
        } else {
            p * system.mass()[i] + q * system.damping()[i]
        };
    }
}

impl Method {
    /// Radau's velocities come from the positions alone, so it does without mass.
    const fn need(self) -> Mass {
        match self {
            Self::Gauss4 => Mass::Needed,
            Self::Radau5 => Mass::Optional,
        }
    }
}
