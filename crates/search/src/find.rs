//! Two searches from a start, and which of their curves the picture supports.

use std::sync::Arc;

use field::Pixels;
use glam::DVec2;

use crate::along::Polygon;
use crate::around::around;
use crate::evidence::{Support, strengths, support};
use crate::flood::{flood, purity};
use crate::line::find_line;
use crate::near::near;
use crate::rules::Rules;
use crate::view::{Seen, View};
use crate::within::{free, within};

/// Which search a curve came from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Search {
    /// A band about the start, to which the curve is tethered.
    Near,
    /// That band and then, since the curve lay at its limits, a band about the result.
    Wider,
    /// All of the start's inside, along rays from its middle.
    Within,
    /// What is like the inside and joined to it.
    Region,
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

/// By how much the curve along rays must be closed better than the one about the start, and a curve around the start
/// better than both.
const BETTER: f64 = 0.05;
const MUCH_BETTER: f64 = 0.1;

/// Share of nodes at the limits from which on the band was too narrow, and how much better the mean edge of a
/// curve beyond it must be.
const LIMITED: f64 = 0.04;
const BETTER_EDGE: f64 = 0.04;

/// The start's inside is unlike its surroundings where their medians differ by this share of the spread of all.
const PLAIN: f64 = 0.25;

/// A part of a curve counts from this area on, in square pixels of the window.
const LEAST_PART: f64 = 4.0;

/// An edge is of one polarity where the mean of its directions is this share of its strength, and of none below the
/// second.
const ONE_POLARITY: f64 = 0.9;
const NO_POLARITY: f64 = 0.5;

/// By how much more pixels must be told apart by a region than before, and by how much its edge may be weaker.
const PURER: f64 = 0.03;
const SLACK: f64 = 0.02;

/// Strength of edge at which one polarity alone is enough.
const STRONG: f64 = 0.5;

/// Look for an outline about a start, open or closed. None for a start without area or length.
#[must_use]
pub fn find(pixels: &dyn Pixels, start: &Polygon, rules: &Rules) -> Option<Searched> {
    let start = start.clone().outwards();
    if !start.closed {
        return find_line(pixels, &start, rules);
    }
    if start.area().partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) {
        return None;
    }
    let first = about(pixels, &start, rules)?;
    let own = first.taken().support;
    let seen = &first.seen;
    let some = own.closed > rules.unsure
        && own.polar > NO_POLARITY * own.edge
        && seen.contrast > seen.noise.max(PLAIN * seen.spread);
    if own.closed > rules.sure || some {
        return Some(first);
    }
    // nothing at the start or within: it may lie inside
    let second = around(pixels, &start, rules)
        .map(|points| {
            Polygon {
                points,
                closed: true,
            }
            .outwards()
        })
        .filter(|around| around.area() > start.area())
        .and_then(|around| about(pixels, &around, rules));
    let better = second.filter(|second| {
        let other = second.taken().support;
        is_outline(&other, rules) && other.closed > own.closed + MUCH_BETTER
    });
    Some(better.map_or(first, |second| Searched {
        around: true,
        ..second
    }))
}

/// Whether a curve is surely an outline by its edge alone.
fn is_outline(support: &Support, rules: &Rules) -> bool {
    support.closed > rules.sure
        || (support.closed > rules.unsure && support.polar > ONE_POLARITY * support.edge)
}

/// The searches about a start and within it, and the rule between them.
fn about(pixels: &dyn Pixels, start: &Polygon, rules: &Rules) -> Option<Searched> {
    let view = View::new(pixels, start, rules);
    let found = |search, curve: &[DVec2]| {
        let curve = simple(curve);
        Found {
            search,
            points: curve.iter().map(|p| view.frame.to_picture(*p)).collect(),
            support: support(&view, &curve, true, false),
            window: curve,
        }
    };
    let near = near(&view, rules)?;
    let mut first = found(Search::Near, &near.points);
    if near.limited > LIMITED {
        let wider = found(Search::Wider, &free(&view, rules, near.points));
        let (own, other) = (first.support, wider.support);
        if other.edge > own.edge + BETTER_EDGE && other.closed > own.closed - 0.5 * BETTER_EDGE {
            first = wider;
        }
    }
    let own = first.support;
    // beside the start there is already a closed edge, or one of a single polarity: stay
    let enough = own.closed > rules.sure
        || (own.closed > rules.unsure && own.edge > STRONG && own.polar > ONE_POLARITY * own.edge);
    let mut list = vec![first];
    let mut taken = 0;
    // a part without an edge, though the rest has a strong one, may be cut off from the object by a corner of the start
    let cornered = own.edge < own.closed - SLACK;
    if (!enough || cornered)
        && let Some(curve) = within(&view, rules)
    {
        let within = found(Search::Within, &curve);
        let other = within.support;
        let better = if enough {
            other.edge > own.edge + BETTER_EDGE && other.closed > own.closed - SLACK
        } else {
            other.closed > own.closed + BETTER
        };
        taken = usize::from(better);
        list.push(within);
    }
    // what no band can follow: only where the two sides are told apart by what they look like, and this curve does it
    // better
    let told = purity(&view, &view.inside(&list[taken].window));
    if told < rules.pure
        && rules.pure < 1.0
        && let Some(curve) = flood(&view, rules, &list[taken].window)
    {
        let region = found(Search::Region, &curve);
        let (own, other) = (list[taken].support, region.support);
        let pure = purity(&view, &view.inside(&curve));
        let better = pure > rules.pure && pure > told + PURER;
        if better && other.closed > own.closed - SLACK && other.edge > own.edge - SLACK {
            taken = list.len();
        }
        list.push(region);
    }
    Some(Searched::of(view, list, taken))
}

/// A curve without its loops: the largest part of one that crosses itself. Normals of a band may meet where it is wide
/// against its bends, and a path through them then folds.
fn simple(curve: &[DVec2]) -> Vec<DVec2> {
    if outline::crossings(curve, true).is_ok_and(|found| found.is_empty()) {
        return curve.to_vec();
    }
    let parts = outline::resolve(curve, LEAST_PART).ok();
    let largest = parts.and_then(|parts| {
        parts
            .pieces
            .into_iter()
            .max_by(|a, b| a.area.total_cmp(&b.area))
    });
    largest.map_or_else(|| curve.to_vec(), |part| part.nodes)
}
