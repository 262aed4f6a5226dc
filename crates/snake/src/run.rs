//! Running a snake until something happens.

use std::ops::ControlFlow;

use glam::DVec2;
use integrator::{FaultKind, State, Stepper};

use crate::Snake;

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Until {
    /// After so many steps at the latest.
    pub steps: u64,
    /// When at rest, if asked for.
    pub rest: Option<Rest>,
}

impl Until {
    /// After `steps` steps.
    #[must_use]
    pub const fn steps(steps: u64) -> Self {
        Self { steps, rest: None }
    }

    /// When at rest, or after `steps` steps.
    #[must_use]
    pub const fn at_rest(rest: Rest, steps: u64) -> Self {
        Self {
            steps,
            rest: Some(rest),
        }
    }
}

/// What counts as rest: slow *and* balanced, at two looks in a row.
///
/// Force alone would call a snake flying through empty space at rest, speed alone one that is
/// just being let go, or that creeps by less than a threshold a step (the false convergence of
/// tests on pixels per step).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rest {
    /// Largest speed of a node. L T⁻¹.
    pub speed: f64,
    /// Largest net force on a node, per unit of arc length. M L T⁻².
    pub force: f64,
    /// Steps between two looks.
    pub every: u64,
}

/// How a run ended. None of these is an error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Outcome {
    /// All steps asked for were made.
    Finished {
        /// Steps made.
        step: u64,
    },
    /// It came to rest.
    Settled {
        /// At this step.
        step: u64,
    },
    /// The observer said so.
    Stopped {
        /// At this step.
        step: u64,
    },
    /// A node is no longer anywhere.
    Diverged {
        /// Steps completed.
        step: u64,
        /// The first such node.
        node: usize,
    },
    /// A node left the picture, under the report's rule that ends there (D54).
    LeftField {
        /// Steps completed.
        step: u64,
        /// The first such node.
        node: usize,
        /// Where it was.
        at: DVec2,
    },
}

impl Outcome {
    /// Steps completed.
    #[must_use]
    pub const fn step(&self) -> u64 {
        match *self {
            Self::Finished { step }
            | Self::Settled { step }
            | Self::Stopped { step }
            | Self::Diverged { step, .. }
            | Self::LeftField { step, .. } => step,
        }
    }

    /// Whether it went as asked.
    #[must_use]
    pub const fn is_good(&self) -> bool {
        matches!(
            self,
            Self::Finished { .. } | Self::Settled { .. } | Self::Stopped { .. }
        )
    }
}

impl std::fmt::Display for Outcome {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match *self {
            Self::Finished { step } => write!(f, "finished after {step} steps"),
            Self::Settled { step } => write!(f, "came to rest after {step} steps"),
            Self::Stopped { step } => write!(f, "stopped after {step} steps"),
            Self::Diverged { step, node } => {
                write!(f, "blew up after {step} steps, first at node {node}")
            }
            Self::LeftField { step, node, at } => write!(
                f,
                "node {node} left the picture after {step} steps, at ({:.3}, {:.3})",
                at.x, at.y
            ),
        }
    }
}

/// Move `snake` from `state` by `stepper` until `until`, showing every step to `observer`.
///
/// The observer sees the state after each step and may stop the run. A snake whose nodes are
/// farther than 1e12 from the origin, or nowhere, has blown up.
pub fn run(
    snake: &mut Snake,
    stepper: &mut dyn Stepper,
    state: &mut State,
    until: &Until,
    observer: &mut dyn FnMut(&mut Snake, &State) -> ControlFlow<()>,
) -> Outcome {
    let mut scratch = vec![DVec2::ZERO; state.x.len()];
    let mut looks = 0;
    let begin = state.step;
    while state.step - begin < until.steps {
        if let Err(fault) = stepper.step(snake, state) {
            let (step, node) = (state.step, fault.node);
            return match fault.kind {
                FaultKind::OutsideField => Outcome::LeftField {
                    step,
                    node,
                    at: fault.at,
                },
                _ => Outcome::Diverged { step, node },
            };
        }
        let somewhere = |x: &DVec2| x.is_finite() && x.abs().max_element() < 1e12;
        if let Some(node) = state.x.iter().position(|x| !somewhere(x)) {
            return Outcome::Diverged {
                step: state.step,
                node,
            };
        }
        if observer(snake, state).is_break() {
            return Outcome::Stopped { step: state.step };
        }
        if let Some(rest) = until.rest
            && state.step.is_multiple_of(rest.every.max(1))
        {
            let speed = state.v.iter().map(|v| v.length()).fold(0.0, f64::max);
            let calm = speed < rest.speed
                && snake
                    .residual(state, &mut scratch)
                    .is_ok_and(|force| force < rest.force);
            looks = if calm { looks + 1 } else { 0 };
            if looks == 2 {
                return Outcome::Settled { step: state.step };
            }
        }
    }
    Outcome::Finished { step: state.step }
}
