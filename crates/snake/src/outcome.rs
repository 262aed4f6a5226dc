//! When a run stops, and how it ended.

use glam::DVec2;
use integrator::{Fault, FaultKind};

use crate::Rest;

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
