//! Labels of the Cell Tracking Challenge by its rules, and what is refused of them.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test: a broken set-up should stop it"
)]

use glam::DVec2;

use super::tests::{context, square, written};
use super::*;

#[test]
fn labels_of_the_challenge_have_a_pixel_in_every_frame_of_a_track() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("01_RES");
    let notes = written(&path, TrackFormat::Ctc);
    assert_eq!(notes.len(), 1, "{notes:?}");
    let table = std::fs::read_to_string(path.join("res_track.txt")).unwrap();
    assert_eq!(table, "1 0 0 0\n2 0 1 0\n3 2 3 2\n4 2 2 2\n65535 2 3 1\n");
    let read = CtcFolder::open(&path).unwrap();
    assert_eq!(read.frames().collect::<Vec<_>>(), [0, 1, 2, 3]);
    // the rule itself: there in each frame from the beginning to the end, and in no other
    for track in read.tracks() {
        for frame in read.frames() {
            let there = read.labels(frame).unwrap().list.contains(&track.label);
            assert_eq!(
                there,
                (track.begin..=track.end).contains(&frame),
                "{track:?} {frame}"
            );
        }
        if let Some(parent) = track.parent {
            let parent = read
                .tracks()
                .iter()
                .find(|one| one.label == parent)
                .unwrap();
            assert!(parent.end < track.begin);
        }
    }
    let areas: Vec<f64> = read
        .outlines(2)
        .unwrap()
        .iter()
        .map(|one| area(&one.points))
        .collect();
    assert_eq!(
        areas.iter().map(|area| area.round()).collect::<Vec<_>>(),
        [36.0, 36.0, 64.0]
    );
    let again = TrackWriter::begin(&path, TrackFormat::Ctc, &context())
        .unwrap_err()
        .to_string();
    assert!(again.contains("has results already"), "{again}");
}

fn area(ring: &[DVec2]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    ring.iter()
        .zip(next)
        .map(|(a, b)| a.perp_dot(*b))
        .sum::<f64>()
        / 2.0
}

#[test]
fn a_parent_that_goes_on_and_frames_that_are_left_out_keep_to_the_rules() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().to_owned();
    let mut writer = TrackWriter::begin(&path, TrackFormat::Ctc, &context()).unwrap();
    let bud = |frame| Tracked {
        parent: Some(1),
        ..square(frame, 2, (30.5, 20.5), 5.0)
    };
    writer
        .frame(1, "", &[square(1, 1, (10.5, 10.5), 8.0)])
        .unwrap();
    writer
        .frame(2, "", &[square(2, 1, (10.5, 10.5), 8.0), bud(2)])
        .unwrap();
    // an outline without a pixel is none
    writer
        .frame(3, "", &[square(3, 1, (-30.0, 10.5), 8.0), bud(3)])
        .unwrap();
    let notes = writer.end().unwrap();
    assert!(notes[0].contains("1 parents go on"), "{notes:?}");
    let table = std::fs::read_to_string(path.join("res_track.txt")).unwrap();
    assert_eq!(table, "1 1 2 0\n2 2 3 0\n");
    assert!(
        CtcFolder::open(&path)
            .unwrap()
            .labels(0)
            .unwrap()
            .list
            .iter()
            .all(|&v| v == 0)
    );
}

#[test]
fn tables_of_the_challenge_that_are_wrong_are_refused_by_their_lines() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().to_owned();
    assert!(
        CtcFolder::open(&path)
            .unwrap_err()
            .to_string()
            .contains("holds no labels")
    );
    written(&path.join("r"), TrackFormat::Ctc);
    let path = path.join("r");
    for (text, wanted) in [
        ("1 0 3\n", "line 1: four whole numbers"),
        ("1 0 3 0\n1 0 2 0\n", "line 2: label 1 is there twice"),
        ("1 3 0 0\n", "line 1: label 1 from 3 to 0"),
        ("0 0 3 0\n", "line 1: label 0"),
        ("1 0 3 0\n2 0 3 7\n", "line 2: parent 7 is no label"),
        ("1 0 3 -1\n", "line 1: four whole numbers"),
    ] {
        std::fs::write(path.join("res_track.txt"), text).unwrap();
        let error = CtcFolder::open(&path).unwrap_err().to_string();
        assert!(error.contains(wanted), "{error}");
    }
    std::fs::write(path.join("res_track.txt"), "").unwrap();
    std::fs::copy(path.join("mask001.tif"), path.join("mask0001.tif")).unwrap();
    assert!(
        CtcFolder::open(&path)
            .unwrap_err()
            .to_string()
            .contains("both of frame 1")
    );
}
