//! Between nodes: the spacing that stands for arc length, the center, and the door every curve passes.

use crate::measure::length;
use crate::{ElasticError, Topology};
use glam::DVec2;

/// Over which edges the spacing is averaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SpacingRule {
    /// The n − 1 edges from the first node to the last, also of a closed curve: the report's program (D8).
    OpenMean,
    /// Every edge the curve has: n of a closed curve, n − 1 of an open one.
    Closed,
}

/// Mean distance between neighbours, the `h` of all differences. L.
///
/// In pixels, or whatever the nodes are in: `s` is arc length at rest, not a number between 0 and 1 as
/// the report's text has it (D7). 0 if there is no edge, or all nodes coincide; a spacing of 0 is refused by
/// whoever would divide by it.
#[must_use]
pub fn spacing(nodes: &[DVec2], closed: bool, rule: SpacingRule) -> f64 {
    let closed = closed && rule == SpacingRule::Closed;
    let edges = if closed {
        nodes.len()
    } else {
        nodes.len().saturating_sub(1)
    };
    if edges == 0 {
        0.0
    } else {
        length(nodes, closed) / edges as f64
    }
}

/// Center of mass: the plain mean of the nodes, or weighted by the mass of each.
///
/// ```text
/// c = Σ μ[i] v[i] / Σ μ[i]
/// ```
///
/// The report calls `∫ μ v ds` the center of mass and forgets to divide; its program takes the mean,
/// right for one mass everywhere (D9). `mass` has one value a node and a positive sum. No nodes: zero.
#[must_use]
pub fn center(nodes: &[DVec2], mass: Option<&[f64]>) -> DVec2 {
    if nodes.is_empty() {
        return DVec2::ZERO;
    }
    let Some(mass) = mass else {
        return lanes::total(nodes) / nodes.len() as f64;
    };
    debug_assert_eq!(nodes.len(), mass.len(), "one mass a node");
    nodes.iter().zip(mass).map(|(&v, &m)| m * v).sum::<DVec2>() / mass.iter().sum::<f64>()
}

/// Refuses nodes that are no curve: too few, not finite, farther out than 1e150, or all in one place.
///
/// ```
/// use elastic::{End, Topology, validate_nodes};
/// use glam::DVec2;
///
/// let nodes = vec![DVec2::new(3.0, 4.0); 6];
/// let refused = validate_nodes(&nodes, Topology::open(End::Free)).unwrap_err();
/// assert_eq!(refused.to_string(), "the 6 points all lie at (3, 4), so the curve has no length; move one");
/// ```
///
/// # Errors
///
/// [`ElasticError::TooFewNodes`], [`ElasticError::NotFinite`], [`ElasticError::TooFar`] or
/// [`ElasticError::NoLength`].
pub fn validate_nodes(nodes: &[DVec2], topology: Topology) -> Result<(), ElasticError> {
    topology.check_count(nodes.len())?;
    check_points("node", nodes)
}

/// Coordinates whose squares are numbers with room for a sum of many.
const FARTHEST: f64 = 1e150;

/// Refuses points that are not finite, farther out than 1e150, or all in one place.
pub(crate) fn check_points(name: &'static str, points: &[DVec2]) -> Result<(), ElasticError> {
    if let Some(index) = points.iter().position(|p| !p.is_finite()) {
        return Err(ElasticError::NotFinite {
            name,
            index,
            value: points[index],
        });
    }
    if let Some(index) = points.iter().position(|p| p.abs().max_element() > FARTHEST) {
        return Err(ElasticError::TooFar {
            name,
            index,
            value: points[index],
        });
    }
    match points.first() {
        Some(&at) if points.iter().all(|p| *p == at) => Err(ElasticError::NoLength {
            count: points.len(),
            at,
        }),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{End, circle};

    fn square() -> [DVec2; 4] {
        [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::new(-1.0, 1.0)]
    }

    #[test]
    fn the_report_counts_one_edge_fewer_than_a_closed_curve_has() {
        // edges 1, 1, 2, and √2 back to the start
        let nodes = square();
        assert_eq!(spacing(&nodes, true, SpacingRule::OpenMean), 4.0 / 3.0);
        assert_eq!(spacing(&nodes, false, SpacingRule::OpenMean), 4.0 / 3.0);
        assert_eq!(spacing(&nodes, false, SpacingRule::Closed), 4.0 / 3.0);
        assert_eq!(
            spacing(&nodes, true, SpacingRule::Closed),
            (4.0 + 2.0_f64.sqrt()) / 4.0
        );
    }

    #[test]
    fn spacing_is_in_pixels_and_not_on_the_unit_interval() {
        let (n, radius) = (60, 20.0);
        let h = spacing(&circle(DVec2::ZERO, radius, n), true, SpacingRule::Closed);
        let chord = 2.0 * radius * (std::f64::consts::PI / n as f64).sin();
        assert!(
            (h - chord).abs() < 1e-14 * radius,
            "rounding of 60 square roots"
        );
        // D7: twice as large, twice as far apart; the text's unit domain has no size
        let large = circle(DVec2::ZERO, 2.0 * radius, n);
        let twice = spacing(&large, true, SpacingRule::Closed);
        assert!((twice - 2.0 * chord).abs() < 1e-14 * radius);
    }

    #[test]
    fn without_edges_there_is_no_spacing() {
        assert_eq!(spacing(&[], true, SpacingRule::Closed), 0.0);
        assert_eq!(spacing(&[DVec2::X], false, SpacingRule::OpenMean), 0.0);
        assert_eq!(spacing(&[DVec2::X; 5], true, SpacingRule::Closed), 0.0);
    }

    #[test]
    fn the_center_of_mass_is_divided_by_the_total_mass() {
        let nodes = square();
        assert_eq!(center(&nodes, None), DVec2::new(0.25, 0.5));
        assert_eq!(center(&nodes, Some(&[7.0; 4])), DVec2::new(0.25, 0.5));
        let heavy = center(&nodes, Some(&[0.0, 1.0, 3.0, 0.0]));
        assert_eq!(heavy, DVec2::new(1.0, 0.75));
    }

    #[test]
    fn what_is_no_curve_is_refused_with_its_reason() {
        let free = Topology::open(End::Free);
        let short = validate_nodes(&[DVec2::ZERO, DVec2::X], free).unwrap_err();
        assert_eq!(
            short.to_string(),
            "a curve with these ends needs at least 3 nodes, got 2"
        );
        let four = validate_nodes(&square(), Topology::Closed).unwrap_err();
        assert_eq!(four, ElasticError::TooFewNodes { needed: 5, got: 4 });
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut nodes = square();
            nodes[2].y = bad;
            let refused = validate_nodes(&nodes, free).unwrap_err();
            assert!(matches!(
                refused,
                ElasticError::NotFinite {
                    name: "node",
                    index: 2,
                    ..
                }
            ));
        }
        assert_eq!(validate_nodes(&square(), free), Ok(()));
    }

    #[test]
    fn coordinates_whose_squares_are_no_numbers_are_refused() {
        let free = Topology::open(End::Free);
        let mut nodes = square();
        nodes[1].x = -1e151;
        let refused = validate_nodes(&nodes, free).unwrap_err();
        assert!(
            refused
                .to_string()
                .starts_with("node 1 must lie within 1e150 of the origin, got (-1"),
            "{refused}"
        );
        nodes[1].x = -1e150;
        assert_eq!(validate_nodes(&nodes, free), Ok(()));
        assert!(length(&nodes, true).is_finite());
    }
}
