//! How far a number may move.

use crate::table::shortest;

/// How far a number may stray from the expected one before `figures --check` says it moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tolerance {
    /// At most so much, in the number's own unit. Zero: to the last digit.
    Absolute(f64),
    /// At most this share of the expected number.
    Relative(f64),
    /// As [`Tolerance::Relative`], and an infinite number is expected to be infinite: for times
    /// that may be "never".
    RelativeOrInfinite(f64),
}

/// For counts, yes and no.
pub const EXACT: f64 = 0.0;
/// For results of a few thousand operations: rounding, and the last bits of a foreign `sin`.
pub const ROUNDING: f64 = 1e-9;

/// At most this share of the expected number.
#[must_use]
pub const fn share(of: f64) -> Tolerance {
    Tolerance::Relative(of)
}

impl From<f64> for Tolerance {
    fn from(most: f64) -> Self {
        Self::Absolute(most)
    }
}

impl Tolerance {
    /// Whether `value` is close enough to `expected`. NaN is close to nothing; an infinite number
    /// only to itself, and only under [`Tolerance::RelativeOrInfinite`].
    #[must_use]
    pub fn allows(self, value: f64, expected: f64) -> bool {
        if !(value.is_finite() && expected.is_finite()) {
            return matches!(self, Self::RelativeOrInfinite(_))
                && value.is_infinite()
                && expected.is_infinite()
                && value.is_sign_positive() == expected.is_sign_positive();
        }
        let distance = (value - expected).abs();
        match self {
            Self::Absolute(most) => distance <= most,
            Self::Relative(share) | Self::RelativeOrInfinite(share) => {
                distance <= share * expected.abs()
            }
        }
    }

    /// How far from `expected` it lets a number be.
    #[must_use]
    pub fn width(self, expected: f64) -> f64 {
        match self {
            Self::Absolute(most) => most,
            Self::Relative(share) | Self::RelativeOrInfinite(share) => share * expected.abs(),
        }
    }
}

impl std::fmt::Display for Tolerance {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Absolute(most) => write!(f, "{}", shortest(*most)),
            Self::Relative(share) => write!(f, "{} of it", shortest(*share)),
            Self::RelativeOrInfinite(share) => {
                write!(f, "{} of it or infinite", shortest(*share))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_measure_as_they_say() {
        assert!(Tolerance::Absolute(0.1).allows(1.05, 1.0));
        assert!(!Tolerance::Absolute(0.1).allows(1.2, 1.0));
        assert!(Tolerance::Relative(0.1).allows(109.0, 100.0));
        assert!(!Tolerance::from(EXACT).allows(1.0 + f64::EPSILON, 1.0));
        assert!(!Tolerance::Absolute(1.0).allows(f64::INFINITY, 1.0));
    }

    #[test]
    fn what_is_not_finite_is_not_silently_the_same() {
        let never = f64::INFINITY;
        for tolerance in [
            Tolerance::from(EXACT),
            Tolerance::Absolute(1.0),
            Tolerance::Relative(1.0),
            Tolerance::RelativeOrInfinite(1.0),
        ] {
            let finds_nan = !tolerance.allows(f64::NAN, f64::NAN)
                && !tolerance.allows(1.0, f64::NAN)
                && !tolerance.allows(f64::NAN, 1.0);
            assert!(finds_nan, "{tolerance}");
            let said = matches!(tolerance, Tolerance::RelativeOrInfinite(_));
            assert_eq!(tolerance.allows(never, never), said, "{tolerance}");
            assert!(!tolerance.allows(never, 1.0) && !tolerance.allows(1.0, never));
            assert!(!tolerance.allows(never, -never));
        }
    }
}
