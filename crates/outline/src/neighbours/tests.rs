//! The grid against looking at every edge.

use super::*;
use crate::place::edges;
use crate::{Place, distance, place};
use proptest::prelude::*;

/// Every edge, looked at one by one.
fn slow(
    curves: &[(Vec<DVec2>, bool)],
    (curve, node): (usize, usize),
    apart: usize,
    reach: f64,
) -> Vec<(usize, usize, f64)> {
    let p = curves[curve].0[node];
    let mut out = Vec::new();
    for (k, (nodes, closed)) in curves.iter().enumerate() {
        let n = nodes.len();
        for edge in edges(nodes, *closed) {
            let i = edge.edge as usize;
            let far = |j: usize| {
                let steps = j.abs_diff(node);
                (if *closed { steps.min(n - steps) } else { steps }) > apart
            };
            let distance = edge.nearest(p).squared.sqrt();
            if distance <= reach && (k != curve || (far(i) && far((i + 1) % n))) {
                out.push((k, i, distance));
            }
        }
    }
    out
}

fn circle(at: DVec2, radius: f64, n: usize) -> Vec<DVec2> {
    let angle = |i: usize| std::f64::consts::TAU * i as f64 / n as f64;
    (0..n)
        .map(|i| at + radius * DVec2::from_angle(angle(i)))
        .collect()
}

#[test]
fn a_ball_beside_a_ball_sees_its_nearest_edge_from_outside() {
    let (a, b) = (
        circle(DVec2::ZERO, 10.0, 40),
        circle(DVec2::new(21.0, 0.0), 10.0, 40),
    );
    let mut neighbours = Neighbours::default();
    neighbours
        .rebuild([(&a[..], true), (&b[..], true)], 2.0)
        .unwrap();
    let mut found = Vec::new();
    neighbours.near_node(0, 0, 3, 2.0, &mut found);
    keep_nearest(&mut found);
    assert_eq!(found.len(), 1);
    assert_eq!((found[0].curve, found[0].side), (1, 1.0));
    // the two nodes face each other, a pixel apart, up to the rounding of cos π
    assert!((found[0].distance - 1.0).abs() < 1e-14);
    assert!((found[0].outward - DVec2::NEG_X).length() < 1e-14);
    // its own other side is 20 away, and its neighbours do not count
    neighbours.near_node(0, 0, 3, 0.9, &mut found);
    assert_eq!(found, []);
}

#[test]
fn beside_a_node_that_is_straight_but_for_rounding_the_outside_is_outside() {
    // a stripe whose long sides lean, so that their nodes are on a line up to rounding, on either side of it
    let along = DVec2::from_angle(0.7);
    let side =
        |from: DVec2, way: f64| (0..40).map(move |i| from + way * f64::from(i) * 0.089_546 * along);
    let top = 39.0 * 0.089_546 * along - along.perp();
    let stripe: Vec<DVec2> = side(DVec2::ZERO, 1.0)
        .chain(side(top, -1.0))
        .rev()
        .collect();
    assert!(twice_the_area(&stripe) > 0.0);
    let mut neighbours = Neighbours::default();
    neighbours.rebuild([(&stripe[..], true)], 1.0).unwrap();
    let mut found = Vec::new();
    for i in 1..39 {
        for far in [1e-3, 0.098, 0.3] {
            let p = f64::from(i) * 0.089_546 * along + far * along.perp();
            neighbours.near_point(p, 0.5, &mut found);
            keep_nearest(&mut found);
            assert_eq!(found[0].side, 1.0, "node {i}, {far} px out");
        }
    }
}

fn twice_the_area(nodes: &[DVec2]) -> f64 {
    let n = nodes.len();
    (0..n).map(|i| nodes[i].perp_dot(nodes[(i + 1) % n])).sum()
}

#[test]
fn a_node_that_has_gone_in_is_told_the_way_out() {
    let (a, b) = (
        circle(DVec2::ZERO, 10.0, 40),
        circle(DVec2::new(19.0, 0.0), 10.0, 40),
    );
    let mut neighbours = Neighbours::default();
    neighbours
        .rebuild([(&a[..], true), (&b[..], true)], 2.0)
        .unwrap();
    let mut found = Vec::new();
    neighbours.near_node(0, 0, 3, 2.0, &mut found);
    keep_nearest(&mut found);
    assert_eq!((found[0].curve, found[0].side), (1, -1.0));
    assert!(found[0].signed() < 0.0);
    // out of b is to the left, and along half an edge's turn of 4.5 degrees
    assert!(found[0].outward.x < -0.99);
}

#[test]
fn nobody_is_near_nobody_and_wrong_numbers_have_no_neighbours() {
    let mut neighbours = Neighbours::default();
    let mut found = Vec::new();
    neighbours.near_point(DVec2::ZERO, 1e9, &mut found);
    assert_eq!(found, []);
    let nodes = [DVec2::ZERO, DVec2::X];
    neighbours.rebuild([(&nodes[..], false)], 1.0).unwrap();
    neighbours.near_point(DVec2::new(f64::NAN, 0.0), 1.0, &mut found);
    assert_eq!(found, []);
    neighbours.near_point(DVec2::ZERO, f64::NAN, &mut found);
    assert_eq!(found, []);
    neighbours.near_node(7, 0, 0, 1.0, &mut found);
    assert_eq!(found, []);
    neighbours.near_point(DVec2::new(0.5, 1.0), 1.0, &mut found);
    assert_eq!(found.len(), 1);
    assert_eq!(
        found[0].side, -1.0,
        "the side the inside of a positive curve would be"
    );
}

