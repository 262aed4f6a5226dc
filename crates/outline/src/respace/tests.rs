//! Spacing within bounds, and none asked for twice.

use super::*;
use proptest::prelude::*;

fn circle(radius: f64, n: usize) -> Vec<DVec2> {
    let angle = |i: usize| std::f64::consts::TAU * i as f64 / n as f64;
    (0..n)
        .map(|i| radius * DVec2::from_angle(angle(i)))
        .collect()
}

fn edges(nodes: &[DVec2], closed: bool) -> Vec<f64> {
    crate::place::edges(nodes, closed)
        .map(|edge| edge.length())
        .collect()
}

const BOUNDS: Bounds = Bounds {
    least: 1.0,
    most: 3.0,
    fewest: 3,
};

#[test]
fn an_edge_too_long_is_halved_and_one_too_short_is_joined() {
    let nodes = [0.0, 4.0, 6.0, 6.5, 8.5].map(|x| DVec2::new(x, 0.0));
    let plan = respace(&nodes, false, &BOUNDS, Between::Chord, &[]).unwrap();
    let xs: Vec<f64> = plan.draw(&nodes).unwrap().iter().map(|v| v.x).collect();
    assert_eq!(xs, [0.0, 2.0, 4.0, 6.0, 8.5]);
    assert_eq!((plan.inserted(), plan.removed()), (1, 1));
    assert_eq!(plan.convex(1), [(0, 0.5), (1, 0.5)]);
}

#[test]
fn kept_nodes_and_ends_stay() {
    let nodes = [0.0, 0.1, 0.2, 2.0].map(|x| DVec2::new(x, 0.0));
    let plan = respace(&nodes, false, &BOUNDS, Between::Chord, &[1]).unwrap();
    let xs: Vec<f64> = plan.draw(&nodes).unwrap().iter().map(|v| v.x).collect();
    assert_eq!(xs, [0.0, 0.1, 2.0]);
    let few = Bounds {
        fewest: 4,
        ..BOUNDS
    };
    assert!(
        respace(&nodes, false, &few, Between::Chord, &[])
            .unwrap()
            .is_identity()
    );
}

#[test]
fn nodes_put_into_a_circle_lie_on_it_to_fourth_order() {
    let off = |n: usize| {
        let nodes = circle(10.0, n);
        let spacing = edges(&nodes, true)[0];
        let bounds = Bounds {
            least: 0.3 * spacing,
            most: 0.9 * spacing,
            fewest: 3,
        };
        let plan = respace(&nodes, true, &bounds, Between::Cubic, &[]).unwrap();
        assert_eq!(plan.inserted(), n);
        let new = plan.draw(&nodes).unwrap();
        new.iter()
            .map(|v| (v.length() - 10.0).abs())
            .fold(0.0, f64::max)
    };
    // the cubic's error at the middle is 3/128 h⁴ f''''
    let order = (off(16) / off(32)).log2();
    assert!((order - 4.0).abs() < 0.1, "{order}");
    assert!(off(64) < 1e-4);
}

#[test]
fn breathing_in_and_out_does_not_flicker() {
    // a ring that grows and shrinks by a tenth, around a length at which edges are divided
    let mut nodes = circle(10.0, 21);
    let spacing = edges(&nodes, true)[0];
    let bounds = Bounds {
        least: 0.4 * spacing,
        most: spacing,
        fewest: 8,
    };
    let mut changes = 0;
    for step in 0..200 {
        let factor = 1.0 + 0.1 * (f64::from(step) * 0.3).sin();
        let mean = nodes.iter().map(|v| v.length()).sum::<f64>() / nodes.len() as f64;
        nodes.iter_mut().for_each(|v| *v *= 10.0 * factor / mean);
        let plan = respace(&nodes, true, &bounds, Between::Cubic, &[]).unwrap();
        changes += usize::from(!plan.is_identity());
        nodes = plan.draw(&nodes).unwrap();
    }
    assert_eq!(changes, 1, "divided once, and never joined");
}

#[test]
fn sliding_evens_out_a_circle_and_moves_nodes_the_least() {
    // uneven by up to half an edge, and turned
    let n = 40;
    let angle = |i: usize| {
        let even = std::f64::consts::TAU * i as f64 / n as f64;
        even + 0.05 * (3.0 * even).sin() + 0.3
    };
    let nodes: Vec<DVec2> = (0..n).map(|i| 10.0 * DVec2::from_angle(angle(i))).collect();
    let mut even = nodes.clone();
    for _ in 0..3 {
        even = slide(&even, true, n, Between::Cubic)
            .unwrap()
            .draw(&even)
            .unwrap();
    }
    let lengths = edges(&even, true);
    let spread = lengths.iter().copied().fold(0.0, f64::max)
        / lengths.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(spread - 1.0 < 1e-4, "{spread}");
    let mean: DVec2 = nodes.iter().zip(&even).map(|(a, b)| *b - *a).sum();
    assert!(mean.length() < 0.05 * n as f64 * 0.1);
    let turn: f64 = nodes
        .iter()
        .zip(&even)
        .map(|(a, b)| a.angle_to(*b))
        .sum::<f64>()
        / n as f64;
    assert!(
        turn.abs() < 1e-3,
        "the row as a whole is not turned: {turn}"
    );
}

