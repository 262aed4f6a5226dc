//! Every scheme at every kind of wall against the mechanics of a mass on a plane: what slides along a
//! wall feels the whole of every force along it, and Coulomb's law holds for what was exchanged.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a snake that cannot be built should stop it"
)]

use crate::common;

use std::ops::ControlFlow;

use elastic::{Material, Topology};
use glam::DVec2;
use integrator::{Scheme, Start, State};
use proptest as _;
use snake::{Body, Energies, Ledger, Snake, Wall, WallLaw, World};
use {banded as _, field as _, outline as _, thiserror as _};

/// Angles of a slope against the horizontal, in degrees: axes, the usual, and any.
const ANGLES: [f64; 6] = [0.0, 30.0, 90.0, 137.3, -41.0, -90.0];

fn inert() -> impl Iterator<Item = Scheme> {
    let other = |scheme: &Scheme| *scheme != Scheme::GradientFlow;
    Scheme::ALL.iter().copied().filter(other)
}

const fn impact(restitution: f64, friction: f64) -> WallLaw {
    WallLaw::Impact {
        restitution,
        friction,
    }
}

fn laws() -> [(&'static str, WallLaw); 4] {
    let penalty = WallLaw::Penalty {
        stiffness: 400.0,
        damping: 8.0,
    };
    [
        ("impact", impact(0.0, 0.0)),
        ("impact 0.4", impact(0.4, 0.0)),
        ("clamp", WallLaw::Clamp),
        ("penalty", penalty),
    ]
}

/// A unit vector along a slope of that many degrees, and the normal to the side of the body.
fn slope(degrees: f64) -> (DVec2, DVec2) {
    let along = DVec2::from_angle(degrees.to_radians());
    (along, along.perp())
}

/// A free rod of five nodes that lies on a wall through (1, 2), and gravity with these parts along and into it.
fn lying(degrees: f64, law: WallLaw, gravity: [f64; 2]) -> (Snake, State) {
    let (along, normal) = slope(degrees);
    let foot = DVec2::new(1.0, 2.0);
    let nodes = elastic::segment(foot, foot + 4.0 * along, 5);
    let body = Body::of(&nodes, Topology::open(elastic::End::Free), 1.0)
        .unwrap()
        .with_material(Material::uniform(0.0, 10.0, 2.0));
    let world = World::default()
        .with_wall(Wall::new(foot, normal, law).unwrap())
        .with_gravity(gravity[0] * along - gravity[1] * normal);
    (Snake::new(body, world).unwrap(), State::at_rest(nodes))
}

/// A run with its account: the state at the end, and the energies at start and end.
fn after(
    scheme: Scheme,
    snake: &mut Snake,
    mut state: State,
    dt: f64,
    steps: u64,
) -> (State, Energies, Energies) {
    let mut ledger = Ledger::begin(snake, &state)
        .and_then(|ledger| ledger.under(scheme, Start::SecondOrder, snake))
        .unwrap();
    let first = ledger.energies(snake, &state);
    let mut stepper = scheme.start(snake, &state, dt, Start::SecondOrder).unwrap();
    common::run(
        snake,
        &mut *stepper,
        &mut state,
        steps,
        &mut |snake, state| {
            ledger.book(snake, state).unwrap();
            ControlFlow::Continue(())
        },
    )
    .unwrap();
    assert_eq!(state.step, steps, "{scheme} arrives");
    let last = ledger.energies(snake, &state);
    (state, first, last)
}

#[test]
fn what_lies_on_a_smooth_slope_slides_down_with_the_whole_of_gravity_along_it() {
    // v = g t = 4, s = ½ g t² = 8 under every scheme, law and angle
    let (dt, steps) = (0.01, 400);
    for scheme in inert() {
        for (name, law) in laws() {
            for degrees in ANGLES {
                let (along, _) = slope(degrees);
                let (mut snake, start) = lying(degrees, law, [1.0, 1.7]);
                let from = start.x.clone();
                let (state, first, last) = after(scheme, &mut snake, start, dt, steps);
                for (i, (x, v)) in state.x.iter().zip(&state.v).enumerate() {
                    let (speed, way) = (v.dot(along), (x - from[i]).dot(along));
                    assert!(
                        (speed - 4.0).abs() < 0.04,
                        "{scheme}, {name}, {degrees}: node {i} has speed {speed} for 4"
                    );
                    assert!(
                        (way - 8.0).abs() < 0.08,
                        "{scheme}, {name}, {degrees}: node {i} went {way} for 8"
                    );
                }
                // a smooth wall takes nothing of what slides: it would, were a force left out
                let fallen = 4.0 * 1.0 * 8.0;
                let penalty = matches!(law, WallLaw::Penalty { .. });
                let contact = last.contact.abs();
                assert!(
                    contact < 0.02 * fallen,
                    "{scheme}, {name}, {degrees}: contact took {contact} of {fallen}"
                );
                let drift = (last.total() - first.total()).abs();
                assert!(
                    drift < 0.02 * fallen || penalty && drift < 0.05 * fallen,
                    "{scheme}, {name}, {degrees}: the account is off by {drift} of {fallen}"
                );
            }
        }
    }
}

#[test]
fn what_lies_on_a_rough_slope_slides_by_coulombs_law_or_not_at_all() {
    let (dt, steps) = (0.01, 400);
    for scheme in inert() {
        for restitution in [0.0, 0.3, 0.9] {
            for degrees in ANGLES {
                let (along, _) = slope(degrees);
                // slides: 1 − 0.2 · 1.7; holds: 1 < 0.8 · 1.7
                for (friction, acceleration) in [(0.2, 0.66), (0.8, 0.0)] {
                    let law = impact(restitution, friction);
                    let (mut snake, start) = lying(degrees, law, [1.0, 1.7]);
                    let from = start.x.clone();
                    let (state, _, last) = after(scheme, &mut snake, start, dt, steps);
                    let at = format!("{scheme}, {restitution}, {friction}, {degrees}");
                    let time = 4.0;
                    let (speed, way) = (acceleration * time, 0.5 * acceleration * time * time);
                    for (i, (x, v)) in state.x.iter().zip(&state.v).enumerate() {
                        let (got, gone) = (v.dot(along), (x - from[i]).dot(along));
                        assert!(
                            (got - speed).abs() < 0.01 * 4.0,
                            "{at}: node {i} has speed {got} for {speed}"
                        );
                        assert!(
                            (gone - way).abs() < 0.01 * 8.0,
                            "{at}: node {i} went {gone} for {way}"
                        );
                    }
                    // five nodes a unit apart
                    let taken = 5.0 * friction * 1.7 * way;
                    assert!(
                        (last.contact - taken).abs() < 0.01 * 40.0,
                        "{at}: contact took {} for {taken}",
                        last.contact
                    );
                }
            }
        }
    }
}

#[test]
fn what_has_met_a_smooth_wall_keeps_its_motion_along_it() {
    for scheme in inert() {
        for law in [impact(0.0, 0.0), impact(0.5, 0.0), WallLaw::Clamp] {
            for degrees in ANGLES {
                let (along, normal) = slope(degrees);
                let wall = Wall::new(DVec2::new(0.3, -0.2), normal, law).unwrap();
                // askew to the wall, so that one node after the other meets it
                let from = DVec2::new(0.3, -0.2) + 0.2 * normal;
                let nodes = elastic::segment(from, from + 3.0 * along + 0.4 * normal, 7);
                let body = Body::of(&nodes, Topology::open(elastic::End::Free), 1.0)
                    .unwrap()
                    .with_material(Material::uniform(0.0, 0.0, 0.0));
                let world = World::default().with_wall(wall);
                let mut snake = Snake::new(body, world).unwrap();
                let mut start = State::at_rest(nodes);
                start.v.fill(1.52 * along - 1.64 * normal);
                let (state, ..) = after(scheme, &mut snake, start, 1e-3, 1000);
                for (i, v) in state.v.iter().enumerate() {
                    let speed = v.dot(along);
                    assert!(
                        (speed - 1.52).abs() < 1e-9,
                        "{scheme}, {law:?}, {degrees}: node {i} has {speed} for 1.52"
                    );
                }
            }
        }
    }
}

#[test]
fn a_ball_that_bounces_loses_as_much_along_a_rough_wall_as_coulomb_says() {
    let friction = 0.15;
    for scheme in inert() {
        for restitution in [0.0, 0.3, 1.0] {
            for degrees in [0.0, -90.0, 137.3] {
                let (along, normal) = slope(degrees);
                let law = impact(restitution, friction);
                let wall = Wall::new(DVec2::ZERO, normal, law).unwrap();
                let nodes = elastic::circle(4.0 * normal, 1.5, 30);
                let body = Body::of(&nodes, Topology::Closed, 1.0)
                    .unwrap()
                    .with_material(Material::uniform(2.0, 60.0, 5.0));
                let mut snake = Snake::new(body, World::default().with_wall(wall)).unwrap();
                let mut start = State::at_rest(nodes);
                start.v.fill(-2.0 * normal + 3.0 * along);
                let (state, ..) = after(scheme, &mut snake, start, 1e-3, 4000);
                let mean = state.v.iter().copied().sum::<DVec2>() / 30.0;
                let (lost, given) = (3.0 - mean.dot(along), mean.dot(normal) + 2.0);
                assert!(given > 1.0, "{scheme} comes back: {mean}");
                assert!(
                    (lost / given - friction).abs() < 0.01 * friction,
                    "{scheme}, {restitution}, {degrees}: {lost} along for {given} across"
                );
            }
        }
    }
}

#[test]
fn friction_takes_energy_from_a_stiff_ball_at_any_step() {
    // the fastest wave turns by 12 in a step: a node that friction alone moved would tear the ball
    let implicit = |scheme: &Scheme| {
        !matches!(
            scheme,
            Scheme::Report | Scheme::Leapfrog | Scheme::Rk4 | Scheme::DormandPrince { .. }
        )
    };
    for scheme in inert().filter(implicit) {
        let wall = Wall::new(DVec2::ZERO, DVec2::Y, impact(0.5, 0.3)).unwrap();
        let nodes = elastic::circle(DVec2::new(0.0, 3.0), 2.0, 20);
        let body = Body::of(&nodes, Topology::Closed, 1.0)
            .unwrap()
            .with_material(Material::uniform(1.0, 1e5, 1e4));
        let world = World::default()
            .with_wall(wall)
            .with_gravity(DVec2::new(0.0, -1.0));
        let mut snake = Snake::new(body, world).unwrap();
        let mut state = State::at_rest(nodes);
        state.v.fill(DVec2::new(3.0, 0.0));
        let first = snake.energies(&state).mechanical();
        let mut stepper = scheme
            .start(&mut snake, &state, 0.02, Start::SecondOrder)
            .unwrap();
        for _ in 0..1000 {
            stepper.step(&mut snake, &mut state).unwrap();
            let rise = snake.energies(&state).mechanical() - first;
            assert!(rise < 0.01 * first, "{scheme}: {rise} of {first}");
        }
    }
}
