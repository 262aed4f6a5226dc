//! What can be wrong with a matrix.
//!
//! Every refusal happens while a matrix is built or factored; products and solves cannot fail.

/// What can be wrong with a matrix, or with what is asked of it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BandedError {
    /// Fewer rows than the band reaches over.
    #[error("the band needs at least {needed} rows, got {got}")]
    TooSmall {
        /// The least number of rows.
        needed: usize,
        /// The number asked for.
        got: usize,
    },
    /// A half width there is no band of.
    #[error("a band has from 1 to {most} diagonals on either side, got {got}")]
    HalfWidth {
        /// The largest half width.
        most: usize,
        /// The half width asked for.
        got: usize,
    },
    /// Two things that go together differ in length.
    #[error("{name} must have length {expected}, got {got}")]
    Length {
        /// What has the wrong length.
        name: &'static str,
        /// The length that fits.
        expected: usize,
        /// The length given.
        got: usize,
    },
    /// An entry that is NaN or infinite, or so large that the pivot is.
    #[error("row {row} holds a number that is not finite")]
    NotFinite {
        /// The row, from 0.
        row: usize,
    },
    /// The elimination met a pivot that is not above zero.
    #[error("the matrix is not positive definite: the pivot of row {row} is {pivot:e}")]
    NotPositive {
        /// The row, from 0.
        row: usize,
        /// The pivot met there.
        pivot: f64,
    },
    /// All pivots are above zero, but only by rounding.
    #[error(
        "the matrix is singular to working precision: row {row} can move against almost no \
         resistance (reciprocal condition {reciprocal_condition:e})"
    )]
    Singular {
        /// The row that moves most in the weakest direction, from 0.
        row: usize,
        /// Smallest over largest eigenvalue, estimated.
        reciprocal_condition: f64,
    },
    /// A complex matrix that cannot be eliminated in order without losing digits.
    #[error(
        "the elimination is unstable: a solution misses its right-hand side by {backward_error:e} \
         of the matrix"
    )]
    Unstable {
        /// `‖b − A x‖ / (‖A‖ ‖x‖)`.
        backward_error: f64,
    },
    /// The matrix asked for is symmetric, and this one is not.
    #[error("entry ({row}, {column}) differs from its mirror image")]
    NotSymmetric {
        /// The row, from 0.
        row: usize,
        /// The column, from 0.
        column: usize,
    },
    /// A matrix whose rows are not all the same, or whose band does not wrap round.
    #[error("the matrix is not circulant: its band must wrap round and its rows be the same")]
    NotCirculant,
    /// A correction that takes all resistance from some direction.
    #[error("column {column} of the correction makes the matrix singular")]
    SingularCorrection {
        /// The column, from 0, up to a change of basis.
        column: usize,
    },
    /// More columns of low rank than are worth a correction.
    #[error("a correction has at most {most} columns, got {got}")]
    TooManyColumns {
        /// The largest number of columns.
        most: usize,
        /// The number given.
        got: usize,
    },
}
