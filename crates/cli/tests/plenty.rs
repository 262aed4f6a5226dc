//! Small texts that ask for very much: refused with the figure, or done in a time that their length explains.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::{Folder, refused, scene};

#[test]
fn products_are_refused_with_the_key() {
    let places: Vec<String> = (0..300).map(|k| format!("[{k}.0, 0.0]")).collect();
    let many = format!("\n[[also]]\nat = [{}]\n", places.join(", "));
    refused(
        scene(&[("nodes = 20", "nodes = 20000")]) + &many,
        &["also 0: at", "6020000 nodes", "at most 2097152"],
    );
    let picture = "[picture.drawn]\nsize = [2048, 2048]\nregion = { right-of = 5.0 }\n[snake]";
    let fields: Vec<String> = (0..40)
        .map(|k| format!("[[force]]\nkind = \"edge\"\nsigma = 2.{k:02}\n"))
        .collect();
    refused(
        scene(&[("[snake]", picture)]) + &fields.join(""),
        &["force 32: kind", "at most 32"],
    );
    let walls = "[[world.wall]]\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\nlaw = \"clamp\"\n";
    refused(
        scene(&[]) + &walls.repeat(4000) + &many,
        &[
            "also 0: force",
            "300 snakes of 4000 forces",
            "at most 1048576",
        ],
    );
    refused(
        scene(&[("dt = 0.01", "dt = \"auto\"\noutput = 1e9")]),
        &["run.output", "sub-steps", "at most 10000000"],
    );
}

#[test]
fn long_lists_of_what_is_the_same_are_done_in_a_time_that_their_length_explains() {
    let folder = Folder::new();
    let force = "[[force]]\nkind = \"gravity\"\nacceleration = [0.0, 0.0]\n";
    folder.write("forces.toml", scene(&[]) + &force.repeat(10_000));
    let begin = std::time::Instant::now();
    let answer = folder.snake(&["run", "forces.toml", "--steps", "1"]);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    folder.write(
        "also.toml",
        scene(&[]) + &"[[also]]\nspin = 1.0\n".repeat(9000),
    );
    let answer = folder.snake(&["run", "also.toml", "--steps", "1"]);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    // some seconds on a slow machine; quadratic it was minutes
    assert!(begin.elapsed().as_secs() < 60, "{:?}", begin.elapsed());
}

#[test]
fn a_list_where_a_word_is_expected_is_refused_and_not_shown() {
    let long = format!("[{}1]", "1,".repeat(1 << 16));
    for (line, instead) in [
        ("title = \"A test\"", format!("title = {long}")),
        ("damping = 0.1", format!("damping = [{long}]")),
        ("topology = \"closed\"", format!("topology = {long}")),
    ] {
        refused(scene(&[(line, &instead)]), &["line"]);
    }
    let force = format!("[[force]]\nkind = {long}\n");
    refused(scene(&[]) + &force, &["kind: expected a word, got a list"]);
    let values = format!("title = [{}1]", "1,".repeat(5 << 20));
    refused(values, &["line 1", "more than 4194304 values"]);
}

#[test]
fn a_force_cannot_have_the_name_of_a_column() {
    for name in [
        "upkeep", "between", "outside", "curve", "total", "kinetic", "x", "higher",
    ] {
        let force = format!(
            "[[force]]\nkind = \"gravity\"\nname = \"{name}\"\nacceleration = [0.0, 0.0]\n"
        );
        refused(scene(&[]) + &force, &["force 0: name", name, "is taken"]);
    }
}
