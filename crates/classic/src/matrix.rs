//! The implicit part of a step: the elastic forces of a closed snake or of one with ends.

use banded::{Factor, Pentadiagonal};
use glam::DVec2;

use crate::{Border, ClassicError, Ends, Rules};

/// Solves `(A + γ) x = b`.
#[derive(Debug)]
pub(crate) enum Elastic {
    Closed(Box<Factor>),
    Open(Rows),
}

impl Elastic {
    /// Of a snake of so many points.
    pub(crate) fn new(rules: &Rules, points: usize) -> Result<Self, ClassicError> {
        let Rules {
            alpha, beta, gamma, ..
        } = *rules;
        let unstable = ClassicError::Unstable { alpha, beta, gamma };
        match rules.ends {
            Ends::Periodic => closed(rules, points)
                .map(|factor| Self::Closed(Box::new(factor)))
                .ok_or(unstable),
            Ends::Open(head, tail) => Rows::new(rules, points, head, tail)
                .map(Self::Open)
                .ok_or(unstable),
        }
    }

    pub(crate) fn solve(&self, b: &mut [DVec2]) {
        match self {
            Self::Closed(factor) => factor.solve(b),
            Self::Open(rows) => rows.solve(b),
        }
    }
}

/// `−α δ² + β δ⁴ + γ` in a ring.
fn closed(rules: &Rules, n: usize) -> Option<Factor> {
    let Rules {
        alpha, beta, gamma, ..
    } = *rules;
    let mut matrix = Pentadiagonal::new(n, true).ok()?;
    for i in 0..n {
        let (next, after) = ((i + 1) % n, (i + 2) % n);
        matrix.add_outer(alpha, &[(i, -1.0), (next, 1.0)]);
        matrix.add_outer(beta, &[(i, 1.0), (next, -2.0), (after, 1.0)]);
    }
    matrix.add_identity(gamma);
    Factor::new(&matrix).ok()
}

/// A matrix of five diagonals without symmetry, as `L U` with rows exchanged; U has two diagonals more.
#[derive(Debug)]
pub(crate) struct Rows {
    /// Row i from column i on.
    upper: Vec<[f64; 5]>,
    /// With which row each was exchanged, and how much of it was taken from the two below.
    steps: Vec<(usize, [f64; 2])>,
}

impl Rows {
    fn new(rules: &Rules, n: usize, head: Border, tail: Border) -> Option<Self> {
        let Rules {
            alpha, beta, gamma, ..
        } = *rules;
        // row i from column i − 2 on
        let inner = [
            beta,
            -alpha - 4.0 * beta,
            2.0 * alpha + 6.0 * beta,
            -alpha - 4.0 * beta,
            beta,
        ];
        let mut rows = vec![inner; n];
        // the border's conditions in place of the first and the last two: no bending at the end and no change of it,
        // or a place that stays and no bending beside it
        match head {
            Border::Free => {
                rows[0] = [0.0, 0.0, 1.0, -2.0, 1.0];
                rows[1] = [0.0, -1.0, 3.0, -3.0, 1.0];
            }
            Border::Fixed => {
                rows[0] = [0.0; 5];
                rows[1] = [0.0, 1.0, -2.0, 1.0, 0.0];
            }
        }
        match tail {
            Border::Free => {
                rows[n - 1] = [1.0, -2.0, 1.0, 0.0, 0.0];
                rows[n - 2] = [-1.0, 3.0, -3.0, 1.0, 0.0];
            }
            Border::Fixed => {
                rows[n - 1] = [0.0; 5];
                rows[n - 2] = [0.0, 1.0, -2.0, 1.0, 0.0];
            }
        }
        for row in &mut rows {
            row[2] += gamma;
        }
        Self::factor(rows)
    }

