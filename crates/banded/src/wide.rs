//! Bands of any width.
//!
//! The half width p is the number of diagonals on either side of the main one: 1 for a string, 3 for a curve that
//! resists a change of bending, 4 for two coordinates of a curve that feel each other (x and y alternating). For p = 2 take
//! [`Pentadiagonal`](crate::Pentadiagonal), whose solve is faster.
//!
//! The width is a number in the value, not a part of the type. Loops over it are compiled once for each width and
//! chosen before the loop over the rows.

use std::ops::{Add, Mul};

use glam::DVec2;

use crate::wide_factor::Ldl;
use crate::{BandedError, Dense};

/// Calls with the half width as a constant `P`, so that loops over it are unrolled.
macro_rules! unrolled {
    ($width:expr, $P:ident => $call:expr) => {
        $crate::wide::unrolled!(@ $width, $P, $call, 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15)
    };
    (@ $width:expr, $P:ident, $call:expr, $($p:literal)*) => {
        match $width {
            $($p => {
                const $P: usize = $p;
                $call
            })*
            _ => {
                const $P: usize = $crate::Banded::WIDEST;
                $call
            }
        }
    };
}
pub(crate) use unrolled;

/// A symmetric band matrix with p diagonals on either side, open or cyclic.
///
/// ```text
/// A[i][i] = diagonal[i]     A[i][i+k] = A[i+k][i] = beside[i][k−1],  k = 1 … p
/// ```
///
/// Indices wrap round when cyclic; what runs off the end is zero when open.
#[derive(Debug, Clone, PartialEq)]
pub struct Banded {
    cyclic: bool,
    half_width: usize,
    diagonal: Vec<f64>,
    /// Row after row, p numbers each.
    beside: Vec<f64>,
}

impl Banded {
    /// The largest half width: x and y in turn of a curve of order 6, seen from a frame that turns.
    pub const WIDEST: usize = 16;

    /// The zero matrix with `n` rows and `half_width` diagonals on either side.
    ///
    /// # Errors
    ///
    /// Refuses a half width of 0 or above [`WIDEST`](Self::WIDEST), fewer than `half_width + 1` rows, and fewer than
    /// `2 half_width + 1` when cyclic.
    pub fn new(n: usize, half_width: usize, cyclic: bool) -> Result<Self, BandedError> {
        if half_width == 0 || half_width > Self::WIDEST {
            return Err(BandedError::HalfWidth {
                most: Self::WIDEST,
                got: half_width,
            });
        }
        let needed = if cyclic {
            2 * half_width + 1
        } else {
            half_width + 1
        };
        if n < needed {
            return Err(BandedError::TooSmall { needed, got: n });
        }
        Ok(Self {
            cyclic,
            half_width,
            diagonal: vec![0.0; n],
            beside: vec![0.0; n * half_width],
        })
    }

