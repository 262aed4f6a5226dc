//! What is followed: the outlines of the first frame, or of another.

use std::collections::BTreeSet;
use std::path::PathBuf;

use ::track::{Options, Start};
use glam::DVec2;
use io::Picture;
use io::frames::Frames;
use io::shapes::{Reading, Shape, Value};
use scene::SceneError;
use scene::fit::Contour;

use super::flags::{Flags, Taken};
use super::numbers::Numbers;
use crate::args::Words;
use crate::commands::key;
use crate::fit::{counted, stem, typed};

/// The frame that the start is in.
pub(super) fn place(flags: &Flags, frames: &Frames) -> Result<usize, SceneError> {
    let Some(text) = &flags.at else { return Ok(0) };
    frames.place_of(text).ok_or_else(|| {
        let needed = match frames.total() {
            Some(total) => format!("a number from 0 to {}", total.saturating_sub(1)),
            None => "a number from 0".to_owned(),
        };
        let message = format!(
            "must be {needed} or the name of a file of the sequence, got {}",
            io::text::clip(text)
        );
        key("--at", message)
    })
}

/// The file of a frame: its own, or the one that all are in.
pub(super) fn file(frames: &Frames, at: usize) -> PathBuf {
    let files = frames.files();
    let own = (frames.total() == Some(files.len())).then(|| files.get(at));
    own.flatten()
        .or_else(|| files.first())
        .cloned()
        .unwrap_or_default()
}

/// The outlines to begin with, and the numbers that they have.
pub(super) fn starts(
    flags: &Flags,
    frames: &Frames,
    at: usize,
    picture: &Picture,
    words: Words,
) -> Result<(Vec<Contour>, Numbers), SceneError> {
    let file = file(frames, at);
    let reading = Reading {
        beside: file
            .file_name()
            .map(|name| name.to_string_lossy().into_owned()),
        size: Some(picture.size()),
        ..typed(&flags.columns, flags.origin)?
    };
    let mut shapes: Vec<Shape> = Vec::new();
    if let Some(seeds) = &flags.seeds {
        let (objects, seeds) = seeds.objects(picture, &reading, &stem(&file))?;
        let large = objects
            .into_iter()
            .filter(|object| area(&object.outline) > SMALLEST);
        shapes.extend(large.map(|object| {
            let mut shape = Shape::curve(object.outline, Some(true));
            shape.id = seeds.get(object.seed).and_then(|seed| seed.id.clone());
            shape
        }));
        if shapes.is_empty() {
            return Err(key(
                "--seeds",
                "no object is found in the frame; needed: --from",
            ));
        }
        let found = counted(shapes.len(), "object");
        words.say(&format!("{found} found to follow"));
    }
    for start in &flags.from {
        let (own, notes) = start.outlines(&reading, &stem(&file))?;
        for note in notes {
            words.say(&format!("note: {note}"));
        }
        shapes.extend(of_frame(own, at, words)?);
    }
    let numbers = Numbers::of(&shapes);
    let contour = |shape: &Shape| Contour {
        points: shape.first().to_vec(),
        closed: shape.closed.unwrap_or(true),
    };
    Ok((shapes.iter().map(contour).collect(), numbers))
}

/// The outlines of one frame, of a file that has those of several.
fn of_frame(shapes: Vec<Shape>, at: usize, words: Words) -> Result<Vec<Shape>, SceneError> {
    let frames: BTreeSet<usize> = shapes.iter().filter_map(Shape::frame).collect();
    let (Some(first), Some(last)) = (frames.first(), frames.last()) else {
        return Ok(shapes);
    };
    if frames.len() == 1 && *first != at {
        words.say(&format!(
            "note: --from: the outlines are said to be of frame {first}, and are taken for frame {at}"
        ));
    } else if !frames.contains(&at) {
        let message = format!(
            "has outlines of frames {first} to {last}, and none of frame {at}; needed: --at with one of them"
        );
        return Err(key("--from", message));
    } else if frames.len() > 1 {
        words.say(&format!(
            "note: --from: of frames {first} to {last}, the outlines of frame {at} are taken"
        ));
    }
    let several = frames.len() > 1;
    let own = shapes
        .into_iter()
        .filter(|shape| !several || shape.frame() == Some(at));
    Ok(own.map(of_track).collect())
}

/// An outline with the number of its object, where its file has one of its own for each frame.
fn of_track(mut shape: Shape) -> Shape {
    let number = match shape.properties.get("track") {
        Some(Value::Number(number)) => Some(number.to_string()),
        Some(Value::Text(text)) => Some(text.clone()),
        _ => None,
    };
    shape.id = number.or(shape.id);
    shape
}

/// How they are followed.
pub(super) fn options(flags: &Flags) -> Options {
    let start = match flags.start {
        // outlines that were found are not found again
        Taken::Auto if flags.seeds.is_some() => Start::Exact,
        Taken::Auto => Start::Chosen,
        Taken::Exact => Start::Exact,
        Taken::Rough => Start::Rough,
    };
    let cores = || std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    Options {
        start,
        patience: flags.patience,
        births: flags.births,
        threads: flags.jobs.unwrap_or_else(cores).max(1),
        ..Options::default()
    }
}

/// Objects found by themselves that are smaller cannot be followed. Square pixels.
const SMALLEST: f64 = 4.0;

/// What a closed outline encloses.
fn area(outline: &[DVec2]) -> f64 {
    let next = outline.iter().cycle().skip(1);
    let twice: f64 = outline.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum();
    0.5 * twice.abs()
}
