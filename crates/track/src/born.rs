//! Objects that were not there before, that come back, and that are no more.

use fit::Image;
use glam::DVec2;

use crate::body::Body;
use crate::divide::embodied;
use crate::region::{Rectangle, Region, grown, regions};
use crate::ring;
use crate::step::{Frame, Step};
use crate::tracker::{Object, Tracker};
use crate::view::View;
use crate::{Event, Happening, State};

/// The least area of a new object, of that of the middle one; and where the border of the frame cuts it.
const AREA: f64 = 0.25;
const CUT_AREA: f64 = 0.1;

/// The least depth of a new object, of the radius of the middle one; and where the border cuts it.
const DEPTH: f64 = 0.3;
const CUT_DEPTH: f64 = 0.2;

/// There are new objects only if they are this share of what looks like them and is known to be none.
const MOSTLY: f64 = 0.5;

/// New objects are not looked for within so many cells of those that are known.
const BESIDE: usize = 2;

/// For so many frames an object grows into what it hangs together with, beyond this share more, up to so many times.
const YOUNG: usize = 8;
const GROWN: f64 = 1.12;
const MOST: f64 = 2.5;

/// An object that is not seen is gone if less than this share of its place looks like objects, for so many frames.
const EMPTY: f64 = 0.25;
const GONE: u32 = 2;

/// An object is at its place again within so many radii, and so many more for every frame; its area is within these.
const PLACE: f64 = 1.5;
const FARTHER: f64 = 0.15;
const SIZES: [f64; 2] = [0.4, 2.5];

/// Least confidence of an object whose place does not look like objects.
const SURE: f64 = 0.5;

impl Tracker {
    /// What looks like objects and belongs to none is a new one, or one that comes back.
    pub(crate) fn bear(
        &mut self,
        image: &Image,
        now: Frame<'_>,
        view: &mut View,
        events: &mut Vec<Event>,
    ) {
        let covered: Vec<bool> = view.owner.iter().map(|own| *own > 0).collect();
        let covered = grown(view.size, &covered, BESIDE);
        let all = Rectangle {
            left: 0,
            top: 0,
            right: view.size.0,
            bottom: view.size.1,
        };
        let area = self.crowd.as_ref().map_or(0.0, |crowd| crowd.area);
        let radius = (area / std::f64::consts::PI).sqrt();
        let found = regions(view.size, all, |at| view.like[at] && !covered[at]);
        let (new, rest): (Vec<Region>, Vec<Region>) = found.into_iter().partition(|region| {
            let [least, deep] = if region.at_border {
                [CUT_AREA, CUT_DEPTH]
            } else {
                [AREA, DEPTH]
            };
            region.cells.len() as f64 >= least * area && region.depth() >= deep * radius
        });
        let cells = |regions: &[Region]| -> f64 {
            let cells: usize = regions.iter().map(|region| region.cells.len()).sum();
            cells as f64
        };
        if cells(&new) < MOSTLY * (cells(&new) + cells(&rest)) {
            return;
        }
        for region in new {
            let Some(body) = embodied(image, now, view, &region, &self.options.fit) else {
                continue;
            };
            let (id, what) = match self.known(&body) {
                Some(mut old) => {
                    (old.body, old.step) = (body, Step::begun());
                    (old.unseen, old.gone) = (0, 0);
                    (old.since, old.cut) = (self.frame, region.at_border);
                    let id = old.id;
                    self.objects.push(old);
                    (id, Happening::Found)
                }
                None => {
                    let id = self.next_id;
                    self.next_id += 1;
                    let mut object = Object::new(id, None, body, self.frame);
                    object.cut = region.at_border;
                    self.objects.push(object);
                    (id, Happening::Born)
                }
            };
            if let Some(object) = self.objects.last() {
                view.cover(self.objects.len(), &object.body.outline());
            }
            events.push(Event {
                frame: self.frame,
                id,
                what,
                confidence: 1.0,
            });
        }
    }

