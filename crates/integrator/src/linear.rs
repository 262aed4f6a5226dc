//! The slope of the external force in the matrix: for edges that hold fast.
//!
//! On an edge the image pulls a node back like a stiff spring along the normal. An explicit force
//! limits the step there; here the spring is part of the matrix, with x and y of each node coupled.

use banded::{Band, Banded, BandedFactor, Dense, Operator};
use glam::{DMat2, DVec2};

use crate::contact::Contacts;
use crate::impulse::{Moment, Pace};
use crate::solver::Solver;
use crate::stepper::{self, Clock, Mass};
use crate::{Fault, SchemeError, State, Stepper, System};

/// Euler's method with elastic force, damping and the external slope at the end of the step.
///
/// ```text
/// (μ/dt² + γ/dt − G + A) δ = elastic(x) + f(t, x, v) + μ v / dt,   x⁺ = x + δ,   v⁺ = δ / dt
/// ```
///
/// `G` is the part of ∂f/∂x that pulls back: its symmetric part without what is above zero, so that the
/// matrix is positive definite at any step; what pushes away is left explicit. Where the system
/// knows no slope, or a constant force, it is the scheme named imex. Factors a band twice as wide each step. O(n p²).
///
/// [baraff98].
#[derive(Debug, Clone)]
pub(crate) struct LinearlyImplicit {
    clock: Clock,
    /// Without the slope: for contacts, and for systems that know none.
    solver: Solver,
    sloped: Sloped,
    force: Vec<DVec2>,
    external: Vec<DVec2>,
    next_x: Vec<DVec2>,
    next_v: Vec<DVec2>,
    contacts: Contacts,
}

impl LinearlyImplicit {
    pub(crate) const NAME: &'static str = "linearly-implicit";

    pub(crate) fn new(
        system: &mut dyn System,
        state: &State,
        dt: f64,
    ) -> Result<Self, SchemeError> {
        system.advance(state.t, &state.x);
        stepper::check(Self::NAME, system, state, dt, Mass::Optional)?;
        let n = state.len();
        let weights = (1.0 / (dt * dt), 1.0 / dt);
        let zeros = || vec![DVec2::ZERO; n];
        Ok(Self {
            clock: Clock::new(state, dt),
            solver: Solver::new(Self::NAME, Mass::Optional, system, weights)?,
            sloped: Sloped::new(system)?,
            force: zeros(),
            external: zeros(),
            next_x: zeros(),
            next_v: zeros(),
            contacts: Contacts::new(n),
        })
    }
}

