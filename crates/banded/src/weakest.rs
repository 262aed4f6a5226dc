//! How near a factored matrix is to a singular one.
//!
//! Pivots do not say: a matrix can be singular to the last digit with every pivot far from zero.
//! What does is a solve: a direction as weak as rounding outgrows all others at once.

use crate::scalar::Entry;

/// Reciprocal condition numbers below this are rounding: 32 units in the last place.
pub(crate) const SINGULAR: f64 = 32.0 * f64::EPSILON;

/// What two inverse iterations say about a matrix.
pub(crate) struct Weakest {
    /// The row that moves most in the weakest direction.
    pub(crate) row: usize,
    /// `1 / (‖A‖ ‖A⁻¹‖)`, estimated.
    pub(crate) reciprocal_condition: f64,
    /// `‖b − A x‖ / (‖A‖ ‖x‖)` of the last of them.
    pub(crate) backward_error: f64,
}

/// Two inverse iterations, from numbers without a pattern.
///
/// `row(i, x)` is row `i` times `x`, and the sum of the row's magnitudes.
pub(crate) fn weakest<E: Entry>(
    n: usize,
    solve: impl Fn(&mut [E]),
    row: impl Fn(usize, &[E]) -> (E, f64),
) -> Weakest {
    // Weyl's sequence: evenly spread in −½..½, in step with no wave of the band
    let mut turn = 0.0_f64;
    let mut b: Vec<E> = Vec::with_capacity(n);
    for _ in 0..n {
        turn = (turn + 0.618_033_988_749_894_9).fract();
        b.push(E::real(turn - 0.5));
    }
    let norm = |x: &[E]| x.iter().map(|x| x.size() * x.size()).sum::<f64>().sqrt();
    let mut x = b.clone();
    let mut smallest = f64::INFINITY;
    for _ in 0..2 {
        b.copy_from_slice(&x);
        let scale = E::real(1.0 / norm(&b));
        b.iter_mut().for_each(|b| *b = *b * scale);
        x.copy_from_slice(&b);
        solve(&mut x);
        smallest = smallest.min(1.0 / norm(&x));
    }
    let (mut moved, mut largest, mut rest, mut size) = (0, 0.0, 0.0_f64, 0.0_f64);
    for i in 0..x.len() {
        if x[i].size() > largest {
            (moved, largest) = (i, x[i].size());
        }
        let (product, sum) = row(i, &x);
        rest = rest.max((b[i] - product).size());
        size = size.max(sum);
    }
    Weakest {
        row: moved,
        reciprocal_condition: smallest / size,
        backward_error: rest / (size * largest),
    }
}
