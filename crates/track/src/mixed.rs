//! Objects that have covered each other and may have changed their numbers.

use std::collections::BTreeSet;

use glam::DVec2;

use crate::body::Body;
use crate::contact;
use crate::ring;
use crate::step::Frame;
use crate::tracker::{Object, Tracker};
use crate::{Event, Happening};

/// Of two that share so much of the smaller one, it is not known which is which until they share less than that.
const COVERED: f64 = 0.6;
const PARTED: f64 = 0.25;

/// Two that are less alike are told apart by their looks.
const ALIKE: f64 = 0.4;

impl Tracker {
    /// Say which objects can have changed their numbers: they covered each other, have parted, and are alike.
    pub(crate) fn mix(&mut self, now: Frame<'_>, events: &mut Vec<Event>) {
        let known: BTreeSet<u32> = self
            .objects
            .iter()
            .chain(&self.graves)
            .map(|object| object.id)
            .collect();
        self.covered
            .retain(|pair| pair.iter().all(|id| known.contains(id)));
        let outlines = self.outlines();
        let mut parted = Vec::new();
        for i in 1..self.objects.len() {
            for j in 0..i {
                let (a, b) = (&self.objects[i], &self.objects[j]);
                let pair = [a.id.min(b.id), a.id.max(b.id)];
                let share = contact::shared(&outlines[i], &outlines[j]);
                let seen = a.step.state.is_seen() && b.step.state.is_seen();
                if share > COVERED {
                    self.covered.insert(pair);
                } else if share < PARTED && seen && self.covered.remove(&pair) {
                    let alike = alike(now, a, b).min(alike(now, b, a));
                    parted.push((pair, alike));
                }
            }
        }
        for ([a, b], alike) in parted.into_iter().filter(|one| one.1 > ALIKE) {
            events.extend([(a, b), (b, a)].map(|(id, other)| Event {
                frame: self.frame,
                id,
                what: Happening::Uncertain(other),
                confidence: alike,
            }));
        }
    }
}

/// How well an object fits what another looks like, against that one itself, and by their sizes: 0 … 1.
fn alike(now: Frame<'_>, one: &Object, other: &Object) -> f64 {
    let own = other.body.outline();
    let seen = one.body.outline();
    let size = ring::radius(&seen) / ring::radius(&own).max(1e-9);
    let (fits, usual) = (fit(now, &other.body, &seen), fit(now, &other.body, &own));
    if usual > 0.0 {
        (fits / usual).clamp(0.0, 1.0) * size.min(1.0 / size).powi(2)
    } else {
        // nothing tells what it looks like
        1.0
    }
}

/// What the frame says for an outline, in pixels, by the tables of an object.
fn fit(now: Frame<'_>, body: &Body, outline: &[DVec2]) -> f64 {
    let curve = body.to_cells(outline);
    let (curve, _) = ring::evenly(&curve, body.curve.len());
    body.evidence_in(now.pixels, &curve, ring::radius(&curve), None)
        .mean
}
