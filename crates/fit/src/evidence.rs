//! What speaks for an outline that has been found: that the image holds it, that it is an outline
//! at all.
//!
//! A curve can come to rest where nothing pulls, folded onto itself, or inside out. Rest alone is
//! no success.

use std::fmt;

use glam::DVec2;
use integrator::State;
use outline::Neighbours;
use snake::Snake;

use crate::force::PULL;

/// How far to either side of a node the forces are asked for. Pixels.
pub(crate) const PROBE: f64 = 1.0;

/// The least stiffness, against that of an edge as high as the image's contrast, that counts as a
/// hold.
const FIRM: f64 = 0.01;

/// The least share of a closed outline that must be held, or of an open one.
const LEAST_HELD: f64 = 0.05;

/// The least area, against that of the start.
pub(crate) const LEAST_AREA: f64 = 0.1;

/// Normals whose product is below this face each other.
const OPPOSITE: f64 = -0.5;

/// What speaks for one curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Evidence {
    /// Share of the nodes that the image holds: moved along the normal, they are pulled back.
    pub held: f64,
    /// How often the curve crosses or touches itself.
    pub crossings: usize,
    /// Signed area at the start and at the end, of a closed curve. Square pixels.
    pub area: Option<(f64, f64)>,
    /// Why a search is not sure of its outline, if it is not.
    pub doubt: Option<Doubt>,
    /// Parts of the curve that face each other more closely than the image's smoothing can resolve,
    /// if any.
    pub narrow: Option<Narrow>,
}

/// Why a search is not sure.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Doubt {
    /// Too little of the best curve lies on an edge.
    NoEdge {
        /// Strength of edge that four fifths of it have. 0 … 1.
        closed: f64,
        /// The least that is needed.
        needed: f64,
    },
    /// The picture is about as steep beside the outline as across it: a slope, not an edge.
    Slope {
        /// How steep, against the outline itself.
        beside: f64,
        /// The most that an edge may have.
        most: f64,
    },
    /// Clicks beside the one that was given lead to other outlines: which object is meant is not clear.
    Unsteady {
        /// How far their outlines overlap with this one, in the mean. 0 … 1.
        overlap: f64,
        /// The least that is needed.
        needed: f64,
    },
    /// Every curve that was found folds, crosses itself or has collapsed: the start is given back.
    Folded,
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoEdge { closed, needed } => write!(
                f,
                "unsure: no boundary here that closes; four fifths of the best outline have an edge of {closed:.2} of the \
                 strongest, needed: {needed:.2}"
            ),
            Self::Slope { beside, most } => write!(
                f,
                "unsure: a slope and no edge; the picture is {beside:.2} as steep beside the outline as across it, which \
                 must be at most {most:.2}"
            ),
            Self::Unsteady { overlap, needed } => write!(
                f,
                "unsure: clicks beside this one lead to other outlines, which overlap with it by {overlap:.2} in the mean, \
                 needed: {needed:.2}; a box or a curve around the object says which is meant"
            ),
            Self::Folded => f.write_str(
                "unsure: every outline found folds, crosses itself or has collapsed; this is the start",
            ),
        }
    }
}

/// Where two parts of a curve face each other most closely. Pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Narrow {
    /// A node of one part.
    pub at: DVec2,
    /// Its distance to the other.
    pub gap: f64,
    /// The least distance that the smoothing resolves.
    pub resolves: f64,
}

impl Evidence {
    /// What speaks for the curve at `end`, which began at `start`; `width`: the least distance of
    /// two edges that the smoothing keeps apart, if known.
    ///
    /// The forces of the image are asked for a pixel inside and a pixel outside of every node:
    /// O(n).
    pub fn of(snake: &mut Snake, start: &[DVec2], end: &State, width: Option<f64>) -> Self {
        let closed = snake.body().topology.is_closed();
        let area = closed.then(|| (elastic::signed_area(start), elastic::signed_area(&end.x)));
        let crossings = outline::crossings(&end.x, closed).map_or(0, |found| found.len());
        Self {
            held: share(&held(snake, end)),
            crossings,
            doubt: None,
            area,
            narrow: width.and_then(|width| narrow(&end.x, closed, width)),
        }
    }

    /// Why this is no outline, if it is none.
    #[must_use]
    pub fn objection(&self) -> Option<String> {
        if let Some(doubt) = self.doubt {
            return Some(doubt.to_string());
        }
        if let Some((before, after)) = self.area {
            if before * after < 0.0 {
                return Some("the curve is turned inside out".to_owned());
            }
            if after.abs() < LEAST_AREA * before.abs() {
                return Some(format!(
                    "the curve has collapsed: its area is {:.1} of {:.1} square pixels at the start",
                    after.abs(),
                    before.abs()
                ));
            }
        }
        if self.crossings > 0 {
            return Some(format!("the curve crosses itself {} times", self.crossings));
        }
        if self.held < LEAST_HELD {
            return Some(
                "no boundary here: the picture holds no part of the curve where it is".to_owned(),
            );
        }
        None
    }

