//! Controlled-continuity splines of any order: the general elastic energy of report §2.4.
//!
//! [`Material`] stops at the second derivative, as the report's program does, and is the quick way there. The third
//! derivative resists a change of bending, the fourth a change of that: a curve with ω₃ springs back
//! with rounder bumps, and pins its neighbours' curvature where ω₂ pins their direction.
//!
//! Here are the weights, what is checked of them, and K; force and energy are in `kernel_walk`. A [`Material`] with weights
//! above the second order comes here for them.

use crate::{Bound, ElasticError, End, Material, Profile, Topology};
use banded::Banded;

/// The weights ω₀ … ωₚ of a controlled-continuity spline, one for each derivative.
///
/// ```text
/// ξ(e) = ½ ∫ Σ ωₘ(s) |∂ᵐe/∂sᵐ|² ds,   m = 0 … p
/// δξ/δe = Σ (−1)ᵐ ∂ᵐ(ωₘ ∂ᵐe)
/// ```
///
/// ωₘ has the dimension M L²ᵐ T⁻². A value at node i acts on the difference of order m whose middle is node i
/// (even m), or the edge from node i to i+1 (odd m), as in [`Material`]; that makes the odd orders of a
/// *profile* first order in the spacing, and everything else inside the curve second order. With
/// p ≤ 2 it is the `Material` of the same weights to rounding, and slower.
///
/// ```
/// use elastic::{Kernel, Topology};
/// use glam::DVec2;
///
/// let third = Kernel::uniform(&[0.0, 0.0, 0.0, 1.0]);
/// third.validate(Topology::Closed, 1.0, 8)?;
/// let mut e = [DVec2::ZERO; 8];
/// e[3] = DVec2::X;
/// let mut force = [DVec2::ZERO; 8];
/// third.force(&e, Topology::Closed, 1.0, &mut force);
/// assert_eq!(force.map(|f| f.x), [1.0, -6.0, 15.0, -20.0, 15.0, -6.0, 1.0, 0.0]);
/// # Ok::<(), elastic::ElasticError>(())
/// ```
///
/// Report Eq. 2.6 to 2.9 with d = 1, `[terzopoulos86]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Kernel {
    /// ω₀, ω₁, … ωₚ.
    pub weights: Vec<Profile>,
}

/// What each weight is called in refusals.
pub(crate) const NAMES: [&str; Kernel::HIGHEST + 1] = [
    "the weight of order 0",
    "the weight of order 1",
    "the weight of order 2",
    "the weight of order 3",
    "the weight of order 4",
    "the weight of order 5",
    "the weight of order 6",
];

/// One row of a difference of order m.
pub(crate) struct Row {
    /// Which weight it takes.
    pub(crate) weight: usize,
    /// How much of a spacing it stands for: 0 where there is none, half where the other half is a mirror image.
    pub(crate) share: f64,
}

impl Kernel {
    /// The highest order: 2⁻⁵³ times 4⁶ is still a small number.
    pub const HIGHEST: usize = 6;

    /// The same weights at every node, from ω₀ on.
    #[must_use]
    pub fn uniform(weights: &[f64]) -> Self {
        Self {
            weights: weights.iter().map(|&w| Profile::Uniform(w)).collect(),
        }
    }

    /// The order p: of the highest derivative that has a weight.
    #[must_use]
    pub const fn order(&self) -> usize {
        self.weights.len().saturating_sub(1)
    }

    /// The least number of nodes: 2 p + 1 closed, p + 1 open.
    #[must_use]
    pub const fn least_nodes(&self, topology: Topology) -> usize {
        match topology {
            Topology::Closed => 2 * self.order() + 1,
            Topology::Open { .. } => self.order() + 1,
        }
    }

    /// The same as a [`Material`], whose orders up to 2 are quicker.
    #[must_use]
    pub fn to_material(&self) -> Material {
        let weight = |m: usize| self.weights.get(m).cloned().unwrap_or(0.0.into());
        Material {
            tether: weight(0),
            tension: weight(1),
            rigidity: weight(2),
            higher: self.weights.iter().skip(3).cloned().collect(),
        }
    }

