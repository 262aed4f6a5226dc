//! Running a snake until something happens.

use std::ops::ControlFlow;

use glam::DVec2;
use integrator::{Fault, FaultKind, State, Stepper};

use crate::Snake;
use crate::rest::{Rest, Verdict, Watch};

/// A node farther from the origin is nowhere. L.
pub(crate) const FAR: f64 = 1e12;

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Until {
    /// After so many steps at the latest.
    pub steps: u64,
    /// At this time, if steps are of no one length. T.
    pub time: Option<f64>,
    /// When at rest, if asked for; then also when it goes round in circles, is lost or collapses.
    pub rest: Option<Rest>,
}

impl Until {
    /// After `steps` steps.
    #[must_use]
    pub const fn steps(steps: u64) -> Self {
        Self {
            steps,
            time: None,
            rest: None,
        }
    }

    /// When at rest, or after `steps` steps.
    #[must_use]
    pub const fn at_rest(rest: Rest, steps: u64) -> Self {
        Self {
            steps,
            time: None,
            rest: Some(rest),
        }
    }
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
    /// It goes to and fro without getting calmer, as a node on a jump of the report's sampling does
    /// (D52), or anything without damping.
    Cycles {
        /// Seen at this step.
        step: u64,
        /// How far the node that moves most gets from where it was. L.
        reach: f64,
    },
    /// More than half of its nodes are at the border of the picture or beyond it.
    Lost {
        /// Seen at this step.
        step: u64,
    },
    /// It has shrunk to a hundredth of its size at the start, or less; or a closed curve that
    /// enclosed something lies flat.
    Collapsed {
        /// Seen at this step.
        step: u64,
    },
    /// A closed curve is the other way round than it was at the start: it has passed through itself.
    TurnedOver {
        /// Seen at this step.
        step: u64,
    },
    /// Curves that push each other lie in each other, or have been: what came too fast for the
    /// contacts to stop it has passed
    /// into another curve, or through it.
    Overlaps {
        /// Steps completed.
        step: u64,
        /// How deep a node is or was in another curve at most, as far as it was followed. L.
        depth: f64,
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
            | Self::Cycles { step, .. }
            | Self::Lost { step }
            | Self::Collapsed { step }
            | Self::TurnedOver { step }
            | Self::Overlaps { step, .. }
            | Self::Stopped { step }
            | Self::Diverged { step, .. }
            | Self::LeftField { step, .. } => step,
        }
    }

    /// What a force or a number that fails makes of a run.
    pub(crate) const fn of_fault(fault: Fault, step: u64) -> Self {
        let Fault { node, at, kind } = fault;
        match kind {
            FaultKind::OutsideField => Self::LeftField { step, node, at },
            _ => Self::Diverged { step, node },
        }
    }

    /// The word for it in records.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Finished { .. } => "finished",
            Self::Settled { .. } => "settled",
            Self::Cycles { .. } => "cycles",
            Self::Lost { .. } => "lost",
            Self::Collapsed { .. } => "collapsed",
            Self::TurnedOver { .. } => "turned-over",
            Self::Overlaps { .. } => "overlaps",
            Self::Stopped { .. } => "stopped",
            Self::Diverged { .. } => "diverged",
            Self::LeftField { .. } => "left-field",
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
            Self::Cycles { step, reach } => write!(
                f,
                "goes to and fro by {reach:.3} pixels without getting calmer, seen after {step} steps"
            ),
            Self::Lost { step } => {
                write!(
                    f,
                    "lost: most of it is at the border of the picture after {step} steps"
                )
            }
            Self::Collapsed { step } => {
                write!(
                    f,
                    "collapsed: hardly any size or area is left after {step} steps"
                )
            }
            Self::TurnedOver { step } => write!(
                f,
                "turned over: the closed curve has passed through itself and runs the other way round, seen after {step} steps"
            ),
            Self::Overlaps { step, depth } => write!(
                f,
                "curves that push each other are or were in each other by {depth:.3} pixels, seen after {step} steps"
            ),
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
/// The observer sees the state after each step, may change the snake's body or world, and may stop
/// the run. A snake whose nodes are farther than 1e12 from the origin, or nowhere, has blown up.
///
/// The observer is the hand: it watches, pulls, lets go, changes a parameter, pauses and stops.
///
/// ```
/// use std::ops::ControlFlow::{Break, Continue};
///
/// use glam::DVec2;
/// use integrator::{Scheme, Start, State};
/// use snake::{Acting, Body, Ledger, Outcome, Snake, Spring, Until, World, run};
///
/// let circle = elastic::circle(DVec2::ZERO, 10.0, 40);
/// let body = Body::of(&circle, elastic::Topology::Closed, 1.0)?.with_damping(1.0);
/// let mut snake = Snake::new(body, World::default())?;
/// let mut state = State::at_rest(circle);
/// let mut stepper = Scheme::Leapfrog.start(&mut snake, &state, 0.01, Start::SecondOrder)?;
/// let mut ledger = Ledger::begin(&mut snake, &state).map_err(|fault| fault.to_string())?;
///
/// // pull node 0 from t = 1 to t = 3
/// let mut hand = |snake: &mut Snake, state: &State| {
///     let _ = ledger.book(snake, state); // watch
///     if state.step == 100 {
///         let pull = Spring::at_node(0, DVec2::new(14.0, 0.0), 5.0);
///         return snake.add_force(Acting::new(pull)).map_or(Break(()), Continue);
///     }
///     if state.step == 300 {
///         snake.remove_force("spring");
///     }
///     Continue(())
/// };
/// run(&mut snake, &mut *stepper, &mut state, &Until::steps(400), &mut hand);
/// assert!(state.x[0].x > 10.0);
/// // between two calls the run pauses; a parameter may change there as it may in an observer
/// let thick = snake.body().clone().with_damping(8.0);
/// snake.set_body(thick)?;
/// stepper.resume(&mut snake, &state);
/// // on, until it is calm
/// let mut calm = |_: &mut Snake, state: &State| {
///     let fastest = state.v.iter().map(|v| v.length()).fold(0.0, f64::max);
///     if fastest < 1e-3 { Break(()) } else { Continue(()) }
/// };
/// let outcome = run(&mut snake, &mut *stepper, &mut state, &Until::steps(10_000), &mut calm);
/// assert!(matches!(outcome, Outcome::Stopped { step } if step > 400));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn run(
    snake: &mut Snake,
    stepper: &mut dyn Stepper,
    state: &mut State,
    until: &Until,
    observer: &mut dyn FnMut(&mut Snake, &State) -> ControlFlow<()>,
) -> Outcome {
    let mut running = Running::begin(snake, state, *until);
    let step = state.step;
    let outcome = running.go(snake, stepper, state, u64::MAX, observer);
    // it always ends: the steps are counted
    outcome.unwrap_or(Outcome::Finished { step })
}

