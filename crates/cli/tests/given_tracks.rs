//! `snake track`: where objects are given, in any frame, by seeds, by hand, and frames that are missing.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use std::collections::BTreeMap;

use crate::common::Folder;
use crate::common::moving::{disc, frames};

/// Bright discs of radius 9 on a dark ground.
fn discs(size: [u32; 2], centers: &[[f64; 2]]) -> Vec<u8> {
    let mut bytes = format!("P5\n{} {}\n255\n", size[0], size[1]).into_bytes();
    for y in 0..size[1] {
        for x in 0..size[0] {
            let inside = |c: &[f64; 2]| 9.5 - (f64::from(x) - c[0]).hypot(f64::from(y) - c[1]);
            let most = centers.iter().map(inside).fold(0.0, f64::max);
            bytes.push((60.0 + 120.0 * most.min(1.0)).round() as u8);
        }
    }
    bytes
}

/// The means of the points of each object in each frame of a table.
fn middles(folder: &Folder, name: &str) -> BTreeMap<(usize, usize), [f64; 2]> {
    let mut sums: BTreeMap<(usize, usize), [f64; 3]> = BTreeMap::new();
    let text = std::fs::read_to_string(folder.path(name)).unwrap();
    for line in text.lines().skip(1) {
        let n: Vec<f64> = line.split(',').map(|word| word.parse().unwrap()).collect();
        let sum = sums.entry((n[0] as usize, n[1] as usize)).or_default();
        *sum = [sum[0] + n[2], sum[1] + n[3], sum[2] + 1.0];
    }
    let mean = |(at, sum): ((usize, usize), [f64; 3])| (at, [sum[0] / sum[2], sum[1] / sum[2]]);
    sums.into_iter().map(mean).collect()
}

fn circle(center: [f64; 2], frame: usize) -> String {
    let mut rows = String::new();
    for k in 0..60 {
        let angle = f64::from(k) * std::f64::consts::TAU / 60.0;
        let (x, y) = (center[0] + 9.0 * angle.cos(), center[1] + 9.0 * angle.sin());
        rows.push_str(&format!("{frame},1,{x},{y}\n"));
    }
    rows
}

#[test]
fn seeds_are_found_in_the_first_frame_and_followed() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("in")).unwrap();
    for t in 0..4 {
        let x = 2.0 * f64::from(t);
        let bytes = discs([120, 60], &[[25.0 + x, 20.0], [90.0 - x, 40.0]]);
        folder.write(&format!("in/f{t}.pgm"), bytes);
    }
    let answer = folder.snake(&["track", "in", "--seeds", "auto", "-o", "t.csv"]);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    assert!(
        answer.err.contains("2 objects found to follow"),
        "{answer:?}"
    );
    let found = middles(&folder, "t.csv");
    assert_eq!(found.len(), 8);
    for t in 0..4 {
        let x = 2.0 * t as f64;
        for center in [[25.0 + x, 20.0], [90.0 - x, 40.0]] {
            let off = |id| {
                let [x, y]: [f64; 2] = found[&(t, id)];
                (x - center[0]).hypot(y - center[1])
            };
            assert!(f64::min(off(1), off(2)) < 0.5, "{t}: {found:?}");
        }
    }
    // several starts are several objects
    let from = ["--from", "circle:25,20,9", "--from", "circle:90,40,9"];
    let answer = folder.snake(&[&["track", "in", "-o", "t.csv"][..], &from].concat());
    assert_eq!((answer.code, middles(&folder, "t.csv").len()), (Some(0), 8));
    folder.refused(
        &[
            "track",
            "in",
            "-q",
            "--seeds",
            "auto",
            "--from",
            "click:25,20",
        ],
        &["--seeds", "--from"],
    );
    let answer = folder.snake(&["track", "in", "-o", "a.csv"]);
    assert!(answer.code == Some(2) && answer.err.contains("--from <START>"));
    std::fs::create_dir(folder.path("empty")).unwrap();
    folder.write("empty/f0.pgm", discs([120, 60], &[]));
    folder.refused(
        &["track", "empty", "-q", "--seeds", "auto", "-o", "a.csv"],
        &["--seeds: no object is found"],
    );
}

