//! Splines and arc length against slow twins and known curves.
#![allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    reason = "a test may stop, and one that says equal means equal"
)]

use elastic::{ElasticError, Parameter, circle, resample, spline};
use glam::DVec2;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 64,
        rng_seed: RngSeed::Fixed(1988),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// Clicks at some distance from each other: no cusps but by accident.
fn clicks(least: usize) -> impl Strategy<Value = Vec<DVec2>> {
    let point = (0.0..100.0, 0.0..100.0).prop_map(|(x, y)| DVec2::new(x, y));
    prop::collection::vec(point, least..12)
}

/// The obvious way: a hundred thousand chords, added up, and cut at even lengths.
fn even_nodes_by_chords(points: &[DVec2], n: usize, closed: bool) -> Vec<DVec2> {
    const FINE: usize = 100_001;
    let mut fine = spline(points, FINE, Parameter::PointIndex, closed).unwrap();
    if closed {
        fine.push(fine[0]);
    }
    let mut lengths = vec![0.0];
    for pair in fine.windows(2) {
        lengths.push(lengths[lengths.len() - 1] + (pair[1] - pair[0]).length());
    }
    let total = lengths[lengths.len() - 1];
    let steps = if closed { n } else { n - 1 };
    (0..n)
        .map(|i| {
            let wanted = total * i as f64 / steps as f64;
            let after = lengths
                .partition_point(|&l| l <= wanted)
                .clamp(1, fine.len() - 1);
            let part = (wanted - lengths[after - 1]) / (lengths[after] - lengths[after - 1]);
            fine[after - 1].lerp(fine[after], part)
        })
        .collect()
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn nodes_even_in_arc_length_are_where_the_chords_say(
        points in clicks(3), n in 5_usize..40, closed: bool,
    ) {
        let nodes = spline(&points, n, Parameter::ArcLength, closed).unwrap();
        for (node, twin) in nodes.iter().zip(even_nodes_by_chords(&points, n, closed)) {
            // chords of 1e-2 on curves bent as sharply as 1e-2 are short by parts of 1e-5
            prop_assert!((*node - twin).length() < 1e-4, "{} for {}", node, twin);
        }
    }

    #[test]
    fn a_spline_passes_through_its_points(points in clicks(3), closed: bool) {
        let pieces = if closed { points.len() } else { points.len() - 1 };
        let n = if closed { 4 * pieces } else { 4 * pieces + 1 };
        let nodes = spline(&points, n, Parameter::PointIndex, closed).unwrap();
        for (i, point) in points.iter().enumerate() {
            prop_assert!((nodes[4 * i] - *point).length() < 1e-12 * 100.0, "point {}", i);
        }
    }

    #[test]
    fn a_spline_moves_and_turns_with_its_points(
        points in clicks(3), angle in -3.0..3.0_f64, closed: bool, index: bool,
    ) {
        let moved = |p: DVec2| DVec2::from_angle(angle).rotate(p) + DVec2::new(17.0, -4.0);
        let parameter = if index { Parameter::PointIndex } else { Parameter::ArcLength };
        let nodes = spline(&points, 11, parameter, closed).unwrap();
        let turned: Vec<_> = points.iter().map(|&p| moved(p)).collect();
        for (a, b) in nodes.iter().zip(spline(&turned, 11, parameter, closed).unwrap()) {
            prop_assert!((moved(*a) - b).length() < 1e-9, "{} for {}", b, moved(*a));
        }
    }
}

#[test]
fn a_not_a_knot_spline_is_exact_for_every_cubic() {
    let cubic = |u: f64| DVec2::new(1.0 + u * (2.0 - u * (3.0 - 0.5 * u)), u * u * u - 4.0 * u);
    for count in [4, 5, 9] {
        let points: Vec<_> = (0..count).map(|i| cubic(f64::from(i))).collect();
        let nodes = spline(&points, 33, Parameter::PointIndex, false).unwrap();
        for (i, node) in nodes.iter().enumerate() {
            let want = cubic(i as f64 * f64::from(count - 1) / 32.0);
            // values up to 480
            assert!(
                (*node - want).length() < 1e-12 * 480.0,
                "{count} points: {node} for {want}"
            );
        }
    }
}

#[test]
fn a_periodic_spline_has_one_turn_of_direction_and_bend_at_its_seam() {
    // the seam is a knot like the others: begun one point later, the curve is the same
    let points: Vec<_> = [(0.0, 0.0), (4.0, 1.0), (5.0, 5.0), (2.0, 7.0), (-2.0, 3.0)]
        .map(|(x, y)| DVec2::new(x, y))
        .to_vec();
    for count in [3, 4, 5] {
        let mut points = points[..count].to_vec();
        let nodes = spline(&points, 8 * count, Parameter::PointIndex, true).unwrap();
        points.rotate_left(1);
        let shifted = spline(&points, 8 * count, Parameter::PointIndex, true).unwrap();
        for i in 0..8 * count {
            let off = shifted[i] - nodes[(i + 8) % (8 * count)];
            assert!(off.length() < 1e-13, "{count} points, node {i}: {off}");
        }
    }
}

