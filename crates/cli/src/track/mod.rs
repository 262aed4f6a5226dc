//! `snake track`: outlines followed through the frames of a sequence.

mod along;
mod between;
mod course;
mod film;
mod flags;
mod numbers;
mod plan;
mod run;
mod said;
mod sinks;
mod start;
mod tables;
mod values;
mod ways;

use std::sync::Arc;

use ::track::{Happening, Options};
use indicatif::ProgressBar;
use io::frames::{Frame, Frames, Numbered};
use io::tracks::TableFrames;
use io::{Invalid, Picture, PictureReading};
use scene::SceneError;

use self::course::Course;
pub(crate) use self::flags::{EXAMPLES, Flags};
use self::numbers::Numbers;
use self::plan::Plan;
use self::run::{Facts, MOST_MISSING, Run, Told};
use self::sinks::Sinks;
use crate::args::Words;
use crate::commands::{Answer, code, key};
use crate::fit::{counted, matched};
use crate::stop::{STOPPED, Stop};

/// Follow outlines through all frames.
pub(crate) fn track(flags: &Flags, words: Words) -> Answer {
    let words = Words {
        verbose: words.verbose || flags.explain,
        ..words
    };
    let plan = Plan::of(flags, words)?;
    let reading = PictureReading {
        channel: flags.channel.clone(),
        as_stored: flags.as_stored,
        invalid: Invalid::Mask,
        ..PictureReading::default()
    };
    let mut frames = Frames::open(&matched(&flags.frames)?, &reading)?;
    let at = start::place(flags, &frames)?;
    plan.check(flags, &frames, at)?;
    let mut facts = facts(flags)?;
    notes(&mut frames, words);
    far_apart(&frames, words);
    let stop = Stop::listen();
    let seekable = frames.is_seekable();
    frames.pass(at);
    let Some(first) = frames.next() else {
        let message = "there is no such frame: the sequence has ended before it";
        return Err(key("--at", message));
    };
    let picture = match &first.frame {
        Frame::Picture(picture) => Arc::new(Picture::clone(picture)),
        Frame::Broken(reason) => {
            let name = if at == 0 { "first frame" } else { "--at" };
            return Err(key(name, format!("{}: {reason}", first.name)));
        }
    };
    for note in picture.notes() {
        words.say(&format!("note: {note}"));
    }
    let (starts, numbers) = start::starts(flags, &frames, at, &picture, words)?;
    let options = start::options(flags);
    let begin = |numbers, options: &Options, back| {
        Run::begin(&first, &picture, &starts, numbers, options, back).map_err(|error| {
            key(
                if flags.seeds.is_some() {
                    "--seeds"
                } else {
                    "--from"
                },
                error,
            )
        })
    };
    let mut run = begin(numbers.clone(), &options, false)?;
    if let Some(id) = flags.object.filter(|id| !numbers.is_known(*id)) {
        return Err(key(
            "--object",
            format!(
                "no object has the number {id} at first; needed: {}",
                numbers.list()
            ),
        ));
    }
    if !flags.births {
        followed_at_all(&facts, &numbers)?;
    }
    let mut sinks = Sinks::begin(flags, &plan, &frames, &picture)?;
    // a division seen backwards is two outlines on one object, of which neither way is right
    let back = seekable && at > 0 && !flags.births;
    if seekable && at > 0 && flags.births {
        words.say(&format!(
            "note: --births: objects are born and divide onwards in time only; the {} before --at are left out \
             (without --births, the objects of the start are followed back through them)",
            counted(at, "frame")
        ));
    }
    let begins = if back { 0 } else { at };
    sinks.charts(numbers.first(), begins);
    if sinks.is_behind() {
        words.say("--resume: frames are followed again from the first; what is there is compared");
    }
    let bar = said::bar(frames.total(), begins, words);
    let mut course = Course {
        births: flags.births,
        ..Course::default()
    };
    let mut all = Whole {
        frames: &mut frames,
        course: &mut course,
        sinks: &mut sinks,
        stop: &stop,
        bar: &bar,
        words,
        is_begun: false,
    };
    let before = if back {
        Some(begin(numbers, &options, true)?)
    } else {
        None
    };
    let ways = Ways {
        at,
        first: &first,
        picture: &picture,
        options: &options,
    };
    let followed = all.follow(&ways, &mut run, before, &mut facts);
    let is_begun = all.is_begun;
    bar.finish_and_clear();
    notes(&mut frames, words);
    let stopped = stop.asked();
    let left = if stopped { frames.left() } else { Some(0) };
    if is_begun {
        end(sinks, followed, (stopped, plan.format.grows()), words)?;
    } else {
        sinks.discard()?;
        followed?;
        words.say("stopped by Ctrl-C before anything was to be written: nothing is changed");
    }
    facts.append(&mut run.facts);
    if let (false, Some(frame)) = (stopped, facts.keys().next()) {
        words.say(&format!(
            "note: --mend: frame {frame} was not followed, and nothing is mended there"
        ));
    }
    let good = said::summary(&course, left, stopped, words)?;
    Ok(code(good))
}

