//! `snake fit` on how an outline came about and how firmly it is held: animations, records, plucked outlines.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::fits::{CENTER, RADIUS, SIZE, START, blank, faded, json, near, text};
use crate::common::{Folder, disc};
use serde_json::Value;

const PICTURE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/tests/data/objects/nucleus_442c4eb0.png"
);
const MASK: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/tests/data/objects/nucleus_442c4eb0_mask.png"
);

#[test]
fn how_an_outline_was_found_is_shown_and_recorded() {
    let folder = Folder::new();
    folder.write("d.pgm", disc(SIZE, CENTER, RADIUS));
    let frames = |name: &str| {
        let bytes = std::fs::read(folder.path(name)).unwrap();
        assert!(bytes.starts_with(b"GIF89a") && bytes.ends_with(b";"));
        bytes
            .windows(3)
            .filter(|three| *three == [0x21, 0xF9, 4])
            .count()
    };
    let searched = folder.snake(&[
        "fit",
        PICTURE,
        "--from",
        MASK,
        "-o",
        "s.csv",
        "--animation",
        "s.gif",
        "--explain",
    ]);
    assert!(searched.code.unwrap() < 2, "{}", searched.err);
    // the start, each curve, the one taken, the outline
    let curves = searched.err.matches("taken\n").count();
    assert_eq!(frames("s.gif"), 3 + curves, "{}", searched.err);
    let moved = folder.snake(&[
        "fit",
        "d.pgm",
        "--from",
        START,
        "--method",
        "motion",
        "-o",
        "m.csv",
        "--animation",
        "m.gif",
        "--record",
        "m.jsonl",
    ]);
    assert_eq!(moved.code, Some(0), "{}", moved.err);
    let record = text(&folder, "m.jsonl");
    let lines: Vec<Value> = record.lines().map(json).collect();
    assert_eq!(
        (&lines[0]["snake_record"], &lines[0]["closed"]),
        (&Value::from(1), &Value::from(true))
    );
    let (first, last) = (&lines[1], &lines[lines.len() - 2]);
    assert_eq!(first["step"], 0);
    assert_eq!(lines[lines.len() - 1]["outcome"], "settled");
    assert_eq!(lines[lines.len() - 1]["step"], last["step"]);
    assert!(
        lines[1..lines.len() - 1]
            .windows(2)
            .all(|two| two[0]["t"].as_f64() < two[1]["t"].as_f64())
    );
    assert!(frames("m.gif") > 10);
    // the end is the outline, the beginning the start
    let table = text(&folder, "m.csv");
    let end = last["x"].as_array().unwrap();
    assert_eq!(table.lines().count(), 2 + end.len());
    for (line, node) in table.lines().skip(2).zip(end) {
        let (x, y) = line.split_once(',').unwrap();
        assert!(near(&node[0], x.parse().unwrap()) && near(&node[1], y.parse().unwrap()));
    }
    let begin = first["x"][0].as_array().unwrap();
    assert!((begin[0].as_f64().unwrap() - 76.0).abs() < 1e-6);
    // watched or not, it is the same outline
    let unwatched = folder.snake(&["fit", "d.pgm", "--from", START, "--method", "motion"]);
    assert_eq!(unwatched.out, text(&folder, "m.csv"));
    let other = folder.snake(&[
        "fit", "d.pgm", "--from", START, "--method", "motion", "-o", "t.csv", "--record", "r.csv",
    ]);
    assert_eq!(other.code, Some(0));
    assert!(text(&folder, "r.csv").starts_with("# record 1, closed, "));
    // of thousands of steps every so many, and the end
    let long = [
        "fit", "d.pgm", "--from", START, "--dt", "0.004", "-o", "l.csv",
    ];
    let slow = folder.snake(&[&long[..], &["--record", "l.jsonl"]].concat());
    assert_eq!(slow.code, Some(0), "{}", slow.err);
    let record = text(&folder, "l.jsonl");
    let steps: Vec<u64> = record
        .lines()
        .skip(1)
        .map(|line| json(line)["step"].as_u64().unwrap())
        .collect();
    let (ended, last) = (steps[steps.len() - 1], steps[steps.len() - 2]);
    assert!(
        ended > 1000 && ended == last && steps.len() < 1004,
        "{ended}"
    );
    let every = steps[1] - steps[0];
    let even = |two: &[u64]| two[1] - two[0] == every;
    assert!(every > 1 && steps[..steps.len() - 2].windows(2).all(even));
    assert!(!last.is_multiple_of(every), "{last}");
    // in a folder too
    let all = folder.snake(&[
        "fit",
        "d.pgm",
        "--from",
        START,
        "--out-dir",
        "out",
        "--as",
        "csv,animation",
    ]);
    assert_eq!(all.code, Some(0), "{}", all.err);
    assert!(frames("out/d.gif") >= 4);
    folder.refused(
        &["fit", "d.pgm", "--from", START, "--record", "x.jsonl"],
        &["--record: ", "no motion", "--method motion", "--animation"],
    );
    folder.refused(
        &["fit", "d.pgm", "--from", START, "--animation", "x.png"],
        &["must end in .gif"],
    );
    folder.refused(
        &["fit", "d.pgm", "--seeds", "auto", "--animation", "x.gif"],
        &["--animation"],
    );
    folder.refused(
        &[
            "fit",
            "d.pgm",
            "--seeds",
            "auto",
            "--out-dir",
            "out",
            "--as",
            "animation",
        ],
        &["--as: ", "--seeds"],
    );
    folder.refused(
        &[
            "fit",
            "d.pgm",
            "--from",
            START,
            "--animation",
            "a.gif",
            "--out",
            "a.gif",
        ],
        &["a.gif"],
    );
}

