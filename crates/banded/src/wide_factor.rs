//! LDLᵀ of a band of any width, with real or complex pivots.

use glam::DVec2;

use crate::complex::{Complex, ComplexPoint};
use crate::scalar::{Entry, Node};
use crate::weakest::{SINGULAR, Weakest, weakest};
use crate::wide::unrolled;
use crate::{Banded, BandedError};

/// Couplings below this part of the largest diagonal element are zero: 1e-5 of its last place.
const FADED: f64 = 1e-21;

/// `A = L D Lᵀ` of a positive definite [`Banded`]: factor once, solve many times.
///
/// Rows in order; when cyclic the last p are the border, eliminated last. O(n p²) to make and
/// O(n p) to use; each row waits for the one before.
#[derive(Debug, Clone, PartialEq)]
pub struct BandedFactor(Ldl<f64>);

/// `diag(shift) + A = L D Lᵀ` of a real [`Banded`] `A` and a complex diagonal.
///
/// As [`BandedFactor`]. No rows are exchanged; see [`ComplexFactor`](crate::ComplexFactor) for when that is stable.
#[derive(Debug, Clone, PartialEq)]
pub struct ComplexBandedFactor(Ldl<Complex>);

/// The factor of a band with entries `E`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ldl<E> {
    half_width: usize,
    /// One over the pivots: of the rows in order, then of the border.
    reciprocals: Vec<E>,
    /// The columns of L under them, p numbers each.
    columns: Vec<E>,
    /// Couplings to the border over the pivot, p numbers a row, zero where they have faded; none when open.
    spikes: Vec<E>,
}

impl BandedFactor {
    /// Factors a matrix. O(n p²).
    ///
    /// # Errors
    ///
    /// Refuses, with the row, a matrix that is not positive definite, one that is singular to
    /// working precision (condition number above about 1e14), and numbers that are not finite.
    pub fn new(a: &Banded) -> Result<Self, BandedError> {
        let mut factor = Ldl::empty(a.half_width());
        factor.eliminate(a, |d, _| d, 1.0)?;
        let Weakest {
            row,
            reciprocal_condition,
            ..
        } = weakest(a.len(), |x| factor.sweep(x), |i, x| a.row(i, x));
        judged(row, reciprocal_condition)?;
        Ok(Self(factor))
    }

    /// Factors another matrix in the same memory, for those that change at every step. O(n p²).
    ///
    /// Leaves out the estimate of the condition number, which costs as much as some solves: what
    /// [`new`](Self::new) would refuse as singular to working precision passes here unless a pivot is not
    /// positive. After an error the factor is of no use until the next.
    ///
    /// # Errors
    ///
    /// Refuses, with the row, a matrix that is not positive definite, and numbers that are not finite.
    pub fn renew(&mut self, a: &Banded) -> Result<(), BandedError> {
        self.0.eliminate(a, |d, _| d, 1.0)
    }

    /// The number of rows.
    #[must_use]
    #[allow(
        clippy::len_without_is_empty,
        reason = "a matrix has at least two rows"
    )]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Turns the right-hand side `b` into the solution, x and y in one sweep. Allocates nothing.
    pub fn solve(&self, b: &mut [DVec2]) {
        self.0.sweep(b);
    }

    /// Turns the right-hand side `b` into the solution, one number a row. Allocates nothing.
    pub fn solve_scalars(&self, b: &mut [f64]) {
        self.0.sweep(b);
    }
}

impl ComplexBandedFactor {
    /// Factors `diag(shift) + A`; `shift` has one number a row. O(n p²).
    ///
    /// # Errors
    ///
    /// Refuses a shift of another length, numbers that are not finite, a matrix that is singular to
    /// working precision, and one whose factor has lost more than four digits for want of exchanges.
    pub fn new(a: &Banded, shift: &[Complex]) -> Result<Self, BandedError> {
        let n = a.len();
        if shift.len() != n {
            return Err(BandedError::Length {
                name: "shift",
                expected: n,
                got: shift.len(),
            });
        }
        let mut factor = Ldl::empty(a.half_width());
        factor.eliminate(a, |d, i| Complex::from(d) + shift[i], 1.0)?;
        let row = |i: usize, x: &[Complex]| {
            let own = Complex::from(a.diagonal()[i]) + shift[i];
            let (mut sum, mut size) = (own * x[i], own.abs());
            for k in 1..=a.half_width() {
                let (back, next) = ((i + n - k) % n, (i + k) % n);
                let (before, after) = (a.beside(back)[k - 1], a.beside(i)[k - 1]);
                sum += x[back] * before + x[next] * after;
                size += before.abs() + after.abs();
            }
            (sum, size)
        };
        let Weakest {
            row,
            reciprocal_condition,
            backward_error,
        } = weakest(n, |x| factor.sweep(x), row);
        judged(row, reciprocal_condition)?;
        if backward_error > 1e4 * f64::EPSILON {
            return Err(BandedError::Unstable { backward_error });
        }
        Ok(Self(factor))
    }

