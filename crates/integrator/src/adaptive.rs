//! Sub-steps chosen by their error, for any scheme.

use crate::dormand_prince::{DormandPrince, size};
use crate::stepper::Clock;
use crate::watched::{Watch, Watched};
use crate::{Fault, Limit, Reason, Scheme, SchemeError, Start, State, Stepper, Summary, System};

/// How many times a pair of sub-steps may be halved.
const LEVELS: u32 = 24;

/// Share of the stability limit that is used.
const BELOW: f64 = 0.95;

/// A stepper whose `dt` is an output step, made in as many sub-steps of another scheme as it takes.
///
/// ```text
/// two sub-steps h against one of 2h:   error = max |x(h, h) − x(2h)| / (2ᵖ − 1) ≤ tolerance
/// ```
///
/// The output step is cut into equal pairs, as few as the stability limit of the long sub-step allows, and a pair is halved
/// where its error asks for it, and doubled again where it no longer does (a proportional and integral
/// rule, `[gustafsson91]`). Lengths are therefore few, and each keeps its factor. The two short sub-steps stand;
/// the long one only judges them. A refused pair leaves no trace. At a change of length schemes of two steps
/// start again with [`Start::SecondOrder`].
///
/// A contact is met at the end of a sub-step and so up to `h` late: it errs by the velocity with which a
/// node leaves, times h. That counts like any other error; lying on a floor has none.
///
/// The error of a run follows the tolerance to the power p/(p+1), p the order of the scheme: local errors
/// are held, and there are more of them the shorter sub-steps are (measured within 0.25; sbdf2, which starts
/// each new length with a step of Euler's, about 1/3). The same bytes every time. Half as many
/// forces again as sub-steps. Memory: one stepper for each length in use, at most 25.
///
/// [`Scheme::DormandPrince`] chooses its own sub-steps by its own error, which the tolerance holds: its parameter, the
/// tolerance over the size of the curve, is this one's to set.
#[derive(Debug, Clone)]
pub struct Adaptive {
    scheme: Scheme,
    tolerance: f64,
    clock: Clock,
    limit: Option<Limit>,
    /// Why a sub-step is no longer that is as long as the output allows.
    whole: Reason,
    /// Whether every sub-step ends a step; the clock's then is the time of the whole run.
    each: bool,
    /// How much of the clock's step is made, in pairs of the finest level, with `each`.
    done: u64,
    /// How much of it the second sub-step of the last pair is.
    second: u64,
    /// The state between the two sub-steps of a pair.
    middle: State,
    /// Whether the second sub-step of the last pair, made already, is yet to be shown.
    waiting: bool,
    /// Pairs an output step has at least.
    pairs: u64,
    /// By level: steps of a pair halved k times. The judge of a level is the sub-step of the one before.
    gears: Vec<Option<Box<dyn Stepper>>>,
    level: u32,
    /// The level of the sub-steps that ended at the state, if nothing came between.
    rolling: Option<u32>,
    last_error: f64,
    /// How long to go before another doubling is tried.
    patience: u32,
    watch: Watch,
    summary: Summary,
    from: State,
    fine: State,
    coarse: State,
    origin: State,
    /// For the scheme that chooses its own.
    own: Option<Box<DormandPrince>>,
}

