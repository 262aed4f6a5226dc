//! What a deformation costs: the elastic densities (report §3.4.1, and §2.4 for those above the second order).
//!
//! The densities are per arc length, so that a curve keeps its behaviour when it gets more nodes. They
//! cannot depend on the deformation. Plastic flow changes the rest shape, not the material (`snake::Plastic`).

use crate::kernel::NAMES;
use crate::{Bound, ElasticError, Kernel, Profile};

/// The elastic densities along a curve. Dimensions with M the unit of mass density.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// ω₀: pulls each node towards its place in the rest shape. M T⁻².
    #[doc(alias = "w0")]
    pub tether: Profile,
    /// ω₁: resists stretching, like a membrane; `tension[i]` acts on the edge from node i to i+1. M L² T⁻².
    ///
    /// The last value of an open curve acts only beyond an [anchored](crate::End::Anchored) tail.
    #[doc(alias = "w1")]
    #[doc(alias = "alpha")]
    pub tension: Profile,
    /// ω₂: resists bending, like a thin plate; `rigidity[i]` acts on the bend at node i. M L⁴ T⁻².
    ///
    /// The first and last value of an open curve act only if that end is [anchored](crate::End::Anchored) or
    /// [clamped](crate::End::Clamped).
    #[doc(alias = "w2")]
    #[doc(alias = "beta")]
    pub rigidity: Profile,
    /// ω₃, ω₄, … ωₚ: the orders above the second, if any; ωₘ has the dimension M L²ᵐ T⁻².
    ///
    /// The third derivative resists a change of bending, the fourth a change of that. A value at node i acts on the difference
    /// of order m whose middle is node i (even m), or the edge from node i to i+1 (odd m). None are the report's
    /// program, and quicker. [`Kernel`] has them all in one row.
    pub higher: Vec<Profile>,
}

impl Material {
    /// The same ω₀, ω₁, ω₂ at every node.
    #[must_use]
    pub const fn uniform(tether: f64, tension: f64, rigidity: f64) -> Self {
        Self {
            tether: Profile::Uniform(tether),
            tension: Profile::Uniform(tension),
            rigidity: Profile::Uniform(rigidity),
            higher: Vec::new(),
        }
    }

    /// The same with the weights of the orders 3, 4 and on.
    #[must_use]
    pub fn with_higher(mut self, weights: Vec<Profile>) -> Self {
        self.higher = weights;
        self
    }

    /// The order p: 2, or that of the last weight above.
    #[must_use]
    pub const fn order(&self) -> usize {
        2 + self.higher.len()
    }

    /// Refuses densities that do not fit `n` nodes, are negative, infinite or not a number.
    ///
    /// # Errors
    ///
    /// [`ElasticError::WrongLength`] or [`ElasticError::BadParameter`], with the name of the density;
    /// [`ElasticError::BadOrder`] above order [`Kernel::HIGHEST`].
    pub fn validate(&self, n: usize) -> Result<(), ElasticError> {
        if self.order() > Kernel::HIGHEST {
            return Err(ElasticError::BadOrder {
                highest: Kernel::HIGHEST,
                weights: self.order() + 1,
            });
        }
        for (name, profile) in self.densities() {
            profile.validate(name, n, Bound::AtLeast(0.0))?;
        }
        Ok(())
    }

    /// Whether all are the same everywhere.
    #[must_use]
    pub fn is_uniform(&self) -> bool {
        self.densities().all(|(_, profile)| profile.is_uniform())
    }

    /// ω₀, ω₁, ω₂ where these three are the same everywhere.
    pub(crate) const fn uniform_densities(&self) -> Option<[f64; 3]> {
        match (&self.tether, &self.tension, &self.rigidity) {
            (Profile::Uniform(w0), Profile::Uniform(w1), Profile::Uniform(w2)) => {
                Some([*w0, *w1, *w2])
            }
            _ => None,
        }
    }