    /// The door: what it lets through, [`force`](Self::force), [`energy`](Self::energy) and
    /// [`bound`](Self::bound) trust.
    ///
    /// # Errors
    ///
    /// No weights, more than up to order [`HIGHEST`](Self::HIGHEST), too few nodes, weights that do not fit or are
    /// negative or not finite, a spacing that cannot be divided by, a K that is not finite.
    pub fn validate(&self, topology: Topology, spacing: f64, n: usize) -> Result<(), ElasticError> {
        if self.weights.is_empty() || self.order() > Self::HIGHEST {
            return Err(ElasticError::BadOrder {
                highest: Self::HIGHEST,
                weights: self.weights.len(),
            });
        }
        let needed = self.least_nodes(topology);
        if n < needed {
            return Err(ElasticError::TooFewNodes { needed, got: n });
        }
        for (profile, name) in self.weights.iter().zip(NAMES) {
            profile.validate(name, n, Bound::AtLeast(0.0))?;
        }
        if !(spacing > 0.0 && (0..=self.order()).all(|m| power(spacing, m).is_normal())) {
            return Err(ElasticError::BadPower {
                spacing,
                power: 2 * self.order(),
            });
        }
        if self.bound(spacing).is_finite() {
            Ok(())
        } else {
            Err(ElasticError::TooStiff { spacing })
        }
    }

    /// No eigenvalue of K is above this, whatever the topology. M T⁻².
    ///
    /// ```text
    /// λ ≤ Σ max ωₘ (4/h²)ᵐ
    /// ```
    ///
    /// Reached by uniform weights on a ring of an even number of nodes.
    #[must_use]
    pub fn bound(&self, spacing: f64) -> f64 {
        let largest = |profile: &Profile| match profile {
            Profile::Uniform(w) => *w,
            Profile::PerNode(w) => w.iter().copied().fold(0.0, f64::max),
        };
        self.weights
            .iter()
            .enumerate()
            .map(|(m, w)| largest(w) * power(0.5 * spacing, m))
            .sum()
    }

    /// The stiffness matrix, a band of half width p: `−K e` is the force on the nodes.
    ///
    /// ```text
    /// K = Σ Dᵐᵀ ωₘ Dᵐ / h²ᵐ
    /// ```
    ///
    /// `n` × `n`, cyclic if closed, its half width 1 at least. Symmetric and never negative, being
    /// assembled from the differences that exist. O(n p²). Pinned and clamped ends are not masked here.
    ///
    /// # Errors
    ///
    /// As [`validate`](Self::validate); fewer than two nodes.
    pub fn stiffness(
        &self,
        topology: Topology,
        spacing: f64,
        n: usize,
    ) -> Result<Banded, ElasticError> {
        self.validate(topology, spacing, n)?;
        let mut k = Banded::new(n, self.order().max(1), topology.is_closed())?;
        let mut coefficients = vec![1.0];
        let mut row = Vec::with_capacity(self.order() + 1);
        for (m, weight) in self.weights.iter().enumerate() {
            let per = power(spacing, m);
            let rows = n + m; // from m before node 0 on
            for at in 0..rows {
                let Row { share, weight: own } = topology.row(m, at, n);
                if share > 0.0 && !(topology.is_closed() && at < m) {
                    row.clear();
                    for (j, &c) in coefficients.iter().enumerate() {
                        row.extend(topology.seen(at + j, m, n).map(|node| (node, c)));
                    }
                    k.add_outer(share * weight.at(own) * per, &row);
                }
            }
            // the next row of Pascal's triangle, with its signs: (1 − z)ᵐ
            coefficients.push(0.0);
            for j in (1..coefficients.len()).rev() {
                coefficients[j] -= coefficients[j - 1];
            }
        }
        Ok(k)
    }
}

impl From<&Material> for Kernel {
    /// The same weights.
    fn from(material: &Material) -> Self {
        let lower = [&material.tether, &material.tension, &material.rigidity];
        Self {
            weights: lower.into_iter().chain(&material.higher).cloned().collect(),
        }
    }
}

