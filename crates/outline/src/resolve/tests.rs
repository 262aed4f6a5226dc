//! Pieces against the winding number of the curve they were cut from.

use super::*;
use crate::{crossings, distance, winding};
use proptest::prelude::*;

fn points(from: &[(f64, f64)]) -> Vec<DVec2> {
    from.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
}

fn rectangle(x: f64, y: f64, width: f64, height: f64) -> Vec<DVec2> {
    points(&[
        (x, y),
        (x + width, y),
        (x + width, y + height),
        (x, y + height),
    ])
}

fn removed(events: &[Event]) -> Vec<(f64, Removal)> {
    let loops = events.iter().filter_map(|event| match event {
        Event::LoopRemoved { area, why } => Some((*area, *why)),
        _ => None,
    });
    loops.collect()
}

#[test]
fn a_simple_outline_is_its_own_only_piece() {
    let square = rectangle(1.0, 2.0, 3.0, 3.0);
    let out = resolve(&square, 0.1).unwrap();
    assert_eq!(out.events, []);
    assert_eq!(out.pieces.len(), 1);
    assert_eq!(out.pieces[0].nodes, square);
    assert_eq!(out.pieces[0].area, 9.0);
    assert!(out.pieces[0].plan(&[4]).unwrap().is_identity());
}

#[test]
fn of_a_bow_tie_the_half_that_turns_the_right_way_is_kept() {
    // the left half runs the wrong way
    let tie = points(&[(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 4.0)]);
    let mut back = tie.clone();
    back.reverse();
    for nodes in [tie, back] {
        let out = resolve(&nodes, 0.1).unwrap();
        assert_eq!(out.pieces.len(), 1);
        assert_eq!(out.pieces[0].area, 4.0);
        assert_eq!(removed(&out.events), [(-4.0, Removal::Inverted)]);
        let cuts: Vec<usize> = (0..3)
            .filter(|&i| out.pieces[0].origins[i].is_cut())
            .collect();
        assert_eq!(cuts.len(), 1);
        assert_eq!(out.pieces[0].nodes[cuts[0]], DVec2::splat(2.0));
    }
}

#[test]
fn a_dumbbell_whose_neck_has_crossed_splits_in_two() {
    let dumbbell = points(&[
        (0.0, 0.0),
        (3.0, 0.0),
        (4.0, 2.0),
        (6.0, 2.0),
        (7.0, 0.0),
        (9.0, 0.0),
        (9.0, 3.0),
        (7.0, 3.0),
        (6.0, 1.0),
        (4.0, 1.0),
        (3.0, 3.0),
        (0.0, 3.0),
    ]);
    let out = resolve(&dumbbell, 0.1).unwrap();
    assert_eq!(out.pieces.len(), 2);
    assert!(out.events.contains(&Event::Split { pieces: 2 }));
    let lost = removed(&out.events);
    assert_eq!(lost.len(), 1);
    assert_eq!(lost[0].1, Removal::Inverted);
    let whole = out.pieces.iter().map(|piece| piece.area).sum::<f64>() + lost[0].0;
    // areas add up with their signs: rounding of numbers near 20
    assert!((whole - 0.5 * twice_area(dumbbell)).abs() < 1e-13);
    assert!(out.pieces[0].area > out.pieces[1].area, "the largest first");
}

#[test]
fn an_inverted_outline_vanishes_and_so_does_a_sliver() {
    let mut square = rectangle(0.0, 0.0, 2.0, 2.0);
    let small = resolve(&square, 5.0).unwrap();
    assert_eq!(
        small.events,
        [
            Event::LoopRemoved {
                area: 4.0,
                why: Removal::Sliver
            },
            Event::Vanished
        ]
    );
    square.reverse();
    let out = resolve(&square, 0.1).unwrap();
    assert!(out.pieces.is_empty());
    assert_eq!(
        out.events,
        [
            Event::LoopRemoved {
                area: -4.0,
                why: Removal::Inverted
            },
            Event::Vanished
        ]
    );
    let flat = points(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (1.0, 0.0)]);
    let flat = resolve(&flat, 0.1).unwrap();
    assert!(flat.pieces.is_empty());
    assert_eq!(flat.events.last(), Some(&Event::Vanished));
}

