//! Laws that hold for every snake, whatever it is made of.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a snake that cannot be built should stop it"
)]

use crate::common;

use std::ops::ControlFlow;

use elastic::{End, Material, Profile, Topology};
use glam::DVec2;
use integrator::{Scheme, Start, State, System};
use proptest::prelude::*;
use snake::{Body, Center, Frame, Outcome, Schedule, Snake, Stepping, Until, Wall, WallLaw, World};

const N: usize = 9;

/// A wavy open or closed curve; no two nodes in one place.
fn curve(topology: Topology, wave: f64) -> Vec<DVec2> {
    let n = N as f64;
    (0..N)
        .map(|i| {
            let s = i as f64 / n;
            match topology {
                Topology::Closed => {
                    DVec2::from_angle(std::f64::consts::TAU * s) * (5.0 + wave * (7.0 * s).sin())
                }
                Topology::Open { .. } => DVec2::new(12.0 * s, wave * (5.0 * s).cos()),
            }
        })
        .collect()
}

fn any_topology() -> impl Strategy<Value = Topology> {
    let end = prop_oneof![
        Just(End::Free),
        Just(End::Anchored),
        Just(End::Pinned),
        Just(End::Clamped)
    ];
    prop_oneof![
        Just(Topology::Closed),
        (end.clone(), end).prop_map(|(head, tail)| Topology::Open { head, tail }),
    ]
}

fn any_profile(most: f64) -> impl Strategy<Value = Profile> {
    prop_oneof![
        (0.0..most).prop_map(Profile::Uniform),
        prop::collection::vec(0.0..most, N).prop_map(Profile::PerNode),
    ]
}

prop_compose! {
    fn any_body()(
        topology in any_topology(),
        wave in 0.1..2.0,
        tether in any_profile(2.0),
        tension in any_profile(20.0),
        rigidity in any_profile(20.0),
        higher in prop_oneof![Just(Vec::new()), prop::collection::vec(any_profile(20.0), 1..=2)],
        mass in prop::collection::vec(0.2..3.0, N),
        even in any::<bool>(),
    ) -> Body {
        let mut body = Body::of(&curve(topology, wave), topology, 1.0).unwrap();
        body.material = Material { tether, tension, rigidity, higher };
        if !even {
            body.mass = Profile::PerNode(mass);
        }
        body.recenter().unwrap();
        body
    }
}

fn any_places() -> impl Strategy<Value = Vec<DVec2>> {
    prop::collection::vec(
        (-9.0..9.0, -9.0..9.0).prop_map(|(x, y)| DVec2::new(x, y)),
        N,
    )
}

/// Forces are a few hundred here, and sums of some tens of products of them are compared.
const ROUNDING: f64 = 1e-10;

