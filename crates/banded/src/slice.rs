//! Any single eigenvalue of a band with a few dense columns, by counting how many lie below a number.
//!
//! `A − λ W = L D Lᵀ` has as many negative pivots as `A u = λ W u` has eigenvalues below λ (Sylvester's law of
//! inertia), so bisection on the count finds the k-th without the others (`[parlett98]`, 3.3 and 7.2). The rows that
//! wrap round a cyclic band and the dense columns `U S Uᵀ` are a border of the matrix:
//!
//! ```text
//! ⎡ B − λW   U   ⎤
//! ⎣   Uᵀ   −S⁻¹  ⎦     has the negative pivots of A − λW and those of −S⁻¹
//! ```

use crate::{Band, Dense, Operator};

/// An eigenvalue below this share of the largest is rounding.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Relative width of the interval at which bisection ends.
const NARROW: f64 = 1e-12;

/// The spectrum of `A u = λ diag(w) u` for an [`Operator`] `A`, which is asked for single eigenvalues.
///
/// Elimination keeps the order of the rows. Eigenvalues are right to some 1e-16 of the largest.
#[derive(Debug, Clone)]
pub struct Slices<'a> {
    band: &'a Band,
    weights: &'a [f64],
    /// `U V`, with `S = V diag(middle) Vᵀ`, where `middle` is not 0.
    columns: Vec<Vec<f64>>,
    middle: Vec<f64>,
    radius: f64,
}

/// `A − λ W = L D Lᵀ` with the border as a last, dense block.
struct Factored {
    /// Rows before the border.
    rows: usize,
    width: usize,
    border: usize,
    /// Pivot and the entries right of it, row by row.
    upper: Vec<f64>,
    /// The entries in the columns of the border, row by row.
    side: Vec<f64>,
    corner: Dense,
    negative: usize,
}

impl<'a> Slices<'a> {
    /// The spectrum for weights above 0, one a row. None for other weights and for numbers that are not finite.
    #[must_use]
    pub fn new(a: &'a Operator, weights: &'a [f64]) -> Option<Self> {
        let (n, band) = (a.len(), a.band());
        if weights.len() != n || !weights.iter().all(|w| *w > 0.0 && w.is_finite()) {
            return None;
        }
        let (mut columns, mut middle) = (Vec::new(), Vec::new());
        if let Some((u, s)) = a.correction() {
            let k = u.len();
            let eigen = Dense::from_fn(k, |i, j| s[i * k + j]).eigen().ok()?;
            for (value, vector) in eigen.values.iter().zip(&eigen.vectors) {
                if value.abs() > 0.0 {
                    let along = |i: usize| u.iter().zip(vector).map(|(u, v)| u[i] * v).sum();
                    columns.push((0..n).map(along).collect());
                    middle.push(*value);
                }
            }
        }
        let radius = radius(band, weights, &columns, &middle);
        radius.is_finite().then_some(Self {
            band,
            weights,
            columns,
            middle,
            radius,
        })
    }

    /// The number below which an eigenvalue cannot be told from 0.
    #[must_use]
    pub const fn rounding(&self) -> f64 {
        ROUNDING * self.radius
    }

    /// How many eigenvalues lie below `lambda`. O(n p²).
    #[must_use]
    pub fn below(&self, lambda: f64) -> usize {
        self.factor(lambda).negative
    }

    /// How many eigenvalues cannot be told from 0 (or are negative).
    #[must_use]
    pub fn zeros(&self) -> usize {
        self.below(self.rounding())
    }

    /// Eigenvalue number `k` from the smallest, counted from 0, to 1e-12 of itself or some 1e-16 of
    /// the largest; 0 where
    /// it cannot be told from that. None for `k` of at least the number of rows. About fifty counts.
    #[must_use]
    pub fn eigenvalue(&self, k: usize) -> Option<f64> {
        if k >= self.weights.len() {
            return None;
        }
        let (mut low, mut high) = (self.rounding(), self.radius);
        if !(low > 0.0 && self.below(low) <= k) {
            return Some(0.0);
        }
        while high > low * (1.0 + NARROW) {
            // far apart: by their logarithms
            let middle = if high > 4.0 * low {
                (low * high).sqrt()
            } else {
                0.5 * (low + high)
            };
            if middle <= low || middle >= high {
                break;
            }
            if self.below(middle) > k {
                high = middle;
            } else {
                low = middle;
            }
        }
        Some(0.5 * (low + high))
    }

