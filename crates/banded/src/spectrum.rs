//! Extreme eigenvalues by asking whether a matrix is positive definite.
//!
//! `λ W − A` is positive definite exactly when λ lies above every eigenvalue of `A u = λ W u`. The
//! question costs one elimination that keeps nothing, so bisection finds the largest eigenvalue in
//! about fifty of them, however close its neighbours are: there is nothing to converge to the
//! wrong place. Eigenvalues inside the spectrum are [`Dense`](crate::Dense)'s business.

use crate::{Band, Pentadiagonal};

/// Whether the matrix with diagonal `diagonal(A[i][i], i)` and off-diagonals `sign · A` is positive.
///
/// Rows in order; when cyclic, the last two are eliminated last and their couplings carried along.
pub(crate) fn is_positive(
    a: &Pentadiagonal,
    diagonal: impl Fn(f64, usize) -> f64,
    sign: f64,
) -> bool {
    let n = a.len();
    let cyclic = a.is_cyclic();
    let inner = if cyclic { n - 2 } else { n };
    let (d, f, s) = (a.diagonal(), a.first(), a.second());
    // what the rows already eliminated leave on this row, the next, and between them
    let (mut here, mut next, mut between) = (0.0, 0.0, 0.0);
    // couplings of this row and the next to the last two, and what is left on those
    let (mut border, mut border_next) = ([0.0; 2], [0.0; 2]);
    let mut rest = [0.0; 3];
    if cyclic {
        border = [sign * s[n - 2], sign * f[n - 1]];
        border_next = [0.0, sign * s[n - 1]];
        rest = [
            diagonal(d[n - 2], n - 2),
            sign * f[n - 2],
            diagonal(d[n - 1], n - 1),
        ];
    }
    for i in 0..inner {
        let pivot = diagonal(d[i], i) + here;
        if pivot.is_nan() || pivot <= 0.0 {
            return false;
        }
        let mut beside = sign * f[i] + between;
        let mut beyond = sign * s[i];
        if cyclic {
            if i + 2 == inner {
                border[0] += beyond;
                beyond = 0.0;
            } else if i + 1 == inner {
                border[0] += beside;
                border[1] += beyond;
                (beside, beyond) = (0.0, 0.0);
            }
            let scaled = [border[0] / pivot, border[1] / pivot];
            rest[0] -= scaled[0] * border[0];
            rest[1] -= scaled[0] * border[1];
            rest[2] -= scaled[1] * border[1];
            let passed = |to: [f64; 2], by: f64| [to[0] - by * scaled[0], to[1] - by * scaled[1]];
            (border, border_next) = (passed(border_next, beside), passed([0.0; 2], beyond));
        }
        here = next - beside * (beside / pivot);
        between = -beside * (beyond / pivot);
        next = -beyond * (beyond / pivot);
    }
    !cyclic || (rest[0] > 0.0 && rest[2] - rest[1] * (rest[1] / rest[0]) > 0.0)
}

/// The largest λ with `A u = λ diag(w) u`, to a relative 1e-12.
///
/// By bisection on "λ diag(w) − A is positive definite", O(n p²) a test, about fifty tests. `w` has one
/// number a row, all above zero; otherwise the answer is NaN.
#[must_use]
pub fn largest_eigenvalue(a: &Band, w: &[f64]) -> f64 {
    let Some((radius, low)) = bracket(a, w, 1.0) else {
        return f64::NAN;
    };
    bisect(low, radius, radius, |lambda| {
        a.is_positive(|d, i| lambda * w[i] - d, -1.0)
    })
}

/// The smallest λ with `A u = λ diag(w) u`, to 1e-12 of itself or 1e-15 of the largest.
///
/// By bisection on "A − λ diag(w) is positive definite", O(n p²) a test, about fifty tests. `w` has one
/// number a row, all above zero; otherwise the answer is NaN.
#[must_use]
pub fn smallest_eigenvalue(a: &Band, w: &[f64]) -> f64 {
    let Some((radius, low)) = bracket(a, w, -1.0) else {
        return f64::NAN;
    };
    -bisect(low, radius, radius, |lambda| {
        a.is_positive(|d, i| d + lambda * w[i], 1.0)
    })
}

/// The radius of the spectrum by Gershgorin's discs of `W^-½ A W^-½`, and the largest diagonal
/// element of `sign · W⁻¹ A`, which the largest eigenvalue of `sign · A` cannot be below.
fn bracket(a: &Band, w: &[f64], sign: f64) -> Option<(f64, f64)> {
    let n = a.len();
    debug_assert_eq!(w.len(), n, "one weight a row");
    if w.len() != n || !w.iter().all(|&w| w > 0.0 && w.is_finite()) {
        return None;
    }
    let root: Vec<f64> = w.iter().map(|w| w.sqrt()).collect();
    let (mut radius, mut low) = (0.0_f64, f64::NEG_INFINITY);
    for i in 0..n {
        let off = |value: f64, j: usize| value.abs() / (root[i] * root[j]);
        let mut row = a.diagonal()[i].abs() / w[i];
        for k in 1..=a.half_width() {
            let back = (i + n - k) % n;
            row += off(a.beside(i, k), (i + k) % n);
            row += off(a.beside(back, k), back);
        }
        if !row.is_finite() {
            return None;
        }
        radius = radius.max(row);
        low = low.max(sign * a.diagonal()[i] / w[i]);
    }
    // the discs are computed with rounding, and a bound must stay one
    Some((radius * (1.0 + 1e-14), low))
}

/// The border between "not above" and "above" in `low..=high`.
fn bisect(mut low: f64, mut high: f64, scale: f64, above: impl Fn(f64) -> bool) -> f64 {
    // a pivot's sign is decided by rounding within some units of the last place of the scale
    while high - low > (2.0 * f64::EPSILON * low.abs().max(high.abs())).max(1e-16 * scale) {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            break;
        }
        if above(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    low + 0.5 * (high - low)
}
