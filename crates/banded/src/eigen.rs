//! The whole eigenbasis of a symmetric matrix.
//!
//! Narrow matrices have no short cut to all their eigenvectors that keeps them orthogonal, so the
//! matrix is taken as dense. For cyclic matrices with equal rows there is one:
//! [`Circulant`](crate::Circulant).

use crate::{BandedError, Dense};

/// Eigenvalues in ascending order, and the eigenvector of each: orthonormal.
#[derive(Debug, Clone, PartialEq)]
pub struct Eigen {
    /// λ₀ ≤ λ₁ ≤ …
    pub values: Vec<f64>,
    /// `vectors[k]` belongs to `values[k]`; unit length.
    pub vectors: Vec<Vec<f64>>,
}

impl Eigen {
    /// From values in any order, and the rows that belong to them.
    fn sorted(values: &[f64], rows: &Dense) -> Self {
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|&i, &j| values[i].total_cmp(&values[j]));
        let n = rows.n;
        Self {
            values: order.iter().map(|&i| values[i]).collect(),
            vectors: order
                .iter()
                .map(|&i| rows.entries[i * n..(i + 1) * n].to_vec())
                .collect(),
        }
    }
}

impl Dense {
    /// All eigenvalues and eigenvectors, by Householder's reflections and the QL iteration. O(n³).
    ///
    /// Each value is right to some units in the last place of the largest; vectors are orthonormal
    /// to rounding, even where values coincide (`[golub13]`, 8.3).
    ///
    /// # Errors
    ///
    /// Refuses a matrix that differs from its transpose by more than rounding, and numbers that are
    /// not finite.
    pub fn eigen(&self) -> Result<Eigen, BandedError> {
        self.check_symmetric()?;
        let Tridiagonal {
            mut diagonal,
            mut beside,
            mut basis,
        } = Tridiagonal::new(self.clone());
        if !diagonalise(&mut diagonal, &mut beside, &mut basis) {
            return self.eigen_by_rotations();
        }
        Ok(Eigen::sorted(&diagonal, &basis))
    }

    /// The same by Jacobi's rotations: the slow twin, about twenty times as long.
    ///
    /// # Errors
    ///
    /// As [`eigen`](Self::eigen).
    pub fn eigen_by_rotations(&self) -> Result<Eigen, BandedError> {
        let n = self.n;
        let scale = self.check_symmetric()?;
        let mut a = self.clone();
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
        let values: Vec<f64> = (0..n).map(|i| a[(i, i)]).collect();
        Ok(Eigen::sorted(&values, &v))
    }

    /// The largest magnitude of a symmetric matrix.
    fn check_symmetric(&self) -> Result<f64, BandedError> {
        let n = self.n;
        let scale = self
            .entries
            .iter()
            .fold(0.0_f64, |most, a| most.max(a.abs()));
        for row in 0..n {
            for column in 0..n {
                if !self[(row, column)].is_finite() {
                    return Err(BandedError::NotFinite { row });
                }
                if (self[(row, column)] - self[(column, row)]).abs() > 1e-12 * scale {
                    return Err(BandedError::NotSymmetric { row, column });
                }
            }
        }
        Ok(scale)
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

/// `A = Qᵀ T Q` with `T` tridiagonal; `Q` is the basis, row by row.
struct Tridiagonal {
    diagonal: Vec<f64>,
    /// `T[i][i+1]`; the last is 0.
    beside: Vec<f64>,
    basis: Dense,
}

impl Tridiagonal {
    /// By one reflection a column, each applied from both sides.
    fn new(mut a: Dense) -> Self {
        let n = a.n;
        let mut basis = Dense::from_fn(n, |i, j| if i == j { 1.0 } else { 0.0 });
        let mut beside = vec![0.0; n];
        for k in 0..n.saturating_sub(1) {
            // v turns the rest of the column onto its first element; the others become zero
            let mut v: Vec<f64> = (k + 1..n).map(|i| a[(i, k)]).collect();
            let size = v.iter().fold(0.0_f64, |norm, v| norm.hypot(*v));
            beside[k] = -size.copysign(v[0]);
            if v[1..].iter().all(|v| v.abs() <= 0.0) {
                beside[k] = v[0];
                continue;
            }
            v[0] -= beside[k];
            let scale = v.iter().map(|v| v * v).sum::<f64>().sqrt();
            v.iter_mut().for_each(|v| *v /= scale);

            let m = v.len();
            let mut p = vec![0.0; m];
            for i in 0..m {
                let row = &a.entries[(k + 1 + i) * n + k + 1..(k + 2 + i) * n];
                p[i] = 2.0 * dot(row, &v);
            }
            let along = dot(&p, &v);
            p.iter_mut().zip(&v).for_each(|(p, v)| *p -= along * v);
            let mut s = vec![0.0; n];
            for i in 0..m {
                let row = &mut a.entries[(k + 1 + i) * n + k + 1..(k + 2 + i) * n];
                for ((a, v_j), p_j) in row.iter_mut().zip(&v).zip(&p) {
                    *a -= v[i] * p_j + p[i] * v_j;
                }
                let row = &basis.entries[(k + 1 + i) * n..(k + 2 + i) * n];
                s.iter_mut()
                    .zip(row)
                    .for_each(|(s, q)| *s += 2.0 * v[i] * q);
            }
            for i in 0..m {
                let row = &mut basis.entries[(k + 1 + i) * n..(k + 2 + i) * n];
                row.iter_mut().zip(&s).for_each(|(q, s)| *q -= v[i] * s);
            }
        }
        Self {
            diagonal: (0..n).map(|i| a[(i, i)]).collect(),
            beside,
            basis,
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The QL iteration with Wilkinson's shift: the diagonal becomes the eigenvalues, the rows of the
/// basis the eigenvectors. False if a value takes more than 60 rounds.
fn diagonalise(d: &mut [f64], e: &mut [f64], basis: &mut Dense) -> bool {
    let n = d.len();
    for l in 0..n {
        for round in 0.. {
            let split = |m: &usize| e[*m].abs() <= f64::EPSILON * (d[*m].abs() + d[*m + 1].abs());
            let m = (l..n - 1).find(split).unwrap_or(n - 1);
            if m == l {
                break;
            }
            if round == 60 {
                return false;
            }
            let half = (d[l + 1] - d[l]) / (2.0 * e[l]);
            let mut g = d[m] - d[l] + e[l] / (half + half.hypot(1.0).copysign(half));
            let (mut s, mut c, mut p) = (1.0, 1.0, 0.0);
            let mut whole = true;
            for i in (l..m).rev() {
                let (f, b) = (s * e[i], c * e[i]);
                let r = f.hypot(g);
                e[i + 1] = r;
                if r <= 0.0 {
                    // the block falls apart here: look again
                    d[i + 1] -= p;
                    e[m] = 0.0;
                    whole = false;
                    break;
                }
                (s, c) = (f / r, g / r);
                g = d[i + 1] - p;
                let turned = (d[i] - g) * s + 2.0 * c * b;
                p = s * turned;
                d[i + 1] = g + p;
                g = c * turned - b;
                let (upper, lower) = basis.entries[i * n..(i + 2) * n].split_at_mut(n);
                for (z, w) in upper.iter_mut().zip(lower) {
                    (*z, *w) = (c * *z - s * *w, s * *z + c * *w);
                }
            }
            if whole {
                d[l] -= p;
                e[l] = g;
                e[m] = 0.0;
            }
        }
    }
    true
}
