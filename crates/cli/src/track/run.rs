//! Objects on their way from frame to frame, onwards or back, with the numbers that they are written with.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use ::track::{Event, Happening, Options, Outline, State, TrackError, Tracked as Step, Tracker};
use io::Picture;
use io::frames::{Frame, Numbered};
use io::tracks::Tracked;
use scene::SceneError;
use scene::fit::{Contour, Image};

use super::numbers::Numbers;
use crate::commands::key;

/// As many frames may be missing by the numbers of the files for objects to go on by them.
pub(super) const MOST_MISSING: u64 = 5;

/// Outlines that are given, by frames.
pub(super) type Facts = BTreeMap<usize, Vec<Tracked>>;

/// A tracker, and what it is given on the way.
#[derive(Debug)]
pub(super) struct Run {
    tracker: Tracker,
    pub(super) numbers: Numbers,
    pub(super) facts: Facts,
    /// Whether it goes from the last frame to the first.
    back: bool,
    /// Whether objects may come by what is given.
    open: bool,
    /// Objects that were seen in the last frame.
    seen: BTreeSet<u32>,
    /// Frames that are missing between the last frame and the one before it.
    missing: u64,
}

/// What there is to say of a frame: numbers are those that are written.
#[derive(Debug, Clone)]
pub(super) struct Told {
    pub(super) index: usize,
    pub(super) name: String,
    pub(super) outlines: Vec<Outline>,
    pub(super) events: Vec<Event>,
    /// Objects whose outlines were given.
    pub(super) given: BTreeSet<u32>,
    /// Why the frame cannot be used.
    pub(super) broken: Option<String>,
    /// How many frames are missing before it that objects have gone on by.
    pub(super) missing: u64,
    /// How many of its pixels do not count.
    pub(super) masked: usize,
}

impl Run {
    /// Begin with a frame and the outlines in it.
    pub(super) fn begin(
        first: &Numbered,
        picture: &Arc<Picture>,
        starts: &[Contour],
        numbers: Numbers,
        options: &Options,
        back: bool,
    ) -> Result<Self, TrackError> {
        let image = Image::of(Arc::<Picture>::clone(picture));
        Ok(Self {
            tracker: Tracker::new(&image, starts, options)?,
            numbers,
            facts: Facts::new(),
            back,
            open: false,
            seen: BTreeSet::new(),
            missing: first.missing,
        })
    }

    /// Begin with outlines that are given; others may come.
    pub(super) fn of_facts(
        first: &Numbered,
        picture: &Arc<Picture>,
        facts: &[Tracked],
        options: &Options,
        back: bool,
    ) -> Result<Self, TrackError> {
        let starts: Vec<Contour> = facts
            .iter()
            .map(|one| Contour::closed(one.points.clone()))
            .collect();
        let numbers = Numbers::given(facts.iter().map(|one| one.id));
        let mut run = Self::begin(first, picture, &starts, numbers, options, back)?;
        run.open = true;
        Ok(run)
    }

    /// What the first frame has said.
    pub(super) fn first(
        &mut self,
        frame: &Numbered,
        picture: &Arc<Picture>,
    ) -> Result<Told, SceneError> {
        let tracked = self.tracker.first().clone();
        let mut told = self.told(frame.index, &frame.name, tracked, None);
        told.masked = masked(picture);
        self.given(&Image::of(Arc::<Picture>::clone(picture)), &mut told)?;
        self.seen = seen(&told);
        Ok(told)
    }

    /// Follow all into the next frame; its picture, if it has one.
    pub(super) fn step(
        &mut self,
        frame: Numbered,
    ) -> Result<(Told, Option<Arc<Picture>>), SceneError> {
        let missing = if self.back {
            self.missing
        } else {
            frame.missing
        };
        self.missing = frame.missing;
        let missing = if missing > MOST_MISSING { 0 } else { missing };
        for _ in 0..missing {
            self.tracker.skip();
        }
        let (index, name) = (frame.index, frame.name);
        let (mut told, picture) = match frame.frame {
            Frame::Broken(reason) => {
                let tracked = self.tracker.skip();
                (self.told(index, &name, tracked, Some(reason)), None)
            }
            Frame::Picture(picture) => {
                let picture: Arc<Picture> = Arc::from(picture);
                let image = Image::of(Arc::<Picture>::clone(&picture));
                let tracked = self.tracker.next(&image);
                let tracked = tracked.map_err(|error| key("frames", error))?;
                let mut told = self.told(index, &name, tracked, None);
                told.masked = masked(&picture);
                self.given(&image, &mut told)?;
                (told, Some(picture))
            }
        };
        told.missing = missing;
        if missing > 0 {
            // what was seen before them was not hidden
            let seen = &self.seen;
            told.events
                .retain(|event| event.what != Happening::Found || !seen.contains(&event.id));
        }
        self.seen = seen(&told);
        Ok((told, picture))
    }

