//! Controlled-continuity splines of any order: the general elastic energy of report §2.4.
//!
//! [`Material`] stops at the second derivative, as the report's program does, and is the quick way there. The third
//! derivative resists a change of bending, the fourth a change of that: a curve with ω₃ springs back
//! with rounder bumps, and pins its neighbours' curvature where ω₂ pins their direction.
//!
//! Here are the weights, what is checked of them, and K; force and energy are in `kernel_walk`. Ends that are clamped
//! it does not know: what else must vanish there depends on the order.

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

/// One row of a difference of order m: its first node, and the number of its weight.
pub(crate) struct Row {
    pub(crate) exists: bool,
    pub(crate) weight: usize,
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

    /// The same as a [`Material`], which is quicker; none above order 2.
    #[must_use]
    pub fn to_material(&self) -> Option<Material> {
        let weight = |m: usize| self.weights.get(m).cloned().unwrap_or(0.0.into());
        (self.order() <= 2).then(|| Material {
            tether: weight(0),
            tension: weight(1),
            rigidity: weight(2),
        })
    }

    /// The door: what it lets through, [`force`](Self::force), [`energy`](Self::energy) and
    /// [`bound`](Self::bound) trust.
    ///
    /// # Errors
    ///
    /// No weights, more than up to order [`HIGHEST`](Self::HIGHEST), too few nodes, weights that do not fit or are
    /// negative or not finite, clamped ends, a spacing that cannot be divided by, a K that is not finite.
    pub fn validate(&self, topology: Topology, spacing: f64, n: usize) -> Result<(), ElasticError> {
        const NAMES: [&str; Kernel::HIGHEST + 1] = [
            "the weight of order 0",
            "the weight of order 1",
            "the weight of order 2",
            "the weight of order 3",
            "the weight of order 4",
            "the weight of order 5",
            "the weight of order 6",
        ];
        if self.weights.is_empty() || self.order() > Self::HIGHEST {
            return Err(ElasticError::BadOrder {
                highest: Self::HIGHEST,
                weights: self.weights.len(),
            });
        }
        if let Topology::Open { head, tail } = topology
            && (head == End::Clamped || tail == End::Clamped)
        {
            return Err(ElasticError::ClampedKernel);
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
    /// `n` × `n`, cyclic if closed; `P` at least the order, and 1 at least. Symmetric and never negative, being
    /// assembled from the differences that exist. O(n p²). Pinned ends are not masked here.
    ///
    /// # Errors
    ///
    /// As [`validate`](Self::validate); a `P` below the order; fewer nodes than a band of `P` needs.
    pub fn stiffness<const P: usize>(
        &self,
        topology: Topology,
        spacing: f64,
        n: usize,
    ) -> Result<Banded<P>, ElasticError> {
        self.validate(topology, spacing, n)?;
        if self.order() > P {
            return Err(ElasticError::BadOrder {
                highest: P,
                weights: self.weights.len(),
            });
        }
        let mut k = Banded::new(n, topology.is_closed())?;
        let mut coefficients = vec![1.0];
        let mut row = Vec::with_capacity(P + 1);
        for (m, weight) in self.weights.iter().enumerate() {
            let per = power(spacing, m);
            let rows = n + m; // from m before node 0 on
            for at in 0..rows {
                let Row {
                    exists,
                    weight: index,
                } = topology.row(m, at, n);
                if exists && !(topology.is_closed() && at < m) {
                    row.clear();
                    for (j, &c) in coefficients.iter().enumerate() {
                        let node = at + j;
                        if topology.is_closed() {
                            row.push(((node + n - m) % n, c));
                        } else if (m..m + n).contains(&node) {
                            row.push((node - m, c));
                        }
                    }
                    k.add_outer(weight.at(index) * per, &row);
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
    /// The same three weights, order 2.
    fn from(material: &Material) -> Self {
        Self {
            weights: vec![
                material.tether.clone(),
                material.tension.clone(),
                material.rigidity.clone(),
            ],
        }
    }
}

impl Topology {
    /// Whether the difference of order `m` that begins at node `at − m` exists, and which weight it takes.
    ///
    /// Free ends: where all its nodes are real. Anchored: where at least one is.
    pub(crate) fn row(self, m: usize, at: usize, n: usize) -> Row {
        let middle = at + m / 2;
        match self {
            Self::Closed => Row {
                exists: true,
                weight: (middle + n - m % n) % n,
            },
            Self::Open { head, tail } => Row {
                exists: (head == End::Anchored || at >= m)
                    && (at < n || tail == End::Anchored && at < n + m),
                weight: middle.saturating_sub(m).min(n - 1),
            },
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
            "a kernel has weights of the orders 0 to at most 6, so 1 to 7 of them, got 0"
        );
        assert_eq!(
            words(Kernel::uniform(&[1.0; 8]), FREE, 1.0, 9),
            "a kernel has weights of the orders 0 to at most 6, so 1 to 7 of them, got 8"
        );
        assert_eq!(
            words(third(), Topology::Closed, 1.0, 6),
            "a curve with these ends needs at least 7 nodes, got 6"
        );
        assert_eq!(
            words(Kernel::uniform(&[1.0, 1.0, 1.0, -2.0]), FREE, 1.0, 9),
            "the weight of order 3 must be finite and at least 0, got -2"
        );
        assert_eq!(
            words(third(), Topology::open(End::Clamped), 1.0, 9),
            "the ends of a kernel cannot be clamped; a material of order 2 can"
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
        let narrow = third().stiffness::<2>(FREE, 1.0, 9).unwrap_err();
        assert_eq!(
            narrow.to_string(),
            "a kernel has weights of the orders 0 to at most 2, so 1 to 3 of them, got 4"
        );
    }

    #[test]
    fn a_material_is_a_kernel_of_order_two_and_back() {
        let material = Material::uniform(1.0, 2.0, 3.0).with_corner(1, 4).unwrap();
        assert_eq!(Kernel::from(&material).to_material(), Some(material));
        assert_eq!(
            Kernel::uniform(&[5.0]).to_material(),
            Some(Material::uniform(5.0, 0.0, 0.0))
        );
        assert_eq!(Kernel::uniform(&[0.0; 4]).to_material(), None);
    }
}
