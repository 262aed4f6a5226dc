//! The band: entries, sums, product.
//!
//! A symmetric matrix with two diagonals beside the main one is three vectors of length n. Where the
//! band of an open matrix runs off its end, the vectors hold zero.

use std::ops::{Add, Mul};

use glam::DVec2;

use crate::{BandedError, Dense, spectrum};

/// A symmetric pentadiagonal matrix, open or cyclic.
///
/// ```text
/// A[i][i] = diagonal[i]    A[i][i+1] = A[i+1][i] = first[i]    A[i][i+2] = A[i+2][i] = second[i]
/// ```
///
/// Indices wrap round when cyclic; the tails of `first` and `second` are zero when open.
#[derive(Debug, Clone, PartialEq)]
pub struct Pentadiagonal {
    cyclic: bool,
    diagonal: Vec<f64>,
    first: Vec<f64>,
    second: Vec<f64>,
}

/// Where an entry is kept.
enum Slot {
    Diagonal(usize),
    First(usize),
    Second(usize),
}

impl Pentadiagonal {
    /// The zero matrix with `n` rows.
    ///
    /// # Errors
    ///
    /// Refuses fewer than 3 rows, and fewer than 5 when cyclic: there the band would meet itself.
    pub fn new(n: usize, cyclic: bool) -> Result<Self, BandedError> {
        let needed = if cyclic { 5 } else { 3 };
        if n < needed {
            return Err(BandedError::TooSmall { needed, got: n });
        }
        let zeros = vec![0.0; n];
        Ok(Self {
            cyclic,
            diagonal: zeros.clone(),
            first: zeros.clone(),
            second: zeros,
        })
    }

