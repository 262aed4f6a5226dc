//! A track that has gone wrong, mended by hand in one frame: the way back from there and the way onwards make it whole.

#![allow(clippy::unwrap_used, reason = "a test may stop")]

use fit::{Contour, Image};
use glam::DVec2;
use track::{Options, Outline, Start, Tracker, blended};

const RADIUS: f64 = 12.0;
const FRAMES: u32 = 15;
const OTHER: DVec2 = DVec2::new(60.0, 78.0);

fn center(t: u32) -> DVec2 {
    let t = f64::from(t);
    DVec2::new(24.0 + 4.0 * t, 30.0 + 4.0 * (0.4 * t).sin())
}

/// A bright disc that moves, and one like it that does not.
fn frame(t: u32) -> Image {
    Image::grey(field::Grid::from_shape_fn((100, 120), |(y, x)| {
        let p = DVec2::new(x as f64, y as f64);
        let inside = |center: DVec2| (RADIUS + 0.5 - p.distance(center)).clamp(0.0, 1.0);
        60.0 + 120.0 * inside(center(t)).max(inside(OTHER))
    }))
}

/// The largest distance of a node from the true circle.
fn off(outline: Option<&Outline>, t: u32) -> f64 {
    let points = outline.map_or(&[][..], |one| &one.points);
    let off = points
        .iter()
        .map(|p| (p.distance(center(t)) - RADIUS).abs());
    off.fold(
        if points.is_empty() {
            f64::INFINITY
        } else {
            0.0
        },
        f64::max,
    )
}

#[test]
fn one_outline_by_hand_mends_what_was_wrong_before_it() {
    let options = Options {
        start: Start::Exact,
        ..Options::default()
    };
    let start = |t: u32| [Contour::circle(center(t), RADIUS)];
    let mut tracker = Tracker::new(&frame(0), &start(0), &options).unwrap();
    let mut onward = vec![tracker.first().outlines.first().cloned()];
    for t in 1..FRAMES {
        if t == 5 {
            // it is made to follow the wrong disc from here on
            let wrong = Contour::circle(OTHER, RADIUS).points;
            tracker.mend(&frame(t - 1), 1, &wrong).unwrap();
        }
        let tracked = tracker.next(&frame(t)).unwrap();
        onward.push(tracked.outlines.first().cloned());
    }
    let wrong = (5..FRAMES).filter(|&t| off(onward[t as usize].as_ref(), t) > 5.0);
    assert_eq!(wrong.count(), 10, "it should follow the wrong disc");
    // the last frame is given
    let last = FRAMES - 1;
    let mut tracker = Tracker::new(&frame(last), &start(last), &options).unwrap();
    let mut back = vec![tracker.first().outlines.first().cloned()];
    for t in (0..last).rev() {
        let tracked = tracker.next(&frame(t)).unwrap();
        back.push(tracked.outlines.first().cloned());
    }
    back.reverse();
    let mended = blended(&onward, &back);
    for (t, outline) in (0..FRAMES).zip(&mended) {
        let off = off(outline.as_ref(), t);
        assert!(off < 1.0, "frame {t}: {off}");
    }
}