proptest! {
    #[test]
    fn force_is_minus_the_gradient_of_energy(body in any_body(), x in any_places(), k in 0..2 * N) {
        let (h, held) = (body.spacing, body.topology.held(N));
        let mut snake = Snake::new(body, World::default()).unwrap();
        let mut force = vec![DVec2::ZERO; N];
        snake.elastic(&x, &mut force);
        let step = 1e-3;
        let mut energy = |by: f64| {
            let mut state = State::at_rest(x.clone());
            if k % 2 == 0 { state.x[k / 2].x += by } else { state.x[k / 2].y += by }
            snake.energies(&state).elastic()
        };
        // the energy is quadratic, so the central difference is exact up to rounding / step
        let slope = (energy(step) - energy(-step)) / (2.0 * step);
        let found = if k % 2 == 0 { force[k / 2].x } else { force[k / 2].y };
        let expected = if held[k / 2] { 0.0 } else { -slope / h };
        prop_assert!((found - expected).abs() < 1e-6 * (1.0 + expected.abs()), "{found} {expected}");
    }

    #[test]
    fn the_operator_is_the_slope_of_the_force(body in any_body(), x in any_places(), y in any_places()) {
        let held = body.topology.held(N);
        let mut snake = Snake::new(body, World::default()).unwrap();
        let (mut fx, mut fy, mut a) = (vec![DVec2::ZERO; N], vec![DVec2::ZERO; N], vec![DVec2::ZERO; N]);
        snake.elastic(&x, &mut fx);
        // held nodes do not move, so only the others may differ
        let y: Vec<DVec2> = (0..N).map(|i| if held[i] { x[i] } else { y[i] }).collect();
        snake.elastic(&y, &mut fy);
        let difference: Vec<DVec2> = x.iter().zip(&y).map(|(x, y)| *x - *y).collect();
        snake.stiffness().multiply_into(&difference, &mut a);
        for i in 0..N {
            prop_assert!((fx[i] - fy[i] + a[i]).length() < ROUNDING * (1.0 + a[i].length()));
        }
    }

    #[test]
    fn no_snake_pushes_itself_along(body in any_body(), x in any_places()) {
        // pinned ends push: what holds them is outside (D4, D5)
        prop_assume!(!body.topology.held(N).contains(&true));
        let mut snake = Snake::new(body, World::default()).unwrap();
        let mut force = vec![DVec2::ZERO; N];
        snake.elastic(&x, &mut force);
        let sum: DVec2 = force.iter().sum();
        let size: f64 = force.iter().map(|f| f.length()).sum();
        prop_assert!(sum.length() < 1e-12 * (1.0 + size), "{sum}");
    }

    #[test]
    fn a_moved_and_turned_snake_feels_the_moved_and_turned_force(
        body in any_body(), x in any_places(), by in (-9.0..9.0, -9.0..9.0), angle in 0.0..6.0,
    ) {
        let turn = DVec2::from_angle(angle);
        let mut turned = body.clone();
        for r in &mut turned.rest {
            *r = turn.rotate(*r);
        }
        let mut snake = Snake::new(body, World::default()).unwrap();
        let mut other = Snake::new(turned, World::default()).unwrap();
        let moved: Vec<DVec2> = x.iter().map(|&p| turn.rotate(p) + DVec2::from(by)).collect();
        let (mut force, mut moved_force) = (vec![DVec2::ZERO; N], vec![DVec2::ZERO; N]);
        snake.elastic(&x, &mut force);
        other.elastic(&moved, &mut moved_force);
        for (f, g) in force.iter().zip(&moved_force) {
            prop_assert!((turn.rotate(*f) - *g).length() < ROUNDING * (1.0 + f.length()));
        }
    }

    #[test]
    fn a_snake_falls_as_one_stone(body in any_body(), scheme in prop_oneof![
        Just(Scheme::Report), Just(Scheme::Leapfrog),
    ]) {
        prop_assume!(!body.topology.held(N).contains(&true));
        let g = DVec2::new(0.3, -0.8);
        let mut start: Vec<DVec2> = body.rest.clone();
        start[2] += DVec2::new(0.2, 0.4); // not at rest, so that it rings while it falls
        let mut snake = Snake::new(body, World::default().with_gravity(g)).unwrap();
        let mut state = State::at_rest(start);
        let begin = snake.center(&state.x);
        let dt = 0.2 * scheme.step_limit(&snake).unwrap_or(0.5).min(0.5);
        let mut stepper = scheme.start(&mut snake, &state, dt, Start::SecondOrder).unwrap();
        common::run(&mut snake, &mut *stepper, &mut state, 50, &mut |_, _| {
            ControlFlow::Continue(())
        }).unwrap();
        let t = 50.0 * dt;
        let fallen = snake.center(&state.x) - begin;
        // both schemes are exact for a uniform acceleration without damping
        prop_assert!((fallen - 0.5 * t * t * g).length() < 1e-9 * (1.0 + t * t), "{fallen}");
    }
}

#[test]
fn the_report_frame_pushes_an_anchored_snake_along() {
    let topology = Topology::open(End::Anchored);
    let mut body = Body::of(&curve(topology, 0.1), topology, 1.0).unwrap();
    body.material = Material::uniform(0.0, 3.0, 5.0);
    body.frame = Frame::report();
    let mut snake = Snake::new(body, World::default()).unwrap();
    let bent: Vec<DVec2> = curve(topology, 2.0);
    let mut force = vec![DVec2::ZERO; N];
    snake.elastic(&bent, &mut force);
    let sum: DVec2 = force.iter().sum();
    assert!(sum.length() > 0.1, "{sum}");
}

