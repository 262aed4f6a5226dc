//! The slow obvious twin: all n² entries, n³ operations.
//!
//! Every fast path of this crate is tested against it.

use std::ops::{Index, IndexMut};

use crate::BandedError;

/// A square matrix, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Dense {
    pub(crate) n: usize,
    pub(crate) entries: Vec<f64>,
}

impl Dense {
    /// The matrix with `entry(row, column)` everywhere.
    pub fn from_fn(n: usize, mut entry: impl FnMut(usize, usize) -> f64) -> Self {
        let mut entries = Vec::with_capacity(n * n);
        for i in 0..n {
            for j in 0..n {
                entries.push(entry(i, j));
            }
        }
        Self { n, entries }
    }

    /// The number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.n
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.n == 0
    }

    /// The rows, from the first.
    pub fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.entries.chunks_exact(self.n.max(1))
    }

    /// `A x`.
    #[must_use]
    pub fn multiply(&self, x: &[f64]) -> Vec<f64> {
        debug_assert_eq!(x.len(), self.n, "one element a column");
        self.rows()
            .map(|row| row.iter().zip(x).map(|(a, x)| a * x).sum())
            .collect()
    }

    /// The solution of `A x = b`, by elimination with row exchanges. O(n³).
    ///
    /// # Errors
    ///
    /// Refuses a `b` of another length, numbers that are not finite, and a matrix with no pivot
    /// left above rounding.
    pub fn solve(&self, b: &[f64]) -> Result<Vec<f64>, BandedError> {
        let n = self.n;
        if b.len() != n {
            return Err(BandedError::Length {
                name: "b",
                expected: n,
                got: b.len(),
            });
        }
        let mut a = self.clone();
        let mut x = b.to_vec();
        let scale = a.entries.iter().fold(0.0_f64, |most, a| most.max(a.abs()));
        for k in 0..n {
            let mut best = k;
            for i in k..n {
                if !a[(i, k)].is_finite() || !x[i].is_finite() {
                    return Err(BandedError::NotFinite { row: i });
                }
                if a[(i, k)].abs() > a[(best, k)].abs() {
                    best = i;
                }
            }
            let pivot = a[(best, k)];
            if pivot.abs() <= scale * f64::EPSILON {
                let reciprocal_condition = if scale > 0.0 {
                    pivot.abs() / scale
                } else {
                    0.0
                };
                return Err(BandedError::Singular {
                    row: k,
                    reciprocal_condition,
                });
            }
            x.swap(k, best);
            for j in 0..n {
                a.entries.swap(k * n + j, best * n + j);
            }
            for i in k + 1..n {
                let factor = a[(i, k)] / pivot;
                for j in k..n {
                    let above = a[(k, j)];
                    a[(i, j)] -= factor * above;
                }
                x[i] -= factor * x[k];
            }
        }
        for k in (0..n).rev() {
            let known: f64 = (k + 1..n).map(|j| a[(k, j)] * x[j]).sum();
            x[k] = (x[k] - known) / a[(k, k)];
        }
        Ok(x)
    }
}

impl Index<(usize, usize)> for Dense {
    type Output = f64;

    fn index(&self, (row, column): (usize, usize)) -> &f64 {
        &self.entries[row * self.n + column]
    }
}

impl IndexMut<(usize, usize)> for Dense {
    fn index_mut(&mut self, (row, column): (usize, usize)) -> &mut f64 {
        &mut self.entries[row * self.n + column]
    }
}
