//! What a scheme needs for how much error: forces counted, time taken, distance from the truth.

use super::trial::{Care, Trial};
use integrator::{Fault, Scheme, Start, System, Wrapped};
use sandbox::prelude::*;
use std::time::Instant;

/// A stopwatch for one thread on a machine that does other things as well.
///
/// Short times are by the wall clock, whose least over a few runs nothing disturbs. Longer ones are the time this
/// thread was on a processor, where the system tells.
#[derive(Debug, Clone, Copy)]
pub struct Stopwatch {
    begun: Instant,
    worked: Option<f64>,
}

impl Stopwatch {
    /// Starts it.
    #[must_use]
    pub fn start() -> Self {
        Self {
            worked: worked(),
            begun: Instant::now(),
        }
    }

    /// Seconds since the start.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        let wall = self.begun.elapsed().as_secs_f64();
        // what the system tells is late by up to some milliseconds, and asking takes time
        let told = if wall > 0.02 {
            self.worked.zip(worked())
        } else {
            None
        };
        match told {
            Some((before, now)) if now > before => wall.min(now - before),
            _ => wall,
        }
    }
}

/// Seconds this thread has been on a processor; None where the system does not tell.
fn worked() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(1e-9 * nanoseconds)
}

/// A system that counts how often it is asked for forces.
struct Counted<'a> {
    inner: &'a mut dyn System,
    elastic: u64,
    external: u64,
}

impl Wrapped for Counted<'_> {
    fn inner(&self) -> &dyn System {
        &*self.inner
    }

    fn inner_mut(&mut self) -> &mut dyn System {
        &mut *self.inner
    }

    fn elastic(&mut self, x: &[DVec2], force: &mut [DVec2]) {
        self.elastic += 1;
        self.inner.elastic(x, force);
    }

    fn external(
        &mut self,
        t: f64,
        x: &[DVec2],
        v: &[DVec2],
        force: &mut [DVec2],
    ) -> Result<(), Fault> {
        self.external += 1;
        self.inner.external(t, x, v, force)
    }
}

/// One run of a scheme over a trial.
#[derive(Debug, Clone, Copy)]
pub struct Effort {
    /// Steps made.
    pub steps: u64,
    /// Elastic or external forces of the whole curve, whichever were asked for more often.
    pub forces: u64,
    /// Time of all steps, start included: the least of a few runs. s.
    pub seconds: f64,
    /// The same without the start.
    pub stepping: f64,
    /// Largest distance of a node from where it should be. px.
    pub error: f64,
}

/// Move a trial in so many steps; None where the scheme refuses or blows up.
///
/// `steps` must be a multiple of what the trial's moments of truth ask for: two where it is judged half way.
pub fn effort(trial: &mut Trial, scheme: Scheme, steps: u64) -> Option<Effort> {
    let mut best: Option<Effort> = None;
    let begun = Instant::now();
    for _ in 0..200 {
        let now = once(trial, scheme, steps)?;
        best = Some(best.map_or(now, |best| Effort {
            seconds: best.seconds.min(now.seconds),
            stepping: best.stepping.min(now.stepping),
            ..now
        }));
        if trial.care == Care::Counted || begun.elapsed().as_secs_f64() > 0.02 {
            break;
        }
    }
    best
}

fn once(trial: &mut Trial, scheme: Scheme, steps: u64) -> Option<Effort> {
    let mut counted = Counted {
        inner: &mut *trial.system,
        elastic: 0,
        external: 0,
    };
    let mut state = trial.start.clone();
    let dt = trial.until / to_real(steps);
    let watch = Stopwatch::start();
    let mut stepper = scheme
        .start(&mut counted, &state, dt, Start::SecondOrder)
        .ok()?;
    let ready = watch.seconds();
    let mut error = 0.0_f64;
    for (share, truth) in &trial.truth {
        let due = share * to_real(steps);
        while to_real(state.step - trial.start.step) < due - 0.5 {
            stepper.step(&mut counted, &mut state).ok()?;
        }
        let apart = state.x.iter().zip(truth).map(|(x, y)| x.distance(*y));
        error = apart.fold(error, |most, d| {
            if d.is_nan() {
                f64::INFINITY
            } else {
                most.max(d)
            }
        });
    }
    let done = watch.seconds();
    error.is_finite().then_some(Effort {
        steps,
        forces: counted.elastic.max(counted.external),
        seconds: done,
        stepping: done - ready,
        error,
    })
}

/// The most steps of a run whose forces are only counted.
const COUNTED_MOST: u64 = 100_000;

/// The smallest error that any claim asks for. px.
const FINEST: f64 = 1e-6;

/// Runs of a scheme from the coarsest that is stable up to where nothing is gained, or time runs out.
pub fn scan(trial: &mut Trial, scheme: Scheme) -> Vec<Effort> {
    if matches!(scheme, Scheme::DormandPrince { .. }) {
        let whole = least(trial);
        let tolerances = (2..=11).map(|digits| 10.0_f64.powi(-digits));
        return tolerances
            .filter_map(|tolerance| effort(trial, Scheme::DormandPrince { tolerance }, whole))
            .collect();
    }
    let mut out: Vec<Effort> = Vec::new();
    let mut steps = coarsest(trial, scheme);
    let counted = trial.care == Care::Counted;
    let most = if counted { COUNTED_MOST } else { 400_000 };
    while steps < most {
        if let Some(now) = effort(trial, scheme, steps) {
            let gained = out.last().is_none_or(|last| now.error < 0.9 * last.error);
            // a blow-up in the making is no measure of anything
            if now.error < 1e3 {
                out.push(now);
            }
            let enough = if counted {
                now.error <= FINEST
            } else {
                now.error < 1e-11 || now.seconds > 0.6 || !gained && now.error < 1e-8
            };
            if enough {
                break;
            }
        }
        steps *= 2;
    }
    out
}

/// The fewest steps, found by bisection, with which a scheme comes within `target`.
pub fn least_steps(
    trial: &mut Trial,
    scheme: Scheme,
    seen: &[Effort],
    target: f64,
) -> Option<Effort> {
    let index = seen.iter().position(|run| run.error <= target)?;
    let mut best = seen[index];
    if index == 0 || matches!(scheme, Scheme::DormandPrince { .. }) {
        return Some(best);
    }
    let unit = least(trial);
    let (mut low, mut high) = (seen[index - 1].steps / unit, best.steps / unit);
    while high - low > (high / 100).max(1) {
        let middle = u64::midpoint(low, high);
        match effort(trial, scheme, middle * unit) {
            Some(now) if now.error <= target => (high, best) = (middle, now),
            _ => low = middle,
        }
    }
    Some(best)
}

/// What step counts must be multiples of.
fn least(trial: &Trial) -> u64 {
    if trial.truth.len() > 1 { 2 } else { 1 }
}

/// The fewest steps that are stable, as far as the scheme can tell.
#[must_use]
pub fn coarsest(trial: &Trial, scheme: Scheme) -> u64 {
    let unit = least(trial);
    let limit = scheme.step_limit(&*trial.system).unwrap_or(f64::INFINITY);
    let mut steps = unit;
    // one in a thousand above the border
    while trial.until / to_real(steps) > 0.999 * limit {
        steps = (steps + unit).max(steps / 1000 * 1001 / unit * unit);
    }
    steps
}

/// Exact: no count here comes near 2⁵³.
#[expect(clippy::cast_precision_loss, reason = "counts here are far below 2^53")]
pub(super) fn to_real(count: u64) -> f64 {
    count as f64
}
