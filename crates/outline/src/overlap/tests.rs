//! Depths and borders that can be told by eye, and by sampling.

use super::*;
use proptest::prelude::*;

fn rectangle(x: f64, y: f64, width: f64, height: f64) -> Vec<DVec2> {
    let at = DVec2::new(x, y);
    vec![
        at,
        at + DVec2::new(width, 0.0),
        at + DVec2::new(width, height),
        at + DVec2::new(0.0, height),
    ]
}

fn circle(at: DVec2, radius: f64, n: usize) -> Vec<DVec2> {
    let angle = |i: usize| std::f64::consts::TAU * i as f64 / n as f64;
    (0..n)
        .map(|i| at + radius * DVec2::from_angle(angle(i)))
        .collect()
}

#[test]
fn depth_is_how_far_a_corner_reaches_in() {
    let a = rectangle(0.0, 0.0, 10.0, 10.0);
    assert_eq!(
        overlap_depth(&a, &rectangle(8.0, 8.0, 10.0, 10.0)).unwrap(),
        2.0
    );
    assert_eq!(
        overlap_depth(&a, &rectangle(10.0, 0.0, 5.0, 5.0)).unwrap(),
        0.0
    );
    assert_eq!(
        overlap_depth(&a, &rectangle(3.0, 4.0, 1.0, 1.0)).unwrap(),
        4.0
    );
    assert!(overlap_depth(&a, &[DVec2::NAN]).is_err());
}

#[test]
fn bars_that_cross_overlap_though_no_node_is_inside() {
    let (a, b) = (
        rectangle(0.0, 4.0, 10.0, 2.0),
        rectangle(3.0, 0.0, 4.0, 10.0),
    );
    assert_eq!(overlap_depth(&a, &b).unwrap(), 2.0);
}

#[test]
fn circles_overlap_by_what_their_centers_are_too_near() {
    let n = 400;
    let (a, b) = (
        circle(DVec2::ZERO, 10.0, n),
        circle(DVec2::new(19.0, 0.0), 10.0, n),
    );
    let depth = overlap_depth(&a, &b).unwrap();
    // nodes face each other; the polygon's edge lies r (1 − cos π/n) = 3e-4 inside the circle
    assert!((depth - 1.0).abs() < 1e-3, "{depth}");
}

#[test]
fn squares_side_by_side_share_one_side_and_the_corners_of_two() {
    let (a, b) = (rectangle(0.0, 0.0, 4.0, 4.0), rectangle(4.5, 1.0, 4.0, 2.0));
    let share = |gap: f64| shared_length((&a, true), (&b, true), gap).unwrap();
    assert_eq!(share(0.4), 0.0);
    assert_eq!(share(0.5), 2.0, "where the sides face each other");
    // round the corners of b by √(1.3² − 0.5²) = 1.2, of which 1 is left of the side; and along two sides of a
    let around = 4.0 + 2.0 * ((1.3_f64 * 1.3 - 1.0).sqrt() - 0.5);
    assert!(
        (share(1.3) - around).abs() < 1e-14,
        "rounding: {}",
        share(1.3)
    );
    assert!(shared_length((&a, true), (&b, true), f64::NAN).is_err());
}

proptest! {
    #[test]
    fn a_shared_border_is_what_samples_say(
        a in prop::collection::vec((-5.0..5.0_f64, -5.0..5.0_f64), 2..8),
        b in prop::collection::vec((-5.0..5.0_f64, -5.0..5.0_f64), 2..8),
        gap in 0.1..3.0_f64,
        closed: bool,
    ) {
        let [a, b] = [a, b].map(|from| -> Vec<DVec2> {
            from.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
        });
        let share = shared_length((&a, closed), (&b, closed), gap).unwrap();
        let samples = 2000_u32;
        let (mut sum, mut ends) = (0.0, 0.0);
        for edge in edges(&a, closed) {
            let near = |k: u32| {
                let t = (f64::from(k) + 0.5) / f64::from(samples);
                distance(&b, closed, edge.a.lerp(edge.b, t)) <= gap
            };
            let count = (0..samples).filter(|&k| near(k)).count();
            sum += edge.length() * count as f64 / f64::from(samples);
            // each of at most 8 stretches has two ends, each of half a sample
            ends += 8.0 * edge.length() / f64::from(samples);
        }
        prop_assert!((share - sum).abs() <= ends, "{} {}", share, sum);
    }
}
