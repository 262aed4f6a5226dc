//! Valid outlines from curves that cross: what is kept, what is dropped, and why.
//!
//! A place belongs to the body if the curve winds around it once or more in the positive sense. What is
//! wound around negatively has flipped, and is dropped; what is enclosed but not wound around is a hole, and
//! holes are filled, since an outline has none. What cannot be done yet: outlines with holes.

use crate::cut::{Loops, Origin, Vertex, at, cut};
use crate::error::check_not_negative;
use crate::overlap::overlap_depth;
use crate::place::{Place, place, twice_area};
use crate::{OutlineError, Plan};
use glam::DVec2;

/// A simple outline of positive area, and where each of its nodes came from.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// The outline, positive and without crossings.
    pub nodes: Vec<DVec2>,
    /// Where each node was on the old curves.
    pub origins: Vec<Origin>,
    /// The area inside. L².
    pub area: f64,
}

impl Piece {
    /// How values are handed from the old curves to this piece.
    ///
    /// `counts` are the numbers of nodes of the old curves, whose values stand in one list, curve after
    /// curve. A node of an edge takes from its two ends; a node at a cut half from either strand.
    ///
    /// # Errors
    /// An origin that the counts do not reach.
    pub fn plan(&self, counts: &[usize]) -> Result<Plan, OutlineError> {
        Plan::from_origins(&self.origins, counts)
    }
}

/// Why a loop was not kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Removal {
    /// Its area has flipped, or it lies in what has.
    Inverted,
    /// It bounded a hole, which is now filled.
    Hole,
    /// It lies inside another piece: the body covered itself twice, or an island stood in a hole.
    Nested,
    /// It is smaller than the least area.
    Sliver,
}

/// What happened to an outline, for a log.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Event {
    /// Nodes that touched or overlapped an edge exactly were moved off it.
    Nudged {
        /// How many times a node was moved.
        nodes: usize,
        /// At most by so much in either direction. L.
        by: f64,
    },
    /// One outline became several.
    Split {
        /// How many.
        pieces: usize,
    },
    /// Two outlines became one.
    Merged {
        /// How deep one was in the other. L.
        depth: f64,
    },
    /// A loop was cut off and dropped.
    LoopRemoved {
        /// Its signed area. L².
        area: f64,
        /// Why.
        why: Removal,
    },
    /// Nothing is left.
    Vanished,
}

/// What is left of curves that crossed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Resolved {
    /// The outlines, the largest first. No two overlap; they may touch where they were cut.
    pub pieces: Vec<Piece>,
    /// What happened. Empty if the curve was a valid outline, which is then the only piece, unchanged but
    /// for nodes that repeat.
    pub events: Vec<Event>,
}

/// Cuts a closed curve at its crossings into simple outlines of positive area.
///
/// Of the plane, what the curve winds around at least once is kept, holes are filled, and pieces below
/// `least_area` are dropped, so that area never flips. A curve of negative area vanishes. Nodes that lie on
/// an edge exactly, or edges that overlap, are first moved apart by some 1e-7 of the curve's size
/// ([`Event::Nudged`]). New nodes stand only where strands crossed; between cuts nothing is moved.
///
/// Linear in the nodes, and the square of the crossings.
///
/// # Errors
/// Fewer than three nodes; coordinates that are not finite or beyond 1e75; a least area that is negative;
/// crossings that come back after every round ([`OutlineError::Unresolved`]).
pub fn resolve(nodes: &[DVec2], least_area: f64) -> Result<Resolved, OutlineError> {
    check_count("an outline", nodes)?;
    check_not_negative("the least area", least_area)?;
    let mut out = sort_out(cut(&[nodes])?, least_area);
    if out.pieces.len() > 1 {
        out.events.push(Event::Split {
            pieces: out.pieces.len(),
        });
    }
    if out.pieces.is_empty() {
        out.events.push(Event::Vanished);
    }
    Ok(out)
}

/// Makes one outline of two that overlap by more than `depth`; none if they do not.
///
/// The piece is the union, its origins name curve 0 for `a` and 1 for `b`. Holes are filled and logged. The
/// depth is that of [`overlap_depth`].
///
/// # Errors
/// As [`resolve`]; a depth that is negative.
pub fn merge(a: &[DVec2], b: &[DVec2], depth: f64) -> Result<Option<Resolved>, OutlineError> {
    check_count("an outline", a)?;
    check_count("an outline", b)?;
    check_not_negative("the depth", depth)?;
    let deep = overlap_depth(a, b)?;
    if deep <= depth {
        return Ok(None);
    }
    let mut out = sort_out(cut(&[a, b])?, 0.0);
    out.events.push(Event::Merged { depth: deep });
    Ok(Some(out))
}

fn check_count(what: &'static str, nodes: &[DVec2]) -> Result<(), OutlineError> {
    if nodes.len() >= 3 {
        return Ok(());
    }
    Err(OutlineError::TooFewNodes {
        what,
        needed: 3,
        got: nodes.len(),
    })
}

/// Which loops bound what is wound around, which do not.
fn sort_out(cut: Loops, least_area: f64) -> Resolved {
    let mut out = Resolved::default();
    if cut.nudged.0 > 0 {
        out.events.push(Event::Nudged {
            nodes: cut.nudged.0,
            by: cut.nudged.1,
        });
    }
    let mut removed = |area, why| out.events.push(Event::LoopRemoved { area, why });
    let mut loops: Vec<(Piece, DVec2)> = Vec::new();
    for vertices in &cut.loops {
        let area = 0.5 * twice_area(at(vertices));
        if area.abs() < least_area || area.abs() <= 0.0 {
            removed(area, Removal::Sliver);
        } else {
            let inner = middle_of_longest(vertices);
            let nodes: Vec<DVec2> = at(vertices).collect();
            let origins = vertices.iter().map(|v| v.origin).collect();
            loops.push((
                Piece {
                    nodes,
                    origins,
                    area,
                },
                inner,
            ));
        }
    }
    // the largest first, so that whoever holds a loop comes before it
    loops.sort_by(|a, b| b.0.area.abs().total_cmp(&a.0.area.abs()));
    let mut kept: Vec<usize> = Vec::new();
    for (k, (piece, inner)) in loops.iter().enumerate() {
        let holds = |m: usize| place(&loops[m].0.nodes, *inner) == Place::Inside;
        let around: i32 = (0..k)
            .filter(|&m| holds(m))
            .map(|m| if loops[m].0.area > 0.0 { 1 } else { -1 })
            .sum();
        let inside_kept = kept.iter().any(|&m| holds(m));
        match (piece.area > 0.0, inside_kept) {
            (true, true) => removed(piece.area, Removal::Nested),
            (true, false) if around == 0 => kept.push(k),
            (false, true) => removed(piece.area, Removal::Hole),
            _ => removed(piece.area, Removal::Inverted),
        }
    }
    let mut k = 0;
    loops.retain(|_| {
        k += 1;
        kept.contains(&(k - 1))
    });
    out.pieces = loops.into_iter().map(|(piece, _)| piece).collect();
    out
}

/// A point of the loop that is no node: loops touch each other in nodes only.
fn middle_of_longest(vertices: &[Vertex]) -> DVec2 {
    let n = vertices.len();
    let edge = |i: usize| (vertices[i].at, vertices[(i + 1) % n].at);
    let squared = |i: usize| edge(i).0.distance_squared(edge(i).1);
    let longest = (0..n).reduce(|best, i| if squared(i) > squared(best) { i } else { best });
    longest.map_or(DVec2::ZERO, |i| edge(i).0.midpoint(edge(i).1))
}

#[cfg(test)]
mod tests;
