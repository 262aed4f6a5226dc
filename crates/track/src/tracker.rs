//! Objects followed together through frames.

use std::collections::{BTreeMap, BTreeSet};

use fit::{Contour, Image};
use flow::Pyramid;
use glam::DVec2;

use crate::assign::beside;
use crate::body::Body;
use crate::contact;
use crate::crowd::Crowd;
use crate::divide::Division;
use crate::ring;
use crate::start::begun;
use crate::step::{Frame, Step};
use crate::{Event, Happening, Options, Outline, Prediction, State, TrackError, Tracked};
use crate::{holes, light};

/// The most confidence in a start where no outline was found.
const DOUBTFUL: f64 = 0.3;

/// Objects that are followed. A copy goes on as the original does.
#[derive(Debug, Clone)]
pub struct Tracker {
    pub(crate) options: Options,
    pub(crate) size: (usize, usize),
    pub(crate) frame: usize,
    pub(crate) next_id: u32,
    pub(crate) objects: Vec<Object>,
    pub(crate) before: Pyramid,
    first: Tracked,
    /// What all look like, where objects may divide and be born.
    pub(crate) crowd: Option<Crowd>,
    /// Divisions that may be undone.
    pub(crate) divisions: Vec<Division>,
    /// Objects that have ended and may come back.
    pub(crate) graves: Vec<Object>,
    /// Pairs of objects that cover each other, for how many frames, and the way between them to begin with.
    pub(crate) together: BTreeMap<[u32; 2], (u32, DVec2)>,
    /// Pairs of objects that have covered each other and have not parted since.
    pub(crate) covered: BTreeSet<[u32; 2]>,
}

/// An object with its number.
#[derive(Debug, Clone)]
pub(crate) struct Object {
    pub id: u32,
    pub parent: Option<u32>,
    pub body: Body,
    /// What the last frame has said.
    pub step: Step,
    /// For how many frames it was not seen, and for how many its place was empty.
    pub unseen: u32,
    pub gone: u32,
    /// In which frame it came, and whether the border of the frame cuts it since.
    pub since: usize,
    pub cut: bool,
    /// The object that covered it when it was seen last.
    pub met: Option<u32>,
    /// In which frame all of it looked like objects last.
    pub whole: Option<usize>,
    /// Its outline in the frame before. Pixels.
    pub last: Vec<DVec2>,
}

impl Tracker {
    /// Begin with the first frame and the outlines in it. A start of one point is a click inside the object.
    ///
    /// # Errors
    ///
    /// No start; one that encloses nothing in the frame.
    pub fn new(frame: &Image, starts: &[Contour], options: &Options) -> Result<Self, TrackError> {
        if starts.is_empty() {
            return Err(TrackError::NoStart);
        }
        let frame = &holes::filled(frame);
        let mut tracker = Self {
            options: options.clone(),
            size: frame.size(),
            frame: 0,
            next_id: 1,
            objects: Vec::new(),
            before: light::pyramid(frame),
            first: Tracked {
                frame: 0,
                outlines: Vec::new(),
                events: Vec::new(),
            },
            crowd: None,
            divisions: Vec::new(),
            graves: Vec::new(),
            together: BTreeMap::new(),
            covered: BTreeSet::new(),
        };
        let mut all = Vec::new();
        fit::in_order(
            starts,
            options.threads,
            |start| begun(frame, start, options.start, &options.fit),
            |index, found| all.push((index, found)),
        );
        for (index, found) in all {
            let found = found.map_err(|error| TrackError::Fit { index, error })?;
            let (width, height) = tracker.size;
            let now = Frame {
                pixels: frame.pixels(),
                pyramid: &tracker.before,
                before: None,
            };
            let body = Body::new(now, &found.points)
                .or_else(|| Body::new(now, &starts[index].points))
                .ok_or(TrackError::Start {
                    index,
                    width,
                    height,
                })?;
            tracker.add(body, found.doubtful);
        }
        if options.births {
            let outlines = tracker.outlines();
            let outlines: Vec<&[DVec2]> = outlines.iter().map(Vec::as_slice).collect();
            tracker.crowd = Crowd::of(frame.pixels(), &outlines);
        }
        Ok(tracker)
    }

