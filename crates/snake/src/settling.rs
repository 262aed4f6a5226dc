//! How long a snake takes to come to rest under each rule of damping.

use std::fmt;
use std::ops::ControlFlow;

use integrator::{Scheme, State};

use crate::{Damping, Outcome, Simulation, SimulationError, Snake, Stepping, Until};

/// One run to rest, to be made under many dampings.
#[derive(Debug, Clone)]
pub struct Settling {
    /// The snake; what it says of damping is passed over.
    pub snake: Snake,
    /// Where it starts.
    pub state: State,
    /// What moves it.
    pub scheme: Scheme,
    /// The step; where internal damping makes that too large, nine tenths of the largest. T.
    pub dt: f64,
    /// What counts as rest, and the most steps.
    pub until: Until,
}

/// One row of the comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeToRest {
    /// The rules, applied in this order to a snake without damping.
    pub rules: Vec<Damping>,
    /// How it ended.
    pub outcome: Outcome,
    /// When: the time to rest where the outcome is [`Outcome::Settled`]. T.
    pub time: f64,
    /// Steps made.
    pub steps: u64,
}

impl TimeToRest {
    /// Whether it came to rest.
    #[must_use]
    pub const fn is_at_rest(&self) -> bool {
        matches!(self.outcome, Outcome::Settled { .. })
    }

    /// The time to rest; infinite for a run that ended otherwise.
    #[must_use]
    pub const fn time_to_rest(&self) -> f64 {
        if self.is_at_rest() {
            self.time
        } else {
            f64::INFINITY
        }
    }
}

impl fmt::Display for TimeToRest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rules: Vec<String> = self.rules.iter().map(Damping::to_string).collect();
        let (rules, time, steps) = (rules.join(" + "), self.time, self.steps);
        write!(
            f,
            "{rules:<32} {time:>10.3} T {steps:>8} steps, {}",
            self.outcome.name()
        )
    }
}

impl Settling {
    /// The run under these rules.
    ///
    /// # Errors
    ///
    /// As [`Snake::damp`], and what the scheme refuses.
    pub fn under(&self, rules: &[Damping]) -> Result<TimeToRest, SimulationError> {
        let mut snake = self.snake.clone();
        for rule in [Damping::Constant(0.0), Damping::Internal(0.0)]
            .iter()
            .chain(rules)
        {
            snake.damp(*rule, &self.state)?;
        }
        let limit = self.scheme.step_limit(&snake);
        let dt = limit.map_or(self.dt, |limit| self.dt.min(0.9 * limit));
        let stepping = Stepping {
            force: true,
            ..Stepping::of(self.scheme, dt)
        };
        let t = self.state.t;
        let mut simulation = Simulation::of(snake, self.state.clone(), stepping)?;
        let outcome = simulation.run(&self.until, &mut |_| ControlFlow::Continue(()))?;
        Ok(TimeToRest {
            rules: rules.to_vec(),
            outcome,
            time: simulation.t() - t,
            steps: simulation.steps(),
        })
    }

    /// A row for each set of rules.
    ///
    /// # Errors
    ///
    /// As [`Settling::under`].
    pub fn table(&self, rules: &[Vec<Damping>]) -> Result<Vec<TimeToRest>, SimulationError> {
        rules.iter().map(|rules| self.under(rules)).collect()
    }

    /// The constant γ between `low` and `high` that comes to rest first, of `tries` on a scale of equal
    /// ratios and `tries` more about the best of those. Runs `2 tries` times.
    ///
    /// Time to rest is no smooth function of γ: modes take turns at being the last, and [`crate::Rest`] looks at
    /// moments a fifth of the run apart. So this is a search and not a descent.
    ///
    /// # Errors
    ///
    /// As [`Settling::under`].
    pub fn best_constant(
        &self,
        low: f64,
        high: f64,
        tries: u32,
    ) -> Result<TimeToRest, SimulationError> {
        let first = self.best_of(low, high, tries)?;
        let Some(Damping::Constant(gamma)) = first.rules.first().copied() else {
            return Ok(first);
        };
        let ratio = (high / low).powf(1.0 / f64::from(tries.max(2) - 1));
        let second = self.best_of(gamma / ratio, gamma * ratio, tries)?;
        let better = second.time_to_rest() < first.time_to_rest();
        Ok(if better { second } else { first })
    }

    fn best_of(&self, low: f64, high: f64, tries: u32) -> Result<TimeToRest, SimulationError> {
        let mut best = self.under(&[Damping::Constant(low)])?;
        let last = tries.max(2) - 1;
        for i in 1..=last {
            let gamma = low * (high / low).powf(f64::from(i) / f64::from(last));
            let row = self.under(&[Damping::Constant(gamma)])?;
            if row.time_to_rest() < best.time_to_rest() {
                best = row;
            }
        }
        Ok(best)
    }
}
