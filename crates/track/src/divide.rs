//! Objects that divide, and divisions that are undone.

use fit::{Contour, Image};
use glam::DVec2;

use crate::body::Body;
use crate::neck::neck;
use crate::region::{Rectangle, Region, filled, regions};
use crate::ring;
use crate::start::{begun, overlap};
use crate::step::{Frame, Step};
use crate::tracker::{Object, Tracker};
use crate::view::View;
use crate::{Event, Happening, Start, State};

/// Two parts are children if each has this share of the object's area, and both together all but this share.
const PART: f64 = 0.2;
const LOST: f64 = 0.25;

/// Which share of a part must lie where the object is or was.
const WITHIN: f64 = 0.5;

/// How far beyond the object parts are looked for, in radii.
const BEYOND: f64 = 0.6;

/// An object divides if it was one region so many frames ago or less.
const LATELY: usize = 2;

/// A division that does not last so many frames is undone.
const FRAMES: usize = 2;

/// An outline found about a region is taken if it shares this much with it.
const NEARLY: f64 = 0.75;

/// A neck is shorter than this, over the square root of the area.
const NECK: f64 = 0.35;

/// An outline whose neck is longer than this has none; an object is surely seen from this confidence on.
const NO_NECK: f64 = 0.65;
const SURE: f64 = 0.85;

/// Parts that touch are two if the level between them is so much lower, as a share of their middle level; and two that
/// have become one if it is nowhere lower by this.
const DIP: f32 = 0.35;
const NO_DIP: f32 = 0.15;

/// A division that may still be undone.
#[derive(Debug, Clone)]
pub(crate) struct Division {
    parent: Object,
    children: [u32; 2],
    frame: usize,
}

/// The body of an object that a region shows.
pub(crate) fn embodied(
    image: &Image,
    now: Frame<'_>,
    view: &View,
    region: &Region,
    options: &fit::Options,
) -> Option<Body> {
    let traced = view.to_pixels(&region.outline());
    if traced.len() < 3 {
        return None;
    }
    let start = Contour::closed(traced.clone());
    let found = (!region.at_border)
        .then(|| begun(image, &start, Start::Rough, options).ok())
        .flatten()
        .filter(|found| found.points.len() > 2 && overlap(&found.points, &traced) > NEARLY);
    Body::new(now, &found.map_or(traced, |found| found.points))
}

/// The two parts of a region with a neck that is darker (or otherwise more like the ground) than they are.
fn necked(whole: &Region, view: &View) -> Option<[Region; 2]> {
    let curve = whole.outline();
    let neck = neck(&curve, PART).filter(|neck| neck.narrow < NECK)?;
    let [from, to] = neck.ends.map(|end| curve[end]);
    let usual = view.middle_level(&whole.cells);
    if view.extreme(from, to, true) > (1.0 - DIP) * usual {
        return None;
    }
    let parts = whole.split(from, to);
    let least = PART * whole.cells.len() as f64;
    parts
        .iter()
        .all(|part| part.cells.len() as f64 >= least)
        .then_some(parts)
}

/// Whether an object without a neck is seen as it was: then what cuts it is part of it.
fn is_one(object: &Object) -> bool {
    let step = &object.step;
    step.state == State::Seen
        && step.confidence > SURE
        && neck(&object.body.outline(), PART).is_none_or(|neck| neck.narrow > NO_NECK)
}

