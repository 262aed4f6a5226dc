//! What can be measured on a curve: length, area, centroid, normals, and the size of a deformation.
//!
//! All of it on the polygon through the nodes, exact for that polygon. A curve that crosses itself has a
//! signed area all the same: loops of opposite turn subtract.

use glam::DVec2;

/// Length of the polygon through the nodes; of a closed one with the edge back to the start. L.
#[must_use]
pub fn length(nodes: &[DVec2], closed: bool) -> f64 {
    let open: f64 = nodes
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).length())
        .sum();
    match nodes {
        [first, .., last] if closed => open + (*first - *last).length(),
        _ => open,
    }
}

/// Signed area inside the closed polygon. L².
///
/// ```text
/// A = ½ Σ (x[i] y[i+1] − x[i+1] y[i])
/// ```
///
/// Positive if it turns from +x towards +y: with y down, clockwise on the screen. Taken about the first
/// node, so that a small curve far from the origin loses no digits.
#[must_use]
pub fn signed_area(nodes: &[DVec2]) -> f64 {
    0.5 * triangles(nodes).map(|(a, b)| a.perp_dot(b)).sum::<f64>()
}

/// Centroid of the area inside the closed polygon; none if it encloses no area.
///
/// ```text
/// C = Σ (v[i] + v[i+1]) (x[i] y[i+1] − x[i+1] y[i]) / 6 A
/// ```
///
/// Not the center of mass, which is that of the curve itself: [`center`](crate::center).
#[must_use]
pub fn centroid(nodes: &[DVec2]) -> Option<DVec2> {
    let (mut twice_area, mut moment) = (0.0, DVec2::ZERO);
    for (a, b) in triangles(nodes) {
        let cross = a.perp_dot(b);
        twice_area += cross;
        moment += cross * (a + b);
    }
    let offset = moment / (3.0 * twice_area);
    nodes
        .first()
        .map(|&origin| origin + offset)
        .filter(|c| c.is_finite())
}

/// Unit normal at every node: the chord between its neighbours, turned to `(t_y, −t_x)`.
///
/// Points outwards on a closed curve of positive [`signed_area`], inwards on one that runs the other way.
/// At an open end the chord is the last edge. Second order in the spacing on even nodes. A node whose
/// neighbours coincide has no tangent, and gets zero.
#[must_use]
pub fn normals(nodes: &[DVec2], closed: bool) -> Vec<DVec2> {
    let n = nodes.len();
    let neighbours = |i: usize| {
        if closed {
            ((i + n - 1) % n, (i + 1) % n)
        } else {
            (i.saturating_sub(1), (i + 1).min(n - 1))
        }
    };
    (0..n)
        .map(|i| {
            let (before, after) = neighbours(i);
            let tangent = (nodes[after] - nodes[before]).normalize_or_zero();
            DVec2::new(tangent.y, -tangent.x)
        })
        .collect()
}

/// Root mean square size: how far a deformation is from nothing. L.
///
/// ```text
/// √( Σ |e[i]|² / n )
/// ```
///
/// 0 without nodes.
#[must_use]
pub fn rms(e: &[DVec2]) -> f64 {
    if e.is_empty() {
        return 0.0;
    }
    (e.iter().map(|v| v.length_squared()).sum::<f64>() / e.len() as f64).sqrt()
}

/// The fan of triangles from the first node, as two sides each.
fn triangles(nodes: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> {
    let origin = nodes.first().copied().unwrap_or_default();
    nodes
        .windows(2)
        .skip(1)
        .map(move |pair| (pair[0] - origin, pair[1] - origin))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{circle, ellipse};

    /// A right triangle of sides 3, 4, 5, far from the origin.
    fn triangle() -> [DVec2; 3] {
        let far = DVec2::new(1e6, -1e6);
        [far, far + DVec2::new(3.0, 0.0), far + DVec2::new(3.0, 4.0)]
    }

    #[test]
    fn a_three_four_five_triangle_measures_as_in_the_book() {
        let nodes = triangle();
        assert_eq!(length(&nodes, false), 7.0);
        assert_eq!(length(&nodes, true), 12.0);
        assert_eq!(signed_area(&nodes), 6.0);
        let third = (nodes[0] + nodes[1] + nodes[2]) / 3.0;
        // one rounding at 1e6
        assert!((centroid(&nodes).unwrap() - third).length() < 1e-9);
    }

    #[test]
    fn the_other_way_round_the_area_is_negative_and_normals_point_inwards() {
        let mut nodes = circle(DVec2::new(3.0, 4.0), 2.0, 12);
        let outward = normals(&nodes, true);
        for (node, normal) in nodes.iter().zip(&outward) {
            let radial = (*node - DVec2::new(3.0, 4.0)) / 2.0;
            // by symmetry the chord of the neighbours is square to the radius: rounding only
            assert!((radial - *normal).length() < 1e-14, "{node}");
        }
        assert!(signed_area(&nodes) > 0.0);
        let area = signed_area(&nodes);
        nodes.reverse();
        assert!((signed_area(&nodes) + area).abs() < 1e-14 * area);
        for (node, normal) in nodes.iter().zip(normals(&nodes, true)) {
            assert!((*node - DVec2::new(3.0, 4.0)).dot(normal) < 0.0);
        }
    }

    #[test]
    fn a_polygon_in_an_ellipse_has_the_area_of_the_formula() {
        // an affine picture of the regular n-gon: ½ n sin(2π/n) a b
        let (a, b, n) = (5.0, 2.0, 17);
        let nodes = ellipse(DVec2::new(-7.0, 11.0), DVec2::new(a, b), 0.7, n);
        let exact = 0.5 * n as f64 * (std::f64::consts::TAU / n as f64).sin() * a * b;
        assert!(
            (signed_area(&nodes) - exact).abs() < 1e-14 * exact,
            "rounding"
        );
        let off = centroid(&nodes).unwrap() - DVec2::new(-7.0, 11.0);
        assert!(off.length() < 1e-13, "its center, up to rounding: {off}");
    }

    #[test]
    fn what_encloses_nothing_has_no_centroid() {
        let flat = [DVec2::ZERO, DVec2::X, 2.0 * DVec2::X];
        assert_eq!(signed_area(&flat), 0.0);
        assert_eq!(centroid(&flat), None);
        assert_eq!(centroid(&[]), None);
        assert_eq!(length(&[], true), 0.0);
        assert_eq!(rms(&[]), 0.0);
    }

    #[test]
    fn open_ends_take_the_normal_of_their_edge_and_folds_take_none() {
        let nodes = [DVec2::ZERO, DVec2::X, DVec2::ZERO];
        assert_eq!(
            normals(&nodes, false),
            [DVec2::NEG_Y, DVec2::ZERO, DVec2::Y]
        );
    }

    #[test]
    fn rms_is_the_radius_of_a_circle_about_its_center() {
        assert!((rms(&circle(DVec2::ZERO, 3.0, 9)) - 3.0).abs() < 1e-15 * 3.0);
        assert_eq!(rms(&[DVec2::new(3.0, 4.0), DVec2::ZERO]), 12.5_f64.sqrt());
    }
}
