//! What a scene says of the body beyond its material: frames that turn, damping that is chosen.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use std::ops::ControlFlow;
use std::path::Path;

use scene::elastic;
use scene::snake::Certificate;
use scene::{Record, SCENES, Scene};

fn changed(name: &str, changes: &[(&str, &str)]) -> Result<Scene, scene::SceneError> {
    let (_, text) = SCENES.iter().find(|(known, _)| *known == name).unwrap();
    let text = changes.iter().fold((*text).to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{name} has no {from}");
        text.replace(from, to)
    });
    Scene::parse(name, &text, Path::new("."))
}

fn run(scene: &mut Scene) -> Record {
    scene.run(&mut |_| ControlFlow::Continue(())).unwrap()
}

fn refused(name: &str, changes: &[(&str, &str)]) -> String {
    changed(name, changes).unwrap_err().to_string()
}

#[test]
fn the_word_critical_gives_the_slowest_mode_that_resists_its_critical_damping() {
    let scene = Scene::named("calmed-oval").unwrap();
    let modes = Certificate::of(&scene.snake, None).modes;
    let slowest = modes.iter().find(|mode| mode.frequency > 0.0).unwrap();
    assert!((slowest.damping_ratio() - 1.0).abs() < 1e-12);
    let third = changed("calmed-oval", &[("\"critical\"", "\"mode(2)\"")]).unwrap();
    let modes = Certificate::of(&third.snake, None).modes;
    let resisting: Vec<_> = modes.iter().filter(|mode| mode.frequency > 0.0).collect();
    assert!((resisting[2].damping_ratio() - 1.0).abs() < 1e-12);
}

#[test]
fn a_calmed_oval_is_at_rest_long_before_the_ringing_one() {
    let mut calm = Scene::named("calmed-oval").unwrap();
    let calmed = run(&mut calm);
    let mut ringing = changed("calmed-oval", &[("\"critical\"", "0.3")]).unwrap();
    let rang = run(&mut ringing);
    assert_eq!(calmed.outcome.name(), "settled");
    assert!(calmed.outcome.step() * 2 < rang.outcome.step());
}

#[test]
fn internal_damping_takes_from_bending_and_nothing_from_flight() {
    let text = [
        (
            "damping = \"critical\"",
            "damping = 0.0\ninternal = \"critical\"",
        ),
        (
            "topology = \"closed\"",
            "topology = \"closed\"\nvelocity = [3.0, 0.0]",
        ),
        ("rest = {}", ""),
        ("time = 200.0", "time = 20.0"),
        ("dt = 0.02", "dt = 0.0004"),
        ("every = 10\n", "every = 10000\n"),
    ];
    let mut scene = changed("calmed-oval", &text).unwrap();
    let record = run(&mut scene);
    let last = record.frames.last().unwrap();
    let energies = last.energies.as_ref().unwrap();
    let flight = 0.5 * scene.snake.body().spacing * 64.0 * 9.0;
    // of the shape nothing is left, of the flight all
    assert!((energies.kinetic / flight - 1.0).abs() < 1e-6);
    // stiff modes creep at half the frequency of the critical one: e^(−2 · 0.226 · 20) = 1e-4
    assert!(energies.elastic() < 1e-3 * energies.damping);
}

#[test]
fn rules_of_damping_that_are_none_are_refused_with_what_would_do() {
    for (word, says) in [
        ("\"criticl\"", "there is no rule \"criticl\""),
        ("\"mode(9000)\"", "no mode 9000"),
        ("\"internal(1)\"", "no rule of this key"),
        ("\"renewed(0)\"", "above 0"),
        ("-1.0", "at least 0"),
    ] {
        let message = refused("calmed-oval", &[("\"critical\"", word)]);
        assert!(message.starts_with("densities.damping: "), "{message}");
        assert!(message.contains(says), "{message}");
    }
    let inside = |word: &str| {
        let text = format!("damping = 0.1\ninternal = {word}");
        refused("calmed-oval", &[("damping = \"critical\"", text.as_str())])
    };
    assert!(inside("\"local\"").contains("densities.internal: local is no rule"));
    assert!(inside("-0.5").contains("internal damping"));
    let looked_after = [
        ("[run]", "[upkeep]\nstretch = 2.0\n[run]"),
        ("\"critical\"", "\"renewed(1)\""),
    ];
    assert!(refused("calmed-oval", &looked_after).contains("\"local\" would do"));
}

