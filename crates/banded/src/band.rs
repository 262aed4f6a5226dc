//! A band of whatever width: five diagonals, or more.
//!
//! Which of the two is asked at the door of each product, factor and solve, never within a loop: five diagonals cost what
//! they cost alone.

use glam::DVec2;

use crate::{
    Banded, BandedError, BandedFactor, Complex, ComplexBandedFactor, ComplexFactor, ComplexPoint,
    Dense, Factor, Pentadiagonal, spectrum,
};

/// A symmetric band matrix, open or cyclic: pentadiagonal wherever that is wide enough.
#[derive(Debug, Clone, PartialEq)]
pub enum Band {
    /// Five diagonals.
    Narrow(Pentadiagonal),
    /// Any number of them.
    Wide(Banded),
}

impl From<Pentadiagonal> for Band {
    fn from(band: Pentadiagonal) -> Self {
        Self::Narrow(band)
    }
}

impl From<Banded> for Band {
    fn from(band: Banded) -> Self {
        Self::Wide(band)
    }
}

/// The same call on whichever it is.
macro_rules! either {
    ($self:expr, $a:ident => $call:expr) => {
        match $self {
            Self::Narrow($a) => $call,
            Self::Wide($a) => $call,
        }
    };
}

impl Band {
    /// The zero matrix with `n` rows: a [`Pentadiagonal`] for a half width up to 2, a [`Banded`] above.
    ///
    /// # Errors
    ///
    /// Refuses what [`Pentadiagonal::new`] and [`Banded::new`] refuse.
    pub fn new(n: usize, half_width: usize, cyclic: bool) -> Result<Self, BandedError> {
        Ok(if half_width <= 2 {
            Pentadiagonal::new(n, cyclic)?.into()
        } else {
            Banded::new(n, half_width, cyclic)?.into()
        })
    }

    /// The number of rows.
    #[must_use]
    #[allow(
        clippy::len_without_is_empty,
        reason = "a matrix has at least two rows"
    )]
    pub fn len(&self) -> usize {
        either!(self, a => a.len())
    }

    /// The number of diagonals on either side of the main one.
    #[must_use]
    pub fn half_width(&self) -> usize {
        match self {
            Self::Narrow(_) => 2,
            Self::Wide(a) => a.half_width(),
        }
    }

    /// Whether the band wraps round.
    #[must_use]
    pub fn is_cyclic(&self) -> bool {
        either!(self, a => a.is_cyclic())
    }

    /// `A[i][i]`.
    #[must_use]
    pub fn diagonal(&self) -> &[f64] {
        either!(self, a => a.diagonal())
    }

    /// `A[i][i+k]` for `k` from 1 to the half width, wrapped when cyclic; 0 off the end when open.
    #[must_use]
    pub fn beside(&self, i: usize, k: usize) -> f64 {
        match self {
            Self::Narrow(a) if k == 1 => a.first()[i],
            Self::Narrow(a) => a.second()[i],
            Self::Wide(a) => a.beside(i)[k - 1],
        }
    }

    /// `A[i][j]`, 0 outside the band.
    #[must_use]
    pub fn entry(&self, i: usize, j: usize) -> f64 {
        either!(self, a => a.entry(i, j))
    }

    /// Adds a number to `A[i][j]` and to its mirror image. Outside the band: a bug, caught in debug builds.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        either!(self, a => a.add(i, j, value));
    }

    /// Adds `weight · r rᵀ`, with the non-zero elements of `r` given as (index, value).
    pub fn add_outer(&mut self, weight: f64, row: &[(usize, f64)]) {
        either!(self, a => a.add_outer(weight, row));
    }

    /// Adds one number a row to the diagonal.
    pub fn add_diagonal(&mut self, values: &[f64]) {
        either!(self, a => a.add_diagonal(values));
    }

    /// Adds a multiple of the identity.
    pub fn add_identity(&mut self, value: f64) {
        either!(self, a => a.add_identity(value));
    }

    /// Multiplies every entry.
    pub fn scale(&mut self, factor: f64) {
        either!(self, a => a.scale(factor));
    }

    /// Sets the rows and columns of held nodes to zero, the diagonal included.
    pub fn hold(&mut self, held: &[bool]) {
        either!(self, a => a.hold(held));
    }

    /// `out = A x`, both coordinates. O(n p), allocates nothing.
    pub fn multiply_into(&self, x: &[DVec2], out: &mut [DVec2]) {
        either!(self, a => a.multiply_into(x, out));
    }

    /// `out = A x` for one number a row. O(n p), allocates nothing.
    pub fn multiply_scalars_into(&self, x: &[f64], out: &mut [f64]) {
        either!(self, a => a.multiply_scalars_into(x, out));
    }

    /// `xᵀ A x`, the two coordinates summed. O(n p), allocates nothing.
    #[must_use]
    pub fn quadratic(&self, x: &[DVec2]) -> f64 {
        either!(self, a => a.quadratic(x))
    }

    /// The numbers of every row (diagonal, then beside) when all rows are the same: see
    /// [`Pentadiagonal::circulant`].
    #[must_use]
    pub fn circulant(&self) -> Option<Vec<f64>> {
        match self {
            Self::Narrow(a) => a.circulant().map(|row| row.to_vec()),
            Self::Wide(a) => a.circulant(),
        }
    }

    /// Whether `xᵀ A x > 0` for every `x` but zero, by the signs of the LDLᵀ pivots. O(n p²).
    #[must_use]
    pub fn is_positive_definite(&self) -> bool {
        either!(self, a => a.is_positive_definite())
    }

    /// Whether the matrix with diagonal `diagonal(A[i][i], i)` and off-diagonals `sign · A` is positive.
    pub(crate) fn is_positive(&self, diagonal: impl Fn(f64, usize) -> f64, sign: f64) -> bool {
        match self {
            Self::Narrow(a) => spectrum::is_positive(a, diagonal, sign),
            Self::Wide(a) => a.is_positive(diagonal, sign),
        }
    }

    /// Largest sum of magnitudes along a row: no eigenvalue is larger.
    #[must_use]
    pub fn norm(&self) -> f64 {
        either!(self, a => a.norm())
    }

    /// All n² entries.
    #[must_use]
    pub fn dense(&self) -> Dense {
        either!(self, a => a.dense())
    }

    /// Factors a positive definite band. O(n p²).
    ///
    /// # Errors
    ///
    /// Refuses what [`Factor::new`] and [`BandedFactor::new`] refuse.
    pub fn factor(&self) -> Result<BandFactor, BandedError> {
        Ok(match self {
            Self::Narrow(a) => BandFactor::Narrow(Factor::new(a)?),
            Self::Wide(a) => BandFactor::Wide(BandedFactor::new(a)?),
        })
    }

    /// Factors `diag(shift) + A` with one complex number a row. O(n p²).
    ///
    /// # Errors
    ///
    /// Refuses what [`ComplexFactor::new`] refuses.
    pub fn factor_shifted(&self, shift: &[Complex]) -> Result<ComplexBandFactor, BandedError> {
        Ok(match self {
            Self::Narrow(a) => ComplexBandFactor::Narrow(ComplexFactor::new(a, shift)?),
            Self::Wide(a) => ComplexBandFactor::Wide(ComplexBandedFactor::new(a, shift)?),
        })
    }
}