impl Tracker {
    /// Objects that are two closed regions now divide.
    pub(crate) fn divide(
        &mut self,
        image: &Image,
        now: Frame<'_>,
        view: &mut View,
        events: &mut Vec<Event>,
    ) {
        let mut index = 0;
        while index < self.objects.len() {
            let parts = self.parts(index, view);
            // what texture alone cuts is cut in all frames
            let object = &mut self.objects[index];
            let lately = object.whole.is_some_and(|t| t + LATELY >= self.frame);
            if matches!(parts.as_slice(), [one] if view.fills(one, &object.body.outline())) {
                object.whole = Some(self.frame);
            }
            let whole = lately && !is_one(object);
            let parts = if whole { parts } else { Vec::new() };
            let bodies = self.halves(index, view, parts).and_then(|[a, b]| {
                let body = |part| embodied(image, now, view, part, &self.options.fit);
                Some([body(&a)?, body(&b)?])
            });
            let Some(bodies) = bodies else {
                index += 1;
                continue;
            };
            let Some(bodies) = self.part_again(index, bodies, view, events) else {
                index += 1;
                continue;
            };
            let parent = self.objects[index].clone();
            let children = [self.next_id, self.next_id + 1];
            self.next_id += 2;
            let frame = self.frame;
            let mut say = |id, what| {
                events.push(Event {
                    frame,
                    id,
                    what,
                    confidence: 1.0,
                });
            };
            say(parent.id, Happening::Divided(children));
            children.iter().for_each(|id| say(*id, Happening::Born));
            let made = bodies
                .into_iter()
                .zip(children)
                .map(|(body, id)| Object::new(id, Some(parent.id), body, frame));
            // the first takes the place of the parent, so that the covers of the view stay those of their objects
            let mut made: Vec<Object> = made.collect();
            let second = made.pop();
            for owner in &mut view.owner {
                if *owner == index + 1 {
                    *owner = 0;
                }
            }
            self.objects.splice(index..=index, made);
            self.objects.extend(second);
            for place in [index, self.objects.len() - 1] {
                view.cover(place + 1, &self.objects[place].body.outline());
            }
            self.divisions.push(Division {
                parent,
                children,
                frame,
            });
            index += 1;
        }
    }

    /// An object and one that it has hidden are the two parts; else these are given back.
    fn part_again(
        &mut self,
        index: usize,
        bodies: [Body; 2],
        view: &mut View,
        events: &mut Vec<Event>,
    ) -> Option<[Body; 2]> {
        let id = self.objects[index].id;
        let hidden = |object: &Object| object.met == Some(id) && !object.step.state.is_seen();
        let listed = self.objects.iter().position(hidden);
        let grave = self.graves.iter().position(|object| object.met == Some(id));
        let place = match (listed, grave) {
            (Some(at), _) => at,
            (None, Some(at)) => {
                let object = self.graves.remove(at);
                self.objects.push(object);
                self.objects.len() - 1
            }
            (None, None) => return Some(bodies),
        };
        let last = ring::middle(&self.objects[place].body.outline());
        let far = |body: &Body| ring::middle(&body.outline()).distance(last);
        let [a, b] = bodies;
        let (own, other) = if far(&a) < far(&b) { (b, a) } else { (a, b) };
        for (at, body) in [(index, own), (place, other)] {
            for owner in &mut view.owner {
                if *owner == at + 1 {
                    *owner = 0;
                }
            }
            let object = &mut self.objects[at];
            object.body = body;
            object.step = Step::begun();
            (object.unseen, object.gone, object.met) = (0, 0, None);
        }
        for at in [index, place] {
            view.cover(at + 1, &self.objects[at].body.outline());
        }
        events.push(Event {
            frame: self.frame,
            id: self.objects[place].id,
            what: Happening::Found,
            confidence: 1.0,
        });
        None
    }

    /// The large regions that lie where an object is or was.
    fn parts(&self, index: usize, view: &View) -> Vec<Region> {
        let object = &self.objects[index];
        if object.step.state == State::Left {
            return Vec::new();
        }
        let before = view.to_cells(&object.last);
        let here = view.to_cells(&object.body.outline());
        let mut cells: Vec<usize> = Vec::new();
        filled(view.size, &before, |at| cells.push(at));
        let area = cells.len() as f64;
        let margin = BEYOND * ring::radius(&before);
        let both: Vec<DVec2> = before.iter().chain(&here).copied().collect();
        let rectangle = Rectangle::about(&both, margin, view.size);
        let own = index + 1;
        let mut parts = regions(view.size, rectangle, |at| {
            view.like[at] && (view.owner[at] == 0 || view.owner[at] == own)
        });
        parts.retain(|part| part.cells.len() as f64 >= PART * area);
        filled(view.size, &here, |at| cells.push(at));
        cells.sort_unstable();
        parts.retain(|part| {
            let within = part
                .cells
                .iter()
                .filter(|at| cells.binary_search(at).is_ok());
            within.count() as f64 >= WITHIN * part.cells.len() as f64
        });
        parts
    }

