//! The drawn sequences of several objects, scored as the Cell Tracking Challenge does.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use std::collections::BTreeMap;

use score::sequences::{Sequence, sequences};
use score::tracking::{Lineage, TrackScores, Tracks, labelled};
use track::{Options, Start, Tracked, Tracker};

fn sequence(name: &str) -> Sequence {
    let found = sequences().into_iter().find(|one| one.name == name);
    found.unwrap()
}

/// The first and last frames of objects.
type Lives = BTreeMap<u32, (usize, usize)>;

fn lineages(lives: &Lives, parent: impl Fn(u32) -> Option<u32>) -> Vec<Lineage> {
    let one = |(&label, &(begin, end)): (&u32, &(usize, usize))| Lineage {
        label,
        begin,
        end,
        parent: parent(label).unwrap_or(0),
    };
    lives.iter().map(one).collect()
}

fn scored(sequence: &Sequence, births: bool) -> TrackScores {
    let options = Options {
        start: Start::Exact,
        births,
        ..Options::default()
    };
    let image = |t: usize| fit::Image::grey(sequence.frame(t));
    let starts: Vec<fit::Contour> = sequence
        .start()
        .into_iter()
        .map(|one| fit::Contour::closed(one.1))
        .collect();
    let mut tracker = Tracker::new(&image(0), &starts, &options).unwrap();
    let (mut tracks, mut parents) = (Tracks::default(), BTreeMap::new());
    let mut lives = [Lives::new(), Lives::new()];
    for t in 0..sequence.frames() {
        let tracked: Tracked = if t == 0 {
            tracker.first().clone()
        } else {
            tracker.next(&image(t)).unwrap()
        };
        parents.extend(
            tracked
                .outlines
                .iter()
                .filter_map(|one| Some((one.id, one.parent?))),
        );
        let outlines: Vec<_> = tracked
            .outlines
            .into_iter()
            .map(|one| (one.id, one.points))
            .collect();
        let [width, height] = sequence.size;
        let both = [labelled(&outlines, (height, width)), sequence.labels(t)];
        tracks.add(&both[0], &both[1]).unwrap();
        for (lives, labels) in lives.iter_mut().zip(&both) {
            for &label in labels.iter().filter(|label| **label > 0) {
                lives.entry(label).or_insert((t, t)).1 = t;
            }
        }
    }
    let found = lineages(&lives[0], |label| parents.get(&label).copied());
    let truth = lineages(&lives[1], |label| {
        let pair = sequence.parents.iter().find(|pair| pair.0 == label);
        pair.map(|pair| pair.1)
    });
    tracks.finish(&found, &truth).unwrap()
}

#[test]
fn a_crowd_keeps_its_identities() {
    let scores = scored(&sequence("crowd"), true);
    assert!(scores.idf1.unwrap() >= 0.98, "{scores:?}");
    assert!(scores.tra.unwrap() >= 0.98, "{scores:?}");
    assert!(scores.seg.unwrap() >= 0.93, "{scores:?}");
    assert_eq!(scores.divisions, [0, 0, 0]);
}

#[test]
fn a_cell_that_divides_has_two_children() {
    let scores = scored(&sequence("divide"), true);
    assert_eq!(scores.divisions, [1, 0, 0]);
    assert!(scores.seg.unwrap() >= 0.95, "{scores:?}");
    assert!(scores.tra.unwrap() >= 0.98, "{scores:?}");
}

#[test]
fn objects_that_cross_keep_their_identities() {
    for births in [false, true] {
        let scores = scored(&sequence("cross"), births);
        assert!(scores.seg.unwrap() >= 0.97, "{scores:?}");
        assert_eq!(scores.switches, 0);
        assert!(scores.idf1.unwrap() > 0.999, "{scores:?}");
    }
}

#[test]
fn one_object_with_texture_stays_one() {
    let scores = scored(&sequence("amoeba_tex"), true);
    assert_eq!(scores.errors.extra, 0, "{scores:?}");
    assert_eq!(scores.divisions, [0, 0, 0]);
}
