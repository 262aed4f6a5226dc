//! Bands of any width.
//!
//! The half width `P` is the number of diagonals on either side of the main one: 1 for a string, 4
//! for two coordinates of a curve that feel each other (x and y alternating). For `P = 2` take
//! [`Pentadiagonal`](crate::Pentadiagonal), whose solve is faster.

use glam::DVec2;

use crate::scalar::Node;
use crate::weakest::{SINGULAR, Weakest, weakest};
use crate::{BandedError, Dense};

/// Couplings below this part of the largest diagonal element are zero: 1e-5 of its last place.
const FADED: f64 = 1e-21;

/// A symmetric band matrix with `P` diagonals on either side, open or cyclic.
///
/// ```text
/// A[i][i] = diagonal[i]     A[i][i+k] = A[i+k][i] = beside[i][k−1],  k = 1 … P
/// ```
///
/// Indices wrap round when cyclic; what runs off the end is zero when open.
#[derive(Debug, Clone, PartialEq)]
pub struct Banded<const P: usize> {
    cyclic: bool,
    diagonal: Vec<f64>,
    beside: Vec<[f64; P]>,
}

impl<const P: usize> Banded<P> {
    /// The zero matrix with `n` rows.
    ///
    /// # Errors
    ///
    /// Refuses fewer than `P + 1` rows, and fewer than `2 P + 1` when cyclic.
    pub fn new(n: usize, cyclic: bool) -> Result<Self, BandedError> {
        const { assert!(P > 0, "a band reaches over at least one neighbour") };
        let needed = if cyclic { 2 * P + 1 } else { P + 1 };
        if n < needed {
            return Err(BandedError::TooSmall { needed, got: n });
        }
        Ok(Self {
            cyclic,
            diagonal: vec![0.0; n],
            beside: vec![[0.0; P]; n],
        })
    }

    /// The number of rows.
    #[must_use]
    #[allow(clippy::len_without_is_empty, reason = "a matrix has at least one row")]
    pub fn len(&self) -> usize {
        self.diagonal.len()
    }

    /// Whether the band wraps round.
    #[must_use]
    pub fn is_cyclic(&self) -> bool {
        self.cyclic
    }

    /// `A[i][j]`, 0 outside the band.
    #[must_use]
    pub fn entry(&self, i: usize, j: usize) -> f64 {
        if i == j {
            return self.diagonal[i];
        }
        self.slot(i, j).map_or(0.0, |(row, k)| self.beside[row][k])
    }

    /// The row and the place in it that keep `A[i][j]`, for different `i` and `j`.
    fn slot(&self, i: usize, j: usize) -> Option<(usize, usize)> {
        let (low, high) = (i.min(j), i.max(j));
        let gap = high - low;
        if gap <= P {
            Some((low, gap - 1))
        } else if self.cyclic && self.len() - gap <= P {
            Some((high, self.len() - gap - 1))
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
        } else if let Some((row, k)) = self.slot(i, j) {
            self.beside[row][k] += value;
        } else {
            debug_assert!(false, "entry ({i}, {j}) lies outside the band");
        }
    }

