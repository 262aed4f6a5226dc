//! Cutting curves at their crossings into loops that cross no more.
//!
//! At a crossing two strands change partners: who came in on one goes out on the other, each in its own
//! direction. Done at every crossing, this leaves loops that touch at the crossings and cross nowhere, and
//! the number of times they wind around a point adds up to what it was [seifert35].

use crate::crossings::{Crossings, Pair};
use crate::error::check_points;
use crate::orient::orientation;
use crate::segments::push_curve;
use crate::{Meeting, OutlineError, Spot};
use glam::DVec2;

/// Rounds after which crossings that come back are given up.
const ROUNDS: i32 = 24;

/// How far nodes that touch are moved, in parts of the size of the whole: where strands then cross at such an
/// angle is known to 1e-16/1e-7, well below the distance between two such crossings.
const NUDGE: f64 = 1e-7;

/// A place on one of several curves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Source {
    /// Which of the curves, from 0 in the order they were given.
    pub curve: usize,
    /// Where on it.
    pub spot: Spot,
}

/// Where a node of a new outline was on the old ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Origin {
    /// Where the strand that leads to the node was.
    pub arrives: Source,
    /// Where the strand that leads on was; the same place, but at a cut.
    pub leaves: Source,
}

impl Origin {
    /// Whether two strands were joined here.
    #[must_use]
    pub fn is_cut(&self) -> bool {
        self.arrives != self.leaves
    }

    fn node(curve: usize, node: usize) -> Self {
        let source = Source {
            curve,
            spot: Spot {
                edge: node,
                along: 0.0,
            },
        };
        Self {
            arrives: source,
            leaves: source,
        }
    }
}

/// A node of a loop.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Vertex {
    pub(crate) at: DVec2,
    pub(crate) origin: Origin,
}

/// Loops that do not cross themselves, and what was done to get them.
#[derive(Debug, Default)]
pub(crate) struct Loops {
    pub(crate) loops: Vec<Vec<Vertex>>,
    /// How many nodes were moved, and the farthest.
    pub(crate) nudged: (usize, f64),
}

/// Cuts closed curves until no loop meets itself. Loops without three different nodes are left out.
///
/// Touches and overlaps are made crossings or nothing by moving the nodes concerned by some 1e-7 of the
/// size of the whole.
pub(crate) fn cut(curves: &[&[DVec2]]) -> Result<Loops, OutlineError> {
    for nodes in curves {
        check_points("node", nodes)?;
    }
    let start = |(curve, nodes): (usize, &&[DVec2])| {
        let vertex = |(i, &at): (usize, &DVec2)| Vertex {
            at,
            origin: Origin::node(curve, i),
        };
        nodes.iter().enumerate().map(vertex).collect::<Vec<_>>()
    };
    let mut group: Vec<Vec<Vertex>> = curves.iter().enumerate().map(start).collect();
    let extent = extent(&group);
    let mut nudged = (0, 0.0);
    let mut search = Crossings::default();
    let mut most = None;
    for round in 0..=ROUNDS {
        group.iter_mut().for_each(tidy);
        group.retain(|vertices| vertices.len() >= 3);
        search.segments.clear();
        for (k, vertices) in group.iter().enumerate() {
            let nodes: Vec<DVec2> = at(vertices).collect();
            push_curve(&mut search.segments, k, &nodes, true);
        }
        search.search();
        let (strands, pairs) = (Strands::new(&group), search.pairs());
        let pairs: Vec<Pair> = pairs
            .iter()
            .filter(|pair| !strands.are_parted(pair))
            .copied()
            .collect();
        if pairs.is_empty() {
            break;
        }
        most.get_or_insert(10 * pairs.len() + 1000);
        if round == ROUNDS || most.is_some_and(|most| pairs.len() > most) {
            return Err(OutlineError::Unresolved {
                left: pairs.len(),
                rounds: round,
            });
        }
        if pairs.iter().any(|pair| pair.kind != Meeting::Cross) {
            let by = NUDGE * extent * 2.0_f64.powi(round);
            let which = strands.beside(&pairs);
            nudge(&mut group, &which, by, round);
            nudged = (nudged.0 + which.len(), by);
        } else {
            group = strands.exchange(&pairs);
        }
    }
    Ok(Loops {
        loops: group,
        nudged,
    })
}

pub(crate) fn at(vertices: &[Vertex]) -> impl Iterator<Item = DVec2> + '_ {
    vertices.iter().map(|v| v.at)
}

/// The longer side of the box around all.
fn extent(curves: &[Vec<Vertex>]) -> f64 {
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for v in curves.iter().flatten() {
        low = low.min(v.at);
        high = high.max(v.at);
    }
    (high - low).max_element().max(0.0)
}

/// Makes nodes that repeat one node.
fn tidy(vertices: &mut Vec<Vertex>) {
    vertices.dedup_by(|next, kept| {
        let same = next.at == kept.at;
        if same {
            kept.origin.leaves = next.origin.leaves;
        }
        same
    });
    while vertices.len() > 1 && vertices[0].at == vertices[vertices.len() - 1].at {
        if let Some(last) = vertices.pop() {
            vertices[0].origin.arrives = last.origin.arrives;
        }
    }
}

/// Moves some nodes a little, each in a direction of its own.
fn nudge(group: &mut [Vec<Vertex>], which: &[usize], by: f64, round: i32) {
    let mut vertices: Vec<&mut Vertex> = group.iter_mut().flatten().collect();
    for &i in which {
        // the golden and the plastic section fill the square evenly: no two nodes move alike
        let seed = (i + 1) as f64 + 7919.0 * f64::from(round);
        let x = (seed * 0.618_033_988_749_894_9).fract() - 0.5;
        let y = (seed * 0.754_877_666_246_692_8).fract() - 0.5;
        vertices[i].at += 2.0 * by * DVec2::new(x, y);
    }
}

