//! Objects on their way through the frames: each frame followed, written, told.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use ::track::{Happening, Outline, State, Tracker};
use io::Picture;
use io::frames::{Frame, Numbered};
use io::tracks::{TableFrames, TrackState, Tracked};
use scene::SceneError;
use scene::fit::Image;

use super::flags::Flags;
use super::numbers::Numbers;
use super::sinks::{Happened, Seen, Sinks};
use crate::args::Words;
use crate::commands::key;

/// Objects beyond which what happens to each is only written.
const FEW: usize = 10;

/// A sequence that is followed.
#[derive(Debug)]
pub(super) struct Course {
    tracker: Tracker,
    numbers: Numbers,
    /// The frame that the tracker counts as 0.
    from: usize,
    /// Outlines mended by hand, by frames.
    mended: BTreeMap<usize, Vec<Tracked>>,
    /// Whether new objects may come.
    births: bool,
    pub(super) tally: Tally,
}

/// What there is to say of it in the end.
#[derive(Debug, Default)]
pub(super) struct Tally {
    pub(super) frames: usize,
    /// The last frame that was followed.
    pub(super) last: usize,
    pub(super) objects: BTreeSet<u32>,
    pub(super) broken: Vec<String>,
    pub(super) lost: BTreeSet<u32>,
    /// Objects that were not seen in the last frame.
    pub(super) hidden: BTreeSet<u32>,
    pub(super) alive: usize,
    pub(super) divided: usize,
    pub(super) born: usize,
    /// Outlines that were not seen, of all.
    pub(super) coasting: usize,
    pub(super) outlines: usize,
}

impl Course {
    pub(super) fn new(
        tracker: Tracker,
        numbers: Numbers,
        from: usize,
        flags: &Flags,
    ) -> Result<Self, SceneError> {
        let mut mended = BTreeMap::new();
        if let Some(path) = &flags.mend {
            for rows in TableFrames::open(path)? {
                let (frame, outlines) = rows?;
                mended.insert(frame, outlines);
            }
        }
        Ok(Self {
            tracker,
            numbers,
            from,
            mended,
            births: flags.births,
            tally: Tally::default(),
        })
    }

    /// A frame that was to be mended and was not there.
    pub(super) fn not_mended(&self) -> Option<usize> {
        self.mended.keys().next().copied()
    }

    /// Whether nothing is followed any more, and nothing will be.
    pub(super) fn is_over(&self) -> bool {
        self.tally.alive == 0 && self.tally.frames > 0 && !self.births
    }

    /// The first frame.
    pub(super) fn first(
        &mut self,
        picture: &Arc<Picture>,
        name: &str,
        sinks: &mut Sinks<'_>,
        words: Words,
    ) -> Result<(), SceneError> {
        let tracked = self.tracker.first().clone();
        let image = Image::of(Arc::<Picture>::clone(picture));
        self.take(tracked, Some(picture), Some(&image), name, sinks, words)
    }

    /// The least number of an object.
    pub(super) fn first_number(&self) -> u32 {
        self.numbers.first()
    }

    /// The next frame.
    pub(super) fn next(
        &mut self,
        frame: Numbered,
        sinks: &mut Sinks<'_>,
        words: Words,
    ) -> Result<(), SceneError> {
        match frame.frame {
            Frame::Broken(reason) => {
                words.say(&format!(
                    "frame {}, {}: {reason}; all goes on as it was going",
                    frame.index, frame.name
                ));
                self.tally.broken.push(frame.name.clone());
                let tracked = self.tracker.skip();
                self.take(tracked, None, None, &frame.name, sinks, words)
            }
            Frame::Picture(picture) => {
                let picture: Arc<Picture> = Arc::from(*picture);
                let image = Image::of(Arc::<Picture>::clone(&picture));
                let tracked = self
                    .tracker
                    .next(&image)
                    .map_err(|error| key("frames", error))?;
                self.take(
                    tracked,
                    Some(&picture),
                    Some(&image),
                    &frame.name,
                    sinks,
                    words,
                )
            }
        }
    }

