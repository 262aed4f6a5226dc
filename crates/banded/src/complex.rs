//! Complex numbers, and the factor of a band with complex numbers on its diagonal.
//!
//! Implicit schemes of high order solve `(α M + β C + K) u = b` with complex α and β: a real band
//! with a complex diagonal. The matrix is symmetric, not Hermitian, and so is its factor.

use std::ops::{Add, AddAssign, Mul, Neg, Sub};

use glam::DVec2;

use crate::scalar::Entry;
use crate::twisted::{Diagonals, Twisted};
use crate::weakest::{Weakest, weakest};
use crate::{BandedError, Pentadiagonal};

/// A complex number.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Complex {
    /// The real part.
    pub re: f64,
    /// The imaginary part.
    pub im: f64,
}

impl Complex {
    /// `re + i im`.
    #[must_use]
    pub const fn new(re: f64, im: f64) -> Self {
        Self { re, im }
    }

    /// The magnitude, without overflow in between.
    #[must_use]
    pub fn abs(self) -> f64 {
        self.re.hypot(self.im)
    }

    /// One over the number, by Smith's division: no overflow in between. Not finite for zero.
    #[must_use]
    pub fn recip(self) -> Self {
        if self.re.abs() >= self.im.abs() {
            let ratio = self.im / self.re;
            let size = self.re + self.im * ratio;
            Self::new(1.0 / size, -ratio / size)
        } else {
            let ratio = self.re / self.im;
            let size = self.re * ratio + self.im;
            Self::new(ratio / size, -1.0 / size)
        }
    }
}

impl From<f64> for Complex {
    fn from(re: f64) -> Self {
        Self::new(re, 0.0)
    }
}

impl Add for Complex {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.re + other.re, self.im + other.im)
    }
}

impl AddAssign for Complex {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Complex {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.re - other.re, self.im - other.im)
    }
}

impl Neg for Complex {
    type Output = Self;

    fn neg(self) -> Self {
        Self::new(-self.re, -self.im)
    }
}

impl Mul for Complex {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let re = self.re * other.re - self.im * other.im;
        Self::new(re, self.re * other.im + self.im * other.re)
    }
}

impl Mul<f64> for Complex {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self::new(self.re * factor, self.im * factor)
    }
}

impl Entry for Complex {
    const ZERO: Self = Self::new(0.0, 0.0);
    const ONE: Self = Self::new(1.0, 0.0);

    fn real(value: f64) -> Self {
        value.into()
    }

    fn size(self) -> f64 {
        self.abs()
    }

    fn inverse(self) -> Self {
        self.recip()
    }

    fn reciprocal(self, row: usize) -> Result<Self, BandedError> {
        let reciprocal = self.recip();
        if !(self.re + self.im).is_finite() {
            Err(BandedError::NotFinite { row })
        } else if !(reciprocal.re + reciprocal.im).is_finite() {
            Err(BandedError::Singular {
                row,
                reciprocal_condition: 0.0,
            })
        } else {
            Ok(reciprocal)
        }
    }
}

/// A point with complex coordinates, real and imaginary parts side by side.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ComplexPoint {
    /// The real parts of x and y.
    pub re: DVec2,
    /// The imaginary parts of x and y.
    pub im: DVec2,
}

impl ComplexPoint {
    /// `re + i im`.
    #[must_use]
    pub const fn new(re: DVec2, im: DVec2) -> Self {
        Self { re, im }
    }
}

impl From<DVec2> for ComplexPoint {
    fn from(re: DVec2) -> Self {
        Self::new(re, DVec2::ZERO)
    }
}

impl Add for ComplexPoint {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.re + other.re, self.im + other.im)
    }
}

impl Sub for ComplexPoint {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.re - other.re, self.im - other.im)
    }
}

impl Mul<Complex> for ComplexPoint {
    type Output = Self;

    #[inline(always)]
    fn mul(self, c: Complex) -> Self {
        Self::new(
            self.re * c.re - self.im * c.im,
            self.re * c.im + self.im * c.re,
        )
    }
}

impl Mul<f64> for ComplexPoint {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self::new(self.re * factor, self.im * factor)
    }
}

/// `diag(shift) + A = L D Lᵀ` of a real [`Pentadiagonal`] `A` and a complex diagonal.
///
/// Made and used as [`Factor`](crate::Factor). No rows are exchanged. That is stable when some
/// multiple `e^{iθ}` of the matrix has positive definite real and imaginary parts (`[higham98]`), as
/// `z² M + z C + K` has for masses, dampings and stiffnesses that are not negative and `Re z > 0`;
/// whether it went well is checked by a solve, once.
#[derive(Debug, Clone, PartialEq)]
pub struct ComplexFactor {
    twisted: Twisted<Complex>,
    reciprocal_condition: f64,
}

impl ComplexFactor {
    /// Factors `diag(shift) + A`; `shift` has one number a row. O(n).
    ///
    /// # Errors
    ///
    /// Refuses a shift of another length, numbers that are not finite, a matrix that is singular to
    /// working precision, and one whose factor has lost more than four digits for want of exchanges.
    pub fn new(a: &Pentadiagonal, shift: &[Complex]) -> Result<Self, BandedError> {
        let n = a.len();
        if shift.len() != n {
            return Err(BandedError::Length {
                name: "shift",
                expected: n,
                got: shift.len(),
            });
        }
        let lift = |entries: &[f64]| entries.iter().map(|&a| a.into()).collect::<Vec<Complex>>();
        let mut diagonal = lift(a.diagonal());
        diagonal
            .iter_mut()
            .zip(shift)
            .for_each(|(d, &shift)| *d += shift);
        let (first, second) = (&lift(a.first()), &lift(a.second()));
        let diagonals = Diagonals {
            cyclic: a.is_cyclic(),
            diagonal: &diagonal,
            first,
            second,
        };
        diagonals.check_finite()?;
        let twisted = Twisted::new(&diagonals)?;
        let Weakest {
            row,
            reciprocal_condition,
            backward_error,
        } = weakest(a.len(), |x| twisted.solve(x), |i, x| diagonals.row(i, x));
        if reciprocal_condition < crate::weakest::SINGULAR {
            return Err(BandedError::Singular {
                row,
                reciprocal_condition,
            });
        }
        if backward_error > 1e4 * f64::EPSILON {
            return Err(BandedError::Unstable { backward_error });
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

    /// `1 / (‖A‖ ‖A⁻¹‖)`, estimated: right within a factor of a few.
    #[must_use]
    pub fn reciprocal_condition(&self) -> f64 {
        self.reciprocal_condition
    }

    /// Turns the right-hand side `b` into the solution, x and y in one sweep.
    ///
    /// O(n), allocates nothing.
    pub fn solve(&self, b: &mut [ComplexPoint]) {
        self.twisted.solve(b);
    }

    /// Turns the right-hand side `b` into the solution, one number a row.
    pub fn solve_scalars(&self, b: &mut [Complex]) {
        self.twisted.solve(b);
    }
}
