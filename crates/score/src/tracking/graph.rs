//! The graph of objects through the frames, and what it takes to put it right.

use std::collections::BTreeMap;

use super::overlaps::Overlaps;

/// How many edits turn the graph that was found into the true one (the acyclic oriented graph measure, AOGM
/// `[matula15]`).
///
/// A node is an object in a frame. An edge joins the node of an object with its next one, or the last node of a parent
/// with the first of a child. A true node and a node found match if the latter covers more than half of the former.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct GraphErrors {
    /// True nodes.
    pub nodes: u64,
    /// True edges.
    pub edges: u64,
    /// Splits of nodes: one less than the true nodes that a node found matches, if it matches several.
    pub split: u64,
    /// True nodes that none matches.
    pub missed: u64,
    /// Nodes found that match none.
    pub extra: u64,
    /// Edges between nodes that match one true node each, where there is no true edge.
    pub deleted: u64,
    /// True edges without one.
    pub added: u64,
    /// Edges within an object that should be from a parent to a child, or the other way round.
    pub changed: u64,
}

impl GraphErrors {
    /// The weighted sum of the edits of nodes: 5 a split, 10 a missed node, 1 an extra one.
    #[must_use]
    pub fn aogm_of_nodes(&self) -> f64 {
        5.0 * self.split as f64 + 10.0 * self.missed as f64 + self.extra as f64
    }

    /// The weighted sum of all: 1 a deleted edge, 1.5 an added one, 1 a changed one.
    #[must_use]
    pub fn aogm(&self) -> f64 {
        let edges = self.deleted as f64 + 1.5 * self.added as f64 + self.changed as f64;
        self.aogm_of_nodes() + edges
    }

    /// `1 − min(AOGM, AOGM₀) / AOGM₀` of the nodes, AOGM₀ that of an empty result; None without true nodes.
    #[must_use]
    pub fn det(&self) -> Option<f64> {
        share(self.aogm_of_nodes(), 10.0 * self.nodes as f64)
    }

    /// The same of nodes and edges.
    #[must_use]
    pub fn tra(&self) -> Option<f64> {
        share(
            self.aogm(),
            10.0 * self.nodes as f64 + 1.5 * self.edges as f64,
        )
    }
}

fn share(sum: f64, empty: f64) -> Option<f64> {
    (empty > 0.0).then(|| 1.0 - sum.min(empty) / empty)
}

/// A node that was found.
#[derive(Debug, Clone, Copy)]
struct Node {
    frame: usize,
    /// The true object, if it matches one and no other.
    truth: Option<u32>,
    /// The frame before in which that object was.
    before: Option<usize>,
}

/// The two graphs as far as they are known.
#[derive(Debug, Default)]
pub(super) struct Graph {
    errors: GraphErrors,
    /// True edges that were found.
    kept: u64,
    /// First and last node of each object found.
    found: BTreeMap<u32, (Node, Node)>,
    /// First and last frame of each true object.
    truth: BTreeMap<u32, (usize, usize)>,
    /// Edges found to the first node of a true object: from which true object and frame, and to which.
    to_first: Vec<(u32, usize, u32)>,
}

impl Graph {
    pub(super) fn add(&mut self, frame: usize, overlaps: &Overlaps) {
        let covering = overlaps.covering();
        let mut covered: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (&truth, &(found, _)) in &covering {
            covered.entry(found).or_default().push(truth);
        }
        let mut before = BTreeMap::new();
        for &object in overlaps.truth.keys() {
            let known = self.truth.get(&object).copied();
            let first = known.map_or(frame, |known| known.0);
            before.insert(object, known.map(|known| known.1));
            self.truth.insert(object, (first, frame));
            self.errors.nodes += 1;
            self.errors.edges += u64::from(known.is_some());
            self.errors.missed += u64::from(!covering.contains_key(&object));
        }
        for &object in overlaps.found.keys() {
            let truth = covered.get(&object).map_or(&[][..], Vec::as_slice);
            self.errors.extra += u64::from(truth.is_empty());
            self.errors.split += (truth.len() as u64).saturating_sub(1);
            let truth = if let [one] = truth { Some(*one) } else { None };
            let before = truth.and_then(|truth| before.get(&truth).copied().flatten());
            let node = Node {
                frame,
                truth,
                before,
            };
            if let Some((_, last)) = self.found.get_mut(&object) {
                let from = std::mem::replace(last, node);
                self.edge(from, node);
            } else {
                self.found.insert(object, (node, node));
            }
        }
    }

    /// An edge within an object that was found.
    fn edge(&mut self, from: Node, to: Node) {
        let (Some(a), Some(b)) = (from.truth, to.truth) else {
            return; // it goes with its node
        };
        if a == b && to.before == Some(from.frame) {
            self.kept += 1;
        } else if a != b && to.before.is_none() {
            self.to_first.push((a, from.frame, b));
        } else {
            self.errors.deleted += 1;
        }
    }

    /// First and last frames of the objects found, and of the true ones.
    pub(super) fn lives(&self) -> [BTreeMap<u32, (usize, usize)>; 2] {
        let found = self.found.iter();
        let found = found.map(|(id, (first, last))| (*id, (first.frame, last.frame)));
        [found.collect(), self.truth.clone()]
    }

    /// With the parents of those that have one.
    pub(super) fn finish(
        self,
        found_parents: &BTreeMap<u32, u32>,
        true_parents: &BTreeMap<u32, u32>,
    ) -> GraphErrors {
        let (mut errors, mut kept) = (self.errors, self.kept);
        errors.edges += true_parents.len() as u64;
        let parent = |parent: u32, frame: usize, child: u32| {
            let ended = self.truth.get(&parent).map(|life| life.1);
            true_parents.get(&child) == Some(&parent) && ended == Some(frame)
        };
        for (a, frame, b) in self.to_first {
            if parent(a, frame, b) {
                kept += 1;
                errors.changed += 1;
            } else {
                errors.deleted += 1;
            }
        }
        for (child, from) in found_parents {
            let (Some((to, _)), Some((_, from))) = (self.found.get(child), self.found.get(from))
            else {
                continue;
            };
            let (Some(a), Some(b)) = (from.truth, to.truth) else {
                continue;
            };
            if a == b && to.before == Some(from.frame) {
                kept += 1;
                errors.changed += 1;
            } else if a != b && to.before.is_none() && parent(a, from.frame, b) {
                kept += 1;
            } else {
                errors.deleted += 1;
            }
        }
        errors.added = errors.edges - kept;
        errors
    }
}
