//! What the user has said of the picture: discs to stay out of, edges that do not count, nodes that stay.

use std::sync::Arc;

use glam::DVec2;
use ndarray::Array2;

use super::edge::ridge;
use super::mend::{about, between, check_node, crosses};
use super::{One, Pictures, prepared};
use crate::LiveError;

/// Steps of a body that is pushed out of a disc or settles about a pin.
const STEPS: u64 = 400;

/// How far beyond a disc nodes may move, against its radius, and how long a stretch follows a pin. Pixels.
const BEYOND: f64 = 2.0;
const STRETCH: f64 = 12.0;

/// Pixels about an edge that does not count.
const WIDTH: f64 = 4.0;

/// Places of an edge may be so far from outlines that are searched again. Pixels.
const TOUCHES: f64 = 8.0;

impl Pictures {
    /// Hold nodes, or let them go.
    pub(super) fn hold(
        &mut self,
        id: u32,
        from: usize,
        to: usize,
        hold: bool,
    ) -> Result<(), LiveError> {
        let one = self.one_mut(id)?;
        check_node(one, from)?;
        check_node(one, to)?;
        for node in between(one.points.len(), one.closed, from, to) {
            if hold {
                one.pins.insert(node);
            } else {
                one.pins.remove(&node);
            }
        }
        Ok(())
    }

    /// Keep all outlines out of a disc.
    pub(super) fn forbid(&mut self, at: DVec2, radius: f64) -> Result<(), LiveError> {
        if !(radius.is_finite() && radius > 0.0) {
            return Err(LiveError::new(format!(
                "the radius of a disc must be above 0, got {radius}"
            )));
        }
        self.forbidden.push((at, radius));
        let moved: Vec<(u32, Arc<One>)> = self
            .outlines
            .iter()
            .map(|(id, one)| (*id, Arc::new(self.kept_out(One::clone(one)))))
            .collect();
        self.outlines.extend(moved);
        Ok(())
    }

    /// An outline that was pushed out of all discs.
    pub(super) fn kept_out(&self, mut one: One) -> One {
        let inside = |p: &DVec2, grow: f64| {
            let mut discs = self.forbidden.iter();
            discs.any(|(at, radius)| p.distance(*at) < grow * radius)
        };
        if !one.points.iter().any(|p| inside(p, 1.0)) {
            return one;
        }
        let free: Vec<usize> = (0..one.points.len())
            .filter(|i| inside(&one.points[*i], BEYOND))
            .collect();
        if let Ok(mut session) = self.session(&one, &one.points, &free) {
            session.step(STEPS);
            let points = session.nodes().to_vec();
            if !crosses(&points, one.closed) {
                one.take_over(&points, &free);
                "pushed out of a place that is forbidden".clone_into(&mut one.words);
            }
        }
        one
    }

    /// An outline with the pinned nodes of another one: the nearest node goes to each of their places, and the stretch
    /// about it follows.
    pub(super) fn with_pins(&self, mut one: One, before: &One) -> One {
        for &pin in &before.pins {
            let Some(place) = before.points.get(pin).copied() else {
                continue;
            };
            let away = |i: &usize| one.points[*i].distance_squared(place);
            let nearest = (0..one.points.len()).min_by(|a, b| away(a).total_cmp(&away(b)));
            let Some(node) = nearest else { continue };
            let reach = STRETCH + 2.0 * one.points[node].distance(place);
            let mut free = about(&one.points, one.closed, node, reach);
            free.retain(|i| *i != node);
            let mut points = one.points.clone();
            points[node] = place;
            let Ok(mut session) = self.session(&one, &points, &free) else {
                continue;
            };
            session.step(STEPS);
            let points = session.nodes().to_vec();
            if !crosses(&points, one.closed) {
                free.push(node);
                one.take_over(&points, &free);
                one.pins.insert(node);
            }
        }
        one
    }

    /// The edge under a place pulls no longer: outlines on it are searched again.
    pub(super) fn not_this_edge(&mut self, at: DVec2, reach: f64) -> Result<(), LiveError> {
        if !(reach.is_finite() && reach >= 0.0) {
            return Err(LiveError::new(format!(
                "how far along an edge must be at least 0 pixels, got {reach}"
            )));
        }
        let Some(edge) = ridge(&self.picture, at, reach) else {
            return Err(LiveError::new("there is no edge under the pointer"));
        };
        let (width, height) = self.picture.size();
        let mut valid = match &self.valid {
            Some(valid) => Array2::clone(valid),
            None => Array2::from_elem((height, width), true),
        };
        for p in &edge {
            blank(&mut valid, *p);
        }
        if !valid.iter().any(|ok| *ok) {
            return Err(LiveError::new("no pixel would be left that counts"));
        }
        self.prepared = prepared(&self.picture, Some(&valid))?;
        self.valid = Some(Arc::new(valid));
        self.version += 1;
        let on_it = |one: &One| {
            let near = |p: &DVec2| edge.iter().any(|e| e.distance(*p) < TOUCHES);
            one.points.iter().any(near)
        };
        let concerned: Vec<u32> = self
            .outlines
            .iter()
            .filter(|(_, one)| on_it(one))
            .map(|(id, _)| *id)
            .collect();
        for id in concerned {
            self.search_again(id)?;
        }
        Ok(())
    }
}

/// Pixels near a place do not count.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "cut to the picture first"
)]
fn blank(valid: &mut Array2<bool>, p: DVec2) {
    let (height, width) = valid.dim();
    let range = |c: f64, most: usize| {
        let low = (c - WIDTH).ceil().max(0.0) as usize;
        let high = (c + WIDTH + 1.0).floor().clamp(0.0, most as f64) as usize;
        low..high
    };
    for y in range(p.y, height) {
        for x in range(p.x, width) {
            if DVec2::new(x as f64, y as f64).distance(p) <= WIDTH {
                valid[[y, x]] = false;
            }
        }
    }
}
