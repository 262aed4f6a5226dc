//! The nearest point of a few edges of a curve, for whoever already knows which.

use glam::DVec2;

use crate::segments::{NONE, Nearest, Segment, side};
use crate::{Near, Spot};

/// The nearest point of these `edges` of one curve of `count` nodes; of equals the first.
///
/// `node` says where a node is: a curve on its way need not be written out. As [`Neighbours`](crate::Neighbours) would say it of the
/// whole curve, if its nearest edge is among them. None if none of them has a length. Number 0 is put for the curve.
pub fn nearest_of(
    edges: &[usize],
    (count, closed): (usize, bool),
    node: impl Fn(usize) -> DVec2,
    p: DVec2,
) -> Option<Near> {
    let segment = |edge: usize| Segment {
        a: node(edge),
        b: node((edge + 1) % count),
        curve: 0,
        edge: 0,
        before: NONE,
        after: NONE,
    };
    let mut best: Option<(usize, Nearest)> = None;
    for &edge in edges {
        let segment = segment(edge);
        let nearest = segment.nearest(p);
        // by the distance, as a whole curve is searched: squares tell apart what is equally far
        let nearer = |least: Nearest| nearest.squared.sqrt() < least.squared.sqrt();
        if segment.a != segment.b && best.is_none_or(|(_, least)| nearer(least)) {
            best = Some((edge, nearest));
        }
    }
    let (edge, nearest) = best?;
    // the edge between its neighbours, to judge the side at a node
    let last = count - usize::from(!closed);
    let before = (edge > 0 || closed).then(|| (edge + last - 1) % last);
    let after = (edge + 1 < last || closed).then(|| (edge + 1) % last);
    let mut three = [segment(edge); 3];
    if let Some(before) = before.map(segment).filter(|s| s.a != s.b) {
        three[0] = before;
        three[1].before = 0;
    }
    if let Some(after) = after.map(segment).filter(|s| s.a != s.b) {
        three[2] = after;
        three[1].after = 2;
    }
    let distance = nearest.squared.sqrt();
    let side = side(&three, 1, &nearest, p);
    let away = (p - nearest.at) / distance;
    let outward = if away.is_finite() && side.abs() > 0.0 {
        side * away
    } else {
        three[1].normal()
    };
    Some(Near {
        curve: 0,
        spot: Spot {
            edge,
            along: nearest.along,
        },
        at: nearest.at,
        distance,
        side,
        outward,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Neighbours, keep_nearest};

    #[test]
    fn all_edges_together_say_what_the_whole_curve_does() {
        // a star: corners that bulge out and cave in
        let star: Vec<DVec2> = (0..14)
            .map(|i| {
                let r = if i % 2 == 0 { 3.0 } else { 1.7 };
                r * DVec2::from_angle(std::f64::consts::TAU * f64::from(i) / 14.0)
            })
            .collect();
        for closed in [true, false] {
            let edges: Vec<usize> = (0..14 - usize::from(!closed)).collect();
            let mut all = Neighbours::default();
            all.rebuild([(&star[..], closed)], 10.0).unwrap();
            let mut found = Vec::new();
            for k in 0..400 {
                let k = f64::from(k);
                let p = DVec2::new((0.37 * k).sin(), (0.61 * k).cos()) * (0.01 * k);
                all.near_point(p, 10.0, &mut found);
                keep_nearest(&mut found);
                let here = nearest_of(&edges, (14, closed), |i| star[i], p).unwrap();
                assert_eq!(here, found[0], "{p}");
            }
        }
    }

    #[test]
    fn of_edges_without_length_there_is_none() {
        let node = |_| DVec2::ONE;
        assert_eq!(nearest_of(&[0, 1], (3, true), node, DVec2::ZERO), None);
    }
}