#[test]
fn a_horseshoe_whose_ends_overlap_becomes_a_disc_without_its_hole() {
    // three sides of a frame, and two arms that lie over each other at the top
    let shoe = points(&[
        (0.0, 0.0),
        (6.0, 0.0),
        (6.0, 2.0),
        (2.0, 2.0),
        (2.0, 8.0),
        (8.0, 8.0),
        (8.0, 1.0),
        (5.0, 1.0),
        (5.0, -1.0),
        (10.0, -1.0),
        (10.0, 10.0),
        (0.0, 10.0),
    ]);
    let out = resolve(&shoe, 0.1).unwrap();
    assert_eq!(out.pieces.len(), 1);
    let mut why: Vec<Removal> = removed(&out.events).iter().map(|r| r.1).collect();
    why.sort_by_key(|why| *why as u8);
    assert_eq!(why, [Removal::Hole, Removal::Nested]);
    assert_eq!(
        place(&out.pieces[0].nodes, DVec2::splat(5.0)),
        Place::Inside
    );
}

#[test]
fn nodes_that_touch_an_edge_are_moved_off_it_and_said_to_be() {
    // a notch whose tip stands on the far side
    let notched = points(&[(0.0, 0.0), (2.0, 4.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]);
    let out = resolve(&notched, 1e-3).unwrap();
    let Event::Nudged { by, .. } = out.events[0] else {
        panic!("{:?}", out.events)
    };
    assert!(by <= 4e-7 * 8.0, "{by}");
    let area: f64 = out.pieces.iter().map(|piece| piece.area).sum();
    assert!(
        (area - 8.0).abs() < 1e-4,
        "moved by 1e-6 along borders of 20: {area}"
    );
    for piece in &out.pieces {
        assert_eq!(crossings(&piece.nodes, true).unwrap(), []);
    }
}

#[test]
fn two_overlapping_squares_merge_into_one_outline() {
    let (a, b) = (rectangle(0.0, 0.0, 4.0, 4.0), rectangle(3.0, 1.0, 4.0, 2.0));
    assert_eq!(merge(&a, &b, 1.0).unwrap(), None);
    let out = merge(&a, &b, 0.5).unwrap().unwrap();
    assert_eq!(out.pieces.len(), 1);
    assert_eq!(out.pieces[0].area, 16.0 + 8.0 - 2.0);
    assert!(out.events.contains(&Event::Merged { depth: 1.0 }));
    // every node knows its own curve
    for (node, origin) in out.pieces[0].nodes.iter().zip(&out.pieces[0].origins) {
        let curve = [&a, &b][origin.arrives.curve];
        let spot = origin.arrives.spot;
        let from = curve[spot.edge].lerp(curve[(spot.edge + 1) % 4], spot.along);
        assert_eq!(from, *node);
    }
    let plan = out.pieces[0].plan(&[4, 4]).unwrap();
    let all: Vec<DVec2> = a.iter().chain(&b).copied().collect();
    assert_eq!(plan.draw(&all).unwrap(), out.pieces[0].nodes);
}

#[test]
fn an_outline_swallows_one_inside_it() {
    let (a, b) = (rectangle(0.0, 0.0, 8.0, 8.0), rectangle(3.0, 3.0, 2.0, 2.0));
    let out = merge(&b, &a, 0.0).unwrap().unwrap();
    assert_eq!(out.pieces.len(), 1);
    assert_eq!(out.pieces[0].nodes, a);
    assert_eq!(removed(&out.events), [(4.0, Removal::Nested)]);
}

#[test]
fn outlines_side_by_side_stay_two() {
    let (a, b) = (rectangle(0.0, 0.0, 4.0, 4.0), rectangle(4.0, 0.0, 4.0, 4.0));
    assert_eq!(
        merge(&a, &b, 0.0).unwrap(),
        None,
        "a shared border is no overlap"
    );
    // the same outline twice is one
    let twice = merge(&a, &a, 0.0).unwrap();
    assert_eq!(twice, None, "no node lies inside");
}

#[test]
fn what_is_no_outline_is_refused() {
    assert!(resolve(&[DVec2::ZERO, DVec2::X], 0.0).is_err());
    assert!(resolve(&[DVec2::ZERO, DVec2::X, DVec2::NAN], 0.0).is_err());
    assert!(resolve(&rectangle(0.0, 0.0, 1.0, 1.0), -1.0).is_err());
    assert!(merge(&rectangle(0.0, 0.0, 1.0, 1.0), &[], 0.0).is_err());
}

/// What must hold of any curve whatever.
fn check(nodes: &[DVec2], probes: &[DVec2], clear: f64) -> Result<(), TestCaseError> {
    let out = resolve(nodes, 0.0).unwrap();
    let lost = removed(&out.events);
    let holes = lost.iter().any(|(_, why)| *why == Removal::Hole);
    for piece in &out.pieces {
        prop_assert!(piece.area > 0.0);
        prop_assert_eq!(crossings(&piece.nodes, true).unwrap(), []);
        // every node is where its origins say, up to nudges and rounding
        let drawn = piece.plan(&[nodes.len()]).unwrap().draw(nodes).unwrap();
        for (node, from) in piece.nodes.iter().zip(&drawn) {
            prop_assert!((*node - *from).length() < clear, "{} {}", node, from);
        }
    }
    // winding adds up, so areas do: rounding, or nudges along the whole length
    let sum: f64 = out
        .pieces
        .iter()
        .map(|p| p.area)
        .chain(lost.iter().map(|l| l.0))
        .sum();
    let area = 0.5 * twice_area(nodes.iter().copied());
    let length: f64 = crate::place::edges(nodes, true)
        .map(|edge| edge.length())
        .sum();
    prop_assert!((sum - area).abs() <= clear * length, "{} {}", sum, area);
    for &p in probes.iter().filter(|&&p| distance(nodes, true, p) > clear) {
        let wound = winding(nodes, p).unwrap() > 0;
        let inside = out
            .pieces
            .iter()
            .filter(|piece| place(&piece.nodes, p) == Place::Inside)
            .count();
        prop_assert!(inside <= 1, "pieces overlap at {}", p);
        if wound {
            prop_assert_eq!(inside, 1, "{} is lost", p);
        } else {
            prop_assert!(inside == 0 || holes, "{} was outside", p);
        }
    }
    Ok(())
}

proptest! {
    #[test]
    fn pieces_cover_what_was_wound_around(
        nodes in prop::collection::vec((-10.0..10.0_f64, -10.0..10.0_f64), 3..40),
        probes in prop::collection::vec((-10.0..10.0_f64, -10.0..10.0_f64), 40),
    ) {
        check(&points(&nodes), &points(&probes), 1e-9)?;
    }

    /// On a lattice strands meet three at a time, nodes stand on edges, edges lie on edges.
    #[test]
    fn pieces_cover_what_was_wound_around_on_a_lattice(
        nodes in prop::collection::vec((0i32..6, 0i32..6), 3..30),
        probes in prop::collection::vec((0.0..6.0_f64, 0.0..6.0_f64), 40),
    ) {
        let nodes: Vec<DVec2> =
            nodes.iter().map(|&(x, y)| DVec2::new(f64::from(x), f64::from(y))).collect();
        check(&nodes, &points(&probes), 1e-4)?;
    }

    #[test]
    fn a_union_covers_both(
        radii in prop::collection::vec(2.0..5.0_f64, 24),
        shift in (-8.0..8.0_f64, -8.0..8.0_f64),
        probes in prop::collection::vec((-10.0..10.0_f64, -10.0..10.0_f64), 40),
    ) {
        let star = |radii: &[f64], at: DVec2| -> Vec<DVec2> {
            let n = radii.len() as f64;
            let angle = |i: usize| std::f64::consts::TAU * i as f64 / n;
            radii.iter().enumerate().map(|(i, r)| at + *r * DVec2::from_angle(angle(i))).collect()
        };
        let (a, b) = (star(&radii[..12], DVec2::ZERO), star(&radii[12..], shift.into()));
        if let Some(out) = merge(&a, &b, 0.0).unwrap() {
            prop_assert_eq!(out.pieces.len(), 1);
            let union = &out.pieces[0].nodes;
            prop_assert_eq!(crossings(union, true).unwrap(), []);
            let holes = removed(&out.events).iter().any(|(_, why)| *why == Removal::Hole);
            for p in points(&probes) {
                let either = place(&a, p) == Place::Inside || place(&b, p) == Place::Inside;
                let inside = place(union, p) == Place::Inside;
                prop_assert!(either == inside || (inside && holes), "{}", p);
            }
        }
    }
}
