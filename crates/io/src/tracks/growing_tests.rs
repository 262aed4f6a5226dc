//! What was ended on the way and is gone on with, and what is not the same.

#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use std::path::{Path, PathBuf};

use super::tests::{context, story, written};
use super::{TrackFormat, TrackWriter};

#[test]
fn a_table_that_was_ended_is_gone_on_with_and_no_rest_is_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let (path, part) = (
        folder.path().join("a.csv"),
        folder.path().join("a.csv.part"),
    );
    let whole = {
        written(&path, TrackFormat::Csv);
        std::fs::read(&path).unwrap()
    };
    let story = story();
    let mut writer = {
        std::fs::remove_file(&path).unwrap();
        TrackWriter::begin(&path, TrackFormat::Csv, &context()).unwrap()
    };
    for frame in 0..3 {
        writer.frame(frame, "", &story[frame]).unwrap();
    }
    // as if the program had been ended within a line
    drop(writer);
    let rest = std::fs::read(&part).unwrap();
    assert!(!path.exists() && whole.starts_with(&rest));
    std::fs::write(&part, &rest[..rest.len() - 3]).unwrap();
    let error = TrackWriter::begin(&path, TrackFormat::Csv, &context())
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("a former run has left") && error.contains("--resume"),
        "{error}"
    );
    // frames are given again; nothing changes until something comes behind what is there
    let mut writer = TrackWriter::resume(&path, TrackFormat::Csv, &context()).unwrap();
    let cut = std::fs::read(&part).unwrap();
    for frame in 0..4 {
        assert_eq!(writer.is_behind(), frame < 3, "{frame}");
        assert!(frame > 2 || std::fs::read(&part).unwrap() == cut);
        writer.frame(frame, "", &story[frame]).unwrap();
    }
    writer.end().unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), whole);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    // a table that ended is gone on with as well
    let half = whole
        .split_inclusive(|b| *b == b'\n')
        .take(6)
        .collect::<Vec<_>>();
    for old in [&whole[..], &half.concat(), b"", b"frame,id,x,y\n"] {
        std::fs::write(&path, old).unwrap();
        let mut writer = TrackWriter::resume(&path, TrackFormat::Csv, &context()).unwrap();
        for frame in 0..4 {
            writer.frame(frame, "", &story[frame]).unwrap();
        }
        writer.end().unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), whole);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }
    // zeros, as a power cut leaves them, are no rows; and where nothing is there, a table begins
    std::fs::write(&part, [&rest[..], &[0; 200_000]].concat()).unwrap();
    std::fs::remove_file(&path).unwrap();
    for _ in 0..2 {
        let mut writer = TrackWriter::resume(&path, TrackFormat::Csv, &context()).unwrap();
        for frame in 0..4 {
            writer.frame(frame, "", &story[frame]).unwrap();
        }
        writer.end().unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), whole);
        std::fs::remove_file(&path).unwrap();
    }
}

#[test]
fn a_table_of_something_else_is_not_gone_on_with_and_stays() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.csv");
    written(&path, TrackFormat::Csv);
    let (whole, story) = (std::fs::read(&path).unwrap(), story());
    // the second point of the only outline of frame 1 is another
    let mut other = story.clone();
    other[1][1].points[1].x += 0.25;
    let mut writer = TrackWriter::resume(&path, TrackFormat::Csv, &context()).unwrap();
    writer.frame(0, "", &other[0]).unwrap();
    let error = writer.frame(1, "", &other[1]).unwrap_err().to_string();
    let before: usize = story[0].iter().map(|one| one.points.len()).sum();
    let wanted = format!("line {}: is not what comes out now", before + 3);
    assert!(error.contains(&wanted), "{error}: {wanted}");
    drop(writer);
    // fewer frames than there are
    let mut writer = TrackWriter::resume(&path, TrackFormat::Csv, &context()).unwrap();
    writer.frame(0, "", &story[0]).unwrap();
    let error = writer.end().unwrap_err().to_string();
    assert!(error.contains("has rows behind those"), "{error}");
    assert_eq!(std::fs::read(&path).unwrap(), whole);
    std::fs::write(&path, "mine").unwrap();
    let error = TrackWriter::resume(&path, TrackFormat::Csv, &context())
        .unwrap_err()
        .to_string();
    assert!(error.contains("line 1: is not what comes out"), "{error}");
    assert_eq!(std::fs::read(&path).unwrap(), b"mine");
    // what was begun leaves nothing if that is asked for
    let other = folder.path().join("b.csv");
    let writer = TrackWriter::begin(&other, TrackFormat::Csv, &context()).unwrap();
    writer.discard().unwrap();
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

/// Every file below a folder, by name, with its bytes.
fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut all = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            all.append(&mut files(&path));
        } else {
            let bytes = std::fs::read(&path).unwrap();
            all.push((path, bytes));
        }
    }
    all.sort();
    all
}

#[test]
fn every_format_that_grows_is_gone_on_with_from_wherever_it_was_ended() {
    for format in TrackFormat::ALL {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.out");
        let step = |writer: &mut TrackWriter, frame: usize| {
            writer.frame(frame, &format!("f{frame}.png"), &story()[frame])
        };
        if !format.grows() {
            let error = TrackWriter::resume(&path, format, &context()).unwrap_err();
            assert!(error.to_string().contains("only written as a whole"));
            continue;
        }
        written(&path, format);
        let whole = files(folder.path());
        // what ended is compared with, and stays
        let mut writer = TrackWriter::resume(&path, format, &context()).unwrap();
        (0..4).for_each(|frame| step(&mut writer, frame).unwrap());
        writer.end().unwrap();
        assert_eq!(files(folder.path()), whole, "{format:?}");
        for ended in 0..4 {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("a.out");
            let mut writer = TrackWriter::begin(&path, format, &context()).unwrap();
            (0..ended).for_each(|frame| step(&mut writer, frame).unwrap());
            // as a kill leaves it
            drop(writer);
            let mut writer = TrackWriter::resume(&path, format, &context()).unwrap();
            (0..4).for_each(|frame| step(&mut writer, frame).unwrap());
            assert!(!writer.is_behind());
            writer.end().unwrap();
            let bytes = |list: Vec<(PathBuf, Vec<u8>)>| -> Vec<Vec<u8>> {
                list.into_iter().map(|one| one.1).collect()
            };
            assert_eq!(
                bytes(files(folder.path())),
                bytes(whole.clone()),
                "{format:?} {ended}"
            );
        }
        // another object there, or fewer frames than there are: refused, and nothing is changed
        let mut writer = TrackWriter::resume(&path, format, &context()).unwrap();
        let mut other = story();
        other[0][0].points.iter_mut().for_each(|p| p.x += 2.0);
        let error = writer
            .frame(0, "f0.png", &other[0])
            .unwrap_err()
            .to_string();
        assert!(
            error.contains("is not what comes out now"),
            "{format:?}: {error}"
        );
        drop(writer);
        let mut writer = TrackWriter::resume(&path, format, &context()).unwrap();
        (0..2).for_each(|frame| step(&mut writer, frame).unwrap());
        assert!(writer.is_behind() && writer.end().is_err());
        assert_eq!(files(folder.path()), whole, "{format:?}");
    }
}