    /// Set what is given in a frame.
    fn given(&mut self, image: &Image, told: &mut Told) -> Result<(), SceneError> {
        let facts = self.facts.remove(&told.index).unwrap_or_default();
        facts
            .iter()
            .try_for_each(|fact| self.mend(fact, image, told))
    }

    fn mend(&mut self, fact: &Tracked, image: &Image, told: &mut Told) -> Result<(), SceneError> {
        let refuse = |message: String| {
            key(
                "--mend",
                format!("frame {}, object {}: {message}", fact.frame, fact.id),
            )
        };
        let known = self.numbers.object(fact.id);
        let mended = match known {
            None if !self.open => {
                return Err(refuse("no such object is followed then".to_owned()));
            }
            None => Err(TrackError::NoStart),
            Some(id) => self.tracker.mend(image, id, &fact.points).map(|_| ()),
        };
        match mended {
            Ok(()) => {}
            // it was lost, or comes by this
            Err(TrackError::NoObject { .. } | TrackError::NoStart) => {
                let id = self.tracker.take_up(image, &fact.points);
                let id = id.map_err(|error| refuse(error.to_string()))?;
                self.numbers.set(id, fact.id);
            }
            Err(error) => return Err(refuse(error.to_string())),
        }
        let count = fact.points.len();
        let at = told.outlines.iter().position(|one| one.id == fact.id);
        let at = at.unwrap_or_else(|| {
            told.outlines.push(of_fact(fact));
            told.outlines.sort_by_key(|one| one.id);
            told.outlines
                .iter()
                .position(|one| one.id == fact.id)
                .unwrap_or(0)
        });
        let one = &mut told.outlines[at];
        one.points.clone_from(&fact.points);
        one.material = shares(count);
        one.errors = vec![0.0; count];
        (one.state, one.confidence) = (State::Seen, 1.0);
        told.given.insert(fact.id);
        told.events.push(Event {
            frame: told.index,
            id: fact.id,
            what: Happening::Mended,
            confidence: 1.0,
        });
        Ok(())
    }

    /// A frame with the numbers that are written.
    fn told(&mut self, index: usize, name: &str, step: Step, broken: Option<String>) -> Told {
        let mut outlines = step.outlines;
        for one in &mut outlines {
            one.id = self.numbers.of_object(one.id);
            one.parent = one.parent.map(|parent| self.numbers.of_object(parent));
            if self.back {
                (one.velocity, one.rotation) = (-one.velocity, -one.rotation);
            }
        }
        let mut events = step.events;
        for event in &mut events {
            event.id = self.numbers.of_object(event.id);
            event.frame = index;
            match &mut event.what {
                Happening::Divided(both) => {
                    *both = both.map(|id| self.numbers.of_object(id));
                }
                Happening::Merged(other) | Happening::Uncertain(other) => {
                    *other = self.numbers.of_object(*other);
                }
                _ => {}
            }
        }
        Told {
            index,
            name: name.to_owned(),
            outlines,
            events,
            given: BTreeSet::new(),
            broken,
            missing: 0,
            masked: 0,
        }
    }
}

/// How many pixels of a picture do not count.
fn masked(picture: &Picture) -> usize {
    let valid = picture.valid();
    valid.map_or(0, |valid| valid.iter().filter(|ok| !**ok).count())
}

fn seen(told: &Told) -> BTreeSet<u32> {
    let seen = told.outlines.iter().filter(|one| one.state.is_seen());
    seen.map(|one| one.id).collect()
}

/// Shares of the length of an outline, one for each node.
fn shares(count: usize) -> Vec<f64> {
    let share = 1.0 / count.max(1) as f64;
    (0..count).map(|i| i as f64 * share).collect()
}

/// An outline that is given, where the object was not followed.
fn of_fact(fact: &Tracked) -> Outline {
    Outline {
        id: fact.id,
        parent: None,
        points: fact.points.clone(),
        material: shares(fact.points.len()),
        errors: vec![0.0; fact.points.len()],
        state: State::Seen,
        confidence: 1.0,
        velocity: glam::DVec2::ZERO,
        rotation: 0.0,
        prediction: ::track::Prediction::Still,
    }
}
