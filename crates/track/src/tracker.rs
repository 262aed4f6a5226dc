//! Objects followed together through frames.

use fit::{Contour, Image};
use flow::Pyramid;
use glam::DVec2;
use ndarray::Array2;

use crate::body::{Body, Frame, Step};
use crate::ring;
use crate::start::begun;
use crate::{Event, Happening, Options, Outline, Prediction, State, TrackError, Tracked};

/// How often a frame is halved for flow.
const SIZES: usize = 5;

/// Objects that are followed.
#[derive(Debug)]
pub struct Tracker {
    options: Options,
    size: (usize, usize),
    frame: usize,
    next_id: u32,
    objects: Vec<Object>,
    before: Pyramid,
    first: Tracked,
}

/// An object with its number.
#[derive(Debug)]
struct Object {
    id: u32,
    parent: Option<u32>,
    body: Body,
    state: State,
    /// For how many frames it was not seen.
    unseen: u32,
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
        let mut tracker = Self {
            options: options.clone(),
            size: frame.size(),
            frame: 0,
            next_id: 1,
            objects: Vec::new(),
            before: pyramid(frame),
            first: Tracked {
                frame: 0,
                outlines: Vec::new(),
                events: Vec::new(),
            },
        };
        let mut all = Vec::new();
        fit::in_order(
            starts,
            options.threads,
            |start| begun(frame, start, options.start, &options.fit),
            |index, found| all.push((index, found)),
        );
        for (index, found) in all {
            let points = found.map_err(|error| TrackError::Fit { index, error })?;
            let (width, height) = tracker.size;
            let now = Frame {
                pixels: frame.pixels(),
                pyramid: &tracker.before,
                before: None,
            };
            let body = Body::new(now, &points).ok_or(TrackError::Start {
                index,
                width,
                height,
            })?;
            tracker.add(body, None, Happening::Begun);
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
        let pyramid = pyramid(frame);
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
        let work = |&index: &usize| {
            let mut body = bodies[index].clone();
            let step = body.follow(now, &predicted[index], &beside(&expected, index));
            (body, step)
        };
        let order: Vec<usize> = (0..bodies.len()).collect();
        fit::in_order(&order, threads, work, |_, answer| followed.push(answer));
        let mut tracked = Tracked {
            frame: self.frame,
            outlines: Vec::new(),
            events: Vec::new(),
        };
        for (object, (body, step)) in self.objects.iter_mut().zip(followed) {
            object.body = body;
            let sure = step.confidence.clamp(0.0, 1.0);
            let (was, is) = (object.state, step.state);
            object.state = is;
            let mut say = |what, confidence| {
                tracked.events.push(Event {
                    frame: self.frame,
                    id: object.id,
                    what,
                    confidence,
                });
            };
            if was != State::Left && is == State::Left {
                say(Happening::Left, 1.0);
            } else if was.is_seen() && is == State::Coasting {
                say(Happening::Hidden, 1.0 - sure);
            } else if !was.is_seen() && is.is_seen() {
                say(Happening::Found, sure);
            }
            object.unseen = if is.is_seen() { 0 } else { object.unseen + 1 };
            if object.unseen > self.options.patience {
                say(Happening::Lost, 1.0);
            } else if is != State::Left {
                tracked.outlines.push(object.outline(&step));
            }
        }
        self.objects
            .retain(|object| object.unseen <= self.options.patience);
        self.before = pyramid;
        Ok(tracked)
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
            object.state = step.state;
            object.unseen += 1;
            if object.state != State::Left {
                tracked.outlines.push(object.outline(&step));
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

    /// Set the outline of an object in the last frame, by hand: tracking goes on from there.
    ///
    /// # Errors
    ///
    /// No such object; an outline without area in the frame; a frame of another size.
    pub fn mend(&mut self, frame: &Image, id: u32, outline: &[DVec2]) -> Result<Event, TrackError> {
        let (needed, got) = (self.size, frame.size());
        if needed != got {
            return Err(TrackError::Size {
                frame: self.frame,
                needed,
                got,
            });
        }
        let known = self.objects.iter().map(|object| object.id).collect();
        let (width, height) = self.size;
        let Some(object) = self.objects.iter_mut().find(|object| object.id == id) else {
            return Err(TrackError::NoObject { id, known });
        };
        let now = Frame {
            pixels: frame.pixels(),
            pyramid: &self.before,
            before: None,
        };
        object.body = Body::new(now, outline).ok_or(TrackError::Start {
            index: 0,
            width,
            height,
        })?;
        (object.unseen, object.state) = (0, State::Seen);
        Ok(Event {
            frame: self.frame,
            id,
            what: Happening::Mended,
            confidence: 1.0,
        })
    }

    fn add(&mut self, body: Body, parent: Option<u32>, what: Happening) {
        let id = self.next_id;
        self.next_id += 1;
        let object = Object {
            id,
            parent,
            body,
            state: State::Seen,
            unseen: 0,
        };
        let step = Step {
            prediction: Prediction::Still,
            confidence: 1.0,
            state: State::Seen,
        };
        self.first.outlines.push(object.outline(&step));
        self.first.events.push(Event {
            frame: 0,
            id,
            what,
            confidence: 1.0,
        });
        self.objects.push(object);
    }
}

impl Object {
    fn outline(&self, step: &Step) -> Outline {
        let points = self.body.outline();
        let (velocity, rotation) = self.body.velocity();
        Outline {
            id: self.id,
            parent: self.parent,
            material: self.body.material().to_vec(),
            errors: self.body.errors(),
            points,
            state: step.state,
            confidence: step.confidence,
            velocity,
            rotation,
            prediction: step.prediction,
        }
    }
}

/// The outlines of other objects that lie near one.
fn beside(all: &[Vec<DVec2>], index: usize) -> Vec<Vec<DVec2>> {
    let (low, high) = ring::bounds(&all[index]);
    let reach = high - low;
    let near = |other: &[DVec2]| {
        let (least, most) = ring::bounds(other);
        least.cmple(high + reach).all() && most.cmpge(low - reach).all()
    };
    let others = all
        .iter()
        .enumerate()
        .filter(|(other, outline)| *other != index && near(outline));
    others.map(|(_, outline)| outline.clone()).collect()
}

/// A frame as flow sees it.
#[allow(
    clippy::cast_possible_truncation,
    reason = "levels in f32 are enough for flow"
)]
fn pyramid(frame: &Image) -> Pyramid {
    let pixels = frame.pixels();
    let (width, height) = pixels.size();
    let levels = Array2::from_shape_fn((height, width), |(y, x)| {
        let level = pixels.level(x, y) as f32;
        if level.is_finite() { level } else { 0.0 }
    });
    Pyramid::of(levels, SIZES)
}
