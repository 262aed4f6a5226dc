//! `snake eval` on small data sets that are made here, with scores known by hand.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test: a broken set-up should stop it"
)]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::float_cmp,
    reason = "a test: small whole numbers"
)]

use crate::common::discs::{columns, set, start_iou, words};

#[test]
fn the_table_has_the_scores_that_are_known_by_hand() {
    let folder = set();
    let before = folder.listing();
    let answer = folder.snake(&["eval", "set", "--each", "each.csv"]);
    assert_eq!(
        (answer.code, answer.err.as_str()),
        (Some(0), ""),
        "{answer:?}"
    );
    let rows = words(&answer.out);
    let names: Vec<&str> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(names, ["near", "wide", "all"]);
    let mean = |more: f64| (0..3).map(|k| start_iou(k, more)).sum::<f64>() / 3.0;
    let starts = [mean(1.0), mean(3.0), 0.5 * (mean(1.0) + mean(3.0))];
    for (row, (number, start)) in rows.iter().zip(["3", "3", "6"].into_iter().zip(starts)) {
        assert_eq!(
            (row[1], row[2]),
            (number, format!("{start:.4}").as_str()),
            "{answer:?}"
        );
        // an edge of full contrast: the outline is on it to a fraction of a pixel
        let found: f64 = row[3].parse().unwrap();
        assert!(found > 0.95 && found <= 1.0, "{answer:?}");
        let (distance, f): (f64, f64) = (row[5].parse().unwrap(), row[7].parse().unwrap());
        assert!(distance < 0.7 && f > 0.999, "{answer:?}");
        // worse, unsure, refused
        assert_eq!(row[8..11], ["0", "0", "0"], "{answer:?}");
    }
    let each = std::fs::read_to_string(folder.path("each.csv")).unwrap();
    let rows = columns(&each, &["stem", "quality", "start_iou", "outcome"]);
    assert_eq!(rows.len(), 6);
    assert_eq!(
        rows[3][..],
        ["d1", "wide", &format!("{:.6}", start_iou(1, 3.0)), "found"]
    );
    let after: Vec<_> = folder
        .listing()
        .into_iter()
        .filter(|(path, _)| !path.ends_with("each.csv"))
        .collect();
    assert_eq!(after, before);
}

#[test]
fn any_number_of_jobs_gives_the_same_and_json_says_what_the_table_says() {
    let folder = set();
    let scores = [
        "stem",
        "quality",
        "iou",
        "mean_distance",
        "hausdorff",
        "boundary_f",
        "outcome",
    ];
    let each = |jobs: &str| {
        let args = [
            "eval", "set", "--jobs", jobs, "--each", "each.csv", "--json",
        ];
        let answer = folder.snake(&args);
        assert_eq!(answer.code, Some(0), "{answer:?}");
        let told: serde_json::Value = serde_json::from_str(&answer.out).unwrap();
        let text = std::fs::read_to_string(folder.path("each.csv")).unwrap();
        (columns(&text, &scores), told)
    };
    let (one, told) = each("1");
    let (three, _) = each("3");
    assert_eq!(one, three);
    let iou: f64 = one
        .iter()
        .map(|row| row[2].parse::<f64>().unwrap())
        .sum::<f64>()
        / 6.0;
    let all = &told["rows"][2];
    assert!((all["iou"].as_f64().unwrap() - iou).abs() < 1e-6, "{told}");
    assert_eq!(
        (all["quality"].as_str(), told["good"].as_bool()),
        (Some("all"), Some(true))
    );
}

