//! Why a scheme will not start.

use banded::BandedError;

/// What can be wrong with a step, a system or the name of a scheme.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SchemeError {
    /// A step that is zero, negative, infinite or NaN.
    #[error("a step must be finite and above 0, got {dt}")]
    BadStep {
        /// The step given.
        dt: f64,
    },
    /// A longest way of a step that is zero, negative, infinite or NaN.
    #[error("the longest way of a step must be finite and above 0, got {reach}")]
    BadReach {
        /// The way given.
        reach: f64,
    },
    /// A step with which the scheme blows up.
    #[error(
        "a step of {} is too large for {scheme}: must be at most {}, the largest stable step",
        number(*dt), number(*limit)
    )]
    AboveLimit {
        /// The scheme's name.
        scheme: &'static str,
        /// The step given.
        dt: f64,
        /// The largest stable step.
        limit: f64,
    },
    /// A step so large or so small that the numbers of the scheme leave the range of `f64`.
    #[error(
        "a step of {} is beyond what {scheme} can compute with; dt² and 1/dt² must be finite",
        number(*dt)
    )]
    BeyondNumbers {
        /// The scheme's name.
        scheme: &'static str,
        /// The step given.
        dt: f64,
    },
    /// A mass that is zero in a scheme that divides by it, negative, or not finite.
    #[error(
        "{scheme} needs a finite mass above 0 at every node, node {node} has {mass}; \
         gradient-flow moves nodes without mass"
    )]
    BadMass {
        /// The scheme's name.
        scheme: &'static str,
        /// The first such node.
        node: usize,
        /// Its mass.
        mass: f64,
    },
    /// A damping that is negative or not finite.
    #[error("damping must be finite and at least 0, node {node} has {damping}")]
    BadDamping {
        /// The first such node.
        node: usize,
        /// Its damping.
        damping: f64,
    },
    /// A position or velocity that is not a finite number.
    #[error("node {node} starts at a place or with a velocity that is not finite")]
    BadStart {
        /// The first such node.
        node: usize,
    },
    /// A system or state whose parts do not have one entry a node.
    #[error("{what} has {got} entries for {needed} nodes")]
    Length {
        /// The part.
        what: &'static str,
        /// Number of nodes of the system.
        needed: usize,
        /// Number of entries.
        got: usize,
    },
    /// A parameter of a scheme outside its range.
    #[error("{scheme}: {name} must be {range}, got {value}")]
    BadParameter {
        /// The scheme's name.
        scheme: &'static str,
        /// The parameter.
        name: &'static str,
        /// What is needed.
        range: &'static str,
        /// The value given.
        value: f64,
    },
    /// A system that the exact schemes cannot take apart into modes.
    #[error("{scheme} cannot take this system apart into modes: {why}")]
    NoModes {
        /// The scheme's name.
        scheme: &'static str,
        /// What stands in the way, and what is needed.
        why: String,
    },
    /// A scheme that keeps one step, where steps were to change.
    #[error(
        "{scheme} keeps one step: its velocity belongs to it; leapfrog is the same with steps that \
         may change"
    )]
    OneStep {
        /// The scheme's name.
        scheme: &'static str,
    },
    /// No scheme has this name.
    #[error("there is no scheme {name}; the nearest is {nearest}")]
    Unknown {
        /// The name given.
        name: String,
        /// The known name most like it.
        nearest: &'static str,
    },
    /// The matrix of an implicit step has no factor.
    #[error(
        "the step's matrix cannot be factored: {0}; needed: mass, damping or stiffness above 0"
    )]
    Matrix(#[from] BandedError),
}

/// A number as people write it: with a power of ten where it would be a row of zeros.
fn number(x: f64) -> String {
    if (1e-6..1e9).contains(&x.abs()) {
        x.to_string()
    } else {
        format!("{x:e}")
    }
}