    /// An eigenvector of the eigenvalue `lambda`, orthogonal to `others` as far as there is one; `Σ w u² = 1`.
    ///
    /// By inverse iteration. Vectors are orthogonal in the sense `Σ w u u' = 0`.
    #[must_use]
    pub fn eigenvector(&self, lambda: f64, others: &[&[f64]]) -> Vec<f64> {
        let n = self.weights.len();
        // beside the eigenvalue, so that the factor is not singular
        let factor = self.factor(lambda - (1e-9 * lambda.abs()).max(self.rounding()));
        // a start in which no smooth or rough vector is missing
        let start =
            |i: usize| 1.0 + 0.5 * (2.4 * i as f64).sin() + (0.7 * (i * i % 97) as f64).cos();
        let mut u: Vec<f64> = (0..n).map(start).collect();
        for _ in 0..4 {
            self.clear(&mut u, others);
            for (u, w) in u.iter_mut().zip(self.weights) {
                *u *= w;
            }
            factor.solve(&mut u);
            self.clear(&mut u, others);
        }
        u
    }

    /// Take `others` out of `u` and scale it.
    fn clear(&self, u: &mut [f64], others: &[&[f64]]) {
        let dot = |a: &[f64], b: &[f64]| -> f64 {
            (0..a.len()).map(|i| self.weights[i] * a[i] * b[i]).sum()
        };
        for _ in 0..2 {
            for other in others {
                let share = dot(u, other);
                u.iter_mut().zip(*other).for_each(|(u, o)| *u -= share * o);
            }
            let most = u.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
            if most > 0.0 && most.is_finite() {
                u.iter_mut().for_each(|u| *u /= most);
            }
            let size = dot(u, u).sqrt();
            if size > 0.0 && size.is_finite() {
                u.iter_mut().for_each(|u| *u /= size);
            }
        }
    }

    fn factor(&self, lambda: f64) -> Factored {
        let (n, p, k) = (
            self.weights.len(),
            self.band.half_width(),
            self.columns.len(),
        );
        let around = if self.band.is_cyclic() { p } else { 0 };
        let (rows, border) = (n - around, around + k);
        let entry = |i: usize, j: usize| {
            let own = if i == j {
                lambda * self.weights[i]
            } else {
                0.0
            };
            self.band.entry(i, j) - own
        };
        let mut upper = vec![0.0; rows * (p + 1)];
        let mut side = vec![0.0; rows * border];
        for i in 0..rows {
            upper[i * (p + 1)] = entry(i, i);
            for j in 1..=p.min(rows - 1 - i) {
                upper[i * (p + 1) + j] = self.band.beside(i, j);
            }
            let side = &mut side[i * border..(i + 1) * border];
            if i < p || i + p >= rows {
                for (q, side) in side.iter_mut().take(around).enumerate() {
                    *side = entry(i, rows + q);
                }
            }
            for (side, column) in side[around..].iter_mut().zip(&self.columns) {
                *side = column[i];
            }
        }
        let mut corner: Vec<f64> = vec![0.0; border * border];
        for q in 0..border {
            for r in 0..border {
                corner[q * border + r] = match (q < around, r < around) {
                    (true, true) => entry(rows + q, rows + r),
                    (true, false) => self.columns[r - around][rows + q],
                    (false, true) => self.columns[q - around][rows + r],
                    (false, false) if q == r => -1.0 / self.middle[q - around],
                    (false, false) => 0.0,
                };
            }
        }
        let least = f64::EPSILON * self.radius * f64::MIN_POSITIVE.sqrt();
        let mut negative = 0;
        for i in 0..rows {
            let (here, below) = upper[i * (p + 1)..].split_at_mut(p + 1);
            if here[0].abs() <= least {
                here[0] = -least.max(f64::MIN_POSITIVE);
            }
            negative += usize::from(here[0] < 0.0);
            let (mine, others) = side[i * border..].split_at_mut(border);
            for j in 1..=p.min(rows - 1 - i) {
                let factor = here[j] / here[0];
                if factor.abs() > 0.0 {
                    let row = &mut below[(j - 1) * (p + 1)..j * (p + 1)];
                    for (row, here) in row.iter_mut().zip(&here[j..]) {
                        *row -= factor * here;
                    }
                    let row = &mut others[(j - 1) * border..j * border];
                    for (row, mine) in row.iter_mut().zip(&*mine) {
                        *row -= factor * mine;
                    }
                }
            }
            for q in 0..border {
                let factor = mine[q] / here[0];
                for r in 0..border {
                    corner[q * border + r] -= factor * mine[r];
                }
            }
        }
        let corner = Dense::from_fn(border, |q, r| {
            0.5 * (corner[q * border + r] + corner[r * border + q])
        });
        let within = corner.eigen().map_or(0, |eigen| {
            eigen.values.iter().filter(|value| **value < 0.0).count()
        });
        let own = self.middle.iter().filter(|s| **s > 0.0).count();
        Factored {
            rows,
            width: p,
            border,
            upper,
            side,
            corner,
            negative: (negative + within).saturating_sub(own),
        }
    }
}