#[test]
fn what_is_broken_is_reported_and_left_out() {
    let folder = set();
    let read = |name: &str| std::fs::read_to_string(folder.path(name)).unwrap();
    folder.write(
        "set/manifest.csv",
        read("set/manifest.csv") + "gone.pgm,gone_mask.pgm,\nalone.pgm\n",
    );
    let more = "gone,near,,1 1;9 1;9 9\nnobody,near,,1 1;9 1;9 9\nd0,near,,1 1;9 one;9 9\nd0,near,,1 1;9 1\n\
                d1,near,,-90 -90;-80 -90;-85 -80\n";
    folder.write("set/inits.csv", read("set/inits.csv") + more);
    folder.write("set/d2_mask.pgm", "P5 2 2 255\nabcd");
    let answer = folder.snake(&["eval", "set", "--quality", "near"]);
    assert_eq!(answer.code, Some(1), "{answer:?}");
    for part in [
        "manifest.csv: line 6: a picture and its mask are needed",
        "inits.csv: line 9: no picture of the manifest is called \"nobody\"",
        "inits.csv: line 10: points must be pairs of numbers",
        "inits.csv: line 11: a polygon must have at least 3 points (or 1, for a click), got 2",
        "gone.pgm: ",
        "d2_mask.pgm: must have 96 × 96 pixels as its picture, got 2 × 2",
    ] {
        assert!(answer.err.contains(part), "{part}: {answer:?}");
    }
    assert_eq!(answer.err.lines().count(), 6, "{answer:?}");
    // two discs are left, and a start beside the picture that the fit refuses
    let row = &words(&answer.out)[0];
    assert_eq!((row[0], row[1], row[10]), ("near", "3", "1"), "{answer:?}");
    let mean = (start_iou(0, 1.0) + start_iou(1, 1.0)) / 3.0;
    assert_eq!(row[2], format!("{mean:.4}"), "{answer:?}");
    let found: f64 = row[3].parse().unwrap();
    assert!(found > 0.63 && found < 0.667, "counts as 0: {answer:?}");
}

#[test]
fn what_cannot_be_asked_for_is_refused() {
    let folder = set();
    for (args, says) in [
        (
            &["nowhere"][..],
            &["nowhere", "manifest.csv", "cannot be read"][..],
        ),
        (
            &["set", "--inits", "more.csv"],
            &["more.csv", "cannot be read"],
        ),
        (
            &["set", "--inits", "manifest.csv"],
            &["manifest.csv", "no column \"stem\""],
        ),
        (
            &["set", "--quality", "far"],
            &["--quality", "\"far\"", "near, wide"],
        ),
        (
            &["set", "--turn", "45"],
            &["--turn", "90, 180 or 270, got 45"],
        ),
        (
            &["set", "--darken", "1.5"],
            &["--darken", "at most 1, got 1.5"],
        ),
        (&["set", "--jobs", "0"], &["--jobs"]),
        (&["set", "--worst", "3"], &["--sheet"]),
        (
            &["set", "--worst", "0", "--sheet", "s.png"],
            &["--worst", "from 1 to", "got 0"],
        ),
        (
            &["set", "--each", "set/d0.pgm"],
            &["--each", "d0.pgm", "a file that is read"],
        ),
        (
            &[
                "set",
                "--sheet",
                "set/../set/d1.PNG",
                "--each",
                "set/d1.PNG",
            ],
            &["--sheet", "taken by --each"],
        ),
        (&["set", "--each", "-"], &["--each", "a file is needed"]),
        (
            &["synthetic", "--turn", "90"],
            &["--turn", "drawn pictures"],
        ),
        (
            &["synthetic", "--sheet", "s.png"],
            &["--sheet", "drawn pictures"],
        ),
        (&["synthetic", "--inits", "a.csv"], &["--inits", "a.csv"]),
        (
            &["synthetic", "--quality", "far"],
            &["--quality", "near, outside, inside"],
        ),
    ] {
        folder.refused(&[&["eval"], args].concat(), says);
    }
    folder.write("set/inits.csv", "stem,quality,points\n");
    folder.refused(&["eval", "set"], &["set", "nothing to score"]);
    folder.write("set/manifest.csv", "");
    folder.refused(&["eval", "set"], &["manifest.csv", "is empty"]);
}
