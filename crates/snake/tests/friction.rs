//! Friction that sticks: on a slope, in exact numbers.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a snake that cannot be built should stop it"
)]

use crate::common;

use elastic::{Material, Topology};
use glam::DVec2;
use integrator::{Scheme, Start, State, System};
use proptest as _;
use snake::{
    Body, Contact, Frame, Rest, Simulation, Snake, Stepping, Upkeep, Wall, WallLaw, World,
};
use {banded as _, field as _, outline as _, thiserror as _};

const G: f64 = 4.0;
const ETA: f64 = 0.5;

const ROUGH: Contact = Contact {
    stiffness: 400.0,
    // a ball stands on one node or two: a third of what is critical for all of it
    damping: 60.0,
    friction: ETA,
    wall_friction: ETA,
    stick: 1.0,
    adhesion: 0.0,
    range: 0.0,
    gap: 0.15,
    stop: 0.2,
    own: false,
};

const TIMING: Stepping = Stepping {
    scheme: Scheme::Leapfrog,
    dt: 2e-3,
    tolerance: None,
    relax: None,
    each: false,
    start: Start::SecondOrder,
    force: false,
};

/// Balls in a row, each standing on a wall; gravity is turned by `slope` instead of the wall.
fn balls(count: u32, slope: f64, frame: Frame) -> Vec<(Snake, State)> {
    let law = WallLaw::Penalty {
        stiffness: 400.0,
        damping: 60.0,
    };
    on(law, count, slope, frame)
}

fn on(law: WallLaw, count: u32, slope: f64, frame: Frame) -> Vec<(Snake, State)> {
    let gravity = G * DVec2::new(slope.sin(), -slope.cos());
    let each = |k: u32| {
        let nodes = elastic::circle(DVec2::new(3.0 * f64::from(k), 1.0), 1.0, 24);
        let mut body = Body::of(&nodes, Topology::Closed, 1.0)
            .unwrap()
            .with_material(Material::uniform(200.0, 100.0, 20.0))
            .with_frame(frame);
        // takes the ringing out and leaves the motion of the whole alone
        body.internal = 0.001;
        let world = World::default()
            .with_gravity(gravity)
            .with_wall(Wall::new(DVec2::ZERO, DVec2::Y, law).unwrap());
        (Snake::new(body, world).unwrap(), State::at_rest(nodes))
    };
    (0..count).map(each).collect()
}

fn crowd(snakes: Vec<(Snake, State)>, contact: Contact) -> Simulation {
    common::simulation(snakes, TIMING, (Some(contact), Upkeep::default()), true).unwrap()
}

fn centers(crowd: &Simulation) -> Vec<DVec2> {
    let each = crowd.members().iter();
    each.map(|m| elastic::center(&m.state().x, None)).collect()
}

fn go(crowd: &mut Simulation, time: f64) {
    while crowd.t() < time {
        assert!(crowd.step().unwrap().is_continue());
    }
}

/// Mean acceleration of all balls down the slope between two times, from their speeds.
fn acceleration(crowd: &mut Simulation, from: f64, to: f64) -> f64 {
    let mass: f64 = crowd
        .members()
        .iter()
        .map(|m| m.snake().mass().iter().sum::<f64>() * m.snake().body().spacing)
        .sum();
    go(crowd, from);
    let (t, p) = (crowd.t(), crowd.momentum().x);
    go(crowd, to);
    (crowd.momentum().x - p) / (crowd.t() - t) / mass
}

#[test]
fn below_the_angle_of_friction_twenty_balls_stay_and_without_stick_they_creep() {
    // tan 20° = 0.364 < 0.5
    let slope = 20_f64.to_radians();
    let way = |stick: f64| {
        let mut crowd = crowd(
            balls(20, slope, Frame::corrected()),
            Contact { stick, ..ROUGH },
        );
        go(&mut crowd, 8.0);
        let settled = centers(&crowd);
        go(&mut crowd, 20.0);
        let after = centers(&crowd);
        let each = settled.iter().zip(&after).map(|(a, b)| a.distance(*b));
        each.fold(0.0, f64::max)
    };
    // what is left of their swinging after 8 s
    let (held, crept) = (way(1.0), way(0.0));
    assert!(held < 1e-6, "moved by {held} in 12 s");
    assert!(crept > 100.0 * held.max(1e-9), "{crept} {held}");
}

