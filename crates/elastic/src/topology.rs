//! How a curve ends, or that it does not: which differences exist.
//!
//! This is the one place where open and closed curves part. Everything that needs to know which edges
//! and bends a curve has asks [`Topology`] here; the energy and the matrix are sums over the answer.
//!
//! An end that slides along a line is a matter of what may move, not of which differences exist: see
//! [`Hold`](crate::Hold). Ends that grow it cannot say yet.

use crate::ElasticError;

/// What holds an end of an open curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum End {
    /// Nothing: the natural end, neither stretched nor bent beyond the last node.
    Free,
    /// Two virtual nodes beyond the end that stay at rest, `e = 0`: the report's program.
    ///
    /// Such an end is held towards its place even without a tether. The report never says so; it is what
    /// its matrix, cut off at both ends, means (D3). The forces no longer sum to zero (D4).
    Anchored,
    /// A nail: the node may not move.
    ///
    /// For energy, force and matrix the same as [`Free`](Self::Free); whoever moves the nodes leaves
    /// those of [`Topology::held`] where they are.
    Pinned,
    /// A vice: the node may not move, and the curve leaves it in the direction it has at rest.
    ///
    /// The node beyond it is the mirror image of the node before it, so that `∂e/∂s = 0` there:
    ///
    /// ```text
    /// e[−1] = e[1],   ∂²e/∂s² = 2 (e[1] − e[0]) / h²   over half a spacing
    /// ```
    ///
    /// Held like a pinned node ([`Topology::held`]). The forces still sum to zero, and a shift costs
    /// nothing. The direction is kept as far as the rigidity of the end node goes; with none the end is
    /// pinned. Second order in the spacing.
    Clamped,
}

impl End {
    /// How many bends there are at this end's node and beyond it.
    const fn bends_beyond(self) -> usize {
        match self {
            Self::Free | Self::Pinned => 0,
            Self::Clamped => 1,
            Self::Anchored => 2,
        }
    }
}

/// Closed, or open with two ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Topology {
    /// The node after the last is the first.
    Closed,
    /// The curve begins at node 0, its head, and ends at the last, its tail.
    Open {
        /// What holds node 0.
        head: End,
        /// What holds the last node.
        tail: End,
    },
}

/// An edge from one node to the next. A node of `None` is virtual and at rest.
pub(crate) struct Edge {
    /// Which tension it takes.
    pub(crate) weight: usize,
    /// Which edge of the curve it is as long as.
    pub(crate) length: usize,
    pub(crate) nodes: [Option<usize>; 2],
}

/// A bend over three nodes in a row. A node of `None` is virtual and at rest.
pub(crate) struct Bend {
    /// Which rigidity it takes.
    pub(crate) weight: usize,
    /// Which edges of the curve its two arms are as long as.
    pub(crate) lengths: [usize; 2],
    /// How much of a spacing it stands for: half, where the other half is a mirror image.
    pub(crate) share: f64,
    pub(crate) nodes: [Option<usize>; 3],
}

/// Positions along the curve are counted from this many virtual nodes before node 0.
const BEFORE: usize = 2;

impl Topology {
    /// Open with the same end twice.
    #[must_use]
    pub const fn open(end: End) -> Self {
        Self::Open {
            head: end,
            tail: end,
        }
    }

    /// Whether the node after the last is the first.
    #[must_use]
    pub const fn is_closed(self) -> bool {
        matches!(self, Self::Closed)
    }

    /// The least number of nodes the differences need: 5 closed, 3 open.
    ///
    /// Below 5 the two arms of a closed second difference squared would meet, and below 3 an open curve
    /// has no bend; the report's program fills its matrix wrongly for 1 and 2 nodes (D65).
    #[must_use]
    pub const fn least_nodes(self) -> usize {
        match self {
            Self::Closed => 5,
            Self::Open { .. } => 3,
        }
    }