/// The factor of a [`Band`].
#[derive(Debug, Clone, PartialEq)]
#[allow(
    clippy::large_enum_variant,
    reason = "one a scheme, and the fast way is not to be one more pointer off"
)]
pub enum BandFactor {
    /// Of five diagonals.
    Narrow(Factor),
    /// Of any number of them.
    Wide(BandedFactor),
}

impl BandFactor {
    /// The number of rows.
    #[must_use]
    #[allow(
        clippy::len_without_is_empty,
        reason = "a matrix has at least two rows"
    )]
    pub fn len(&self) -> usize {
        either!(self, a => a.len())
    }

    /// Turns the right-hand side `b` into the solution, x and y in one sweep. O(n p), allocates nothing.
    pub fn solve(&self, b: &mut [DVec2]) {
        either!(self, a => a.solve(b));
    }

    /// Turns the right-hand side `b` into the solution, one number a row.
    pub fn solve_scalars(&self, b: &mut [f64]) {
        either!(self, a => a.solve_scalars(b));
    }
}

/// The factor of a [`Band`] with a complex diagonal added.
#[derive(Debug, Clone, PartialEq)]
#[allow(
    clippy::large_enum_variant,
    reason = "one a scheme, and the fast way is not to be one more pointer off"
)]
pub enum ComplexBandFactor {
    /// Of five diagonals.
    Narrow(ComplexFactor),
    /// Of any number of them.
    Wide(ComplexBandedFactor),
}

impl ComplexBandFactor {
    /// The number of rows.
    #[must_use]
    #[allow(
        clippy::len_without_is_empty,
        reason = "a matrix has at least two rows"
    )]
    pub fn len(&self) -> usize {
        either!(self, a => a.len())
    }

    /// Turns the right-hand side `b` into the solution, x and y in one sweep. O(n p), allocates nothing.
    pub fn solve(&self, b: &mut [ComplexPoint]) {
        either!(self, a => a.solve(b));
    }

    /// Turns the right-hand side `b` into the solution, one number a row.
    pub fn solve_scalars(&self, b: &mut [Complex]) {
        either!(self, a => a.solve_scalars(b));
    }
}
