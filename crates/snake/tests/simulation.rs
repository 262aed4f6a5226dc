//! A run is a value: copied, edited between two steps, joined and left by snakes.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a snake that cannot be built should stop it"
)]

use crate::common;

use std::ops::ControlFlow::Continue;

use elastic::{Material, Topology};
use glam::DVec2;
use integrator::{Scheme, State};
use snake::{
    Acting, Body, Contact, Edit, Entry, Frame, Parameter, Rules, Simulation, SimulationError,
    Snake, Spring, Stepping, Term, Until, Upkeep, World,
};
use {banded as _, field as _, outline as _, proptest as _, thiserror as _};

const LAYER: Contact = Contact {
    stiffness: 40.0,
    damping: 0.0,
    friction: 0.0,
    wall_friction: 0.0,
    stick: 1.0,
    adhesion: 0.0,
    range: 0.0,
    gap: 0.2,
    stop: 0.3,
    own: false,
};

fn ball(center: DVec2, v: DVec2, frame: Frame) -> (Snake, State) {
    let nodes = elastic::ellipse(center, DVec2::new(2.2, 1.8), 0.3, 24);
    let mut body = Body::of(&nodes, Topology::Closed, 1.0)
        .unwrap()
        .with_material(Material::uniform(1.0, 20.0, 4.0));
    body.frame = frame;
    let mut state = State::at_rest(nodes);
    state.v.fill(v);
    (Snake::new(body, World::default()).unwrap(), state)
}

/// Two balls on their way to each other.
fn two(frame: Frame) -> Vec<(Snake, State)> {
    vec![
        ball(DVec2::ZERO, DVec2::new(1.5, 0.2), frame),
        ball(DVec2::new(5.0, 0.7), DVec2::new(-1.0, 0.0), frame),
    ]
}

fn met(stepping: Stepping, energies: bool) -> Simulation {
    let rules = (Some(LAYER), Upkeep::default());
    common::simulation(two(Frame::corrected()), stepping, rules, energies).unwrap()
}

fn go(simulation: &mut Simulation, steps: u64) {
    let outcome = simulation
        .run(&Until::steps(steps), &mut |_| Continue(()))
        .unwrap();
    assert!(outcome.is_good(), "{outcome}");
}

fn places(simulation: &Simulation) -> Vec<Vec<DVec2>> {
    let members = simulation.members().iter();
    members
        .map(|m| [m.state().x.clone(), m.state().v.clone()].concat())
        .collect()
}

#[test]
fn a_copy_goes_on_as_the_original_does_to_the_last_bit() {
    for &scheme in Scheme::ALL {
        let chosen = [None, Some(1e-4)];
        let chosen = chosen
            .iter()
            .filter(|t| t.is_none() || scheme != Scheme::Report);
        for &tolerance in chosen {
            let stepping = Stepping {
                tolerance,
                ..Stepping::of(scheme, 0.01)
            };
            let mut original = met(stepping, true);
            go(&mut original, 70);
            let mut copy = original.clone();
            go(&mut original, 60);
            go(&mut copy, 60);
            assert_eq!(places(&original), places(&copy), "{scheme}");
            assert_eq!(original.energies(), copy.energies(), "{scheme}");
        }
    }
}

#[test]
fn a_run_in_parts_is_the_run_whole_to_the_last_bit() {
    for &scheme in Scheme::ALL {
        let (mut whole, mut parts) = (
            met(Stepping::of(scheme, 0.01), false),
            met(Stepping::of(scheme, 0.01), false),
        );
        go(&mut whole, 150);
        for steps in [1, 49, 100] {
            go(&mut parts, steps);
        }
        assert_eq!(places(&whole), places(&parts), "{scheme}");
    }
}

#[test]
fn one_ball_of_two_is_pulled_held_and_let_go_and_the_account_closes() {
    let mut simulation = met(Stepping::of(Scheme::Leapfrog, 0.004), true);
    let first = simulation.energies().total();
    let (mut off, mut most) = (0.0_f64, 0.0_f64);
    let mut watch = |simulation: &mut Simulation| {
        let energies = simulation.energies();
        off = off.max((energies.total() - first).abs());
        most = energies
            .values()
            .iter()
            .fold(most, |most, e| most.max(e.abs()));
    };
    let to = DVec2::new(5.0, 6.0);
    let edits = [
        Edit::Add(Acting::new(Spring::at_node(3, to, 9.0)).named("pull")),
        Edit::Set(Parameter::Damping, 0.5),
        Edit::Replace(Acting::new(Spring::at_node(9, to, 20.0)).named("pull")),
        Edit::Hold(vec![0, 1]),
        Edit::Remove("pull".to_owned()),
        Edit::Release(vec![0, 1]),
        Edit::Set(Parameter::Tension, 30.0),
    ];
    let before = simulation.members()[0].snake().body().clone();
    for edit in edits {
        simulation.edit(1, edit).unwrap();
        for _ in 0..150 {
            assert!(simulation.step().unwrap().is_continue());
            watch(&mut simulation);
        }
    }
    // the contacts' own error of order 2 in the step
    assert!(off < 2e-3 * most, "{off} of {most}");
    assert!(simulation.energies().hand.abs() > 1.0);
    let members = simulation.members();
    assert_eq!(members[0].snake().body(), &before);
    assert!(elastic::center(&members[1].state().x, None).y > 1.5);
}

