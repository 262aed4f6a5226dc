//! Drawing a curve anew: exact curves, slow twins, very uneven nodes.
#![allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    reason = "a test may stop, and one that says equal means equal"
)]

use elastic::{
    ElasticError, Knots, Parameter, circle, length, resample, resample_over, segment, spline,
    turning_angle,
};
use glam::DVec2;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::f64::consts::TAU;

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 128,
        rng_seed: RngSeed::Fixed(1988),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// Points on a circle of radius 10 about the origin whose steps differ by up to `ratio` to one.
fn uneven_circle(steps: &[f64]) -> Vec<DVec2> {
    let total: f64 = steps.iter().sum();
    let mut angle = 0.0;
    steps
        .iter()
        .map(|step| {
            let here = 10.0 * DVec2::from_angle(angle);
            angle += TAU * step / total;
            here
        })
        .collect()
}

/// The largest distance from the circle, over nodes drawn anew.
fn miss(points: &[DVec2], knots: Knots) -> f64 {
    let nodes = resample_over(points, 200, knots, true).unwrap();
    nodes
        .iter()
        .map(|v| (v.length() - 10.0).abs())
        .fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn over_chords_a_very_uneven_circle_stays_one(
        steps in prop::collection::vec((-3.0..0.0_f64).prop_map(f64::exp2).prop_map(|x| x.powi(2)), 24..60),
    ) {
        let points = uneven_circle(&steps);
        let longest = steps.iter().fold(0.0, |a: f64, b| a.max(*b)) / steps.iter().sum::<f64>() * TAU;
        // a cubic over an arc of this angle misses the circle by R θ⁴/384 and some for its slopes
        let bound = 10.0 * longest.powi(4) / 50.0;
        prop_assert!(miss(&points, Knots::Chord) < bound, "{} over {}", miss(&points, Knots::Chord), bound);
    }

    #[test]
    fn nodes_drawn_anew_are_even_and_keep_the_ends(
        x in prop::collection::vec((0.0..100.0, 0.0..100.0), 3..12), n in 6_usize..40, closed: bool, half: bool,
    ) {
        let points: Vec<_> = x.into_iter().map(|(x, y)| DVec2::new(x, y)).collect();
        let knots = if half { Knots::Centripetal } else { Knots::Chord };
        let nodes = resample_over(&points, n, knots, closed).unwrap();
        prop_assert_eq!(nodes[0], points[0]);
        if !closed {
            prop_assert_eq!(nodes[n - 1], points[points.len() - 1]);
        }
        // a finer curve from the same spline is cut by the same lengths: its chords say so
        let fine = resample_over(&points, if closed { 64 * n } else { 64 * (n - 1) + 1 }, knots, closed).unwrap();
        let whole = length(&fine, closed);
        let steps = if closed { n } else { n - 1 };
        for (i, node) in nodes.iter().enumerate() {
            // twice the same place by two tables, each to 1e-12 of the length; cusps are rare and wider
            prop_assert!((*node - fine[64 * i]).length() < 1e-8 * whole, "node {}", i);
        }
        for i in 0..steps {
            let upper = if i + 1 == n { fine.len() } else { 64 * (i + 1) };
            let part = length(&fine[64 * i..=upper.min(fine.len() - 1)], false);
            let closing = if upper == fine.len() { (fine[0] - fine[fine.len() - 1]).length() } else { 0.0 };
            // chords cut corners: by parts of a hundredth where a curve turns within a few of them
            prop_assert!((part + closing - whole / steps as f64).abs() < 0.02 * whole / steps as f64);
        }
    }

    #[test]
    fn drawing_anew_moves_turns_and_scales_with_the_curve(
        x in prop::collection::vec((0.0..100.0, 0.0..100.0), 3..12), angle in -3.0..3.0_f64, closed: bool,
        scale in 0.01..100.0_f64,
    ) {
        let points: Vec<_> = x.into_iter().map(|(x, y)| DVec2::new(x, y)).collect();
        let turn = DVec2::from_angle(angle);
        let place = |v: &DVec2| scale * turn.rotate(*v) + DVec2::new(30.0, -20.0);
        let moved: Vec<_> = points.iter().map(place).collect();
        let nodes = resample(&points, 17, closed).unwrap();
        for (a, b) in resample(&moved, 17, closed).unwrap().iter().zip(&nodes) {
            // 1e-12 of the length by each table; cusps are wider
            prop_assert!((*a - place(b)).length() < 1e-6 * (scale * 100.0 + 30.0));
        }
    }
}

