//! Scores of sequences against slow twins: whole graphs, all assignments, discs laid on boundaries.

use std::collections::{BTreeMap, BTreeSet};

use ndarray::Array2;
use proptest::prelude::*;

use super::*;

/// The same with a disc laid on every pixel of the boundaries, as the toolkit of the challenge does it.
fn slow_boundary_f(found: &Array2<bool>, truth: &Array2<bool>) -> f64 {
    let (height, width) = found.dim();
    let reach = (0.008 * ((height * height + width * width) as f64).sqrt()).ceil() as i64;
    let boundary = |mask: &Array2<bool>| -> BTreeSet<(i64, i64)> {
        let mut on = BTreeSet::new();
        for ((y, x), here) in mask.indexed_iter() {
            for (v, u) in [(y, x + 1), (y + 1, x), (y + 1, x + 1)] {
                if v < height && u < width && mask[[v, u]] != *here {
                    on.insert((y as i64, x as i64));
                }
            }
        }
        on
    };
    let (a, b) = (boundary(found), boundary(truth));
    if a.is_empty() && b.is_empty() {
        return 1.0;
    }
    let share = |of: &BTreeSet<(i64, i64)>, other: &BTreeSet<(i64, i64)>| {
        let mut near = 0;
        for (y, x) in of {
            let within = |(v, u): &(i64, i64)| (y - v).pow(2) + (x - u).pow(2) <= reach * reach;
            near += usize::from(other.iter().any(within));
        }
        if of.is_empty() {
            1.0
        } else {
            near as f64 / of.len() as f64
        }
    };
    let (p, r) = (share(&a, &b), share(&b, &a));
    if p + r > 0.0 {
        2.0 * p * r / (p + r)
    } else {
        0.0
    }
}

/// The least sum of all matches there are.
fn brute(costs: &Array2<f64>) -> f64 {
    fn rest(costs: &Array2<f64>, row: usize, free: &mut Vec<usize>) -> f64 {
        if row == costs.nrows() {
            return 0.0;
        }
        let mut least = f64::INFINITY;
        for k in 0..free.len() {
            let column = free.remove(k);
            least = least.min(costs[[row, column]] + rest(costs, row + 1, free));
            free.insert(k, column);
        }
        least
    }
    let costs = if costs.nrows() > costs.ncols() {
        costs.t().to_owned()
    } else {
        costs.clone()
    };
    rest(&costs, 0, &mut (0..costs.ncols()).collect())
}

/// A node: a frame and an object.
type Node = (usize, u32);

/// The edits from whole graphs: true nodes, true edges; splits, missed, extra, deleted, added, changed.
fn slow_graph(
    found: &[Array2<u32>],
    truth: &[Array2<u32>],
    parents: [&BTreeMap<u32, u32>; 2],
) -> [u64; 8] {
    let graph = |frames: &[Array2<u32>], parents: &BTreeMap<u32, u32>| {
        let mut of: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (t, frame) in frames.iter().enumerate() {
            let labels: BTreeSet<u32> = frame.iter().copied().filter(|label| *label > 0).collect();
            labels
                .iter()
                .for_each(|label| of.entry(*label).or_default().push(t));
        }
        let mut edges: BTreeMap<(Node, Node), bool> = BTreeMap::new();
        for (label, frames) in &of {
            for pair in frames.windows(2) {
                edges.insert(((pair[0], *label), (pair[1], *label)), false);
            }
        }
        for (child, parent) in parents {
            let from = (*of[parent].last().unwrap(), *parent);
            edges.insert((from, (of[child][0], *child)), true);
        }
        let nodes = of
            .iter()
            .flat_map(|(label, frames)| frames.iter().map(|t| (*t, *label)));
        (nodes.collect::<BTreeSet<Node>>(), edges)
    };
    let (nodes, edges) = graph(found, parents[0]);
    let (true_nodes, true_edges) = graph(truth, parents[1]);
    let mut matched: BTreeMap<Node, Vec<Node>> = BTreeMap::new();
    let mut missed = 0;
    for &(t, label) in &true_nodes {
        let covers = |other: &&Node| {
            let pairs = truth[t].iter().zip(&found[t]);
            let own = truth[t].iter().filter(|l| **l == label).count();
            let both = pairs
                .filter(|(a, b)| **a == label && **b == other.1)
                .count();
            other.0 == t && 2 * both > own
        };
        match nodes.iter().find(covers) {
            Some(node) => matched.entry(*node).or_default().push((t, label)),
            None => missed += 1,
        }
    }
    let alone = |node: &Node| {
        matched
            .get(node)
            .filter(|all| all.len() == 1)
            .map(|all| all[0])
    };
    let (mut deleted, mut changed, mut there) = (0, 0, BTreeSet::new());
    for ((from, to), kind) in &edges {
        let (Some(a), Some(b)) = (alone(from), alone(to)) else {
            continue;
        };
        match true_edges.get(&(a, b)) {
            None => deleted += 1,
            Some(true_kind) => {
                changed += u64::from(true_kind != kind);
                there.insert((a, b));
            }
        }
    }
    let split = matched.values().map(|all| all.len() as u64 - 1).sum();
    let extra = (nodes.len() - matched.len()) as u64;
    let (all, added) = (
        true_edges.len() as u64,
        (true_edges.len() - there.len()) as u64,
    );
    [
        true_nodes.len() as u64,
        all,
        split,
        missed,
        extra,
        deleted,
        added,
        changed,
    ]
}