    /// Sets a row's own element, and those beside it on the right (wrapped round when cyclic; when open, what
    /// runs off the end must be 0).
    pub fn set_row(&mut self, i: usize, diagonal: f64, beside: [f64; P]) {
        debug_assert!(
            self.cyclic || beside.iter().skip(self.len() - 1 - i).all(|a| *a == 0.0),
            "nothing runs off the end"
        );
        self.diagonal[i] = diagonal;
        self.beside[i] = beside;
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

    /// `out = A x` for one number a row. O(n P), allocates nothing.
    pub fn multiply_scalars_into(&self, x: &[f64], out: &mut [f64]) {
        debug_assert!(
            x.len() == self.len() && out.len() == self.len(),
            "one element a row"
        );
        for (i, out) in out.iter_mut().enumerate() {
            *out = self.row(i, x).0;
        }
    }

    /// Row `i` times `x`, and the sum of the row's magnitudes.
    fn row(&self, i: usize, x: &[f64]) -> (f64, f64) {
        let n = self.len();
        let (mut sum, mut size) = (self.diagonal[i] * x[i], self.diagonal[i].abs());
        for k in 1..=P {
            let (back, next) = ((i + n - k) % n, (i + k) % n);
            let (before, after) = (self.beside[back][k - 1], self.beside[i][k - 1]);
            sum += before * x[back] + after * x[next];
            size += before.abs() + after.abs();
        }
        (sum, size)
    }

    /// All n² entries.
    #[must_use]
    pub fn dense(&self) -> Dense {
        Dense::from_fn(self.len(), |i, j| self.entry(i, j))
    }
}

/// `A = L D Lᵀ` of a positive definite [`Banded`]: factor once, solve many times.
///
/// Rows in order; when cyclic the last `P` are the border, eliminated last. O(n P²) to make and
/// O(n P) to use; each row waits for the one before.
#[derive(Debug, Clone, PartialEq)]
pub struct BandedFactor<const P: usize> {
    /// One over the pivot, and the column of L under it.
    links: Vec<(f64, [f64; P])>,
    /// Couplings to the border over the pivot, zero where they have faded; none when open.
    spikes: Vec<[f64; P]>,
    border: Vec<(f64, [f64; P])>,
}

impl<const P: usize> BandedFactor<P> {
    /// Factors a matrix. O(n P²).
    ///
    /// # Errors
    ///
    /// Refuses, with the row, a matrix that is not positive definite, one that is singular to
    /// working precision (condition number above about 1e14), and numbers that are not finite.
    pub fn new(a: &Banded<P>) -> Result<Self, BandedError> {
        let n = a.len();
        let mut factor = Self {
            links: Vec::new(),
            spikes: Vec::new(),
            border: Vec::new(),
        };
        factor.renew(a)?;
        let Weakest {
            row,
            reciprocal_condition,
            ..
        } = weakest(n, |x| factor.solve_scalars(x), |i, x| a.row(i, x));
        if reciprocal_condition.is_nan() {
            Err(BandedError::NotFinite { row })
        } else if reciprocal_condition < SINGULAR {
            Err(BandedError::Singular {
                row,
                reciprocal_condition,
            })
        } else {
            Ok(factor)
        }
    }

    /// Factors another matrix in the same memory, for those that change at every step. O(n P²).
    ///
    /// Leaves out the estimate of the condition number, which costs as much as some solves: what
    /// [`new`](Self::new) would refuse as singular to working precision passes here unless a pivot is not
    /// positive. After an error the factor is of no use until the next.
    ///
    /// # Errors
    ///
    /// Refuses, with the row, a matrix that is not positive definite, and numbers that are not finite.
    pub fn renew(&mut self, a: &Banded<P>) -> Result<(), BandedError> {
        let n = a.len();
        let inner = if a.cyclic { n - P } else { n };
        self.spikes.clear();
        let mut corner = [[0.0; P]; P];
        if a.cyclic {
            self.spikes.resize(inner, [0.0; P]);
            for b in 0..P {
                (0..P).for_each(|c| corner[b][c] = a.entry(inner + b, inner + c));
                for i in (0..P).chain(inner - P..inner) {
                    self.spikes[i][b] = a.entry(i, inner + b);
                }
            }
        }
        let faded = FADED * a.diagonal.iter().fold(0.0_f64, |most, d| most.max(d.abs()));
        self.links.clear();
        // what the rows before take from this one and the next P: diagonal, then beside
        let mut taken = [[0.0; P]; P];
        let mut taken_diagonal = [0.0; P];
        for i in 0..inner {
            let reciprocal = positive(a.diagonal[i] - taken_diagonal[0], i)?;
            let mut column = a.beside[i];
            for k in 0..P {
                column[k] -= taken[0][k];
            }
            let reach = P.min(inner - 1 - i);
            column[reach..].fill(0.0);
            let scaled = column.map(|a| a * reciprocal);
            for k in 1..P {
                taken_diagonal[k - 1] = taken_diagonal[k];
                taken[k - 1] = taken[k];
            }
            taken_diagonal[P - 1] = 0.0;
            taken[P - 1] = [0.0; P];
            for k in 0..P {
                taken_diagonal[k] += scaled[k] * column[k];
                for j in k + 1..P {
                    taken[k][j - k - 1] += scaled[k] * column[j];
                }
            }
            self.links.push((reciprocal, scaled));
            if a.cyclic {
                let spikes = &mut self.spikes;
                let spike = spikes[i];
                if spike.iter().all(|g| g.abs() <= faded) {
                    spikes[i] = [0.0; P];
                    continue;
                }
                for k in 0..reach {
                    (0..P).for_each(|b| spikes[i + k + 1][b] -= scaled[k] * spike[b]);
                }
                spikes[i] = spike.map(|g| g * reciprocal);
                for b in 0..P {
                    (0..P).for_each(|c| corner[b][c] -= spikes[i][b] * spike[c]);
                }
            }
        }
        self.border = if a.cyclic {
            small_factor(corner, inner)?
        } else {
            Vec::new()
        };
        Ok(())
    }

