//! What cannot be measured, and what is needed.

use outline::OutlineError;

/// Why something cannot be measured.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ScoreError {
    /// Two masks or images of different sizes.
    #[error("sizes must be equal, got {} × {} and {} × {} pixels", first.1, first.0, second.1, second.0)]
    Sizes {
        /// Rows and columns of the first.
        first: (usize, usize),
        /// Rows and columns of the second.
        second: (usize, usize),
    },
    /// An outline of no points.
    #[error("the {0} outline has no points; at least one polygon is needed")]
    Empty(&'static str),
    /// An outline that encloses no area, of which most measures make no sense.
    #[error(
        "the outline encloses no area; needed: a polygon of at least three nodes, not on one line"
    )]
    Flat,
    /// An outline too long to be walked along in half pixels.
    #[error("the {0} outline must be at most {1} pixels long, got {2:.3e}")]
    Long(&'static str, f64, f64),
    /// A number out of its range.
    #[error("{what} must be a number of at least 0, got {got}")]
    Negative {
        /// Of what.
        what: &'static str,
        /// What was given.
        got: f64,
    },
    /// A cost that is no number.
    #[error("costs must be finite, got {got} in row {} and column {}", at.0, at.1)]
    Cost {
        /// Row and column, from 0.
        at: (usize, usize),
        /// What was given.
        got: f64,
    },
    /// A table of the lives of objects that does not fit what was seen of them.
    #[error("the {whose} object {label} {message}")]
    Lineage {
        /// Found or true.
        whose: &'static str,
        /// Which object.
        label: u32,
        /// What does not fit.
        message: String,
    },
    /// Nodes that are no places.
    #[error(transparent)]
    Outline(#[from] OutlineError),
}