/// A table with the parents that a random choice and the frames allow.
fn table_of(frames: &[Array2<u32>], wanted: &[u32]) -> (Vec<Lineage>, BTreeMap<u32, u32>) {
    let mut lives: BTreeMap<u32, (usize, usize)> = BTreeMap::new();
    for (t, frame) in frames.iter().enumerate() {
        for label in frame.iter().filter(|label| **label > 0) {
            lives.entry(*label).or_insert((t, t)).1 = t;
        }
    }
    let mut parents = BTreeMap::new();
    for (label, parent) in (1..).zip(wanted) {
        if let (Some(own), Some(other)) = (lives.get(&label), lives.get(parent))
            && other.1 < own.0
        {
            parents.insert(label, *parent);
        }
    }
    let line = |(&label, &(begin, end)): (&u32, &(usize, usize))| Lineage {
        label,
        begin,
        end,
        parent: parents.get(&label).copied().unwrap_or(0),
    };
    (lives.iter().map(line).collect(), parents)
}

fn frames() -> impl Strategy<Value = Vec<Array2<u32>>> {
    // few labels in runs, so that many match
    let frame = prop::collection::vec((0u32..7, 1usize..5), 6);
    let line = |runs: Vec<(u32, usize)>| {
        let all = runs
            .into_iter()
            .flat_map(|(label, long)| std::iter::repeat_n(label, long));
        let mut labels: Vec<u32> = all.take(12).collect();
        labels.resize(12, 0);
        Array2::from_shape_vec((1, 12), labels).unwrap()
    };
    prop::collection::vec(frame.prop_map(line), 5)
}

/// What was found: the truth, with some frames of other ones.
fn pairs() -> impl Strategy<Value = (Vec<Array2<u32>>, Vec<Array2<u32>>)> {
    (frames(), frames(), prop::collection::vec(0u32..3, 5)).prop_map(|(truth, other, which)| {
        let one = |((a, b), which): ((&Array2<u32>, &Array2<u32>), &u32)| {
            if *which == 0 {
                b.clone()
            } else {
                a.mapv(|label| if label == 5 { 6 } else { label })
            }
        };
        let found = truth.iter().zip(&other).zip(&which).map(one).collect();
        (found, truth)
    })
}

proptest! {
    #[test]
    fn an_assignment_is_the_best_of_all(
        (rows, columns) in (1usize..6, 1usize..6),
        numbers in prop::collection::vec(-20i32..20, 25),
    ) {
        let costs = Array2::from_shape_fn((rows, columns), |(i, j)| f64::from(numbers[5 * i + j]));
        let got = assignment(&costs).unwrap();
        let chosen: Vec<(usize, usize)> =
            got.iter().enumerate().filter_map(|(i, j)| j.map(|j| (i, j))).collect();
        prop_assert_eq!(chosen.len(), rows.min(columns));
        let different: BTreeSet<usize> = chosen.iter().map(|pair| pair.1).collect();
        prop_assert_eq!(different.len(), chosen.len());
        let sum: f64 = chosen.iter().map(|(i, j)| costs[[*i, *j]]).sum();
        prop_assert_eq!(sum, brute(&costs), "{:?}", costs);
    }

    #[test]
    fn edits_frame_by_frame_are_those_of_whole_graphs(
        (found, truth) in pairs(),
        wanted in prop::collection::vec(1u32..7, 12),
    ) {
        let mut tracks = Tracks::default();
        for (found, truth) in found.iter().zip(&truth) {
            tracks.add(found, truth).unwrap();
        }
        let (own, parents) = table_of(&found, &wanted[..6]);
        let (table, true_parents) = table_of(&truth, &wanted[6..]);
        let got = tracks.finish(&own, &table).unwrap();
        let e = got.errors;
        let all = [e.nodes, e.edges, e.split, e.missed, e.extra, e.deleted, e.added, e.changed];
        prop_assert_eq!(all, slow_graph(&found, &truth, [&parents, &true_parents]));
        for score in [got.seg, got.det, got.tra, got.idf1, got.division_f1()].into_iter().flatten() {
            prop_assert!((0.0..=1.0).contains(&score), "{:?}", got);
        }
    }

    #[test]
    fn numbers_of_objects_do_not_matter(
        (found, truth) in pairs(),
        shuffled in Just((1u32..7).collect::<Vec<_>>()).prop_shuffle(),
    ) {
        let score = |found: &[Array2<u32>]| {
            let mut tracks = Tracks::default();
            for (found, truth) in found.iter().zip(&truth) {
                tracks.add(found, truth).unwrap();
            }
            tracks.finish(&table_of(found, &[]).0, &[]).unwrap()
        };
        let other = |label: u32| if label > 0 { 90 + shuffled[label as usize - 1] } else { 0 };
        let renamed: Vec<Array2<u32>> = found.iter().map(|frame| frame.mapv(other)).collect();
        let (a, b) = (score(&found), score(&renamed));
        // a sum of overlaps may be taken in another order
        prop_assert!((a.seg.unwrap_or(0.0) - b.seg.unwrap_or(0.0)).abs() < 1e-12);
        prop_assert_eq!(TrackScores { seg: None, ..a }, TrackScores { seg: None, ..b });
    }

    #[test]
    fn the_boundary_measure_is_that_of_the_toolkit(
        marks in prop::collection::vec(prop::collection::vec((0usize..150, 0usize..150, 1usize..40), 0..3), 2),
    ) {
        let mask = |marks: &[(usize, usize, usize)]| Array2::from_shape_fn((140, 150), |(y, x)| {
            marks.iter().any(|&(v, u, r)| y.abs_diff(v).pow(2) + x.abs_diff(u).pow(2) <= r * r)
        });
        let (a, b) = (mask(&marks[0]), mask(&marks[1]));
        prop_assert_eq!(boundary_f(&a, &b).unwrap(), slow_boundary_f(&a, &b));
    }
}
