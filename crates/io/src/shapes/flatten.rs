//! Curves as points: no edge is farther from its curve than it may be.

use std::f64::consts::TAU;

use glam::DVec2;

/// Edges that one piece of a curve may become.
const MOST_EDGES: f64 = 10_000.0;

/// Edges for a piece that may be off by `flat`.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to a small whole number"
)]
fn edges(count: f64) -> usize {
    count.ceil().clamp(1.0, MOST_EDGES) as usize
}

/// The points behind the first of a cubic Bézier curve. Its edges are off by at most an eighth of
/// its largest second derivative over the square of their number.
pub(super) fn cubic([a, b, c, d]: [DVec2; 4], flat: f64) -> Vec<DVec2> {
    let bend = (a - 2.0 * b + c).length().max((b - 2.0 * c + d).length());
    let n = edges((6.0 * bend / (8.0 * flat)).sqrt());
    let point = |i: usize| {
        let t = i as f64 / n as f64;
        let s = 1.0 - t;
        s * s * s * a + 3.0 * s * s * t * b + 3.0 * s * t * t * c + t * t * t * d
    };
    let mut points: Vec<DVec2> = (1..n).map(point).collect();
    points.push(d);
    points
}

/// [`cubic`] for a quadratic curve.
pub(super) fn quadratic([a, b, c]: [DVec2; 3], flat: f64) -> Vec<DVec2> {
    let bend = (a - 2.0 * b + c).length();
    let n = edges((2.0 * bend / (8.0 * flat)).sqrt());
    let point = |i: usize| {
        let t = i as f64 / n as f64;
        let s = 1.0 - t;
        s * s * a + 2.0 * s * t * b + t * t * c
    };
    let mut points: Vec<DVec2> = (1..n).map(point).collect();
    points.push(c);
    points
}

/// An ellipse around a center, or a part of one, with half axes along x and y: `n` edges' corners
/// from an angle on, over another, the last left out.
pub(super) fn arc(center: DVec2, radii: DVec2, [from, over]: [f64; 2], flat: f64) -> Vec<DVec2> {
    let largest = radii.abs().max_element();
    // an edge over the angle 2 w is off by r (1 - cos w)
    let half = (1.0 - (flat / largest.max(flat)).min(1.0)).acos();
    let n = edges((over.abs() / (2.0 * half)).max(12.0 * over.abs() / TAU));
    let point = |i: usize| {
        let angle = from + over * i as f64 / n as f64;
        center + radii * DVec2::from_angle(angle)
    };
    (0..n).map(point).collect()
}

/// A whole ellipse.
pub(super) fn ellipse(center: DVec2, radii: DVec2, flat: f64) -> Vec<DVec2> {
    arc(center, radii, [0.0, TAU], flat)
}

/// A rectangle from a corner on, its corners rounded by quarters of ellipses.
pub(super) fn rectangle(corner: DVec2, size: DVec2, radii: DVec2, flat: f64) -> Vec<DVec2> {
    let radii = radii.min(size / 2.0);
    let far = corner + size;
    if radii.min_element() <= 0.0 {
        return vec![
            corner,
            DVec2::new(far.x, corner.y),
            far,
            DVec2::new(corner.x, far.y),
        ];
    }
    let (low, high) = (corner + radii, far - radii);
    let centers = [
        (high.x, low.y, 3.0),
        (high.x, high.y, 0.0),
        (low.x, high.y, 1.0),
        (low.x, low.y, 2.0),
    ];
    let quarter = TAU / 4.0;
    let mut points = Vec::new();
    for (x, y, turn) in centers {
        let center = DVec2::new(x, y);
        points.extend(arc(center, radii, [turn * quarter, quarter], flat));
        let end = DVec2::from_angle((turn + 1.0) * quarter);
        points.push(center + radii * end);
    }
    points
}

