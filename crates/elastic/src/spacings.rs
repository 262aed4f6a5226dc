//! A curve whose edges have lengths of their own: report §5.3, the correction of the derivatives.
//!
//! "The derivatives have to be corrected by a factor of dᵢ." Not by one: a first difference is divided by the length
//! of its edge, a second difference of those by the distance of the two middles (D77). The force is then again minus the
//! gradient of an energy, with each edge and each bend counting for the length it stands for.
//!
//! What the ends are is asked of the same topology as on even nodes. Orders above two keep one spacing.

use crate::spacing::check_points;
use crate::stiffness::SPACINGS;
use crate::topology::{Bend, Edge};
use crate::{ElasticEnergy, ElasticError, Material, Topology};
use banded::Pentadiagonal;
use glam::DVec2;

/// The lengths of a curve's edges at rest, and the length each node stands for.
///
/// ```text
/// D₁e[i] = (e[i+1] − e[i]) / dᵢ,   D₂e[i] = (D₁e[i] − D₁e[i−1]) / Dᵢ,   Dᵢ = (dᵢ₋₁ + dᵢ)/2
/// ```
///
/// dᵢ is the edge from node i to i+1. An end node of an open curve stands for the whole of its edge, as on even
/// nodes, where everything here is what [`elastic_force`](crate::elastic_force) and its like give, to rounding.
/// Edges beyond an end are as long as the last before it.
///
/// Second order where the lengths change smoothly along the curve. Where long and short ones alternate D₂ is of
/// first order and the force of rigidity, two differences more, does not converge node by node; the energy does, and
/// so does the shape in balance. [`spacing_study`](crate::spacing_study) has the figures.
///
/// Report §5.3 and D77.
#[derive(Debug, Clone, PartialEq)]
pub struct Spacings {
    topology: Topology,
    edges: Vec<f64>,
    shares: Vec<f64>,
}

impl Spacings {
    /// The chords of a rest shape.
    ///
    /// # Errors
    ///
    /// As [`validate_nodes`](crate::validate_nodes); [`ElasticError::BadEdge`] where neighbours coincide or are out of
    /// all measure.
    pub fn of(rest: &[DVec2], topology: Topology) -> Result<Self, ElasticError> {
        topology.check_count(rest.len())?;
        check_points("node", rest)?;
        let closing = rest.first().filter(|_| topology.is_closed());
        let after = rest.iter().skip(1).chain(closing);
        let edges = rest.iter().zip(after).map(|(a, b)| (*b - *a).length());
        Self::new(edges.collect(), topology)
    }

    /// Edges of these lengths: n of a closed curve of n nodes, n − 1 of an open one.
    ///
    /// # Errors
    ///
    /// [`ElasticError::TooFewNodes`] or [`ElasticError::BadEdge`].
    pub fn new(edges: Vec<f64>, topology: Topology) -> Result<Self, ElasticError> {
        let n = edges.len() + usize::from(!topology.is_closed());
        topology.check_count(n)?;
        if let Some(index) = edges.iter().position(|d| !SPACINGS.contains(d)) {
            let length = edges[index];
            return Err(ElasticError::BadEdge { index, length });
        }
        let last = edges.len() - 1;
        let share = |i: usize| match topology {
            Topology::Closed => 0.5 * (edges[i.checked_sub(1).unwrap_or(last)] + edges[i]),
            Topology::Open { .. } => 0.5 * (edges[i.saturating_sub(1)] + edges[i.min(last)]),
        };
        let shares = (0..n).map(share).collect();
        Ok(Self {
            topology,
            edges,
            shares,
        })
    }

    /// dᵢ, the length of each edge. L.
    #[must_use]
    pub fn edges(&self) -> &[f64] {
        &self.edges
    }

    /// Dᵢ, the length each node stands for: μ Dᵢ is its mass, and Dᵢ times a force density its force. L.
    #[must_use]
    pub fn shares(&self) -> &[f64] {
        &self.shares
    }

