//! What cannot be known is said: who is who after two alike have covered each other, what a start on nothing is, what
//! pixels show that are no numbers.

#![allow(clippy::unwrap_used, reason = "a test may stop")]

use fit::{Contour, Image};
use glam::DVec2;
use ndarray::Array2;
use track::{Event, Happening, Options, Start, State, Tracker};

const RADIUS: f64 = 12.0;

/// Discs on a dark ground, each of its own level; those that come later lie in front.
fn drawn(discs: &[(DVec2, f64)]) -> Image {
    Image::grey(field::Grid::from_shape_fn((90, 160), |(y, x)| {
        let p = DVec2::new(x as f64, y as f64);
        discs.iter().fold(60.0, |under, (center, level)| {
            let share = (RADIUS + 0.5 - p.distance(*center)).clamp(0.0, 1.0);
            under + share * (level - under)
        })
    }))
}

fn exact() -> Options {
    Options {
        start: Start::Exact,
        ..Options::default()
    }
}

/// Two discs that run through each other, of these levels: what is told of identities.
fn met(levels: [f64; 2]) -> Vec<Event> {
    let centers = |t: u32| {
        let way = 4.0 * f64::from(t);
        [DVec2::new(30.0 + way, 44.0), DVec2::new(130.0 - way, 45.0)]
    };
    let frame = |t| {
        let [a, b] = centers(t);
        drawn(&[(a, levels[0]), (b, levels[1])])
    };
    let starts = centers(0).map(|center| Contour::circle(center, RADIUS));
    let mut tracker = Tracker::new(&frame(0), &starts, &exact()).unwrap();
    let all = (1..25).flat_map(|t| tracker.next(&frame(t)).unwrap().events);
    let doubt = |event: &Event| matches!(event.what, Happening::Uncertain(_));
    all.filter(doubt).collect()
}

#[test]
fn who_is_who_after_two_alike_have_covered_each_other_is_said_to_be_uncertain() {
    let told = met([180.0, 180.0]);
    let pairs: Vec<(u32, &Happening)> = told.iter().map(|one| (one.id, &one.what)).collect();
    assert_eq!(
        pairs,
        [(1, &Happening::Uncertain(2)), (2, &Happening::Uncertain(1))]
    );
    for event in &told {
        // they cover each other whole in frames 12 and 13, and are apart from frame 16 on
        assert!((14..=18).contains(&event.frame), "{event:?}");
        assert!(
            event.confidence > 0.6 && event.confidence <= 1.0,
            "{event:?}"
        );
    }
}

#[test]
fn two_that_look_otherwise_are_told_apart() {
    assert_eq!(met([180.0, 110.0]), []);
}

#[test]
fn a_click_where_there_is_nothing_is_unsure() {
    for level in [0.0, 60.0] {
        let empty = Image::grey(field::Grid::from_elem((90, 160), level));
        let click = Contour {
            points: vec![DVec2::new(60.0, 40.0)],
            closed: true,
        };
        let Ok(mut tracker) = Tracker::new(&empty, &[click], &Options::default()) else {
            continue;
        };
        let first = tracker.first();
        assert!(first.outlines[0].confidence < 0.1, "{first:?}");
        assert!(first.events[0].confidence < 0.1, "{first:?}");
        let next = tracker.next(&empty).unwrap();
        assert_eq!(next.outlines[0].state, State::Coasting);
        assert!(next.outlines[0].confidence < 0.1);
    }
    // where there is something, it is sure
    let center = DVec2::new(60.0, 40.0);
    let click = Contour {
        points: vec![center],
        closed: true,
    };
    let tracker = Tracker::new(&drawn(&[(center, 180.0)]), &[click], &Options::default());
    let first = tracker.unwrap().first().clone();
    assert!(first.outlines[0].confidence > 0.9, "{first:?}");
}

#[test]
fn confidences_are_from_0_to_1() {
    // the contrast rises threefold
    let center = |t: u32| DVec2::new(40.0 + 2.0 * f64::from(t), 44.0);
    let frame = |t| drawn(&[(center(t), 80.0 + 4.0 * f64::from(t))]);
    let start = [Contour::circle(center(0), RADIUS)];
    let mut tracker = Tracker::new(&frame(0), &start, &exact()).unwrap();
    for t in 1..20 {
        let outline = &tracker.next(&frame(t)).unwrap().outlines[0];
        assert!(
            (0.0..=1.0).contains(&outline.confidence),
            "{}",
            outline.confidence
        );
    }
}

#[test]
fn pixels_that_do_not_count_say_nothing() {
    let center = |t: u32| DVec2::new(30.0 + 4.0 * f64::from(t), 44.0);
    let start = [Contour::circle(center(0), RADIUS)];
    let mut tracker = Tracker::new(&drawn(&[(center(0), 180.0)]), &start, &exact()).unwrap();
    for t in 1..20 {
        let whole = drawn(&[(center(t), 180.0)]);
        let frame = if (8..12).contains(&t) {
            // a patch over a third of the disc holds what is no picture
            let hole = |(y, x): (usize, usize)| {
                (f64::from(u32::try_from(x).unwrap()) - center(t).x - 4.0) > 0.0
                    && (30..58).contains(&y)
                    && (x as f64) < center(t).x + 30.0
            };
            let levels = field::Grid::from_shape_fn((90, 160), |at| {
                if hole(at) {
                    3000.0
                } else {
                    whole.pixels().level(at.1, at.0)
                }
            });
            let valid = Array2::from_shape_fn((90, 160), |at| !hole(at));
            Image::grey(levels).with_mask(valid).unwrap()
        } else {
            whole
        };
        let outline = tracker.next(&frame).unwrap().outlines[0].clone();
        let off = outline
            .points
            .iter()
            .map(|p| (p.distance(center(t)) - RADIUS).abs())
            .fold(0.0, f64::max);
        assert!(off < 2.0, "frame {t}: {off}");
        assert!(outline.state.is_seen(), "frame {t}: {:?}", outline.state);
    }
}