    /// The number of rows.
    #[must_use]
    #[allow(
        clippy::len_without_is_empty,
        reason = "a matrix has at least two rows"
    )]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Turns the right-hand side `b` into the solution, x and y in one sweep. Allocates nothing.
    pub fn solve(&self, b: &mut [ComplexPoint]) {
        self.0.sweep(b);
    }

    /// Turns the right-hand side `b` into the solution, one number a row. Allocates nothing.
    pub fn solve_scalars(&self, b: &mut [Complex]) {
        self.0.sweep(b);
    }
}

/// Refuses what cannot be solved with.
fn judged(row: usize, reciprocal_condition: f64) -> Result<(), BandedError> {
    if reciprocal_condition.is_nan() {
        Err(BandedError::NotFinite { row })
    } else if reciprocal_condition < SINGULAR {
        Err(BandedError::Singular {
            row,
            reciprocal_condition,
        })
    } else {
        Ok(())
    }
}

impl<E> Ldl<E> {
    /// Of no matrix yet.
    pub(crate) const fn empty(half_width: usize) -> Self {
        Self {
            half_width,
            reciprocals: Vec::new(),
            columns: Vec::new(),
            spikes: Vec::new(),
        }
    }

    fn len(&self) -> usize {
        self.reciprocals.len()
    }
}

impl<E: Entry> Ldl<E> {
    /// Factors the matrix with diagonal `diagonal(A[i][i], i)` and off-diagonals `sign · A`.
    pub(crate) fn eliminate(
        &mut self,
        a: &Banded,
        diagonal: impl Fn(f64, usize) -> E,
        sign: f64,
    ) -> Result<(), BandedError> {
        self.half_width = a.half_width();
        unrolled!(self.half_width, P => self.rows_in_order::<P>(a, diagonal, sign))
    }

    fn rows_in_order<const P: usize>(
        &mut self,
        a: &Banded,
        diagonal: impl Fn(f64, usize) -> E,
        sign: f64,
    ) -> Result<(), BandedError> {
        let n = a.len();
        let cyclic = a.is_cyclic();
        let inner = if cyclic { n - P } else { n };
        let zero = [E::ZERO; P];
        let lifted = |i: usize, j: usize| {
            let entry = a.entry(i, j);
            if i == j {
                diagonal(entry, i)
            } else {
                E::real(sign * entry)
            }
        };
        self.spikes.clear();
        let mut corner = [zero; P];
        if cyclic {
            self.spikes.resize(inner * P, E::ZERO);
            for b in 0..P {
                (0..P).for_each(|c| corner[b][c] = lifted(inner + b, inner + c));
                for i in (0..P.min(inner)).chain(inner.saturating_sub(P)..inner) {
                    self.spikes[i * P + b] = lifted(i, inner + b);
                }
            }
        }
        let own = a.diagonal();
        let faded = FADED * (0..n).fold(0.0_f64, |most, i| most.max(diagonal(own[i], i).size()));
        self.reciprocals.clear();
        self.columns.clear();
        // what the rows before take from this one and the next P: diagonal, then beside
        let mut taken = [zero; P];
        let mut taken_diagonal = zero;
        for (i, beside) in a.rows::<P>()[..inner].iter().enumerate() {
            let reciprocal = (diagonal(own[i], i) - taken_diagonal[0]).reciprocal(i)?;
            let mut column = beside.map(|a| E::real(sign * a));
            for k in 0..P {
                column[k] = column[k] - taken[0][k];
            }
            let reach = P.min(inner - 1 - i);
            column[reach..].fill(E::ZERO);
            let scaled = column.map(|a| a * reciprocal);
            for k in 1..P {
                taken_diagonal[k - 1] = taken_diagonal[k];
                taken[k - 1] = taken[k];
            }
            taken_diagonal[P - 1] = E::ZERO;
            taken[P - 1] = zero;
            for k in 0..P {
                taken_diagonal[k] = taken_diagonal[k] + scaled[k] * column[k];
                for j in k + 1..P {
                    taken[k][j - k - 1] = taken[k][j - k - 1] + scaled[k] * column[j];
                }
            }
            self.reciprocals.push(reciprocal);
            self.columns.extend_from_slice(&scaled);
            if cyclic {
                let spikes = self.spikes.as_chunks_mut::<P>().0;
                let spike = spikes[i];
                if spike.iter().all(|g| g.size() <= faded) {
                    spikes[i] = zero;
                    continue;
                }
                for k in 0..reach {
                    for b in 0..P {
                        spikes[i + k + 1][b] = spikes[i + k + 1][b] - scaled[k] * spike[b];
                    }
                }
                spikes[i] = spike.map(|g| g * reciprocal);
                for b in 0..P {
                    for c in 0..P {
                        corner[b][c] = corner[b][c] - spikes[i][b] * spike[c];
                    }
                }
            }
        }
        if cyclic {
            self.border(corner, inner)?;
        }
        Ok(())
    }

