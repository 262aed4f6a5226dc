//! `snake track`: what it reads, what it writes, what it says, and how it goes on.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::moving::{START, disc, frames};
use crate::common::{Answer, Folder};

fn run(folder: &Folder, more: &[&str]) -> Answer {
    folder.snake(&[&["track", "in"][..], &START, more].concat())
}

fn read(folder: &Folder, name: &str) -> String {
    std::fs::read_to_string(folder.path(name)).unwrap()
}

/// The mean place of the points of each frame of a table.
fn middles(text: &str) -> Vec<(usize, f64, f64)> {
    let mut list: Vec<(usize, f64, f64, f64)> = Vec::new();
    for line in text.lines().skip(1) {
        let numbers: Vec<f64> = line.split(',').map(|word| word.parse().unwrap()).collect();
        let frame = numbers[0] as usize;
        match list.last_mut() {
            Some(last) if last.0 == frame => {
                (last.1, last.2, last.3) = (last.1 + numbers[2], last.2 + numbers[3], last.3 + 1.0);
            }
            _ => list.push((frame, numbers[2], numbers[3], 1.0)),
        }
    }
    list.into_iter()
        .map(|(frame, x, y, n)| (frame, x / n, y / n))
        .collect()
}

#[test]
fn a_disc_is_followed_and_all_is_written_that_is_asked_for() {
    let folder = frames(8);
    let answer = run(
        &folder,
        &[
            "-o",
            "t.csv",
            "--measure",
            "m.csv",
            "--events",
            "e.csv",
            "--overlay",
            "o.gif",
            "--kymograph",
            "k.png",
            "--trajectories",
            "w.png",
            "--json",
        ],
    );
    assert_eq!(answer.code, Some(0), "{answer:?}");
    assert!(
        answer.err.contains("1 object followed through 8 frames"),
        "{answer:?}"
    );
    assert!(answer.err.contains("8 files are masks"), "{answer:?}");
    let json: serde_json::Value = serde_json::from_str(&answer.out).unwrap();
    assert_eq!(
        (&json["frames"], &json["good"], &json["left"]),
        (&8.into(), &true.into(), &0.into())
    );
    let text = read(&folder, "t.csv");
    assert!(text.starts_with("frame,id,x,y\n0,1,"), "{text}");
    let found = middles(&text);
    assert_eq!(found.len(), 8);
    for (frame, x, y) in found {
        let off = (x - 20.0 - 2.0 * frame as f64).hypot(y - 24.0);
        assert!(off < 0.4, "{frame}: {x} {y}");
    }
    let measures = read(&folder, "m.csv");
    assert_eq!(measures.lines().count(), 9);
    let areas: Vec<f64> = measures
        .lines()
        .skip(1)
        .map(|line| line.split(',').nth(6).unwrap().parse().unwrap())
        .collect();
    // π 9² = 254, and half a pixel around is 28
    assert!(
        areas.iter().all(|area| (area - 254.0).abs() < 28.0),
        "{areas:?}"
    );
    assert_eq!(
        read(&folder, "e.csv"),
        "frame,id,event,others,confidence\n0,1,begun,,1\n"
    );
    for (name, head) in [
        ("o.gif", &b"GIF89a"[..]),
        ("k.png", b"\x89PNG"),
        ("w.png", b"\x89PNG"),
    ] {
        assert!(
            std::fs::read(folder.path(name)).unwrap().starts_with(head),
            "{name}"
        );
    }
    // the same again gives the same bytes, for any number of threads
    let before: Vec<Vec<u8>> = ["t.csv", "o.gif", "k.png"]
        .map(|name| std::fs::read(folder.path(name)).unwrap())
        .into();
    let again = run(
        &folder,
        &[
            "-o",
            "t.csv",
            "--overlay",
            "o.gif",
            "--kymograph",
            "k.png",
            "-j",
            "1",
        ],
    );
    assert_eq!(again.code, Some(0));
    let after: Vec<Vec<u8>> = ["t.csv", "o.gif", "k.png"]
        .map(|name| std::fs::read(folder.path(name)).unwrap())
        .into();
    assert!(before == after);
}

