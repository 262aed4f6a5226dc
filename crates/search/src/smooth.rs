//! Values along a curve, smoothed.

use glam::DVec2;

/// What is smoothed: numbers, or points.
pub trait Value: Copy {
    /// Its coordinates, one after the other.
    const SIZE: usize;
    /// Values as their coordinates.
    fn flat(values: &[Self]) -> &[f64];
    /// See [`Self::flat`].
    fn flat_mut(values: &mut [Self]) -> &mut [f64];
}

impl Value for f64 {
    const SIZE: usize = 1;

    fn flat(values: &[Self]) -> &[f64] {
        values
    }

    fn flat_mut(values: &mut [Self]) -> &mut [f64] {
        values
    }
}

impl Value for DVec2 {
    const SIZE: usize = 2;

    fn flat(values: &[Self]) -> &[f64] {
        lanes::flat(values)
    }

    fn flat_mut(values: &mut [Self]) -> &mut [f64] {
        lanes::flat_mut(values)
    }
}

/// Values along a curve, smoothed by a Gaussian of so many nodes; at open ends the last is repeated.
#[must_use]
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a few times the number of nodes at most"
)]
pub fn smoothed<T: Value>(values: &[T], sigma: f64, closed: bool) -> Vec<T> {
    let n = values.len();
    if n == 0 || sigma < 0.1 {
        return values.to_vec();
    }
    let reach = (3.0 * sigma)
        .ceil()
        .min(if closed { n as f64 / 2.0 } else { n as f64 }) as usize;
    let weights: Vec<f64> = (0..=reach)
        .map(|k| (-0.5 * (k as f64 / sigma).powi(2)).exp())
        .collect();
    let total = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
    // the values again on either side, so that no index needs to be brought back into range
    let at = |i: isize| {
        let last = n.cast_signed() - 1;
        let i = if closed {
            i.rem_euclid(last + 1)
        } else {
            i.clamp(0, last)
        };
        values[i.unsigned_abs()]
    };
    let mut wide = Vec::with_capacity(n + 2 * reach);
    wide.extend((-reach.cast_signed()..0).map(at));
    wide.extend_from_slice(values);
    wide.extend((n.cast_signed()..(n + reach).cast_signed()).map(at));
    let mut smooth = values.to_vec();
    folded(T::flat(&wide), T::SIZE, &weights, T::flat_mut(&mut smooth));
    for number in T::flat_mut(&mut smooth) {
        *number *= total.recip();
    }
    smooth
}

/// Numbers that are worked on at once.
const LANES: usize = 16;

lanes::wide! {
    /// Sums of numbers and their neighbours on either side, `stride` numbers from each other, times weights: the first
    /// for the number itself. `wide` has as many neighbours more on either side as there are.
    pub(crate) fn folded(wide: &[f64], stride: usize, weights: &[f64], sums: &mut [f64]) {
        let own = stride * (weights.len() - 1);
        let (blocks, rest) = sums.as_chunks_mut::<LANES>();
        for (block, at) in blocks.iter_mut().zip((own..).step_by(LANES)) {
            let mut sum = [0.0; LANES];
            for (sum, number) in sum.iter_mut().zip(&wide[at..at + LANES]) {
                *sum = number * weights[0];
            }
            for (k, weight) in weights.iter().enumerate().skip(1) {
                let (before, after) = (at - k * stride, at + k * stride);
                let both = wide[before..before + LANES].iter().zip(&wide[after..after + LANES]);
                for (sum, (a, b)) in sum.iter_mut().zip(both) {
                    *sum += (a + b) * weight;
                }
            }
            *block = sum;
        }
        let first = own + blocks.len() * LANES;
        for (sum, at) in rest.iter_mut().zip(first..) {
            *sum = wide[at] * weights[0];
            for (k, weight) in weights.iter().enumerate().skip(1) {
                *sum += (wide[at - k * stride] + wide[at + k * stride]) * weight;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The definition, one value after the other.
    #[allow(clippy::cast_possible_truncation, reason = "a few hundred at most")]
    fn slow(values: &[f64], sigma: f64, closed: bool) -> Vec<f64> {
        let n = values.len().cast_signed() as i32;
        let cap = if closed { n / 2 } else { n };
        let reach = ((3.0 * sigma).ceil() as i32).min(cap);
        let weight = |k: i32| (-0.5 * (f64::from(k) / sigma).powi(2)).exp();
        let at = |i: i32| {
            let i = if closed {
                i.rem_euclid(n)
            } else {
                i.clamp(0, n - 1)
            };
            values[i.unsigned_abs() as usize]
        };
        let total: f64 = (-reach..=reach).map(weight).sum();
        (0..n)
            .map(|i| (-reach..=reach).map(|k| weight(k) * at(i + k)).sum::<f64>() / total)
            .collect()
    }

    #[test]
    fn smoothed_values_are_means_of_their_neighbours() {
        for n in [1, 2, 5, 16, 47, 160] {
            let values: Vec<f64> = (0..n).map(|i| (0.7 * f64::from(i * i)).sin()).collect();
            let points: Vec<DVec2> = values.iter().map(|v| DVec2::new(*v, 2.0 - v)).collect();
            for (sigma, closed) in [
                (0.5, true),
                (4.0, true),
                (40.0, true),
                (3.0, false),
                (60.0, false),
            ] {
                let found = smoothed(&values, sigma, closed);
                let both = smoothed(&points, sigma, closed);
                for ((found, p), wanted) in
                    found.iter().zip(&both).zip(slow(&values, sigma, closed))
                {
                    assert!(
                        (found - wanted).abs() < 1e-13,
                        "{n} {sigma}: {found} for {wanted}"
                    );
                    assert!((p.x - wanted).abs() < 1e-13 && (p.y - 2.0 + wanted).abs() < 1e-12);
                }
            }
        }
    }
}