    /// First derivative on every edge, D₁. One value an edge. O(n).
    #[must_use]
    pub fn first(&self, values: &[DVec2]) -> Vec<DVec2> {
        let n = self.shares.len();
        let next = |i: usize| values[(i + 1) % n];
        let edges = self.edges.iter().enumerate();
        edges.map(|(i, d)| (next(i) - values[i]) / *d).collect()
    }

    /// Second derivative at every node, D₂. One value a node; 0 at the ends of an open curve. O(n).
    #[must_use]
    pub fn second(&self, values: &[DVec2]) -> Vec<DVec2> {
        let n = self.shares.len();
        let first = self.first(values);
        (0..n)
            .map(|i| {
                if !self.topology.is_closed() && (i == 0 || i + 1 == n) {
                    return DVec2::ZERO;
                }
                (first[i] - first[(i + n - 1) % n]) / self.shares[i]
            })
            .collect()
    }

    /// Elastic force on every node, per length of what it stands for: M L T⁻².
    ///
    /// ```text
    /// F[i] = − (1/Dᵢ) ∂ξ/∂e[i]
    /// ```
    ///
    /// with ξ of [`energy`](Self::energy). `e` and `force` have one value a node; `force` is overwritten. O(n), allocates
    /// nothing; some ten times the work of one spacing for all. The sum of `Dᵢ F[i]` is 0 where nothing is tethered or
    /// anchored. The material is trusted to fit, as by [`elastic_force`](crate::elastic_force).
    pub fn force(&self, e: &[DVec2], material: &Material, force: &mut [DVec2]) {
        let n = self.shares.len();
        debug_assert!(e.len() == n && force.len() == n, "one value a node");
        for (i, (out, e)) in force.iter_mut().zip(e).enumerate() {
            *out = -(material.tether.at(i) * self.shares[i]) * *e;
        }
        let at = |node: Option<usize>| node.map_or(DVec2::ZERO, |i| e[i]);
        for edge in self.topology.edges(n) {
            let [a, b] = edge.nodes;
            let pull = self.edge_weight(&edge, material) * (at(b) - at(a));
            add(force, a, pull);
            add(force, b, -pull);
        }
        for bend in self.topology.bends(n) {
            let [a, b, c] = bend.nodes;
            let (left, right, weight) = self.bend_weight(&bend, material);
            let (arriving, leaving) = (left * (at(b) - at(a)), right * (at(c) - at(b)));
            let moment = weight * (leaving - arriving);
            add(force, a, -left * moment);
            add(force, b, (left + right) * moment);
            add(force, c, -right * moment);
        }
        for (out, share) in force.iter_mut().zip(&self.shares) {
            *out /= *share;
        }
    }

    /// Elastic energy of a deformation. M L³ T⁻².
    ///
    /// ```text
    /// ξ = ½ ( Σ ω₀ |e|² Dᵢ + Σ ω₁ |D₁e|² dᵢ + Σ ω₂ |D₂e|² Dᵢ )
    /// ```
    ///
    /// over nodes, edges and bends that exist. O(n). On a closed curve second order however uneven the nodes.
    #[must_use]
    pub fn energy(&self, e: &[DVec2], material: &Material) -> ElasticEnergy {
        let n = self.shares.len();
        let at = |node: Option<usize>| node.map_or(DVec2::ZERO, |i| e[i]);
        let tether = (0..n).map(|i| material.tether.at(i) * self.shares[i] * e[i].length_squared());
        let tension = self.topology.edges(n).map(|edge| {
            let [a, b] = edge.nodes.map(at);
            self.edge_weight(&edge, material) * (b - a).length_squared()
        });
        let rigidity = self.topology.bends(n).map(|bend| {
            let [a, b, c] = bend.nodes.map(at);
            let (left, right, weight) = self.bend_weight(&bend, material);
            weight * (right * (c - b) - left * (b - a)).length_squared()
        });
        ElasticEnergy {
            tether: 0.5 * tether.sum::<f64>(),
            tension: 0.5 * tension.sum::<f64>(),
            rigidity: 0.5 * rigidity.sum::<f64>(),
            higher: 0.0,
        }
    }