#[test]
fn a_start_in_any_frame_is_followed_back_and_onwards() {
    let folder = frames(8);
    let start = ["--from", "circle:28,24,9", "--start", "exact"];
    let run = |more: &[&str]| folder.snake(&[&["track", "in"][..], &start, more].concat());
    let all = [
        "-o",
        "t.csv",
        "--events",
        "e.csv",
        "--measure",
        "m.csv",
        "--kymograph",
        "k.csv",
    ];
    let answer = run(&[&["--at", "4"][..], &all].concat());
    assert_eq!(answer.code, Some(0), "{answer:?}");
    let found = middles(&folder, "t.csv");
    assert_eq!(found.len(), 8);
    for ((frame, _), [x, y]) in &found {
        let off = (x - 20.0 - 2.0 * *frame as f64).hypot(y - 24.0);
        assert!(off < 0.4, "{frame}: {x} {y}");
    }
    let read = |name: &str| std::fs::read_to_string(folder.path(name)).unwrap();
    assert_eq!(
        read("e.csv"),
        "frame,id,event,others,confidence\n0,1,begun,,1\n"
    );
    // velocities are in time, also of frames that were followed back
    let speeds: Vec<f64> = read("m.csv")
        .lines()
        .skip(2)
        .map(|line| line.split(',').nth(10).unwrap().parse().unwrap())
        .collect();
    assert!(
        speeds[..2]
            .iter()
            .chain(&speeds[5..])
            .all(|v| (v - 2.0).abs() < 0.6),
        "{speeds:?}"
    );
    let before = (read("t.csv"), read("k.csv"));
    // the same by its name, and gone on with
    assert_eq!(
        run(&[&["--at", "f4.pgm", "--resume"][..], &all].concat()).code,
        Some(0)
    );
    assert!((read("t.csv"), read("k.csv")) == before);
    // a stream is only followed onwards, and its frames keep their numbers
    let bytes: Vec<u8> = (0..8).flat_map(disc).collect();
    let more = ["track", "-", "--at", "4", "-o", "s.csv"];
    let answer = folder.snake_reading(&[&more[..], &start].concat(), bytes);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    assert!(answer.err.contains("cannot be read back"), "{answer:?}");
    let stream = middles(&folder, "s.csv");
    assert_eq!(
        stream.keys().map(|at| at.0).collect::<Vec<_>>(),
        [4, 5, 6, 7]
    );
    for (text, says) in [
        (
            "8",
            "--at: must be a number from 0 to 7 or the name of a file of the sequence, got 8",
        ),
        ("f9.pgm", "got f9.pgm"),
    ] {
        let more = ["track", "in", "-q", "--at", text, "-o", "a.csv"];
        folder.refused(&[&more[..], &start].concat(), &[says]);
    }
}