    /// The outlines of the first frame, and that they have begun.
    #[must_use]
    pub const fn first(&self) -> &Tracked {
        &self.first
    }

    /// Follow all objects into the next frame.
    ///
    /// # Errors
    ///
    /// A frame of another size: nothing has changed then.
    pub fn next(&mut self, frame: &Image) -> Result<Tracked, TrackError> {
        let (needed, got) = (self.size, frame.size());
        if needed != got {
            return Err(TrackError::Size {
                frame: self.frame + 1,
                needed,
                got,
            });
        }
        self.frame += 1;
        let (frame, pyramid) = light::levelled(&self.before, &holes::filled(frame));
        let frame = &frame;
        let now = Frame {
            pixels: frame.pixels(),
            pyramid: &pyramid,
            before: Some(&self.before),
        };
        let bodies: Vec<&Body> = self.objects.iter().map(|object| &object.body).collect();
        let threads = self.options.threads;
        let mut predicted = Vec::with_capacity(bodies.len());
        fit::in_order(
            &bodies,
            threads,
            |body| body.predict(now),
            |_, answer| predicted.push(answer),
        );
        let expected: Vec<Vec<DVec2>> = bodies
            .iter()
            .zip(&predicted)
            .map(|(body, predicted)| body.to_pixels(predicted.expected()))
            .collect();
        let mut followed = Vec::with_capacity(bodies.len());
        let births = self.crowd.is_some();
        let work = |&index: &usize| {
            let mut body = bodies[index].clone();
            // where new objects are looked for, one that has left comes back as one of them
            let step = if births && body.left {
                body.coast(Some(now.pixels), Prediction::Flown, 0.0)
            } else {
                body.follow(now, &predicted[index], &beside(&expected, index))
            };
            (body, step)
        };
        let order: Vec<usize> = (0..bodies.len()).collect();
        fit::in_order(&order, threads, work, |_, answer| followed.push(answer));
        self.compete(now, &predicted, &expected, &mut followed);
        let mut events = Vec::new();
        for (object, (body, step)) in self.objects.iter_mut().zip(followed) {
            object.last = object.body.outline();
            object.body = body;
            if step.state.is_seen() {
                let middle = ring::middle(&object.body.curve);
                object.body.seen_in = Some((frame.clone(), middle));
            }
            let was = std::mem::replace(&mut object.step, step).state;
            let (is, sure) = (object.step.state, object.step.confidence.clamp(0.0, 1.0));
            let said = if was != State::Left && is == State::Left {
                Some((Happening::Left, 1.0))
            } else if was.is_seen() && is == State::Coasting {
                Some((Happening::Hidden, 1.0 - sure))
            } else if !was.is_seen() && is.is_seen() {
                Some((Happening::Found, sure))
            } else {
                None
            };
            let remeshed = object.step.remeshed.then_some((Happening::Remeshed, 1.0));
            events.extend(
                said.into_iter()
                    .chain(remeshed)
                    .map(|(what, confidence)| Event {
                        frame: self.frame,
                        id: object.id,
                        what,
                        confidence,
                    }),
            );
            object.unseen = if is.is_seen() { 0 } else { object.unseen + 1 };
        }
        self.meet();
        let now = Frame {
            before: None,
            pixels: frame.pixels(),
            pyramid: &pyramid,
        };
        self.come_and_go(frame, now, &mut events);
        self.mix(now, &mut events);
        self.merge(&mut events);
        self.give_up(&mut events);
        self.before = pyramid;
        let seen = self
            .objects
            .iter()
            .filter(|object| object.step.state != State::Left);
        let mut outlines: Vec<Outline> = seen.map(Object::outline).collect();
        outlines.sort_by_key(|outline| outline.id);
        contact::parted(&mut outlines);
        Ok(Tracked {
            frame: self.frame,
            outlines,
            events,
        })
    }

