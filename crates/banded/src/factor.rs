//! LDLᵀ of a band, kept for many solves.

use glam::DVec2;

use crate::twisted::{Diagonals, Twisted};
use crate::weakest::{SINGULAR, Weakest, weakest};
use crate::{BandedError, Pentadiagonal};

/// `A = L D Lᵀ` of a positive definite [`Pentadiagonal`]: factor once, solve many times.
///
/// O(n) to make and to use. Pivots are kept as reciprocals, so a solve divides nothing. Rows are
/// eliminated from both ends towards the middle, when cyclic after cutting out the last two: as
/// stable as any Cholesky factorisation, so a solution satisfies `A x = b` to some units in the last
/// place of `‖A‖ ‖x‖`, whatever the condition number.
#[derive(Debug, Clone, PartialEq)]
pub struct Factor {
    twisted: Twisted<f64>,
    reciprocal_condition: f64,
}

impl Factor {
    /// Factors a matrix. O(n).
    ///
    /// # Errors
    ///
    /// Refuses, with the row, a matrix that is not positive definite, one that is singular to
    /// working precision (condition number above about 1e14), and numbers that are not finite.
    pub fn new(a: &Pentadiagonal) -> Result<Self, BandedError> {
        let (diagonal, first, second) = (a.diagonal(), a.first(), a.second());
        let diagonals = Diagonals {
            cyclic: a.is_cyclic(),
            diagonal,
            first,
            second,
        };
        diagonals.check_finite()?;
        let twisted = Twisted::new(&diagonals)?;
        let Weakest {
            row,
            reciprocal_condition,
            ..
        } = weakest(a.len(), |x| twisted.solve(x), |i, x| diagonals.row(i, x));
        if reciprocal_condition < SINGULAR {
            return Err(BandedError::Singular {
                row,
                reciprocal_condition,
            });
        }
        Ok(Self {
            twisted,
            reciprocal_condition,
        })
    }

    /// The number of rows.
    #[must_use]
    #[allow(clippy::len_without_is_empty, reason = "a matrix has at least 3 rows")]
    pub fn len(&self) -> usize {
        self.twisted.len()
    }

    /// Smallest over largest eigenvalue, estimated: right within a factor of a few.
    ///
    /// A relative error of the right-hand side grows at most by one over this.
    #[must_use]
    pub fn reciprocal_condition(&self) -> f64 {
        self.reciprocal_condition
    }

    /// Turns the right-hand side `b` into the solution of `A x = b`, x and y in one sweep.
    ///
    /// O(n), allocates nothing.
    pub fn solve(&self, b: &mut [DVec2]) {
        self.twisted.solve(b);
    }

    /// Turns the right-hand side `b` into the solution, one number a row.
    pub fn solve_scalars(&self, b: &mut [f64]) {
        self.twisted.solve(b);
    }
}
