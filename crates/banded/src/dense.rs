//! The slow obvious twin: all n² entries, n³ operations.
//!
//! Every fast path of this crate is tested against it. It is also what finds a whole eigenbasis,
//! for which narrow matrices have no short cut that keeps the vectors orthogonal.

use std::ops::{Index, IndexMut};

use crate::BandedError;

/// A square matrix, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Dense {
    n: usize,
    entries: Vec<f64>,
}

/// Eigenvalues in ascending order, and the eigenvector of each: orthonormal.
#[derive(Debug, Clone, PartialEq)]
pub struct Eigen {
    /// λ₀ ≤ λ₁ ≤ …
    pub values: Vec<f64>,
    /// `vectors[k]` belongs to `values[k]`; unit length.
    pub vectors: Vec<Vec<f64>>,
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

    /// All eigenvalues and eigenvectors, by Jacobi's rotations. O(n³) a sweep, about ten sweeps.
    ///
    /// Only the symmetric part is looked at: the upper triangle is taken for the lower as well.
    /// Each value is right to some units in the last place of the largest.
    ///
    /// # Errors
    ///
    /// Refuses a matrix that differs from its transpose by more than rounding, and numbers that are
    /// not finite.
    pub fn eigen(&self) -> Result<Eigen, BandedError> {
        let n = self.n;
        let mut a = self.clone();
        let scale = a.entries.iter().fold(0.0_f64, |most, a| most.max(a.abs()));
        for row in 0..n {
            for column in 0..n {
                if !a[(row, column)].is_finite() {
                    return Err(BandedError::NotFinite { row });
                }
                if (a[(row, column)] - a[(column, row)]).abs() > 1e-12 * scale {
                    return Err(BandedError::NotSymmetric { row, column });
                }
            }
        }
        // rows of `v` turn into the eigenvectors
        let mut v = Self::from_fn(n, |i, j| if i == j { 1.0 } else { 0.0 });
        for _sweep in 0..64 {
            let mut rotated = false;
            for p in 0..n {
                for q in p + 1..n {
                    rotated |= a.rotate(&mut v, p, q, scale);
                }
            }
            if !rotated {
                break;
            }
        }
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|&i, &j| a[(i, i)].total_cmp(&a[(j, j)]));
        Ok(Eigen {
            values: order.iter().map(|&i| a[(i, i)]).collect(),
            vectors: order
                .iter()
                .map(|&i| v.entries[i * n..(i + 1) * n].to_vec())
                .collect(),
        })
    }

    /// One rotation that makes `A[p][q]` zero; false when it already is, to rounding.
    fn rotate(&mut self, v: &mut Self, p: usize, q: usize, scale: f64) -> bool {
        let n = self.n;
        let off = self[(p, q)];
        let (app, aqq) = (self[(p, p)], self[(q, q)]);
        let small = f64::EPSILON * (app * aqq).abs().sqrt().max(1e-4 * f64::EPSILON * scale);
        if off.abs() <= small {
            return false;
        }
        let theta = (aqq - app) / (2.0 * off);
        let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
        let c = 1.0 / (t * t + 1.0).sqrt();
        let s = t * c;
        let turn = |x: f64, y: f64| (c * x - s * y, s * x + c * y);
        for k in 0..n {
            if k != p && k != q {
                let (kp, kq) = turn(self[(k, p)], self[(k, q)]);
                (self[(k, p)], self[(p, k)]) = (kp, kp);
                (self[(k, q)], self[(q, k)]) = (kq, kq);
            }
            let (vp, vq) = turn(v[(p, k)], v[(q, k)]);
            (v[(p, k)], v[(q, k)]) = (vp, vq);
        }
        (self[(p, p)], self[(q, q)]) = (app - t * off, aqq + t * off);
        (self[(p, q)], self[(q, p)]) = (0.0, 0.0);
        true
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
