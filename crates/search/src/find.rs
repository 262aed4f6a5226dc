//! The search about a start of any kind: closed or open, around its object or inside it.

use std::sync::Arc;

use field::Pixels;
use glam::DVec2;

use crate::along::Polygon;
use crate::around::around;
use crate::choice::{ONE_POLARITY, about};
use crate::evidence::{Support, strengths, support};
use crate::line::find_line;
use crate::rules::Rules;
use crate::view::{Seen, View};

/// Which search a curve came from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Search {
    /// A band about the start, to which the curve is tethered.
    Near,
    /// That band, tethered so that only much of an edge draws it from the start.
    Close,
    /// That band, with little of a tether.
    Loose,
    /// That band and then, since the curve lay at its limits, a band about the result.
    Wider,
    /// All of the start's inside, along rays from its middle.
    Within,
    /// What is like the inside and joined to it.
    Region,
    /// A narrow band about one of these curves.
    Again,
}

/// A curve found.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// By which search.
    pub search: Search,
    /// Its points, in the picture.
    pub points: Vec<DVec2>,
    /// What the picture says for it.
    pub support: Support,
    /// Its points in the window.
    pub(crate) window: Vec<DVec2>,
}

/// What the searches found.
#[derive(Debug, Clone)]
pub struct Searched {
    /// The curves: the one about the start first.
    pub found: Vec<Found>,
    /// Which of them the rule takes.
    pub taken: usize,
    /// Whether the start lay inside: the curves were looked for about an outline around it.
    pub around: bool,
    /// Size of a pixel of the window that was searched, in pixels of the picture.
    pub pixel: f64,
    /// What was measured about the start.
    pub seen: Seen,
    /// Of a start by one click: how far outlines from clicks beside it overlap with this one, in the mean, 0 … 1.
    pub steady: Option<f64>,
    view: Arc<View>,
}

impl Searched {
    pub(crate) fn of(view: View, found: Vec<Found>, taken: usize) -> Self {
        let (pixel, seen) = (view.frame.scale.recip(), view.seen());
        Self {
            found,
            taken,
            around: false,
            pixel,
            seen,
            steady: None,
            view: Arc::new(view),
        }
    }

    /// What the picture says for another curve in the window.
    #[must_use]
    pub fn support(&self, curve: &Polygon) -> Support {
        let curve = curve.map(|p| self.view.frame.to_window(p));
        support(&self.view, &curve.points, curve.closed, true)
    }

    /// The strength of the edge at each point of a curve, 0 … 1; None outside the picture.
    #[must_use]
    pub fn strengths(&self, curve: &Polygon) -> Vec<Option<f64>> {
        strengths(&self.view, &curve.map(|p| self.view.frame.to_window(p)))
    }

    /// The curve that the rule takes.
    #[must_use]
    pub fn taken(&self) -> &Found {
        &self.found[self.taken]
    }
}

/// By how much a curve around the start must be closed better than all about it.
const MUCH_BETTER: f64 = 0.1;

/// The start's inside is unlike its surroundings where their medians differ by this share of the spread of all.
const PLAIN: f64 = 0.25;

/// The middle of a start and its surroundings look alike below this difference of their medians, in percent of the
/// range.
const FAINT: f64 = 1.0;

/// An edge is of no polarity where the mean of its directions is less than this share of its strength.
const NO_POLARITY: f64 = 0.5;

/// A search was asked to end before it had an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stopped;

/// Whether a search is asked to end: looked at between its stages, each of which takes some milliseconds.
pub(crate) type Asked<'a> = &'a dyn Fn() -> bool;

/// Go on unless an end is asked for.
pub(crate) fn go_on(asked: Asked<'_>) -> Result<(), Stopped> {
    if asked() { Err(Stopped) } else { Ok(()) }
}

/// Look for an outline about a start, open or closed. None for a start without area or length.
#[must_use]
pub fn find(pixels: &dyn Pixels, start: &Polygon, rules: &Rules) -> Option<Searched> {
    find_unless(pixels, start, rules, &|| false).ok().flatten()
}

/// [`find`] that ends early when `asked` says so: it is looked at between the stages of the search.
///
/// # Errors
///
/// [`Stopped`] where `asked` has said yes.
pub fn find_unless(
    pixels: &dyn Pixels,
    start: &Polygon,
    rules: &Rules,
    asked: &dyn Fn() -> bool,
) -> Result<Option<Searched>, Stopped> {
    go_on(asked)?;
    let start = start.clone().outwards();
    if !start.closed {
        return Ok(find_line(pixels, &start, rules));
    }
    if start.area().partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) {
        return Ok(None);
    }
    let Some(first) = about(pixels, &start, rules, asked)? else {
        return Ok(None);
    };
    let own = first.taken().support;
    let seen = &first.seen;
    let some = own.closed > rules.unsure
        && own.polar > NO_POLARITY * own.edge
        && seen.contrast > seen.noise.max(PLAIN * seen.spread);
    // a start that looks as what is around it may lie wholly inside
    let faint = seen.contrast < FAINT;
    if !own.is_slope() && ((own.closed > rules.sure && !faint) || some) {
        return Ok(Some(first));
    }
    // nothing at the start or within: it may lie inside
    let outer = around(pixels, &start, rules)
        .map(|points| {
            Polygon {
                points,
                closed: true,
            }
            .outwards()
        })
        .filter(|around| around.area() > start.area());
    let second = match outer {
        Some(around) => about(pixels, &around, rules, asked)?,
        None => None,
    };
    let better = second.filter(|second| {
        let other = second.taken().support;
        let better = own.is_slope() || other.closed > own.closed + MUCH_BETTER;
        is_outline(&other, rules) && !other.is_slope() && better
    });
    Ok(Some(better.map_or(first, |second| Searched {
        around: true,
        ..second
    })))
}

/// Whether a curve is surely an outline by its edge alone.
fn is_outline(support: &Support, rules: &Rules) -> bool {
    support.closed > rules.sure
        || (support.closed > rules.unsure && support.polar > ONE_POLARITY * support.edge)
}