#[test]
fn every_format_is_written_by_the_name_of_its_file() {
    let folder = frames(3);
    for (name, begin) in [
        ("t.geojson", "{\"type\":\"FeatureCollection\""),
        ("t.json", "{\"videos\":[{"),
        ("t.txt", "1,1,"),
    ] {
        assert_eq!(run(&folder, &["-q", "-o", name]).code, Some(0), "{name}");
        assert!(read(&folder, name).starts_with(begin), "{name}");
    }
    assert_eq!(run(&folder, &["-q", "-o", "t.zip"]).code, Some(0));
    assert!(
        std::fs::read(folder.path("t.zip"))
            .unwrap()
            .starts_with(b"PK")
    );
    assert_eq!(
        run(&folder, &["-q", "-o", "res", "--as", "ctc"]).code,
        Some(0)
    );
    assert_eq!(read(&folder, "res/res_track.txt"), "1 0 2 0\n");
    assert!(folder.path("res/mask002.tif").exists());
    let answer = run(&folder, &["-q"]);
    assert_eq!(middles(&answer.out).len(), 3);
    assert_eq!(
        middles(&answer.out),
        middles(
            &folder
                .snake_reading(
                    &[
                        "track",
                        "-",
                        "-q",
                        "--from",
                        "circle:20,24,9",
                        "--start",
                        "exact"
                    ],
                    [disc(0), disc(1), disc(2)].concat()
                )
                .out
        )
    );
}

#[test]
fn a_frame_that_cannot_be_used_is_coasted_over_and_told() {
    let folder = frames(7);
    folder.write("in/f3.pgm", b"P5\n80 48\n255\n");
    let answer = run(
        &folder,
        &[
            "-o",
            "t.csv",
            "--measure",
            "m.csv",
            "--overlay",
            "o.png",
            "--json",
        ],
    );
    assert_eq!(answer.code, Some(1), "{answer:?}");
    assert!(
        answer
            .err
            .contains("frame 3, f3.pgm: the picture cannot be decoded"),
        "{answer:?}"
    );
    let states: Vec<String> = read(&folder, "m.csv")
        .lines()
        .skip(1)
        .map(|line| line.split(',').nth(4).unwrap().to_owned())
        .collect();
    assert_eq!(states[3], "coasting");
    assert!(
        states
            .iter()
            .enumerate()
            .all(|(at, state)| at == 3 || state == "tracked"),
        "{states:?}"
    );
    let json: serde_json::Value = serde_json::from_str(&answer.out).unwrap();
    assert_eq!(json["broken_frames"], serde_json::json!(["f3.pgm"]));
    let last = middles(&read(&folder, "t.csv"))[6];
    assert!((last.1 - 32.0).abs() < 0.5, "{last:?}");
    // a frame of another size is one of them, and a number that is missing is told
    folder.write("in/f3.pgm", b"P5\n1 1\n255\n\x00");
    std::fs::remove_file(folder.path("in/f5.pgm")).unwrap();
    let answer = run(&folder, &["-o", "t.csv"]);
    assert_eq!(answer.code, Some(1));
    assert!(
        answer
            .err
            .contains("has 1×1 pixels and the first frame 80×48"),
        "{answer:?}"
    );
    assert!(
        answer.err.contains("missing in the sequence: 5"),
        "{answer:?}"
    );
}

#[test]
fn an_outline_that_was_mended_by_hand_is_gone_on_from() {
    let folder = frames(6);
    let mut rows = String::from("frame,id,x,y\n");
    for k in 0..40 {
        let angle = f64::from(k) * std::f64::consts::TAU / 40.0;
        rows.push_str(&format!(
            "3,1,{},{}\n",
            26.0 + 9.0 * angle.cos(),
            24.0 + 9.0 * angle.sin()
        ));
    }
    folder.write("mend.csv", rows);
    let answer = run(
        &folder,
        &[
            "-o",
            "t.csv",
            "--mend",
            "mend.csv",
            "--measure",
            "m.csv",
            "--events",
            "e.csv",
        ],
    );
    assert_eq!(answer.code, Some(0), "{answer:?}");
    assert!(
        answer.err.contains("frame 3: object 1 mended"),
        "{answer:?}"
    );
    let count = read(&folder, "t.csv")
        .lines()
        .filter(|line| line.starts_with("3,"))
        .count();
    assert_eq!(count, 40);
    assert!(
        read(&folder, "m.csv")
            .lines()
            .nth(4)
            .unwrap()
            .contains(",given,")
    );
    assert!(read(&folder, "e.csv").contains("\n3,1,mended,"));
    folder.write("mend.csv", "frame,id,x,y\n1,7,1,1\n1,7,5,1\n1,7,5,5\n");
    let answer = run(&folder, &["-o", "t2.csv", "--mend", "mend.csv"]);
    assert_eq!(answer.code, Some(2));
    assert!(
        answer
            .err
            .contains("--mend: frame 1, object 7: no such object"),
        "{answer:?}"
    );
}
