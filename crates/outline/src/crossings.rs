//! Where an outline meets itself.
//!
//! Every pair of edges is looked at whose cells of a [`Grid`] have one in common; whether the two meet is
//! decided exactly. What cannot be done yet: curves whose nodes crowd in one cell cost their square there.

use crate::error::check_points;
use crate::grid::Grid;
use crate::orient::{meet, orientation};
use crate::segments::{NONE, Segment, push_curve};
use crate::{Meeting, OutlineError};
use glam::DVec2;

/// A place on a curve: which edge, and how far along it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Edge `i` runs from node `i` to the next; the last of a closed curve runs to node 0.
    pub edge: usize,
    /// From 0 at its first node to 1 at its second.
    pub along: f64,
}

/// Two edges of a curve that meet though they are no neighbours, or that fold back on each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// The place on the edge of lower index.
    pub first: Spot,
    /// The place on the other edge.
    pub second: Spot,
    /// Where they meet, rounded.
    pub at: DVec2,
    /// How they meet, exactly.
    pub kind: Meeting,
}

/// All places where a polygon meets itself, in the order of their edges; see [`Crossings::find`].
///
/// # Errors
/// As [`Crossings::find`].
pub fn crossings(nodes: &[DVec2], closed: bool) -> Result<Vec<Crossing>, OutlineError> {
    let mut search = Crossings::default();
    search.find(nodes, closed)?;
    Ok(search.found)
}

/// The search for self-crossings, with its memory kept from one curve to the next.
#[derive(Debug, Clone, Default)]
pub struct Crossings {
    pub(crate) segments: Vec<Segment>,
    grid: Grid,
    candidates: Vec<u32>,
    pairs: Vec<Pair>,
    found: Vec<Crossing>,
}

/// Two segments that meet, by index, and where.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pair {
    pub(crate) one: u32,
    pub(crate) other: u32,
    pub(crate) t: f64,
    pub(crate) u: f64,
    pub(crate) kind: Meeting,
}

impl Crossings {
    /// All places where the polygon meets itself, sorted by first edge, then second.
    ///
    /// One entry for each pair of edges that share a point, so a curve is simple exactly if there is none.
    /// Defined in every case: neighbours share a node and count only if one folds back on the other
    /// ([`Meeting::Overlap`]); nodes that repeat are one node, and their edges of no length do not exist;
    /// a node on a far edge is a [`Meeting::Touch`] with each edge it belongs to; the ends of an open
    /// curve that coincide touch.
    ///
    /// Linear in the nodes for curves that are spread out, plus the crossings. Nothing is allocated once
    /// the memory has grown to a curve's size.
    ///
    /// # Errors
    /// A coordinate that is not finite or beyond 1e75; more than 2³¹ nodes.
    pub fn find(&mut self, nodes: &[DVec2], closed: bool) -> Result<&[Crossing], OutlineError> {
        check_points("node", nodes)?;
        self.segments.clear();
        push_curve(&mut self.segments, 0, nodes, closed);
        self.search();
        self.found.clear();
        let segments = &self.segments;
        self.found.extend(self.pairs.iter().map(|pair| {
            let (one, other) = (&segments[pair.one as usize], &segments[pair.other as usize]);
            Crossing {
                first: Spot {
                    edge: one.edge as usize,
                    along: pair.t,
                },
                second: Spot {
                    edge: other.edge as usize,
                    along: pair.u,
                },
                at: one.a.lerp(one.b, pair.t),
                kind: pair.kind,
            }
        }));
        Ok(&self.found)
    }

    /// All pairs of the segments that meet, of whichever curve, sorted.
    #[allow(clippy::cast_possible_truncation, reason = "the door counts the nodes")]
    pub(crate) fn search(&mut self) {
        self.pairs.clear();
        self.grid.build(&self.segments, 0.0);
        for (i, segment) in self.segments.iter().enumerate() {
            let i = i as u32;
            self.candidates.clear();
            let candidates = &mut self.candidates;
            self.grid.visit_along(segment, |j| {
                if j > i {
                    candidates.push(j);
                }
            });
            candidates.sort_unstable();
            candidates.dedup();
            for &j in candidates.iter() {
                if let Some((kind, t, u)) = pair(&self.segments, i, j) {
                    self.pairs.push(Pair {
                        one: i,
                        other: j,
                        t,
                        u,
                        kind,
                    });
                }
            }
        }
    }

    /// What was found.
    pub(crate) fn pairs(&self) -> &[Pair] {
        &self.pairs
    }
}

/// How two segments meet, the node between neighbours apart.
pub(crate) fn pair(segments: &[Segment], i: u32, j: u32) -> Option<(Meeting, f64, f64)> {
    let (one, other) = (&segments[i as usize], &segments[j as usize]);
    if one.after == j && j != NONE && folds(one, other) {
        Some((Meeting::Overlap, 1.0, 0.0))
    } else if other.after == i && folds(other, one) {
        Some((Meeting::Overlap, 0.0, 1.0))
    } else if one.after == j || other.after == i {
        None
    } else {
        meet(one.a, one.b, other.a, other.b)
    }
}

