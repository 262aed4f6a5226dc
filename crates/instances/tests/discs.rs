//! Touching circles whose truth is exact: from seeds and automatically, whatever the picture's levels; and nothing in
//! pictures without objects.

#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test may stop the process, and its numbers are small"
)]

use field::drawn::{covered, noisy, rounded};
use field::{Grid, Smoothing};
use glam::DVec2;
use instances::{Circle, Instances, Rules, SeedError, Seeds, outline_all};
use ndarray::Array2;

const SIDE: usize = 256;

/// Circles on a ground of 60, each with its level: blurred by a pixel, with noise.
fn drawn(circles: &[Circle], levels: &[f64], seed: u64) -> Grid {
    let mut sum = Grid::from_elem((SIDE, SIDE), 60.0);
    for (at, (circle, level)) in circles.iter().zip(levels).enumerate() {
        // an overlap belongs to the nearer
        let own = |p: DVec2| nearest(circles, p) == Some(at);
        assert!(circle.radius > 0.0);
        sum += &covered((SIDE, SIDE), own, (level - 60.0, 0.0));
    }
    let smooth = field::MaskedImage::whole(&sum)
        .unwrap()
        .smoothed(Smoothing::Gaussian(1.0));
    rounded(&noisy(&smooth.unwrap(), 5.0, seed))
}

fn nearest(circles: &[Circle], p: DVec2) -> Option<usize> {
    (0..circles.len())
        .filter(|&at| p.distance(circles[at].center) <= circles[at].radius)
        .min_by(|&a, &b| {
            p.distance(circles[a].center)
                .total_cmp(&p.distance(circles[b].center))
        })
}

fn two() -> Vec<Circle> {
    [88.0, 168.0]
        .map(|x| Circle {
            center: DVec2::new(x, 128.0),
            radius: 40.0,
        })
        .to_vec()
}

fn seven() -> Vec<Circle> {
    let center = DVec2::splat(128.0);
    let turn = |k: u32| 46.0 * DVec2::from_angle(f64::from(k) * std::f64::consts::FRAC_PI_3);
    let all = std::iter::once(center).chain((0..6).map(|k| center + turn(k)));
    all.map(|center| Circle {
        center,
        radius: 24.0,
    })
    .collect()
}

/// The least over the circles of the intersection over the union with the outline of the same place.
fn worst(found: &Instances, circles: &[Circle]) -> f64 {
    let mut worst = 1.0_f64;
    for (at, circle) in circles.iter().enumerate() {
        let middle = found.labels[[
            circle.center.y.round() as usize,
            circle.center.x.round() as usize,
        ]];
        let (mut both, mut either) = (0.0, 0.0);
        for ((y, x), &label) in found.labels.indexed_iter() {
            let inside = nearest(circles, DVec2::new(x as f64, y as f64)) == Some(at);
            let own = label > 0 && label == middle;
            both += f64::from(u8::from(inside && own));
            either += f64::from(u8::from(inside || own));
        }
        worst = worst.min(both / either);
    }
    worst
}

/// Circles of half the radius, as seeds are.
fn inner(circles: &[Circle]) -> Seeds {
    let half = |one: &Circle| Circle {
        center: one.center + DVec2::new(1.0, -0.7),
        radius: 0.5 * one.radius,
    };
    Seeds::Circles(circles.iter().map(half).collect())
}

fn find(picture: Grid, seeds: &Seeds) -> Instances {
    outline_all(&picture, seeds, &Rules::default()).unwrap()
}

#[test]
fn touching_circles_are_kept_apart_from_seeds() {
    for (circles, levels, seed) in [
        (two(), vec![200.0; 2], 21),
        (seven(), vec![200.0; 7], 22),
        (two(), vec![200.0, 120.0], 23),
    ] {
        let found = find(drawn(&circles, &levels, seed), &inner(&circles));
        assert_eq!(
            (found.objects.len(), found.missing.len()),
            (circles.len(), 0)
        );
        let iou = worst(&found, &circles);
        assert!(iou > 0.94, "{iou} of {} circles", circles.len());
        assert!(found.objects.iter().all(|one| !one.cut));
    }
}

#[test]
fn touching_circles_are_found_without_seeds() {
    for (circles, levels, seed) in [
        (two(), vec![200.0; 2], 21),
        (seven(), vec![200.0; 7], 22),
        (two(), vec![200.0, 120.0], 23),
    ] {
        let found = find(drawn(&circles, &levels, seed), &Seeds::Auto);
        assert_eq!(found.objects.len(), circles.len(), "seed {seed}");
        let iou = worst(&found, &circles);
        assert!(iou > 0.9, "{iou} of {} circles", circles.len());
    }
}

