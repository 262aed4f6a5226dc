//! Many objects: division, birth, loss, contact, on drawn frames whose truth is known.
#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    reason = "a test fails by them"
)]

use fit::{Contour, Image};
use glam::DVec2;
use track::{Happening, Options, Tracked, Tracker, overlap};

const SIZE: (usize, usize) = (96, 120);
const GROUND: f64 = 60.0;

/// A frame of level 60 where `level` says nothing, by 4 × 4 points of a pixel, with noise within ±8.
fn drawn(t: usize, level: impl Fn(DVec2) -> Option<f64>) -> Image {
    let grid = field::Grid::from_shape_fn(SIZE, |(y, x)| {
        let points = (0..16).map(|k| {
            let part = DVec2::new(f64::from(k % 4), f64::from(k / 4)) / 4.0 - 0.375;
            level(DVec2::new(x as f64, y as f64) + part).unwrap_or(GROUND)
        });
        let noise = field::drawn::uniform(1 + t as u64, (y * SIZE.1 + x) as u64);
        (points.sum::<f64>() / 16.0 + 16.0 * (noise - 0.5)).round()
    });
    Image::grey(grid)
}

fn disc(p: DVec2, x: f64, y: f64, radius: f64) -> bool {
    p.distance(DVec2::new(x, y)) <= radius
}

fn circle(x: f64, y: f64, radius: f64) -> Vec<DVec2> {
    Contour::circle(DVec2::new(x, y), radius).points
}

fn options(births: bool) -> Options {
    Options {
        start: track::Start::Exact,
        births,
        ..Options::default()
    }
}

/// All frames followed.
fn followed(
    frames: usize,
    frame: impl Fn(usize) -> Image,
    starts: &[Vec<DVec2>],
    options: &Options,
) -> Vec<Tracked> {
    let starts: Vec<Contour> = starts.iter().cloned().map(Contour::closed).collect();
    let mut tracker = Tracker::new(&frame(0), &starts, options).unwrap();
    let mut all = vec![tracker.first().clone()];
    all.extend((1..frames).map(|t| tracker.next(&frame(t)).unwrap()));
    all
}

/// Frames and objects of what happened so.
fn happened(all: &[Tracked], what: impl Fn(&Happening) -> bool) -> Vec<(usize, u32)> {
    let events = all.iter().flat_map(|tracked| &tracked.events);
    events
        .filter(|event| what(&event.what))
        .map(|event| (event.frame, event.id))
        .collect()
}

fn ids(tracked: &Tracked) -> Vec<u32> {
    tracked.outlines.iter().map(|one| one.id).collect()
}

/// The overlap of the object of that number with a true outline.
fn fits(tracked: &Tracked, id: u32, truth: &[DVec2]) -> f64 {
    let one = tracked.outlines.iter().find(|one| one.id == id);
    one.map_or(0.0, |one| overlap(&one.points, truth))
}

/// Two discs of radius 14 whose middles part by 4 pixels a frame: apart from frame 8 on.
fn parting(t: usize) -> Image {
    let half = 2.0 * t as f64;
    drawn(t, |p| {
        let both = disc(p, 60.0 - half, 48.0, 14.0) || disc(p, 60.0 + half, 48.0, 14.0);
        both.then_some(180.0)
    })
}

#[test]
fn an_object_that_becomes_two_divides() {
    let all = followed(14, parting, &[circle(60.0, 48.0, 14.0)], &options(true));
    let divided = happened(&all, |what| *what == Happening::Divided([2, 3]));
    assert_eq!(divided.len(), 1, "{divided:?}");
    assert_eq!(divided[0].1, 1);
    assert!((7..=9).contains(&divided[0].0), "{divided:?}");
    for (t, tracked) in all.iter().enumerate() {
        if t < divided[0].0 {
            assert_eq!(ids(tracked), [1], "{t}");
            continue;
        }
        assert_eq!(ids(tracked), [2, 3], "{t}");
        assert!(tracked.outlines.iter().all(|one| one.parent == Some(1)));
        let half = 2.0 * t as f64;
        for truth in [
            circle(60.0 - half, 48.0, 14.0),
            circle(60.0 + half, 48.0, 14.0),
        ] {
            let best = fits(tracked, 2, &truth).max(fits(tracked, 3, &truth));
            assert!(best > 0.95, "{t}: {best}");
        }
    }
}

