//! `snake track` begun with tracks of its own.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::moving::{START, frames};

#[test]
fn of_tracks_the_outlines_of_the_frame_of_the_start_are_taken() {
    let folder = frames(6);
    for name in ["t.csv", "t.geojson", "t.zip"] {
        let begun = folder.snake(&[&["track", "in", "-o", name][..], &START].concat());
        assert_eq!(begun.code, Some(0), "{begun:?}");
        for at in ["0", "3"] {
            let from = [
                "track", "in", "--from", name, "--at", at, "--start", "exact", "-o", "a.csv",
            ];
            let answer = folder.snake(&from);
            assert_eq!(answer.code, Some(0), "{name} {at}: {answer:?}");
            let says = format!("of frames 0 to 5, the outlines of frame {at} are taken");
            assert!(answer.err.contains(&says), "{answer:?}");
            assert!(
                answer.err.contains("1 object followed through 6 frames"),
                "{answer:?}"
            );
            let text = std::fs::read_to_string(folder.path("a.csv")).unwrap();
            let rows: Vec<Vec<f64>> = text
                .lines()
                .skip(1)
                .map(|line| line.split(',').map(|word| word.parse().unwrap()).collect())
                .collect();
            for frame in 0..6 {
                let own: Vec<&Vec<f64>> = rows
                    .iter()
                    .filter(|row| (row[0] - f64::from(frame)).abs() < 0.5)
                    .collect();
                assert!(
                    own.iter().all(|row| (row[1] - 1.0).abs() < 0.5),
                    "{name} {at}"
                );
                let x = own.iter().map(|row| row[2]).sum::<f64>() / own.len() as f64;
                assert!(
                    (x - 20.0 - 2.0 * f64::from(frame)).abs() < 0.5,
                    "{name} {at} {frame}: {x}"
                );
            }
        }
    }
    // a frame that is not there
    let text = std::fs::read_to_string(folder.path("t.csv")).unwrap();
    let some: Vec<&str> = text
        .lines()
        .filter(|line| !line.starts_with("5,"))
        .collect();
    folder.write("some.csv", some.join("\n"));
    folder.refused(
        &[
            "track", "in", "-q", "--from", "some.csv", "--at", "5", "-o", "b.csv",
        ],
        &["--from: has outlines of frames 0 to 4, and none of frame 5"],
    );
}
