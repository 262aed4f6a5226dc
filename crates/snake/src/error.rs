//! What can be wrong with a snake or its world.

use elastic::ElasticError;
use glam::DVec2;
use integrator::SchemeError;

/// A value that a snake cannot have.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SnakeError {
    /// The curve or its material.
    #[error(transparent)]
    Elastic(#[from] ElasticError),
    /// A scheme that cannot move it.
    #[error(transparent)]
    Scheme(#[from] SchemeError),
    /// A name that is none of those known.
    #[error("there is no {what} {name:?}; known are {known}")]
    UnknownName {
        /// What was to be named.
        what: &'static str,
        /// What was given.
        name: String,
        /// What is needed.
        known: &'static str,
    },
    /// Something that a turning frame cannot carry.
    #[error("a frame that turns by its own equation needs {needed}")]
    NotInTurningFrame {
        /// What is needed.
        needed: &'static str,
    },
    /// A snake whose ends cannot grow.
    #[error("ends that grow need {needed}")]
    CannotGrow {
        /// What is needed.
        needed: &'static str,
    },
    /// A line that nothing can slide along.
    #[error(transparent)]
    Line(#[from] outline::OutlineError),
    /// A mode that the body has not.
    #[error("there is no mode {mode} that resists: the body has {modes} of them")]
    NoMode {
        /// What was asked for, counted from 0.
        mode: usize,
        /// How many there are.
        modes: usize,
    },
    /// A number that must be finite, or at least something, is not.
    #[error("{name} must be finite and {bound}, got {value}")]
    BadNumber {
        /// The user's word for it.
        name: &'static str,
        /// What is needed.
        bound: &'static str,
        /// What was given.
        value: f64,
    },
    /// A wall whose normal has no direction.
    #[error("a wall needs a normal of nonzero length, got ({x}, {y})")]
    NoNormal {
        /// x of the normal given.
        x: f64,
        /// y of the normal given.
        y: f64,
    },
    /// A schedule without times in ascending order.
    #[error("the times of a schedule must ascend, but entry {index} is at {time}")]
    BadSchedule {
        /// Index of the first entry out of order.
        index: usize,
        /// Its time.
        time: f64,
    },
    /// Another number of nodes than the snake has.
    #[error("the snake has {needed} nodes, got a body of {got}")]
    OtherLength {
        /// What the snake has.
        needed: usize,
        /// What was given.
        got: usize,
    },
    /// A node that there is not.
    #[error("there is no node {node}: the snake has {nodes}, counted from 0")]
    NoSuchNode {
        /// The node asked for.
        node: usize,
        /// How many there are.
        nodes: usize,
    },
    /// Too few nodes to take hold of a curve.
    #[error("at least {needed} nodes are needed, got {got}")]
    TooFewNodes {
        /// What is needed.
        needed: usize,
        /// What was given.
        got: usize,
    },
    /// No force of that name acts.
    #[error("no force called {name:?} acts on the snake")]
    NoSuchForce {
        /// The name asked for.
        name: String,
    },
    /// A force that needs an inside, on an open curve.
    #[error("the force {name:?} needs a closed curve: an open one has no inside")]
    NeedsClosed {
        /// What it is called.
        name: String,
    },
    /// The mass-weighted center needs some mass.
    #[error("the center of mass needs some mass, but mass is 0 everywhere")]
    NoMass,
}

/// `value`, or an error that names it.
pub(crate) fn finite_at_least(
    name: &'static str,
    least: f64,
    bound: &'static str,
    value: f64,
) -> Result<f64, SnakeError> {
    if value.is_finite() && value >= least {
        Ok(value)
    } else {
        Err(SnakeError::BadNumber { name, bound, value })
    }
}

/// Whether `at` is a place.
pub(crate) fn place(name: &'static str, at: DVec2) -> Result<(), SnakeError> {
    finite_at_least(name, f64::MIN, "a place", at.x)?;
    finite_at_least(name, f64::MIN, "a place", at.y)?;
    Ok(())
}