    /// Eliminate with the largest pivot of three. `rows`: row i from column i − 2 on.
    fn factor(rows: Vec<[f64; 5]>) -> Option<Self> {
        let n = rows.len();
        // at column i, the rows that reach it: i, i + 1, i + 2, each from column i on
        let aligned = |i: usize, from: usize| {
            let mut out = [0.0; 5];
            let row = rows.get(i)?;
            for (k, value) in row.iter().enumerate() {
                let column = i + k; // two more than it is
                if (from + 2..n + 2).contains(&column) {
                    out[column - 2 - from] = *value;
                }
            }
            Some(out)
        };
        let (mut upper, mut steps) = (Vec::with_capacity(n), Vec::with_capacity(n));
        let mut waiting = vec![aligned(0, 0)?, aligned(1, 0)?];
        for i in 0..n {
            waiting.extend(aligned(i + 2, i));
            let best = (0..waiting.len())
                .max_by(|a, b| waiting[*a][0].abs().total_cmp(&waiting[*b][0].abs()))?;
            waiting.swap(0, best);
            let pivot = waiting.remove(0);
            if !(pivot[0].abs() > f64::MIN_POSITIVE && pivot[0].is_finite()) {
                return None;
            }
            let mut shares = [0.0; 2];
            for (row, share) in waiting.iter_mut().zip(&mut shares) {
                *share = row[0] / pivot[0];
                for k in 1..5 {
                    row[k - 1] = row[k] - *share * pivot[k];
                }
                row[4] = 0.0;
            }
            let mut pivot = pivot;
            pivot[0] = pivot[0].recip();
            upper.push(pivot);
            steps.push((i + best, shares));
        }
        Some(Self { upper, steps })
    }

    fn solve(&self, b: &mut [DVec2]) {
        let n = b.len();
        for (i, (with, shares)) in self.steps.iter().enumerate() {
            b.swap(i, *with);
            let here = b[i];
            for (k, share) in shares.iter().enumerate().take(n - 1 - i) {
                b[i + 1 + k] -= *share * here;
            }
        }
        for i in (0..n).rev() {
            let row = &self.upper[i];
            let mut value = b[i];
            for (k, after) in b[i + 1..].iter().enumerate().take(4) {
                value -= row[k + 1] * *after;
            }
            b[i] = value * row[0];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `A x` of rows that begin two columns before their own.
    fn product(rows: &[[f64; 5]], x: &[DVec2]) -> Vec<DVec2> {
        let one = |i: usize| {
            let terms = rows[i].iter().enumerate();
            let inside =
                terms.filter_map(|(k, value)| Some(*value * *x.get((i + k).checked_sub(2)?)?));
            inside.sum()
        };
        (0..x.len()).map(one).collect()
    }

    #[test]
    fn what_is_solved_satisfies_the_rows_even_where_a_pivot_is_small() {
        for n in 4..30 {
            let wild = |i: usize, k: usize| ((i * 7 + k * 13 + n) as f64 * 0.7).sin();
            let mut rows: Vec<[f64; 5]> = (0..n)
                .map(|i| [0, 1, 2, 3, 4].map(|k| wild(i, k)))
                .collect();
            rows[0][2] = 1e-13; // needs an exchange
            let x: Vec<DVec2> = (0..n).map(|i| DVec2::new(wild(i, 9), wild(i, 5))).collect();
            let mut b = product(&rows, &x);
            Rows::factor(rows).unwrap().solve(&mut b);
            let worst = b
                .iter()
                .zip(&x)
                .map(|(a, b)| a.distance(*b))
                .fold(0.0, f64::max);
            assert!(worst < 1e-8, "{n}: {worst:e}"); // matrices of random numbers, condition up to 1e6
        }
    }

    #[test]
    fn a_row_of_zeros_is_refused() {
        let mut rows = vec![[1.0, -4.0, 6.0, -4.0, 1.0]; 9];
        rows[3] = [0.0; 5];
        assert!(Rows::factor(rows).is_none());
    }
}
