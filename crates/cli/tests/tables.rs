//! `snake fit --as parquet`: a table that goes on where it was, by this command or by pysnakes.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::Folder;
use crate::common::fits::small_disc;
use glam::DVec2;
use store::{Results, Row};

/// Pictures a to d, of which c is blank and d is none.
fn pictures() -> Folder {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("in")).unwrap();
    for (name, contrast) in [("a", 120.0), ("b", 110.0), ("c", 0.0)] {
        folder.write(&format!("in/{name}.pgm"), small_disc(contrast));
    }
    folder.write("in/d.pgm", b"P5\n64 48\n255\n and no more");
    folder
}

const FIT: [&str; 8] = [
    "fit",
    "in/",
    "--from",
    "circle:30,24,15",
    "--out-dir",
    "out",
    "--as",
    "parquet",
];

fn parts(folder: &Folder) -> Vec<(String, Vec<u8>)> {
    let list = std::fs::read_dir(folder.path("out")).unwrap();
    let mut parts: Vec<_> = list
        .map(|entry| entry.unwrap())
        .map(|entry| {
            (
                entry.file_name().into_string().unwrap(),
                std::fs::read(entry.path()).unwrap(),
            )
        })
        .collect();
    parts.sort();
    parts
}

#[test]
fn each_picture_is_a_file_of_a_table_a_refused_one_too() {
    let folder = pictures();
    let run = |more: &[&str]| folder.snake(&[&FIT[..], more].concat());
    let first = run(&[]);
    assert_eq!(first.code, Some(1), "{}", first.err);
    let whole = parts(&folder);
    let results = Results::open(&folder.path("out")).unwrap();
    let doubtful = |name: &str| results.doubtful(&format!("in/{name}.pgm")).unwrap();
    assert_eq!(
        ["a", "b", "c", "d", "e"].map(doubtful),
        [Some(0), Some(0), Some(1), Some(1), None]
    );
    assert_eq!(whole.len(), 4);
    // nothing is left to do, and what was not sure is known
    let again = run(&["--resume"]);
    assert_eq!(again.code, Some(1));
    assert!(again.err.contains("4 there already"), "{}", again.err);
    assert!(
        again
            .err
            .contains("in/c.pgm: there already, 1 outline unsure"),
        "{}",
        again.err
    );
    assert_eq!(parts(&folder), whole);
    // one is gone and comes again with the same bytes; threads make no difference
    std::fs::remove_file(results.part("in/b.pgm")).unwrap();
    let again = run(&["--resume", "--jobs", "3"]);
    assert!(again.err.contains("3 there already"), "{}", again.err);
    assert_eq!(parts(&folder), whole);
}

#[test]
fn what_another_program_has_finished_is_passed_over_also_when_it_is_joined() {
    let folder = pictures();
    let points = [(1.0, 1.0), (9.0, 1.0), (5.0, 7.0)].map(|(x, y)| DVec2::new(x, y));
    let results = Results::open(&folder.path("out")).unwrap();
    for (name, joined) in [("in/a.pgm", true), ("in/b.pgm", false)] {
        let part = results.write(name, &[Row::of(&points, true)]).unwrap();
        if joined {
            std::fs::rename(part, folder.path("out/joined.parquet")).unwrap();
        }
    }
    let run = folder.snake(&[&FIT[..], &["--resume"]].concat());
    assert!(run.err.contains("2 there already"), "{}", run.err);
    assert_eq!(parts(&folder).len(), 4);
    // beside other results only the pictures that lack one are looked at
    let both = ["--as", "csv", "--resume"];
    let run = folder.snake(&[&FIT[..], &both].concat());
    assert!(run.err.contains("0 there already"), "{}", run.err);
}

#[test]
fn a_table_is_of_a_folder_and_a_foreign_one_is_refused() {
    let folder = pictures();
    let one = [
        "fit",
        "in/a.pgm",
        "--from",
        "circle:30,24,15",
        "--as",
        "parquet",
        "-o",
        "a.parquet",
    ];
    let run = folder.snake(&one);
    assert_eq!(run.code, Some(2));
    assert!(run.err.contains("--out-dir"), "{}", run.err);
    std::fs::create_dir(folder.path("out")).unwrap();
    folder.write("out/joined.parquet", b"PAR1 and no more");
    let run = folder.snake(&FIT);
    assert_eq!(run.code, Some(2));
    assert!(run.err.contains("joined.parquet"), "{}", run.err);
}