#[test]
fn where_the_index_makes_wiggles_the_chord_hardly_does() {
    // a square corner with two nodes close together, then a long edge
    let points = [
        DVec2::new(0.0, 0.0),
        DVec2::new(10.0, 0.0),
        DVec2::new(10.0, 0.1),
        DVec2::new(10.0, 10.0),
        DVec2::new(0.0, 10.0),
    ];
    // a convex curve turns round once in all; wiggles and loops turn more
    let turns = |knots| {
        let c = resample_over(&points, 2000, knots, true).unwrap();
        let edge = |i: usize| c[(i + 1) % 2000] - c[i % 2000];
        let angle = |i| turning_angle(edge(i), edge(i + 1)).abs();
        (0..2000).map(angle).sum::<f64>() / TAU
    };
    assert!(turns(Knots::Index) > 1.5, "{}", turns(Knots::Index));
    assert!(
        turns(Knots::Centripetal) < 1.2,
        "{}",
        turns(Knots::Centripetal)
    );
    assert!(turns(Knots::Chord) < 1.1, "{}", turns(Knots::Chord));
}

#[test]
fn on_even_points_all_knots_draw_the_same_curve() {
    let points = circle(DVec2::new(3.0, 4.0), 7.0, 20);
    let index = resample_over(&points, 33, Knots::Index, true).unwrap();
    assert_eq!(
        index,
        spline(&points, 33, Parameter::ArcLength, true).unwrap()
    );
    for knots in [Knots::Centripetal, Knots::Chord] {
        let other = resample_over(&points, 33, knots, true).unwrap();
        for (a, b) in index.iter().zip(&other) {
            assert!((*a - *b).length() < 1e-11, "{knots:?}: {a} {b}");
        }
    }
    // an open arc too: with even widths both are not-a-knot
    let index = resample_over(&points[..9], 33, Knots::Index, false).unwrap();
    let chord = resample_over(&points[..9], 33, Knots::Chord, false).unwrap();
    for (a, b) in index.iter().zip(&chord) {
        assert!((*a - *b).length() < 1e-11, "{a} {b}");
    }
}

#[test]
fn over_chords_of_smoothly_uneven_nodes_the_curve_is_of_fourth_order() {
    let error = |n: usize| {
        let steps: Vec<f64> = (0..n)
            .map(|i| 1.0 + 0.8 * (TAU * i as f64 / n as f64).sin())
            .collect();
        miss(&uneven_circle(&steps), Knots::Chord)
    };
    let order = (error(40) / error(80)).log2();
    assert!((order - 4.0).abs() < 0.2, "{order}");
}

#[test]
fn a_straight_rod_stays_straight_however_its_nodes_lie() {
    let places = [0.0, 1e-9, 1.0, 1.5, 1.5 + 1e-6, 900.0, 1000.0];
    let rod: Vec<_> = places.map(|x| DVec2::new(3.0 * x, 4.0 * x)).to_vec();
    let even = resample(&rod, 11, false).unwrap();
    for (a, b) in even
        .iter()
        .zip(segment(DVec2::ZERO, DVec2::new(3e3, 4e3), 11))
    {
        assert!((*a - b).length() < 1e-7, "{a} for {b}");
    }
}

#[test]
fn neighbours_that_coincide_count_once_and_too_few_others_are_refused() {
    let mut points = circle(DVec2::ZERO, 5.0, 12);
    let plain = resample(&points, 20, true).unwrap();
    points.insert(4, points[3]);
    points.push(points[0]);
    assert_eq!(resample(&points, 20, true).unwrap(), plain);
    let two = [DVec2::ZERO, DVec2::X, DVec2::X, DVec2::ZERO];
    assert_eq!(
        resample(&two, 9, true),
        Err(ElasticError::TooFewPoints { needed: 3, got: 2 })
    );
    let line = resample(&two[..3], 5, false).unwrap();
    assert!((line[2] - DVec2::new(0.5, 0.0)).length() < 1e-15);
}

#[test]
fn what_would_overflow_or_is_no_number_is_refused_with_its_place() {
    for bad in [1e151, -1e200, f64::MAX] {
        let points = [DVec2::ZERO, DVec2::X, DVec2::new(0.0, bad)];
        for refused in [
            resample(&points, 9, true).unwrap_err(),
            spline(&points, 9, Parameter::ArcLength, false).unwrap_err(),
        ] {
            assert!(
                matches!(
                    refused,
                    ElasticError::TooFar {
                        name: "point",
                        index: 2,
                        ..
                    }
                ),
                "{refused}"
            );
        }
    }
    // as far as the door lets through, everything is still a number
    let far = [
        DVec2::ZERO,
        DVec2::new(1e150, 0.0),
        DVec2::new(1e150, -1e150),
    ];
    for closed in [false, true] {
        for knots in [Knots::Index, Knots::Chord, Knots::Centripetal] {
            let nodes = resample_over(&far, 9, knots, closed).unwrap();
            assert!(nodes.iter().all(|v| v.is_finite()), "{knots:?} {closed}");
        }
    }
    let nan = resample(&[DVec2::NAN, DVec2::X], 9, false).unwrap_err();
    assert!(matches!(nan, ElasticError::NotFinite { index: 0, .. }));
    let few = resample(&[DVec2::ZERO, DVec2::X], 2, false).unwrap_err();
    assert_eq!(few, ElasticError::TooFewNodes { needed: 3, got: 2 });
}
