//! `snake track`: outlines followed through the frames of a sequence.

mod along;
mod course;
mod film;
mod flags;
mod numbers;
mod plan;
mod said;
mod sinks;
mod tables;
mod values;
mod ways;

use std::sync::Arc;

use ::track::{Options, Tracker};
use io::frames::{Frame, Frames, Numbered};
use io::shapes::{Reading, Shape};
use io::tracks::TableFrames;
use io::{Picture, PictureReading};
use scene::SceneError;
use scene::fit::{Contour, Image};

use self::course::Course;
use self::flags::Taken;
pub(crate) use self::flags::{EXAMPLES, Flags};
use self::numbers::Numbers;
use self::plan::Plan;
use self::sinks::Sinks;
use crate::args::Words;
use crate::commands::{Answer, code, key};
use crate::fit::{matched, stem, typed};
use crate::stop::{STOPPED, Stop};

/// Follow the outlines of the first frame through all.
pub(crate) fn track(flags: &Flags, words: Words) -> Answer {
    let words = Words {
        verbose: words.verbose || flags.explain,
        ..words
    };
    let plan = Plan::of(flags, words)?;
    let reading = PictureReading {
        channel: flags.channel.clone(),
        as_stored: flags.as_stored,
        ..PictureReading::default()
    };
    let inputs = matched(&flags.frames)?;
    let mut frames = Frames::open(&inputs, &reading)?;
    plan.check(flags, &frames)?;
    notes(&mut frames, words);
    let stop = Stop::listen();
    let from = if flags.resume {
        TableFrames::last(plan.out())?
    } else {
        None
    };
    let (tracked_before, first) = match &from {
        None => (0, next(&mut frames)?),
        Some((frame, _)) => {
            frames.pass(*frame);
            (*frame, next(&mut frames)?)
        }
    };
    let Frame::Picture(picture) = first.frame else {
        let Frame::Broken(reason) = first.frame else {
            return Ok(code(false));
        };
        return Err(key("first frame", format!("{}: {reason}", first.name)));
    };
    for note in picture.notes() {
        words.say(&format!("note: {note}"));
    }
    let picture: Arc<Picture> = Arc::from(*picture);
    let (starts, numbers) = match &from {
        None => starts(flags, &frames, &picture, words)?,
        Some((_, outlines)) => {
            words.say(&format!(
                "goes on with frame {}, {}",
                tracked_before, first.name
            ));
            let starts = outlines.iter().map(|one| Contour {
                points: one.points.clone(),
                closed: true,
            });
            (
                starts.collect(),
                Numbers::given(outlines.iter().map(|one| one.id)),
            )
        }
    };
    let options = options(flags, from.is_some());
    let tracker = Tracker::new(
        &Image::of(Arc::<Picture>::clone(&picture)),
        &starts,
        &options,
    );
    let tracker = tracker.map_err(|error| key("--from", error))?;
    if let Some(id) = flags.object.filter(|id| !numbers.is_known(*id)) {
        return Err(key(
            "--object",
            format!(
                "no object has the number {id} at first; needed: {}",
                numbers.list()
            ),
        ));
    }
    // the frame that is gone on with is written already
    let there = from.as_ref().map_or(0, |(frame, _)| frame + 1);
    let mut sinks = Sinks::begin(flags, &plan, &frames, &picture, there)?;
    sinks.charts(numbers.first(), there);
    if there > 0 {
        sinks.replay(&inputs, &reading, there)?;
    }
    let mut course = Course::new(tracker, numbers, tracked_before, flags)?;
    if there == 0 {
        course.first(&picture, &first.name, &mut sinks, words)?;
    } else {
        course.again();
    }
    let bar = said::bar(frames.total(), tracked_before, words);
    while !stop.asked() && !course.is_over() {
        let Some(frame) = frames.next() else { break };
        bar.suspend(|| notes(&mut frames, words));
        bar.suspend(|| course.next(frame, &mut sinks, words))?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    let left = left(&mut frames, stop.asked());
    notes(&mut frames, words);
    for note in sinks.end()? {
        words.say(&format!("note: {note}"));
    }
    if let (false, Some(frame)) = (stop.asked(), course.not_mended()) {
        words.say(&format!(
            "note: --mend: frame {frame} was not followed, and nothing is mended there"
        ));
    }
    let stopped = stop.asked();
    if stopped {
        words.say(&format!("{STOPPED}; --resume goes on with a table"));
    }
    let good = said::summary(&course, left, stopped, words)?;
    Ok(code(good))
}

/// The next frame, which must be there.
fn next(frames: &mut Frames) -> Result<Numbered, SceneError> {
    let message = "there is no such frame: the sequence has ended before it";
    frames.next().ok_or_else(|| key("frames", message))
}

/// How many frames are left behind, if that is known.
const fn left(frames: &mut Frames, stopped: bool) -> Option<usize> {
    if stopped { frames.left() } else { Some(0) }
}

/// Say what there is to say of the frames.
fn notes(frames: &mut Frames, words: Words) {
    for note in frames.take_notes() {
        words.say(&format!("note: {note}"));
    }
}

/// The outlines to begin with, and the numbers that they have.
fn starts(
    flags: &Flags,
    frames: &Frames,
    picture: &Picture,
    words: Words,
) -> Result<(Vec<Contour>, Numbers), SceneError> {
    let file = frames.files().first().cloned().unwrap_or_default();
    let reading = Reading {
        beside: file
            .file_name()
            .map(|name| name.to_string_lossy().into_owned()),
        size: Some(picture.size()),
        ..typed(&flags.columns, flags.origin)?
    };
    let (shapes, notes) = flags.from.outlines(&reading, &stem(&file))?;
    for note in notes {
        words.say(&format!("note: {note}"));
    }
    let numbers = Numbers::of(&shapes);
    let contour = |shape: &Shape| Contour {
        points: shape.first().to_vec(),
        closed: shape.closed.unwrap_or(true),
    };
    Ok((shapes.iter().map(contour).collect(), numbers))
}

fn options(flags: &Flags, again: bool) -> Options {
    let start = match flags.start {
        _ if again => ::track::Start::Exact,
        Taken::Auto => ::track::Start::Chosen,
        Taken::Exact => ::track::Start::Exact,
        Taken::Rough => ::track::Start::Rough,
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