#[test]
fn the_center_of_mass_is_weighted_and_divided_by_the_total() {
    let topology = Topology::open(End::Free);
    let nodes = [DVec2::ZERO, DVec2::X, 2.0 * DVec2::X];
    let mut body = Body::of(&nodes, topology, 1.0).unwrap();
    body.mass = Profile::PerNode(vec![1.0, 1.0, 6.0]);
    body.recenter().unwrap();
    let snake = Snake::new(body.clone(), World::default()).unwrap();
    assert!((snake.center(&nodes) - DVec2::new(13.0 / 8.0, 0.0)).length() < 1e-15);
    body.frame.center = Center::Mean;
    let snake = Snake::new(body, World::default()).unwrap();
    assert!((snake.center(&nodes) - DVec2::X).length() < 1e-15);
}

#[test]
fn pinned_ends_stay_where_they_are_to_the_bit() {
    let topology = Topology::open(End::Pinned);
    let nodes = curve(topology, 0.5);
    let mut body = Body::of(&nodes, topology, 1.0).unwrap().with_damping(0.1);
    body.material = Material::uniform(0.1, 3.0, 5.0);
    let world = World::default().with_gravity(DVec2::new(0.0, 3.0));
    for scheme in Scheme::ALL {
        let mut snake = Snake::new(body.clone(), world.clone()).unwrap();
        let mut state = State::at_rest(nodes.clone());
        let dt = 0.5 * scheme.step_limit(&snake).unwrap_or(0.1).min(0.1);
        // a scheme may refuse a situation it is not made for; it may not move the ends
        let Ok(mut stepper) = scheme.start(&mut snake, &state, dt, Start::SecondOrder) else {
            continue;
        };
        common::run(&mut snake, &mut *stepper, &mut state, 40, &mut |_, _| {
            ControlFlow::Continue(())
        })
        .unwrap();
        assert_eq!(state.x[0], nodes[0], "{}", scheme.name());
        assert_eq!(state.x[N - 1], nodes[N - 1], "{}", scheme.name());
        assert!(state.x[N / 2].y > nodes[N / 2].y, "{}", scheme.name());
    }
}

/// A ring dropped on a floor; returns the largest speed up after the hit over the speed before it.
fn bounce(law: WallLaw, tether: f64) -> (f64, f64) {
    let nodes = elastic::circle(DVec2::new(0.0, 3.0), 1.0, 24);
    let mut body = Body::of(&nodes, Topology::Closed, 1.0).unwrap();
    body.material = Material::uniform(tether, 200.0, 20.0);
    let floor = Wall::new(DVec2::ZERO, DVec2::Y, law).unwrap();
    let world = World::default().with_wall(floor);
    let mut snake = Snake::new(body, world).unwrap();
    let mut state = State::at_rest(nodes);
    state.v.fill(DVec2::new(0.7, -2.0));
    let before = snake.energies(&state).total();
    let dt = 0.2 * Scheme::Leapfrog.step_limit(&snake).unwrap();
    let mut stepper = Scheme::Leapfrog
        .start(&mut snake, &state, dt, Start::SecondOrder)
        .unwrap();
    let mut highest = f64::NEG_INFINITY;
    let mut most = 0.0_f64;
    common::run(
        &mut snake,
        &mut *stepper,
        &mut state,
        40_000,
        &mut |snake, state| {
            let speed = state.v.iter().map(|v| v.y).sum::<f64>() / state.v.len() as f64;
            highest = highest.max(speed);
            most = most.max(snake.energies(state).total());
            if snake.center(&state.x).y > 3.0 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        },
    )
    .unwrap();
    (highest / 2.0, most / before)
}

#[test]
fn no_wall_law_gives_energy_to_a_bouncing_ring() {
    for law in [
        WallLaw::Clamp,
        WallLaw::Penalty {
            stiffness: 5000.0,
            damping: 5.0,
        },
        WallLaw::Impact {
            restitution: 0.0,
            friction: 0.3,
        },
        WallLaw::Impact {
            restitution: 1.0,
            friction: 0.0,
        },
    ] {
        let (back, energy) = bounce(law, 50.0);
        assert!(back > 0.1 && back < 1.02, "{law:?}: came back with {back}");
        // leapfrog's own energy error at a fifth of the limit is about a hundredth
        assert!(energy < 1.03, "{law:?}: energy rose to {energy}");
    }
}

