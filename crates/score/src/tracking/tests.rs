//! Scores of sequences against small graphs by hand, slow twins, and numbers of another program.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;
use ndarray::Array2;
use proptest::prelude::*;

use super::*;

fn row(text: &str) -> Array2<u32> {
    let labels: Vec<u32> = text.chars().map(|c| c.to_digit(36).unwrap()).collect();
    Array2::from_shape_vec((1, labels.len()), labels).unwrap()
}

fn lines(table: &[[usize; 4]]) -> Vec<Lineage> {
    let line = |&[label, begin, end, parent]: &[usize; 4]| Lineage {
        label: label as u32,
        begin,
        end,
        parent: parent as u32,
    };
    table.iter().map(line).collect()
}

/// The scores of frames of one line of pixels each.
fn scored(
    found: &[&str],
    truth: &[&str],
    found_table: &[[usize; 4]],
    true_table: &[[usize; 4]],
) -> TrackScores {
    let mut tracks = Tracks::default();
    for (found, truth) in found.iter().zip(truth) {
        tracks.add(&row(found), &row(truth)).unwrap();
    }
    tracks
        .finish(&lines(found_table), &lines(true_table))
        .unwrap()
}

/// Random sequences and what py-ctcmetrics 1.3.3 (the Python package of the Cell Tracking Challenge) says of them:
/// splits, missed, extra, deleted, added, changed; divisions right, wrong, missed at a tolerance of 1; SEG, DET, TRA;
/// and IDF1 of tracks as they are, where its match by coverage is the same as one by intersection over union.
#[test]
fn numbers_are_those_of_another_program() {
    let mut count = 0;
    for line in include_str!("tests/cases.txt").lines().skip(1) {
        let part: Vec<&str> = line.split(' ').collect();
        let frames = |text: &'static str| text.split('/').collect::<Vec<_>>();
        let table = |text: &str| -> Vec<[usize; 4]> {
            let line = |line: &str| {
                let numbers: Vec<usize> = line.split(',').map(|n| n.parse().unwrap()).collect();
                numbers.try_into().unwrap()
            };
            text.split(';').map(line).collect()
        };
        let (truth, found) = (frames(part[0]), frames(part[1]));
        let got = scored(&found, &truth, &table(part[3]), &table(part[2]));
        let e = got.errors;
        let counts = [e.split, e.missed, e.extra, e.deleted, e.added, e.changed];
        let all: Vec<String> = counts
            .iter()
            .chain(&got.divisions)
            .map(u64::to_string)
            .collect();
        assert_eq!(all.join(","), part[4], "{line}");
        let numbers: Vec<f64> = part[5].split(',').map(|n| n.parse().unwrap()).collect();
        let [seg, det, tra, idf1] = [got.seg, got.det, got.tra, got.idf1].map(Option::unwrap);
        for (got, want) in [seg, det, tra].iter().zip(&numbers) {
            assert!((got - want).abs() < 1e-11, "{line}: {got} {want}");
        }
        if numbers[3] >= 0.0 {
            assert!((idf1 - numbers[3]).abs() < 1e-11, "{line}: {idf1}");
        }
        count += 1;
    }
    assert_eq!(count, 8);
}

#[test]
fn a_perfect_result_scores_one_and_an_empty_one_nothing() {
    let truth = ["1110222", "1110222", "3344222", "3344022"];
    let table = [[1, 0, 1, 0], [2, 0, 3, 0], [3, 2, 3, 1], [4, 2, 3, 1]];
    let got = scored(&truth, &truth, &table, &table);
    assert_eq!([got.seg, got.det, got.tra, got.idf1], [Some(1.0); 4]);
    assert_eq!(
        (got.division_f1(), got.switches, got.frames),
        (Some(1.0), 0, 4)
    );
    assert_eq!(
        (got.errors.nodes, got.errors.edges, got.errors.aogm()),
        (10, 8, 0.0)
    );
    let got = scored(&["0000000"; 4], &truth, &[], &table);
    assert_eq!([got.seg, got.det, got.tra, got.idf1], [Some(0.0); 4]);
    assert_eq!((got.division_f1(), got.divisions), (Some(0.0), [0, 0, 1]));
    assert_eq!(got.errors.aogm(), 10.0 * 10.0 + 1.5 * 8.0);
    // what is found where there is nothing has no share, but a mean over all of 0
    let got = scored(&truth, &["0000000"; 4], &table, &[]);
    assert_eq!(
        [got.seg, got.det, got.tra, got.idf1],
        [None, None, None, Some(0.0)]
    );
    let got = scored(&["000"], &["000"], &[], &[]);
    assert_eq!((got.idf1, got.division_f1()), (None, None));
}