/// Finish what is written, however the way has ended.
fn end(
    sinks: Sinks<'_>,
    followed: Result<(), SceneError>,
    (stopped, grows): (bool, bool),
    words: Words,
) -> Result<(), SceneError> {
    if sinks.is_behind() && (stopped || followed.is_err()) {
        // what a former run has written is more than what there is by now
        words.say("ended before all was followed again that is there: nothing is changed");
        return followed;
    }
    let kept = sinks.end();
    if followed.is_err() {
        words.say(if kept.is_ok() {
            "ended by an error: what there was by then is written"
        } else {
            "ended by an error, and not all can be written: what there is stays as NAME.part, and --resume goes on with it"
        });
    }
    followed?;
    for note in kept? {
        words.say(&format!("note: {note}"));
    }
    if stopped {
        let more = if grows {
            "; --resume goes on with it"
        } else {
            ""
        };
        words.say(&format!("{STOPPED}{more}"));
    }
    Ok(())
}

/// Where the way begins, and how it is gone.
struct Ways<'a> {
    at: usize,
    first: &'a Numbered,
    picture: &'a Arc<Picture>,
    options: &'a Options,
}

/// A sequence with all that is made of it.
struct Whole<'a, 'b> {
    frames: &'a mut Frames,
    course: &'a mut Course,
    sinks: &'a mut Sinks<'b>,
    stop: &'a Stop,
    bar: &'a ProgressBar,
    words: Words,
    /// Whether anything has been written.
    is_begun: bool,
}

impl Whole<'_, '_> {
    /// Follow all. `before` goes from the start back to the first frame. Of `facts` those are left that nothing was
    /// done with.
    fn follow(
        &mut self,
        ways: &Ways<'_>,
        run: &mut Run,
        before: Option<Run>,
        facts: &mut Facts,
    ) -> Result<(), SceneError> {
        let seekable = self.frames.is_seekable();
        let mut behind = before;
        let beyond = facts.split_off(&self.frames.total().unwrap_or(usize::MAX));
        let mut earlier = std::mem::replace(facts, beyond);
        run.facts = earlier.split_off(&ways.at);
        let farthest = run.facts.keys().next_back().copied();
        let farthest = farthest.filter(|&frame| seekable && frame > ways.at);
        match &mut behind {
            Some(behind) => {
                let here = run.facts.get(&ways.at).cloned();
                earlier.extend(here.map(|list| (ways.at, list)));
                behind.facts = earlier;
            }
            None => facts.append(&mut earlier),
        }
        if !seekable && (ways.at > 0 || !run.facts.is_empty()) {
            self.words.say(
                "note: a video or a stream cannot be read back: objects are only followed onwards",
            );
        }
        let first = run.first(ways.first, ways.picture)?;
        let mut told = Vec::new();
        if let Some(behind) = &mut behind {
            let first = behind.first(ways.first, ways.picture)?;
            let options = ways.options;
            let Some(mut way) =
                between::outwards(self.frames, behind, first, 0, options, self.stop)?
            else {
                return Ok(());
            };
            facts.append(&mut behind.facts);
            way.reverse();
            way.pop();
            for event in way.iter_mut().map(|told| &mut told.events) {
                // what ends on the way back begins; that is told by the outlines
                event.retain(|one| {
                    matches!(
                        one.what,
                        Happening::Mended | Happening::Skipped | Happening::Uncertain(_)
                    )
                });
            }
            told.append(&mut way);
        }
        let Some(to) = farthest.or((!told.is_empty()).then_some(ways.at)) else {
            self.told(&first, Some(ways.picture))?;
            return self.onwards(run);
        };
        let Some(mut way) =
            between::outwards(self.frames, run, first, to, ways.options, self.stop)?
        else {
            return Ok(());
        };
        told.append(&mut way);
        between::retold(&mut told);
        let next = told.last().map_or(0, |last| last.index + 1);
        for one in &told {
            if self.stop.asked() {
                return Ok(());
            }
            let picture = if self.sinks.needs_pictures() && self.frames.seek(one.index) {
                let frame = self.frames.next();
                frame.and_then(between::picture_of)
            } else {
                None
            };
            self.told(one, picture.as_ref())?;
        }
        self.frames.seek(next);
        self.onwards(run)
    }

