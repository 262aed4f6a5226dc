//! `snake track --resume`: the same bytes as without an end on the way, and what is refused.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::moving::{START, disc, frames};
use crate::common::{Answer, Folder};

/// All that is written.
const ALL: [&str; 10] = [
    "-o",
    "t.csv",
    "--measure",
    "m.csv",
    "--events",
    "e.csv",
    "--kymograph",
    "k.csv",
    "--overlay",
    "o.gif",
];

fn run(folder: &Folder, more: &[&str]) -> Answer {
    folder.snake(&[&["track", "in"][..], &START, &ALL, more].concat())
}

fn results(folder: &Folder) -> Vec<Vec<u8>> {
    let names = ALL.iter().skip(1).step_by(2);
    names
        .map(|name| std::fs::read(folder.path(name)).unwrap())
        .collect()
}

#[test]
fn a_run_that_was_ended_anywhere_ends_in_the_same_bytes() {
    let folder = frames(8);
    assert_eq!(run(&folder, &[]).code, Some(0));
    let whole = results(&folder);
    let table = String::from_utf8(whole[0].clone()).unwrap();
    let lines = table.split_inclusive('\n').collect::<Vec<_>>();
    let cuts = [0, 1, 2, lines.len() / 3, lines.len() / 2, lines.len() - 1];
    for (round, cut) in cuts.into_iter().enumerate() {
        // what was killed stands in the part; what was ended by Ctrl-C has the name
        std::fs::remove_file(folder.path("t.csv")).unwrap();
        let name = if round % 2 == 0 {
            "t.csv.part"
        } else {
            "t.csv"
        };
        let half = if round == 4 { "4,1,3" } else { "" };
        folder.write(name, lines[..cut].concat() + half);
        folder.write("m.csv", "of the former run");
        let answer = run(&folder, &["--resume"]);
        assert_eq!(answer.code, Some(0), "{cut}: {answer:?}");
        assert!(results(&folder) == whole, "{cut}");
        assert!(!folder.path("t.csv.part").exists());
        if cut > 2 {
            assert!(
                answer.err.contains("what is there is compared")
                    && answer.err.contains("goes on behind frame"),
                "{answer:?}"
            );
        }
    }
    // a part is not written over without that
    std::fs::rename(folder.path("t.csv"), folder.path("t.csv.part")).unwrap();
    folder.refused(
        &[&["track", "in", "-q"][..], &START, &["-o", "t.csv"]].concat(),
        &["t.csv.part", "--resume"],
    );
}

#[test]
fn every_format_that_grows_is_gone_on_with() {
    let folder = frames(6);
    for name in ["t.geojson", "t.txt", "labels"] {
        let go = |more: &[&str]| {
            let out = [
                "--as",
                if name == "labels" { "ctc" } else { "" },
                "-o",
                name,
            ];
            let out = &out[if name == "labels" { 0 } else { 2 }..];
            folder.snake(&[&["track", "in"][..], &START, out, more].concat())
        };
        assert_eq!(go(&[]).code, Some(0), "{name}");
        let is_folder = folder.path(name).is_dir();
        let file = if is_folder {
            format!("{name}/mask004.tif")
        } else {
            name.to_owned()
        };
        let whole = std::fs::read(folder.path(&file)).unwrap();
        if is_folder {
            std::fs::remove_file(folder.path("labels/mask004.tif")).unwrap();
            std::fs::remove_file(folder.path("labels/mask005.tif")).unwrap();
        } else {
            std::fs::remove_file(folder.path(name)).unwrap();
            folder.write(&format!("{name}.part"), &whole[..whole.len() / 2]);
        }
        let answer = go(&["--resume"]);
        assert_eq!(answer.code, Some(0), "{answer:?}");
        assert!(answer.err.contains("goes on behind frame"), "{answer:?}");
        assert!(
            std::fs::read(folder.path(&file)).unwrap() == whole,
            "{name}"
        );
        assert_eq!(go(&["--resume"]).code, Some(0), "{name}");
    }
    for name in ["t.zip", "t.json"] {
        let args = [&["track", "in", "--resume", "-o", name][..], &START].concat();
        folder.refused(&args, &["--resume: goes on with what grows", "needed"]);
    }
}

#[test]
fn what_is_not_the_same_is_refused_and_stays() {
    let folder = frames(5);
    assert_eq!(run(&folder, &[]).code, Some(0));
    let refused = |more: &[&str], says: &[&str]| {
        folder.refused(
            &[&["track", "in", "-q"][..], &ALL, &["--resume"], more].concat(),
            says,
        );
    };
    refused(
        &["--from", "circle:20,24,8.5", "--start", "exact"],
        &["t.csv: line 2: is not what comes out now", "another start"],
    );
    std::fs::remove_file(folder.path("in/f4.pgm")).unwrap();
    refused(&START, &["t.csv: has rows behind those of the last frame"]);
    folder.write("t.csv", "mine");
    refused(&START, &["t.csv: line 1: is not what comes out now"]);
}

#[test]
fn an_error_on_the_way_keeps_what_was_followed() {
    let folder = frames(6);
    folder.write("mend.csv", "frame,id,x,y\n4,1,-9,1\n4,1,-5,1\n4,1,-5,5\n");
    let says = "--mend: frame 4, object 1: start 0: must be a closed outline";
    let bytes: Vec<u8> = (0..6).flat_map(disc).collect();
    let stream = |more: &[&str]| {
        folder.snake_reading(&[&["track", "-"][..], &START, &ALL, more].concat(), &bytes)
    };
    let answer = stream(&["--mend", "mend.csv"]);
    assert_eq!(answer.code, Some(2), "{answer:?}");
    assert!(
        answer.err.contains("what there was by then is written") && answer.err.contains(says),
        "{answer:?}"
    );
    let kept = results(&folder);
    let table = String::from_utf8(kept[0].clone()).unwrap();
    assert!(
        table.contains("\n3,1,") && !table.contains("\n4,"),
        "{table}"
    );
    assert_eq!(kept[1].split(|b| *b == b'\n').count(), 6);
    assert_eq!(stream(&["--resume"]).code, Some(0));
    let resumed = results(&folder);
    assert_eq!(stream(&[]).code, Some(0));
    assert!(results(&folder) == resumed);
    // where frames are followed before anything is written, nothing is changed
    folder.refused(
        &[
            &["track", "in", "-q", "--mend", "mend.csv"][..],
            &START,
            &ALL,
        ]
        .concat(),
        &[says],
    );
}