impl Adaptive {
    /// Ready to leave `state` in steps of `output`, each sub-step with an error of at most `tolerance` pixels.
    ///
    /// `limit` is what sub-steps must stay below, [`Limit::of`] the scheme at least.
    ///
    /// # Errors
    ///
    /// As [`Scheme::start`]; a tolerance that is not finite and above 0, a limit that leaves no step, and the
    /// scheme named report, whose velocity belongs to one length of step.
    pub fn new(
        scheme: Scheme,
        system: &mut dyn System,
        state: &State,
        output: f64,
        tolerance: f64,
        limit: Option<Limit>,
    ) -> Result<Self, SchemeError> {
        let refused = |name, range, value| SchemeError::BadParameter {
            scheme: scheme.name(),
            name,
            range,
            value,
        };
        if !(tolerance.is_finite() && tolerance > 0.0) {
            return Err(refused("tolerance", "finite and above 0", tolerance));
        }
        if scheme == Scheme::Report {
            return Err(SchemeError::OneStep {
                scheme: scheme.name(),
            });
        }
        let mut own = None;
        let mut whole = None;
        if matches!(scheme, Scheme::DormandPrince { .. }) {
            // relative to the size, within what doubles can hold
            let relative = (tolerance / size(&state.x)).clamp(1e-14, 1.0);
            let made = DormandPrince::new(system, state, output, relative)?;
            own = Some(Box::new(made));
        } else {
            whole = Some(scheme.start(system, state, output, Start::SecondOrder)?);
        }
        let most = limit.map_or(f64::INFINITY, |limit| BELOW * limit.dt);
        let pairs = (output / most).ceil().max(1.0);
        // more would take longer than anybody waits for one output
        if !(most > 0.0 && pairs < 1e12) {
            return Err(refused(
                "stability limit",
                "above 1e-12 of the output step",
                most,
            ));
        }
        let mut gears: Vec<Option<Box<dyn Stepper>>> = (0..=LEVELS + 1).map(|_| None).collect();
        if pairs < 1.5 {
            gears[0] = whole;
        }
        Ok(Self {
            scheme,
            tolerance,
            clock: Clock::new(state, output),
            limit,
            whole: Reason::Output,
            each: false,
            done: 0,
            second: 0,
            middle: state.clone(),
            waiting: false,
            pairs: whole_number(pairs),
            gears,
            level: 0,
            rolling: None,
            last_error: tolerance,
            patience: 0,
            watch: Watch::default(),
            summary: Summary::new(limit),
            from: state.clone(),
            fine: state.clone(),
            coarse: state.clone(),
            origin: state.clone(),
            own,
        })
    }

    /// The same without an output step: every step is one sub-step, of whatever length it takes.
    ///
    /// `output` of [`Adaptive::new`] is then the time of the whole run; a sub-step ends there.
    #[must_use]
    pub const fn each(mut self) -> Self {
        self.each = true;
        self
    }

    /// The same where the output step is itself as short as `limit` asks for: the reason of sub-steps as long as it allows.
    #[must_use]
    pub fn cut_by(mut self, limit: Limit) -> Self {
        self.whole = Reason::Stability(limit);
        self.summary.limit = Limit::tighter(self.summary.limit, Some(limit));
        self
    }

    /// What became of the sub-steps so far.
    #[must_use]
    pub const fn summary(&self) -> &Summary {
        &self.summary
    }

    /// Why the last sub-step was no longer.
    #[must_use]
    pub const fn reason(&self) -> Reason {
        self.summary.reason
    }

    /// Length of a pair of sub-steps at a level.
    fn pair(&self, level: u32) -> f64 {
        self.clock.dt / self.pairs as f64 * 0.5_f64.powi(level as i32)
    }

    /// A gear for steps of the length of a pair at `level`, ready to leave `from`.
    fn ready(&mut self, system: &mut dyn System, level: u32, goes_on: bool) -> Result<(), Fault> {
        let dt = self.pair(level);
        let slot = &mut self.gears[level as usize];
        match slot {
            Some(_) if goes_on => {}
            Some(stepper) => stepper.resume(system, &self.from),
            None => {
                let start = Start::SecondOrder;
                let made = self.scheme.start(system, &self.from, dt, start);
                *slot = Some(made.map_err(|_| crate::stepper::unsolvable(&self.from.x))?);
            }
        }
        Ok(())
    }

    fn go(
        stepper: &mut Option<Box<dyn Stepper>>,
        watch: &mut Watch,
        system: &mut dyn System,
        state: &mut State,
    ) -> Result<(), Fault> {
        let Some(stepper) = stepper else {
            return Err(crate::stepper::unsolvable(&state.x));
        };
        let mut system = Watched {
            inner: system,
            watch,
        };
        stepper.step(&mut system, state)
    }