    /// What to know of an outline that is one.
    #[must_use]
    pub fn note(&self) -> Option<String> {
        self.narrow.map(|Narrow { at, gap, resolves }| {
            format!(
                "near ({:.0}, {:.0}) parts of the curve face each other at {gap:.1} pixels; the smoothing resolves \
                 {resolves:.1}: a smaller sigma, or the force `line` for a thin line, tells them apart",
                at.x, at.y
            )
        })
    }
}

impl fmt::Display for Evidence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.0} % held by the picture", 100.0 * self.held)?;
        if let Some((_, area)) = self.area {
            write!(f, ", area {:.1} px²", area.abs())?;
        }
        if self.crossings > 0 {
            write!(f, ", {} crossings", self.crossings)?;
        }
        Ok(())
    }
}

/// Unit normals of the nodes; of a curve that runs clockwise on the screen they point inwards.
pub(crate) fn normals(x: &[DVec2], closed: bool) -> Vec<DVec2> {
    let n = x.len();
    let beside = |i: usize| {
        if closed {
            (x[(i + n - 1) % n], x[(i + 1) % n])
        } else {
            (x[i.saturating_sub(1)], x[(i + 1).min(n - 1)])
        }
    };
    let normal = |i| {
        let (before, after) = beside(i);
        (after - before).perp().normalize_or_zero()
    };
    (0..n).map(normal).collect()
}

/// The image's forces along `normals` when every node is moved along its own by `way`; None where
/// one has no value.
pub(crate) fn pulls(
    snake: &mut Snake,
    end: &State,
    normals: &[DVec2],
    way: f64,
) -> Option<Vec<f64>> {
    let n = end.len();
    let moved = end.x.iter().zip(normals);
    let moved = State {
        x: moved.map(|(x, normal)| x + way * normal).collect(),
        v: vec![DVec2::ZERO; n],
        ..end.clone()
    };
    let mut force = vec![DVec2::ZERO; n];
    for index in 0..snake.world().forces.len() {
        if snake.world().forces[index].is_of_picture() {
            snake.force_of(index, &moved, &mut force).ok()?;
        }
    }
    Some(force.iter().zip(normals).map(|(f, n)| f.dot(*n)).collect())
}

/// Which nodes the image's forces pull back when the curve is moved along its normals.
pub(crate) fn held(snake: &mut Snake, end: &State) -> Vec<bool> {
    let normals = normals(&end.x, snake.body().topology.is_closed());
    let mut beside = |way| pulls(snake, end, &normals, way);
    let (Some(outer), Some(inner)) = (beside(PROBE), beside(-PROBE)) else {
        return vec![true; end.len()]; // a force has no value there: nothing can be said against it
    };
    let least = 2.0 * PROBE * FIRM * PULL;
    let both = outer.iter().zip(&inner);
    both.map(|(outer, inner)| *inner - *outer > least).collect()
}

/// The share of the nodes for which it is so.
fn share(held: &[bool]) -> f64 {
    held.iter().filter(|held| **held).count() as f64 / held.len() as f64
}

/// The least distance between parts that face each other, if below `width`.
fn narrow(x: &[DVec2], closed: bool, width: f64) -> Option<Narrow> {
    let n = x.len();
    let spacing = elastic::length(x, closed) / n as f64;
    // a part farther along the curve than the way around a half circle of that width
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "at most the number of nodes"
    )]
    let apart = (2.0 * width / spacing).ceil().min(n as f64) as usize;
    let mut neighbours = Neighbours::default();
    neighbours.rebuild([(x, closed)], width).ok()?;
    let normals = normals(x, closed);
    let mut found = Vec::new();
    let mut least: Option<(f64, usize)> = None;
    for node in 0..n {
        neighbours.near_node(0, node, apart, width, &mut found);
        // nodes that crowd in a bend are near and do not face each other
        let facing = found
            .iter()
            .filter(|near| normals[node].dot(normals[near.spot.edge % n]) < OPPOSITE);
        let gap = facing.map(|near| near.distance).fold(width, f64::min);
        if gap < least.map_or(width, |(known, _)| known) {
            least = Some((gap, node));
        }
    }
    least.map(|(gap, node)| Narrow {
        at: x[node],
        gap,
        resolves: width,
    })
}