    /// The number of rows.
    #[must_use]
    #[allow(clippy::len_without_is_empty, reason = "a matrix has at least one row")]
    pub fn len(&self) -> usize {
        self.links.len() + self.border.len()
    }

    /// Turns the right-hand side `b` into the solution, x and y in one sweep. Allocates nothing.
    pub fn solve(&self, b: &mut [DVec2]) {
        self.sweep(b);
    }

    /// Turns the right-hand side `b` into the solution, one number a row. Allocates nothing.
    pub fn solve_scalars(&self, b: &mut [f64]) {
        self.sweep(b);
    }

    fn sweep<V: Node<f64>>(&self, b: &mut [V]) {
        debug_assert_eq!(b.len(), self.len(), "one element a row");
        let inner = self.links.len();
        let (b, border) = b.split_at_mut(inner);
        let mut window = [V::default(); P];
        window.copy_from_slice(&b[..P]);
        for (i, (_, column)) in self.links.iter().enumerate() {
            let y = window[0];
            b[i] = y;
            for k in 1..P {
                window[k - 1] = window[k] - y * column[k - 1];
            }
            let entering = b.get(i + P).copied().unwrap_or_default();
            window[P - 1] = entering - y * column[P - 1];
        }
        for (y, spike) in b.iter().zip(&self.spikes) {
            for (rest, f) in border.iter_mut().zip(spike) {
                *rest = *rest - *y * *f;
            }
        }
        for i in 0..self.border.len() {
            for (k, f) in (i + 1..P).zip(self.border[i].1) {
                border[k] = border[k] - border[i] * f;
            }
        }
        for (i, (reciprocal, column)) in self.border.iter().enumerate().rev() {
            border[i] = border[i] * *reciprocal;
            for (k, f) in (i + 1..P).zip(column) {
                border[i] = border[i] - border[k] * *f;
            }
        }
        window = [V::default(); P];
        for (i, (reciprocal, column)) in self.links.iter().enumerate().rev() {
            let mut x = b[i] * *reciprocal;
            if let Some(spike) = self.spikes.get(i) {
                for (known, f) in border.iter().zip(spike) {
                    x = x - *known * *f;
                }
            }
            // the nearest last: it is the one that is waited for
            for k in (0..P).rev() {
                x = x - window[k] * column[k];
            }
            for k in (1..P).rev() {
                window[k] = window[k - 1];
            }
            window[0] = x;
            b[i] = x;
        }
    }
}

/// One over a pivot, or why there is none.
fn positive(pivot: f64, row: usize) -> Result<f64, BandedError> {
    crate::scalar::Entry::reciprocal(pivot, row)
}

/// LDLᵀ of the block at the border: pivots' reciprocals, and columns counted from below the pivot.
fn small_factor<const P: usize>(
    mut a: [[f64; P]; P],
    first: usize,
) -> Result<Vec<(f64, [f64; P])>, BandedError> {
    let mut links = Vec::with_capacity(P);
    for k in 0..P {
        let reciprocal = positive(a[k][k], first + k)?;
        let mut column = [0.0; P];
        for i in k + 1..P {
            column[i - k - 1] = a[i][k] * reciprocal;
            for j in k + 1..P {
                a[i][j] -= column[i - k - 1] * a[k][j];
            }
        }
        links.push((reciprocal, column));
    }
    Ok(links)
}