    /// Which of `n` nodes may not move: the pinned and the clamped ends.
    #[must_use]
    pub fn held(self, n: usize) -> Vec<bool> {
        let held = |end| matches!(end, End::Pinned | End::Clamped);
        let (head, tail) = match self {
            Self::Closed => (false, false),
            Self::Open { head, tail } => (held(head), held(tail)),
        };
        (0..n)
            .map(|i| (head && i == 0) || (tail && i + 1 == n))
            .collect()
    }

    /// The same curve walked from the other side: head and tail change places.
    #[must_use]
    pub const fn reversed(self) -> Self {
        match self {
            Self::Closed => Self::Closed,
            Self::Open { head, tail } => Self::Open {
                head: tail,
                tail: head,
            },
        }
    }

    /// Refuses fewer than [`least_nodes`](Self::least_nodes).
    pub(crate) const fn check_count(self, n: usize) -> Result<(), ElasticError> {
        if n < self.least_nodes() {
            return Err(ElasticError::TooFewNodes {
                needed: self.least_nodes(),
                got: n,
            });
        }
        Ok(())
    }

    /// Every edge that exists among `n` nodes, from head to tail.
    pub(crate) fn edges(self, n: usize) -> impl Iterator<Item = Edge> {
        let (first, last) = self.edge_range(n);
        (first..last).map(move |k| self.edge(k, n))
    }

    /// The edges besides those from a node to the next in the row: over the seam, beyond anchored ends.
    pub(crate) fn outer_edges(self, n: usize) -> impl Iterator<Item = Edge> {
        let (first, last) = self.edge_range(n);
        (first..BEFORE)
            .chain(BEFORE + n - 1..last)
            .map(move |k| self.edge(k, n))
    }

    /// Every bend that exists among `n` nodes, from head to tail.
    pub(crate) fn bends(self, n: usize) -> impl Iterator<Item = Bend> {
        let (first, last) = self.bend_range(n);
        (first..last).map(move |k| self.bend(k, n))
    }

    /// The bends besides those over three nodes in a row.
    pub(crate) fn outer_bends(self, n: usize) -> impl Iterator<Item = Bend> {
        let (first, last) = self.bend_range(n);
        (first..=BEFORE)
            .chain(BEFORE + n - 1..last)
            .map(move |k| self.bend(k, n))
    }

    const fn edge_range(self, n: usize) -> (usize, usize) {
        match self {
            Self::Closed => (BEFORE, BEFORE + n),
            Self::Open { head, tail } => (
                BEFORE - matches!(head, End::Anchored) as usize,
                BEFORE + n - 1 + matches!(tail, End::Anchored) as usize,
            ),
        }
    }

    const fn bend_range(self, n: usize) -> (usize, usize) {
        match self {
            Self::Closed => (BEFORE, BEFORE + n),
            Self::Open { head, tail } => (
                BEFORE + 1 - head.bends_beyond(),
                BEFORE + n - 1 + tail.bends_beyond(),
            ),
        }
    }

    fn edge(self, k: usize, n: usize) -> Edge {
        Edge {
            weight: self.weight(k, n),
            length: self.length(k, n),
            nodes: [self.node(k, n), self.node(k + 1, n)],
        }
    }

    fn bend(self, k: usize, n: usize) -> Bend {
        let mut nodes = [self.node(k - 1, n), self.node(k, n), self.node(k + 1, n)];
        let mut share = 1.0;
        if let Self::Open { head, tail } = self {
            if k == BEFORE && head == End::Clamped {
                (nodes[0], share) = (nodes[2], 0.5);
            } else if k + 1 == BEFORE + n && tail == End::Clamped {
                (nodes[2], share) = (nodes[0], 0.5);
            }
        }
        Bend {
            weight: self.weight(k, n),
            lengths: [self.length(k - 1, n), self.length(k, n)],
            share,
            nodes,
        }
    }