    /// The two of them that an object has become.
    fn halves(&self, index: usize, view: &View, mut parts: Vec<Region>) -> Option<[Region; 2]> {
        let mut area = 0.0;
        filled(view.size, &view.to_cells(&self.objects[index].last), |_| {
            area += 1.0;
        });
        let sum: usize = parts.iter().map(|part| part.cells.len()).sum();
        let fits = (sum as f64 / area - 1.0).abs() <= LOST;
        if let [whole] = parts.as_slice() {
            parts = necked(whole, view)?.to_vec();
        }
        let parts: [Region; 2] = parts.try_into().ok()?;
        fits.then_some(parts)
    }

    /// Divisions whose children are not two objects in the frames after are undone.
    pub(crate) fn reunite(
        &mut self,
        image: &Image,
        now: Frame<'_>,
        view: &mut View,
        events: &mut Vec<Event>,
    ) {
        let frame = self.frame;
        for division in std::mem::take(&mut self.divisions) {
            let places = division
                .children
                .map(|id| self.objects.iter().position(|object| object.id == id));
            let [Some(a), Some(b)] = places else {
                continue;
            };
            let Some(body) = self.joined([a, b], image, now, view) else {
                if frame < division.frame + FRAMES {
                    self.divisions.push(division);
                }
                continue;
            };
            let mut parent = division.parent;
            for id in division.children {
                events.push(Event {
                    frame,
                    id,
                    what: Happening::Merged(parent.id),
                    confidence: 1.0,
                });
            }
            events.push(Event {
                frame,
                id: parent.id,
                what: Happening::Found,
                confidence: 1.0,
            });
            parent.body = body;
            parent.step = Step::begun();
            parent.unseen = 0;
            self.objects[a] = parent;
            self.objects.remove(b);
            view.owner.iter_mut().for_each(|owner| {
                if *owner == b + 1 {
                    *owner = 0;
                } else if *owner > b + 1 {
                    *owner -= 1;
                }
            });
            let a = if b < a { a - 1 } else { a };
            view.cover(a + 1, &self.objects[a].body.outline());
        }
    }

    /// The body of two children that are one region.
    fn joined(
        &self,
        [a, b]: [usize; 2],
        image: &Image,
        now: Frame<'_>,
        view: &View,
    ) -> Option<Body> {
        let outlines = [a, b].map(|at| view.to_cells(&self.objects[at].body.outline()));
        let both: Vec<DVec2> = outlines.iter().flatten().copied().collect();
        let radius = ring::radius(&outlines[0]).max(ring::radius(&outlines[1]));
        let rectangle = Rectangle::about(&both, BEYOND * radius, view.size);
        let owners = [0, a + 1, b + 1];
        let mine = |at: usize| view.like[at] && owners.contains(&view.owner[at]);
        let largest = regions(view.size, rectangle, mine)
            .into_iter()
            .max_by_key(|region| region.cells.len())?;
        let of = |own: usize| {
            let all = |at: &&usize| view.owner[**at] == own;
            let here = largest.cells.iter().filter(all).count();
            here as f64
        };
        let seen = [a, b].map(|at| self.objects[at].step.state.is_seen());
        let areas = outlines
            .iter()
            .map(|outline| elastic::signed_area(outline).abs());
        let shares: Vec<f64> = areas
            .zip([a, b])
            .map(|(area, at)| of(at + 1) / area)
            .collect();
        let [from, to] = [&outlines[0], &outlines[1]].map(|outline| ring::middle(outline));
        let usual = view.middle_level(&largest.cells);
        let one_region = shares.iter().all(|share| *share > WITHIN)
            && view.extreme(from, to, false) > (1.0 - NO_DIP) * usual;
        let one_only = seen[0] != seen[1];
        (one_region || one_only)
            .then(|| embodied(image, now, view, &largest, &self.options.fit))
            .flatten()
    }
}