#[test]
fn what_cannot_be_edited_is_refused_and_changes_nothing() {
    let mut simulation = met(Stepping::of(Scheme::Leapfrog, 0.01), false);
    go(&mut simulation, 10);
    let mut twin = simulation.clone();
    for (id, edit, says) in [
        (7, Edit::Hold(vec![0]), "no snake 7"),
        (0, Edit::Hold(vec![24]), "node 24"),
        (0, Edit::Remove("pull".to_owned()), "pull"),
        (0, Edit::Set(Parameter::Mass, -1.0), "mass"),
        (0, Edit::Set(Parameter::Tension, f64::NAN), "tension"),
        (0, Edit::Rest(vec![DVec2::ZERO; 24]), ""),
        (1, Edit::Rest(vec![DVec2::ZERO; 5]), "24"),
    ] {
        let error = simulation.edit(id, edit).unwrap_err();
        assert!(error.to_string().contains(says), "{says}: {error}");
    }
    go(&mut simulation, 100);
    go(&mut twin, 100);
    assert_eq!(places(&simulation), places(&twin));
}

#[test]
fn a_snake_joins_and_another_leaves() {
    let mut simulation = met(Stepping::of(Scheme::Leapfrog, 0.01), true);
    go(&mut simulation, 20);
    let (snake, state) = ball(DVec2::new(0.0, 9.0), DVec2::ZERO, Frame::corrected());
    let total = simulation.energies().total();
    let id = simulation.add(Entry::new(snake, state)).unwrap();
    assert_eq!((id, simulation.members().len()), (2, 3));
    assert!((simulation.members()[2].state().t - 0.2).abs() < 1e-12);
    go(&mut simulation, 20);
    let gone = simulation.remove(0).unwrap();
    // what they brought and took is booked, and the sum stays
    assert!((simulation.energies().total() - total).abs() < 1e-4 * total);
    assert_eq!(gone.state.step, 40);
    go(&mut simulation, 20);
    let ids: Vec<usize> = simulation.members().iter().map(|m| m.id()).collect();
    assert_eq!(ids, [1, 2]);
    assert!(matches!(
        simulation.remove(0).unwrap_err(),
        SimulationError::NoSuchSnake { id: 0 }
    ));
    let gone = gone.snake.edits();
    assert_eq!(gone, 0, "the edit did not change it");
}

#[test]
fn balls_whose_frames_have_their_own_equation_meet_and_keep_their_momentum() {
    let rules = Rules {
        contact: Some(LAYER),
        ..Rules::default()
    };
    let entries = two(Frame::turning())
        .into_iter()
        .map(|(snake, state)| Entry {
            terms: Some(Term::ALL.to_vec()),
            ..Entry::new(snake, state)
        });
    let stepping = Stepping::of(Scheme::Rk4, 0.002);
    let mut own = Simulation::new(entries.collect(), stepping, &rules).unwrap();
    let rules = (Some(LAYER), Upkeep::default());
    let mut fit = common::simulation(two(Frame::turning()), stepping, rules, false).unwrap();
    let (momentum, spin) = (own.momentum(), own.angular_momentum());
    go(&mut own, 1500);
    go(&mut fit, 1500);
    assert!(own.momentum().distance(momentum) < 1e-9 * momentum.length());
    assert!((own.angular_momentum() - spin).abs() < 1e-5 * spin.abs());
    // they have bounced, and the same motion by the fitted frame is where this one is
    assert!(own.members()[0].state().v[0].x < 0.5);
    for (a, b) in own.members().iter().zip(fit.members()) {
        let ways = a.state().x.iter().zip(&b.state().x);
        let off = ways.map(|(p, q)| p.distance(*q)).fold(0.0, f64::max);
        assert!(off < 2e-3, "{off}");
    }
}