/// Whether the second of two neighbours runs back over the first.
fn folds(first: &Segment, second: &Segment) -> bool {
    let turn = orientation(first.a, first.b, second.b);
    turn.abs() <= 0.0 && (first.b - first.a).dot(second.b - second.a) < 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Every pair of edges, looked at one by one.
    fn slow(nodes: &[DVec2], closed: bool) -> Vec<(usize, usize, Meeting)> {
        let mut segments = Vec::new();
        push_curve(&mut segments, 0, nodes, closed);
        let count = u32::try_from(segments.len()).unwrap();
        let mut out = Vec::new();
        for i in 0..count {
            for j in i + 1..count {
                if let Some((kind, _, _)) = pair(&segments, i, j) {
                    let edge = |k: u32| segments[k as usize].edge as usize;
                    out.push((edge(i), edge(j), kind));
                }
            }
        }
        out
    }

    fn short(found: &[Crossing]) -> Vec<(usize, usize, Meeting)> {
        found
            .iter()
            .map(|c| (c.first.edge, c.second.edge, c.kind))
            .collect()
    }

    fn points(from: &[(f64, f64)]) -> Vec<DVec2> {
        from.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
    }

    #[test]
    fn a_bow_tie_crosses_once_in_its_middle() {
        let tie = points(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)]);
        let found = crossings(&tie, true).unwrap();
        assert_eq!(found.len(), 1);
        assert_eq!(
            found[0].first,
            Spot {
                edge: 0,
                along: 0.5
            }
        );
        assert_eq!(
            found[0].second,
            Spot {
                edge: 2,
                along: 0.5
            }
        );
        assert_eq!(found[0].at, DVec2::ONE);
        assert_eq!(found[0].kind, Meeting::Cross);
    }

    #[test]
    fn a_square_does_not_meet_itself_even_with_nodes_twice_or_thrice() {
        let square = points(&[
            (0.0, 0.0),
            (0.0, 0.0),
            (1.0, 0.0),
            (1.0, 1.0),
            (1.0, 1.0),
            (1.0, 1.0),
            (0.0, 1.0),
        ]);
        assert_eq!(crossings(&square, true).unwrap(), []);
        assert_eq!(crossings(&square, false).unwrap(), []);
        assert_eq!(crossings(&[], true).unwrap(), []);
        assert_eq!(crossings(&square[..2], true).unwrap(), []);
    }

    #[test]
    fn a_fold_is_an_overlap_of_neighbours() {
        let spike = points(&[(0.0, 0.0), (4.0, 0.0), (2.0, 0.0), (2.0, 3.0)]);
        assert_eq!(
            short(&crossings(&spike, false).unwrap()),
            [(0, 1, Meeting::Overlap), (0, 2, Meeting::Touch)]
        );
        let flat = points(&[(0.0, 0.0), (1.0, 0.0)]);
        assert_eq!(
            short(&crossings(&flat, true).unwrap()),
            [(0, 1, Meeting::Overlap)]
        );
    }

    #[test]
    fn an_open_curve_that_ends_where_it_starts_touches() {
        let ring = points(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 0.0)]);
        assert_eq!(
            short(&crossings(&ring, false).unwrap()),
            [(0, 2, Meeting::Touch)]
        );
        // closed, the repeated node is one
        assert_eq!(crossings(&ring, true).unwrap(), []);
    }

    #[test]
    fn numbers_that_are_none_are_refused_by_name() {
        let bad = points(&[(0.0, 0.0), (f64::NAN, 0.0), (1.0, 1.0)]);
        let error = crossings(&bad, true).unwrap_err();
        assert!(
            error.to_string().starts_with("node 1 must lie within 1e75"),
            "{error}"
        );
        let far = points(&[(0.0, 0.0), (1e76, 0.0), (1.0, 1.0)]);
        assert!(crossings(&far, true).is_err());
    }

    proptest! {
        /// On a small lattice touches, overlaps, repeats and triple points are the rule.
        #[test]
        fn the_grid_finds_what_every_pair_finds_on_a_lattice(
            lattice in prop::collection::vec((0i32..8, 0i32..8), 0..40),
            closed: bool,
        ) {
            let nodes: Vec<DVec2> =
                lattice.iter().map(|&(x, y)| DVec2::new(f64::from(x), f64::from(y))).collect();
            prop_assert_eq!(short(&crossings(&nodes, closed).unwrap()), slow(&nodes, closed));
        }

        #[test]
        fn the_grid_finds_what_every_pair_finds_on_uneven_curves(
            steps in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64, -4..4i32), 2..120),
            closed: bool,
        ) {
            // steps of very different sizes
            let mut at = DVec2::ZERO;
            let nodes: Vec<DVec2> = steps
                .iter()
                .map(|&(x, y, size)| {
                    at += DVec2::new(x, y) * 2.0_f64.powi(size);
                    at
                })
                .collect();
            let mut search = Crossings::default();
            search.find(&[DVec2::ZERO, DVec2::X, DVec2::Y], true).unwrap();
            let found = search.find(&nodes, closed).unwrap();
            prop_assert_eq!(short(found), slow(&nodes, closed));
        }
    }
}