    /// An object that has ended or is not seen, if a new one is that: taken out of those that are kept.
    fn known(&mut self, new: &Body) -> Option<Object> {
        let outline = new.outline();
        let (middle, area) = (ring::middle(&outline), elastic::signed_area(&outline).abs());
        let far = |object: &Object| {
            let last = object.body.outline();
            let reach = ring::radius(&last) * (PLACE + FARTHER * f64::from(object.unseen));
            let size = area / elastic::signed_area(&last).abs().max(1e-9);
            let whole = object.step.state == State::Left;
            let fits = (whole || size > SIZES[0]) && size < SIZES[1];
            let far = ring::middle(&last).distance(middle) / reach;
            (fits && far < 1.0).then_some(far)
        };
        let nearest = |list: &[Object]| {
            let fitting = list
                .iter()
                .enumerate()
                .filter_map(|(at, object)| Some((at, far(object)?)));
            fitting
                .min_by(|a, b| a.1.total_cmp(&b.1))
                .map(|best| best.0)
        };
        // the covers of a view are by place: an object is taken out of the list only where it covers nothing
        let hidden = |object: &Object| object.id > 0 && !object.step.state.is_seen();
        let left: Vec<usize> = (0..self.objects.len())
            .filter(|&at| hidden(&self.objects[at]))
            .collect();
        let back = left
            .into_iter()
            .filter_map(|at| Some((at, far(&self.objects[at])?)))
            .min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((at, _)) = back {
            let mut old = self.objects[at].clone();
            self.objects[at].id = 0;
            old.unseen = 0;
            return Some(old);
        }
        nearest(&self.graves).map(|at| self.graves.remove(at))
    }

    /// Young objects, and those that come over the border, become what they hang together with.
    pub(crate) fn grow(&mut self, image: &Image, now: Frame<'_>, view: &mut View) {
        for index in 0..self.objects.len() {
            let object = &self.objects[index];
            let young = object.since > 0 && self.frame < object.since + YOUNG;
            if !(young || object.cut) || object.step.state == State::Left {
                continue;
            }
            let Some(region) = self.whole(index, view) else {
                continue;
            };
            let own = view.owner.iter().filter(|own| **own == index + 1).count() as f64;
            let all = region.cells.len() as f64;
            if all > GROWN * own
                && all < MOST * own
                && let Some(body) = embodied(image, now, view, &region, &self.options.fit)
            {
                view.cover(index + 1, &body.outline());
                let object = &mut self.objects[index];
                object.body = body;
                object.step = Step::begun();
            }
            self.objects[index].cut &= region.at_border;
        }
    }

    /// The region that holds most of an object and is not another's.
    fn whole(&self, index: usize, view: &View) -> Option<Region> {
        let curve: Vec<DVec2> = view.to_cells(&self.objects[index].body.outline());
        let margin = ring::radius(&curve);
        let rectangle = Rectangle::about(&curve, margin, view.size);
        let own = index + 1;
        let found = regions(view.size, rectangle, |at| {
            let owner = view.owner[at];
            view.like[at] && (owner == own || (owner == 0 && !view.is_beside_other(at, own)))
        });
        let mine = |region: &Region| {
            let cells = region.cells.iter();
            cells.filter(|at| view.owner[**at] == own).count()
        };
        let best = found.into_iter().max_by_key(|region| mine(region))?;
        (4 * mine(&best) > best.cells.len()).then_some(best)
    }

    /// Objects whose place is empty are lost.
    pub(crate) fn bury(&mut self, view: &View, events: &mut Vec<Event>) {
        let mut index = 0;
        while index < self.objects.len() {
            let object = &mut self.objects[index];
            let doubted = !object.step.state.is_seen() || object.step.confidence < SURE;
            let empty = object.id > 0
                && doubted
                && object.step.state != State::Left
                && view.share(&object.body.outline()) < EMPTY;
            object.gone = if empty { object.gone + 1 } else { 0 };
            if object.gone < GONE {
                index += 1;
                continue;
            }
            events.push(Event {
                frame: self.frame,
                id: object.id,
                what: Happening::Lost,
                confidence: 1.0,
            });
            let object = self.objects.remove(index);
            self.graves.push(object);
        }
        let patience = self.options.patience;
        self.graves.iter_mut().for_each(|object| object.unseen += 1);
        self.graves.retain(|object| object.unseen <= patience);
    }
}
