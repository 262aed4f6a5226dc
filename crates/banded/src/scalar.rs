//! What an entry of a matrix and a node of a right-hand side can be.
//!
//! The elimination is written once, for real and for complex entries. A node of a right-hand side is
//! whatever can be subtracted and multiplied by an entry: a number or a point.

use std::ops::{Add, Mul, Neg, Sub};

use crate::BandedError;

/// An entry of a matrix.
pub(crate) trait Entry:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    const ZERO: Self;
    const ONE: Self;

    /// A real number as an entry.
    fn real(value: f64) -> Self;

    /// The magnitude.
    fn size(self) -> f64;

    /// One over it.
    fn inverse(self) -> Self;

    /// One over the pivot of a row, or why there is none.
    fn reciprocal(self, row: usize) -> Result<Self, BandedError>;
}

impl Entry for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;

    fn real(value: f64) -> Self {
        value
    }

    fn size(self) -> f64 {
        self.abs()
    }

    fn inverse(self) -> Self {
        1.0 / self
    }

    fn reciprocal(self, row: usize) -> Result<Self, BandedError> {
        if !self.is_finite() {
            Err(BandedError::NotFinite { row })
        } else if self <= 0.0 {
            Err(BandedError::NotPositive { row, pivot: self })
        } else {
            Ok(1.0 / self)
        }
    }
}

/// One node of a right-hand side of a matrix with entries `E`.
pub(crate) trait Node<E>:
    Copy + Default + Add<Output = Self> + Sub<Output = Self> + Mul<E, Output = Self>
{
}

impl<E, V> Node<E> for V where
    V: Copy + Default + Add<Output = Self> + Sub<Output = Self> + Mul<E, Output = Self>
{
}
