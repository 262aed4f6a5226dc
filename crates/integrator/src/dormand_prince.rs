//! The reference: a method that chooses its own steps.

use glam::DVec2;

use crate::contact::Contacts;
use crate::impulse::{Moment, Pace};
use crate::rk4::{Rates, stop_held};
use crate::stepper::{self, Clock, Mass};
use crate::{Fault, FaultKind, SchemeError, State, Stepper, System};

const STAGES: usize = 7;

/// Where in the step each stage is.
const NODES: [f64; STAGES] = [0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0];

/// What each stage takes from those before it; the last row is the step itself.
const TABLEAU: [&[f64]; STAGES] = [
    &[],
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[
        19372.0 / 6561.0,
        -25360.0 / 2187.0,
        64448.0 / 6561.0,
        -212.0 / 729.0,
    ],
    &[
        9017.0 / 3168.0,
        -355.0 / 33.0,
        46732.0 / 5247.0,
        49.0 / 176.0,
        -5103.0 / 18656.0,
    ],
    &[
        35.0 / 384.0,
        0.0,
        500.0 / 1113.0,
        125.0 / 192.0,
        -2187.0 / 6784.0,
        11.0 / 84.0,
    ],
];

/// Fifth order minus fourth.
const ERROR: [f64; STAGES] = [
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// The part of the continuous extension that is not a cubic Hermite one.
const DENSE: [f64; STAGES] = [
    -12715105075.0 / 11282082432.0,
    0.0,
    87487479700.0 / 32700410799.0,
    -10690763975.0 / 1880347072.0,
    701980252875.0 / 199316789632.0,
    -1453857185.0 / 822651844.0,
    69997945.0 / 29380423.0,
];

/// Dormand and Prince's pair of orders 5 and 4, with steps chosen by their error and dense output.
///
/// Works in two ways. As a [`Stepper`] it moves the state by exactly `dt`, in as many sub-steps as
/// the tolerance asks for. Through [`advance`](Self::advance) it takes one step of its own choice, and
/// [`at`](Self::at) tells where the nodes were at any time within it.
///
/// The error of a sub-step is kept below a length, in the mean square over all nodes:
///
/// ```text
/// |error of x| ≤ ℓ,   |error of v| ≤ ℓ / L · max(V, L / 1000 h),   ℓ = tolerance · L
/// ```
///
/// L is half the diagonal of the box around the nodes at the start (1 where they are one point), V
/// the largest speed of a node so far.
/// So neither the unit of length nor where the origin lies enters. Six forces a sub-step, each with
/// what schedules say at its own time. Contacts are met
/// at the ends of sub-steps.
///
/// Dormand & Prince 1980; dense output after Hairer, Nørsett & Wanner, *Solving ODEs I*, II.6.
#[derive(Debug, Clone)]
pub struct DormandPrince {
    clock: Clock,
    tolerance: f64,
    /// L, and V.
    size: f64,
    fastest: f64,
    /// The sub-step to try next.
    try_next: f64,
    last_error: f64,
    /// Time and length of the last sub-step.
    span: (f64, f64),
    /// Sub-steps made and refused so far.
    counts: (u64, u64),
    /// The shortest and the longest sub-step, and how many were cut short by the room there was.
    lengths: (f64, f64, u64),
    /// Whether the first stage is known already from the last sub-step.
    ready: bool,
    rates: Rates,
    stages_x: Vec<Vec<DVec2>>,
    stages_v: Vec<Vec<DVec2>>,
    from: State,
    to: State,
    contacts: Contacts,
}

impl DormandPrince {
    pub(crate) const NAME: &'static str = "dormand-prince";

    /// Ready to leave `state`, with a first sub-step of at most `dt`.
    ///
    /// # Errors
    ///
    /// As [`Scheme::start`](crate::Scheme::start); a tolerance outside 1e-14 … 1.
    pub fn new(
        system: &mut dyn System,
        state: &State,
        dt: f64,
        tolerance: f64,
    ) -> Result<Self, SchemeError> {
        if !(1e-14..=1.0).contains(&tolerance) {
            let (scheme, name, range) = (Self::NAME, "tolerance", "between 1e-14 and 1");
            return Err(SchemeError::BadParameter {
                scheme,
                name,
                range,
                value: tolerance,
            });
        }
        system.advance(state.t, &state.x);
        stepper::check(Self::NAME, system, state, dt, Mass::Needed)?;
        let n = state.len();
        let mut rates = Rates::default();
        rates.prepare(system);
        let stages = || vec![vec![DVec2::ZERO; n]; STAGES];
        Ok(Self {
            clock: Clock::new(state, dt),
            tolerance,
            size: size(&state.x),
            fastest: 0.0,
            try_next: dt,
            last_error: 1.0,
            span: (state.t, 0.0),
            counts: (0, 0),
            lengths: (f64::INFINITY, 0.0, 0),
            ready: false,
            rates,
            stages_x: stages(),
            stages_v: stages(),
            from: state.clone(),
            to: state.clone(),
            contacts: Contacts::new(n),
        })
    }

    /// Sub-steps made and sub-steps refused since the start.
    #[must_use]
    pub fn counts(&self) -> (u64, u64) {
        self.counts
    }

    /// The shortest and the longest sub-step so far, and how many the end of a step has cut short.
    pub(crate) const fn lengths(&self) -> (f64, f64, u64) {
        self.lengths
    }

    /// Move `state` by one sub-step of the method's own choice; `state.step` counts them.
    ///
    /// # Errors
    ///
    /// As [`Stepper::step`].
    pub fn advance(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), Fault> {
        self.advance_within(system, state, f64::INFINITY)
    }

    /// The same by at most `room`.
    pub(crate) fn advance_within(
        &mut self,
        system: &mut dyn System,
        state: &mut State,
        room: f64,
    ) -> Result<(), Fault> {
        self.from.copy(state);
        stop_held(system, &mut self.from.v);
        if let Err(fault) = self.substep(system, room) {
            self.ready = false;
            return Err(fault);
        }
        let step = state.step + 1;
        state.copy(&self.to);
        state.step = step;
        Ok(())
    }

    /// Position and velocity at time `t` within the last sub-step, in `out`; order 4.
    ///
    /// Outside of it the formula extrapolates. Does not know of contacts at the sub-step's end.
    pub fn at(&self, t: f64, out: &mut State) {
        let (start, h) = self.span;
        let s = if h > 0.0 { (t - start) / h } else { 0.0 };
        let r = 1.0 - s;
        out.copy(&self.from);
        out.t = t;
        let blend = |from: &[DVec2], stages: &[Vec<DVec2>], out: &mut [DVec2]| {
            for i in 0..from.len() {
                let sum = |row: &[f64]| -> DVec2 {
                    row.iter()
                        .zip(stages)
                        .map(|(&b, k)| b * k[i])
                        .sum::<DVec2>()
                        * h
                };
                let rise = sum(TABLEAU[6]);
                let first = h * stages[0][i] - rise;
                let last = rise - h * stages[6][i] - first;
                out[i] = from[i] + s * (rise + r * (first + s * (last + r * sum(&DENSE))));
            }
        };
        blend(&self.from.x, &self.stages_x, &mut out.x);
        blend(&self.from.v, &self.stages_v, &mut out.v);
    }

    /// One accepted sub-step from `from` to `to`, no longer than `room`.
    fn substep(&mut self, system: &mut dyn System, room: f64) -> Result<(), Fault> {
        let t = self.from.t;
        if self.rates.advance(Self::NAME, system, t, &self.from.x)? {
            self.ready = false;
        }
        if self.ready {
            self.stages_x.swap(0, STAGES - 1);
            self.stages_v.swap(0, STAGES - 1);
            self.ready = false;
        } else {
            let (x, v) = (&self.from.x, &self.from.v);
            self.stages_x[0].copy_from_slice(v);
            self.rates
                .acceleration(system, t, x, v, &mut self.stages_v[0])?;
        }
        loop {
            let h = self.try_next.min(room);
            let tried = self.stages(system, h);
            let error = match tried {
                Ok(()) => self.error(h),
                // a stage may look where no force is, or overflow: a shorter one will not
                Err(_) => f64::INFINITY,
            };
            if error <= 1.0 {
                let grow = 0.9 * error.max(1e-10).powf(-0.17) * self.last_error.powf(0.04);
                let next = h * grow.clamp(0.2, 5.0);
                // a sub-step cut short by the end of the step says little about the next one
                self.try_next = if h < self.try_next {
                    self.try_next.max(next)
                } else {
                    next
                };
                self.last_error = error.max(1e-4);
                self.span = (t, h);
                self.counts.0 += 1;
                let (short, long, cut) = self.lengths;
                let cut = cut + u64::from(h >= room);
                self.lengths = (short.min(h), long.max(h), cut);
                return self.accept(system, t, h);
            }
            self.counts.1 += 1;
            self.try_next = h * if error.is_finite() {
                (0.9 * error.powf(-0.2)).max(0.2)
            } else {
                0.2
            };
            if self.try_next <= 1e-13 * self.clock.dt || t + self.try_next <= t {
                tried?;
                return Err(Fault {
                    node: 0,
                    at: self.from.x[0],
                    kind: FaultKind::NotFinite,
                });
            }
        }
    }

    /// All stages after the first; the last is at the end of the sub-step, which is left in `to`.
    fn stages(&mut self, system: &mut dyn System, h: f64) -> Result<(), Fault> {
        for stage in 1..STAGES {
            for i in 0..self.from.len() {
                let (mut dx, mut dv) = (DVec2::ZERO, DVec2::ZERO);
                for (j, &a) in TABLEAU[stage].iter().enumerate() {
                    dx += a * self.stages_x[j][i];
                    dv += a * self.stages_v[j][i];
                }
                self.to.x[i] = self.from.x[i] + h * dx;
                self.to.v[i] = self.from.v[i] + h * dv;
            }
            stepper::finite(&self.to.x)?;
            let t = self.from.t + NODES[stage] * h;
            self.rates.advance(Self::NAME, system, t, &self.to.x)?;
            let (x, v) = (&self.to.x, &self.to.v);
            self.stages_x[stage].copy_from_slice(v);
            self.rates
                .acceleration(system, t, x, v, &mut self.stages_v[stage])?;
        }
        Ok(())
    }

    /// Estimated error over tolerance: at most 1 is good enough.
    fn error(&self, h: f64) -> f64 {
        let mut sum = 0.0;
        let speeds = self.from.v.iter().chain(&self.to.v).map(|v| v.length());
        let fastest = speeds
            .fold(self.fastest, f64::max)
            .max(1e-3 * self.size / h);
        for i in 0..self.from.len() {
            let (mut dx, mut dv) = (DVec2::ZERO, DVec2::ZERO);
            for (j, &e) in ERROR.iter().enumerate() {
                dx += e * self.stages_x[j][i];
                dv += e * self.stages_v[j][i];
            }
            sum += (h * dx / self.size).length_squared();
            sum += (h * dv / fastest).length_squared();
        }
        let error = (sum / (4.0 * self.from.len() as f64)).sqrt() / self.tolerance;
        if error.is_nan() { f64::INFINITY } else { error }
    }

    fn accept(&mut self, system: &mut dyn System, t: f64, h: f64) -> Result<(), Fault> {
        self.to.t = t + h;
        let speeds = self.to.v.iter().map(|v| v.length());
        self.fastest = speeds.fold(self.fastest, f64::max);
        let moment = Moment {
            t: t + h,
            dt: h,
            pace: Pace::Together { way: 0.5 },
        };
        let State { x, v, .. } = &mut self.to;
        let touched = self.contacts.meet(system, moment, &self.from.x, x, v)?;
        self.ready = !touched;
        Ok(())
    }
}

/// Half the diagonal of the box around some points, or 1 where they are one.
pub(crate) fn size(x: &[DVec2]) -> f64 {
    let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let (low, high) = x
        .iter()
        .fold(none, |(low, high), p| (low.min(*p), high.max(*p)));
    let half = 0.5 * low.distance(high);
    if half > 0.0 && half.is_finite() {
        half
    } else {
        1.0
    }
}

impl Stepper for DormandPrince {
    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }

    fn step(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), Fault> {
        let end = self.clock.next();
        self.from.copy(state);
        self.from.t = self.clock.now();
        stop_held(system, &mut self.from.v);
        loop {
            let room = end - self.from.t;
            if let Err(fault) = self.substep(system, room) {
                self.ready = false;
                return Err(fault);
            }
            if self.span.1 >= room {
                break;
            }
            std::mem::swap(&mut self.from, &mut self.to);
            system.passed(&self.from);
        }
        state.x.copy_from_slice(&self.to.x);
        state.v.copy_from_slice(&self.to.v);
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