#[test]
fn sliding_to_another_number_keeps_ends_and_length() {
    let nodes: Vec<DVec2> = [0.0, 1.0, 1.5, 4.0, 10.0]
        .iter()
        .map(|&x| DVec2::new(x, 0.0))
        .collect();
    let plan = slide(&nodes, false, 11, Between::Chord).unwrap();
    for (i, node) in plan.draw(&nodes).unwrap().iter().enumerate() {
        // rounding of numbers up to 10
        assert!((node.x - i as f64).abs() < 1e-14 && node.y == 0.0, "{node}");
    }
    let same = circle(3.0, 12);
    assert!(
        slide(&same, true, 12, Between::Cubic)
            .unwrap()
            .is_identity(),
        "already even"
    );
}

#[test]
fn what_cannot_be_spaced_is_refused() {
    let nodes = circle(3.0, 12);
    let narrow = Bounds {
        least: 1.0,
        most: 2.0,
        fewest: 3,
    };
    let error = respace(&nodes, true, &narrow, Between::Cubic, &[]).unwrap_err();
    assert!(
        matches!(error, OutlineError::NarrowBounds { .. }),
        "{error}"
    );
    assert!(respace(&nodes, true, &BOUNDS, Between::Cubic, &[12]).is_err());
    assert!(respace(&nodes[..2], true, &BOUNDS, Between::Cubic, &[]).is_err());
    assert!(
        respace(
            &[DVec2::ZERO, DVec2::NAN, DVec2::X],
            true,
            &BOUNDS,
            Between::Cubic,
            &[]
        )
        .is_err()
    );
    let wide = [DVec2::ZERO, DVec2::new(1e9, 0.0)];
    assert!(respace(&wide, false, &BOUNDS, Between::Cubic, &[]).is_err());
    assert!(slide(&[DVec2::ONE; 5], true, 5, Between::Cubic).is_err());
    assert!(slide(&nodes, true, 2, Between::Cubic).is_err());
}

proptest! {
    #[test]
    fn afterwards_all_edges_are_within_bounds_and_nothing_more_is_asked(
        steps in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64, -3..4i32), 3..60),
        closed: bool,
        cubic: bool,
        ratio in 2.5..6.0_f64,
    ) {
        let mut at = DVec2::ZERO;
        let nodes: Vec<DVec2> = steps
            .iter()
            .map(|&(x, y, size)| {
                at += DVec2::new(x, y) * 2.0_f64.powi(size);
                at
            })
            .collect();
        let bounds = Bounds { least: 0.7, most: 0.7 * ratio, fewest: 0 };
        let between = if cubic { Between::Cubic } else { Between::Chord };
        let plan = respace(&nodes, closed, &bounds, between, &[]).unwrap();
        let new = plan.draw(&nodes).unwrap();
        prop_assert_eq!(new.len(), plan.len());
        // no node more could be spared
        let stuck = nodes.len() - plan.removed() == if closed { 3 } else { 2 };
        for length in edges(&new, closed) {
            // 1e-9 is what the bounds leave alone
            prop_assert!(length <= bounds.most * (1.0 + 2e-9));
            prop_assert!(length >= bounds.least * (1.0 - 2e-9) || stuck, "{}", length);
        }
        let again = respace(&new, closed, &bounds, between, &[]).unwrap();
        prop_assert!(again.is_identity() || stuck);
    }

    #[test]
    fn poured_weights_are_convex_and_drawn_ones_reproduce_a_shift(
        radii in prop::collection::vec(1.0..9.0_f64, 5..30),
        shift in (-1e3..1e3_f64, -1e3..1e3_f64),
        count in 3usize..60,
    ) {
        let n = radii.len() as f64;
        let angle = |i: usize| std::f64::consts::TAU * i as f64 / n;
        let nodes: Vec<DVec2> =
            radii.iter().enumerate().map(|(i, r)| *r * DVec2::from_angle(angle(i))).collect();
        let plan = slide(&nodes, true, count, Between::Cubic).unwrap();
        for i in 0..plan.len() {
            let sum: f64 = plan.convex(i).iter().map(|(_, weight)| weight).sum();
            prop_assert!((sum - 1.0).abs() < 1e-15 && plan.convex(i).iter().all(|t| t.1 > 0.0));
            let sizes: f64 = plan.stencil(i).iter().map(|(_, weight)| weight.abs()).sum();
            prop_assert!(sizes <= SWING + 1e-12);
        }
        let moved: Vec<DVec2> = nodes.iter().map(|v| *v + DVec2::from(shift)).collect();
        for (a, b) in plan.draw(&nodes).unwrap().iter().zip(plan.draw(&moved).unwrap()) {
            prop_assert!((*a + DVec2::from(shift) - b).length() < 1e-11, "rounding at 1e3");
        }
    }
}
