//! Totals before and after, on curves of any shape.

use super::*;
use crate::{Between, Bounds, resolve, respace, slide};
use proptest::prelude::*;

fn circle(radius: f64, n: usize) -> Vec<DVec2> {
    let angle = |i: usize| std::f64::consts::TAU * i as f64 / n as f64;
    (0..n)
        .map(|i| radius * DVec2::from_angle(angle(i)))
        .collect()
}

#[test]
fn rigid_motion_stays_rigid() {
    let positions = circle(10.0, 24);
    let turn = 0.3;
    let velocities: Vec<DVec2> = positions
        .iter()
        .map(|x| DVec2::new(1.0, -2.0) + turn * x.perp())
        .collect();
    let density = vec![2.0; 24];
    let lengths = Lengths::Even(2.6);
    let body = Body {
        positions: &positions,
        velocities: &velocities,
        density: &density,
        lengths,
    };
    let before = body.motion().unwrap();
    let plan = slide(&positions, true, 61, Between::Cubic).unwrap();
    let new = plan
        .carry(&body, Lengths::Even(2.6 * 24.0 / 61.0), Totals::Kept)
        .unwrap();
    // the nodes moved out to the circle, so the same spin is a slower turn; but one turn for all
    let after = Body {
        positions: &new.positions,
        velocities: &new.velocities,
        density: &new.density,
        lengths: Lengths::Even(2.6 * 24.0 / 61.0),
    };
    let after = after.motion().unwrap();
    let slower = before.spin / after.inertia;
    for (v, x) in new.velocities.iter().zip(&new.positions) {
        let rigid = before.momentum / before.mass + slower * (*x - after.center).perp();
        assert!((*v - rigid).length() < 1e-13, "rounding of numbers near 5");
    }
    assert!((new.mass_factor - 1.0).abs() < 1e-14);
    // the spin's energy is L²/2I, so it changes as the inertia does
    let spin = before.spin * before.spin / 2.0;
    let expected = spin / after.inertia - spin / before.inertia;
    assert!(
        (new.kinetic_change - expected).abs() < 1e-11,
        "rounding of energies near 1e3"
    );
}

#[test]
fn nothing_is_lost_where_nothing_changes() {
    let positions = circle(10.0, 24);
    let velocities: Vec<DVec2> = positions
        .iter()
        .map(|x| DVec2::new(x.y * x.x, x.x))
        .collect();
    let density: Vec<f64> = (0..24).map(|i| 1.0 + f64::from(i)).collect();
    let body = Body {
        positions: &positions,
        velocities: &velocities,
        density: &density,
        lengths: Lengths::Even(1.0),
    };
    let spacing = positions[0].distance(positions[1]);
    let plan = respace(
        &positions,
        true,
        &Bounds::around(spacing),
        Between::Cubic,
        &[],
    )
    .unwrap();
    let new = plan
        .carry(&body, Lengths::Even(1.0), Totals::Handed)
        .unwrap();
    assert_eq!(new.positions, positions);
    assert_eq!(new.velocities, velocities);
    assert_eq!(new.density, density);
    assert_eq!(new.kinetic_change, 0.0);
}

#[test]
fn a_piece_is_handed_what_its_stretch_had() {
    let tie = [(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 4.0)].map(DVec2::from);
    let mut tie = tie.to_vec();
    tie.reverse();
    let velocities = [0.0, 1.0, 2.0, 3.0].map(|x| DVec2::new(x, 0.0));
    let body = Body {
        positions: &tie,
        velocities: &velocities,
        density: &[1.0; 4],
        lengths: Lengths::Even(1.0),
    };
    let piece = &resolve(&tie, 0.0).unwrap().pieces[0];
    let plan = piece.plan(&[4]).unwrap();
    let new = plan
        .carry(&body, Lengths::Even(1.0), Totals::Handed)
        .unwrap();
    assert_eq!(new.positions, piece.nodes);
    // at the cut: half of the middle of one strand, half of the other
    let cut = piece
        .origins
        .iter()
        .position(|origin| origin.is_cut())
        .unwrap();
    assert_eq!(new.velocities[cut].x, 1.5);
    assert_eq!(new.density, [1.0; 3]);
}

