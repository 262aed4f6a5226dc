//! A lone snake is a simulation of one: the same bytes as a plain loop over its scheme, and the same with the
//! contacts of a crowd looked for at every step, for every shipped scene.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a shipped scene that cannot be read should stop it"
)]

use std::ops::ControlFlow::Continue;

use glam::DVec2;
use scene::integrator::{State, Stepper};
use scene::snake::{Contact, Pace, Snake, Term, Turning, TurningStepper, Upkeep};
use scene::{Company, Record, Scene};

/// Enough for contacts, schedules and growth to matter, and few enough for a test.
const STEPS: u64 = 400;

/// A shipped scene of one snake, cut short, that keeps its start and its end.
fn lone(name: &str) -> Option<Scene> {
    let mut scene = Scene::named(name).unwrap();
    if scene.company.is_some() {
        return None;
    }
    scene.plan.until.steps = scene.plan.until.steps.min(STEPS);
    scene.plan.recording = scene::Recording::default();
    Some(scene)
}

fn bits(nodes: &[DVec2]) -> Vec<(u64, u64)> {
    nodes
        .iter()
        .map(|p| (p.x.to_bits(), p.y.to_bits()))
        .collect()
}

fn stepper(scene: &Scene, snake: &mut Snake, state: &State) -> Box<dyn Stepper> {
    let plan = &scene.plan;
    let pace = match (&scene.terms, plan.tolerance) {
        (Some(terms), _) => {
            let turning = Turning::new(snake).unwrap();
            let missing = Term::ALL.iter().filter(|term| !terms.contains(term));
            let turning = missing.fold(turning, |turning, &term| turning.without(term));
            let (scheme, start) = (plan.scheme, plan.start_rule);
            let stepper = TurningStepper::new(turning, scheme, state, plan.dt, start);
            return Box::new(stepper.unwrap());
        }
        (None, None) => Pace::fixed(plan.scheme, snake, state, plan.dt, plan.start_rule),
        (None, Some(tolerance)) => Pace::chosen(plan.scheme, snake, state, plan.dt, tolerance),
    };
    let mut pace = pace.unwrap();
    if plan.each {
        pace = pace.each();
    }
    pace.stepper().boxed()
}

/// The end of the scene by a plain loop, whatever rest says; None where a hand takes part.
fn by_hand(scene: &Scene) -> Option<State> {
    if !scene.hand.is_empty() {
        return None;
    }
    let (plan, mut snake, mut state) = (&scene.plan, scene.of_the_run(), scene.start.clone());
    snake.settle(&state);
    let mut moving = stepper(scene, &mut snake, &state);
    let mut tips = scene.tips.clone();
    for step in 0..plan.until.steps {
        if plan.until.time.is_some_and(|end| state.t >= end) {
            break;
        }
        if let Some((tips, every)) = &mut tips
            && step > 0
            && step.is_multiple_of(*every)
            && let Some((grown, at)) = tips.grow(&snake, &state).unwrap()
        {
            (snake, state) = (grown, at);
            moving = stepper(scene, &mut snake, &state);
        }
        moving.step(&mut snake, &mut state).unwrap();
    }
    Some(state)
}

fn same(name: &str, one: &Record, other: &Record) {
    assert_eq!(one.outcome, other.outcome, "{name}");
    assert_eq!(one.events, other.events, "{name}");
    let (a, b) = (one.last().unwrap(), other.last().unwrap());
    assert_eq!((a.step, a.t.to_bits()), (b.step, b.t.to_bits()), "{name}");
    assert_eq!(bits(a.nodes()), bits(b.nodes()), "{name}");
}

#[test]
fn a_simulation_of_one_is_a_plain_loop_over_its_scheme() {
    let mut ran = 0;
    for (name, _) in scene::SCENES {
        let Some(mut scene) = lone(name) else {
            continue;
        };
        scene.plan.until.rest = None;
        let Some(end) = by_hand(&scene) else { continue };
        let record = scene.run(&mut |_| Continue(())).unwrap();
        assert_eq!(bits(record.last().unwrap().nodes()), bits(&end.x), "{name}");
        ran += 1;
    }
    assert!(ran > 20, "{ran}");
}

#[test]
fn a_lone_snake_in_a_crowd_moves_as_without_one() {
    let contact = Contact {
        stiffness: 1e-6,
        damping: 0.0,
        friction: 0.0,
        wall_friction: 0.0,
        stick: 0.0,
        gap: 1e-3,
        adhesion: 0.0,
        range: 0.0,
        stop: 1.0,
        own: false,
    };
    let mut alone = Vec::new();
    for (name, _) in scene::SCENES {
        let Some(scene) = lone(name) else { continue };
        if scene.plan.each {
            // its sub-steps are steps of its own, which others cannot share
            alone.push(*name);
            continue;
        }
        let mut crowd = scene.clone();
        crowd.company = Some(Company {
            others: Vec::new(),
            contact: Some(contact),
            upkeep: Upkeep::default(),
        });
        let one = scene.run(&mut |_| Continue(())).unwrap();
        let other = crowd.run(&mut |_| Continue(())).unwrap();
        same(name, &one, &other);
    }
    assert_eq!(alone, [""; 0]);
}