#[test]
fn each_edit_of_the_graph_costs_its_weight() {
    let truth = ["11100222", "11100222", "11100222"];
    let table = [[1, 0, 2, 0], [2, 0, 2, 0]];
    let aogm =
        |found: &[&str], own: &[[usize; 4]]| scored(found, &truth, own, &table).errors.aogm();
    // one node missing takes its two edges along: the track goes on after it
    let own = [[1, 0, 2, 0], [2, 0, 2, 0]];
    assert_eq!(
        aogm(&["11100222", "00000222", "11100222"], &own),
        10.0 + 1.0 + 2.0 * 1.5
    );
    // as two tracks there is no edge to delete
    let two = [[1, 0, 0, 0], [2, 0, 2, 0], [3, 2, 2, 0]];
    assert_eq!(
        aogm(&["11100222", "00000222", "33300222"], &two),
        10.0 + 2.0 * 1.5
    );
    // one extra node
    let extra = [[1, 0, 2, 0], [2, 0, 2, 0], [3, 1, 1, 0]];
    assert_eq!(aogm(&["11100222", "11130222", "11100222"], &extra), 1.0);
    // one node for two: a split, an edge past it, and all edges of both missing
    assert_eq!(
        aogm(
            &["11100222", "11111111", "11100222"],
            &[[1, 0, 2, 0], [2, 0, 2, 0]]
        ),
        5.0 + 1.0 + 4.0 * 1.5
    );
    // identities exchanged once: two edges wrong, two missing
    assert_eq!(
        aogm(&["11100222", "11100222", "22200111"], &own),
        2.0 + 2.0 * 1.5
    );
    // cut in two that are parent and child: the edge is there, with another meaning
    let cut = [[1, 0, 0, 0], [2, 0, 2, 0], [3, 1, 2, 1]];
    assert_eq!(aogm(&["11100222", "33300222", "33300222"], &cut), 1.0);
}

#[test]
fn identities_count_over_the_whole_sequence() {
    // exchanged at the third of five frames: 6 of 10 stay in the best match
    let truth = ["110022"; 5];
    let found = ["110022", "110022", "220011", "220011", "220011"];
    let table = [[1, 0, 4, 0], [2, 0, 4, 0]];
    let got = scored(&found, &truth, &table, &table);
    assert_eq!((got.idf1, got.switches), (Some(0.6), 2));
    assert_eq!((got.seg, got.det), (Some(1.0), Some(1.0)));
    // lost for a frame and found again is no switch; found as another one is
    let found = ["110022", "000022", "110022", "000022", "330022"];
    let own = [[1, 0, 2, 0], [2, 0, 4, 0], [3, 4, 4, 0]];
    let got = scored(&found, &truth, &own, &table);
    assert_eq!((got.idf1, got.switches), (Some(2.0 * 7.0 / 18.0), 1));
}

#[test]
fn a_division_may_be_found_a_frame_early_or_late_but_not_two() {
    let truth = ["111100", "111100", "111100", "223300", "223300", "223300"];
    let table = [[1, 0, 2, 0], [2, 3, 5, 1], [3, 3, 5, 1]];
    let at = |frame: usize| {
        let found: Vec<&str> = (0..6)
            .map(|t| if t < frame { "111110" } else { "223330" })
            .collect();
        let own = [[1, 0, frame - 1, 0], [2, frame, 5, 1], [3, frame, 5, 1]];
        scored(&found, &truth, &own, &table).divisions
    };
    let all: Vec<[u64; 3]> = (1..6).map(at).collect();
    // early children cover none of the undivided parent by more than half at their first frame, but do when it divides
    assert_eq!(all, [[0, 1, 1], [1, 0, 0], [1, 0, 0], [1, 0, 0], [0, 1, 1]]);
}

