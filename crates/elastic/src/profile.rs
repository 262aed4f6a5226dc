//! A parameter along the curve: one number, or one a node.
//!
//! In the theory ω(s), μ(s) and γ(s) are functions. [`Profile`] is what they become at the nodes. It
//! knows no interpolation: resampling a curve with a profile is the caller's affair.

use crate::ElasticError;
use std::fmt;

/// A parameter along the curve.
#[derive(Debug, Clone, PartialEq)]
pub enum Profile {
    /// The same everywhere.
    Uniform(f64),
    /// One value a node.
    PerNode(Vec<f64>),
}

/// The range a parameter must lie in, beside being finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bound {
    /// This much or more: a tension may be 0.
    AtLeast(f64),
    /// More than this: a mass may not be 0.
    Above(f64),
}

impl Bound {
    /// Whether `value` is finite and in range.
    #[must_use]
    pub fn admits(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Self::AtLeast(least) => value >= least,
                Self::Above(floor) => value > floor,
            }
    }
}

impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::AtLeast(least) => write!(f, "finite and at least {least}"),
            Self::Above(floor) => write!(f, "finite and above {floor}"),
        }
    }
}

impl Profile {
    /// The value at node `i`. A uniform profile has one at every node.
    ///
    /// # Panics
    ///
    /// If there is no such node; [`validate`](Self::validate) has seen to it that there is.
    #[must_use]
    pub fn at(&self, i: usize) -> f64 {
        match self {
            Self::Uniform(value) => *value,
            Self::PerNode(values) => values[i],
        }
    }

    /// Refuses a profile that does not fit `n` nodes, or has a value out of bounds; `name` is the
    /// user's own word for the parameter.
    ///
    /// ```
    /// use elastic::{Bound, Profile};
    ///
    /// let damping = Profile::PerNode(vec![1.0, -2.0, 1.0]);
    /// let refused = damping.validate("damping", 3, Bound::AtLeast(0.0)).unwrap_err();
    /// assert_eq!(refused.to_string(), "damping must be finite and at least 0, got -2 at node 1");
    /// ```
    ///
    /// # Errors
    ///
    /// [`ElasticError::WrongLength`] or [`ElasticError::BadParameter`].
    pub fn validate(&self, name: &'static str, n: usize, bound: Bound) -> Result<(), ElasticError> {
        match self {
            Self::Uniform(value) => {
                if bound.admits(*value) {
                    return Ok(());
                }
                Err(ElasticError::BadParameter {
                    name,
                    node: None,
                    value: *value,
                    bound,
                })
            }
            Self::PerNode(values) => {
                if values.len() != n {
                    let got = values.len();
                    return Err(ElasticError::WrongLength {
                        name,
                        needed: n,
                        got,
                    });
                }
                values
                    .iter()
                    .position(|&v| !bound.admits(v))
                    .map_or(Ok(()), |i| {
                        let value = values[i];
                        Err(ElasticError::BadParameter {
                            name,
                            node: Some(i),
                            value,
                            bound,
                        })
                    })
            }
        }
    }

    /// One value for each of `n` nodes.
    #[must_use]
    pub fn to_vec(&self, n: usize) -> Vec<f64> {
        (0..n).map(|i| self.at(i)).collect()
    }

    /// Every value times `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        match self {
            Self::Uniform(value) => Self::Uniform(value * factor),
            Self::PerNode(values) => Self::PerNode(values.iter().map(|v| v * factor).collect()),
        }
    }

    /// Whether it is one number by construction (equal values at all nodes do not count).
    #[must_use]
    pub const fn is_uniform(&self) -> bool {
        matches!(self, Self::Uniform(_))
    }

    /// The same with node `i` of `n` set to `value`.
    #[must_use]
    pub fn with(&self, i: usize, n: usize, value: f64) -> Self {
        let mut values = self.to_vec(n);
        values[i] = value;
        Self::PerNode(values)
    }
}

impl From<f64> for Profile {
    fn from(value: f64) -> Self {
        Self::Uniform(value)
    }
}

impl From<Vec<f64>> for Profile {
    fn from(values: Vec<f64>) -> Self {
        Self::PerNode(values)
    }
}

/// A profile read without a branch: a uniform one is a slice of one value, met at every index.
#[derive(Clone, Copy)]
pub(crate) struct Lane<'a> {
    values: &'a [f64],
    mask: usize,
}

impl<'a> Lane<'a> {
    pub(crate) const fn new(profile: &'a Profile) -> Self {
        match profile {
            Profile::Uniform(value) => Self {
                values: std::slice::from_ref(value),
                mask: 0,
            },
            Profile::PerNode(values) => Self {
                values: values.as_slice(),
                mask: usize::MAX,
            },
        }
    }

    #[inline(always)]
    pub(crate) const fn at(self, i: usize) -> f64 {
        self.values[i & self.mask]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_profile_of_the_wrong_length_is_refused_with_both_lengths() {
        let refused = Profile::from(vec![1.0; 4]).validate("tension", 6, Bound::AtLeast(0.0));
        assert_eq!(
            refused,
            Err(ElasticError::WrongLength {
                name: "tension",
                needed: 6,
                got: 4
            })
        );
    }

    #[test]
    fn values_that_are_not_numbers_or_out_of_bounds_are_refused_by_node() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1e-300] {
            let uniform = Profile::Uniform(bad).validate("mass", 2, Bound::AtLeast(0.0));
            assert!(
                matches!(uniform, Err(ElasticError::BadParameter { node: None, .. })),
                "{bad}"
            );
            let one = Profile::from(vec![1.0, bad]).validate("mass", 2, Bound::AtLeast(0.0));
            assert!(
                matches!(one, Err(ElasticError::BadParameter { node: Some(1), .. })),
                "{bad}"
            );
        }
    }

    #[test]
    fn zero_is_at_least_zero_but_not_above_it() {
        assert!(Bound::AtLeast(0.0).admits(0.0));
        assert!(!Bound::Above(0.0).admits(0.0));
        let refused = Profile::Uniform(0.0)
            .validate("mass", 3, Bound::Above(0.0))
            .unwrap_err();
        assert_eq!(
            refused.to_string(),
            "mass must be finite and above 0, got 0"
        );
    }

    #[test]
    fn one_node_can_be_set_apart() {
        assert_eq!(
            Profile::Uniform(2.0).with(1, 3, 0.0),
            Profile::from(vec![2.0, 0.0, 2.0])
        );
        assert_eq!(
            Profile::from(vec![1.0, 3.0]).scaled(2.0),
            Profile::from(vec![2.0, 6.0])
        );
    }
}
