//! Curves with a formula: circle, ellipse, segment.
//!
//! What comes in is taken as it is; [`validate_nodes`](crate::validate_nodes) refuses what is no curve.

use glam::DVec2;
use std::f64::consts::TAU;

/// A closed circle of `n` nodes: node `i` at the angle `2π i / n`, from +x towards +y.
///
/// In axes with y down that is clockwise on the screen, and the signed area is positive.
#[must_use]
pub fn circle(center: DVec2, radius: f64, n: usize) -> Vec<DVec2> {
    ellipse(center, DVec2::splat(radius), 0.0, n)
}

/// A closed ellipse of `n` nodes, turned by `angle` (radians, from +x towards +y).
///
/// ```text
/// v[i] = center + R(angle) (a cos φ, b sin φ),   φ = 2π i / n
/// ```
///
/// Nodes are even in φ, not in arc length: [`resample`](crate::resample) makes them so.
#[must_use]
pub fn ellipse(center: DVec2, semi_axes: DVec2, angle: f64, n: usize) -> Vec<DVec2> {
    let turn = DVec2::from_angle(angle);
    (0..n)
        .map(|i| center + turn.rotate(semi_axes * DVec2::from_angle(TAU * ratio(i, n))))
        .collect()
}

/// `n` nodes at even distances from `from` to `to`, both included. With `n = 1`, only `from`.
#[must_use]
pub fn segment(from: DVec2, to: DVec2, n: usize) -> Vec<DVec2> {
    (0..n)
        .map(|i| from + (to - from) * ratio(i, n.saturating_sub(1).max(1)))
        .collect()
}

/// `i / n` as a real number.
fn ratio(i: usize, n: usize) -> f64 {
    i as f64 / n as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_starts_at_plus_x_and_turns_towards_plus_y() {
        let nodes = circle(DVec2::new(1.0, 2.0), 3.0, 4);
        let want = [(4.0, 2.0), (1.0, 5.0), (-2.0, 2.0), (1.0, -1.0)];
        for (node, (x, y)) in nodes.iter().zip(want) {
            // cos(π/2) is 6e-17, not 0
            assert!((*node - DVec2::new(x, y)).length() < 1e-15, "{node}");
        }
    }

    #[test]
    fn a_turned_ellipse_has_its_long_axis_along_the_angle() {
        let nodes = ellipse(DVec2::ZERO, DVec2::new(5.0, 1.0), 0.3, 8);
        assert!((nodes[0] - 5.0 * DVec2::from_angle(0.3)).length() < 1e-15);
        assert!((nodes[2] - DVec2::from_angle(0.3).perp()).length() < 1e-15);
    }

    #[test]
    fn a_segment_reaches_both_ends_exactly() {
        let (a, b) = (DVec2::new(1.0, -1.0), DVec2::new(4.0, 8.0));
        let nodes = segment(a, b, 4);
        assert_eq!(nodes, [a, DVec2::new(2.0, 2.0), DVec2::new(3.0, 5.0), b]);
        assert_eq!(segment(a, b, 1), [a]);
        assert!(segment(a, b, 0).is_empty());
    }
}