    /// LDLᵀ of the block at the border: pivots' reciprocals, and columns counted from below the pivot.
    fn border<const P: usize>(
        &mut self,
        mut a: [[E; P]; P],
        first: usize,
    ) -> Result<(), BandedError> {
        for k in 0..P {
            let reciprocal = a[k][k].reciprocal(first + k)?;
            let mut column = [E::ZERO; P];
            for i in k + 1..P {
                column[i - k - 1] = a[i][k] * reciprocal;
                for j in k + 1..P {
                    a[i][j] = a[i][j] - column[i - k - 1] * a[k][j];
                }
            }
            self.reciprocals.push(reciprocal);
            self.columns.extend_from_slice(&column);
        }
        Ok(())
    }

    fn sweep<V: Node<E>>(&self, b: &mut [V]) {
        unrolled!(self.half_width, P => self.sweep_of::<P, V>(b));
    }

    fn sweep_of<const P: usize, V: Node<E>>(&self, b: &mut [V]) {
        debug_assert_eq!(b.len(), self.len(), "one element a row");
        let (columns, spikes) = (
            self.columns.as_chunks::<P>().0,
            self.spikes.as_chunks::<P>().0,
        );
        let inner = if spikes.is_empty() {
            b.len()
        } else {
            spikes.len()
        };
        let (b, border) = b.split_at_mut(inner);
        let (columns, border_columns) = columns.split_at(inner);
        let (reciprocals, border_reciprocals) = self.reciprocals.split_at(inner);
        let mut window = [V::default(); P];
        let first = P.min(inner);
        window[..first].copy_from_slice(&b[..first]);
        for (i, column) in columns.iter().enumerate() {
            let y = window[0];
            b[i] = y;
            for k in 1..P {
                window[k - 1] = window[k] - y * column[k - 1];
            }
            let entering = b.get(i + P).copied().unwrap_or_default();
            window[P - 1] = entering - y * column[P - 1];
        }
        for (y, spike) in b.iter().zip(spikes) {
            for (rest, f) in border.iter_mut().zip(spike) {
                *rest = *rest - *y * *f;
            }
        }
        for i in 0..border.len() {
            for (k, f) in (i + 1..P).zip(border_columns[i]) {
                border[k] = border[k] - border[i] * f;
            }
        }
        for (i, (&reciprocal, column)) in border_reciprocals
            .iter()
            .zip(border_columns)
            .enumerate()
            .rev()
        {
            border[i] = border[i] * reciprocal;
            for (k, f) in (i + 1..P).zip(column) {
                border[i] = border[i] - border[k] * *f;
            }
        }
        window = [V::default(); P];
        for (i, (&reciprocal, column)) in reciprocals.iter().zip(columns).enumerate().rev() {
            let mut x = b[i] * reciprocal;
            if let Some(spike) = spikes.get(i) {
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
