//! `[[hand]]`: forces and holds that come and go during a run of a scene.
#![allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    reason = "a test: a scene that cannot run should stop it, and what stands stands"
)]

use std::ops::ControlFlow;
use std::path::Path;

use scene::integrator::{Scheme, Start};
use scene::snake::{Acting, Spring};
use scene::{Record, Scene};

/// An arch in empty space that swings, with these hands.
fn arch(hands: &str) -> String {
    format!(
        r#"
title = "An arch"
{hands}
[snake]
nodes = 21
topology = "open"
start = {{ points = [[0.0, 0.0], [5.0, 6.0], [10.0, 8.0], [15.0, 6.0], [20.0, 0.0]] }}
rest = {{ segment = {{ from = [0.0, 0.0], to = [20.0, 0.0] }} }}
[material]
tether = 0.0
tension = 10.0
rigidity = 20.0
[densities]
mass = 1.0
damping = 0.5
[run]
dt = 0.05
time = 20.0
[record]
every = 1
energies = true
"#
    )
}

fn scene(hands: &str) -> Scene {
    Scene::parse("arch", &arch(hands), Path::new(".")).unwrap()
}

fn run(scene: &mut Scene) -> Record {
    scene.run(&mut |_| ControlFlow::Continue(())).unwrap()
}

fn refusal(hands: &str) -> String {
    Scene::parse("arch", &arch(hands), Path::new("."))
        .unwrap_err()
        .to_string()
}

const PULL: &str = r#"
[[hand]]
from = 5.0
until = 12.0
force = { kind = "spring", name = "pull", from = [10.0, 9.0], to = [10.0, 20.0], stiffness = 8.0 }
"#;

#[test]
fn a_hand_of_a_scene_is_what_an_observer_would_do() {
    let mut scene_ = scene(PULL);
    let record = run(&mut scene_);
    let plain = scene("");
    let (mut snake, mut state) = (plain.snake.clone(), plain.start.clone());
    let mut stepper = Scheme::Leapfrog
        .start(&mut snake, &state, 0.05, Start::SecondOrder)
        .unwrap();
    for step in 0..400 {
        if step == 100 {
            let (from, to) = (glam::DVec2::new(10.0, 9.0), glam::DVec2::new(10.0, 20.0));
            let spring = Spring::at_nearest(&state.x, false, from, to, 8.0).unwrap();
            let acting = Acting::new(spring).named("pull");
            snake.add_force(acting).unwrap();
            stepper.resume(&mut snake, &state);
        } else if step == 240 {
            assert!(snake.remove_force("pull").is_some());
            stepper.resume(&mut snake, &state);
        }
        stepper.step(&mut snake, &mut state).unwrap();
    }
    assert_eq!(record.last().unwrap().nodes(), state.x);
    assert_eq!(
        record.events,
        [
            "t = 5.0000: hand 0 takes hold of the curve, pull",
            "t = 12.0000: hand 0 lets go of the curve, pull"
        ]
    );
    // and the scene is as it was
    assert_eq!(run(&mut scene_), record);
}

#[test]
fn before_a_hand_comes_the_run_is_the_one_without_it_to_the_last_bit() {
    let (with, without) = (run(&mut scene(PULL)), run(&mut scene("")));
    for (a, b) in with.frames.iter().zip(&without.frames).take(101) {
        assert_eq!(a.nodes(), b.nodes(), "at step {}", a.step);
    }
    let (a, b) = (with.frames[110].nodes(), without.frames[110].nodes());
    assert!(a[10].distance(b[10]) > 0.1, "{} {}", a[10], b[10]);
}

#[test]
fn what_a_hand_puts_in_is_booked_and_the_account_closes() {
    let record = run(&mut scene(PULL));
    let total = |k: usize| record.frames[k].energies.as_ref().unwrap().total();
    let hand = |k: usize| record.frames[k].energies.as_ref().unwrap().hand;
    assert_eq!(hand(100), 0.0);
    // the spring is stretched when it comes and when it goes
    assert!(hand(101).abs() > 100.0 && (hand(400) - hand(101)).abs() > 1.0);
    for k in 0..=400 {
        // some hundred terms of a few hundred units
        assert!((total(k) - total(0)).abs() < 1e-9, "step {k}: {}", total(k));
    }
}

#[test]
fn held_nodes_stand_until_they_are_let_go_and_no_longer() {
    let hold = "[[hand]]\nfrom = 2.0\nuntil = 9.0\nhold = [3, 5]\n[[hand]]\nfrom = 4.0\nuntil = 12.0\nhold = [5, 6]";
    let record = run(&mut scene(hold));
    let at = |k: usize, node: usize| record.frames[k].nodes()[node];
    for (node, from, until) in [(3, 40, 180), (5, 40, 240), (6, 80, 240)] {
        for k in from..=until {
            assert_eq!(at(k, node), at(from, node), "node {node} at step {k}");
        }
        assert_ne!(at(until + 1, node), at(until, node));
        assert_ne!(at(from - 1, node), at(from, node));
    }
}