#[test]
fn points_and_labels_are_seeds_too() {
    let circles = two();
    let picture = drawn(&circles, &[200.0; 2], 21);
    let points = circles.iter().map(|one| one.center + DVec2::new(5.0, -4.0));
    let found = find(picture.clone(), &Seeds::Points(points.collect()));
    assert_eq!(found.objects.len(), 2);
    assert!(worst(&found, &circles) > 0.9, "{}", worst(&found, &circles));
    let rough = Array2::from_shape_fn((SIDE, SIDE), |(y, x)| {
        let p = DVec2::new(x as f64, y as f64);
        nearest(&circles, p + DVec2::new(3.0, 2.0)).map_or(0, |at| 5 * (at as u32 + 1))
    });
    let found = find(picture, &Seeds::Labels(rough));
    assert_eq!(found.objects.len(), 2);
    assert!(worst(&found, &circles) > 0.94);
}

#[test]
fn a_picture_without_objects_has_none() {
    let flat = Grid::from_elem((120, 160), 90.0);
    for picture in [
        flat.clone(),
        rounded(&noisy(&flat, 8.0, 3)),
        rounded(&noisy(&flat, 40.0, 4)),
        Grid::from_shape_fn((120, 160), |(y, x)| (x + y) as f64 * 0.5),
    ] {
        let found = find(picture, &Seeds::Auto);
        assert!(
            found.objects.is_empty(),
            "{} objects, {:?}",
            found.objects.len(),
            found.objects.first()
        );
        assert!(found.labels.iter().all(|label| *label == 0));
    }
    for dim in [(1, 1), (1, 9), (5, 4)] {
        assert!(
            find(Grid::from_elem(dim, 7.0), &Seeds::Auto)
                .objects
                .is_empty()
        );
    }
}

#[test]
fn nothing_depends_on_the_levels_or_on_the_run() {
    for (circles, seeds) in [(seven(), None), (two(), Some(Seeds::Auto))] {
        let seeds = seeds.unwrap_or_else(|| inner(&circles));
        let picture = drawn(&circles, &vec![200.0; circles.len()], 22);
        let plain = find(picture.clone(), &seeds);
        assert_eq!(plain, find(picture.clone(), &seeds));
        for other in [picture.mapv(|v| 255.0 - v), picture.mapv(|v| 0.25 * v)] {
            let found = find(other, &seeds);
            assert_eq!(found.objects.len(), plain.objects.len());
            let differ = found
                .labels
                .iter()
                .zip(&plain.labels)
                .filter(|(a, b)| a != b);
            let share =
                differ.count() as f64 / plain.labels.iter().filter(|one| **one > 0).count() as f64;
            assert!(share < 0.01, "{share}");
        }
    }
}

#[test]
fn labels_are_the_pixels_inside_the_outlines() {
    let circles = seven();
    let found = find(drawn(&circles, &[200.0; 7], 22), &inner(&circles));
    // the one in the middle touches all others
    assert_eq!(found.objects[0].touching, [2, 3, 4, 5, 6, 7]);
    let mut wrong = 0;
    for ((y, x), &label) in found.labels.indexed_iter() {
        let p = DVec2::new(x as f64, y as f64);
        let inside: Vec<u32> = found
            .objects
            .iter()
            .filter(|one| outline::winding(&one.outline, p) != Some(0))
            .map(|one| one.label)
            .collect();
        wrong += usize::from(!(inside.contains(&label) || (label == 0 && inside.is_empty())));
    }
    // only pixels whose middle is on a border may differ
    assert!(wrong <= 2, "{wrong}");
}

#[test]
fn seeds_that_are_none_are_refused() {
    let picture = Grid::from_elem((20, 30), 1.0);
    let circle = |x: f64, radius: f64| {
        Seeds::Circles(vec![Circle {
            center: DVec2::new(x, 5.0),
            radius,
        }])
    };
    for seeds in [
        circle(40.0, 3.0),
        circle(f64::NAN, 3.0),
        circle(5.0, 0.0),
        circle(5.0, f64::INFINITY),
    ] {
        let refused = outline_all(&picture, &seeds, &Rules::default());
        assert!(
            matches!(refused, Err(SeedError::Circle { number: 1, .. })),
            "{refused:?}"
        );
    }
    let labels = Seeds::Labels(Array2::zeros((20, 31)));
    let refused = outline_all(&picture, &labels, &Rules::default());
    let message = refused.unwrap_err().to_string();
    assert!(
        message.contains("(20, 30)") && message.contains("(20, 31)"),
        "{message}"
    );
}
