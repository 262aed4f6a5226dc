//! How runs end: a crowd by the same words as a lone snake, and curves that turned over, lie flat or lie in each other.
#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::panic,
    reason = "a test: a snake that cannot be built should stop it"
)]

use crate::common;

use std::ops::ControlFlow::Continue;
use std::sync::Arc;

use elastic::{Material, Topology};
use field::{ForceField, Grid};
use glam::DVec2;
use integrator::{Scheme, Start, State};
use snake::{
    Body, Contact, Damping, Force, Outcome, Pressure, Rest, Sampling, Schedule, Snake, Stepping,
    Until, Upkeep, Wall, WallLaw, World,
};
use {banded as _, outline as _, proptest as _, thiserror as _};

const MIDDLE: DVec2 = DVec2::new(60.0, 60.0);

fn timing(scheme: Scheme, dt: f64) -> Stepping {
    Stepping {
        scheme,
        dt,
        tolerance: None,
        relax: None,
        each: false,
        start: Start::SecondOrder,
        force: false,
    }
}

/// The end of a lone snake, without an account of energies and with one: outcome and state.
fn both(snake: &Snake, start: &State, dt: f64, steps: u64) -> [(Outcome, State); 2] {
    let until = Until::at_rest(Rest::default(), steps);
    let stepping = Stepping::of(Scheme::Leapfrog, dt);
    let snakes = vec![(snake.clone(), start.clone())];
    let rules = (None, Upkeep::default());
    let mut booked = common::simulation(snakes, stepping, rules, true).unwrap();
    let outcome = booked.run(&until, &mut |_| Continue(())).unwrap();
    let member = booked.members().first().unwrap();
    let with = (outcome, member.state().clone());
    [common::end(snake, start, stepping, &until), with]
}

fn flat(push: f64) -> Arc<ForceField> {
    let along = Grid::from_elem((121, 121), push);
    Arc::new(ForceField::from_components(&along, &Grid::zeros((121, 121))).unwrap())
}

fn ring(material: Material, damping: f64) -> (Body, Vec<DVec2>) {
    let circle = elastic::circle(MIDDLE, 20.0, 30);
    let body = Body::of(&circle, Topology::Closed, 1.0).unwrap();
    (body.with_material(material).with_damping(damping), circle)
}

#[test]
fn an_account_changes_neither_the_end_nor_the_way_there() {
    let soft = Material::uniform(1.0, 5.0, 0.0);
    let mut cases = Vec::new();
    // comes to rest
    let (mut body, x) = ring(soft.clone(), 0.5);
    body.rest = elastic::ellipse(DVec2::ZERO, DVec2::new(22.0, 18.0), 0.0, 30);
    cases.push(("settled", body.clone(), World::default(), x.clone()));
    // swings for ever
    cases.push((
        "cycles",
        body.with_damping(0.0),
        World::default(),
        x.clone(),
    ));
    // pushed out of its picture
    let (body, _) = ring(soft.clone(), 0.5);
    let world = World::default().with_image(flat(3.0), Sampling::Bilinear);
    cases.push(("lost", body.clone(), world, x.clone()));
    // the same under the rule that ends at the border
    let world = World::default().with_image(flat(3.0), Sampling::OneAxis);
    cases.push(("left-field", body, world, x.clone()));
    // shrinks to nothing
    let (mut body, _) = ring(Material::uniform(0.0, 50.0, 0.0), 2.0);
    body.rest = elastic::circle(DVec2::ZERO, 1e-6, 30);
    cases.push(("collapsed", body, World::default(), x.clone()));
    // is thrown out of all numbers
    let (body, _) = ring(soft, 0.0);
    let world = World::default().with_gravity(DVec2::new(1e13, 0.0));
    cases.push(("diverged", body, world, x));
    for (name, body, world, x) in cases {
        let snake = Snake::new(body, world).unwrap();
        let start = State::at_rest(x);
        let limit = Scheme::Leapfrog.step_limit(&snake).unwrap();
        let [lone, crowd] = both(&snake, &start, 0.3 * limit.min(1.0), 100_000);
        assert_eq!(lone.0.name(), name);
        assert_eq!(lone.0, crowd.0, "{name}");
        assert_eq!(lone.0.is_good(), crowd.0.is_good(), "{name}");
        if name != "diverged" {
            assert_eq!(lone.1, crowd.1, "{name}: to the last bit");
        }
    }
}

