//! The elastic energy, term by term.

use crate::{Material, Topology};
use glam::DVec2;

/// The elastic energy of a deformation, one number a term. M L³ T⁻².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElasticEnergy {
    /// ½ ∫ ω₀ |e|² ds.
    pub tether: f64,
    /// ½ ∫ ω₁ |∂e/∂s|² ds.
    pub tension: f64,
    /// ½ ∫ ω₂ |∂²e/∂s²|² ds.
    pub rigidity: f64,
}

impl ElasticEnergy {
    /// The three together.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.tether + self.tension + self.rigidity
    }
}

/// Elastic energy of a deformation: what it cost to bring the curve there.
///
/// ```text
/// ξ = ½ h ( Σ ω₀[i] |e[i]|²  +  Σ ω₁[i] |e[i+1] − e[i]|² / h²  +  Σ ω₂[i] |e[i+1] − 2 e[i] + e[i−1]|² / h⁴ )
/// ```
///
/// over nodes, edges and bends that exist. `e` holds one deformation a node. An integral over arc
/// length, so that it does not depend on the number of nodes beyond the error of the differences (second
/// order closed; an end node of an open curve counts for a whole `h`, which is first order). O(n).
///
/// The arguments are trusted: they are what [`stiffness`](crate::stiffness) would accept.
///
/// Report Eq. 2.5 and 2.6 with p = 2.
#[must_use]
pub fn elastic_energy(
    e: &[DVec2],
    topology: Topology,
    material: &Material,
    spacing: f64,
) -> ElasticEnergy {
    let n = e.len();
    debug_assert!(
        n >= topology.least_nodes(),
        "the curve has the nodes its differences need"
    );
    let at = |node: Option<usize>| node.map_or(DVec2::ZERO, |i| e[i]);
    let tether: f64 = (0..n)
        .map(|i| material.tether.at(i) * e[i].length_squared())
        .sum();
    let tension: f64 = topology
        .edges(n)
        .map(|edge| {
            let [a, b] = edge.nodes.map(at);
            material.tension.at(edge.weight) * (b - a).length_squared()
        })
        .sum();
    let rigidity: f64 = topology
        .bends(n)
        .map(|bend| {
            let [a, b, c] = bend.nodes.map(at);
            material.rigidity.at(bend.weight) * ((c - b) - (b - a)).length_squared()
        })
        .sum();
    let half = 0.5 * spacing;
    let per_h2 = 1.0 / (spacing * spacing);
    ElasticEnergy {
        tether: half * tether,
        tension: half * tension * per_h2,
        rigidity: half * rigidity * per_h2 * per_h2,
    }
}