#[test]
fn above_it_they_slide_at_g_times_sine_less_friction_times_cosine() {
    for degrees in [30.0_f64, 40.0, 60.0] {
        let slope = degrees.to_radians();
        let mut crowd = crowd(balls(20, slope, Frame::corrected()), ROUGH);
        let found = acceleration(&mut crowd, 3.0, 6.0);
        let exact = G * (slope.sin() - ETA * slope.cos());
        // they bounce a little as they go, and the push on them with it
        assert!(
            (found / exact - 1.0).abs() < 0.01,
            "{degrees}°: {found}, exactly {exact}"
        );
    }
}

#[test]
fn a_hoop_that_may_turn_rolls_at_half_of_g_sine() {
    // it rolls without slipping while tan of the slope is below twice the coefficient
    let slope = 20_f64.to_radians();
    let exact = 0.5 * G * slope.sin();
    // hard, so that its center is a radius above the wall; without damping, since a node that lands on a damper
    // costs what rolls over it
    let hard = WallLaw::Penalty {
        stiffness: 20_000.0,
        damping: 0.0,
    };
    let law = Contact {
        damping: 0.0,
        ..ROUGH
    };
    let timing = Stepping { dt: 2e-4, ..TIMING };
    let snakes = on(hard, 1, slope, Frame::turning());
    let mut crowd =
        common::simulation(snakes, timing, (Some(law), Upkeep::default()), true).unwrap();
    let found = acceleration(&mut crowd, 1.0, 4.0);
    // it rolls over the 24 corners of a polygon
    assert!((found / exact - 1.0).abs() < 0.02, "{found} {exact}");
}

#[test]
fn a_ball_held_on_a_rough_curve_is_at_rest_and_its_account_closes() {
    // the slope is a snake itself, all of its nodes held
    let slope = 15_f64.to_radians();
    let mut snakes = balls(2, slope, Frame::corrected());
    for (snake, _) in &mut snakes {
        let mut world = snake.world().clone();
        world.walls.clear();
        snake.set_world(world).unwrap();
        let mut damped = snake.body().clone().with_damping(0.5);
        damped.internal = 0.0;
        snake.set_body(damped).unwrap();
    }
    let nodes: Vec<DVec2> = (0..60)
        .map(|i| DVec2::new(-3.0 + 0.2 * f64::from(i), -0.15))
        .collect();
    let body = Body::of(&nodes, Topology::open(elastic::End::Free), 1.0).unwrap();
    let mut floor = Snake::new(body, World::default()).unwrap();
    floor.hold(0..60).unwrap();
    snakes.push((floor, State::at_rest(nodes)));
    let mut crowd = crowd(snakes, ROUGH);
    crowd.watch(Rest::default());
    let first = crowd.energies().total();
    let (mut off, mut most) = (0.0_f64, 0.0_f64);
    while crowd.steps() < 20_000 && !crowd.is_at_rest() {
        assert!(crowd.step().unwrap().is_continue());
        let energies = crowd.energies();
        off = off.max((energies.total() - first).abs());
        most = most.max(energies.forces[0].abs().max(energies.damping));
    }
    assert!(crowd.is_at_rest());
    // rounding, over some thousand steps
    assert!(off < 1e-11 * most, "{off} of {most}");
}

#[test]
fn friction_that_will_not_do_is_refused_by_name() {
    for (contact, name) in [
        (
            Contact {
                stick: 1.5,
                ..ROUGH
            },
            "the stick of contacts",
        ),
        (
            Contact {
                stick: f64::NAN,
                ..ROUGH
            },
            "the stick of contacts",
        ),
        (
            Contact {
                wall_friction: -1.0,
                ..ROUGH
            },
            "the friction at walls",
        ),
    ] {
        let refused = common::simulation(
            balls(1, 0.0, Frame::corrected()),
            TIMING,
            (Some(contact), Upkeep::default()),
            true,
        );
        let message = refused.unwrap_err().to_string();
        assert!(message.contains(name), "{message}");
    }
}