#[test]
fn the_slope_of_the_outside_is_the_difference_of_its_force() {
    // smooth and curved, so that a slope at the wrong place would show
    let x = field::Grid::from_shape_fn((16, 16), |(y, x)| (0.3 * x as f64).sin() + 0.1 * y as f64);
    let y = field::Grid::from_shape_fn((16, 16), |(y, x)| (0.2 * y as f64).cos() - 0.2 * x as f64);
    let field = std::sync::Arc::new(field::ForceField::from_components(&x, &y).unwrap());
    let nodes = [
        DVec2::new(3.3, 4.4),
        DVec2::new(6.2, 7.7),
        DVec2::new(10.6, 9.1),
    ];
    let body = Body::of(&nodes, Topology::open(End::Free), 1.0).unwrap();
    let law = WallLaw::Penalty {
        stiffness: 7.0,
        damping: 0.0,
    };
    let wall = Wall::new(DVec2::new(5.0, 5.0), DVec2::new(1.0, 2.0), law).unwrap();
    let world = World::default()
        .with_image(field, snake::Sampling::Bilinear)
        .with_wall(wall);
    let mut snake = Snake::new(body, world).unwrap();
    let mut slope = [glam::DMat2::ZERO; 3];
    assert!(snake.external_slope(0.0, &nodes, &mut slope));
    let mut force = |by: DVec2| {
        let x: Vec<DVec2> = nodes.iter().map(|p| *p + by).collect();
        let mut force = vec![DVec2::ZERO; 3];
        snake
            .external(0.0, &x, &[DVec2::ZERO; 3], &mut force)
            .unwrap();
        force
    };
    let step = 1e-5;
    for (axis, e) in [DVec2::X, DVec2::Y].into_iter().enumerate() {
        let (after, before) = (force(e * step), force(-e * step));
        for i in 0..3 {
            let found = (after[i] - before[i]) / (2.0 * step);
            // bilinear between pixels and linear behind the wall: exact up to rounding / step
            assert!((found - slope[i].col(axis)).length() < 1e-8, "node {i}");
        }
    }
}

#[test]
fn d12_a_turned_snake_counts_as_deformed() {
    let nodes = elastic::ellipse(DVec2::ZERO, DVec2::new(4.0, 2.0), 0.0, 12);
    let mut body = Body::of(&nodes, Topology::Closed, 1.0).unwrap();
    body.material = Material::uniform(1.0, 2.0, 3.0);
    let mut snake = Snake::new(body, World::default()).unwrap();
    let turn = |angle: f64| {
        nodes
            .iter()
            .map(|&p| DVec2::from_angle(angle).rotate(p))
            .collect::<Vec<_>>()
    };
    assert!(snake.energies(&State::at_rest(turn(0.0))).elastic() < 1e-20);
    assert!(snake.energies(&State::at_rest(turn(0.5))).elastic() > 1.0);
}

#[test]
fn d67_a_smooth_wall_squeezes_and_nothing_bulges() {
    let nodes = elastic::circle(DVec2::new(1.2, 0.0), 1.0, 24);
    let mut body = Body::of(&nodes, Topology::Closed, 1.0).unwrap();
    body.material = Material::uniform(0.0, 5.0, 0.3);
    let wall = Wall::new(DVec2::ZERO, DVec2::X, WallLaw::Clamp).unwrap();
    let world = World::default()
        .with_wall(wall)
        .with_gravity(DVec2::new(0.0, -0.4));
    let mut snake = Snake::new(body, world).unwrap();
    let mut state = State::at_rest(nodes);
    state.v.fill(DVec2::new(-2.0, 0.0));
    let dt = 0.3 * Scheme::Report.step_limit(&snake).unwrap();
    let mut stepper = Scheme::Report
        .start(&mut snake, &state, dt, Start::FirstOrder)
        .unwrap();
    let (mut most, mut e) = (DVec2::ZERO, vec![DVec2::ZERO; 24]);
    common::run(
        &mut snake,
        &mut *stepper,
        &mut state,
        200,
        &mut |snake, state| {
            snake.deformation_into(&state.x, &mut e);
            most = e.iter().fold(most, |most, e| most.max(e.abs()));
            ControlFlow::Continue(())
        },
    )
    .unwrap();
    // squeezed by tens of percent along x; along y only rounding, some 1e-16 a step
    assert!(most.x > 0.1 && most.y < 1e-11, "{most}");
}