#[test]
fn nothing_divides_or_is_born_unless_it_may() {
    let all = followed(14, parting, &[circle(60.0, 48.0, 14.0)], &options(false));
    let what = |what: &Happening| matches!(what, Happening::Divided(_) | Happening::Born);
    assert!(happened(&all, what).is_empty());
    assert!(all.iter().all(|tracked| ids(tracked) == [1]));
}

/// Two discs of radius 13 whose middles part to 34 pixels and stay, with a bridge between.
#[test]
fn a_dumbbell_that_never_parts_does_not_divide() {
    for bridge in [3.0, 6.0] {
        let half = |t: usize| (2.0 * t as f64).min(17.0);
        let frame = |t: usize| {
            drawn(t, |p| {
                let discs =
                    disc(p, 60.0 - half(t), 48.0, 13.0) || disc(p, 60.0 + half(t), 48.0, 13.0);
                let between = (p.x - 60.0).abs() <= half(t) && (p.y - 48.0).abs() <= bridge;
                (discs || between).then_some(180.0)
            })
        };
        let all = followed(20, frame, &[circle(60.0, 48.0, 13.0)], &options(true));
        for (t, tracked) in all.iter().enumerate() {
            assert_eq!(
                ids(tracked),
                [1],
                "bridge {bridge}, {t}: {:?}",
                tracked.events
            );
        }
    }
}

#[test]
fn parts_in_contact_are_two_if_a_dark_line_is_between_them() {
    // two discs of radius 14 whose middles part to 26 pixels: with a dark line between them from frame 8 on, or without
    for line in [Some(90.0), Some(110.0), None] {
        let half = |t: usize| (2.0 * t as f64).min(13.0);
        let frame = |t: usize| {
            drawn(t, |p| {
                let both =
                    disc(p, 60.0 - half(t), 48.0, 14.0) || disc(p, 60.0 + half(t), 48.0, 14.0);
                let between = t >= 8 && (p.x - 60.0).abs() < 1.5;
                both.then_some(line.filter(|_| between).unwrap_or(180.0))
            })
        };
        let all = followed(20, frame, &[circle(60.0, 48.0, 14.0)], &options(true));
        let divided = happened(&all, |what| *what == Happening::Divided([2, 3]));
        if line.is_some() {
            assert!(
                divided.len() == 1 && (8..=9).contains(&divided[0].0),
                "{divided:?}"
            );
            assert_eq!(ids(&all[19]), [2, 3]);
            let [a, b] = [0, 1].map(|at| &all[19].outlines[at].points);
            assert!(overlap(a, b) < 2e-3);
            for x in [47.0, 73.0] {
                let truth: Vec<DVec2> = circle(x, 48.0, 14.0)
                    .into_iter()
                    .map(|p| {
                        DVec2::new(
                            if x < 60.0 {
                                p.x.min(60.0)
                            } else {
                                p.x.max(60.0)
                            },
                            p.y,
                        )
                    })
                    .collect();
                let fit = fits(&all[19], 2, &truth).max(fits(&all[19], 3, &truth));
                assert!(fit > 0.9, "{x}: {fit}");
            }
        } else {
            assert!(divided.is_empty(), "{divided:?}");
            assert_eq!(ids(&all[19]), [1]);
        }
    }
}