impl Stepper for LinearlyImplicit {
    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }

    fn step(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), Fault> {
        let (dt, t) = (self.clock.dt, self.clock.now());
        if self.solver.advance(system, t, &state.x)? {
            let renewed = self.sloped.renew(system);
            renewed.map_err(|_| stepper::unsolvable(&state.x))?;
        }
        stepper::external(system, t, &state.x, &state.v, &mut self.external)?;
        let known = self.sloped.look(system, t, &state.x);
        system.elastic(&state.x, &mut self.force);
        for i in 0..state.len() {
            self.force[i] += self.external[i] + system.mass()[i] / dt * state.v[i];
        }
        stepper::release(system.held(), &mut self.force);
        if known {
            self.sloped
                .solve(
                    self.solver.matrix(),
                    system.held(),
                    Counts::PullingBack,
                    &mut self.force,
                )
                .map_err(|_| stepper::unsolvable(&state.x))?;
        } else {
            self.solver.solve(&mut self.force);
        }
        for i in 0..state.len() {
            self.next_x[i] = state.x[i] + self.force[i];
            self.next_v[i] = self.force[i] / dt;
        }
        stepper::finite(&self.next_x)?;
        let moment = Moment {
            t: t + dt,
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

/// How much of a slope is in the matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Counts {
    /// What pulls back.
    PullingBack,
    /// What pushes away too.
    All,
}

/// The matrix of a step with the slopes of the external force in it.
#[derive(Debug, Clone)]
pub(crate) struct Sloped {
    correction: Option<Correction>,
    /// The matrix, x and y of each node in turn.
    wide: Banded,
    /// Its factor, made anew in the same memory each step.
    factor: Option<BandedFactor>,
    slope: Vec<DMat2>,
    /// x and y of each node in turn.
    flat: Vec<f64>,
}

impl Sloped {
    pub(crate) fn new(system: &dyn System) -> Result<Self, SchemeError> {
        let n = system.len();
        Ok(Self {
            correction: Correction::new(system.stiffness())?,
            wide: coupled(system.stiffness().band())?,
            factor: None,
            slope: vec![DMat2::ZERO; n],
            flat: vec![0.0; 2 * n],
        })
    }

    /// The stiffness of the system has changed.
    pub(crate) fn renew(&mut self, system: &dyn System) -> Result<(), SchemeError> {
        self.correction = Correction::new(system.stiffness())?;
        Ok(())
    }

    /// Ask for the slopes at `x`; false where the system knows none or its force is constant.
    pub(crate) fn look(&mut self, system: &mut dyn System, t: f64, x: &[DVec2]) -> bool {
        !system.external_is_constant() && system.external_slope(t, x, &mut self.slope)
    }

    /// Solve with `matrix` and the slopes last asked for, or what pulls back of them; `force` becomes the
    /// increment.
    ///
    /// Refused where the matrix is not positive definite, which cannot be if only what pulls back counts.
    pub(crate) fn solve(
        &mut self,
        matrix: &Operator,
        held: &[bool],
        counts: Counts,
        force: &mut [DVec2],
    ) -> Result<(), SchemeError> {
        let band = matrix.band();
        if self.wide.half_width() != 2 * band.half_width() {
            self.wide = coupled(band)?;
        }
        for i in 0..force.len() {
            let pull = if held[i] {
                DMat2::ZERO
            } else if counts == Counts::All {
                symmetric(self.slope[i])
            } else {
                pulling(self.slope[i])
            };
            set_rows(&mut self.wide, band, i, pull);
        }
        match &mut self.factor {
            Some(factor) => factor.renew(&self.wide)?,
            none => *none = Some(BandedFactor::new(&self.wide)?),
        }
        let Some(factor) = &self.factor else {
            return Ok(());
        };
        for (i, force) in force.iter().enumerate() {
            (self.flat[2 * i], self.flat[2 * i + 1]) = (force.x, force.y);
        }
        factor.solve_scalars(&mut self.flat);
        if let Some(correction) = &self.correction {
            correction.apply(factor, &mut self.flat)?;
        }
        for (i, force) in force.iter_mut().enumerate() {
            *force = DVec2::new(self.flat[2 * i], self.flat[2 * i + 1]);
        }
        Ok(())
    }
}

/// Room for the band with x and y of each node coupled.
fn coupled(band: &Band) -> Result<Banded, SchemeError> {
    let (n, width) = (band.len(), band.half_width());
    Ok(Banded::new(2 * n, 2 * width, band.is_cyclic())?)
}

/// The rows of x and y of node `i`: x and y of this node, then of the next, then of the one after.
fn set_rows(wide: &mut Banded, band: &Band, i: usize, pull: DMat2) {
    let (own, between, row) = (band.diagonal()[i], -pull.x_axis.y, 2 * i);
    let (x, y) = (own - pull.x_axis.x, own - pull.y_axis.y);
    if let Band::Narrow(band) = band {
        let (near, far) = (band.first()[i], band.second()[i]);
        wide.set_row(row, x, &[between, near, 0.0, far]);
        wide.set_row(row + 1, y, &[0.0, near, 0.0, far]);
        return;
    }
    let mut beside = [0.0; Banded::WIDEST];
    let beside = &mut beside[..wide.half_width()];
    for (k, pair) in beside.chunks_exact_mut(2).enumerate() {
        pair[1] = band.beside(i, k + 1);
    }
    wide.set_row(row + 1, y, beside);
    beside[0] = between;
    wide.set_row(row, x, beside);
}

/// The symmetric part of a slope; zero where it is no number.
fn symmetric(slope: DMat2) -> DMat2 {
    let b = 0.5 * (slope.x_axis.y + slope.y_axis.x);
    let whole = DMat2::from_cols(DVec2::new(slope.x_axis.x, b), DVec2::new(b, slope.y_axis.y));
    if whole.is_finite() {
        whole
    } else {
        DMat2::ZERO
    }
}

/// The symmetric part of a slope without its positive eigenvalues.
fn pulling(slope: DMat2) -> DMat2 {
    let (a, d) = (slope.x_axis.x, slope.y_axis.y);
    let b = 0.5 * (slope.x_axis.y + slope.y_axis.x);
    let (mean, half) = (0.5 * (a + d), 0.5 * (a - d));
    let radius = half.hypot(b);
    let (low, high) = ((mean - radius).min(0.0), (mean + radius).min(0.0));
    // low · (I − P) + high · P with P = ½ (I + [half b; b −half] / radius)
    let (middle, spread) = (0.5 * (low + high), 0.5 * (high - low));
    if !(radius > 0.0 && mean.is_finite()) {
        return DMat2::from_diagonal(DVec2::splat(if middle.is_finite() { middle } else { 0.0 }));
    }
    let (c, s) = (spread * half / radius, spread * b / radius);
    DMat2::from_cols(DVec2::new(middle + c, s), DVec2::new(s, middle - c))
}

/// The columns an operator has beside its band, once along x and once along y.
#[derive(Debug, Clone)]
struct Correction {
    columns: Vec<Vec<f64>>,
    middle: Dense,
}

impl Correction {
    fn new(operator: &Operator) -> Result<Option<Self>, SchemeError> {
        let columns = operator.columns();
        let k = columns.len();
        if k == 0 {
            return Ok(None);
        }
        let n = operator.len();
        // U S Uᵀ U from products, then S = (UᵀU)⁻¹ Uᵀ (U S Uᵀ U) (UᵀU)⁻¹
        let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        let gram = Dense::from_fn(k, |i, j| dot(&columns[i], &columns[j]));
        let mut once = Vec::with_capacity(k);
        for column in columns {
            let (mut whole, mut band) = (vec![0.0; n], vec![0.0; n]);
            operator.multiply_scalars_into(column, &mut whole);
            operator.band().multiply_scalars_into(column, &mut band);
            let low: Vec<f64> = whole.iter().zip(&band).map(|(w, b)| w - b).collect();
            let along: Vec<f64> = columns.iter().map(|column| dot(column, &low)).collect();
            once.push(gram.solve(&along)?);
        }
        let mut middle = Vec::with_capacity(k);
        for i in 0..k {
            let row: Vec<f64> = (0..k).map(|j| once[j][i]).collect();
            middle.push(gram.solve(&row)?);
        }
        let spread = |axis: usize, column: &Vec<f64>| {
            let mut flat = vec![0.0; 2 * n];
            for (i, &u) in column.iter().enumerate() {
                flat[2 * i + axis] = u;
            }
            flat
        };
        let columns = [0, 1]
            .iter()
            .flat_map(|&axis| columns.iter().map(move |c| spread(axis, c)))
            .collect();
        let middle = Dense::from_fn(2 * k, |i, j| {
            if i / k == j / k {
                middle[i % k][j % k]
            } else {
                0.0
            }
        });
        Ok(Some(Self { columns, middle }))
    }

    /// From B⁻¹ b to (B + U S Uᵀ)⁻¹ b.
    fn apply(&self, factor: &BandedFactor, x: &mut [f64]) -> Result<(), SchemeError> {
        let k = self.columns.len();
        let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        let mut solved = self.columns.clone();
        solved
            .iter_mut()
            .for_each(|column| factor.solve_scalars(column));
        let inner = Dense::from_fn(k, |i, j| {
            let product: f64 = (0..k)
                .map(|q| self.middle[(i, q)] * dot(&self.columns[q], &solved[j]))
                .sum();
            if i == j { 1.0 + product } else { product }
        });
        let along: Vec<f64> = self.columns.iter().map(|column| dot(column, x)).collect();
        let weights = inner.solve(&self.middle.multiply(&along))?;
        for (weight, column) in weights.iter().zip(&solved) {
            for (x, z) in x.iter_mut().zip(column) {
                *x -= weight * z;
            }
        }
        Ok(())
    }
}