#[test]
fn a_refused_curve_leaves_nothing_behind() {
    let (good, bad) = (circle(DVec2::ZERO, 3.0, 12), [DVec2::NAN, DVec2::X]);
    let mut neighbours = Neighbours::default();
    let refused = neighbours.rebuild([(&good[..], true), (&bad[..], false)], 1.0);
    assert!(matches!(
        refused,
        Err(OutlineError::NotFinite { index: 0, .. })
    ));
    let mut found = Vec::new();
    neighbours.near_point(DVec2::ZERO, 10.0, &mut found);
    assert_eq!(found, []);
    assert!(neighbours.rebuild([(&good[..], true)], f64::NAN).is_err());
}

proptest! {
    #[test]
    fn the_grid_finds_what_every_edge_finds(
        steps in prop::collection::vec(
            prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64, -3..4i32), 1..30),
            1..6,
        ),
        closed in prop::collection::vec(any::<bool>(), 6),
        usual in 0.0..3.0_f64,
        reach in 0.0..6.0_f64,
        apart in 0usize..4,
    ) {
        let curves: Vec<(Vec<DVec2>, bool)> = steps
            .iter()
            .zip(&closed)
            .map(|(steps, &closed)| {
                let mut at = DVec2::ZERO;
                let walk = steps.iter().map(|&(x, y, size)| {
                    at += DVec2::new(x, y) * 2.0_f64.powi(size);
                    at
                });
                (walk.collect(), closed)
            })
            .collect();
        let mut neighbours = Neighbours::default();
        // filed twice: what was there before must not matter
        for usual in [1.0, usual] {
            neighbours.rebuild(curves.iter().map(|(n, c)| (&n[..], *c)), usual).unwrap();
        }
        let mut found = Vec::new();
        for (k, (nodes, _)) in curves.iter().enumerate() {
            for i in 0..nodes.len() {
                neighbours.near_node(k, i, apart, reach, &mut found);
                let quick: Vec<(usize, usize, f64)> =
                    found.iter().map(|near| (near.curve, near.spot.edge, near.distance)).collect();
                prop_assert_eq!(quick, slow(&curves, (k, i), apart, reach));
                for near in &found {
                    prop_assert!((near.outward.length() - 1.0).abs() < 1e-14, "rounding of a unit");
                }
            }
        }
    }

    #[test]
    fn the_nearest_of_a_curve_says_whether_a_point_is_inside(
        radii in prop::collection::vec(1.0..9.0_f64, 3..30),
        x in -10.0..10.0_f64,
        y in -10.0..10.0_f64,
    ) {
        let n = radii.len() as f64;
        let angle = |i: usize| std::f64::consts::TAU * i as f64 / n;
        let star: Vec<DVec2> =
            radii.iter().enumerate().map(|(i, r)| *r * DVec2::from_angle(angle(i))).collect();
        let p = DVec2::new(x, y);
        let mut neighbours = Neighbours::default();
        neighbours.rebuild([(&star[..], true)], 1.0).unwrap();
        let mut found = Vec::new();
        neighbours.near_point(p, 30.0, &mut found);
        keep_nearest(&mut found);
        prop_assert_eq!(found.len(), 1);
        prop_assert_eq!(found[0].distance, distance(&star, true, p));
        prop_assert_eq!(found[0].side < 0.0, place(&star, p) == Place::Inside);
        // outwards is where the distance grows
        let step = found[0].outward * 1e-4;
        let ahead = crate::signed_distance(&star, p + step) - found[0].signed();
        // 1 along the normal; no more than the step in any case
        prop_assert!(ahead <= 1e-4 * (1.0 + 1e-9));
    }
}

proptest! {
    /// Filed again and again while the curves move, slowly and fast, at times with other nodes: the same each time as
    /// looking at every edge.
    #[test]
    fn curves_that_move_are_found_as_by_looking_at_every_edge(
        ways in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64, 0.0..1.0_f64), 30),
        reach in 0.2..3.0_f64,
        speed in prop_oneof![Just(0.01), Just(0.1), Just(2.0)],
    ) {
        let mut curves = vec![
            (circle(DVec2::ZERO, 4.0, 24), true),
            (circle(DVec2::new(8.5, 0.3), 4.0, 31), true),
            (vec![DVec2::new(-3.0, 4.5), DVec2::new(2.0, 5.0), DVec2::new(9.0, 4.6)], false),
        ];
        let mut neighbours = Neighbours::default();
        let mut found = Vec::new();
        for (step, &(x, y, bend)) in ways.iter().enumerate() {
            for (k, (nodes, _)) in curves.iter_mut().enumerate() {
                for (i, p) in nodes.iter_mut().enumerate() {
                    let own = if (i + k + step) % 3 == 0 { bend } else { 0.3 };
                    *p += speed * own * if k == 1 { DVec2::new(-x, y) } else { DVec2::new(x, y) };
                }
            }
            if step == 17 {
                curves[0].0.pop();
            }
            let all = curves.iter().map(|(nodes, closed)| (&nodes[..], *closed));
            neighbours.rebuild(all, reach).unwrap();
            for (k, (nodes, _)) in curves.iter().enumerate() {
                for node in 0..nodes.len() {
                    neighbours.near_node(k, node, 2, reach, &mut found);
                    let each = found.iter().map(|near| (near.curve, near.spot.edge, near.distance));
                    prop_assert_eq!(each.collect::<Vec<_>>(), slow(&curves, (k, node), 2, reach));
                    // and about the point there, which has no list
                    neighbours.near_point(nodes[node], reach, &mut found);
                    let others = found.iter().filter(|near| near.curve != k).count();
                    let asked = slow(&curves, (k, node), usize::MAX / 2, reach).len();
                    prop_assert_eq!(others, asked);
                }
            }
        }
    }
}