    /// One pair from `from` at the level there is, into `fine`, and its judge into `coarse`.
    fn try_pair(&mut self, system: &mut dyn System) -> Result<f64, Fault> {
        let level = self.level;
        let goes_on = self.rolling == Some(level);
        self.watch.half = None;
        self.fine.copy(&self.from);
        self.coarse.copy(&self.from);
        self.rewind(system);
        self.ready(system, level, false)?;
        let (long, short) = (level as usize, level as usize + 1);
        Self::go(
            &mut self.gears[long],
            &mut self.watch,
            system,
            &mut self.coarse,
        )?;
        self.rewind(system);
        self.ready(system, level + 1, goes_on)?;
        self.watch.late = 0.0;
        self.watch.met.clear();
        for half in 0..2 {
            self.watch.half = Some(half);
            Self::go(
                &mut self.gears[short],
                &mut self.watch,
                system,
                &mut self.fine,
            )?;
            if half == 0 {
                self.middle.copy(&self.fine);
            }
        }
        self.watch.half = None;
        let mut apart = 0.0_f64;
        for (a, b) in self.fine.x.iter().zip(&self.coarse.x) {
            apart = apart.max(a.distance_squared(*b));
        }
        let error = apart.sqrt() / (2.0_f64.powi(self.scheme.order() as i32) - 1.0);
        let error = error.max(self.watch.late);
        Ok(if error.is_nan() { f64::INFINITY } else { error })
    }

    /// Bring the system back to the time of `from`.
    fn rewind(&self, system: &mut dyn System) {
        system.advance(self.from.t, &self.from.x);
    }

    /// By how much a pair could be longer for an error within the tolerance.
    fn stretch(&self, error: f64) -> f64 {
        let exponent = 1.0 / f64::from(self.scheme.order() + 1);
        let now = self.tolerance / error.max(1e-30 * self.tolerance);
        let before = self.tolerance / self.last_error.max(1e-30 * self.tolerance);
        0.9 * now.powf(0.7 * exponent) * (now / before).clamp(0.1, 10.0).powf(0.3 * exponent)
    }

    /// One accepted pair; how much of the output step, in pairs of the finest level, it has made.
    fn advance(&mut self, system: &mut dyn System) -> Result<u64, Fault> {
        loop {
            self.watch.touched = false;
            let tried = self.try_pair(system);
            // one step may look where no force is, or overflow: shorter ones will not
            let error = tried.unwrap_or(f64::INFINITY);
            let floor = self.level == LEVELS;
            if error <= self.tolerance || floor && tried.is_ok() {
                let reason = self.why(error);
                self.summary.count(0.5 * self.pair(self.level), reason);
                self.rolling = Some(self.level);
                let done = 1 << (LEVELS - self.level);
                let stretch = self.stretch(error);
                self.last_error = error;
                self.patience = self.patience.saturating_sub(1);
                if stretch >= 2.0 && self.patience == 0 && self.level > 0 {
                    self.level -= 1;
                }
                return Ok(done);
            }
            self.rolling = None;
            if floor {
                self.rewind(system);
                tried?;
            }
            self.summary.refuse();
            // by what the error asks for, at most three halvings at once
            let exponent = 1.0 / f64::from(self.scheme.order() + 1);
            let ask = (error / (0.5 * self.tolerance)).powf(exponent).log2();
            let halvings = 1 + u32::from(ask > 1.0) + u32::from(ask > 2.0);
            self.level = (self.level + halvings).min(LEVELS);
            self.last_error = self.tolerance;
            self.patience = 2;
        }
    }

    fn why(&self, error: f64) -> Reason {
        if error > self.tolerance {
            Reason::Floor
        } else if self.level > 0 && self.watch.touched {
            Reason::Contact
        } else if self.level > 0 {
            Reason::Accuracy
        } else {
            match self.limit {
                Some(limit) if self.pairs > 1 => Reason::Stability(limit),
                _ => self.whole,
            }
        }
    }
}

