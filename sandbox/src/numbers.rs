//! Sums of many numbers in one.

use crate::real;

/// The least of several; infinite of none.
pub fn least(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(f64::INFINITY, f64::min)
}

/// The largest of several; minus infinity of none.
pub fn most(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(f64::NEG_INFINITY, f64::max)
}

/// The mean of several.
pub fn mean(values: impl IntoIterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    for value in values {
        sum += value;
        count += 1;
    }
    sum / real(count)
}

/// Yes or no as one or zero.
#[must_use]
pub fn flag(yes: bool) -> f64 {
    f64::from(u8::from(yes))
}

/// Least and largest of finite values, a little room added.
pub fn range(values: impl IntoIterator<Item = f64>, room: f64) -> (f64, f64) {
    let values = values.into_iter().filter(|value| value.is_finite());
    let ends = (f64::INFINITY, f64::NEG_INFINITY);
    let (low, high) = values.fold(ends, |(a, b), v| (a.min(v), b.max(v)));
    let span = (high - low).max(1e-12);
    (low - room * span, high + room * span)
}
