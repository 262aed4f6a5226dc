//! Objects that compete for one place.

use std::collections::BTreeMap;

use glam::DVec2;

use crate::body::Body;
use crate::candidates::Predicted;
use crate::contact;
use crate::ring;
use crate::step::{Frame, Step};
use crate::tracker::Tracker;
use crate::{Event, Happening, Prediction, State};

/// Two outlines end on one object if they share so much of the smaller one, and were to share less than that before.
const ONE: f64 = 0.5;
const APART: f64 = 0.25;

/// Objects that share so much of the smaller one for so many frames, and go together within so many radii, are one.
const MERGED: f64 = 0.6;
const TOGETHER: u32 = 8;
const STILL: f64 = 0.25;

/// An object is hidden by one that shares so much of the smaller one.
const MET: f64 = 0.3;

impl Tracker {
    /// Where two end on one object that were to be apart, the one with less evidence looks elsewhere.
    pub(crate) fn compete(
        &self,
        now: Frame<'_>,
        predicted: &[Predicted],
        expected: &[Vec<DVec2>],
        followed: &mut [(Body, Step)],
    ) {
        let mut ended: Vec<Vec<DVec2>> = followed.iter().map(|(body, _)| body.outline()).collect();
        // what was looked for elsewhere does not lie where another one is
        for i in 0..followed.len() {
            let searched = |at: usize| followed[at].1.prediction == Prediction::Searched;
            let taken = searched(i)
                && followed[i].1.state.is_seen()
                && (0..followed.len()).any(|j| {
                    let other = j != i && !searched(j) && followed[j].1.state.is_seen();
                    other
                        && contact::near(&ended[i], &ended[j])
                        && contact::shared(&ended[i], &ended[j]) > MET
                });
            if taken {
                let mut body = self.objects[i].body.clone();
                let step = body.coast(Some(now.pixels), Prediction::Flown, 0.0);
                ended[i] = body.outline();
                followed[i] = (body, step);
            }
        }
        for i in 1..followed.len() {
            for j in 0..i {
                let both = followed[i].1.state.is_seen() && followed[j].1.state.is_seen();
                if !both
                    || !contact::near(&ended[i], &ended[j])
                    || contact::shared(&ended[i], &ended[j]) < ONE
                {
                    continue;
                }
                let left = [i, j].map(|at| self.objects[at].body.left);
                if left[0] == left[1] && contact::shared(&expected[i], &expected[j]) > APART {
                    continue;
                }
                let less = followed[i].1.confidence < followed[j].1.confidence;
                let weaker = if left[0] || (less && !left[1]) { i } else { j };
                let stronger = i + j - weaker;
                let mut places = expected.to_vec();
                places[stronger].clone_from(&ended[stronger]);
                let mut body = self.objects[weaker].body.clone();
                let step = body.follow(now, &predicted[weaker], &beside(&places, weaker));
                ended[weaker] = body.outline();
                followed[weaker] = (body, step);
            }
        }
    }

    /// Objects that are not seen any more note which one covers them.
    pub(crate) fn meet(&mut self) {
        let outlines = self.outlines();
        for i in 0..self.objects.len() {
            let object = &self.objects[i];
            let hidden = object.step.state == State::Coasting;
            let met = (hidden && object.unseen == 1).then(|| {
                (0..outlines.len())
                    .filter(|&j| j != i && contact::near(&outlines[i], &outlines[j]))
                    .map(|j| (j, contact::shared(&outlines[i], &outlines[j])))
                    .filter(|one| one.1 > MET)
                    .max_by(|a, b| a.1.total_cmp(&b.1))
                    .map(|one| self.objects[one.0].id)
            });
            if let Some(met) = met {
                self.objects[i].met = met;
            }
        }
    }

    /// Of two that cover each other for long and go together, the one with less evidence ends.
    pub(crate) fn merge(&mut self, events: &mut Vec<Event>) {
        let outlines = self.outlines();
        let mut together = BTreeMap::new();
        let mut ended = Vec::new();
        for i in 1..self.objects.len() {
            for j in 0..i {
                // by number, whatever their places are
                let (i, j) = if self.objects[i].id < self.objects[j].id {
                    (j, i)
                } else {
                    (i, j)
                };
                let (a, b) = (&self.objects[i], &self.objects[j]);
                let left = [a, b].iter().any(|one| one.step.state == State::Left);
                if left
                    || !contact::near(&outlines[i], &outlines[j])
                    || contact::shared(&outlines[i], &outlines[j]) < MERGED
                {
                    continue;
                }
                let way = ring::middle(&outlines[i]) - ring::middle(&outlines[j]);
                let still = STILL * ring::radius(&outlines[i]).min(ring::radius(&outlines[j]));
                let pair = [b.id, a.id];
                let before = self.together.get(&pair);
                let (frames, first) = match before {
                    Some((frames, first)) if first.distance(way) < still => (frames + 1, *first),
                    _ => (1, way),
                };
                together.insert(pair, (frames, first));
                if frames >= TOGETHER {
                    let less = a.step.confidence <= b.step.confidence;
                    ended.push(if less { [a.id, b.id] } else { [b.id, a.id] });
                }
            }
        }
        self.together = together;
        for [id, other] in ended {
            let place = |id: u32| self.objects.iter().position(|object| object.id == id);
            let (Some(at), Some(_)) = (place(id), place(other)) else {
                continue;
            };
            let mut object = self.objects.remove(at);
            object.met = Some(other);
            if self.crowd.is_some() {
                self.graves.push(object);
            }
            events.push(Event {
                frame: self.frame,
                id,
                what: Happening::Merged(other),
                confidence: 1.0,
            });
        }
    }
}

/// The outlines of other objects that lie near one.
pub(crate) fn beside(all: &[Vec<DVec2>], index: usize) -> Vec<Vec<DVec2>> {
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