#[test]
fn a_closed_spline_through_a_circle_is_round_to_fourth_order() {
    let error = |count: usize| {
        let points = circle(DVec2::ZERO, 10.0, count);
        let nodes = spline(&points, 8 * count, Parameter::PointIndex, true).unwrap();
        nodes
            .iter()
            .map(|v| (v.length() - 10.0).abs())
            .fold(0.0, f64::max)
    };
    let order = (error(16) / error(32)).log2();
    assert!((order - 4.0).abs() < 0.1, "{order}");
}

#[test]
fn arc_length_is_even_to_twelve_digits() {
    // nodes of a spline through a circle: the arcs between them are equal, so the chords nearly are;
    // by symmetry, 24 nodes on 12 points must come in pairs of exactly equal chords
    let nodes = spline(
        &circle(DVec2::ZERO, 10.0, 12),
        24,
        Parameter::ArcLength,
        true,
    )
    .unwrap();
    let chords: Vec<_> = (0..24)
        .map(|i| (nodes[(i + 1) % 24] - nodes[i]).length())
        .collect();
    for chord in &chords {
        assert!(
            (chord - chords[0]).abs() < 1e-12 * 10.0,
            "{chord} for {}",
            chords[0]
        );
    }
    // a line needs no quadrature: u is the length
    let line = [
        DVec2::ZERO,
        DVec2::new(3.0, 4.0),
        DVec2::new(6.0, 8.0),
        DVec2::new(9.0, 12.0),
    ];
    for (i, v) in spline(&line, 13, Parameter::ArcLength, false)
        .unwrap()
        .iter()
        .enumerate()
    {
        assert!((v.length() - 1.25 * i as f64).abs() < 1e-13, "{v}");
    }
}

#[test]
fn the_length_of_a_parabola_is_that_of_the_book() {
    // y = x² from −1 to 1: length √5 + ½ asinh 2; halfway is the vertex
    let points = [DVec2::new(-1.0, 1.0), DVec2::ZERO, DVec2::ONE];
    let nodes = spline(&points, 5, Parameter::ArcLength, false).unwrap();
    assert!(nodes[2].length() < 1e-14, "{}", nodes[2]);
    // a quarter of the way from the end, ½ x √(1+4x²) + ¼ asinh 2x is half of its value at 1
    let arc = |x: f64| 0.5 * x * (1.0 + 4.0 * x * x).sqrt() + 0.25 * (2.0 * x).asinh();
    assert!(
        (arc(nodes[3].x) - 0.5 * arc(1.0)).abs() < 1e-13,
        "{}",
        nodes[3]
    );
    assert!((nodes[3].y - nodes[3].x.powi(2)).abs() < 1e-14);
}

#[test]
fn a_double_click_makes_a_cusp_and_no_trouble() {
    let p = DVec2::new(5.0, 1.0);
    let points = [
        DVec2::ZERO,
        p,
        p,
        DVec2::new(9.0, 6.0),
        DVec2::new(2.0, 8.0),
    ];
    for closed in [false, true] {
        for parameter in [Parameter::PointIndex, Parameter::ArcLength] {
            let nodes = spline(&points, 300, parameter, closed).unwrap();
            assert!(
                nodes.iter().all(|v| v.is_finite()),
                "{parameter:?} {closed}"
            );
        }
    }
    // straight out, and straight back in: the speed goes through zero within the first piece
    let back = [DVec2::ZERO, DVec2::X, DVec2::ZERO];
    let nodes = spline(&back, 9, Parameter::ArcLength, false).unwrap();
    for (i, v) in nodes.iter().enumerate() {
        let want = 1.0 - (1.0 - i as f64 / 4.0).abs();
        // x = 1 − (u−1)²: at the turn a length of 1e-16 is 1e-8 in u
        assert!((v.x - want).abs() < 1e-9 && v.y == 0.0, "node {i}: {v}");
    }
}

#[test]
fn an_even_circle_is_its_own_resampling() {
    let nodes = circle(DVec2::new(4.0, 4.0), 3.0, 40);
    for (a, b) in resample(&nodes, 40, true).unwrap().iter().zip(&nodes) {
        assert!((*a - *b).length() < 1e-12, "{a} for {b}");
    }
    let finer = resample(&nodes, 80, true).unwrap();
    for v in &finer {
        // a cubic spline's error on forty points: (2π/40)⁴/384 of the radius
        assert!(((*v - DVec2::splat(4.0)).length() - 3.0).abs() < 1e-5);
    }
}

#[test]
fn what_no_curve_goes_through_is_refused() {
    let p = DVec2::new(2.0, 3.0);
    for parameter in [Parameter::PointIndex, Parameter::ArcLength] {
        assert_eq!(
            spline(&[p, p, p, p], 10, parameter, false),
            Err(ElasticError::NoLength { count: 4, at: p })
        );
        assert_eq!(
            spline(&[p, DVec2::ZERO], 10, parameter, true),
            Err(ElasticError::TooFewPoints { needed: 3, got: 2 })
        );
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let refused = spline(&[DVec2::ZERO, DVec2::new(bad, 1.0)], 10, parameter, false);
            assert!(matches!(
                refused,
                Err(ElasticError::NotFinite {
                    name: "point",
                    index: 1,
                    ..
                })
            ));
        }
        let refused = spline(&[DVec2::ZERO, p, DVec2::X], 4, parameter, true).unwrap_err();
        assert_eq!(
            refused.to_string(),
            "a curve with these ends needs at least 5 nodes, got 4"
        );
    }
}
