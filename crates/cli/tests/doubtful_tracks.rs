//! `snake track`: what is said of what cannot be known, before it is followed or as it comes.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::Folder;
use crate::common::moving::{START, disc, frames};

/// A frame as floats, with a patch that holds no numbers.
fn patched(frame: usize) -> Vec<u8> {
    let bytes = disc(frame);
    let levels = &bytes[bytes.len() - 80 * 48..];
    let mut out = b"Pf\n80 48\n-1.0\n".to_vec();
    for y in (0..48).rev() {
        for x in 0..80_usize {
            let hole = (x + 2).abs_diff(20 + 2 * frame) < 5 && y < 20;
            let level = f32::from(levels[y * 80 + x]) / 255.0;
            out.extend((if hole { f32::NAN } else { level }).to_le_bytes());
        }
    }
    out
}

#[test]
fn a_patch_without_numbers_in_one_frame_is_left_out_and_told() {
    let folder = frames(3);
    for frame in 3..9 {
        if frame == 5 {
            folder.write(&format!("in/f{frame}.pfm"), patched(frame));
        } else {
            folder.write(&format!("in/f{frame}.pgm"), disc(frame));
        }
    }
    let names: Vec<String> = (0..9)
        .map(|k| format!("in/f{k}.{}", if k == 5 { "pfm" } else { "pgm" }))
        .collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let args = [
        &["track"][..],
        &names,
        &START,
        &["-o", "t.csv", "--measure", "m.csv"],
    ]
    .concat();
    let answer = folder.snake(&args);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    assert!(
        answer
            .err
            .contains("frame 5, f5.pfm: 180 pixels are no numbers or left out"),
        "{answer:?}"
    );
    let table = std::fs::read_to_string(folder.path("t.csv")).unwrap();
    for frame in 0..9 {
        let mean = |column: usize| {
            let own = table
                .lines()
                .filter(|line| line.starts_with(&format!("{frame},")));
            let list: Vec<f64> = own
                .map(|line| line.split(',').nth(column).unwrap().parse().unwrap())
                .collect();
            list.iter().sum::<f64>() / list.len() as f64
        };
        let off = (mean(2) - 20.0 - 2.0 * f64::from(frame)).hypot(mean(3) - 24.0);
        assert!(off < 0.7, "{frame}: {off}");
    }
}

#[test]
fn a_number_that_no_object_has_is_refused_before_anything_is_followed() {
    let folder = frames(4);
    folder.write("mend.csv", "frame,id,x,y\n3,7,1,1\n3,7,5,1\n3,7,5,5\n");
    folder.refused(
        &[
            &["track", "in", "-q", "-o", "t.csv", "--mend", "mend.csv"][..],
            &START,
        ]
        .concat(),
        &["--mend: frame 3, object 7: no such object is followed; needed: 1"],
    );
}

#[test]
fn a_click_on_nothing_is_unsure() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("in")).unwrap();
    for frame in 0..3 {
        folder.write(
            &format!("in/f{frame}.pgm"),
            [&b"P5\n80 48\n255\n"[..], &[0; 80 * 48]].concat(),
        );
    }
    let args = [
        "track",
        "in",
        "--from",
        "click:40,20",
        "-o",
        "t.csv",
        "--events",
        "e.csv",
    ];
    let answer = folder.snake(&args);
    assert_ne!(answer.code, Some(0), "{answer:?}");
    if answer.code == Some(1) {
        assert!(answer.err.contains("unsure"), "{answer:?}");
        let events = std::fs::read_to_string(folder.path("e.csv")).unwrap();
        let begun: Vec<&str> = events
            .lines()
            .filter(|line| line.contains(",begun,"))
            .collect();
        assert!(begun.iter().all(|line| line.ends_with(",0")), "{events}");
    }
}

#[test]
fn with_births_the_frames_before_the_start_are_left_out_and_it_is_said_why() {
    let folder = frames(6);
    let args = [
        "track",
        "in",
        "--from",
        "circle:26,24,9",
        "--at",
        "3",
        "--births",
        "-o",
        "t.csv",
    ];
    let answer = folder.snake(&args);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    assert!(
        answer
            .err
            .contains("onwards in time only; the 3 frames before --at are left out"),
        "{answer:?}"
    );
    let table = std::fs::read_to_string(folder.path("t.csv")).unwrap();
    assert!(table.lines().nth(1).unwrap().starts_with("3,"), "{table}");
}
