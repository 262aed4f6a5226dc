//! Scores of sequences against small graphs by hand, and numbers of another program.

use glam::DVec2;
use ndarray::Array2;

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