#[test]
fn a_plucked_outline_is_firm_where_it_has_an_edge() {
    let folder = Folder::new();
    folder.write("sharp.pgm", disc(SIZE, CENTER, RADIUS));
    folder.write("faded.pgm", faded());
    folder.write("blank.pgm", blank());
    let circle = format!("circle:{},{},{RADIUS}", CENTER[0], CENTER[1]);
    let told = |picture: &str, more: &[&str]| {
        let mut args = vec![
            "fit",
            picture,
            "--from",
            &circle,
            "--json",
            "-o",
            "o.geojson",
        ];
        // where there is no edge it is to stay about the start
        for rule in ["unsure=0", "pure=1", "region=0", "tether=50", "around=1"] {
            args.extend(["--set", rule]);
        }
        let answer = folder.snake(&[&args[..], more].concat());
        assert!(answer.code.unwrap() < 2, "{answer:?}");
        (json(&answer.out)["pluck"].clone(), answer.err)
    };
    let (sharp, said) = told("sharp.pgm", &["--pluck", "--explain"]);
    assert_eq!(
        (sharp["kick"].as_f64(), sharp["firm"].as_f64()),
        (Some(2.0), Some(1.0))
    );
    assert!(
        said.contains("plucked by 2 pixels: 100 % firm") && said.contains("stretch 1 at "),
        "{said}"
    );
    assert!(text(&folder, "o.geojson").contains("\"firm\":1"));
    let (blank, _) = told("blank.pgm", &["--pluck=3"]);
    assert_eq!(
        (blank["kick"].as_f64(), blank["firm"].as_f64()),
        (Some(3.0), Some(0.0))
    );
    assert_eq!(told("sharp.pgm", &[]).0, Value::Null);
    let (faded, _) = told("faded.pgm", &["--pluck", "--overlay", "seen.png"]);
    for stretch in faded["stretches"].as_array().unwrap() {
        let (x, firmness) = (
            stretch["x"].as_f64().unwrap(),
            stretch["firmness"].as_f64().unwrap(),
        );
        if x > 60.0 {
            assert!(firmness > 0.8, "{stretch}");
        }
        if x < 26.0 {
            assert!(firmness < 0.2, "{stretch}");
        }
    }
    // blue where it is firm, and not blue where it is loose
    let seen = io::Picture::load(&folder.path("seen.png")).unwrap();
    let zoom = seen.size().0 as f64 / SIZE as f64;
    assert!(zoom > 4.0);
    let blue = |p: &Value| {
        let place = |name: &str| (zoom * p[name].as_f64().unwrap()) as usize;
        (0..9).any(|k| {
            let [r, _, b] = seen.color_at(place("x") - 4 + k, place("y"));
            b > 150.0 && r < 60.0
        })
    };
    for stretch in faded["stretches"].as_array().unwrap() {
        let x = stretch["x"].as_f64().unwrap();
        if !(30.0..=60.0).contains(&x) {
            assert_eq!(blue(stretch), x > 60.0, "{stretch}");
        }
    }
    for (kick, says) in [
        ("0", "--pluck: must be"),
        ("-1", "--pluck: must be"),
        ("30", "three sigma"),
    ] {
        let flag = format!("--pluck={kick}");
        folder.refused(
            &["fit", "sharp.pgm", "--from", START, &flag, "-o", "r.csv"],
            &[says],
        );
    }
    // each of many objects
    folder.write("in.csv", format!("x,y\n{},{}\n", CENTER[0], CENTER[1]));
    let many = folder.snake(&[
        "fit",
        "sharp.pgm",
        "--seeds",
        "in.csv",
        "--pluck",
        "--json",
        "-o",
        "m.csv",
    ]);
    assert_eq!(
        json(&many.out)["outlines"][0]["pluck"]["firm"],
        1.0,
        "{}",
        many.err
    );
}
