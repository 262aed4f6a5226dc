//! Where a point is: inside an outline, outside or on it, and how far from it.

use crate::orient::orientation;
use crate::segments::{NONE, Segment};
use glam::DVec2;

/// Where a point is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// The outline winds around it.
    Inside,
    /// The outline does not wind around it.
    Outside,
    /// On an edge or a node, exactly.
    Border,
}

/// How often a closed polygon winds around a point; none if the point is on it.
///
/// Positive if it winds as an outline of positive area does. Exact, O(n), allocates nothing. 0 around a
/// point that is not a number.
#[must_use]
pub fn winding(nodes: &[DVec2], p: DVec2) -> Option<i32> {
    let mut turns = 0;
    let mut a = *nodes.last()?;
    for &b in nodes {
        let upward = a.y <= p.y && p.y < b.y;
        let downward = b.y <= p.y && p.y < a.y;
        let level = p.y <= a.y.max(b.y) && p.y >= a.y.min(b.y);
        if level && p.x <= a.x.max(b.x) {
            let turn = orientation(a, b, p);
            if turn.abs() <= 0.0 && p.x >= a.x.min(b.x) {
                return None;
            }
            turns += i32::from(upward && turn > 0.0) - i32::from(downward && turn < 0.0);
        }
        a = b;
    }
    Some(turns)
}

/// Whether a point is inside a closed polygon: wound around, in whichever sense.
///
/// Exact, O(n), allocates nothing.
#[must_use]
pub fn place(nodes: &[DVec2], p: DVec2) -> Place {
    match winding(nodes, p) {
        None => Place::Border,
        Some(0) => Place::Outside,
        Some(_) => Place::Inside,
    }
}

/// Distance from a point to a polygon; infinite without nodes. L.
///
/// O(n), allocates nothing.
#[must_use]
pub fn distance(nodes: &[DVec2], closed: bool, p: DVec2) -> f64 {
    let first = nodes
        .first()
        .map_or(f64::INFINITY, |v| (p - *v).length_squared());
    edges(nodes, closed)
        .map(|edge| edge.nearest(p).squared)
        .fold(first, f64::min)
        .sqrt()
}

/// Distance from a point to a closed polygon, negative inside. L.
///
/// O(n), allocates nothing.
#[must_use]
pub fn signed_distance(nodes: &[DVec2], p: DVec2) -> f64 {
    let unsigned = distance(nodes, true, p);
    match place(nodes, p) {
        Place::Inside => -unsigned,
        Place::Outside => unsigned,
        Place::Border => 0.0,
    }
}

/// Twice the signed area, about the first node so that no digits are lost far from the origin.
pub(crate) fn twice_area(nodes: impl IntoIterator<Item = DVec2>) -> f64 {
    let mut nodes = nodes.into_iter();
    let Some(origin) = nodes.next() else {
        return 0.0;
    };
    let (mut last, mut total) = (DVec2::ZERO, 0.0);
    for v in nodes {
        let here = v - origin;
        total += last.perp_dot(here);
        last = here;
    }
    total
}

/// The edges of a curve that have a length, without knowledge of each other.
pub(crate) fn edges(nodes: &[DVec2], closed: bool) -> impl Iterator<Item = Segment> + '_ {
    let n = nodes.len();
    let count = if closed { n } else { n.saturating_sub(1) };
    (0..count)
        .map(move |i| (i, nodes[i], nodes[if i + 1 == n { 0 } else { i + 1 }]))
        .filter(|(_, a, b)| a != b)
        .map(|(i, a, b)| {
            let edge = u32::try_from(i).unwrap_or(NONE);
            Segment {
                a,
                b,
                curve: 0,
                edge,
                before: NONE,
                after: NONE,
            }
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SQUARE: [DVec2; 4] = [
        DVec2::ZERO,
        DVec2::new(4.0, 0.0),
        DVec2::new(4.0, 4.0),
        DVec2::new(0.0, 4.0),
    ];

    /// The angle swept as seen from the point, in turns.
    fn slow(nodes: &[DVec2], p: DVec2) -> i32 {
        let sweep: f64 = (0..nodes.len())
            .map(|i| (nodes[i] - p).angle_to(nodes[(i + 1) % nodes.len()] - p))
            .sum();
        (sweep / std::f64::consts::TAU).round() as i32
    }

    #[test]
    fn a_square_has_an_inside_an_outside_and_a_border() {
        for (x, y, at, far) in [
            (1.0, 2.0, Place::Inside, -1.0),
            (-3.0, 2.0, Place::Outside, 3.0),
            (7.0, 8.0, Place::Outside, 5.0),
            (4.0, 1.0, Place::Border, 0.0),
            (1.0, 0.0, Place::Border, 0.0),
            (4.0, 4.0, Place::Border, 0.0),
            (5.0, 4.0, Place::Outside, 1.0),
            (-1.0, 0.0, Place::Outside, 1.0),
        ] {
            let p = DVec2::new(x, y);
            assert_eq!(place(&SQUARE, p), at, "{p}");
            assert_eq!(signed_distance(&SQUARE, p), far, "{p}");
        }
    }

    #[test]
    fn winding_counts_turns_with_their_sense() {
        let twice: Vec<DVec2> = SQUARE.iter().chain(&SQUARE).copied().collect();
        assert_eq!(winding(&twice, DVec2::ONE), Some(2));
        let back: Vec<DVec2> = SQUARE.iter().rev().copied().collect();
        assert_eq!(winding(&back, DVec2::ONE), Some(-1));
        assert_eq!(winding(&[], DVec2::ONE), None);
        assert!(distance(&[], true, DVec2::ONE).is_infinite());
        assert_eq!(distance(&[DVec2::ZERO], true, DVec2::X), 1.0);
    }

    proptest! {
        #[test]
        fn winding_is_the_angle_swept(
            points in prop::collection::vec((-5i32..5, -5i32..5), 1..20),
            x in -5i32..5,
            y in -5i32..5,
        ) {
            let nodes: Vec<DVec2> =
                points.iter().map(|&(x, y)| DVec2::new(f64::from(x), f64::from(y))).collect();
            // on the lattice it may lie on the border, beside it never
            let p = DVec2::new(f64::from(x), f64::from(y));
            let beside = p + DVec2::new(0.317, 0.1234);
            prop_assert_eq!(winding(&nodes, beside), Some(slow(&nodes, beside)));
            match winding(&nodes, p) {
                Some(turns) => prop_assert_eq!(turns, slow(&nodes, p)),
                None => prop_assert!(distance(&nodes, true, p) < 1e-14, "rounding of one projection"),
            }
        }
    }
}