#[test]
fn outlines_by_hand_mend_what_was_wrong_before_them() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("in")).unwrap();
    // the disc is away for three frames and comes back elsewhere; meanwhile one like it comes and stays
    let center = |t: usize| [24.0 + 4.0 * t as f64, 25.0];
    for t in 0..16 {
        let still = [70.0, 80.0];
        let both = [still, center(t)];
        let shown = match t {
            0..5 => &both[1..],
            5..8 => &both[..1],
            _ => &both,
        };
        folder.write(&format!("in/f{t:02}.pgm"), discs([130, 110], shown));
    }
    let off = |name: &str, t: usize| {
        let found = middles(&folder, name);
        found.get(&(t, 1)).map_or(f64::INFINITY, |[x, y]| {
            (x - center(t)[0]).hypot(y - center(t)[1])
        })
    };
    let start = ["--from", "circle:24,25,9", "--start", "exact"];
    let run = |more: &[&str]| folder.snake(&[&["track", "in"][..], &start, more].concat());
    // the wrong one is taken for it, from frame 6 on
    let answer = run(&["-o", "w.csv"]);
    assert!(
        off("w.csv", 8) > 20.0 && off("w.csv", 15) > 20.0,
        "{answer:?}"
    );
    let rows = String::from("frame,id,x,y\n") + &circle(center(13), 13);
    folder.write("mend.csv", rows);
    let all = [
        "--mend",
        "mend.csv",
        "-o",
        "t.csv",
        "--overlay",
        "o.gif",
        "--events",
        "e.csv",
    ];
    let answer = run(&all);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    for t in (0..5).chain(8..16) {
        assert!(off("t.csv", t) < 1.0, "{t}: {} {answer:?}", off("t.csv", t));
    }
    let given = std::fs::read_to_string(folder.path("t.csv")).unwrap();
    assert!(given.contains(&circle(center(13), 13)), "it is a fact");
    let bytes = |name: &str| std::fs::read(folder.path(name)).unwrap();
    let before = ["t.csv", "o.gif", "e.csv"].map(bytes);
    // the same bytes where it is gone on with, and for one thread
    let part: String = given.split_inclusive('\n').take(400).collect();
    folder.write("t.csv", part);
    assert_eq!(
        run(&[&all[..], &["--resume", "-j", "1"]].concat()).code,
        Some(0)
    );
    assert!(["t.csv", "o.gif", "e.csv"].map(bytes) == before);
    // from a start in the last frame, what is given before it holds as well
    let rows = String::from("frame,id,x,y\n") + &circle(center(1), 1) + &circle(center(9), 9);
    folder.write("mend.csv", rows);
    let start = [
        "--from",
        "circle:84,25,9",
        "--start",
        "exact",
        "--at",
        "f15.pgm",
    ];
    let more = ["track", "in", "--mend", "mend.csv", "-o", "b.csv"];
    let answer = folder.snake(&[&more[..], &start].concat());
    assert_eq!(answer.code, Some(0), "{answer:?}");
    for t in (0..5).chain(8..16) {
        assert!(off("b.csv", t) < 1.0, "{t}: {} {answer:?}", off("b.csv", t));
    }
}

#[test]
fn objects_go_on_by_the_frames_that_are_missing() {
    let center = |t: usize| [20.0 + 7.0 * t as f64, 30.0];
    // another like it comes to where the disc would be if no frame were missing
    let end = |name: &str| {
        let folder = Folder::new();
        std::fs::create_dir(folder.path("in")).unwrap();
        for t in 0..4 {
            folder.write(&format!("in/f{t:02}.pgm"), discs([180, 60], &[center(t)]));
        }
        folder.write(name, discs([180, 60], &[center(7), center(4)]));
        let start = ["--from", "circle:20,30,9", "--start", "exact"];
        let answer = folder.snake(&[&["track", "in", "-o", "t.csv"][..], &start].concat());
        let found = middles(&folder, "t.csv");
        let frames: Vec<usize> = found.keys().map(|at| at.0).collect();
        assert_eq!(frames, [0, 1, 2, 3, 4], "{answer:?}");
        (found[&(4, 1)], answer.err)
    };
    let off = |at: [f64; 2], t| (at[0] - center(t)[0]).hypot(at[1] - center(t)[1]);
    let (at, said) = end("in/f07.pgm");
    assert!(
        said.contains("3 frames missing before f07.pgm: objects go on by as many"),
        "{said}"
    );
    assert!(off(at, 7) < 0.5, "{at:?} {said}");
    let (at, said) = end("in/f04.pgm");
    assert!(off(at, 4) < 0.5 && !said.contains("missing"), "{at:?}");
    // of many it cannot be said where the object has gone
    let (_, said) = end("in/f10.pgm");
    assert!(
        said.contains("4 to 9: 6 frames missing, more than 5"),
        "{said}"
    );
}
