//! `snake eval` on sequences that are made here, with scores known by hand.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test: a broken set-up should stop it"
)]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::Folder;
use crate::common::discs::{columns, words};

const SIDE: usize = 80;

/// A picture and a mask of a disc.
fn disc([x, y]: [f64; 2], radius: f64) -> [Vec<u8>; 2] {
    let head = format!("P5 {SIDE} {SIDE} 255\n").into_bytes();
    let far = |at: usize| radius - ((at % SIDE) as f64 - x).hypot((at / SIDE) as f64 - y);
    let level = |at: usize| (60.0 + 140.0 * (far(at) + 0.5).clamp(0.0, 1.0)).round() as u8;
    let mask = |at: usize| if far(at) >= 0.0 { 255 } else { 0 };
    let all = 0..SIDE * SIDE;
    [
        head.iter().copied().chain(all.clone().map(level)).collect(),
        head.iter().copied().chain(all.map(mask)).collect(),
    ]
}

/// A sequence of six frames in which a disc moves by two pixels a frame, in the folder `set`.
fn moving() -> Folder {
    let folder = Folder::new();
    std::fs::create_dir_all(folder.path("set/a")).unwrap();
    let mut manifest = String::from("sequence,frame,file,mask\n");
    for t in 0..6 {
        let [picture, mask] = disc([28.0 + 2.0 * f64::from(t), 40.0], 14.0);
        folder.write(&format!("set/a/{t}.pgm"), picture);
        folder.write(&format!("set/a/{t}_mask.pgm"), mask);
        manifest += &format!("a,{t},a/{t}.pgm,a/{t}_mask.pgm\n");
    }
    folder.write("set/manifest.csv", manifest);
    let point = |k: i32| {
        let (sin, cos) = (f64::from(k) * 0.157).sin_cos();
        format!("{} {}", 28.5 + 15.0 * cos, 40.0 + 15.0 * sin)
    };
    let points: Vec<String> = (0..40).map(point).collect();
    let inits = format!(
        "stem,quality,points\na,near,{0}\na,far,{0}\n",
        points.join(";")
    );
    folder.write("set/inits.csv", inits);
    folder
}

#[test]
fn a_disc_is_followed_from_near_and_from_the_truth() {
    let folder = moving();
    let answer = folder.snake(&["eval", "set", "--each", "each.csv"]);
    assert_eq!(
        (answer.code, answer.err.as_str()),
        (Some(0), ""),
        "{answer:?}"
    );
    let rows = words(&answer.out);
    let names: Vec<[&str; 3]> = rows.iter().map(|row| [row[0], row[1], row[2]]).collect();
    let want = [
        ["a", "near", "5"],
        ["a", "true", "5"],
        ["all", "near", "1"],
        ["all", "true", "1"],
    ];
    assert_eq!(names, want, "{answer:?}");
    for row in &rows {
        let iou: f64 = row[3].parse().unwrap();
        // a start a pixel outside lies on the blurred edge, and is kept as drawn
        let least = if row[1] == "near" { 0.87 } else { 0.95 };
        assert!(iou > least && iou <= 1.0, "{answer:?}");
        assert_eq!((row[9], row[10]), ("0.000", "0.000"));
    }
    let each = std::fs::read_to_string(folder.path("each.csv")).unwrap();
    let frames = columns(&each, &["start", "frame", "iou", "sure"]);
    assert_eq!(frames.len(), 12);
    assert_eq!(
        (frames[11][0].as_str(), frames[11][1].as_str()),
        ("true", "5")
    );
    // the mean is that of the frames after the first
    let mean: f64 = frames[7..]
        .iter()
        .map(|row| row[2].parse::<f64>().unwrap())
        .sum::<f64>()
        / 5.0;
    assert_eq!(rows[1][3], format!("{mean:.4}"));
    // one of the starts; and as before, the fit on the first frame alone
    let answer = folder.snake(&["eval", "set", "--quality", "far", "--json"]);
    assert!(
        answer.out.contains("\"start\":\"far\"") && !answer.out.contains("near"),
        "{answer:?}"
    );
    let answer = folder.snake(&["eval", "set", "--first-frames"]);
    assert_eq!(words(&answer.out)[0][..2], ["near", "1"], "{answer:?}");
}

#[test]
fn outlines_from_a_table_are_scored_by_hand() {
    let folder = Folder::new();
    std::fs::create_dir_all(folder.path("set")).unwrap();
    let mut manifest = String::from("sequence,frame,file,mask\n");
    let mut found = String::from("frame,id,x,y\n");
    for t in 0..4 {
        // a square of 10 pixels; found is one that is shifted by 0, 0, 5 pixels, and then none
        let inside = |at: usize| (10..20).contains(&(at % 40)) && (10..20).contains(&(at / 40));
        let mask = (0..1600).map(|at| if inside(at) { 255 } else { 0 });
        let mask: Vec<u8> = b"P5 40 40 255\n".iter().copied().chain(mask).collect();
        folder.write(&format!("set/{t}_mask.pgm"), mask);
        manifest += &format!("q,{t},{t}.pgm,{t}_mask.pgm\n");
        let x = if t == 2 { 14.5 } else { 9.5 };
        if t < 3 {
            for (dx, dy) in [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)] {
                found += &format!("{t},1,{},{}\n", x + dx, 9.5 + dy);
            }
        }
    }
    folder.write("set/manifest.csv", manifest);
    folder.write("found.csv", &found);
    // no picture and no start is needed
    let answer = folder.snake(&["eval", "set", "--found", "found.csv"]);
    assert_eq!(
        (answer.code, answer.err.as_str()),
        (Some(0), ""),
        "{answer:?}"
    );
    let row = &words(&answer.out)[0];
    // 1, 1/3 and 0; without the last 1 and 1/3, and of the boundaries 1 and what is within a pixel
    let mean = 4.0 / 9.0;
    assert_eq!(
        row[..6],
        ["q", "found", "3", &format!("{mean:.4}"), "0.0000", "0.0000"],
        "{answer:?}"
    );
    assert_eq!(
        (row[9], row[10], row[11]),
        ("0.333", "0.333", "-"),
        "{answer:?}"
    );
    // a frame more than there are
    folder.write("found.csv", found + "4,1,0,0\n4,1,5,0\n4,1,0,5\n");
    let answer = folder.snake(&["eval", "set", "--found", "found.csv"]);
    assert_eq!(answer.code, Some(2), "{answer:?}");
    assert!(
        answer
            .err
            .contains("has a frame 4, but frames must be 0 to 3"),
        "{answer:?}"
    );
}

