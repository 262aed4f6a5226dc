//! How an outline was found, as an animation; how a curve moved, as a record.

use std::borrow::Cow;

use glam::DVec2;
use io::paint::{Animation, Stroke};
use io::record::{Curve, Ending, Frame, Record};
use io::{IoError, Picture};
use scene::fit::{Choices, Fit, Session};
use scene::snake::Outcome;

use super::one::Found;
use super::overlay::{FOUND, START, UNSURE};
use crate::crop::Crop;

/// Moments kept of a motion at most; from then on only every second one.
const MOST: usize = 1000;

/// Side of an animation, and how many moments of a motion it shows at most.
const SIDE: u32 = 480;
const MOST_SHOWN: usize = 120;

/// For how long, in hundredths of a second: a curve of a search, a moment of a motion, the outline.
const SEARCHED: u16 = 90;
const MOVING: u16 = 6;
const ENDING: u16 = 250;

/// Colors by their numbers, with that of a curve on the way.
const COLORS: [[u8; 3]; 4] = [START, [240, 228, 66], FOUND, UNSURE];
const WIDTH: f64 = 2.0;

/// A curve on its way.
#[derive(Debug, Clone)]
pub(super) struct Moment {
    step: u64,
    t: f64,
    nodes: Vec<DVec2>,
}

/// The moments of a motion, as many as memory has room for: the start, and after equally many steps.
#[derive(Debug, Clone)]
pub(super) struct Moments {
    list: Vec<Moment>,
    every: u64,
}

impl Moments {
    /// Keep every moment at first.
    pub(super) const fn new() -> Self {
        Self {
            list: Vec::new(),
            every: 1,
        }
    }

    /// Keep the moment if it is due, or if it is the last.
    pub(super) fn see(&mut self, session: &Session, last: bool) {
        let step = session.steps();
        let kept = self.list.last().is_some_and(|last| last.step == step);
        if kept || (!step.is_multiple_of(self.every) && !last) {
            return;
        }
        self.list.push(Moment {
            step,
            t: session.simulation().t(),
            nodes: session.nodes().to_vec(),
        });
        if self.list.len() > MOST && !last {
            self.every *= 2;
            let every = self.every;
            self.list.retain(|moment| moment.step.is_multiple_of(every));
        }
    }
}

/// The motion of a fit as `snake run` writes one; None where no motion was watched.
pub(super) fn record(found: &Found, name: &str, title: &str) -> Option<Record<'static>> {
    let (moments, fit) = (found.moments.as_ref()?, found.fit.as_ref()?);
    let Choices::Motion(moved) = &fit.chosen else {
        return None;
    };
    let closed = fit.contour.closed;
    let curve = |nodes: &[DVec2]| Curve {
        id: 0,
        closed,
        nodes: nodes.to_vec(),
        velocities: None,
    };
    let frame = |moment: &Moment| Frame {
        step: moment.step,
        t: moment.t,
        curves: Cow::Owned(vec![curve(&moment.nodes)]),
        energies: None,
    };
    let (node, at) = match fit.outcome {
        Outcome::Diverged { node, .. } => (Some(node), None),
        Outcome::LeftField { node, at, .. } => (Some(node), Some(at)),
        _ => (None, None),
    };
    Some(Record {
        scene: name.to_owned(),
        title: title.to_owned(),
        scheme: moved.scheme.to_owned(),
        dt: moved.step,
        closed,
        terms: Vec::new(),
        frames: moments.list.iter().map(frame).collect(),
        events: Vec::new(),
        ending: Ending {
            word: fit.outcome.name().to_owned(),
            sentence: fit.outcome.to_string(),
            step: fit.steps,
            node,
            at,
        },
    })
}

/// A curve of a frame, in the picture, and the number of its color.
type Drawn<'a> = (&'a [DVec2], bool, usize);

/// How the outlines of a picture were found, one after the other.
pub(super) fn film(picture: &Picture, found: &[Found]) -> Result<Vec<u8>, IoError> {
    let points = found.iter().flat_map(|one| {
        let outline = one.shape.iter().flat_map(|shape| shape.first());
        let on_the_way = curves(one.fit.as_ref()).iter().flatten();
        one.start
            .first()
            .iter()
            .chain(outline)
            .chain(on_the_way)
            .copied()
    });
    let crop = Crop::about(picture, points, SIDE);
    let mut animation = Animation::over(&crop.image, &COLORS)?;
    let mut show = |drawn: &[Drawn<'_>], hold: u16| {
        let placed: Vec<Vec<DVec2>> = drawn.iter().map(|one| crop.place(one.0)).collect();
        let strokes: Vec<Stroke<'_>> = placed
            .iter()
            .zip(drawn)
            .map(|(nodes, &(_, closed, color))| Stroke {
                nodes,
                closed,
                color,
            })
            .collect();
        animation.show(&strokes, WIDTH, hold)
    };
    let mut done: Vec<Drawn<'_>> = Vec::new();
    for one in found {
        let start = (one.start.first(), one.start.closed == Some(true), 0);
        let closed = one.fit.as_ref().is_some_and(|fit| fit.contour.closed);
        show(&[&done[..], &[start]].concat(), SEARCHED)?;
        for curve in curves(one.fit.as_ref()) {
            show(
                &[&done[..], &[start, (curve, closed, 1)]].concat(),
                SEARCHED,
            )?;
        }
        let moments = one
            .moments
            .as_ref()
            .map_or(&[][..], |moments| &moments.list);
        for moment in moments
            .iter()
            .step_by(moments.len().div_ceil(MOST_SHOWN).max(1))
        {
            show(
                &[&done[..], &[start, (&moment.nodes, closed, 1)]].concat(),
                MOVING,
            )?;
        }
        if let Some(taken) = taken(one.fit.as_ref()) {
            show(
                &[&done[..], &[start, (taken, closed, 2)]].concat(),
                SEARCHED,
            )?;
        }
        if let Some(shape) = &one.shape {
            let color = if one.unsure.is_some() { 3 } else { 2 };
            done.push((shape.first(), shape.closed == Some(true), color));
        }
    }
    let starts = found
        .iter()
        .map(|one| (one.start.first(), one.start.closed == Some(true), 0));
    let all: Vec<Drawn<'_>> = starts.chain(done.iter().copied()).collect();
    show(&all, ENDING)?;
    animation.end()
}

/// The curves that the searches found.
fn curves(fit: Option<&Fit>) -> &[Vec<DVec2>] {
    match fit.map(|fit| &fit.chosen) {
        Some(Choices::Search(search)) => &search.curves,
        _ => &[],
    }
}

/// The one of them that was taken.
fn taken(fit: Option<&Fit>) -> Option<&[DVec2]> {
    match fit.map(|fit| &fit.chosen) {
        Some(Choices::Search(search)) => search.curves.get(search.taken?).map(Vec::as_slice),
        _ => None,
    }
}
