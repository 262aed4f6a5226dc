//! What can be wrong with an outline, each with what was given and what is needed.

use glam::DVec2;

/// What can be wrong with an outline or with what is asked of it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OutlineError {
    /// Fewer nodes than the question makes sense for.
    #[error("{what} needs at least {needed} nodes, got {got}")]
    TooFewNodes {
        /// What needs them.
        what: &'static str,
        /// The least that is allowed.
        needed: usize,
        /// What was given.
        got: usize,
    },
    /// More nodes than an index of 32 bits counts.
    #[error("{got} nodes are too many: at most {most}", most = u32::MAX / 2)]
    TooManyNodes {
        /// What was given.
        got: usize,
    },
    /// A coordinate is not a number, or so large that its square is none.
    #[error("{name} {index} must lie within 1e75 of the origin, got ({}, {})", .value.x, .value.y)]
    NotFinite {
        /// What stands there: `node`, `velocity`.
        name: &'static str,
        /// Which one, from 0.
        index: usize,
        /// What was given.
        value: DVec2,
    },
    /// A number is out of its range, or not a number.
    #[error("{name} must be {bound}, got {value}")]
    BadNumber {
        /// Which number.
        name: &'static str,
        /// What is needed.
        bound: &'static str,
        /// What was given.
        value: f64,
    },
    /// Bounds of spacing that would insert a node only to remove it again.
    #[error(
        "the most spacing must be at least {ratio} times the least, got {least} to {most}: \
         else what is divided is joined again",
        ratio = crate::Bounds::RATIO
    )]
    NarrowBounds {
        /// The least spacing given.
        least: f64,
        /// The most spacing given.
        most: f64,
    },
    /// A list does not have one value a node.
    #[error("{name} must have {needed} values, one a node, got {got}")]
    WrongLength {
        /// Which list.
        name: &'static str,
        /// The number of nodes.
        needed: usize,
        /// The number of values.
        got: usize,
    },
    /// All nodes are one and the same, so there is no curve between them.
    #[error("the nodes all lie at ({}, {}), so the curve has no length; move one", .at.x, .at.y)]
    NoLength {
        /// Where they are.
        at: DVec2,
    },
    /// Crossings that stayed after every attempt; see [`resolve`](crate::resolve).
    #[error(
        "{left} crossings are left after {rounds} rounds; are the nodes within rounding of each other?"
    )]
    Unresolved {
        /// How many.
        left: usize,
        /// After how many rounds.
        rounds: i32,
    },
}

/// The farthest a coordinate may be from the origin: products of four of them are still numbers.
pub(crate) const FAR: f64 = 1e75;

/// Refuses what is not a number or too far away.
pub(crate) fn check_points(name: &'static str, points: &[DVec2]) -> Result<(), OutlineError> {
    if points.len() > (u32::MAX / 2) as usize {
        return Err(OutlineError::TooManyNodes { got: points.len() });
    }
    let near = |v: &DVec2| v.x.abs() <= FAR && v.y.abs() <= FAR; // false for NaN
    points
        .iter()
        .position(|v| !near(v))
        .map_or(Ok(()), |index| {
            Err(OutlineError::NotFinite {
                name,
                index,
                value: points[index],
            })
        })
}

/// Refuses a number that is not positive, or not one.
pub(crate) fn check_positive(name: &'static str, value: f64) -> Result<(), OutlineError> {
    if value > 0.0 && value <= FAR {
        return Ok(());
    }
    Err(OutlineError::BadNumber {
        name,
        bound: "positive and at most 1e75",
        value,
    })
}

/// Refuses a negative number, or none.
pub(crate) fn check_not_negative(name: &'static str, value: f64) -> Result<(), OutlineError> {
    if (0.0..=FAR).contains(&value) {
        return Ok(());
    }
    Err(OutlineError::BadNumber {
        name,
        bound: "from 0 to 1e75",
        value,
    })
}

/// Refuses a list of another length.
pub(crate) fn check_length(
    name: &'static str,
    needed: usize,
    got: usize,
) -> Result<(), OutlineError> {
    if needed == got {
        return Ok(());
    }
    Err(OutlineError::WrongLength { name, needed, got })
}
