//! Frames and truths are what the formulas say.

use std::f64::consts::PI;

use field::drawn::{covered, noisy, rounded};

use super::*;
use crate::{Measures, filled, iou};

fn named(name: &str) -> Sequence {
    sequences()
        .into_iter()
        .find(|one| one.name == name)
        .unwrap()
}

fn measured(ring: &[DVec2]) -> Measures {
    Measures::of(&[ring]).unwrap()
}

/// The share of the area of two equal discs that they have in common, by the formula of the lens.
fn lens(radius: f64, apart: f64) -> f64 {
    let half = (0.5 * apart / radius).acos();
    (2.0 * half - (2.0 * half).sin()) / PI
}

#[test]
fn areas_and_centers_are_those_of_the_formulas() {
    for (name, area) in [
        ("move_const", |_| PI * 400.0),
        ("move_fall", |_| PI * 324.0),
        ("move_bounce", |_| PI * 324.0),
        ("kick", |_| PI * 324.0),
        ("turn", |_| PI * 1000.0),
        ("turn_fast", |_| PI * 1000.0),
        ("grow", |t| PI * (12.0 + t) * (12.0 + t)),
        // ½ ∫ r² da = π (base² + ½ Σ size²)
        ("breathe", |t| {
            let size = 12.0 * (0.2 * t).sin();
            PI * (2025.0 + 0.5 * size * size)
        }),
        ("amoeba_tex", |_| PI * (784.0 + 18.0 + 8.0 + 2.0)),
        ("noise_cnr2", |_| PI * 812.0),
        ("fade", |_| PI * 812.0),
        ("occluded", |_| PI * 324.0),
        ("distractor", |_| PI * 256.0),
        ("tongue", |_| PI * 484.0),
        ("camera", |_| PI * 560.0),
        ("cross", |_| PI * 144.0),
    ] as [(&str, fn(f64) -> f64); 16]
    {
        let sequence = named(name);
        for t in 0..40 {
            for (id, ring) in sequence.truth(t) {
                // a polygon of n nodes lacks (2π / n)² / 6 of a circle; of waves, a few times as much
                let (got, exact) = (measured(&ring).area, area(t as f64));
                assert!(
                    (got - exact).abs() < 3e-5 * exact,
                    "{name} {t} {id}: {got} {exact}"
                );
            }
        }
    }
    let turn = measured(&named("turn").truth(10)[0].1);
    assert!((turn.angle - 40.0_f64.to_radians()).abs() < 1e-9);
    let wave = measured(&named("camera").truth(6)[0].1).centroid;
    // the picture is shifted by 15 pixels at the golden angle
    let shift = wave - DVec2::new(66.0 + 9.0, 96.0);
    assert!((shift.length() - 15.0).abs() < 1e-9, "{shift}");
}

#[test]
fn kicks_leave_a_share_of_0_168_in_common() {
    let kick = named("kick");
    let mask = |t: usize| filled(&[kick.truth(t).remove(0).1], (192, 192));
    for t in 0..39 {
        let center = |t: usize| measured(&kick.truth(t)[0].1).centroid;
        let step = center(t + 1).distance(center(t));
        let kicked = kick.events.contains(&(t, 1, Event::Kicked));
        assert_eq!((step - 26.0).abs() < 1e-9, kicked, "{t}: {step}");
        if kicked {
            let share = lens(18.0, step);
            assert!((share - 0.168).abs() < 5e-4, "{share}");
            let (a, b) = (mask(t), mask(t + 1));
            // IoU = share / (2 − share)
            assert!((iou(&a, &b).unwrap() - share / (2.0 - share)).abs() < 0.01);
        }
    }
    assert_eq!(kick.events.len(), 2);
}

#[test]
fn a_frame_is_drawn_as_the_conventions_say_bit_by_bit() {
    let sequence = named("move_const");
    let center = DVec2::new(40.0 + 2.8 * 7.0, 96.0);
    let disc = |p: DVec2| p.distance_squared(center) <= 400.0;
    let slow = crate::synthetic::blurred(&covered((192, 192), disc, (200.0, 60.0)), 1.0);
    assert_eq!(sequence.frame(7), rounded(&noisy(&slow, 5.0, 107)));
}

#[test]
fn where_a_pixel_is_said_to_be_whole_all_its_points_agree() {
    for sequence in sequences() {
        for t in [13, 20] {
            let scene = &sequence.scenes[t];
            for body in &scene.bodies {
                for (x, y) in (0..192).flat_map(|y| (0..192).map(move |x| (x, y))) {
                    let p = DVec2::new(f64::from(x), f64::from(y));
                    let Some(inside) = body.region.whole(p) else {
                        continue;
                    };
                    for (i, j) in [
                        (-1.0, -1.0),
                        (1.0, -1.0),
                        (-1.0, 1.0),
                        (1.0, 1.0),
                        (0.0, 0.0),
                    ] {
                        let q = p + DVec2::new(i, j) * 7.0 / 16.0;
                        assert_eq!(body.region.holds(q), inside, "{} {t} {q}", sequence.name);
                    }
                    let far = p.distance(body.region.center);
                    assert!(!inside || far <= body.region.reach());
                }
            }
        }
    }
}

