//! On which side of a line a point lies, and how two segments meet: decided exactly.
//!
//! The sign comes from adaptive arithmetic [shewchuk97], so two questions about the same points never
//! contradict each other; only *where* two segments cross is rounded.

use glam::DVec2;
use robust::{Coord, orient2d};
use std::cmp::Ordering;

/// Twice the signed area of the triangle; its sign is exact, its size rounded.
///
/// Positive if `c` lies on the side of the line from `a` to `b` where the inside of an outline is. Exact as
/// long as no product of two differences underflows (1e-300) or overflows.
pub(crate) fn orientation(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |v: DVec2| Coord { x: v.x, y: v.y };
    orient2d(coord(a), coord(b), coord(c))
}

/// How two segments meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meeting {
    /// They cross in one point inside both.
    Cross,
    /// They share one point, and it is an end of at least one of them.
    Touch,
    /// They lie on one line and share a stretch of it.
    Overlap,
}

/// How `ab` and `cd` meet, if they do, and at which fraction of each.
///
/// Whether and how is exact; the fractions are rounded, and name one point of both segments. Of an overlap the end first on `ab` is told. A segment of no
/// length is a point.
pub(crate) fn meet(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Option<(Meeting, f64, f64)> {
    if apart(a.x, b.x, c.x, d.x) || apart(a.y, b.y, c.y, d.y) {
        return None;
    }
    let (to_c, to_d) = (orientation(a, b, c), orientation(a, b, d));
    if same_side(to_c, to_d) {
        return None;
    }
    let (to_a, to_b) = (orientation(c, d, a), orientation(c, d, b));
    if same_side(to_a, to_b) {
        return None;
    }
    let zero = |o: f64| o.partial_cmp(&0.0) == Some(Ordering::Equal);
    if zero(to_c) && zero(to_d) && zero(to_a) && zero(to_b) {
        return collinear(a, b, c, d);
    }
    if zero(to_c) || zero(to_d) || zero(to_a) || zero(to_b) {
        // not all on one line, the boxes meet, neither on one side of the other: the zero is the point
        let touching = [
            (zero(to_a), a),
            (zero(to_b), b),
            (zero(to_c), c),
            (zero(to_d), d),
        ];
        return touching
            .into_iter()
            .filter(|(on, _)| *on)
            .map(|(_, p)| p)
            .find(|p| on_box(*p, a, b) && on_box(*p, c, d))
            .map(|p| (Meeting::Touch, fraction(a, b, p), fraction(c, d, p)));
    }
    let t = to_a / (to_a - to_b);
    // of strands nearly parallel the fractions are uncertain; taken from one point, they agree
    let at = a.lerp(b, t);
    let u = (at - c).dot(d - c) / (d - c).length_squared();
    let u = if u.is_nan() { to_c / (to_c - to_d) } else { u };
    Some((Meeting::Cross, t, u.clamp(0.0, 1.0)))
}

/// Whether the stretches from `a` to `b` and from `c` to `d` have nothing in common.
fn apart(a: f64, b: f64, c: f64, d: f64) -> bool {
    a.max(b) < c.min(d) || c.max(d) < a.min(b)
}

fn same_side(one: f64, other: f64) -> bool {
    (one > 0.0 && other > 0.0) || (one < 0.0 && other < 0.0)
}

fn on_box(p: DVec2, a: DVec2, b: DVec2) -> bool {
    p.cmpge(a.min(b)).all() && p.cmple(a.max(b)).all()
}

/// Where along `ab` the point `p`, which lies on it, is; 0 on a segment of no length.
fn fraction(a: DVec2, b: DVec2, p: DVec2) -> f64 {
    let d = (b - a).abs();
    let (length, along) = if d.x >= d.y {
        (b.x - a.x, p.x - a.x)
    } else {
        (b.y - a.y, p.y - a.y)
    };
    let t = along / length;
    if t.is_finite() {
        t.clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// Segments on one line: what they share, if anything.
fn collinear(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Option<(Meeting, f64, f64)> {
    let ends = [a, b, c, d];
    let shared = ends.map(|p| on_box(p, a, b) && on_box(p, c, d));
    let at = |p: DVec2| (fraction(a, b, p), fraction(c, d, p));
    let first = (0..4)
        .filter(|&i| shared[i])
        .map(|i| ends[i])
        .min_by(|p, q| at(*p).0.total_cmp(&at(*q).0))?;
    let stretch = (0..4).any(|i| shared[i] && ends[i] != first);
    let kind = if stretch {
        Meeting::Overlap
    } else {
        Meeting::Touch
    };
    let (t, u) = at(first);
    Some((kind, t, u))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn at(x: f64, y: f64) -> DVec2 {
        DVec2::new(x, y)
    }

    #[test]
    fn two_diagonals_cross_in_the_middle() {
        let meeting = meet(at(0.0, 0.0), at(2.0, 2.0), at(0.0, 2.0), at(2.0, 0.0));
        assert_eq!(meeting, Some((Meeting::Cross, 0.5, 0.5)));
    }

    #[test]
    fn an_end_on_a_segment_touches_and_beside_it_does_not() {
        let (a, b) = (at(0.0, 0.0), at(4.0, 0.0));
        let touch = meet(a, b, at(1.0, 0.0), at(1.0, 5.0));
        assert_eq!(touch, Some((Meeting::Touch, 0.25, 0.0)));
        assert_eq!(meet(a, b, at(1.0, f64::MIN_POSITIVE), at(1.0, 5.0)), None);
        assert_eq!(
            meet(a, b, b, at(5.0, 5.0)),
            Some((Meeting::Touch, 1.0, 0.0))
        );
    }

    #[test]
    fn segments_of_one_line_overlap_touch_or_miss() {
        let (a, b) = (at(0.0, 0.0), at(4.0, 4.0));
        let overlap = meet(a, b, at(8.0, 8.0), at(3.0, 3.0));
        assert_eq!(overlap, Some((Meeting::Overlap, 0.75, 1.0)));
        let touch = meet(a, b, at(4.0, 4.0), at(5.0, 5.0));
        assert_eq!(touch, Some((Meeting::Touch, 1.0, 0.0)));
        assert_eq!(meet(a, b, at(5.0, 5.0), at(6.0, 6.0)), None);
    }

    #[test]
    fn a_segment_of_no_length_is_a_point() {
        let (a, b, p) = (at(0.0, 0.0), at(4.0, 2.0), at(2.0, 1.0));
        assert_eq!(meet(p, p, a, b), Some((Meeting::Touch, 0.0, 0.5)));
        assert_eq!(meet(p, p, p, p), Some((Meeting::Touch, 0.0, 0.0)));
        assert_eq!(meet(p, p, a, at(4.0, 2.1)), None);
    }

    proptest! {
        /// On a small lattice whole numbers decide exactly.
        #[test]
        fn the_sign_is_that_of_whole_numbers(
            p in prop::array::uniform6(-30_000_000i64..30_000_000),
            shift in -1i64..=1,
        ) {
            // c on the line through a and b, or one unit beside it
            let [ax, ay, bx, by, _, _] = p;
            let (cx, cy) = (2 * bx - ax, 2 * by - ay + shift);
            let whole = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
            let scale = 1.0 / 1024.0; // exact
            let point = |x: i64, y: i64| at(x as f64 * scale + 1e3, y as f64 * scale + 1e3);
            let sign = orientation(point(ax, ay), point(bx, by), point(cx, cy));
            prop_assert_eq!(sign.partial_cmp(&0.0).unwrap(), whole.cmp(&0));
        }

        #[test]
        fn two_segments_meet_as_seen_from_either(p in prop::array::uniform8(0i32..7)) {
            let q = p.map(f64::from);
            let (a, b, c, d) = (at(q[0], q[1]), at(q[2], q[3]), at(q[4], q[5]), at(q[6], q[7]));
            let kind = meet(a, b, c, d).map(|m| m.0);
            for other in [meet(c, d, a, b), meet(b, a, c, d), meet(a, b, d, c)] {
                prop_assert_eq!(kind, other.map(|m| m.0));
            }
            if let Some((_, t, u)) = meet(a, b, c, d) {
                // both fractions name one point, within rounding of numbers below 8
                prop_assert!((a.lerp(b, t) - c.lerp(d, u)).length() < 1e-14);
            }
        }
    }
}
