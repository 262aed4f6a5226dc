//! The elastic energy, term by term.
//!
//! It is what the force and the matrix are derived from, and the tests hold both to it. Energy per node, for
//! drawing where a curve is strained, it cannot say yet.

use crate::profile::Lane;
use crate::{Material, Topology, kernel_walk};
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
    /// ½ ∫ Σ ωₘ |∂ᵐe/∂sᵐ|² ds over the orders m above the second.
    pub higher: f64,
}

impl ElasticEnergy {
    /// All together.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.tether + self.tension + self.rigidity + self.higher
    }
}

/// Elastic energy of a deformation: what it cost to bring the curve there.
///
/// ```text
/// ξ = ½ h ( Σ ω₀[i] |e[i]|²  +  Σ ω₁[i] |e[i+1] − e[i]|² / h²  +  Σ ω₂[i] |e[i+1] − 2 e[i] + e[i−1]|² / h⁴ )
/// ```
///
/// over nodes, edges and bends that exist, and so on for the orders above. `e` holds one deformation a node. An integral over arc
/// length, so that it does not depend on the number of nodes beyond the error of the differences (second
/// order closed; an end node of an open curve counts for a whole `h`, which is first order). O(n).
///
/// The arguments are trusted: they are what [`stiffness`](crate::stiffness) would accept.
///
/// Report Eq. 2.5 and 2.6.
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
        rigidity += (bend.share * w2.at(bend.weight)) * (bent * bent);
    }
    let higher = if material.higher.is_empty() {
        0.0
    } else {
        kernel_walk::energy((3, &material.higher), e, topology, spacing)
            .iter()
            .sum()
    };
    let half = 0.5 * spacing;
    let per_h2 = 1.0 / (spacing * spacing);
    ElasticEnergy {
        tether: half * tether.element_sum(),
        tension: half * per_h2 * tension.element_sum(),
        rigidity: half * per_h2 * per_h2 * rigidity.element_sum(),
        higher,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::End;
    use std::f64::consts::{PI, TAU};

    const W: [f64; 3] = [0.7, 5.0, 11.0];

    /// Three waves of height a round a ring of length l, and the exact energy of each term.
    fn ring(n: usize) -> (ElasticEnergy, [f64; 3]) {
        let (a, l, waves) = (0.4, 30.0, 3.0);
        let e: Vec<_> = (0..n)
            .map(|i| DVec2::new(a * (waves * TAU * i as f64 / n as f64).cos(), 0.0))
            .collect();
        let [w0, w1, w2] = W;
        let material = Material::uniform(w0, w1, w2);
        let energy = elastic_energy(&e, Topology::Closed, &material, l / n as f64);
        // ½ ω ∫ a² k^2m cos² ds over the ring
        let k: f64 = waves * TAU / l;
        let exact = [0, 1, 2].map(|m| 0.25 * W[m] * a * a * l * [1.0, k * k, k.powi(4)][m]);
        (energy, exact)
    }

    #[test]
    fn energy_is_an_integral_over_arc_length_whatever_the_number_of_nodes() {
        let error = |n: usize, term: usize| {
            let (energy, exact) = ring(n);
            let got = [energy.tether, energy.tension, energy.rigidity][term];
            (got / exact[term] - 1.0).abs()
        };
        // the sum of cos² over whole waves is exact
        assert!(error(64, 0) < 1e-14, "{}", error(64, 0));
        for term in [1, 2] {
            let order = (error(64, term) / error(128, term)).log2();
            assert!((order - 2.0).abs() < 0.01, "term {term}: {order}");
        }
    }

    #[test]
    fn a_stretched_rod_stores_half_its_tension_times_the_strain_squared() {
        // e = ε s along a rod of length 8: ½ ω₁ ε² l, whatever the nodes, for there is no end effect
        for n in [5, 9, 65] {
            let h = 8.0 / (n - 1) as f64;
            let e: Vec<_> = (0..n)
                .map(|i| DVec2::new(0.25 * h * i as f64, 0.0))
                .collect();
            let material = Material::uniform(0.0, 3.0, 100.0);
            let energy = elastic_energy(&e, Topology::open(End::Free), &material, h);
            assert_eq!(energy.tension, 0.5 * 3.0 * 0.0625 * 8.0, "{n} nodes");
            assert_eq!(energy.rigidity, 0.0, "{n} nodes");
            assert_eq!(energy.total(), energy.tension);
        }
    }

    #[test]
    fn the_end_nodes_of_an_open_curve_count_for_a_whole_spacing() {
        let tether = |n: usize| {
            let h = PI / (n - 1) as f64;
            let e = vec![DVec2::X; n];
            let material = Material::uniform(2.0, 0.0, 0.0);
            elastic_energy(&e, Topology::open(End::Free), &material, h).tether
        };
        // ½ ω₀ l (1 + 1/(n − 1))
        for n in [11, 101] {
            let want = PI * (1.0 + 1.0 / (n - 1) as f64);
            assert!((tether(n) - want).abs() < 1e-14 * want * 10.0, "{n}");
        }
    }
}