    /// The number of rows.
    #[must_use]
    #[allow(clippy::len_without_is_empty, reason = "a matrix has at least 3 rows")]
    pub fn len(&self) -> usize {
        self.diagonal.len()
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

    /// `A[i][i+1]`, wrapped when cyclic; the last is 0 when open.
    #[must_use]
    pub fn first(&self) -> &[f64] {
        &self.first
    }

    /// `A[i][i+2]`, wrapped when cyclic; the last two are 0 when open.
    #[must_use]
    pub fn second(&self) -> &[f64] {
        &self.second
    }

    /// `A[i][j]`, 0 outside the band.
    #[must_use]
    pub fn entry(&self, i: usize, j: usize) -> f64 {
        match self.slot(i, j) {
            Some(Slot::Diagonal(k)) => self.diagonal[k],
            Some(Slot::First(k)) => self.first[k],
            Some(Slot::Second(k)) => self.second[k],
            None => 0.0,
        }
    }

    fn slot(&self, i: usize, j: usize) -> Option<Slot> {
        let n = self.len();
        let (low, high) = (i.min(j), i.max(j));
        debug_assert!(
            high < n,
            "entry ({i}, {j}) lies outside a matrix of {n} rows"
        );
        match high - low {
            0 => Some(Slot::Diagonal(low)),
            1 => Some(Slot::First(low)),
            2 => Some(Slot::Second(low)),
            gap if self.cyclic && n - gap == 1 => Some(Slot::First(high)),
            gap if self.cyclic && n - gap == 2 => Some(Slot::Second(high)),
            _ => None,
        }
    }

    /// Adds a number to `A[i][j]` and to its mirror image.
    ///
    /// Entries outside the band stay 0: asking for one is a bug, caught in debug builds.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        match self.slot(i, j) {
            Some(Slot::Diagonal(k)) => self.diagonal[k] += value,
            Some(Slot::First(k)) => self.first[k] += value,
            Some(Slot::Second(k)) => self.second[k] += value,
            None => debug_assert!(false, "entry ({i}, {j}) lies outside the band"),
        }
    }

    /// Adds `weight · r rᵀ`, with the non-zero elements of `r` given as (index, value).
    ///
    /// One call adds the energy `½ weight (r·e)²` of one spring, whatever nodes it joins. All pairs
    /// of indices must lie within the band; indices may repeat and, when cyclic, wrap round it.
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
        for diagonal in [&mut self.diagonal, &mut self.first, &mut self.second] {
            for a in diagonal {
                *a *= factor;
            }
        }
    }

    /// Sets the rows and columns of held nodes to zero, the diagonal included.
    pub fn hold(&mut self, held: &[bool]) {
        let n = self.len();
        debug_assert_eq!(held.len(), n, "one mark a row");
        for i in 0..n {
            if held[i] {
                self.diagonal[i] = 0.0;
            }
            if held[i] || held[(i + 1) % n] {
                self.first[i] = 0.0;
            }
            if held[i] || held[(i + 2) % n] {
                self.second[i] = 0.0;
            }
        }
    }

    /// `out = A x`, both coordinates. O(n), allocates nothing.
    pub fn multiply_into(&self, x: &[DVec2], out: &mut [DVec2]) {
        self.product(x, out);
    }

    /// `out = A x` for one number a row. O(n), allocates nothing.
    pub fn multiply_scalars_into(&self, x: &[f64], out: &mut [f64]) {
        self.product(x, out);
    }

    fn product<V>(&self, x: &[V], out: &mut [V])
    where
        V: Copy + Add<Output = V> + Mul<f64, Output = V>,
    {
        let n = self.len();
        debug_assert!(x.len() == n && out.len() == n, "one element a row");
        let row = |i: usize| {
            let (back, back2) = ((i + n - 1) % n, (i + n - 2) % n);
            let (next, next2) = ((i + 1) % n, (i + 2) % n);
            x[i] * self.diagonal[i]
                + (x[back] * self.first[back] + x[next] * self.first[i])
                + (x[back2] * self.second[back2] + x[next2] * self.second[i])
        };
        for i in [0, 1, n - 2, n - 1] {
            out[i] = row(i);
        }
        let inner = out[2..].iter_mut().zip(x.windows(5));
        let diagonals = self.diagonal[2..].iter().zip(self.first[1..].windows(2));
        for (((out, x), (d, f)), s) in inner.zip(diagonals).zip(self.second.windows(3)) {
            *out = x[2] * *d + (x[1] * f[0] + x[3] * f[1]) + (x[0] * s[0] + x[4] * s[2]);
        }
    }

    /// `xᵀ A x`, the two coordinates summed. O(n), allocates nothing.
    ///
    /// Twice the energy of a spring system with this stiffness.
    #[must_use]
    pub fn quadratic(&self, x: &[DVec2]) -> f64 {
        let n = self.len();
        debug_assert_eq!(x.len(), n, "one element a row");
        let mut sum = 0.0;
        for i in 0..n {
            sum += self.diagonal[i] * x[i].length_squared();
            sum += 2.0 * self.first[i] * x[i].dot(x[(i + 1) % n]);
            sum += 2.0 * self.second[i] * x[i].dot(x[(i + 2) % n]);
        }
        sum
    }

    /// The three numbers of every row (diagonal, first, second) when all rows are the same.
    ///
    /// Sums of the same springs in another order differ by rounding, so rows count as the same
    /// within four units in the last place of the row sum; the numbers are those of a row in the
    /// middle. `None` when open, or when rows differ by more.
    #[must_use]
    pub fn circulant(&self) -> Option<[f64; 3]> {
        let middle = self.len() / 2;
        let row = [
            self.diagonal[middle],
            self.first[middle],
            self.second[middle],
        ];
        let size = row[0].abs() + 2.0 * (row[1].abs() + row[2].abs());
        let same = |entries: &[f64], typical: f64| {
            entries
                .iter()
                .all(|a| (a - typical).abs() <= 4.0 * f64::EPSILON * size)
        };
        (self.cyclic
            && same(&self.diagonal, row[0])
            && same(&self.first, row[1])
            && same(&self.second, row[2]))
        .then_some(row)
    }

    /// Whether `xᵀ A x > 0` for every `x` but zero, by the signs of the LDLᵀ pivots. O(n).
    ///
    /// Right up to rounding: the answer is exact for a matrix that differs from this one by a few
    /// units in the last place of each entry.
    #[must_use]
    pub fn is_positive_definite(&self) -> bool {
        spectrum::is_positive(self, |d, _| d, 1.0)
    }

    /// Largest sum of magnitudes along a row: no eigenvalue is larger.
    #[must_use]
    pub fn norm(&self) -> f64 {
        let n = self.len();
        let row = |i: usize| {
            self.diagonal[i].abs()
                + (self.first[i].abs() + self.first[(i + n - 1) % n].abs())
                + (self.second[i].abs() + self.second[(i + n - 2) % n].abs())
        };
        // NaN goes through
        (0..n)
            .map(row)
            .fold(0.0, |most, size| if size <= most { most } else { size })
    }

    /// All n² entries.
    #[must_use]
    pub fn dense(&self) -> Dense {
        Dense::from_fn(self.len(), |i, j| self.entry(i, j))
    }
}
