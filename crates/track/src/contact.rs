//! Objects that meet: how far they cover each other, and the common border of those in contact.

use glam::DVec2;

use crate::Outline;
use crate::ring;

/// Outlines that share less than this of the smaller one are in contact; others cross.
const CONTACT: f64 = 0.35;

/// Whether the rectangles about two curves meet.
pub(crate) fn near(a: &[DVec2], b: &[DVec2]) -> bool {
    let (low, high) = ring::bounds(a);
    let (least, most) = ring::bounds(b);
    low.cmple(most).all() && least.cmple(high).all()
}

/// The area that two curves share, as a share of the smaller one.
pub(crate) fn shared(a: &[DVec2], b: &[DVec2]) -> f64 {
    if !near(a, b) {
        return 0.0;
    }
    let (low, high) = ring::bounds(a);
    let (least, most) = ring::bounds(b);
    let (top, bottom) = (low.y.max(least.y), high.y.min(most.y));
    let rows = (bottom - top).ceil().max(1.0);
    let step = (bottom - top) / rows;
    let (mut y, mut area) = (top + 0.5 * step, 0.0);
    while y < bottom {
        let other = ring::spans(b, y);
        for [from, to] in ring::spans(a, y) {
            for [start, end] in &other {
                area += (to.min(*end) - from.max(*start)).max(0.0) * step;
            }
        }
        y += step;
    }
    let smaller = elastic::signed_area(a)
        .abs()
        .min(elastic::signed_area(b).abs());
    if smaller > 0.0 { area / smaller } else { 0.0 }
}

/// Outlines in contact end at a common border: the chord between the places where they cut each other.
pub(crate) fn parted(outlines: &mut [Outline]) {
    for i in 1..outlines.len() {
        let (before, rest) = outlines.split_at_mut(i);
        let Some(one) = rest.first_mut() else {
            continue;
        };
        for other in before {
            let seen = one.state.is_seen() && other.state.is_seen();
            if !seen || !near(&one.points, &other.points) {
                continue;
            }
            if let Some((a, b)) = bordered(&one.points, &other.points) {
                (one.points, other.points) = (a, b);
            }
        }
    }
}

/// Two closed curves in contact, each ending at the common border; None where they do not overlap, or share so much of
/// the smaller one that they cross. Nodes keep their number and order. Pixels.
#[must_use]
pub fn bordered(one: &[DVec2], other: &[DVec2]) -> Option<(Vec<DVec2>, Vec<DVec2>)> {
    let share = shared(one, other);
    let touch = share > 0.0 && share < CONTACT;
    touch.then(|| (cut_off(one, other), cut_off(other, one)))
}

/// The nodes of a curve, those inside another one put evenly on the chord from where it enters to where it leaves.
fn cut_off(curve: &[DVec2], other: &[DVec2]) -> Vec<DVec2> {
    let n = curve.len();
    let inside: Vec<bool> = curve.iter().map(|p| within(other, *p)).collect();
    let mut out = curve.to_vec();
    let Some(start) = (0..n).find(|&i| !inside[i]) else {
        return out;
    };
    let mut k = 0;
    while k < n {
        let first = (start + k) % n;
        if !inside[first] {
            k += 1;
            continue;
        }
        let run = (0..n - k).take_while(|j| inside[(first + j) % n]).count();
        let last = (first + run - 1) % n;
        let enters = crossing(curve[(first + n - 1) % n], curve[first], other, false);
        let leaves = crossing(curve[last], curve[(last + 1) % n], other, true);
        if let (Some(enters), Some(leaves)) = (enters, leaves) {
            for j in 0..run {
                let share = if run > 1 {
                    j as f64 / (run - 1) as f64
                } else {
                    0.5
                };
                out[(first + j) % n] = enters.lerp(leaves, share);
            }
        }
        k += run;
    }
    out
}

/// Whether a place lies inside a curve.
fn within(curve: &[DVec2], p: DVec2) -> bool {
    ring::spans(curve, p.y)
        .iter()
        .any(|[from, to]| p.x > *from && p.x < *to)
}

/// Where a line from `a` to `b` cuts a curve: the first place, or the last one.
fn crossing(a: DVec2, b: DVec2, curve: &[DVec2], last: bool) -> Option<DVec2> {
    let way = b - a;
    let cuts = (0..curve.len()).filter_map(|i| {
        let (p, q) = (curve[i], curve[(i + 1) % curve.len()]);
        let side = q - p;
        let across = way.perp_dot(side);
        if across.abs() < 1e-12 {
            return None;
        }
        let t = (p - a).perp_dot(side) / across;
        let s = (p - a).perp_dot(way) / across;
        ((0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&s)).then_some(t)
    });
    let t = if last {
        cuts.max_by(f64::total_cmp)
    } else {
        cuts.min_by(f64::total_cmp)
    };
    t.map(|t| a + t * way)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(center: DVec2, radius: f64) -> Vec<DVec2> {
        (0..80)
            .map(|i| {
                let angle = std::f64::consts::TAU * f64::from(i) / 80.0;
                center + radius * DVec2::from_angle(angle)
            })
            .collect()
    }

    /// The area of the lens of two circles of radius r at distance d, in closed form.
    fn lens(r: f64, d: f64) -> f64 {
        let half = (d / (2.0 * r)).acos();
        2.0 * r * r * half - 0.5 * d * (4.0 * r * r - d * d).sqrt()
    }

    #[test]
    fn the_share_of_two_circles_is_that_of_their_lens() {
        let (a, b) = (
            circle(DVec2::ZERO, 20.0),
            circle(DVec2::new(25.0, 0.0), 20.0),
        );
        let area = std::f64::consts::PI * 400.0;
        assert!((shared(&a, &b) - lens(20.0, 25.0) / area).abs() < 0.005);
        assert!(shared(&a, &circle(DVec2::new(50.0, 0.0), 20.0)).abs() < 1e-12);
    }

    #[test]
    fn what_overlaps_is_cut_at_the_chord() {
        let (a, b) = (
            circle(DVec2::ZERO, 20.0),
            circle(DVec2::new(37.0, 3.0), 20.0),
        );
        let (c, d) = (cut_off(&a, &b), cut_off(&b, &a));
        assert!(shared(&a, &b) > 0.01);
        assert!(shared(&c, &d) < 1e-3, "{}", shared(&c, &d));
        // each has lost half of the lens
        let lost = elastic::signed_area(&a) - elastic::signed_area(&c);
        let half = 0.5 * lens(20.0, DVec2::new(37.0, 3.0).length());
        assert!((lost / half - 1.0).abs() < 0.1, "{lost} {half}");
    }
}