    /// The second derivative of the energy: symmetric, pentadiagonal. M L T⁻².
    ///
    /// ```text
    /// ξ = ½ eᵀ S e,   Dᵢ F[i] = −(S e)[i],   K = D⁻¹ S
    /// ```
    ///
    /// With the masses `μ Dᵢ` on the other side the modes are those of `S u = λ M D u`. On even nodes S is `h`
    /// times [`stiffness`](crate::stiffness). Held nodes are not masked. O(n).
    ///
    /// # Errors
    ///
    /// A material that does not fit, is not sound or has an order above 2, and an S that is not finite.
    pub fn stiffness(&self, material: &Material) -> Result<Pentadiagonal, ElasticError> {
        let n = self.shares.len();
        material.validate(n)?;
        if material.order() > 2 {
            let order = material.order();
            return Err(ElasticError::OrderOfSpacings { order });
        }
        let mut s = Pentadiagonal::new(n, self.topology.is_closed())?;
        let tether: Vec<f64> = (0..n)
            .map(|i| material.tether.at(i) * self.shares[i])
            .collect();
        s.add_diagonal(&tether);
        for edge in self.topology.edges(n) {
            let weight = self.edge_weight(&edge, material);
            crate::stiffness::add(&mut s, weight, edge.nodes, [-1.0, 1.0]);
        }
        for bend in self.topology.bends(n) {
            let (left, right, weight) = self.bend_weight(&bend, material);
            crate::stiffness::add(&mut s, weight, bend.nodes, [left, -(left + right), right]);
        }
        if s.norm().is_finite() {
            Ok(s)
        } else {
            let spacing = self.edges.iter().copied().fold(f64::INFINITY, f64::min);
            Err(ElasticError::TooStiff { spacing })
        }
    }

    /// ω₁ d / d².
    fn edge_weight(&self, edge: &Edge, material: &Material) -> f64 {
        material.tension.at(edge.weight) / self.edges[edge.length]
    }

    /// 1/d before, 1/d after, and ω₂ D / D².
    fn bend_weight(&self, bend: &Bend, material: &Material) -> (f64, f64, f64) {
        let [before, after] = bend.lengths.map(|k| self.edges[k]);
        let weight = bend.share * material.rigidity.at(bend.weight) / (0.5 * (before + after));
        (1.0 / before, 1.0 / after, weight)
    }
}

fn add(force: &mut [DVec2], node: Option<usize>, by: DVec2) {
    if let Some(i) = node {
        force[i] += by;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{End, circle};

    #[test]
    fn an_edge_without_length_is_refused_by_its_number() {
        let mut nodes = circle(DVec2::ZERO, 5.0, 8);
        nodes[3] = nodes[2];
        let refused = Spacings::of(&nodes, Topology::Closed).unwrap_err();
        assert_eq!(
            refused.to_string(),
            "edge 2 must be from 1e-75 to 1e75 long, got 0; do its nodes coincide?"
        );
        let nan = Spacings::new(vec![1.0, f64::NAN], Topology::open(End::Free));
        assert!(nan.unwrap_err().to_string().starts_with("edge 1 must be"));
        let short = Spacings::new(vec![], Topology::open(End::Free));
        assert_eq!(short, Err(ElasticError::TooFewNodes { needed: 3, got: 1 }));
    }

    #[test]
    fn derivatives_of_a_parabola_over_uneven_nodes_are_those_of_the_middles() {
        // e = s² at 0, 1, 3, 4: slopes at the middles of the edges are exact, and 2 between
        let nodes = [0.0, 1.0, 3.0, 4.0].map(|s| DVec2::new(s, 0.0));
        let spacings = Spacings::of(&nodes, Topology::open(End::Free)).unwrap();
        assert_eq!(spacings.edges(), [1.0, 2.0, 1.0]);
        assert_eq!(spacings.shares(), [1.0, 1.5, 1.5, 1.0]);
        let e = nodes.map(|s| DVec2::new(0.0, s.x * s.x));
        assert_eq!(
            spacings.first(&e),
            [1.0, 4.0, 7.0].map(|y| DVec2::new(0.0, y))
        );
        assert_eq!(
            spacings.second(&e),
            [0.0, 2.0, 2.0, 0.0].map(|y| DVec2::new(0.0, y))
        );
    }
}