#[test]
fn a_division_that_does_not_last_is_undone() {
    // two discs of radius 14 part, are 4 pixels apart in frame 8 alone, and are one again
    let half = |t: usize| {
        if t <= 8 {
            2.0 * t as f64
        } else {
            (32.0 - 2.0 * t as f64).max(8.0) - 2.0
        }
    };
    let level = |t: usize, p: DVec2| {
        disc(p, 60.0 - half(t), 48.0, 14.0) || disc(p, 60.0 + half(t), 48.0, 14.0)
    };
    let frame = |t: usize| drawn(t, |p| level(t, p).then_some(180.0));
    let all = followed(20, frame, &[circle(60.0, 48.0, 14.0)], &options(true));
    assert_eq!(
        happened(&all, |what| matches!(what, Happening::Divided(_))),
        [(8, 1)]
    );
    let mut undone = happened(&all, |what| *what == Happening::Merged(1));
    undone.sort_unstable();
    assert_eq!(undone.iter().map(|one| one.1).collect::<Vec<_>>(), [2, 3]);
    assert!(
        undone.iter().all(|one| (9..=10).contains(&one.0)),
        "{undone:?}"
    );
    for tracked in &all[10..] {
        assert_eq!(ids(tracked), [1], "{}", tracked.frame);
    }
    // what it encloses is what was drawn
    let ring = &all[19].outlines[0].points;
    let mask = score::filled(&[&ring[..]], SIZE);
    let truth =
        ndarray::Array2::from_shape_fn(SIZE, |(y, x)| level(19, DVec2::new(x as f64, y as f64)));
    assert!(score::iou(&mask, &truth).unwrap() > 0.95);
}

#[test]
fn what_was_not_there_is_born_once() {
    // one from nothing in frame 4, one over the left border from frame 6 on
    let enters = |t: usize| (-14.0 + 3.0 * (t as f64 - 5.0)).min(20.0);
    let frame = |t: usize| {
        drawn(t, |p| {
            let one = disc(p, 60.0, 30.0 + t as f64, 11.0);
            let other = t >= 4 && disc(p, 95.0, 40.0, 9.0);
            let third = t >= 6 && disc(p, enters(t), 70.0, 10.0);
            (one || other || third).then_some(if other { 200.0 } else { 180.0 })
        })
    };
    let all = followed(24, frame, &[circle(60.0, 30.0, 11.0)], &options(true));
    let born = happened(&all, |what| *what == Happening::Born);
    assert_eq!(born.len(), 2, "{born:?}");
    assert_eq!(born[0], (4, 2));
    assert!(born[1].1 == 3 && (6..=9).contains(&born[1].0), "{born:?}");
    for (t, tracked) in all.iter().enumerate() {
        let truth = circle(60.0, 30.0 + t as f64, 11.0);
        assert!(fits(tracked, 1, &truth) > 0.95, "{t}");
        if t >= 4 {
            assert!(fits(tracked, 2, &circle(95.0, 40.0, 9.0)) > 0.93, "{t}");
        }
        // wholly in the frame from 13 on
        if t >= 16 {
            let fit = fits(tracked, 3, &circle(enters(t), 70.0, 10.0));
            assert!(fit > 0.93, "{t}: {fit}");
        }
    }
    assert_eq!(ids(&all[23]), [1, 2, 3]);
}

#[test]
fn what_is_no_more_is_lost_and_what_returns_is_the_old_one() {
    let frame = |t: usize| {
        drawn(t, |p| {
            let there = !(6..12).contains(&t) && disc(p, 30.0, 48.0, 11.0);
            let other = disc(p, 85.0, 48.0, 11.0);
            (there || other).then_some(180.0)
        })
    };
    let starts = [circle(30.0, 48.0, 11.0), circle(85.0, 48.0, 11.0)];
    let all = followed(18, frame, &starts, &options(true));
    assert_eq!(happened(&all, |what| *what == Happening::Hidden), [(6, 1)]);
    let lost = happened(&all, |what| *what == Happening::Lost);
    assert!(
        lost.len() == 1 && lost[0].1 == 1 && lost[0].0 <= 8,
        "{lost:?}"
    );
    assert_eq!(ids(&all[10]), [2]);
    assert_eq!(happened(&all, |what| *what == Happening::Found), [(12, 1)]);
    assert!(happened(&all, |what| *what == Happening::Born).is_empty());
    for tracked in &all[12..] {
        assert!(fits(tracked, 1, &starts[0]) > 0.95);
    }
}