/// The points behind the first of an SVG's arc: from `from` to `to`, of an ellipse whose axes are
/// turned by an angle, the longer way if `large`, with growing angles if `sweep`.
pub(super) fn svg_arc(
    [from, to]: [DVec2; 2],
    radii: DVec2,
    turned: f64,
    [large, sweep]: [bool; 2],
    flat: f64,
) -> Vec<DVec2> {
    let radii = radii.abs();
    if radii.min_element() <= 0.0 || from == to {
        return vec![to];
    }
    // in a frame in which the ellipse is a circle of radius 1, around the middle of the ends
    let axis = DVec2::from_angle(turned);
    let into = |p: DVec2| DVec2::new(axis.dot(p), axis.perp_dot(p)) / radii;
    let back = |p: DVec2| {
        let p = p * radii;
        DVec2::new(axis.x * p.x - axis.y * p.y, axis.y * p.x + axis.x * p.y)
    };
    let half = into((to - from) / 2.0);
    // radii that are too small to reach are enlarged
    let reach = half.length();
    let scale = reach.max(1.0);
    let half = half / scale;
    let off = (1.0 - half.length_squared()).max(0.0).sqrt();
    let side = if large == sweep { -1.0 } else { 1.0 };
    let center = half.normalize_or_zero().perp() * (off * side);
    let (begin, end) = ((-half - center).to_angle(), (half - center).to_angle());
    let mut over = end - begin;
    if sweep && over < 0.0 {
        over += TAU;
    } else if !sweep && over > 0.0 {
        over -= TAU;
    }
    let middle = f64::midpoint(from.x, to.x);
    let middle = DVec2::new(middle, f64::midpoint(from.y, to.y));
    let flat = flat / (radii.max_element() * scale);
    let circle = arc(center, DVec2::ONE, [begin, over], flat);
    let points = circle.into_iter().skip(1);
    let mut points: Vec<DVec2> = points.map(|p| middle + back(p * scale)).collect();
    points.push(to);
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::rings::area;

    #[test]
    fn an_ellipse_is_as_near_as_asked() {
        for flat in [0.1, 1e-3] {
            let points = ellipse(DVec2::ZERO, DVec2::new(50.0, 20.0), flat);
            for (a, b) in points.iter().zip(points.iter().cycle().skip(1)) {
                let middle = (*a + *b) / 2.0 / DVec2::new(50.0, 20.0);
                assert!((1.0 - middle.length()) * 20.0 <= flat);
            }
        }
    }

    #[test]
    fn arcs_go_the_way_their_flags_say() {
        let ends = [DVec2::new(10.0, 0.0), DVec2::new(0.0, 10.0)];
        // by the standard's picture of the four arcs: the small one around (0, 0) or (10, 10)
        for (large, sweep, center) in [
            (false, true, (0.0, 0.0)),
            (false, false, (10.0, 10.0)),
            (true, true, (10.0, 10.0)),
            (true, false, (0.0, 0.0)),
        ] {
            let points = svg_arc(ends, DVec2::splat(10.0), 0.3, [large, sweep], 1e-3);
            for p in &points {
                let off = p.distance(DVec2::from(center)) - 10.0;
                assert!(off.abs() < 1e-9, "{large} {sweep}: {p}");
            }
            let mut ring = vec![ends[0]];
            ring.extend(points);
            let quarter = TAU * 12.5 - 50.0;
            let whole = if large { TAU * 50.0 - quarter } else { quarter };
            let sign = if sweep { 1.0 } else { -1.0 };
            assert!(
                (area(&ring) - sign * whole).abs() < 0.1,
                "{large} {sweep}: {}",
                area(&ring)
            );
        }
        // half an ellipse that is scaled up to reach
        let ends = [DVec2::new(0.0, 0.0), DVec2::new(20.0, 0.0)];
        let points = svg_arc(ends, DVec2::new(1.0, 2.0), 0.0, [false, true], 1e-3);
        let top = points.iter().map(|p| p.y).fold(0.0, f64::min);
        assert!((top + 20.0).abs() < 1e-2, "{top}");
    }

    #[test]
    fn a_cubic_is_as_near_as_asked() {
        let four = [(0.0, 0.0), (0.0, 30.0), (40.0, 30.0), (40.0, 0.0)].map(DVec2::from);
        let coarse = cubic(four, 0.1);
        let fine = cubic(four, 1e-5);
        let mut ring = vec![four[0]];
        ring.extend(&coarse);
        for p in &fine {
            let edges = ring.windows(2).map(|pair| {
                let (a, d) = (pair[0], pair[1] - pair[0]);
                let t = ((*p - a).dot(d) / d.length_squared()).clamp(0.0, 1.0);
                p.distance(a + t * d)
            });
            assert!(edges.fold(f64::INFINITY, f64::min) <= 0.1);
        }
    }
}