    /// The node at position `k`, if it is a real one.
    const fn node(self, k: usize, n: usize) -> Option<usize> {
        if self.is_closed() {
            return Some((k + n - BEFORE) % n);
        }
        if k < BEFORE || k >= BEFORE + n {
            None
        } else {
            Some(k - BEFORE)
        }
    }

    /// The index of the edge from position `k` on: beyond an end, that of the last edge before it.
    fn length(self, k: usize, n: usize) -> usize {
        if self.is_closed() {
            (k + n - BEFORE) % n
        } else {
            k.saturating_sub(BEFORE).min(n - 2)
        }
    }

    /// The index of the density at position `k`: beyond an end, that of the end.
    fn weight(self, k: usize, n: usize) -> usize {
        if self.is_closed() {
            (k + n - BEFORE) % n
        } else {
            k.saturating_sub(BEFORE).min(n - 1)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_pinned_and_clamped_ends_are_held() {
        let one = Topology::Open {
            head: End::Pinned,
            tail: End::Anchored,
        };
        assert_eq!(one.held(4), [true, false, false, false]);
        assert_eq!(one.reversed().held(4), [false, false, false, true]);
        let vice = Topology::Open {
            head: End::Free,
            tail: End::Clamped,
        };
        assert_eq!(vice.held(3), [false, false, true]);
        assert_eq!(Topology::open(End::Free).held(3), [false; 3]);
        assert_eq!(Topology::Closed.held(5), [false; 5]);
    }

    #[test]
    fn a_closed_curve_has_as_many_edges_as_nodes_and_a_free_one_fewer() {
        for (topology, edges, bends) in [
            (Topology::Closed, 7, 7),
            (Topology::open(End::Free), 6, 5),
            (Topology::open(End::Pinned), 6, 5),
            (Topology::open(End::Anchored), 8, 9),
            (Topology::open(End::Clamped), 6, 7),
            (
                Topology::Open {
                    head: End::Anchored,
                    tail: End::Free,
                },
                7,
                7,
            ),
        ] {
            assert_eq!(topology.edges(7).count(), edges, "{topology:?}");
            assert_eq!(topology.bends(7).count(), bends, "{topology:?}");
        }
    }

    #[test]
    fn an_edge_beyond_an_anchored_end_takes_the_density_of_the_end() {
        let edges: Vec<_> = Topology::open(End::Anchored)
            .edges(3)
            .map(|e| (e.weight, e.nodes))
            .collect();
        assert_eq!(
            edges,
            [
                (0, [None, Some(0)]),
                (0, [Some(0), Some(1)]),
                (1, [Some(1), Some(2)]),
                (2, [Some(2), None]),
            ]
        );
    }

    #[test]
    fn the_bend_at_a_clamped_end_sees_the_next_node_twice_and_counts_half() {
        let bends: Vec<_> = Topology::open(End::Clamped)
            .bends(4)
            .map(|b| (b.weight, b.share, b.nodes.map(Option::unwrap)))
            .collect();
        assert_eq!(
            bends,
            [
                (0, 0.5, [1, 0, 1]),
                (1, 1.0, [0, 1, 2]),
                (2, 1.0, [1, 2, 3]),
                (3, 0.5, [2, 3, 2]),
            ]
        );
    }

    #[test]
    fn outer_edges_and_bends_are_those_not_in_the_row() {
        for topology in [
            Topology::Closed,
            Topology::open(End::Free),
            Topology::open(End::Anchored),
            Topology::Open {
                head: End::Anchored,
                tail: End::Pinned,
            },
            Topology::Open {
                head: End::Free,
                tail: End::Anchored,
            },
            Topology::Open {
                head: End::Clamped,
                tail: End::Anchored,
            },
            Topology::open(End::Clamped),
        ] {
            for n in [topology.least_nodes(), 9] {
                let row = topology.edges(n).count() - topology.outer_edges(n).count();
                assert_eq!(row, n - 1, "{topology:?}");
                let row = topology.bends(n).count() - topology.outer_bends(n).count();
                assert_eq!(row, n - 2, "{topology:?}");
            }
        }
    }
}