    /// A corner at node `i` of `n`: no rigidity there, so a kink costs nothing.
    ///
    /// Of the orders above the second those differences weigh nothing that have the node inside.
    ///
    /// Report §3.4.1: ω₂(s₀) = 0 permits a tangent discontinuity.
    ///
    /// # Errors
    ///
    /// As [`validate`](Self::validate); [`ElasticError::TooFewNodes`] if there is no node `i`.
    pub fn with_corner(&self, i: usize, n: usize) -> Result<Self, ElasticError> {
        self.validate(n)?;
        has_node(i, n)?;
        Ok(Self {
            rigidity: self.rigidity.with(i, n, 0.0),
            higher: self.higher_without(i, 0, n),
            ..self.clone()
        })
    }

    /// A break after node `i` of `n`: nothing holds its two sides together, so a jump costs nothing.
    ///
    /// The edge from i to i+1 loses its tension, the two bends that reach over it their rigidity, and so do the
    /// differences of higher orders.
    /// In a closed curve node 0 follows the last; in an open one a break after the last node frees an
    /// anchored tail only in part, and is better said by [`End::Free`](crate::End::Free).
    ///
    /// Report §3.4.1: ω₁(s₀) = ω₂(s₀) = 0 permits a position discontinuity. One node of ω₂ = 0 is not
    /// enough: the bend at each side of the gap has an arm across it.
    ///
    /// # Errors
    ///
    /// As [`validate`](Self::validate); [`ElasticError::TooFewNodes`] if there is no node `i`.
    pub fn with_break(&self, i: usize, n: usize) -> Result<Self, ElasticError> {
        self.validate(n)?;
        has_node(i, n)?;
        Ok(Self {
            tether: self.tether.clone(),
            tension: self.tension.with(i, n, 0.0),
            rigidity: self.rigidity.with(i, n, 0.0).with((i + 1) % n, n, 0.0),
            higher: self.higher_without(i, 1, n),
        })
    }

    /// ω₃ … ωₚ without the differences that reach over node `i`, or with `beyond` 1 over the edge after it.
    fn higher_without(&self, i: usize, beyond: usize, n: usize) -> Vec<Profile> {
        let each = (3..).zip(&self.higher);
        each.map(|(m, profile)| {
            // by the last node of each; its middle says which weight it takes
            (i + 1..i + m + beyond).fold(profile.clone(), |profile, last| {
                profile.with((last + m * n - m + m / 2) % n, n, 0.0)
            })
        })
        .collect()
    }

    fn densities(&self) -> impl Iterator<Item = (&'static str, &Profile)> {
        let lower = [
            ("tether", &self.tether),
            ("tension", &self.tension),
            ("rigidity", &self.rigidity),
        ];
        let higher = NAMES.into_iter().skip(3).zip(&self.higher);
        lower.into_iter().chain(higher)
    }
}

const fn has_node(i: usize, n: usize) -> Result<(), ElasticError> {
    if i < n {
        Ok(())
    } else {
        Err(ElasticError::TooFewNodes {
            needed: i + 1,
            got: n,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bad_density_is_refused_by_its_name() {
        let mut material = Material::uniform(0.0, 1.0, -3.0);
        assert_eq!(
            material.validate(5).unwrap_err().to_string(),
            "rigidity must be finite and at least 0, got -3"
        );
        material.rigidity = vec![1.0; 4].into();
        assert_eq!(
            material.validate(5).unwrap_err().to_string(),
            "rigidity must have one value for each of the 5 nodes, got 4"
        );
        material = Material::uniform(f64::NAN, 1.0, 1.0);
        assert!(
            material
                .validate(5)
                .unwrap_err()
                .to_string()
                .starts_with("tether must be finite")
        );
    }

    #[test]
    fn a_corner_takes_one_rigidity_and_a_break_one_tension_and_two() {
        let plain = Material::uniform(1.0, 2.0, 3.0);
        let corner = plain.with_corner(2, 5).unwrap();
        assert_eq!(corner.rigidity, vec![3.0, 3.0, 0.0, 3.0, 3.0].into());
        assert_eq!(corner.tension, plain.tension);
        let broken = plain.with_break(4, 5).unwrap();
        assert_eq!(broken.tension, vec![2.0, 2.0, 2.0, 2.0, 0.0].into());
        assert_eq!(broken.rigidity, vec![0.0, 3.0, 3.0, 3.0, 0.0].into());
        assert_eq!(
            plain.with_corner(5, 5),
            Err(ElasticError::TooFewNodes { needed: 6, got: 5 })
        );
    }
}