impl Factored {
    /// Turn the right-hand side into the solution.
    fn solve(&self, b: &mut [f64]) {
        let (rows, p, border) = (self.rows, self.width, self.border);
        let mut last = vec![0.0; border];
        let around = b.len() - rows;
        last[..around].copy_from_slice(&b[rows..]);
        for i in 0..rows {
            let here = &self.upper[i * (p + 1)..(i + 1) * (p + 1)];
            let share = b[i] / here[0];
            for j in 1..=p.min(rows - 1 - i) {
                b[i + j] -= share * here[j];
            }
            for (last, side) in last.iter_mut().zip(&self.side[i * border..]) {
                *last -= share * side;
            }
        }
        if border > 0 {
            last = self.corner.solve(&last).unwrap_or(last);
        }
        for i in (0..rows).rev() {
            let here = &self.upper[i * (p + 1)..(i + 1) * (p + 1)];
            let mut sum = b[i];
            for j in 1..=p.min(rows - 1 - i) {
                sum -= here[j] * b[i + j];
            }
            for (last, side) in last.iter().zip(&self.side[i * border..]) {
                sum -= last * side;
            }
            b[i] = sum / here[0];
        }
        b[rows..].copy_from_slice(&last[..around]);
    }
}

/// A bound of all magnitudes by Gershgorin's discs of `W^-½ A W^-½`.
fn radius(band: &Band, weights: &[f64], columns: &[Vec<f64>], middle: &[f64]) -> f64 {
    let n = weights.len();
    let root: Vec<f64> = weights.iter().map(|w| w.sqrt()).collect();
    let sums: Vec<f64> = columns
        .iter()
        .map(|column| column.iter().zip(&root).map(|(u, r)| u.abs() / r).sum())
        .collect();
    let row = |i: usize| {
        let mut row = band.diagonal()[i].abs() / weights[i];
        for k in 1..=band.half_width() {
            let back = (i + n - k) % n;
            for (value, j) in [
                (band.beside(i, k), (i + k) % n),
                (band.beside(back, k), back),
            ] {
                row += value.abs() / (root[i] * root[j]);
            }
        }
        for ((column, sum), s) in columns.iter().zip(&sums).zip(middle) {
            row += column[i].abs() / root[i] * s.abs() * sum;
        }
        row
    };
    (0..n).map(row).fold(0.0, f64::max) * (1.0 + 1e-14)
}