    /// Follow and tell all that comes.
    fn onwards(&mut self, run: &mut Run) -> Result<(), SceneError> {
        while !self.stop.asked() && !self.course.is_over() {
            let Some(frame) = self.frames.next() else {
                break;
            };
            self.bar.suspend(|| notes(self.frames, self.words));
            let (told, picture) = run.step(frame)?;
            self.told(&told, picture.as_ref())?;
        }
        Ok(())
    }

    /// Write and tell a frame.
    fn told(&mut self, told: &Told, picture: Option<&Arc<Picture>>) -> Result<(), SceneError> {
        self.is_begun = true;
        let behind = self.sinks.is_behind();
        let (course, sinks, words) = (&mut *self.course, &mut *self.sinks, self.words);
        let picture = picture.map(AsRef::as_ref);
        self.bar
            .suspend(|| course.tell(told, picture, sinks, words))?;
        if behind && !self.sinks.is_behind() {
            let text = format!("goes on behind frame {}", told.index);
            self.bar.suspend(|| words.say(&text));
        }
        self.bar.inc(1);
        Ok(())
    }
}

/// What is given by hand, by frames.
fn facts(flags: &Flags) -> Result<Facts, SceneError> {
    let mut facts = Facts::new();
    if let Some(path) = &flags.mend {
        for rows in TableFrames::open(path)? {
            let (frame, outlines) = rows?;
            facts.insert(frame, outlines);
        }
    }
    Ok(facts)
}

/// Refuse what is given of objects that are not followed. (Where objects are born, that is known when their frames
/// come.)
fn followed_at_all(facts: &Facts, numbers: &Numbers) -> Result<(), SceneError> {
    for (frame, one) in facts
        .iter()
        .flat_map(|(frame, list)| list.iter().map(move |one| (frame, one)))
    {
        if !numbers.is_known(one.id) {
            let message = format!(
                "frame {frame}, object {}: no such object is followed; needed: {}",
                one.id,
                numbers.list()
            );
            return Err(key("--mend", message));
        }
    }
    Ok(())
}

/// Say what there is to say of the frames.
fn notes(frames: &mut Frames, words: Words) {
    for note in frames.take_notes() {
        words.say(&format!("note: {note}"));
    }
}

/// Say where more frames are missing than objects go on by.
fn far_apart(frames: &Frames, words: Words) {
    for gap in frames.gaps().iter().filter(|gap| gap.count > MOST_MISSING) {
        let count = usize::try_from(gap.count).unwrap_or(usize::MAX);
        words.say(&format!(
            "note: {gap}: {} missing, more than {MOST_MISSING}: objects are looked for where they were",
            counted(count, "frame")
        ));
    }
}