#[test]
fn a_freeze_keeps_nodes_where_they_are_when_it_comes() {
    let freeze = |from: f64, step: usize| {
        let hand = format!(
            "[[hand]]\nfrom = {from:.1}\nforce = {{ kind = \"freeze\", stretch = [8, 12], stiffness = 200.0, damping = 20.0 }}"
        );
        let record = run(&mut scene(&hand));
        let (then, end) = (record.frames[step].nodes(), record.last().unwrap().nodes());
        (8..=12)
            .map(|i| then[i].distance(end[i]))
            .fold(0.0, f64::max)
    };
    // what tension and rigidity pull with, some units, over 200
    assert!(freeze(1.0, 20) < 0.1 && freeze(3.0, 60) < 0.1);
}

#[test]
fn a_snake_that_does_not_move_waits_for_the_hand() {
    let still = |hands: &str| {
        let text = arch(hands)
            .replace("[5.0, 6.0], [10.0, 8.0], [15.0, 6.0], ", "")
            .replace("time = 20.0", "time = 400.0\nrest = {}");
        let mut scene = Scene::parse("rod", &text, Path::new(".")).unwrap();
        run(&mut scene).outcome
    };
    assert!(still("").step() < 100);
    let late = PULL.replace("5.0\n", "50.0\n").replace("12.0\n", "60.0\n");
    let outcome = still(&late);
    assert!(outcome.step() > 1200 && outcome.is_good(), "{outcome}");
}

#[test]
fn hands_that_will_not_do_are_refused_by_their_key() {
    let spring = "force = { kind = \"spring\", node = 2, to = [0.0, 0.0], stiffness = 1.0 }";
    for (hands, says) in [
        (
            "[[hand]]\nfrom = 1.0",
            "hand 0: needs one of the keys hold and force",
        ),
        (
            &*format!("[[hand]]\nhold = [0, 1]\n{spring}"),
            "hand 0: needs one of the keys hold and force",
        ),
        ("[[hand]]\nhold = [5, 3]", "hand 0: hold"),
        ("[[hand]]\nhold = [0, 21]", "hand 0: hold"),
        ("[[hand]]\nfrom = -1.0\nhold = [0, 1]", "hand 0: from"),
        (
            "[[hand]]\nfrom = 3.0\nuntil = 3.0\nhold = [0, 1]",
            "hand 0: until",
        ),
        (
            "[[hand]]\nforce = { kind = \"edge\" }",
            "looks at the picture; needed: a [[force]]",
        ),
        (
            "[[hand]]\nforce = { kind = \"spring\", node = 40, to = [0.0, 0.0], stiffness = 1.0 }",
            "hand 0: force: node",
        ),
        ("[[hand]]\nforce = { kind = \"sprung\" }", "sprung"),
        (
            "[upkeep]\nstretch = 2.0\n[[hand]]\nhold = [0, 1]",
            "[upkeep] numbers them anew",
        ),
    ] {
        let error = refusal(hands);
        assert!(error.contains(says), "{hands}: {error}");
    }
}

/// Two balls at rest beside each other, the second in front of the first, in a world where they push each other.
fn balls(hands: &str) -> Result<Scene, scene::SceneError> {
    let text = format!(
        r#"
title = "Two balls"
{hands}
[snake]
nodes = 24
topology = "closed"
start = {{ circle = {{ center = [0.0, 0.0], radius = 2.0 }} }}
[[also]]
at = [[4.5, 0.0]]
[material]
tether = 1.0
tension = 20.0
rigidity = 4.0
[densities]
mass = 1.0
damping = 0.5
[contact]
stiffness = 200.0
stop = 0.3
[run]
dt = 0.01
time = 6.0
[record]
every = 1
energies = true
"#
    );
    Scene::parse("balls", &text, Path::new("."))
}

#[test]
fn a_hand_drags_one_ball_of_two_against_the_other() {
    let drag = "[[hand]]\nsnake = 1\nfrom = 1.0\nuntil = 5.0\n\
                force = { kind = \"spring\", from = [2.5, 0.0], to = [-1.0, 0.0], stiffness = 40.0 }";
    let record = run(&mut balls(drag).unwrap());
    let end = record.last().unwrap();
    let center = |nodes: &[glam::DVec2]| elastic_center(nodes).x;
    let [first, second] = [0, 1].map(|k| center(&end.curves[k].nodes));
    // the first is pushed aside by the second, which is dragged
    assert!(first < -0.5 && second < 4.0, "{first} {second}");
    assert_eq!(
        record.events[0],
        "t = 1.0000: hand 0 takes hold of the curve of snake 1, spring"
    );
    let still = run(&mut balls("").unwrap());
    assert!(center(still.last().unwrap().nodes()).abs() < 1e-9);
    // a snake that there is not
    let error = balls(&drag.replace("snake = 1", "snake = 2")).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("hand 0: snake: must be at most 1"),
        "{error}"
    );
}

fn elastic_center(nodes: &[glam::DVec2]) -> glam::DVec2 {
    nodes.iter().sum::<glam::DVec2>() / nodes.len() as f64
}