/// A picture of labels of one row.
fn labels(text: &str) -> Vec<u8> {
    let head = format!("P5 {} 1 255\n", text.len()).into_bytes();
    head.into_iter()
        .chain(text.bytes().map(|c| c - b'0'))
        .collect()
}

#[test]
fn folders_of_the_cell_tracking_challenge_are_scored_by_hand() {
    let folder = Folder::new();
    for name in ["set/01_GT/TRA", "set/01_GT/SEG", "results/01_RES"] {
        std::fs::create_dir_all(folder.path(name)).unwrap();
    }
    // an object divides; one of the children is not found
    let truth = ["1111000", "2200330", "2200330"];
    let found = ["5555000", "5500000", "5500000"];
    for (t, (truth, found)) in truth.iter().zip(found).enumerate() {
        folder.write(&format!("set/01_GT/TRA/man_track00{t}.tif"), labels(truth));
        folder.write(&format!("results/01_RES/mask00{t}.tif"), labels(found));
    }
    // SEG is taken where there is one: of one pixel more, 2 of 3
    folder.write("set/01_GT/SEG/man_seg001.tif", labels("2220000"));
    folder.write("set/01_GT/TRA/man_track.txt", "1 0 0 0\n2 1 2 1\n3 1 2 1\n");
    folder.write("results/01_RES/res_track.txt", "5 0 2 0\n");
    let answer = folder.snake(&["eval", "set", "--found", "results", "--json"]);
    assert_eq!(
        (answer.code, answer.err.as_str()),
        (Some(0), ""),
        "{answer:?}"
    );
    let said: serde_json::Value = serde_json::from_str(&answer.out).unwrap();
    let row = &said["rows"][0];
    assert_eq!(row["sequence"], "01");
    assert!(
        (row["seg"].as_f64().unwrap() - 2.0 / 3.0).abs() < 1e-12,
        "{row}"
    );
    // five nodes and four edges: two nodes missing, and three edges; one edge is one within a track
    let graph = &row["graph"];
    for (name, count) in [
        ("nodes", 5),
        ("edges", 4),
        ("missed", 2),
        ("added", 2),
        ("changed", 1),
    ] {
        assert_eq!(graph[name], count, "{name}: {row}");
    }
    let tra = 1.0 - (20.0 + 3.0 + 1.0) / (50.0 + 6.0);
    assert!((row["tra"].as_f64().unwrap() - tra).abs() < 1e-12, "{row}");
    assert_eq!(row["divisions"]["missed"], 1);
    // a table that does not fit
    folder.write("results/01_RES/res_track.txt", "5 0 1 0\n");
    let answer = folder.snake(&["eval", "set", "--found", "results"]);
    assert_eq!(answer.code, Some(2));
    let message = "the found object 5 is in the frames 0 to 2, but the table has 0 to 1";
    assert!(answer.err.contains(message), "{answer:?}");
    // without pictures nothing can be followed
    let answer = folder.snake(&["eval", "set"]);
    assert_eq!(answer.code, Some(2));
    assert!(answer.err.contains("--found is needed"), "{answer:?}");
}

#[test]
fn what_does_not_fit_is_refused_with_what_is_needed() {
    let folder = moving();
    for (flags, message) in [
        (&["--sheet", "s.png"][..], "sequences cannot have it"),
        (&["--turn", "90"], "sequences cannot have it"),
        (&["--found", "none.csv"], "none.csv is not there"),
        (
            &["--quality", "best"],
            "no start has the quality \"best\"; there are: near, far, true",
        ),
        (&["--inits", "none.csv"], "none.csv"),
    ] {
        let answer = folder.snake(&[&["eval", "set"], flags].concat());
        assert_eq!(answer.code, Some(2), "{answer:?}");
        assert!(answer.err.contains(message), "{answer:?}");
    }
    let text = std::fs::read_to_string(folder.path("set/manifest.csv")).unwrap();
    folder.write("set/manifest.csv", text.replace("a,3,", "a,9,"));
    let answer = folder.snake(&["eval", "set"]);
    assert!(answer.err.contains("frame 3 of 6 is missing"), "{answer:?}");
    folder.write("set/manifest.csv", text.replace("a,3,", "a,2,"));
    let answer = folder.snake(&["eval", "set"]);
    assert!(
        answer.err.contains("frame 2 of a is there twice"),
        "{answer:?}"
    );
    folder.write("set/manifest.csv", &text);
    folder.write("set/a/3_mask.pgm", "P5 2 2 255\n....");
    let answer = folder.snake(&["eval", "set"]);
    assert_eq!(answer.code, Some(2));
    assert!(answer.err.contains("sizes must be equal"), "{answer:?}");
}
