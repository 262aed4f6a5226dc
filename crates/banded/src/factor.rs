//! LDLᵀ of a band, kept for many solves.

use glam::DVec2;

use crate::twisted::{Diagonals, Twisted};
use crate::{BandedError, Pentadiagonal};

/// Reciprocal condition numbers below this are rounding: 32 units in the last place.
const SINGULAR: f64 = 32.0 * f64::EPSILON;

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
        let finite = |i: &usize| (diagonal[*i] + first[*i] + second[*i]).is_finite();
        if let Some(row) = (0..a.len()).find(|i| !finite(i)) {
            return Err(BandedError::NotFinite { row });
        }
        let twisted = Twisted::new(&Diagonals {
            cyclic: a.is_cyclic(),
            diagonal,
            first,
            second,
        })?;
        let mut factor = Self {
            twisted,
            reciprocal_condition: 1.0,
        };
        let (row, smallest) = factor.weakest();
        factor.reciprocal_condition = smallest / a.norm();
        if factor.reciprocal_condition >= SINGULAR {
            Ok(factor)
        } else {
            let reciprocal_condition = factor.reciprocal_condition;
            Err(BandedError::Singular {
                row,
                reciprocal_condition,
            })
        }
    }

    /// The number of rows.
    #[must_use]
    #[allow(clippy::len_without_is_empty, reason = "a matrix has at least 3 rows")]
    pub fn len(&self) -> usize {
        self.twisted.len()
    }

    /// Smallest over largest eigenvalue, estimated: right within a factor of a few.
    ///
    /// Multiply by the error of a right-hand side, relative, and divide: so many digits are lost.
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

    /// The row that moves most in the weakest direction, and about the smallest eigenvalue.
    ///
    /// Two inverse iterations from numbers without a pattern: a direction as weak as rounding
    /// outgrows all others in the first.
    fn weakest(&self) -> (usize, f64) {
        // Weyl's sequence: evenly spread in −½..½, in step with no wave of the band
        let mut turn = 0.0_f64;
        let mut x: Vec<f64> = Vec::with_capacity(self.len());
        for _ in 0..self.len() {
            turn = (turn + 0.618_033_988_749_894_9).fract();
            x.push(turn - 0.5);
        }
        let largest = |x: &[f64]| {
            let most = |best: (usize, f64), (i, x): (usize, &f64)| {
                if x.abs() > best.1 { (i, x.abs()) } else { best }
            };
            x.iter().enumerate().fold((0, 0.0), most)
        };
        let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let mut smallest = f64::INFINITY;
        for _ in 0..2 {
            let scale = 1.0 / norm(&x);
            x.iter_mut().for_each(|x| *x *= scale);
            self.solve_scalars(&mut x);
            smallest = smallest.min(1.0 / norm(&x));
        }
        (largest(&x).0, smallest)
    }
}