#[test]
fn a_spinning_oval_keeps_its_energy_by_either_turning_frame_and_moves_alike() {
    let mut equations = Scene::named("spinning-oval").unwrap();
    let by_equations = run(&mut equations);
    let fit = [(
        "frame = { terms = [\"centrifugal\", \"coriolis\", \"transverse\"] }",
        "frame = \"turning\"",
    )];
    let by_fit = run(&mut changed("spinning-oval", &fit).unwrap());
    let pairs = by_equations.frames.iter().zip(&by_fit.frames);
    for (a, b) in pairs {
        let apart = a.nodes.iter().zip(&b.nodes).map(|(a, b)| a.distance(*b));
        // two ways of order 4 over two turns
        assert!(apart.fold(0.0, f64::max) < 1e-5, "at {}", a.t);
    }
    let total = |record: &Record, k: usize| record.frames[k].energies.as_ref().unwrap().total();
    let last = by_equations.frames.len() - 1;
    assert!((total(&by_equations, last) / total(&by_equations, 0) - 1.0).abs() < 1e-7);
}

#[test]
fn a_term_left_out_by_name_changes_the_motion_as_theory_says() {
    // without the centrifugal force nothing widens the oval: its greatest elastic energy falls
    let greatest = |record: &Record| {
        let energies = record
            .frames
            .iter()
            .map(|frame| frame.energies.as_ref().unwrap().elastic());
        energies.fold(0.0, f64::max)
    };
    let whole = run(&mut Scene::named("spinning-oval").unwrap());
    let without = [("\"centrifugal\", ", "")];
    let without = run(&mut changed("spinning-oval", &without).unwrap());
    assert!(greatest(&without) < 0.1 * greatest(&whole));
}

#[test]
fn what_a_turning_frame_cannot_carry_is_refused_by_its_key() {
    for (from, to, says) in [
        ("\"coriolis\"", "\"corioli\"", "did you mean \"coriolis\""),
        (
            "topology = \"closed\"",
            "topology = { head = \"pinned\", tail = \"free\" }",
            "every node free",
        ),
        (
            "[run]",
            "[schedule]\ntension = [[0.0, 1.0], [1.0, 2.0]]\n[run]",
            "stay the same",
        ),
        ("[run]", "[[also]]\nspin = 1.0\n[run]", "one snake"),
        ("dt = 0.002\n", "dt = \"auto\"\n", "\"auto\""),
        (
            "title",
            "rules = { frame = \"report\" }\ntitle",
            "does not turn",
        ),
    ] {
        let scene = changed("spinning-oval", &[(from, to)]);
        let error = scene
            .and_then(|scene| scene.check())
            .unwrap_err()
            .to_string();
        assert!(error.contains(says), "{to}: {error}");
    }
}

#[test]
fn a_picture_that_rotates_takes_a_turning_oval_with_it_and_strains_one_that_does_not_turn() {
    let strain = |frame: &str| {
        let changes = [
            ("frame = \"turning\"", frame),
            ("time = 630.0", "time = 157.0"),
        ];
        let mut scene = changed("turned-oval", &changes).unwrap();
        let record = run(&mut scene);
        let last = record.frames.last().unwrap();
        // angle of the longer axis, from the second moments
        let center = elastic::center(&last.nodes, None);
        let (mut xx, mut xy) = (0.0, 0.0);
        for p in &last.nodes {
            let q = *p - center;
            xx += q.x * q.x - q.y * q.y;
            xy += 2.0 * q.x * q.y;
        }
        (
            0.5 * xy.atan2(xx),
            last.energies.as_ref().unwrap().elastic(),
        )
    };
    // a quarter turn at 0.01 per unit of time
    let (turned, calm) = strain("frame = \"turning\"");
    assert!(
        (turned.abs() - std::f64::consts::FRAC_PI_2).abs() < 0.1,
        "{turned}"
    );
    let (_, strained) = strain("frame = \"translating\"");
    assert!(calm < 0.05 * strained, "{calm} {strained}");
    for (from, to, says) in [
        ("spin = 0.01\n", "", "with it spin would do"),
        (
            "about = [63.5, 63.5]",
            "about = [1e12, 0.0]",
            "force 0: about",
        ),
    ] {
        assert!(refused("turned-oval", &[(from, to)]).contains(says));
    }
}
