//! The searches about a start, and which of their curves is taken.
//!
//! Each rule compares two curves by what the picture says for them ([`Support`]), never by the curves themselves: the
//! one nearer to the start is kept unless the other has clearly more of an edge.

use field::Pixels;
use glam::DVec2;

use crate::along::Polygon;
use crate::evidence::{Support, on_edge, support};
use crate::find::{Asked, Found, Search, Searched, Stopped, go_on};
use crate::flood::{flood, purity};
use crate::near::Tethered;
use crate::rules::Rules;
use crate::view::View;
use crate::within::{WIDTH, free, within};

/// By how much a curve loose from the start, or along rays, must be closed better than the one about the start.
const BETTER: f64 = 0.08;

/// By how much a curve loose from the start must be closed better where the one about the start is closed itself.
const MUCH_BETTER: f64 = 0.2;

/// The tethers of a curve close to the start, and of one loose from it, as times of the usual one.
const CLOSE: f64 = 10.0;
const LOOSE: f64 = 0.3;

/// A loose curve is taken where it is closed this much as a sure one must be.
const LOOSE_SURE: f64 = 0.87;

/// The curve close to the start is taken unless the usual one is closed better by this, or has a mean edge better by
/// this, or has one on the curve itself, not a little beside it, that is better by this.
const MORE_CLOSED: f64 = 0.06;
const MORE_EDGE: f64 = 0.03;
const MORE_EXACTLY: f64 = 0.1;

/// Share of nodes at the limits from which on the band was too narrow.
const LIMITED: f64 = 0.04;

/// How much better the mean edge must be of a curve beyond the limits of the band, or across a corner of the start.
const BETTER_EDGE: f64 = 0.04;

/// An edge is of one polarity where the mean of its directions is this share of its strength.
pub(crate) const ONE_POLARITY: f64 = 0.9;

/// Strength of edge at which one polarity alone is enough.
const STRONG: f64 = 0.5;

/// By how much more pixels must be told apart by a region than before, and by how much its edge may be weaker.
const PURER: f64 = 0.03;
const SLACK: f64 = 0.02;

/// Half width of the last band, in radii of the start; by how much more of an edge the weakest twentieth and all of the
/// curve must have there, and how much less the rest may have.
const LAST_WIDTH: f64 = 0.1;
const STRONGER: f64 = 0.08;
const STRONGER_IN_ALL: f64 = 0.005;
const LAST_SLACK: f64 = 0.01;

/// A part of a curve counts from this area on, in square pixels of the window.
const LEAST_PART: f64 = 4.0;

/// What has been found so far.
struct Choice<'a> {
    view: &'a View,
    rules: &'a Rules,
    tethered: Tethered<'a>,
    found: Vec<Found>,
    taken: usize,
}

/// The searches about a start and within it. None for a start without area.
pub(crate) fn about(
    pixels: &dyn Pixels,
    start: &Polygon,
    rules: &Rules,
    asked: Asked<'_>,
) -> Result<Option<Searched>, Stopped> {
    let view = View::new(pixels, start, rules);
    let mut choice = Choice {
        view: &view,
        rules,
        tethered: Tethered::new(&view, rules),
        found: Vec::new(),
        taken: 0,
    };
    go_on(asked)?;
    if choice.beside().is_none() {
        return Ok(None);
    }
    go_on(asked)?;
    let own = choice.own();
    // beside the start there is already a closed edge, or one of a single polarity: stay. A curve that the band does
    // not hold is not one beside the start.
    let held = choice.found[0].search == Search::Near;
    let one_polarity = own.polar > ONE_POLARITY * own.edge;
    let enough = own.whole() > rules.sure
        || (held && own.closed > rules.unsure && own.edge > STRONG && one_polarity);
    choice.loose(enough);
    // a part without an edge, though the rest has a strong one, may be cut off from the object by a corner of the start
    let cornered = enough && own.edge < own.closed - SLACK;
    if choice.taken == 0 && (!enough || cornered) {
        go_on(asked)?;
        choice.along_rays(enough);
    }
    go_on(asked)?;
    choice.region();
    go_on(asked)?;
    choice.close();
    choice.last();
    let Choice { found, taken, .. } = choice;
    Ok(Some(Searched::of(view, found, taken)))
}

