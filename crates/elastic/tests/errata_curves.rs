//! Where the report is wrong about drawn curves and their curvature, pinned with numbers. D.. are the errata's.
//!
//! D61 to D64 against the report's own numbers are in `oracle.rs`.
#![allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    reason = "a test may stop, and one that says equal means equal"
)]

use elastic::{
    ElasticError, End, Estimate, Material, Parameter, Topology, circle, curvature, spline,
    stiffness, stiffness_as_printed, turning_angle,
};
use glam::DVec2;

const ANCHORED: Topology = Topology::open(End::Anchored);

fn uneven_clicks() -> [DVec2; 4] {
    [
        DVec2::ZERO,
        DVec2::new(1.0, 0.5),
        DVec2::new(9.0, 0.0),
        DVec2::new(10.0, 6.0),
    ]
}

fn edges(nodes: &[DVec2]) -> Vec<f64> {
    nodes
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).length())
        .collect()
}

fn unevenness(nodes: &[DVec2]) -> f64 {
    let edges = edges(nodes);
    let largest = edges.iter().copied().fold(0.0, f64::max);
    largest / edges.iter().copied().fold(f64::INFINITY, f64::min)
}

#[test]
fn d61_nodes_even_in_the_click_index_are_uneven_along_the_curve() {
    let by = |parameter| spline(&uneven_clicks(), 4000, parameter, false).unwrap();
    let index = unevenness(&by(Parameter::PointIndex));
    assert!(index > 4.0, "{index}");
    // at the sharp bend by the second click a chord is a little shorter than its arc
    let arc = unevenness(&by(Parameter::ArcLength));
    assert!(arc < 1.002, "{arc}");
}

#[test]
fn d62_two_points_make_a_line_three_a_parabola_and_one_nothing() {
    let by = |points: &[DVec2]| spline(points, 9, Parameter::PointIndex, false);
    let clicks = uneven_clicks();
    let line = by(&clicks[..2]).unwrap();
    assert_eq!(line[4], DVec2::new(0.5, 0.25));
    // three points at u = 0, 1, 2: Lagrange's parabola
    for (i, node) in by(&clicks[..3]).unwrap().iter().enumerate() {
        let u = i as f64 / 4.0;
        let [a, b, c] = [clicks[0], clicks[1], clicks[2]];
        let want =
            a * ((u - 1.0) * (u - 2.0) / 2.0) + b * (u * (2.0 - u)) + c * (u * (u - 1.0) / 2.0);
        assert!((*node - want).length() < 1e-14 * 9.0, "{node} for {want}");
    }
    assert_eq!(
        by(&clicks[..1]),
        Err(ElasticError::TooFewPoints { needed: 2, got: 1 })
    );
    assert_eq!(
        by(&[]),
        Err(ElasticError::TooFewPoints { needed: 2, got: 0 })
    );
}

#[test]
fn d63_there_are_always_n_nodes_and_the_last_is_the_last_click_but_for_rounding() {
    for clicks in 2..=40 {
        let points: Vec<_> = (0..clicks).map(|i| DVec2::new(f64::from(i), 0.0)).collect();
        for n in [3, 7, 10, 50, 97, 200] {
            let nodes = spline(&points, n, Parameter::PointIndex, false).unwrap();
            assert_eq!(nodes.len(), n);
            // the errata found 7e-15 in the parameter; x is the parameter here
            let off = (nodes[n - 1] - points[points.len() - 1]).length();
            assert!(off <= 2.2e-14, "{clicks} clicks, {n} nodes: {off:e}");
        }
    }
}

#[test]
fn d64_the_last_click_belongs_to_the_curve() {
    let clicks = uneven_clicks();
    for parameter in [Parameter::PointIndex, Parameter::ArcLength] {
        let nodes = spline(&clicks, 25, parameter, false).unwrap();
        assert_eq!(nodes[0], clicks[0]);
        assert!((nodes[24] - clicks[3]).length() < 1e-14 * 10.0);
    }
}

#[test]
fn d65_fewer_nodes_than_the_bend_reaches_over_are_refused() {
    let clicks = uneven_clicks();
    let material = Material::uniform(1.0, 1.0, 1.0);
    for n in 0..3 {
        let refused = ElasticError::TooFewNodes { needed: 3, got: n };
        assert_eq!(
            spline(&clicks, n, Parameter::PointIndex, false),
            Err(refused.clone())
        );
        assert_eq!(stiffness(ANCHORED, &material, 1.0, n), Err(refused.clone()));
        assert_eq!(stiffness_as_printed(1.0, 1.0, 1.0, n), Err(refused));
    }
    let refused = ElasticError::TooFewNodes { needed: 5, got: 4 };
    assert_eq!(stiffness(Topology::Closed, &material, 1.0, 4), Err(refused));
}

