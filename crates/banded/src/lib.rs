//! Narrow symmetric systems: product, factor, solve.
//!
//! A node of a curve feels its two neighbours on either side and nothing else, so every matrix here
//! has five diagonals: the diagonal itself, one beside it and one beside that, the lower two being
//! the mirror of the upper two. On a closed curve the band wraps round, and the last nodes meet the
//! first:
//!
//! ```text
//! open                     cyclic
//! d f s . . .              d f s . s f
//! f d f s . .              f d f s . s
//! s f d f s .              s f d f s .
//! . s f d f s              . s f d f s
//! . . s f d f              s . s f d f
//! . . . s f d              f s . s f d
//! ```
//!
//! [`Pentadiagonal`] holds such a matrix as three vectors, [`Factor`] is its LDLᵀ, computed once
//! and solved many times, x and y in one sweep. [`Banded`] has any number of diagonals, for curves whose energy has
//! derivatives above the second, and [`Band`] is whichever of the two is wanted. [`Operator`] adds a few dense columns to
//! the band (a body frame, a weight that all nodes share). [`Dense`] is the slow obvious twin every test
//! compares with.
//!
//! Product, factor and solve are O(n); product and solve allocate nothing. Nothing here knows that
//! there is a curve.

mod band;
mod chain;
mod circulant;
mod complex;
mod dense;
mod diagonal;
mod eigen;
mod error;
mod factor;
mod lowrank;
mod matrix;
mod operator;
mod scalar;
mod slice;
mod spectrum;
mod twisted;
mod weakest;
mod wide;
mod wide_factor;

pub use band::{Band, BandFactor, ComplexBandFactor};
pub use circulant::Circulant;
pub use complex::{Complex, ComplexFactor, ComplexPoint};
pub use dense::Dense;
pub use eigen::Eigen;
pub use error::BandedError;
pub use factor::Factor;
pub use matrix::Pentadiagonal;
pub use operator::{ComplexOperatorFactor, Operator, OperatorFactor};
pub use slice::Slices;
pub use spectrum::{largest_eigenvalue, smallest_eigenvalue};
pub use wide::Banded;
pub use wide_factor::{BandedFactor, ComplexBandedFactor};

#[cfg(test)]
mod tests;
