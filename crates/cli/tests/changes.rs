//! Scenes shown, and changed key by key.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::{Folder, scene};
use scene::SCENES;

#[test]
fn every_shipped_scene_is_shown_as_it_was_written_and_runs_from_what_is_shown() {
    let folder = Folder::new();
    for (name, text) in SCENES {
        let shown = folder.snake(&["show", name]);
        assert_eq!((shown.code, shown.err.as_str()), (Some(0), ""), "{name}");
        assert_eq!(shown.out, *text, "{name}");
    }
    let run = ["--steps", "3", "--record", "-"];
    let shown = folder.snake(&["show", "soft-ball", "--set", "title=A soft ball"]);
    assert!(!shown.out.contains('#'), "{shown:?}");
    folder.write("soft-ball.toml", &shown.out);
    let [by_name, from_file] = ["soft-ball", "soft-ball.toml"].map(|scene| {
        let answer = folder.snake(&[&["run", scene][..], &run].concat());
        assert_eq!(answer.code, Some(0), "{answer:?}");
        answer.out
    });
    assert_eq!(by_name, from_file);
}

#[test]
fn a_run_with_a_key_set_is_the_run_of_a_file_that_says_so() {
    let folder = Folder::new();
    folder.write("a.toml", scene(&[]));
    let set = [
        "--set",
        "material.tension=3",
        "--set",
        "run.steps=7",
        "--set",
        "snake.velocity=[-1, 2]",
        "--set",
        "force.0.kind=gravity",
        "--set",
        "title = Another",
    ];
    // a gravity needs its acceleration
    folder.refused(
        &[&["run", "a.toml"][..], &set, &["--record", "a.csv"]].concat(),
        &["force.0.kind: force 0: missing field `acceleration`"],
    );
    let set = [
        "--set",
        "material.tension=3",
        "--set",
        "run.steps=7",
        "--set",
        "snake.velocity=[-1, 2]",
        "--set",
        "force.0={ kind = \"gravity\", acceleration = [0.0, 1.0] }",
        "--set",
        "title = Another",
    ];
    let answer = folder.snake(&[&["run", "a.toml"][..], &set, &["--record", "a.jsonl"]].concat());
    assert_eq!(answer.code, Some(0), "{answer:?}");
    assert!(
        answer.err.starts_with("Another: finished after 7 steps"),
        "{answer:?}"
    );
    let text = scene(&[
        ("tension = 1.0", "tension = 3.0"),
        ("steps = 5", "steps = 7"),
        ("velocity = [1.0, 0.0]", "velocity = [-1.0, 2.0]"),
        ("title = \"A test\"", "title = \"Another\""),
    ]);
    let force = "[[force]]\nkind = \"gravity\"\nacceleration = [0.0, 1.0]\n";
    std::fs::create_dir(folder.path("other")).unwrap();
    folder.write("other/a.toml", text + force);
    let other = folder.snake(&["run", "other/a.toml", "--record", "-"]);
    let read = std::fs::read_to_string(folder.path("a.jsonl")).unwrap();
    assert_eq!(other.out, read);
    // and what is shown says it
    let shown = folder.snake(&[&["show", "a.toml"][..], &set].concat());
    assert!(shown.out.contains("tension = 3.0\n"), "{shown:?}");
    let again = folder.snake_reading(&["run", "-", "--record", "-"], &shown.out);
    assert_eq!(
        again.out.lines().skip(1).collect::<Vec<_>>(),
        read.lines().skip(1).collect::<Vec<_>>()
    );
}

#[test]
fn keys_and_values_that_there_are_not_are_refused_by_the_key() {
    let folder = Folder::new();
    for command in ["run", "show"] {
        for (set, says) in [
            (
                "material.tensoin=3",
                &["material.tensoin: ", "\"tensoin\"", "\"tension\"?"][..],
            ),
            ("material.tension", &["a key and a value are needed"]),
            ("material.tension=", &["material.tension: has no value"]),
            ("run.dt=fast", &["run.dt: ", "\"auto\"", "fast"]),
            (
                "force.edge.strength=2",
                &["force.edge.strength: ", "no entry \"edge\""],
            ),
            ("=3", &["is no key"]),
        ] {
            folder.refused(&[command, "soft-ball", "--set", set], says);
        }
        folder.refused(&[command, "soft-bal"], &["\"soft-ball\""]);
        folder.refused(&[command, "none.toml"], &["none.toml", "cannot be read"]);
    }
    // what makes no sense is found when it is built
    folder.refused(
        &["run", "soft-ball", "--set", "run.dt=-1"],
        &["run.dt: ", "above 0"],
    );
    folder.write("bad.toml", "title = 3");
    folder.refused(&["show", "bad.toml"], &["bad.toml: line 1"]);
}

#[test]
fn nodes_may_be_so_many_pixels_apart() {
    let folder = Folder::new();
    let text = scene(&[("nodes = 20", "nodes = \"2 px\"")]);
    // 10 π around
    let answer = folder.snake_reading(&["run", "-", "--out", "-"], text);
    assert_eq!(answer.out.lines().count(), 2 + 16, "{answer:?}");
    let wide = scene(&[("nodes = 20", "nodes = \"9 px\"")]);
    folder.refused_reading(
        &["run", "-"],
        wide,
        &[
            "snake.nodes: \"9 px\"",
            "31.42 pixels long",
            "at least 5 nodes, got 3",
        ],
    );
}