/// Two discs of radius 14 that come as near as 24 pixels; each ends at the line between them.
fn touching(t: usize) -> ([DVec2; 2], Image) {
    let half = (20.0 - t as f64).abs().max(12.0);
    let places = [DVec2::new(60.0 - half, 48.0), DVec2::new(60.0 + half, 48.0)];
    let image = drawn(t, |p| {
        let side = usize::from(p.x > 60.0);
        (p.distance(places[side]) <= 14.0).then_some([180.0, 205.0][side])
    });
    (places, image)
}

#[test]
fn objects_in_contact_do_not_overlap() {
    for births in [false, true] {
        let starts = [circle(40.0, 48.0, 14.0), circle(80.0, 48.0, 14.0)];
        let all = followed(36, |t| touching(t).1, &starts, &options(births));
        for (t, tracked) in all.iter().enumerate() {
            assert_eq!(ids(tracked), [1, 2], "{t}");
            let [a, b] = [0, 1].map(|at| &tracked.outlines[at].points);
            assert!(overlap(a, b) < 2e-3, "{t}: {}", overlap(a, b));
            for (k, center) in touching(t).0.iter().enumerate() {
                let inwards = |p: DVec2| {
                    let x = if k == 0 { p.x.min(60.0) } else { p.x.max(60.0) };
                    DVec2::new(x, p.y)
                };
                let truth: Vec<DVec2> = circle(center.x, center.y, 14.0)
                    .into_iter()
                    .map(inwards)
                    .collect();
                let fit = fits(tracked, 1 + k as u32, &truth);
                assert!(fit > 0.93, "births {births}, {t}: {fit}");
            }
        }
    }
}

#[test]
fn of_two_outlines_of_one_object_one_ends() {
    let frame = |t: usize| drawn(t, |p| disc(p, 40.0 + t as f64, 48.0, 14.0).then_some(180.0));
    let starts = [circle(40.0, 48.0, 14.0), circle(41.0, 48.0, 13.5)];
    let all = followed(25, frame, &starts, &options(false));
    let merged = happened(&all, |what| matches!(what, Happening::Merged(_)));
    assert_eq!(merged.len(), 1, "{merged:?}");
    let last = &all[24];
    assert_eq!(last.outlines.len(), 1);
    let kept = last.outlines[0].id;
    assert_ne!(kept, merged[0].1);
    assert!(fits(last, kept, &circle(64.0, 48.0, 14.0)) > 0.95);
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let starts = [circle(40.0, 48.0, 14.0), circle(80.0, 48.0, 14.0)];
    let run = |threads| {
        let options = Options {
            threads,
            ..options(true)
        };
        let mut all = followed(20, |t| touching(t).1, &starts, &options);
        all.extend(followed(12, parting, &[circle(60.0, 48.0, 14.0)], &options));
        all
    };
    let one = run(1);
    assert!(one.iter().any(|tracked| tracked.outlines.len() == 2));
    assert_eq!(one, run(2));
    assert_eq!(one, run(5));
}

#[test]
fn what_could_not_be_told_apart_is_two_again_when_it_parts() {
    // two discs of radius 12 become one, stay so for ten frames and part again
    let half = |t: usize| match t {
        0..10 => 20.0 - 2.0 * t as f64,
        10..20 => 0.0,
        _ => (1.5 * (t as f64 - 20.0)).min(24.0),
    };
    let frame = |t: usize| {
        drawn(t, |p| {
            let both = disc(p, 60.0 - half(t), 48.0, 12.0) || disc(p, 60.0 + half(t), 48.0, 12.0);
            both.then_some(180.0)
        })
    };
    let starts = [circle(40.0, 48.0, 12.0), circle(80.0, 48.0, 12.0)];
    let all = followed(40, frame, &starts, &options(true));
    let last = &all[39];
    assert_eq!(ids(last), [1, 2]);
    let new = |what: &Happening| matches!(what, Happening::Divided(_) | Happening::Born);
    assert!(happened(&all, new).is_empty());
    for x in [36.0, 84.0] {
        let truth = circle(x, 48.0, 12.0);
        let best = fits(last, 1, &truth).max(fits(last, 2, &truth));
        assert!(best > 0.95, "{x}: {best}");
    }
}