#[test]
fn tables_that_do_not_fit_are_refused() {
    let frames = ["1122", "1100", "3333"];
    for (table, message) in [
        (
            &[[1, 0, 1, 0], [2, 0, 0, 0]][..],
            "the found object 3 is in a frame, but not in the table",
        ),
        (
            &[[1, 0, 2, 0]],
            "the found object 1 is in the frames 0 to 1, but the table has 0 to 2",
        ),
        (
            &[[7, 0, 2, 0]],
            "the found object 7 is in the table, but in no frame",
        ),
        (
            &[[1, 0, 1, 0], [1, 0, 1, 0]],
            "the found object 1 is in the table twice",
        ),
        (
            &[[1, 0, 1, 0], [2, 0, 0, 0], [3, 2, 2, 9]],
            "the found object 3 has the parent 9, which is not in the table",
        ),
        (
            &[[1, 0, 1, 3], [2, 0, 0, 0], [3, 2, 2, 0]],
            "the found object 1 begins in frame 0; its parent 3 must end before, got 2",
        ),
    ] {
        let mut tracks = Tracks::default();
        for frame in frames {
            tracks.add(&row(frame), &row(frame)).unwrap();
        }
        let error = tracks.finish(&lines(table), &[]).unwrap_err();
        assert_eq!(error.to_string(), message);
    }
    let error = Tracks::default().add(&row("11"), &row("111")).unwrap_err();
    assert!(error.to_string().contains("sizes must be equal"));
    let costs = Array2::from_elem((2, 2), f64::NAN);
    let error = assignment(&costs).unwrap_err().to_string();
    assert_eq!(error, "costs must be finite, got NaN in row 0 and column 0");
}

#[test]
fn an_exact_truth_followed_exactly_scores_one() {
    let all = crate::sequences::sequences();
    for sequence in all
        .iter()
        .filter(|s| ["leave", "breathe", "vanish"].contains(&&*s.name))
    {
        let mut following = Following::new((192, 192));
        for t in 0..sequence.frames() {
            let truth: Vec<Vec<DVec2>> = sequence.truth(t).into_iter().map(|one| one.1).collect();
            following.add(&truth, &truth, true).unwrap();
        }
        let got = following.finish().unwrap();
        assert_eq!(
            (got.frames, got.iou, got.last, got.worst),
            (39, 1.0, 1.0, 1.0)
        );
        assert_eq!((got.j_and_f(), got.lost), (Some(1.0), 0.0));
        assert!(got.f > 1.0 - 1e-12);
        assert!(got.distance.unwrap() < 1e-9);
    }
    let crowd = all.iter().find(|s| s.name == "crowd").unwrap();
    let mut tracks = Tracks::default();
    for t in 0..crowd.frames() {
        let labels = crowd.labels(t);
        tracks.add(&labels, &labels).unwrap();
    }
    let got = tracks.finish(&[], &[]).unwrap();
    assert_eq!([got.seg, got.det, got.tra, got.idf1], [Some(1.0); 4]);
}

#[test]
fn means_leave_out_the_first_frame_and_the_challenge_also_the_last() {
    let square = |x: f64| {
        let corners = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)];
        vec![
            corners
                .map(|corner| DVec2::from(corner) + DVec2::new(x + 0.5, 5.5))
                .to_vec(),
        ]
    };
    let mut following = Following::new((20, 40));
    // shifted by 1, 0, 5, 12 pixels: 9/11, 1, 1/3, 0
    for shift in [1.0, 0.0, 5.0, 12.0] {
        following
            .add(&square(shift), &square(0.0), shift > 3.0)
            .unwrap();
    }
    let got = following.finish().unwrap();
    let mean = (1.0 + 1.0 / 3.0) / 3.0;
    assert!((got.iou - mean).abs() < 1e-15 && got.frames == 3);
    assert!((got.j.unwrap() - 2.0 / 3.0).abs() < 1e-15);
    assert_eq!((got.last, got.worst), (0.0, 0.0));
    assert!((got.lost - 1.0 / 3.0).abs() < 1e-15 && (got.sure_and_lost - 1.0 / 3.0).abs() < 1e-15);
    let mut following = Following::new((20, 40));
    assert_eq!(following.clone().finish(), None);
    following.add(&square(0.0), &square(0.0), true).unwrap();
    assert_eq!(following.clone().finish(), None);
    following.add(&square(0.0), &square(0.0), true).unwrap();
    let got = following.finish().unwrap();
    assert_eq!((got.iou, got.j, got.j_and_f()), (1.0, None, None));
}

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