#[test]
fn half_way_between_the_levels_lies_the_truth() {
    for sequence in sequences() {
        // others have textures, or things that are no objects, or objects of different levels
        let flat = |scene: &Scene| {
            let one = scene.bodies.first().map(|body| body.level);
            let plain = |b: &Body| b.id > 0 && b.texture.is_none() && Some(b.level) == one;
            scene.texture.is_none() && scene.bodies.iter().all(plain)
        };
        if !sequence.scenes.iter().all(flat) {
            continue;
        }
        for t in (0..40).step_by(3) {
            let scene = &sequence.scenes[t];
            let half = 0.5 * (scene.ground + scene.bodies[0].level);
            let picture = sequence.clean(t);
            let labels = sequence.labels(t);
            let curves: Vec<Vec<DVec2>> = sequence.truth(t).into_iter().map(|one| one.1).collect();
            for ((y, x), label) in labels.indexed_iter() {
                if (picture[[y, x]] >= half) != (*label > 0) {
                    let p = DVec2::new(x as f64, y as f64);
                    let far = curves.iter().map(|c| outline::distance(c, true, p));
                    let far = far.fold(f64::INFINITY, f64::min);
                    // where two are near, and where the neck closes, the blur of both adds up
                    assert!(far <= 0.6, "{} {t}: {p} {far}", sequence.name);
                }
            }
        }
    }
}

#[test]
fn frames_differ_and_are_the_same_each_time() {
    let (all, again) = (sequences(), sequences());
    assert_eq!(all, again);
    let names: std::collections::BTreeSet<&str> = all.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names.len(), all.len());
    for sequence in &all {
        assert_eq!((sequence.frames(), sequence.size), (40, [192, 192]));
        assert_eq!(sequence.frame(11), sequence.frame(11));
        let still = ["leave", "vanish", "divide"].contains(&sequence.name.as_str());
        for t in 1..40 {
            let (a, b) = (&sequence.scenes[t - 1], &sequence.scenes[t]);
            assert!(still || a != b, "{} {t}", sequence.name);
        }
        assert!(still || sequence.clean(1) != sequence.clean(2));
        assert_ne!(sequence.frame(1), sequence.frame(2));
        let start = sequence.start();
        assert!(!start.is_empty() && start == sequence.truth(0));
    }
}

#[test]
fn what_is_hidden_or_left_has_no_truth_and_what_happens_is_said() {
    let vanish = named("vanish");
    let leave = named("leave");
    for t in 0..40 {
        assert_eq!(vanish.truth(t).is_empty(), (15..20).contains(&t));
        assert_eq!(vanish.bodies(t).len(), 1);
        assert_eq!(leave.truth(t).is_empty(), (16..24).contains(&t), "{t}");
        for (_, ring) in leave.truth(t) {
            assert!(ring.iter().all(|p| p.x <= 191.5));
        }
    }
    // at frame 12 the center is 2.5 pixels inside: half a disc and a strip
    let area = measured(&leave.truth(12)[0].1).area;
    let x = 191.5 - (209.5 + 5.0 * (4.0 - 7.5));
    let exact = 324.0 * (PI - (x / 18.0_f64).acos()) + x * (324.0 - x * x).sqrt();
    assert!((area - exact).abs() < 0.05, "{area} {exact}");
    for sequence in sequences() {
        let ids = |t: usize| {
            sequence
                .truth(t)
                .into_iter()
                .map(|one| one.0)
                .collect::<Vec<_>>()
        };
        for t in 1..40 {
            let (before, now) = (ids(t - 1), ids(t));
            let comes = |event: &Event| matches!(event, Event::Born | Event::Returned);
            let goes = |event: &Event| {
                matches!(
                    event,
                    Event::Vanished | Event::Left | Event::Lost | Event::Divided
                )
            };
            let said = |which: &dyn Fn(&Event) -> bool, id: u32| {
                let here =
                    |(at, of, event): &(usize, u32, Event)| *at == t && *of == id && which(event);
                sequence.events.iter().any(here)
            };
            for id in 1..30 {
                let came = now.contains(&id) && !before.contains(&id);
                let went = before.contains(&id) && !now.contains(&id);
                assert_eq!(said(&comes, id), came, "{} {t} {id}", sequence.name);
                assert_eq!(said(&goes, id), went, "{} {t} {id}", sequence.name);
            }
        }
    }
}

