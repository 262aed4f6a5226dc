//! A few dense columns on top of a band: product and inverse.

use crate::BandedError;
use crate::scalar::{Entry, Node};

/// The largest number of columns in a correction.
pub(crate) const MOST: usize = 4;

/// `U S Uᵀ`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LowRank {
    pub(crate) columns: Vec<Vec<f64>>,
    /// `S`, row by row.
    pub(crate) middle: Vec<f64>,
}

impl LowRank {
    pub(crate) fn entry(&self, i: usize, j: usize) -> f64 {
        let k = self.columns.len();
        let mut sum = 0.0;
        for p in 0..k {
            for q in 0..k {
                sum += self.columns[p][i] * self.middle[p * k + q] * self.columns[q][j];
            }
        }
        sum
    }

    /// `out += U S Uᵀ x`.
    pub(crate) fn add_product<V: Node<f64>>(&self, x: &[V], out: &mut [V]) {
        let mut along = [V::default(); MOST];
        for (along, column) in along.iter_mut().zip(&self.columns) {
            *along = dot(column, x);
        }
        for (column, along) in self.columns.iter().zip(weighted(&self.middle, along)) {
            for (out, &u) in out.iter_mut().zip(column) {
                *out = *out + along * u;
            }
        }
    }
}

/// `Σ u[i] x[i]`, in four sums that do not wait for each other.
fn dot<V: Node<f64>>(u: &[f64], x: &[V]) -> V {
    let (u, u_rest) = u.as_chunks::<4>();
    let (x, x_rest) = x.as_chunks::<4>();
    let mut sums = [V::default(); 4];
    for (u, x) in u.iter().zip(x) {
        for k in 0..4 {
            sums[k] = sums[k] + x[k] * u[k];
        }
    }
    let whole = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    x_rest
        .iter()
        .zip(u_rest)
        .fold(whole, |sum, (&x, &u)| sum + x * u)
}

/// A small square matrix, row by row, times a vector.
fn weighted<E: Copy, V: Node<E>>(middle: &[E], along: [V; MOST]) -> [V; MOST] {
    let mut sums = [V::default(); MOST];
    let k = middle.len().isqrt();
    for p in 0..k {
        for q in 0..k {
            sums[p] = sums[p] + along[q] * middle[p * k + q];
        }
    }
    sums
}

/// `(B + U S Uᵀ)⁻¹ = B⁻¹ − Z H Uᵀ B⁻¹` with `Z = B⁻¹ U` and `H = (I + S Uᵀ Z)⁻¹ S`.
///
/// Sherman, Morrison and Woodbury's formula, in the form that allows a singular `S`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Correction<E> {
    columns: Vec<Vec<f64>>,
    solved: Vec<Vec<E>>,
    /// `H`, row by row.
    middle: Vec<E>,
}

impl<E: Entry + Node<E> + Node<f64>> Correction<E> {
    /// From the columns and what solves with the band.
    pub(crate) fn new(low: &LowRank, solve: impl Fn(&mut [E])) -> Result<Self, BandedError> {
        let k = low.columns.len();
        let lift = |u: &Vec<f64>| u.iter().map(|&u| E::real(u)).collect::<Vec<E>>();
        let mut solved: Vec<Vec<E>> = low.columns.iter().map(lift).collect();
        solved.iter_mut().for_each(|column| solve(column));
        let middle: Vec<E> = low.middle.iter().map(|&s| E::real(s)).collect();
        let mut inner = [[E::ZERO; MOST]; MOST];
        for j in 0..k {
            let mut along = [E::ZERO; MOST];
            for (along, column) in along.iter_mut().zip(&low.columns) {
                *along = dot(column, &solved[j]);
            }
            for (i, product) in weighted(&middle, along).into_iter().enumerate() {
                inner[i][j] = if i == j { E::ONE + product } else { product };
            }
        }
        Ok(Self {
            columns: low.columns.clone(),
            solved,
            middle: divide(inner, middle, k)?,
        })
    }
}

impl<E: Copy> Correction<E> {
    /// Turns `B⁻¹ b` into the solution. O(n), allocates nothing.
    pub(crate) fn correct<V: Node<E> + Node<f64>>(&self, x: &mut [V]) {
        let mut along = [V::default(); MOST];
        for (along, column) in along.iter_mut().zip(&self.columns) {
            *along = dot(column, x);
        }
        let weights = weighted(&self.middle, along);
        if let ([p, q], [s, t, ..]) = (self.solved.as_slice(), weights) {
            for (x, (&p, &q)) in x.iter_mut().zip(p.iter().zip(q)) {
                *x = (*x - s * p) - t * q;
            }
            return;
        }
        for (column, along) in self.solved.iter().zip(weights) {
            for (x, &z) in x.iter_mut().zip(column) {
                *x = *x - along * z;
            }
        }
    }
}

/// `A⁻¹ B` of two k×k matrices, `B` row by row, by elimination with row exchanges.
fn divide<E: Entry>(
    mut a: [[E; MOST]; MOST],
    mut b: Vec<E>,
    k: usize,
) -> Result<Vec<E>, BandedError> {
    let largest = |row: &[E]| row.iter().fold(0.0_f64, |most, a| most.max(a.size()));
    let scale = a.iter().map(|row| largest(row)).fold(0.0, f64::max);
    for p in 0..k {
        let best = (p..k).fold(p, |best, i| {
            if a[i][p].size() > a[best][p].size() {
                i
            } else {
                best
            }
        });
        let size = a[best][p].size();
        // the identity is in it: a pivot this small against 1 and the rest is cancellation
        if size.is_nan() || size <= 32.0 * f64::EPSILON * scale {
            return Err(BandedError::SingularCorrection { column: p });
        }
        a.swap(p, best);
        (0..k).for_each(|j| b.swap(p * k + j, best * k + j));
        let pivot = a[p][p].inverse();
        for i in (0..k).filter(|&i| i != p) {
            let factor = a[i][p] * pivot;
            for j in p..k {
                a[i][j] = a[i][j] - factor * a[p][j];
            }
            for j in 0..k {
                b[i * k + j] = b[i * k + j] - factor * b[p * k + j];
            }
        }
        for j in 0..k {
            b[p * k + j] = b[p * k + j] * pivot;
        }
        for j in p + 1..k {
            a[p][j] = a[p][j] * pivot;
        }
    }
    Ok(b)
}