/// A whole number below 2⁴⁰ as one.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "between 1 and 1e12, checked"
)]
const fn whole_number(value: f64) -> u64 {
    value as u64
}

impl Adaptive {
    /// A pair that is too long for what is left, or not in line with it, is halved.
    const fn align(&mut self, done: u64) {
        while !done.is_multiple_of(1 << (LEVELS - self.level)) {
            self.level += 1;
        }
    }

    /// How much of the clock's step is made.
    fn share(&self) -> f64 {
        self.done as f64 / (self.pairs << LEVELS) as f64
    }

    /// One sub-step, the second of a pair from what the first has left.
    fn one(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), Fault> {
        let whole = self.pairs << LEVELS;
        if !self.waiting {
            self.from.copy(state);
            self.from.t = self.clock.part(self.share());
            self.align(self.done);
            let some = match self.advance(system) {
                Ok(some) => some,
                Err(fault) => {
                    self.rolling = None;
                    return Err(fault);
                }
            };
            let half = self.done as f64 + 0.5 * some as f64;
            self.middle.t = self.clock.part(half / whole as f64);
            self.done += some;
            self.second = some - some / 2;
            self.fine.t = self.clock.part(self.share());
            std::mem::swap(&mut self.from, &mut self.fine);
        }
        let to = if self.waiting {
            &self.from
        } else {
            &self.middle
        };
        self.watch.tell(usize::from(self.waiting), system);
        state.x.copy_from_slice(&to.x);
        state.v.copy_from_slice(&to.v);
        state.t = to.t;
        state.step += 1;
        self.waiting = !self.waiting;
        if self.done == whole && !self.waiting {
            // whoever goes on beyond the end does so by another span of that length
            self.done = 0;
            self.clock.restart(state);
        }
        Ok(())
    }

    /// A step of the scheme that chooses its own sub-steps.
    fn by_itself(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), Fault> {
        let Some(own) = &mut self.own else {
            return Err(crate::stepper::unsolvable(&state.x));
        };
        if self.each {
            let room = self.clock.next() - state.t;
            own.advance_within(system, state, room)?;
            if state.t >= self.clock.next() {
                state.t = self.clock.next();
                self.clock.restart(state);
            }
        } else {
            own.step(system, state)?;
        }
        self.summary.take(own);
        Ok(())
    }
}

impl Stepper for Adaptive {
    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }

    fn step(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), Fault> {
        if self.own.is_some() {
            return self.by_itself(system, state);
        }
        if self.each {
            return self.one(system, state);
        }
        let whole = self.pairs << LEVELS;
        let mut done = 0;
        self.origin.copy(state);
        self.from.copy(state);
        self.from.t = self.clock.now();
        while done < whole {
            self.align(done);
            match self.advance(system) {
                Ok(some) => {
                    if done > 0 {
                        system.passed(&self.from);
                    }
                    done += some;
                    self.watch.tell(0, system);
                    system.passed(&self.middle);
                    self.watch.tell(1, system);
                }
                Err(fault) => {
                    state.copy(&self.origin);
                    self.rolling = None;
                    return Err(fault);
                }
            }
            std::mem::swap(&mut self.from, &mut self.fine);
        }
        state.x.copy_from_slice(&self.from.x);
        state.v.copy_from_slice(&self.from.v);
        self.clock.tick(state);
        Ok(())
    }

    fn dt(&self) -> f64 {
        self.clock.dt
    }

    fn resume(&mut self, system: &mut dyn System, state: &State) {
        if self.each {
            // only half of the last pair stands
            self.done -= if self.waiting { self.second } else { 0 };
            self.waiting = false;
        }
        self.clock.restart(state);
        self.clock.rewind(self.share());
        self.rolling = None;
        self.last_error = self.tolerance;
        if let Some(own) = &mut self.own {
            own.resume(system, state);
        }
    }
}
