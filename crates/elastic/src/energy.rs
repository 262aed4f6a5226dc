//! The elastic energy, term by term.

use crate::profile::Lane;
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
    let (w0, w1, w2) = (
        Lane::new(&material.tether),
        Lane::new(&material.tension),
        Lane::new(&material.rigidity),
    );
    // x and y apart until the end: two sums side by side cost what one does
    let mut tether = w0.at(n - 1) * (e[n - 1] * e[n - 1]);
    let mut tension = DVec2::ZERO;
    let mut rigidity = DVec2::ZERO;
    let mut edge = DVec2::ZERO;
    for (i, pair) in e.windows(2).enumerate() {
        let next = pair[1] - pair[0];
        tether += w0.at(i) * (pair[0] * pair[0]);
        tension += w1.at(i) * (next * next);
        if i > 0 {
            let bend = next - edge;
            rigidity += w2.at(i) * (bend * bend);
        }
        edge = next;
    }
    let at = |node: Option<usize>| node.map_or(DVec2::ZERO, |i| e[i]);
    for edge in topology.outer_edges(n) {
        let [a, b] = edge.nodes.map(at);
        tension += w1.at(edge.weight) * ((b - a) * (b - a));
    }
    for bend in topology.outer_bends(n) {
        let [a, b, c] = bend.nodes.map(at);
        let bent = (c - b) - (b - a);
        rigidity += w2.at(bend.weight) * (bent * bent);
    }
    let half = 0.5 * spacing;
    let per_h2 = 1.0 / (spacing * spacing);
    ElasticEnergy {
        tether: half * tether.element_sum(),
        tension: half * per_h2 * tension.element_sum(),
        rigidity: half * per_h2 * per_h2 * rigidity.element_sum(),
    }
}