    /// What a frame has said: written and told.
    fn take(
        &mut self,
        mut tracked: ::track::Tracked,
        picture: Option<&Picture>,
        image: Option<&Image>,
        name: &str,
        sinks: &mut Sinks<'_>,
        words: Words,
    ) -> Result<(), SceneError> {
        let frame = tracked.frame + self.from;
        let mut given = BTreeSet::new();
        if let Some(image) = image {
            for outline in self.mended.remove(&frame).unwrap_or_default() {
                self.mend(&outline, image, &mut tracked)?;
                given.insert(outline.id);
            }
        }
        let mut seen = Vec::new();
        for outline in &tracked.outlines {
            let one = self.tracked(frame, outline, &given);
            if words.verbose {
                words.detail(&format!(
                    "frame {frame}, object {}: {}, confidence {:.2}, {:?}",
                    one.id,
                    one.state.name(),
                    outline.confidence,
                    outline.prediction
                ));
            }
            seen.push(Seen {
                tracked: one,
                outline: outline.clone(),
            });
        }
        let happened: Vec<Happened> = tracked
            .events
            .iter()
            .map(|event| Happened {
                frame,
                id: self.numbers.of_object(event.id),
                word: word(&event.what),
                others: match &event.what {
                    Happening::Divided(both) => {
                        both.iter().map(|&id| self.numbers.of_object(id)).collect()
                    }
                    Happening::Merged(other) => vec![self.numbers.of_object(*other)],
                    _ => Vec::new(),
                },
                confidence: event.confidence,
            })
            .collect();
        self.count(frame, &seen, &happened);
        let few = self.tally.objects.len() <= FEW;
        for one in happened
            .iter()
            .filter(|one| !matches!(one.word, "begun" | "skipped"))
        {
            let text = one.to_string();
            if few {
                words.say(&text);
            } else {
                words.detail(&text);
            }
        }
        sinks.frame(frame, name, picture, &seen, &happened)
    }

    fn mend(
        &mut self,
        outline: &Tracked,
        image: &Image,
        tracked: &mut ::track::Tracked,
    ) -> Result<(), SceneError> {
        let refuse = |message: String| {
            key(
                "--mend",
                format!("frame {}, object {}: {message}", outline.frame, outline.id),
            )
        };
        let id = self.numbers.object(outline.id);
        let id = id.ok_or_else(|| refuse("no such object is followed then".to_owned()))?;
        let event = self
            .tracker
            .mend(image, id, &outline.points)
            .map_err(|error| refuse(error.to_string()))?;
        for one in tracked.outlines.iter_mut().filter(|one| one.id == id) {
            one.points.clone_from(&outline.points);
            let share = 1.0 / outline.points.len().max(1) as f64;
            one.material = (0..outline.points.len())
                .map(|i| i as f64 * share)
                .collect();
            one.errors = vec![0.0; outline.points.len()];
            (one.state, one.confidence) = (State::Seen, 1.0);
        }
        tracked.events.push(event);
        Ok(())
    }

    fn tracked(&mut self, frame: usize, outline: &Outline, given: &BTreeSet<u32>) -> Tracked {
        let id = self.numbers.of_object(outline.id);
        let state = match outline.state {
            _ if given.contains(&id) => TrackState::Given,
            State::Seen => TrackState::Tracked,
            State::Partly => TrackState::Partly,
            State::Coasting | State::Left => TrackState::Coasting,
        };
        let sure = outline.confidence;
        Tracked {
            frame,
            id,
            points: outline.points.clone(),
            parent: outline.parent.map(|parent| self.numbers.of_object(parent)),
            confidence: Some(if sure.is_finite() {
                sure.clamp(0.0, 1.0)
            } else {
                0.0
            }),
            state,
            measures: BTreeMap::new(),
        }
    }

    fn count(&mut self, frame: usize, seen: &[Seen], happened: &[Happened]) {
        let tally = &mut self.tally;
        tally.frames += 1;
        tally.last = frame;
        tally.alive = seen.len();
        tally.outlines += seen.len();
        tally.hidden.clear();
        for one in seen {
            tally.objects.insert(one.tracked.id);
            if one.tracked.state == TrackState::Coasting {
                tally.coasting += 1;
                tally.hidden.insert(one.tracked.id);
            }
        }
        for one in happened {
            match one.word {
                "lost" => {
                    tally.lost.insert(one.id);
                }
                "divided" => tally.divided += 1,
                "born" => tally.born += 1,
                _ => {}
            }
        }
    }
}

/// What happened, in a word.
pub(super) const fn word(what: &Happening) -> &'static str {
    match what {
        Happening::Begun => "begun",
        Happening::Hidden => "hidden",
        Happening::Found => "found",
        Happening::Left => "left",
        Happening::Lost => "lost",
        Happening::Divided(_) => "divided",
        Happening::Born => "born",
        Happening::Merged(_) => "merged",
        Happening::Skipped => "skipped",
        Happening::Mended => "mended",
        Happening::Remeshed => "remeshed",
        _ => "other",
    }
}