#[test]
fn a_crowd_is_not_at_rest_while_one_of_it_is_lost_or_goes_to_and_fro() {
    let soft = Material::uniform(1.0, 5.0, 0.0);
    let (mut body, x) = ring(soft.clone(), 0.5);
    body.rest = elastic::ellipse(DVec2::ZERO, DVec2::new(22.0, 18.0), 0.0, 30);
    let calm = Snake::new(body.clone(), World::default()).unwrap();
    let swings = Snake::new(body.with_damping(0.0), World::default()).unwrap();
    let (body, _) = ring(soft, 0.5);
    let world = World::default().with_image(flat(3.0), Sampling::Bilinear);
    let lost = Snake::new(body, world).unwrap();
    let end = |others: &[&Snake]| {
        let snakes = others
            .iter()
            .map(|s| ((*s).clone(), State::at_rest(x.clone())));
        let timing = timing(Scheme::Leapfrog, 0.1);
        let crowd = common::simulation(snakes.collect(), timing, (None, Upkeep::default()), true);
        let until = Until::at_rest(Rest::default(), 200_000);
        crowd.unwrap().run(&until, &mut |_| Continue(())).unwrap()
    };
    assert_eq!(end(&[&calm, &calm]).name(), "settled");
    assert_eq!(end(&[&calm, &swings]).name(), "cycles");
    assert_eq!(end(&[&lost, &calm]).name(), "lost");
    assert_eq!(end(&[&swings, &lost, &calm]).name(), "lost");
}

#[test]
fn a_curve_that_has_passed_through_itself_or_lies_flat_is_not_at_rest() {
    // the rest shape runs the other way round, so the start is inside out against it
    let (mut body, mut x) = ring(Material::uniform(1.0, 5.0, 0.0), 0.5);
    x.iter_mut().for_each(|p| p.x = 2.0 * MIDDLE.x - p.x);
    let snake = Snake::new(body.clone(), World::default()).unwrap();
    for (outcome, state) in both(&snake, &State::at_rest(x.clone()), 0.1, 100_000) {
        assert_eq!(outcome.name(), "turned-over");
        assert!(!outcome.is_good());
        assert!(elastic::signed_area(&state.x) * elastic::signed_area(&x) < 0.0);
    }
    // a balloon of negative pressure with some rigidity: nothing is inside in the end
    body.material = Material::uniform(0.0, 1.0, 40.0);
    let world = World::default().with(Pressure::constant(-6.0));
    let snake = Snake::new(body, world).unwrap();
    let start = State::at_rest(elastic::circle(MIDDLE, 20.0, 30));
    for (outcome, _) in both(&snake, &start, 0.05, 400_000) {
        assert!(!outcome.is_good(), "{outcome}");
    }
}

#[test]
fn what_bounces_comes_to_rest_on_its_wall() {
    for restitution in [0.0, 0.3, 0.7] {
        let law = WallLaw::Impact {
            restitution,
            friction: 0.0,
        };
        let (body, x) = ring(Material::uniform(2.0, 20.0, 5.0), 0.4);
        let floor = Wall::new(DVec2::new(0.0, 39.0), DVec2::Y, law).unwrap();
        let world = World::default()
            .with_gravity(DVec2::new(0.0, -0.5))
            .with_wall(floor);
        let snake = Snake::new(body, world).unwrap();
        for (outcome, _) in both(&snake, &State::at_rest(x.clone()), 0.02, 100_000) {
            assert_eq!(outcome.name(), "settled", "{restitution}: {outcome}");
        }
    }
}

fn ball(center: DVec2, speed: f64) -> (Snake, State) {
    let nodes = elastic::circle(center, 3.0, 24);
    let body = Body::of(&nodes, Topology::Closed, 1.0)
        .unwrap()
        .with_material(Material::uniform(50.0, 400.0, 50.0));
    let mut state = State::at_rest(nodes);
    state.v.fill(DVec2::new(speed, 0.0));
    (Snake::new(body, World::default()).unwrap(), state)
}

#[test]
fn fast_balls_do_not_pass_through_each_other_without_a_word() {
    for speed in [1.0, 30.0, 100.0, 400.0, 2000.0] {
        let contact = Contact {
            stiffness: 5000.0,
            damping: 0.0,
            friction: 0.0,
            wall_friction: 0.0,
            stick: 1.0,
            adhesion: 0.0,
            range: 0.0,
            gap: 0.0,
            stop: 0.5,
            own: false,
        };
        let snakes = vec![ball(DVec2::ZERO, speed), ball(DVec2::new(30.0, 0.0), 0.0)];
        let mut crowd = common::simulation(
            snakes,
            timing(Scheme::Leapfrog, 0.004),
            (Some(contact), Upkeep::default()),
            true,
        )
        .unwrap();
        let momentum = crowd.momentum();
        let steps = (60.0 / speed / 0.004).ceil() as u64;
        let outcome = crowd
            .run(&Until::steps(steps), &mut |_| Continue(()))
            .unwrap();
        assert!(crowd.momentum().distance(momentum) < 1e-9 * momentum.length());
        let center = |k: usize| elastic::center(&crowd.members()[k].state().x, None).x;
        let passed = center(0) > center(1);
        assert!(!passed || !outcome.is_good(), "{speed}: {outcome}");
        // up to where the balls can stop each other at all they do
        if speed <= 30.0 {
            assert!(outcome.is_good() && !passed, "{speed}: {outcome}");
        }
    }
}