#[test]
fn a_division_keeps_the_area_and_parts_at_frame_20() {
    let divide = named("divide");
    assert_eq!(divide.parents, [(2, 1), (3, 1)]);
    for t in 0..40 {
        let truth = divide.truth(t);
        assert_eq!(truth.len(), if t < 20 { 1 } else { 2 });
        let area: f64 = truth.iter().map(|one| measured(&one.1).area).sum();
        assert!((area - PI * 784.0).abs() < 1e-3 * PI * 784.0, "{t} {area}");
        if t >= 20 {
            let gap = truth[0]
                .1
                .iter()
                .map(|p| outline::distance(&truth[1].1, true, *p));
            let gap = gap.fold(f64::INFINITY, f64::min);
            assert_eq!(gap < 1e-3, t == 20, "{t} {gap}");
        }
    }
}

#[test]
fn two_that_cross_overlap_in_six_frames_and_those_that_pass_never() {
    let cross = named("cross");
    let apart = |s: &Sequence, t: usize| {
        let at: Vec<DVec2> = s
            .bodies(t)
            .iter()
            .map(|one| measured(&one.1).centroid)
            .collect();
        at[0].distance(at[1])
    };
    for t in 0..40 {
        assert_eq!(apart(&cross, t) < 24.0, (17..=22).contains(&t), "{t}");
    }
    let distractor = named("distractor");
    let gap = |t: usize| {
        let [a, b] = [0, 1].map(|k| distractor.scenes[t].bodies[k].region.center);
        a.distance(b) - 32.0
    };
    let least = (0..40).map(gap).fold(f64::INFINITY, f64::min);
    assert!((3.0..3.1).contains(&least), "{least}");
}

#[test]
fn a_crowd_touches_without_overlap_and_parts() {
    let crowd = named("crowd");
    assert_eq!(crowd.start().len(), 20);
    let mut met = std::collections::BTreeSet::new();
    let mut parted = std::collections::BTreeSet::new();
    for t in 0..40 {
        let truth = crowd.truth(t);
        let masks: Vec<Array2<bool>> = truth
            .iter()
            .map(|one| filled(&[&one.1], (192, 192)))
            .collect();
        let sum = masks.iter().flatten().filter(|inside| **inside).count();
        let union = crowd.labels(t).iter().filter(|label| **label > 0).count();
        assert_eq!(sum, union, "{t}: none share a pixel");
        let bodies = &crowd.scenes[t].bodies;
        for (i, one) in bodies.iter().enumerate() {
            for other in &bodies[..i] {
                let apart = one.region.center.distance(other.region.center);
                let gap = apart - one.region.reach() - other.region.reach();
                assert!(gap > -1.6, "{t} {} {}: {gap}", one.id, other.id);
                if gap < 0.0 {
                    met.insert((one.id, other.id));
                } else if met.contains(&(one.id, other.id)) {
                    parted.insert((one.id, other.id));
                }
            }
        }
    }
    assert!(
        met.len() >= 10 && parted.len() >= 6,
        "{} {}",
        met.len(),
        parted.len()
    );
    let count = |event: Event| crowd.events.iter().filter(|one| one.2 == event).count();
    assert_eq!(
        [count(Event::Born), count(Event::Lost), count(Event::Left)],
        [4, 3, 1]
    );
}

#[test]
fn texture_has_its_deviation_and_moves_with_what_bears_it() {
    let texture = scene::Texture {
        size: 15.0,
        seed: 7002,
    };
    let lattice = scene::Lattice::of(texture);
    let places =
        (0..640).flat_map(|y| (0..640).map(move |x| DVec2::new(f64::from(x), f64::from(y)) / 2.0));
    let levels: Vec<f64> = places.map(|p| lattice.at(p)).collect();
    let mean = levels.iter().sum::<f64>() / levels.len() as f64;
    let spread = levels.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / levels.len() as f64;
    // of 64 × 64 independent numbers: a few hundredths
    assert!(
        (spread.sqrt() - 15.0).abs() < 0.5 && mean.abs() < 1.0,
        "{mean} {spread}"
    );
    // the ground of `camera` at the jerk of frame 2, by (15, 0); its object has not turned far
    let camera = named("camera");
    let (before, after) = (camera.clean(1), camera.clean(2));
    for (x, y) in [(20, 30), (100, 170), (150, 40), (170, 120)] {
        assert!((before[[y, x]] - after[[y, x + 15]]).abs() <= 1.0);
    }
    // a point of the ellipse that turns by 12 degrees a frame
    let turn = named("turn_fast");
    let (body, next) = (
        &turn.scenes[3].bodies[0].region,
        &turn.scenes[4].bodies[0].region,
    );
    let arm = DVec2::from_angle(36.0_f64.to_radians()) * 30.0;
    let moved = DVec2::from_angle(12.0_f64.to_radians()).rotate(arm);
    let (a, b) = (
        body.material(body.center + arm),
        next.material(next.center + moved),
    );
    assert!(a.distance(b) < 1e-12, "{a} {b}");
}
