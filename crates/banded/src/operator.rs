//! A band and a few dense columns.
//!
//! What all nodes share (a body frame, a weight) couples every node with every other, but in few
//! ways: it is a sum of a few outer products. Adding it to a band keeps product and solve O(n).

use glam::DVec2;

use crate::lowrank::{Correction, LowRank, MOST};
use crate::{
    Band, BandFactor, Banded, BandedError, Complex, ComplexBandFactor, ComplexPoint, Dense,
    Pentadiagonal,
};

/// `A = B + U S Uᵀ`: a band `B`, and up to four dense columns `U` weighted by a small symmetric `S`.
#[derive(Debug, Clone, PartialEq)]
pub struct Operator {
    band: Band,
    low_rank: Option<LowRank>,
}

impl From<Band> for Operator {
    fn from(band: Band) -> Self {
        Self {
            band,
            low_rank: None,
        }
    }
}

impl From<Pentadiagonal> for Operator {
    fn from(band: Pentadiagonal) -> Self {
        Band::from(band).into()
    }
}

impl From<Banded> for Operator {
    fn from(band: Banded) -> Self {
        Band::from(band).into()
    }
}

impl Operator {
    /// A band with a correction: `columns` are those of `U`, `middle` is `S` row by row.
    ///
    /// # Errors
    ///
    /// Refuses more than four columns, columns of another length than the band, a `middle` that is
    /// not square or not symmetric, and numbers that are not finite.
    pub fn new(
        band: impl Into<Band>,
        columns: Vec<Vec<f64>>,
        middle: Vec<f64>,
    ) -> Result<Self, BandedError> {
        let band = band.into();
        let k = columns.len();
        if k > MOST {
            return Err(BandedError::TooManyColumns { most: MOST, got: k });
        }
        if middle.len() != k * k {
            return Err(BandedError::Length {
                name: "middle",
                expected: k * k,
                got: middle.len(),
            });
        }
        for column in &columns {
            if column.len() != band.len() {
                let (expected, got) = (band.len(), column.len());
                return Err(BandedError::Length {
                    name: "column",
                    expected,
                    got,
                });
            }
            if let Some(row) = column.iter().position(|u| !u.is_finite()) {
                return Err(BandedError::NotFinite { row });
            }
        }
        for row in 0..k {
            for column in 0..k {
                let (entry, mirror) = (middle[row * k + column], middle[column * k + row]);
                if !entry.is_finite() {
                    return Err(BandedError::NotFinite { row });
                }
                if entry.to_bits() != mirror.to_bits() {
                    return Err(BandedError::NotSymmetric { row, column });
                }
            }
        }
        Ok(Self {
            band,
            low_rank: (k > 0).then_some(LowRank { columns, middle }),
        })
    }

    /// The band `B`.
    #[must_use]
    pub fn band(&self) -> &Band {
        &self.band
    }

    /// The columns of `U`: none for a plain band.
    #[must_use]
    pub fn columns(&self) -> &[Vec<f64>] {
        self.low_rank.as_ref().map_or(&[], |low| &low.columns)
    }

    /// `U` and `S`, row by row, where there is a correction.
    pub(crate) fn correction(&self) -> Option<(&[Vec<f64>], &[f64])> {
        let low = self.low_rank.as_ref()?;
        Some((&low.columns, &low.middle))
    }

    /// The number of rows.
    #[must_use]
    #[allow(clippy::len_without_is_empty, reason = "a matrix has at least 3 rows")]
    pub fn len(&self) -> usize {
        self.band.len()
    }

    /// `out = A x`, both coordinates. O(n), allocates nothing.
    pub fn multiply_into(&self, x: &[DVec2], out: &mut [DVec2]) {
        self.band.multiply_into(x, out);
        if let Some(low) = &self.low_rank {
            low.add_product(x, out);
        }
    }

    /// `out = A x` for one number a row. O(n), allocates nothing.
    pub fn multiply_scalars_into(&self, x: &[f64], out: &mut [f64]) {
        self.band.multiply_scalars_into(x, out);
        if let Some(low) = &self.low_rank {
            low.add_product(x, out);
        }
    }