#[test]
fn looking_at_a_pressure_settles_nothing() {
    let x = elastic::circle(DVec2::ZERO, 5.0, 40);
    let mut back = x.clone();
    back.reverse();
    fn of(x: &[DVec2]) -> snake::Curve<'_> {
        snake::Curve {
            t: 0.0,
            x,
            v: &[],
            mass: &[],
            closed: true,
            spacing: 1.0,
        }
    }
    let mut looked = Pressure::constant(2.0);
    let mut fresh = looked.clone();
    let (_, _) = (
        looked.energy(&of(&back)),
        looked.pull(1.0, Some(&of(&back))),
    );
    let push = |pressure: &mut Pressure| {
        let mut force = vec![DVec2::ZERO; 40];
        pressure.add(&of(&x), &mut force).unwrap();
        force
    };
    assert_eq!(push(&mut looked), push(&mut fresh));
    // and what a run begins with stays, however the curve is turned over later
    looked.settle(&of(&back));
    let first = looked.energy(&of(&x)).unwrap();
    assert!((first - fresh.energy(&of(&x)).unwrap()).abs() < 1e-12);
}

#[test]
fn steps_are_checked_against_the_stiffest_moment_of_the_run() {
    // leapfrog: dt² λ < 4 with λ = (4 ω₁/h² + 16 ω₂/h⁴)/μ of a ring of an even number of nodes
    let (mut body, _) = ring(Material::uniform(0.0, 5.0, 0.0), 0.0);
    let h = body.spacing;
    let exact = |stiff: f64, mass: f64| (4.0 * mass / (20.0 * stiff / (h * h))).sqrt();
    let schedule = |points: &[(f64, f64)]| Some(Schedule::new(points.to_vec()).unwrap());
    body.schedules.tension = schedule(&[(0.0, 1.0), (10.0, 16.0), (20.0, 4.0)]);
    let ask = |body: &Body, to: f64| {
        let mut snake = Snake::new(body.clone(), World::default()).unwrap();
        snake.run_between(0.0, to);
        let limit = snake::Certificate::limit(&snake, Scheme::Leapfrog)
            .unwrap()
            .dt;
        for scheme in [Scheme::Leapfrog, Scheme::Report] {
            assert!(snake.check_step(scheme, 0.999 * limit, false).is_ok());
            assert!(snake.check_step(scheme, 1.001 * limit, false).is_err());
        }
        limit
    };
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    near(ask(&body, 0.0), exact(1.0, 1.0));
    near(ask(&body, 5.0), exact(8.5, 1.0));
    near(ask(&body, 100.0), exact(16.0, 1.0));
    // a mass that falls; and one that grows as fast as the stiffness asks for nothing
    body.schedules.mass = schedule(&[(0.0, 1.0), (10.0, 16.0), (20.0, 4.0)]);
    near(ask(&body, 100.0), exact(1.0, 1.0));
    body.schedules.tension = None;
    body.schedules.mass = schedule(&[(0.0, 1.0), (10.0, 0.25)]);
    near(ask(&body, 100.0), exact(1.0, 0.25));
}

#[test]
fn another_body_keeps_what_the_snake_was_told() {
    let (body, x) = ring(Material::uniform(1.0, 5.0, 2.0), 0.1);
    let state = State::at_rest(x);
    let mut snake = Snake::new(body, World::default()).unwrap();
    snake.damp(Damping::Renewed(1.0), &state).unwrap();
    snake.expect_changes_until(50.0);
    let stiffer = snake
        .body()
        .clone()
        .with_material(Material::uniform(1.0, 80.0, 2.0));
    snake.set_body(stiffer).unwrap();
    let before = integrator::System::damping(&snake)[0];
    // chosen anew for the stiffness there is now, when it is due
    integrator::System::advance(&mut snake, 2.0, &state.x);
    let after = integrator::System::damping(&snake)[0];
    assert!(after > 1.5 * before, "{before} {after}");
    // and it waits for the change that was announced
    let until = Until::at_rest(Rest::default(), 1000);
    let stepping = Stepping::of(Scheme::Imex, 0.5);
    let (outcome, state) = common::end(&snake, &state, stepping, &until);
    assert!(
        matches!(outcome, Outcome::Settled { .. }) && state.t >= 50.0,
        "{outcome}"
    );
}
