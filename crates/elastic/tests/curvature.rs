//! The curvature estimates on curves whose curvature is known: measured orders.
#![allow(clippy::float_cmp, reason = "a test that says equal means equal")]

use elastic::{Estimate, circle, curvature, ellipse, turning_angle};
use glam::DVec2;
use std::f64::consts::{PI, TAU};

/// A circle whose nodes are uneven in a smooth way, the longest step three times the shortest.
fn uneven_circle(radius: f64, n: usize) -> Vec<DVec2> {
    (0..n)
        .map(|i| {
            let t = TAU * i as f64 / n as f64;
            radius * DVec2::from_angle(t + 0.5 * t.sin())
        })
        .collect()
}

/// A circle whose steps are long and short by turns: uneven however many there are.
fn rough_circle(radius: f64, n: usize) -> Vec<DVec2> {
    let angle = |i: usize| i as f64 + if i.is_multiple_of(2) { 0.0 } else { 0.3 };
    (0..n)
        .map(|i| radius * DVec2::from_angle(TAU * angle(i) / n as f64))
        .collect()
}

/// Largest error of the curvature over a closed curve, relative to `exact` at each node.
fn worst(nodes: &[DVec2], estimate: Estimate, exact: impl Fn(usize) -> f64) -> f64 {
    curvature(nodes, true, estimate)
        .iter()
        .enumerate()
        .map(|(i, k)| (k / exact(i) - 1.0).abs())
        .fold(0.0, f64::max)
}

/// The order at which an error falls when the number of nodes doubles from 128 to 256.
fn order(error: impl Fn(usize) -> f64) -> f64 {
    (error(128) / error(256)).log2()
}

#[test]
fn on_an_even_circle_two_estimates_are_exact_and_two_of_second_order() {
    let radius = 7.0;
    for estimate in Estimate::ALL {
        let error = |n| {
            worst(&circle(DVec2::new(3.0, -2.0), radius, n), estimate, |_| {
                1.0 / radius
            })
        };
        match estimate {
            // second differences of nodes 0.17 apart: rounding of 1e-15 over the square of that
            Estimate::Direction | Estimate::Difference => {
                assert!(error(256) < 1e-12, "{}: {}", estimate.name(), error(256));
            }
            Estimate::Turn | Estimate::Formula => {
                let measured = order(error);
                assert!(
                    (measured - 2.0).abs() < 0.01,
                    "{}: {measured}",
                    estimate.name()
                );
            }
        }
    }
}

#[test]
fn on_an_even_circle_the_errors_are_those_of_the_series() {
    let n = 100;
    let nodes = circle(DVec2::ZERO, 2.0, n);
    let half = PI / n as f64;
    let exact = |k: f64| move |_: usize| k;
    // θ/d = (2π/n) / (2R sin(π/n)) and 1 / (R cos²(π/n))
    let turn = half / (2.0 * half.sin());
    assert!(worst(&nodes, Estimate::Turn, exact(turn)) < 1e-12);
    let formula = 0.5 / half.cos().powi(2);
    assert!(worst(&nodes, Estimate::Formula, exact(formula)) < 1e-12);
}

#[test]
fn on_an_uneven_circle_only_the_plain_difference_does_not_converge() {
    let radius = 7.0;
    for smooth in [true, false] {
        let shape = if smooth { uneven_circle } else { rough_circle };
        for estimate in Estimate::ALL {
            let error = |n| worst(&shape(radius, n), estimate, |_| 1.0 / radius);
            if estimate == Estimate::Difference {
                assert!(
                    error(128) > 0.2 && error(1024) > 0.9 * error(128),
                    "{}",
                    error(1024)
                );
            } else {
                // 1/cos((a−b)/4) for arcs a, b: where they change smoothly, a − b is of second order
                let known = if smooth && estimate == Estimate::Direction {
                    4.0
                } else {
                    2.0
                };
                let measured = order(error);
                assert!(
                    (measured - known).abs() < 0.1,
                    "{}: {measured}",
                    estimate.name()
                );
            }
        }
    }
}

#[test]
fn on_rough_nodes_of_another_curve_the_estimates_are_of_first_order_only() {
    // an ellipse has changing curvature: the estimates see that of a place between the nodes
    let (a, b) = (3.0, 2.0);
    let angle = |i: usize, n: usize| {
        TAU * (i as f64 + if i.is_multiple_of(2) { 0.0 } else { 0.3 }) / n as f64
    };
    for estimate in [Estimate::Turn, Estimate::Direction, Estimate::Formula] {
        let error = |n: usize| {
            let nodes: Vec<_> = (0..n)
                .map(|i| DVec2::new(a, b) * DVec2::from_angle(angle(i, n)))
                .collect();
            let exact = |i: usize| {
                let (sin, cos) = angle(i, n).sin_cos();
                a * b / (a * a * sin * sin + b * b * cos * cos).powf(1.5)
            };
            worst(&nodes, estimate, exact)
        };
        let measured = order(error);
        assert!(
            (measured - 1.0).abs() < 0.1,
            "{}: {measured}",
            estimate.name()
        );
    }
}

#[test]
fn the_turns_of_any_closed_curve_without_crossing_add_up_to_one_round() {
    for nodes in [
        circle(DVec2::ZERO, 1.0, 3),
        ellipse(DVec2::new(5.0, 5.0), DVec2::new(9.0, 1.0), 1.0, 31),
        rough_circle(4.0, 50),
    ] {
        let n = nodes.len();
        let sum: f64 = (0..n)
            .map(|i| {
                let (a, b, c) = (nodes[i], nodes[(i + 1) % n], nodes[(i + 2) % n]);
                turning_angle(b - a, c - b)
            })
            .sum();
        assert!((sum - TAU).abs() < 1e-13, "rounding of fifty angles: {sum}");
    }
}

#[test]
fn walked_the_other_way_a_curve_turns_the_other_way() {
    let mut nodes = uneven_circle(2.0, 24);
    for estimate in Estimate::ALL {
        let mut forth = curvature(&nodes, true, estimate);
        nodes.reverse();
        let back = curvature(&nodes, true, estimate);
        nodes.reverse();
        forth.reverse();
        for (a, b) in forth.iter().zip(&back) {
            assert!(
                *a > 0.0 && (a + b).abs() < 1e-13 * a,
                "{}: {a} {b}",
                estimate.name()
            );
        }
    }
}

#[test]
fn ends_and_places_without_direction_count_as_straight() {
    let (a, b) = (DVec2::ZERO, DVec2::X);
    let nodes = [a, b, b, DVec2::new(2.0, 1.0), DVec2::new(2.0, 3.0)];
    for estimate in Estimate::ALL {
        let k = curvature(&nodes, false, estimate);
        assert_eq!(
            (k[0], k[1], k[2], k[4]),
            (0.0, 0.0, 0.0, 0.0),
            "{}",
            estimate.name()
        );
        assert!(k[3] > 0.0, "{}", estimate.name());
        assert!(curvature(&[], true, estimate).is_empty());
        assert_eq!(curvature(&[a], true, estimate), [0.0]);
        assert_eq!(curvature(&[a; 4], true, estimate), [0.0; 4]);
    }
}

#[test]
fn a_fold_straight_back_is_finite_by_every_estimate() {
    for estimate in Estimate::ALL {
        let k = estimate.at(DVec2::ZERO, DVec2::X, DVec2::ZERO, 1.0);
        assert!(k.is_finite(), "{}: {k}", estimate.name());
    }
    assert_eq!(
        Estimate::Turn
            .at(DVec2::ZERO, DVec2::X, DVec2::ZERO, 1.0)
            .abs(),
        PI
    );
}