    /// Objects divide, come and go, if they may.
    fn come_and_go(&mut self, image: &Image, now: Frame<'_>, events: &mut Vec<Event>) {
        let outlines = self.outlines();
        let outlines: Vec<&[DVec2]> = outlines.iter().map(Vec::as_slice).collect();
        let taught: Vec<bool> = self
            .objects
            .iter()
            .map(|object| object.step.state == State::Seen)
            .collect();
        let Some(crowd) = &mut self.crowd else {
            return;
        };
        let Some(mut view) = crowd.view(image.pixels(), &outlines, &taught) else {
            return;
        };
        self.reunite(image, now, &mut view, events);
        self.divide(image, now, &mut view, events);
        self.grow(image, now, &mut view);
        self.bear(image, now, &mut view, events);
        self.bury(&view, events);
        self.objects.retain(|object| object.id > 0);
    }

    /// Objects that were not seen for too long end.
    fn give_up(&mut self, events: &mut Vec<Event>) {
        let (frame, patience) = (self.frame, self.options.patience);
        let lost = self.objects.iter().filter(|one| one.unseen > patience);
        events.extend(lost.map(|object| Event {
            frame,
            id: object.id,
            what: Happening::Lost,
            confidence: 1.0,
        }));
        self.objects.retain(|object| object.unseen <= patience);
    }

    /// The outlines of all objects. Pixels.
    pub(crate) fn outlines(&self) -> Vec<Vec<DVec2>> {
        let outlines = self.objects.iter().map(|object| object.body.outline());
        outlines.collect()
    }

    /// Go on without a frame that cannot be read: all objects go on as they were going.
    pub fn skip(&mut self) -> Tracked {
        self.frame += 1;
        let mut tracked = Tracked {
            frame: self.frame,
            outlines: Vec::new(),
            events: Vec::new(),
        };
        for object in &mut self.objects {
            let step = object.body.coast(None, Prediction::Flown, 0.0);
            object.step = step;
            object.unseen += 1;
            if object.step.state != State::Left {
                tracked.outlines.push(object.outline());
            }
            let (frame, id) = (self.frame, object.id);
            tracked.events.push(Event {
                frame,
                id,
                what: Happening::Skipped,
                confidence: 1.0,
            });
        }
        tracked
    }

    fn add(&mut self, body: Body, doubtful: bool) {
        let mut object = Object::new(self.next_id, None, body, 0);
        let most = if doubtful { DOUBTFUL } else { 1.0 };
        let sure = object.body.clear.min(most);
        object.step.confidence = sure;
        self.next_id += 1;
        self.first.outlines.push(object.outline());
        self.first.events.push(Event {
            frame: 0,
            id: object.id,
            what: Happening::Begun,
            confidence: sure,
        });
        self.objects.push(object);
    }
}

impl Object {
    /// An object that comes in a frame.
    pub(crate) fn new(id: u32, parent: Option<u32>, body: Body, since: usize) -> Self {
        Self {
            id,
            parent,
            last: body.outline(),
            body,
            step: Step::begun(),
            unseen: 0,
            gone: 0,
            since,
            cut: false,
            met: None,
            whole: None,
        }
    }

    fn outline(&self) -> Outline {
        let step = &self.step;
        let points = self.body.outline();
        let (velocity, rotation) = self.body.velocity();
        Outline {
            id: self.id,
            parent: self.parent,
            material: self.body.material().to_vec(),
            errors: self.body.errors(),
            points,
            state: step.state,
            confidence: if step.confidence.is_finite() {
                step.confidence.clamp(0.0, 1.0)
            } else {
                0.0
            },
            velocity,
            rotation,
            prediction: step.prediction,
        }
    }
}
