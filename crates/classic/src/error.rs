//! What can be wrong with a picture, a start or a rule.

/// Why there is no snake.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ClassicError {
    /// A picture of fewer than three pixels across.
    #[error(
        "image: must have at least 3×3 pixels and a channel, got {height}×{width} and {channels}"
    )]
    Small {
        /// Rows.
        height: usize,
        /// Columns.
        width: usize,
        /// Channels.
        channels: usize,
    },
    /// A level that is no number.
    #[error("image: must be finite everywhere, got {got} at row {row}, column {column}")]
    Level {
        /// The row.
        row: usize,
        /// The column.
        column: usize,
        /// The level.
        got: f64,
    },
    /// Too few points.
    #[error("snake: must have at least {needed} points, got {got}")]
    Few {
        /// As many as there must be.
        needed: usize,
        /// As many as there are.
        got: usize,
    },
    /// A point that is no place.
    #[error("snake: point {index} must be finite, got ({x}, {y})")]
    Point {
        /// Its index.
        index: usize,
        /// Its column.
        x: f64,
        /// Its row.
        y: f64,
    },
    /// A rule out of its range.
    #[error("{name}: must be {needed}, got {got}")]
    Rule {
        /// Which.
        name: &'static str,
        /// The range, in words.
        needed: &'static str,
        /// What was given.
        got: f64,
    },
    /// No stable step.
    #[error(
        "alpha, beta, gamma: no step is stable with {alpha}, {beta}, {gamma}; alpha and beta at least 0 always are"
    )]
    Unstable {
        /// The tension.
        alpha: f64,
        /// The rigidity.
        beta: f64,
        /// The step.
        gamma: f64,
    },
    /// A snake over so much of the picture that there is no room for its energy.
    #[error("snake: it spans {pixels} pixels of the picture, must be at most {most}")]
    Large {
        /// As many as it spans.
        pixels: u64,
        /// As many as there may be.
        most: u64,
    },
}