impl Topology {
    /// The difference of order `m` that begins at node `at − m`.
    ///
    /// Free ends: it exists where all its nodes are real. Anchored: where at least one is. Clamped: where no more than one
    /// lies beyond the end, the mirror image of the node before it, and the middle of the difference does not.
    pub(crate) fn row(self, m: usize, at: usize, n: usize) -> Row {
        let middle = at + m / 2;
        let Self::Open { head, tail } = self else {
            return Row {
                weight: (middle + n - m % n) % n,
                share: 1.0,
            };
        };
        let half = if m == 2 { 0.5 } else { 1.0 };
        // how far it reaches beyond an end
        let beyond = |end: End, over: usize| match (end, over) {
            (_, 0) => 1.0,
            (End::Anchored, over) if over <= m => 1.0,
            (End::Clamped, 1) if m >= 2 => half,
            _ => 0.0,
        };
        Row {
            weight: middle.saturating_sub(m).min(n - 1),
            share: beyond(head, m.saturating_sub(at)) * beyond(tail, (at + 1).saturating_sub(n)),
        }
    }

    /// Whose deformation stands at `place`, counted from `before` nodes before node 0; none: it is at rest.
    pub(crate) fn seen(self, place: usize, before: usize, n: usize) -> Option<usize> {
        match self {
            Self::Closed => Some((place + n - before % n) % n),
            Self::Open { .. } if (before..before + n).contains(&place) => Some(place - before),
            Self::Open { head, .. } if head == End::Clamped && place + 1 == before => Some(1),
            Self::Open { tail, .. } if tail == End::Clamped && place == before + n => Some(n - 2),
            Self::Open { .. } => None,
        }
    }
}

/// `1/h²ᵐ`.
pub(crate) fn power(spacing: f64, m: usize) -> f64 {
    let per_h2 = 1.0 / (spacing * spacing);
    (0..m).fold(1.0, |product, _| product * per_h2)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FREE: Topology = Topology::open(End::Free);

    #[test]
    fn what_is_no_kernel_is_refused_with_its_reason() {
        let words = |kernel: Kernel, topology, spacing, n| {
            let refused = kernel.validate(topology, spacing, n).unwrap_err();
            refused.to_string()
        };
        let third = || Kernel::uniform(&[1.0; 4]);
        assert_eq!(
            words(Kernel::uniform(&[]), FREE, 1.0, 9),
            "elasticity has weights of the orders 0 to at most 6, so 1 to 7 of them, got 0"
        );
        assert_eq!(
            words(Kernel::uniform(&[1.0; 8]), FREE, 1.0, 9),
            "elasticity has weights of the orders 0 to at most 6, so 1 to 7 of them, got 8"
        );
        assert_eq!(
            words(third(), Topology::Closed, 1.0, 6),
            "a curve with these ends needs at least 7 nodes, got 6"
        );
        assert_eq!(
            words(Kernel::uniform(&[1.0, 1.0, 1.0, -2.0]), FREE, 1.0, 9),
            "the weight of order 3 must be finite and at least 0, got -2"
        );
        for bad in [0.0, -1.0, 1e-60, 1e60, f64::NAN, f64::INFINITY] {
            assert!(
                words(third(), FREE, bad, 9)
                    .starts_with("1 over the spacing to the power 6 must be"),
                "{bad}"
            );
        }
        let stiff = Kernel::uniform(&[0.0, 0.0, 0.0, 1e300]);
        assert!(words(stiff, FREE, 1e-10, 9).starts_with("the densities are too large"));
    }

    #[test]
    fn a_material_is_a_kernel_of_order_two_and_back() {
        let material = Material::uniform(1.0, 2.0, 3.0).with_corner(1, 4).unwrap();
        assert_eq!(Kernel::from(&material).to_material(), material);
        assert_eq!(
            Kernel::uniform(&[5.0]).to_material(),
            Material::uniform(5.0, 0.0, 0.0)
        );
        assert_eq!(Kernel::uniform(&[0.0; 4]).to_material().order(), 3);
    }
}