/// A run that is made in parts: as [`run`], with pauses in which nothing is forgotten.
#[derive(Debug)]
pub struct Running {
    until: Until,
    begin: u64,
    watch: Option<Watch>,
}

impl Running {
    /// Begin a run at `state`, to last until `until`.
    pub fn begin(snake: &mut Snake, state: &State, until: Until) -> Self {
        snake.settle(state);
        let watch = until.rest.map(|rest| Watch::new(rest, snake, state));
        Self {
            until,
            begin: state.step,
            watch,
        }
    }

    /// Go on by at most so many steps, each shown to the observer; None if the run has not ended.
    pub fn go(
        &mut self,
        snake: &mut Snake,
        stepper: &mut dyn Stepper,
        state: &mut State,
        steps: u64,
        observer: &mut dyn FnMut(&mut Snake, &State) -> ControlFlow<()>,
    ) -> Option<Outcome> {
        let end = self.until.time;
        let over = |state: &State| end.is_some_and(|end| state.t >= end);
        let paused = state.step.saturating_add(steps);
        while state.step - self.begin < self.until.steps && !over(state) {
            if state.step >= paused {
                return None;
            }
            if let Err(fault) = stepper.step(snake, state) {
                return Some(Outcome::of_fault(fault, state.step));
            }
            let somewhere = |x: &DVec2| x.is_finite() && x.abs().max_element() < FAR;
            if let Some(node) = state.x.iter().position(|x| !somewhere(x)) {
                let step = state.step;
                return Some(Outcome::Diverged { step, node });
            }
            let changes = snake.changes;
            if observer(snake, state).is_break() {
                return Some(Outcome::Stopped { step: state.step });
            }
            if snake.changes != changes {
                // forces kept from the last step are no longer those of this snake
                stepper.resume(snake, state);
            }
            let step = state.step;
            let watch = self.watch.as_mut();
            match watch.and_then(|watch| watch.look(snake, state, &[])) {
                None | Some(Verdict::Moving) => {}
                Some(verdict) => {
                    let settled = Outcome::Settled { step };
                    return Some(verdict.outcome(step).unwrap_or(settled));
                }
            }
        }
        let step = state.step;
        let watch = self.watch.as_ref();
        let turned = watch.and_then(|watch| watch.turned(snake, state));
        let turned = turned.and_then(|verdict| verdict.outcome(step));
        Some(turned.unwrap_or(Outcome::Finished { step }))
    }
}