    /// `diag(diagonal) + scale · A`: what an implicit step solves with.
    #[must_use]
    pub fn shifted(&self, scale: f64, diagonal: &[f64]) -> Self {
        let mut shifted = self.clone();
        shifted.band.scale(scale);
        shifted.band.add_diagonal(diagonal);
        if let Some(low) = &mut shifted.low_rank {
            low.middle.iter_mut().for_each(|s| *s *= scale);
        }
        shifted
    }

    /// Factors the operator. O(n).
    ///
    /// The band is factored alone and corrected by Sherman, Morrison and Woodbury's formula, so it
    /// must be positive definite itself; digits are lost where its condition is much worse than that
    /// of the whole.
    ///
    /// # Errors
    ///
    /// Refuses what [`Band::factor`] refuses, and a correction that makes the whole singular.
    pub fn factor(&self) -> Result<OperatorFactor, BandedError> {
        let band = self.band.factor()?;
        let solve = |column: &mut [f64]| band.solve_scalars(column);
        let correction = self
            .low_rank
            .as_ref()
            .map(|low| Correction::new(low, solve));
        Ok(OperatorFactor {
            correction: correction.transpose()?,
            band,
        })
    }

    /// Factors `diag(shift) + A` with one complex number a row. O(n).
    ///
    /// # Errors
    ///
    /// Refuses what [`Band::factor_shifted`] refuses, and a correction that makes the whole singular.
    pub fn factor_shifted(&self, shift: &[Complex]) -> Result<ComplexOperatorFactor, BandedError> {
        let band = self.band.factor_shifted(shift)?;
        let solve = |column: &mut [Complex]| band.solve_scalars(column);
        let correction = self
            .low_rank
            .as_ref()
            .map(|low| Correction::new(low, solve));
        Ok(ComplexOperatorFactor {
            correction: correction.transpose()?,
            band,
        })
    }

    /// All n² entries.
    #[must_use]
    pub fn dense(&self) -> Dense {
        let low = |i: usize, j: usize| self.low_rank.as_ref().map_or(0.0, |low| low.entry(i, j));
        Dense::from_fn(self.len(), |i, j| self.band.entry(i, j) + low(i, j))
    }
}

/// The factor of an [`Operator`].
#[derive(Debug, Clone, PartialEq)]
pub struct OperatorFactor {
    band: BandFactor,
    correction: Option<Correction<f64>>,
}

impl OperatorFactor {
    /// The number of rows.
    #[must_use]
    #[allow(clippy::len_without_is_empty, reason = "a matrix has at least 3 rows")]
    pub fn len(&self) -> usize {
        self.band.len()
    }

    /// Turns the right-hand side `b` into the solution of `A x = b`, x and y in one sweep.
    ///
    /// O(n), allocates nothing.
    pub fn solve(&self, b: &mut [DVec2]) {
        self.band.solve(b);
        if let Some(correction) = &self.correction {
            correction.correct(b);
        }
    }

    /// Turns the right-hand side `b` into the solution, one number a row.
    pub fn solve_scalars(&self, b: &mut [f64]) {
        self.band.solve_scalars(b);
        if let Some(correction) = &self.correction {
            correction.correct(b);
        }
    }
}

/// The factor of an [`Operator`] with a complex diagonal added.
#[derive(Debug, Clone, PartialEq)]
pub struct ComplexOperatorFactor {
    band: ComplexBandFactor,
    correction: Option<Correction<Complex>>,
}

impl ComplexOperatorFactor {
    /// The number of rows.
    #[must_use]
    #[allow(clippy::len_without_is_empty, reason = "a matrix has at least 3 rows")]
    pub fn len(&self) -> usize {
        self.band.len()
    }

    /// Turns the right-hand side `b` into the solution, x and y in one sweep.
    ///
    /// O(n), allocates nothing.
    pub fn solve(&self, b: &mut [ComplexPoint]) {
        self.band.solve(b);
        if let Some(correction) = &self.correction {
            correction.correct(b);
        }
    }
}