impl Choice<'_> {
    /// What speaks for the curve that is taken.
    fn own(&self) -> Support {
        self.found[self.taken].support
    }

    fn add(&mut self, search: Search, curve: &[DVec2]) -> Support {
        let window = simple(curve);
        let support = support(self.view, &window, true, false);
        self.found.push(Found {
            search,
            points: window
                .iter()
                .map(|p| self.view.frame.to_picture(*p))
                .collect(),
            support,
            window,
        });
        support
    }

    fn take_last(&mut self) {
        self.taken = self.found.len() - 1;
    }

    /// The band about the start, or what lies beyond its limits.
    fn beside(&mut self) -> Option<()> {
        let usual = self.tethered.best(self.rules.tether)?;
        let own = self.add(Search::Near, &usual.points);
        if usual.limited > LIMITED {
            let other = self.add(
                Search::Wider,
                &free(self.view, self.rules, usual.points, WIDTH),
            );
            let better = other.edge > own.edge + BETTER_EDGE
                && other.closed > own.closed - 0.5 * BETTER_EDGE;
            // one of the two is the curve about the start from here on
            self.found.remove(usize::from(!better));
        }
        Some(())
    }

    /// That band with little of a tether; where the curve about the start is `enough`, only for one that is closed much
    /// better.
    fn loose(&mut self, enough: bool) {
        let own = self.own();
        let better = if enough { MUCH_BETTER } else { BETTER };
        if let Some(loose) = self.tethered.best(LOOSE * self.rules.tether) {
            let whole = self.add(Search::Loose, &loose.points).whole();
            if whole > LOOSE_SURE * self.rules.sure && whole > own.whole() + better {
                self.take_last();
            }
        }
    }

    /// Rays from the middle of the start; where the curve about it is `enough`, only for a corner that it cuts off.
    fn along_rays(&mut self, enough: bool) {
        let own = self.own();
        if let Some(curve) = within(self.view, self.rules) {
            let other = self.add(Search::Within, &curve);
            let better = if enough {
                other.edge > own.edge + BETTER_EDGE && other.closed > own.closed - SLACK
            } else {
                other.whole() > own.whole() + BETTER
            };
            if better {
                self.take_last();
            }
        }
    }

    /// What no band can follow: only where the two sides are told apart by what they look like, and this curve does it
    /// better.
    fn region(&mut self) {
        let least = self.rules.pure;
        let pure = |curve: &[DVec2]| purity(self.view, &self.view.inside(curve));
        let told = pure(&self.found[self.taken].window);
        if told >= least || least >= 1.0 {
            return;
        }
        let Some(curve) = flood(self.view, self.rules, &self.found[self.taken].window) else {
            return;
        };
        let told_by_it = pure(&curve);
        let own = self.own();
        let other = self.add(Search::Region, &curve);
        let better = told_by_it > least && told_by_it > told + PURER;
        if !better || other.closed <= own.closed - SLACK || other.edge <= own.edge - SLACK {
            return;
        }
        self.take_last();
        // a curve along rays that tells them apart too, and has more of an edge, has not grown into what is alike
        if self
            .found
            .iter()
            .all(|found| found.search != Search::Within)
            && let Some(curve) = within(self.view, self.rules)
        {
            let told = purity(self.view, &self.view.inside(&curve));
            let more = self.add(Search::Within, &curve);
            if more.edge > other.edge && more.closed > other.closed && told > least {
                self.take_last();
            }
        }
    }

    /// A start that lies almost on the edge: the curve leaves it only for more of an edge.
    fn close(&mut self) {
        if self.taken > 0 || self.found[0].search != Search::Near {
            return;
        }
        let own = self.own();
        if let Some(close) = self.tethered.best(CLOSE * self.rules.tether) {
            let other = self.add(Search::Close, &close.points);
            let exact = |at: usize| on_edge(self.view, &self.found[at].window);
            let more = own.closed >= other.closed + MORE_CLOSED
                || own.edge >= other.edge + MORE_EDGE
                || exact(0) >= exact(self.found.len() - 1) + MORE_EXACTLY;
            if !more {
                self.take_last();
            }
        }
    }

    /// A narrow band about the curve that is taken: ends and corners that it cuts off.
    fn last(&mut self) {
        let own = self.own();
        let curve = self.found[self.taken].window.clone();
        let curve = free(self.view, self.rules, curve, LAST_WIDTH);
        let other = self.add(Search::Again, &curve);
        let better = other.weakest > own.weakest + STRONGER
            && other.edge > own.edge + STRONGER_IN_ALL
            && other.closed > own.closed - LAST_SLACK
            && other.whole() > own.whole() - LAST_SLACK;
        if better {
            self.take_last();
        }
    }
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
