//! Cyclic matrices whose rows are all the same, by Fourier transform.
//!
//! Waves round the ring are the eigenvectors of every such matrix, so a transform takes it apart
//! into n numbers. For a solve that is slower than a [`Factor`](crate::Factor); it is here for what
//! a factor cannot do: any function of the matrix, exact motion in time among them.
//!
//! A point (x, y) is transformed as the complex number x + i y. The eigenvalues are real, so the
//! coordinates do not mix.

use std::cell::RefCell;
use std::fmt;
use std::sync::Arc;

use glam::DVec2;
use rustfft::num_complex::Complex64;
use rustfft::{Fft, FftPlanner};

use crate::{Band, BandedError};

/// A cyclic [`Band`] with equal rows `d, a₁ … aₚ`, in its eigenbasis.
///
/// ```text
/// λ[k] = d + 2 Σ aₘ cos mθ,   θ = 2π k / n
/// ```
///
/// Transforms are O(n log n) for every n, and allocate nothing.
#[derive(Clone)]
pub struct Circulant {
    eigenvalues: Vec<f64>,
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
    buffer: Vec<Complex64>,
    scratch: Vec<Complex64>,
}

impl fmt::Debug for Circulant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Circulant")
            .field("eigenvalues", &self.eigenvalues)
            .finish_non_exhaustive()
    }
}

impl Circulant {
    /// Takes a matrix apart.
    ///
    /// # Errors
    ///
    /// Refuses a matrix that is open, one whose rows differ by more than rounding (see
    /// [`Band::circulant`]), and numbers that are not finite.
    pub fn new(a: &Band) -> Result<Self, BandedError> {
        let n = a.len();
        if !a.norm().is_finite() {
            return Err(BandedError::NotFinite { row: 0 });
        }
        let powers = in_sines(&a.circulant().ok_or(BandedError::NotCirculant)?);
        let mut eigenvalues = Vec::with_capacity(n);
        for k in 0..=n / 2 {
            let wave = count(k) / count(n);
            let sigma = (std::f64::consts::PI * wave).sin().powi(2);
            eigenvalues.push(
                powers
                    .iter()
                    .rev()
                    .fold(0.0, |sum, c| c + 4.0 * sigma * sum),
            );
        }
        // exactly the same for a wave and the one that runs the other way
        for k in n / 2 + 1..n {
            eigenvalues.push(eigenvalues[n - k]);
        }
        let (forward, inverse) = plans(n);
        let room = forward
            .get_inplace_scratch_len()
            .max(inverse.get_inplace_scratch_len());
        Ok(Self {
            eigenvalues,
            forward,
            inverse,
            buffer: vec![Complex64::default(); n],
            scratch: vec![Complex64::default(); room],
        })
    }