#[test]
fn d71_the_printed_arc_cosine_has_no_angle_and_the_dot_product_has() {
    // edges of any length and direction, a known angle apart, on either side
    for first in [0.0, 0.9, 2.4, -3.0] {
        for angle in [0.4, -0.4, 1.9, -3.1, 1e-9] {
            let (u, w) = (
                2.0 * DVec2::from_angle(first),
                0.3 * DVec2::from_angle(first + angle),
            );
            assert!(
                (turning_angle(u, w) - angle).abs() < 2e-15,
                "{first}, {angle}"
            );
        }
    }
}

#[test]
fn d72_the_mean_of_two_edges_is_a_sum_and_the_printed_difference_would_vanish() {
    let n = 24;
    let nodes = circle(DVec2::ZERO, 5.0, n);
    // 2π/n over the chord 2 r sin(π/n), and 1/r in the limit
    let angle = std::f64::consts::TAU / n as f64;
    let want = angle / (10.0 * (0.5 * angle).sin());
    assert!((want - 0.2).abs() < 6e-4);
    for k in curvature(&nodes, true, Estimate::Turn) {
        assert!((k - want).abs() < 1e-13, "{k} for {want}");
    }
}

#[test]
fn d73_the_turn_has_a_sign_which_an_arc_cosine_loses() {
    // an S: it turns one way, then the other
    let nodes: Vec<_> = (0..41)
        .map(|i| {
            let x = f64::from(i) * 0.1;
            DVec2::new(x, (x * std::f64::consts::FRAC_PI_2).sin())
        })
        .collect();
    for estimate in Estimate::ALL {
        let k = curvature(&nodes, false, estimate);
        assert!(
            k[10] < -1.0 && k[30] > 1.0,
            "{}: {} {}",
            estimate.name(),
            k[10],
            k[30]
        );
        assert!((k[10] + k[30]).abs() < 1e-9, "{}", estimate.name());
    }
}

#[test]
fn d77_one_factor_for_all_derivatives_does_not_converge_and_one_for_each_does() {
    // nodes on a unit circle at angles that alternate between long and short steps
    let worst = |n: usize, estimate: &dyn Fn(DVec2, DVec2, DVec2) -> f64| {
        let angle = |i: usize| {
            let even = std::f64::consts::TAU * i as f64 / n as f64;
            if i.is_multiple_of(2) {
                even
            } else {
                even + 0.5 / n as f64
            }
        };
        let at = |i: usize| DVec2::from_angle(angle(i));
        (1..n)
            .map(|i| (estimate(at(i - 1), at(i), at(i + 1)) - 1.0).abs())
            .fold(0.0, f64::max)
    };
    // "corrected by a factor d_i": the second difference over d_i²
    let one_factor =
        |a: DVec2, b: DVec2, c: DVec2| ((c - b) - (b - a)).length() / (b - a).length_squared();
    let each = |a, b, c| Estimate::Formula.at(a, b, c, 1.0);
    assert!(worst(40, &one_factor) > 0.2 && worst(640, &one_factor) > 0.2);
    assert!(worst(40, &each) < 0.02);
    // sixteen times the nodes, second order: 256 times closer
    assert!(worst(640, &each) < worst(40, &each) / 200.0);
}

#[test]
fn d79_the_difference_of_two_unit_vectors_is_twice_the_sine_of_half_the_angle() {
    for degrees in [1.0, 30.0, 90.0, 135.0, 179.0_f64] {
        let theta = degrees.to_radians();
        let (u, w) = (3.0 * DVec2::X, 0.5 * DVec2::from_angle(theta));
        let length = (w.normalize() - u.normalize()).length();
        assert!(
            (length - 2.0 * (theta / 2.0).sin()).abs() < 1e-15,
            "{degrees}"
        );
        let k = Estimate::Direction.at(-u, DVec2::ZERO, w, 1.0);
        assert!(
            (k - length / 1.75).abs() < 1e-15,
            "over the mean of 3 and 0.5: {k}"
        );
    }
}