#[test]
fn a_body_without_mass_or_with_wrong_numbers_is_refused() {
    let positions = circle(1.0, 3);
    let body = |density: &[f64], length: f64| {
        let lengths = Lengths::Even(length);
        Body {
            positions: &positions,
            velocities: &positions,
            density,
            lengths,
        }
        .motion()
    };
    assert!(body(&[1.0; 3], 1.0).is_ok());
    assert!(body(&[0.0; 3], 1.0).is_err());
    assert!(body(&[1.0; 2], 1.0).is_err());
    assert!(body(&[1.0, -1.0, 1.0], 1.0).is_err());
    assert!(body(&[1.0; 3], f64::NAN).is_err());
    assert!(body(&[1.0, f64::INFINITY, 1.0], 1.0).is_err());
}

proptest! {
    #[test]
    fn mass_momentum_and_spin_are_kept_to_rounding(
        nodes in prop::collection::vec(
            ((-9.0..9.0_f64, -9.0..9.0_f64), (-5.0..5.0_f64, -5.0..5.0_f64), 0.0..4.0_f64, 0.1..2.0_f64),
            4..40,
        ),
        shift in (-1e3..1e3_f64, -1e3..1e3_f64),
        drift in (-10.0..10.0_f64, -10.0..10.0_f64),
        closed: bool,
        even: bool,
        cubic: bool,
        count in 4usize..80,
    ) {
        let positions: Vec<DVec2> = nodes.iter().map(|n| DVec2::from(n.0) + DVec2::from(shift)).collect();
        let velocities: Vec<DVec2> = nodes.iter().map(|n| DVec2::from(n.1) + DVec2::from(drift)).collect();
        let density: Vec<f64> = nodes.iter().map(|n| n.2 + 0.01).collect();
        let each: Vec<f64> = nodes.iter().map(|n| n.3).collect();
        let body = Body {
            positions: &positions,
            velocities: &velocities,
            density: &density,
            lengths: Lengths::Each(&each),
        };
        let between = if cubic { Between::Cubic } else { Between::Chord };
        let plan = if even {
            slide(&positions, closed, count, between).unwrap()
        } else {
            let bounds = Bounds { least: 1.0, most: 3.0, fewest: 4 };
            respace(&positions, closed, &bounds, between, &[]).unwrap()
        };
        let lengths = Lengths::Even(0.7);
        let new = plan.carry(&body, lengths, Totals::Kept).unwrap();
        let before = body.motion().unwrap();
        let (positions, velocities) = (&new.positions[..], &new.velocities[..]);
        let after = Body { positions, velocities, density: &new.density, lengths }.motion().unwrap();
        let mass = before.mass;
        // a hundred roundings or so of sums whose terms are of this size; coordinates are known to 1e-13
        let speed = (2.0 * (before.kinetic + after.kinetic) / mass).sqrt();
        let size = ((before.inertia + after.inertia) / mass).sqrt() + 1e-3;
        prop_assert!((after.mass - mass).abs() < 1e-13 * mass);
        prop_assert!((after.momentum - before.momentum).length() < 1e-12 * mass * speed);
        prop_assert!((after.spin - before.spin).abs() < 1e-12 * mass * speed * size);
        let change = after.kinetic - before.kinetic;
        prop_assert!((new.kinetic_change - change).abs() < 1e-12 * mass * speed * speed);
        let old = density.iter().copied().fold((f64::INFINITY, 0.0_f64), |(a, b), d| (a.min(d), b.max(d)));
        for density in &new.density {
            let bare = density / new.mass_factor;
            prop_assert!(bare >= old.0 * (1.0 - 1e-14) && bare <= old.1 * (1.0 + 1e-14));
        }
    }
}