#[test]
fn the_step_limit_of_uneven_mass_and_damping_parts_rest_from_blow_up() {
    let nodes = curve(Topology::Closed, 0.5);
    let mut body = Body::of(&nodes, Topology::Closed, 1.0).unwrap();
    body.material = Material {
        tether: Profile::Uniform(0.1),
        tension: Profile::PerNode((0..N).map(|i| 1.0 + i as f64).collect()),
        rigidity: Profile::PerNode((0..N).map(|i| 2.0 + (i % 3) as f64).collect()),
        higher: vec![Profile::Uniform(0.5)],
    };
    body.mass = Profile::PerNode((0..N).map(|i| 0.5 + 0.2 * i as f64).collect());
    body.damping = Profile::PerNode((0..N).map(|i| 0.3 * (i % 4) as f64).collect());
    // the mean moves with uneven masses; measured from the plain mean the limit is K's own
    body.frame.center = Center::Mean;
    body.recenter().unwrap();
    for scheme in [Scheme::Report, Scheme::Leapfrog] {
        let size = |factor: f64| {
            let mut snake = Snake::new(body.clone(), World::default()).unwrap();
            let dt = factor * scheme.step_limit(&snake).unwrap();
            let mut state = State::at_rest(nodes.clone());
            state.x[4] += DVec2::new(1e-3, 0.0);
            let mut stepper = scheme
                .start(&mut snake, &state, dt, Start::SecondOrder)
                .unwrap();
            let _ = common::run(&mut snake, &mut *stepper, &mut state, 3000, &mut |_, _| {
                ControlFlow::Continue(())
            });
            state.v.iter().map(|v| v.length()).fold(0.0, f64::max)
        };
        assert!(size(0.999) < 1e-2, "{}: {}", scheme.name(), size(0.999));
        let above = size(1.02);
        assert!(above > 1.0 || above.is_nan(), "{}: {above}", scheme.name());
    }
}

#[test]
fn a_schedule_changes_the_body_and_its_operator() {
    let nodes = elastic::circle(DVec2::ZERO, 5.0, 12);
    let mut body = Body::of(&nodes, Topology::Closed, 1.0).unwrap();
    body.material = Material::uniform(1.0, 2.0, 3.0);
    body.schedules.tension = Some(Schedule::new(vec![(0.0, 1.0), (1.0, 3.0)]).unwrap());
    let mut snake = Snake::new(body.clone(), World::default()).unwrap();
    let before = snake.revision();
    snake.advance(0.0, &nodes);
    assert_eq!(snake.revision(), before);
    snake.advance(1.0, &nodes);
    assert_ne!(snake.revision(), before);
    body.schedules.tension = None;
    body.material = Material::uniform(1.0, 6.0, 3.0);
    let constant = Snake::new(body, World::default()).unwrap();
    assert_eq!(snake.stiffness(), constant.stiffness());
}

#[test]
fn a_run_that_blows_up_says_when_and_where() {
    let nodes = elastic::circle(DVec2::ZERO, 5.0, 12);
    let mut body = Body::of(&nodes, Topology::Closed, 1.0).unwrap();
    body.material = Material::uniform(1.0, 2.0, 3.0);
    let snake = Snake::new(body, World::default()).unwrap();
    let mut state = State::at_rest(nodes);
    state.x[3].x += 0.1;
    let dt = 1.5 * Scheme::Leapfrog.step_limit(&snake).unwrap();
    let stepping = Stepping {
        force: true,
        ..Stepping::of(Scheme::Leapfrog, dt)
    };
    let (outcome, _) = common::end(&snake, &state, stepping, &Until::steps(9999));
    assert!(
        matches!(outcome, Outcome::Diverged { step: 5..=200, .. }),
        "{outcome}"
    );
}
