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
    let first = next(&mut frames)?;
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
    let (starts, numbers) = starts(flags, &frames, &picture, words)?;
    let tracker = Tracker::new(
        &Image::of(Arc::<Picture>::clone(&picture)),
        &starts,
        &options(flags),
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
    let mut course = Course::new(tracker, numbers, 0, flags)?;
    let mut sinks = Sinks::begin(flags, &plan, &frames, &picture)?;
    sinks.charts(course.first_number());
    if sinks.is_behind() {
        words.say("--resume: frames are followed again from the first; what is there is compared");
    }
    let bar = said::bar(frames.total(), 0, words);
    let followed = bar.suspend(|| course.first(&picture, &first.name, &mut sinks, words));
    let followed = followed.and_then(|()| {
        while !stop.asked() && !course.is_over() {
            let Some(frame) = frames.next() else { break };
            bar.suspend(|| notes(&mut frames, words));
            let (behind, index) = (sinks.is_behind(), frame.index);
            bar.suspend(|| course.next(frame, &mut sinks, words))?;
            if behind && !sinks.is_behind() {
                bar.suspend(|| words.say(&format!("goes on behind frame {index}")));
            }
            bar.inc(1);
        }
        Ok(())
    });
    bar.finish_and_clear();
    let left = left(&mut frames, stop.asked());
    notes(&mut frames, words);
    let stopped = stop.asked();
    if sinks.is_behind() && (stopped || followed.is_err()) {
        // what a former run has written is more than what there is by now
        words.say("ended before all was followed again that is there: nothing is changed");
        followed?;
    } else {
        let kept = sinks.end();
        if followed.is_err() && kept.is_ok() {
            words.say("ended by an error: what there was by then is written");
        }
        followed?;
        for note in kept? {
            words.say(&format!("note: {note}"));
        }
        if stopped {
            words.say(&format!("{STOPPED}; --resume goes on with a table"));
        }
    }
    if let (false, Some(frame)) = (stopped, course.not_mended()) {
        words.say(&format!(
            "note: --mend: frame {frame} was not followed, and nothing is mended there"
        ));
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

fn options(flags: &Flags) -> Options {
    let start = match flags.start {
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
