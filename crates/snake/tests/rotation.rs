//! A body frame that turns with the best fit of the rest shape: report §5.2.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a snake that cannot be built should stop it"
)]

use crate::common;

use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::sync::Arc;

use crate::spin::{N, body, farthest, go, spinning};
use elastic::{Material, Motion, Topology};
use field::{EdgeForce, ForceField, Grid, Smoothing, edge_force};
use glam::DVec2;
use integrator::{Scheme, Start, State};
use snake::{Body, Frame, Ledger, Sampling, Snake, Term, Turn, World};
use {banded as _, outline as _, proptest as _, thiserror as _};

fn turned(state: &State, by: DVec2) -> State {
    State {
        x: state.x.iter().map(|&p| by.rotate(p)).collect(),
        v: state.v.iter().map(|&p| by.rotate(p)).collect(),
        ..state.clone()
    }
}

#[test]
fn a_rigid_rotation_costs_nothing_where_the_frame_turns() {
    let state = turned(
        &spinning(&body(Frame::turning()), 0.0, 0.0),
        DVec2::from_angle(2.5),
    );
    for (frame, free) in [(Frame::turning(), true), (Frame::corrected(), false)] {
        let mut snake = Snake::new(body(frame), World::default()).unwrap();
        let energy = snake.energies(&state).elastic();
        let mut force = vec![DVec2::ZERO; N];
        snake.strain_force(&state.x, &mut force);
        let strongest = force.iter().map(|f| f.length()).fold(0.0, f64::max);
        // stiffnesses of some tens and places of 50: rounding of 1e-12
        assert_eq!(strongest < 1e-11, free, "{strongest}");
        assert_eq!(energy < 1e-20, free, "{energy}");
        let mut e = vec![DVec2::ZERO; N];
        snake.deformation_into(&state.x, &mut e);
        assert_eq!(elastic::rms(&e) < 1e-12, free);
    }
}

#[test]
fn the_force_of_a_turning_rest_shape_is_minus_the_gradient_of_the_least_energy() {
    let body = body(Frame::turning());
    let h = body.spacing;
    let mut state = turned(&spinning(&body, 0.0, 0.2), DVec2::from_angle(1.0));
    let mut snake = Snake::new(body, World::default()).unwrap();
    let mut force = vec![DVec2::ZERO; N];
    snake.strain_force(&state.x, &mut force);
    let center = snake.center(&state.x);
    let arms = state.x.iter().zip(&force);
    let torque: f64 = arms.map(|(x, f)| (*x - center).perp_dot(*f)).sum();
    let sum: DVec2 = force.iter().sum();
    // sums of 24 forces of up to 100 with arms of up to 6
    assert!(
        torque.abs() < 1e-10 && sum.length() < 1e-11,
        "{torque} {sum}"
    );
    for (i, direction) in [(0, DVec2::X), (5, DVec2::Y), (17, DVec2::new(0.6, 0.8))] {
        let step = 1e-4;
        let mut energy = |by: f64| {
            let place = state.x[i];
            state.x[i] += by * direction;
            let energy = snake.energies(&state).elastic();
            state.x[i] = place;
            energy
        };
        let slope = (energy(step) - energy(-step)) / (2.0 * step);
        let found = force[i].dot(direction);
        // the third derivative times step², and rounding over step: 1e-7 of forces of order ten
        assert!(
            (found + slope / h).abs() < 1e-6 * (1.0 + found.abs()),
            "{found} {slope}"
        );
    }
}

#[test]
fn a_turning_body_resists_no_more_than_one_that_does_not() {
    // its energy is K's less something convex: the step limit of K is enough
    let body = body(Frame::turning());
    let mut state = spinning(&body, 2.0, 0.3);
    let mut snake = Snake::new(body, World::default()).unwrap();
    let dt = 0.98 * Scheme::Leapfrog.step_limit(&snake).unwrap();
    let start = snake.energies(&state).total();
    go(&mut snake, &mut state, Scheme::Leapfrog, dt, 4000);
    let end = snake.energies(&state).total();
    assert!(end < 3.0 * start, "{start} {end}");
}

/// Drift of energy and angular momentum over one free turn, each relative.
fn drift(scheme: Scheme, steps: u64) -> (f64, f64) {
    let body = body(Frame::turning());
    let omega = 0.7;
    let mut state = spinning(&body, omega, 0.1);
    let mut snake = Snake::new(body.clone(), World::default()).unwrap();
    let mut ledger = Ledger::begin(&mut snake, &state).unwrap();
    let spin =
        |state: &State| Motion::of(&state.x, &state.v, &body.mass, body.spacing).angular_momentum;
    let (energy, momentum) = (snake.energies(&state).total(), spin(&state));
    let dt = TAU / omega / steps as f64;
    let mut stepper = scheme
        .start(&mut snake, &state, dt, Start::SecondOrder)
        .unwrap();
    let (mut gap, mut slip) = (0.0_f64, 0.0_f64);
    for _ in 0..steps {
        stepper.step(&mut snake, &mut state).unwrap();
        ledger.book(&mut snake, &state).unwrap();
        let total = ledger.energies(&mut snake, &state).total();
        gap = gap.max((total - energy).abs() / energy);
        slip = slip.max((spin(&state) - momentum).abs() / momentum);
    }
    (gap, slip)
}