    /// The number of rows.
    #[must_use]
    #[allow(
        clippy::len_without_is_empty,
        reason = "a cyclic matrix has at least 5 rows"
    )]
    pub fn len(&self) -> usize {
        self.eigenvalues.len()
    }

    /// The eigenvalue of each mode, in the order of the transform: `λ[k] = λ[n−k]`.
    ///
    /// Right to some units in the last place of the row's largest entry.
    #[must_use]
    pub fn eigenvalues(&self) -> &[f64] {
        &self.eigenvalues
    }

    /// `modes[k] = Σ_j x[j] exp(−2πi j k / n)`, a point being the complex number x + i y.
    pub fn to_modes(&mut self, x: &[DVec2], modes: &mut [DVec2]) {
        let forward = Arc::clone(&self.forward);
        self.transform(&*forward, x, modes, 1.0);
    }

    /// `x[j] = 1/n Σ_k modes[k] exp(2πi j k / n)`: undoes [`to_modes`](Self::to_modes).
    pub fn from_modes(&mut self, modes: &[DVec2], x: &mut [DVec2]) {
        let inverse = Arc::clone(&self.inverse);
        self.transform(&*inverse, modes, x, 1.0 / count(self.len()));
    }

    fn transform(&mut self, fft: &dyn Fft<f64>, from: &[DVec2], to: &mut [DVec2], scale: f64) {
        let n = self.len();
        debug_assert!(from.len() == n && to.len() == n, "one point a row");
        for (slot, point) in self.buffer.iter_mut().zip(from) {
            *slot = Complex64::new(point.x, point.y);
        }
        fft.process_with_scratch(&mut self.buffer, &mut self.scratch);
        for (point, slot) in to.iter_mut().zip(&self.buffer) {
            *point = DVec2::new(slot.re, slot.im) * scale;
        }
    }

    /// Multiplies every mode of `x` by its gain: `x ← g(A) x` with `gains[k] = g(λ[k])`.
    ///
    /// Gains must be the same for `k` and `n − k`, as every function of the eigenvalues is; otherwise
    /// x and y mix.
    pub fn filter(&mut self, gains: &[f64], x: &mut [DVec2]) {
        debug_assert_eq!(gains.len(), self.len(), "one gain a mode");
        for (slot, point) in self.buffer.iter_mut().zip(&*x) {
            *slot = Complex64::new(point.x, point.y);
        }
        self.forward
            .process_with_scratch(&mut self.buffer, &mut self.scratch);
        let scale = 1.0 / count(self.len());
        for (slot, gain) in self.buffer.iter_mut().zip(gains) {
            *slot *= gain * scale;
        }
        self.inverse
            .process_with_scratch(&mut self.buffer, &mut self.scratch);
        for (point, slot) in x.iter_mut().zip(&self.buffer) {
            *point = DVec2::new(slot.re, slot.im);
        }
    }

    /// One over each eigenvalue: the gains with which [`filter`](Self::filter) solves `A x = b`.
    ///
    /// # Errors
    ///
    /// Refuses a matrix that is singular to working precision; `row` is the mode.
    pub fn reciprocals(&self) -> Result<Vec<f64>, BandedError> {
        let largest = self
            .eigenvalues
            .iter()
            .fold(0.0_f64, |most, e| most.max(e.abs()));
        let condition = |e: f64| {
            if largest > 0.0 {
                e.abs() / largest
            } else {
                0.0
            }
        };
        let singular = |&e: &f64| condition(e) < crate::weakest::SINGULAR;
        match self.eigenvalues.iter().position(singular) {
            Some(row) => {
                let reciprocal_condition = condition(self.eigenvalues[row]);
                Err(BandedError::Singular {
                    row,
                    reciprocal_condition,
                })
            }
            None => Ok(self.eigenvalues.iter().map(|e| 1.0 / e).collect()),
        }
    }
}

/// The coefficients of λ in powers of 4 sin² θ/2: small eigenvalues keep their digits where cosines would cancel.
///
/// `2 cos mθ = (2 − s) 2 cos (m−1)θ − 2 cos (m−2)θ` with `s = 4 sin² θ/2`.
fn in_sines(row: &[f64]) -> Vec<f64> {
    let mut powers = vec![0.0; row.len()];
    powers[0] = row[0] + 2.0 * row[1..].iter().sum::<f64>();
    let (mut before, mut cosine) = (vec![2.0], vec![2.0, -1.0]);
    for (m, a) in row.iter().enumerate().skip(1) {
        for (power, c) in powers.iter_mut().zip(&cosine).skip(1) {
            *power += a * c;
        }
        let mut next = vec![0.0; m + 2];
        for (k, c) in cosine.iter().enumerate() {
            next[k] += 2.0 * c;
            next[k + 1] -= c;
        }
        for (k, c) in before.iter().enumerate() {
            next[k] -= c;
        }
        (before, cosine) = (cosine, next);
    }
    powers
}

type Plan = Arc<dyn Fft<f64>>;

/// The transforms planned lately, with their lengths: the plan takes longer than ten transforms.
const KEPT: usize = 8;

thread_local! {
    static PLANS: RefCell<Vec<(usize, Plan, Plan)>> = const { RefCell::new(Vec::new()) };
}

/// The transforms of length `n`, there and back. The last few lengths of each thread are kept.
fn plans(n: usize) -> (Plan, Plan) {
    PLANS.with_borrow_mut(|kept| {
        let (forward, inverse) = match kept.iter().position(|(length, ..)| *length == n) {
            Some(at) => {
                let (_, forward, inverse) = kept.remove(at);
                (forward, inverse)
            }
            None => {
                let mut planner = FftPlanner::new();
                (planner.plan_fft_forward(n), planner.plan_fft_inverse(n))
            }
        };
        kept.truncate(KEPT - 1);
        kept.insert(0, (n, Arc::clone(&forward), Arc::clone(&inverse)));
        (forward, inverse)
    })
}

/// A count as a number.
#[allow(clippy::cast_precision_loss, reason = "no ring has 2⁵³ nodes")]
fn count(n: usize) -> f64 {
    n as f64
}