    /// The number of rows.
    #[must_use]
    #[allow(
        clippy::len_without_is_empty,
        reason = "a matrix has at least two rows"
    )]
    pub fn len(&self) -> usize {
        self.diagonal.len()
    }

    /// The number of diagonals on either side.
    #[must_use]
    pub fn half_width(&self) -> usize {
        self.half_width
    }

    /// Whether the band wraps round.
    #[must_use]
    pub fn is_cyclic(&self) -> bool {
        self.cyclic
    }

    /// `A[i][i]`.
    #[must_use]
    pub fn diagonal(&self) -> &[f64] {
        &self.diagonal
    }

    /// `A[i][i+1] … A[i][i+p]`, wrapped when cyclic; what runs off the end is 0 when open.
    #[must_use]
    pub fn beside(&self, i: usize) -> &[f64] {
        &self.beside[i * self.half_width..][..self.half_width]
    }

    /// The rows of `beside`, for a width known when this is compiled.
    pub(crate) fn rows<const P: usize>(&self) -> &[[f64; P]] {
        debug_assert_eq!(P, self.half_width, "the constant is the width");
        self.beside.as_chunks().0
    }

    /// `A[i][j]`, 0 outside the band.
    #[must_use]
    pub fn entry(&self, i: usize, j: usize) -> f64 {
        if i == j {
            return self.diagonal[i];
        }
        self.slot(i, j).map_or(0.0, |at| self.beside[at])
    }

    /// Where `A[i][j]` is kept, for different `i` and `j`.
    fn slot(&self, i: usize, j: usize) -> Option<usize> {
        let p = self.half_width;
        let (low, high) = (i.min(j), i.max(j));
        let gap = high - low;
        if gap <= p {
            Some(low * p + gap - 1)
        } else if self.cyclic && self.len() - gap <= p {
            Some(high * p + self.len() - gap - 1)
        } else {
            None
        }
    }

    /// Adds a number to `A[i][j]` and to its mirror image.
    ///
    /// Entries outside the band stay 0: asking for one is a bug, caught in debug builds.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        if i == j {
            self.diagonal[i] += value;
        } else if let Some(at) = self.slot(i, j) {
            self.beside[at] += value;
        } else {
            debug_assert!(false, "entry ({i}, {j}) lies outside the band");
        }
    }

    /// Sets a row's own element, and the p beside it on the right (wrapped round when cyclic; when open, what
    /// runs off the end must be 0).
    pub fn set_row(&mut self, i: usize, diagonal: f64, beside: &[f64]) {
        debug_assert!(
            self.cyclic || beside.iter().skip(self.len() - 1 - i).all(|a| *a == 0.0),
            "nothing runs off the end"
        );
        self.diagonal[i] = diagonal;
        self.beside[i * self.half_width..][..self.half_width].copy_from_slice(beside);
    }

    /// Adds `weight · r rᵀ`, with the non-zero elements of `r` given as (index, value).
    pub fn add_outer(&mut self, weight: f64, row: &[(usize, f64)]) {
        for (k, &(i, left)) in row.iter().enumerate() {
            self.add(i, i, weight * left * left);
            for &(j, right) in &row[k + 1..] {
                let product = weight * left * right;
                self.add(i, j, if i == j { 2.0 * product } else { product });
            }
        }
    }

    /// Adds one number a row to the diagonal.
    pub fn add_diagonal(&mut self, values: &[f64]) {
        debug_assert_eq!(values.len(), self.len(), "one number a row");
        for (a, value) in self.diagonal.iter_mut().zip(values) {
            *a += value;
        }
    }

    /// Adds a multiple of the identity.
    pub fn add_identity(&mut self, value: f64) {
        for a in &mut self.diagonal {
            *a += value;
        }
    }

    /// Multiplies every entry.
    pub fn scale(&mut self, factor: f64) {
        for a in self.diagonal.iter_mut().chain(&mut self.beside) {
            *a *= factor;
        }
    }

    /// Sets the rows and columns of held nodes to zero, the diagonal included.
    pub fn hold(&mut self, held: &[bool]) {
        let n = self.len();
        debug_assert_eq!(held.len(), n, "one mark a row");
        for (i, row) in self.beside.chunks_exact_mut(self.half_width).enumerate() {
            if held[i] {
                self.diagonal[i] = 0.0;
                row.fill(0.0);
            }
            for (k, a) in row.iter_mut().enumerate() {
                if held[(i + 1 + k) % n] {
                    *a = 0.0;
                }
            }
        }
    }

    /// `out = A x`, both coordinates. O(n p), allocates nothing.
    pub fn multiply_into(&self, x: &[DVec2], out: &mut [DVec2]) {
        unrolled!(self.half_width, P => self.product::<P, _>(x, out));
    }

    /// `out = A x` for one number a row. O(n p), allocates nothing.
    pub fn multiply_scalars_into(&self, x: &[f64], out: &mut [f64]) {
        unrolled!(self.half_width, P => self.product::<P, _>(x, out));
    }

    fn product<const P: usize, V>(&self, x: &[V], out: &mut [V])
    where
        V: Copy + Add<Output = V> + Mul<f64, Output = V>,
    {
        let n = self.len();
        debug_assert!(x.len() == n && out.len() == n, "one element a row");
        let rows = self.rows::<P>();
        let edge = P.min(n - P);
        for i in (0..edge).chain(n - P..n) {
            let mut sum = x[i] * self.diagonal[i];
            for k in 1..=P {
                let (back, next) = ((i + n - k) % n, (i + k) % n);
                sum = sum + (x[back] * rows[back][k - 1] + x[next] * rows[i][k - 1]);
            }
            out[i] = sum;
        }
        for i in P..n - P {
            let (x, rows) = (&x[i - P..=i + P], &rows[i - P..=i]);
            let mut sum = x[P] * self.diagonal[i];
            for k in 1..=P {
                sum = sum + (x[P - k] * rows[P - k][k - 1] + x[P + k] * rows[P][k - 1]);
            }
            out[i] = sum;
        }
    }

    /// Row `i` times `x`, and the sum of the row's magnitudes.
    pub(crate) fn row(&self, i: usize, x: &[f64]) -> (f64, f64) {
        let n = self.len();
        let (mut sum, mut size) = (self.diagonal[i] * x[i], self.diagonal[i].abs());
        for k in 1..=self.half_width {
            let (back, next) = ((i + n - k) % n, (i + k) % n);
            let (before, after) = (self.beside(back)[k - 1], self.beside(i)[k - 1]);
            sum += before * x[back] + after * x[next];
            size += before.abs() + after.abs();
        }
        (sum, size)
    }

    /// `xᵀ A x`, the two coordinates summed. O(n p), allocates nothing.
    #[must_use]
    pub fn quadratic(&self, x: &[DVec2]) -> f64 {
        let n = self.len();
        debug_assert_eq!(x.len(), n, "one element a row");
        let mut sum = 0.0;
        for i in 0..n {
            sum += self.diagonal[i] * x[i].length_squared();
            for (k, a) in self.beside(i).iter().enumerate() {
                sum += 2.0 * a * x[i].dot(x[(i + 1 + k) % n]);
            }
        }
        sum
    }

    /// Largest sum of magnitudes along a row: no eigenvalue is larger.
    #[must_use]
    pub fn norm(&self) -> f64 {
        let zeros = vec![0.0; self.len()];
        // NaN goes through
        (0..self.len())
            .map(|i| self.row(i, &zeros).1)
            .fold(0.0, |most, size| if size <= most { most } else { size })
    }

    /// The numbers of every row (diagonal, then beside) when all rows are the same to four units in the last place of
    /// the row sum; those of a row in the middle. `None` when open, or when rows differ by more.
    #[must_use]
    pub fn circulant(&self) -> Option<Vec<f64>> {
        let middle = self.len() / 2;
        let (diagonal, beside) = (self.diagonal[middle], self.beside(middle));
        let size = diagonal.abs() + 2.0 * beside.iter().map(|a| a.abs()).sum::<f64>();
        let same = |a: f64, typical: f64| (a - typical).abs() <= 4.0 * f64::EPSILON * size;
        let even = self.diagonal.iter().all(|&a| same(a, diagonal))
            && (0..self.len())
                .all(|i| self.beside(i).iter().zip(beside).all(|(&a, &b)| same(a, b)));
        (self.cyclic && even).then(|| [&[diagonal], beside].concat())
    }

    /// Whether `xᵀ A x > 0` for every `x` but zero, by the signs of the LDLᵀ pivots. O(n p²).
    #[must_use]
    pub fn is_positive_definite(&self) -> bool {
        self.is_positive(|d, _| d, 1.0)
    }

    /// Whether the matrix with diagonal `diagonal(A[i][i], i)` and off-diagonals `sign · A` is positive.
    pub(crate) fn is_positive(&self, diagonal: impl Fn(f64, usize) -> f64, sign: f64) -> bool {
        let mut factor = Ldl::<f64>::empty(self.half_width);
        factor.eliminate(self, diagonal, sign).is_ok()
    }

    /// All n² entries.
    #[must_use]
    pub fn dense(&self) -> Dense {
        Dense::from_fn(self.len(), |i, j| self.entry(i, j))
    }
}