#[test]
fn a_free_spinning_snake_keeps_energy_and_angular_momentum_to_the_order_of_its_scheme() {
    for (scheme, order, most) in [
        (Scheme::Leapfrog, 2.0, 1e-3),
        (Scheme::Rk4, 4.0, 1e-6),
        (Scheme::Newmark, 2.0, 1e-2),
        (Scheme::Sbdf2, 2.0, 3e-2),
        // most of the wave is gone after a turn, so it is not yet in proportion to the step
        (Scheme::Imex, 0.9, 0.5),
        (Scheme::Gauss4, 4.0, 1e-6),
        (Scheme::Exact, 2.0, 1e-2),
    ] {
        let (coarse, fine) = (drift(scheme, 800), drift(scheme, 1600));
        let name = scheme.name();
        assert!(fine.0 < most && fine.1 < most, "{name}: {fine:?}");
        let found = (coarse.0 / fine.0).log2();
        // the largest gap need not fall at the same time in both runs
        assert!(
            found > order - 0.35 || fine.0 < 1e-11,
            "{name}: energy of order {found}"
        );
        let found = (coarse.1 / fine.1).log2();
        // where the scheme keeps it exactly what is left is rounding
        assert!(
            found > order - 0.35 || fine.1 < 1e-11,
            "{name}: momentum of order {found}"
        );
    }
}

#[test]
fn a_turned_start_gives_the_turned_run() {
    let body = body(Frame::turning());
    let by = DVec2::from_angle(1.9);
    for scheme in [Scheme::Leapfrog, Scheme::Newmark, Scheme::Rk4] {
        let mut snake = Snake::new(body.clone(), World::default()).unwrap();
        let mut state = spinning(&body, 0.7, 0.1);
        let mut other = turned(&state, by);
        let limit = Scheme::Leapfrog.step_limit(&snake).unwrap();
        go(&mut snake, &mut state, scheme, 0.5 * limit, 500);
        go(&mut snake, &mut other, scheme, 0.5 * limit, 500);
        let apart = farthest(&turned(&state, by).x, &other.x);
        // rounding of places of 50 over 500 steps
        assert!(apart < 1e-9, "{}: {apart}", scheme.name());
        assert!(farthest(&state.x, &other.x) > 1.0);
    }
}

/// The force of a soft-edged ellipse of semi-axes 30 and 18, turned by that much, in a picture of 100 × 100.
fn oval(angle: f64) -> Arc<ForceField> {
    let back = DVec2::from_angle(-angle);
    let image = Grid::from_shape_fn((100, 100), |(y, x)| {
        let p = back.rotate(DVec2::new(x as f64, y as f64) - 49.5);
        let out = ((p / DVec2::new(30.0, 18.0)).length() - 1.0) * 22.0;
        140.0 / (1.0 + out.exp())
    });
    let rule = EdgeForce {
        smoothing: Smoothing::Gaussian(3.0),
        gain: 2.0,
    };
    Arc::new(edge_force(&image, &rule).unwrap())
}

#[test]
fn on_an_image_that_turns_the_turning_frame_stays_undeformed_and_the_other_does_not() {
    let follow = |frame: Frame, turn: f64| {
        let nodes = elastic::ellipse(DVec2::splat(49.5), DVec2::new(30.0, 18.0), 0.0, 60);
        let body = Body::of(&nodes, Topology::Closed, 1.0)
            .unwrap()
            .with_material(Material::uniform(0.05, 20.0, 60.0))
            .with_damping(0.5)
            .with_frame(frame);
        let world = World::default().with_image(oval(0.0), Sampling::Bilinear);
        let mut snake = Snake::new(body, world).unwrap();
        let mut state = State::at_rest(nodes);
        let dt = 0.1;
        let mut stepper = Scheme::Leapfrog
            .start(&mut snake, &state, dt, Start::SecondOrder)
            .unwrap();
        // a quarter of a turn in 90 pictures, twenty steps each
        let _ = common::run(
            &mut snake,
            &mut *stepper,
            &mut state,
            6000,
            &mut |snake, state| {
                if state.step % 20 == 0 && state.step <= 1800 {
                    let angle = turn * state.step as f64 / 1800.0;
                    let world = World::default().with_image(oval(angle), Sampling::Bilinear);
                    return match snake.set_world(world) {
                        Ok(()) => ControlFlow::Continue(()),
                        Err(_) => ControlFlow::Break(()),
                    };
                }
                ControlFlow::Continue(())
            },
        );
        assert_eq!(state.step, 6000);
        let mut e = vec![DVec2::ZERO; 60];
        snake.deformation_into(&state.x, &mut e);
        (elastic::rms(&e), snake.angle(&state.x), state)
    };
    let (small, angle, state) = follow(Frame::turning(), 0.25 * TAU);
    let (still, _, _) = follow(Frame::turning(), 0.0);
    let (large, ..) = follow(Frame::corrected(), 0.25 * TAU);
    // a blurred edge lies a little inside its ellipse, and that much it is deformed on a still image too;
    // pixels are not the same in all directions
    assert!((small - still).abs() < 0.05 * still, "{small} {still}");
    assert!(large > 10.0 * still, "{large}");
    assert!((angle - 0.25 * TAU).abs() < 0.01, "{angle}");
    // the turning one is on the outline: its nodes at the long end are where the ellipse is now
    let ellipse = |state: &State| {
        let level = |x: &DVec2| ((*x - 49.5) / DVec2::new(18.0, 30.0)).length() - 1.0;
        state.x.iter().map(|x| level(x).abs()).fold(0.0, f64::max)
    };
    assert!(ellipse(&state) < 0.05);
}

#[test]
fn names_are_read_as_they_are_written_and_others_refused() {
    for turn in Turn::ALL {
        assert_eq!(turn.to_string().parse::<Turn>().unwrap(), *turn);
    }
    for term in Term::ALL {
        assert_eq!(term.to_string().parse::<Term>().unwrap(), *term);
    }
    let error = "euler".parse::<Term>().unwrap_err();
    assert!(error.to_string().contains("transverse"), "{error}");
    assert!("fits".parse::<Turn>().is_err());
}