/// All curves in one row. Edge k starts at vertex k.
struct Strands {
    vertices: Vec<Vertex>,
    /// Which curve each belongs to.
    curve: Vec<usize>,
    next: Vec<usize>,
    before: Vec<usize>,
}

impl Strands {
    fn new(group: &[Vec<Vertex>]) -> Self {
        let vertices: Vec<Vertex> = group.iter().flatten().copied().collect();
        let (mut curve, mut next, mut before) = (Vec::new(), Vec::new(), Vec::new());
        for (k, own) in group.iter().enumerate() {
            let (start, n) = (curve.len(), own.len());
            next.extend((0..n).map(|i| start + (i + 1) % n));
            before.extend((0..n).map(|i| start + (i + n - 1) % n));
            curve.resize(start + n, k);
        }
        Self {
            vertices,
            curve,
            next,
            before,
        }
    }

    /// Whether two edges only share the node at which their loops were parted.
    fn are_parted(&self, pair: &Pair) -> bool {
        let node = |edge: u32, t: f64| {
            if t <= 0.0 {
                Some(edge as usize)
            } else {
                (t >= 1.0).then(|| self.next[edge as usize])
            }
        };
        let (Some(one), Some(other)) = (node(pair.one, pair.t), node(pair.other, pair.u)) else {
            return false;
        };
        let at = |i: usize| self.vertices[i].at;
        let cut = |i: usize| self.vertices[i].origin.is_cut();
        if pair.kind != Meeting::Touch || self.curve[one] == self.curve[other] {
            return false;
        }
        if at(one) != at(other) || !cut(one) || !cut(other) {
            return false;
        }
        // and do not go through each other there
        let (a, p, b) = (at(self.before[one]), at(one), at(self.next[one]));
        let within = |q: DVec2| {
            let sides = (orientation(a, p, q) > 0.0, orientation(p, b, q) > 0.0);
            if orientation(a, p, b) > 0.0 {
                sides.0 && sides.1
            } else {
                sides.0 || sides.1
            }
        };
        within(at(self.before[other])) == within(at(self.next[other]))
    }

    /// Both nodes of one edge of every pair that touches or overlaps.
    fn beside(&self, pairs: &[Pair]) -> Vec<usize> {
        let touching = pairs.iter().filter(|pair| pair.kind != Meeting::Cross);
        let mut which: Vec<usize> = touching
            .flat_map(|pair| [pair.other as usize, self.next[pair.other as usize]])
            .collect();
        which.sort_unstable();
        which.dedup();
        which
    }

    /// Changes partners at every crossing and follows the strands round.
    fn exchange(&self, pairs: &[Pair]) -> Vec<Vec<Vertex>> {
        // every crossing lies on two edges: (edge, how far along, which pair, whether its first strand)
        let mut stops: Vec<(usize, f64, usize, bool)> = Vec::with_capacity(2 * pairs.len());
        for (p, pair) in pairs.iter().enumerate() {
            stops.push((pair.one as usize, pair.t, p, true));
            stops.push((pair.other as usize, pair.u, p, false));
        }
        stops.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));

        let mut all = self.vertices.clone();
        let mut next = self.next.clone();
        let mut partners = vec![(0, 0); pairs.len()];
        for on_edge in stops.chunk_by(|a, b| a.0 == b.0) {
            let mut last = on_edge[0].0;
            for &(_, _, p, first) in on_edge {
                let new = all.len();
                all.push(self.crossing(&pairs[p], first));
                next.push(next[last]);
                next[last] = new;
                last = new;
                if first {
                    partners[p].0 = new;
                } else {
                    partners[p].1 = new;
                }
            }
        }
        for &(one, other) in &partners {
            next.swap(one, other);
        }
        let mut seen = vec![false; all.len()];
        let mut loops = Vec::new();
        for start in 0..all.len() {
            let mut vertices = Vec::new();
            let mut here = start;
            while !seen[here] {
                seen[here] = true;
                vertices.push(all[here]);
                here = next[here];
            }
            if !vertices.is_empty() {
                loops.push(vertices);
            }
        }
        loops
    }

    /// The node at a crossing, as its first or its second strand comes to it.
    fn crossing(&self, pair: &Pair, first: bool) -> Vertex {
        let ends = |edge: u32| {
            let edge = edge as usize;
            (&self.vertices[edge], &self.vertices[self.next[edge]])
        };
        let (one, other) = (ends(pair.one), ends(pair.other));
        let at = one.0.at.lerp(one.1.at, pair.t);
        let one = between(one.0, one.1, pair.t);
        let other = between(other.0, other.1, pair.u);
        let (arrives, leaves) = if first { (one, other) } else { (other, one) };
        Vertex {
            at,
            origin: Origin { arrives, leaves },
        }
    }
}

/// Where a fraction of the way from one vertex to the next was on the old curves.
fn between(from: &Vertex, to: &Vertex, t: f64) -> Source {
    let (start, end) = (from.origin.leaves, to.origin.arrives);
    let same = start.curve == end.curve && start.spot.edge == end.spot.edge;
    // on another edge only if that starts where this one ends
    let last = if same { end.spot.along } else { 1.0 };
    let along = start.spot.along + t * (last - start.spot.along);
    Source {
        spot: Spot {
            edge: start.spot.edge,
            along,
        },
        ..start
    }
}
