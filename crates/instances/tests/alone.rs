//! Objects without seeds: drawn circles of many sizes and levels are each found once, and nothing else is.

#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test may stop the process, and its numbers are small"
)]

use field::drawn::{covered, noisy, rounded};
use field::{Grid, Smoothing};
use glam::DVec2;
use instances::{Instances, Rules, Seeds, outline_all};

/// A circle and what it adds to the ground.
type Disk = (DVec2, f64, f64);

/// Circles on a ground of 40 that rises by `slope` a pixel to the right, blurred by a pixel, with noise.
fn drawn(dim: (usize, usize), disks: &[Disk], slope: f64, noise: f64, seed: u64) -> Grid {
    let mut sum = Grid::from_shape_fn(dim, |(_, x)| 40.0 + slope * x as f64);
    for &(center, radius, level) in disks {
        sum += &covered(dim, |p| p.distance(center) <= radius, (level, 0.0));
    }
    let smooth = field::MaskedImage::whole(&sum).unwrap();
    let smooth = smooth.smoothed(Smoothing::Gaussian(1.0)).unwrap();
    rounded(&noisy(&smooth, noise, seed))
}

fn find(picture: Grid) -> Instances {
    outline_all(&picture, &Seeds::Auto, &Rules::default()).unwrap()
}

/// Each circle must be one object that has at least so much of their union in common, and there must be no other.
fn each_once(found: &Instances, disks: &[Disk], least: f64, what: &str) {
    for &(center, radius, level) in disks {
        let middle = found.labels[[center.y.round() as usize, center.x.round() as usize]];
        assert!(
            middle > 0,
            "{what}: none at {center} of radius {radius}, level {level}"
        );
        let (mut both, mut either) = (0.0, 0.0);
        for ((y, x), &label) in found.labels.indexed_iter() {
            let inside = DVec2::new(x as f64, y as f64).distance(center) <= radius;
            both += f64::from(u8::from(inside && label == middle));
            either += f64::from(u8::from(inside || label == middle));
        }
        assert!(
            both > least * either,
            "{what}: {} at {center} of radius {radius}, level {level}",
            both / either
        );
    }
    assert_eq!(found.objects.len(), disks.len(), "{what}");
}

/// Circles in rows whose radii and levels are taken in turn.
fn rows(dim: (usize, usize), radii: &[f64], levels: &[f64]) -> Vec<Disk> {
    let most = radii.iter().fold(0.0, |most: f64, one| most.max(*one));
    let step = 2.0 * most + 9.0;
    let mut out = Vec::new();
    let mut y = most + 6.0;
    while y + most + 4.0 < dim.0 as f64 {
        let mut x = most + 6.0;
        while x + most + 4.0 < dim.1 as f64 {
            let at = out.len();
            let shift = DVec2::new((at % 3) as f64, (at % 5) as f64 * 0.7);
            let disk = (
                DVec2::new(x, y) + shift,
                radii[at % radii.len()],
                levels[at % levels.len()],
            );
            out.push(disk);
            x += step;
        }
        y += step;
    }
    out
}

#[test]
fn bright_and_dim_ones_are_found_in_one_picture() {
    let disks = rows((260, 300), &[14.0], &[150.0, 25.0, 60.0]);
    assert!(disks.len() > 30);
    let picture = drawn((260, 300), &disks, 0.0, 2.0, 5);
    each_once(&find(picture.clone()), &disks, 0.85, "light");
    each_once(&find(picture.mapv(|v| 255.0 - v)), &disks, 0.85, "dark");
}

#[test]
fn a_ground_that_is_not_even_hides_none() {
    let disks = rows((240, 300), &[16.0, 11.0], &[60.0]);
    // the ground at the right is lighter than circles at the left
    let picture = drawn((240, 300), &disks, 0.4, 3.0, 6);
    each_once(&find(picture), &disks, 0.85, "slope");
}

#[test]
fn small_and_large_ones_are_found_in_one_picture() {
    let radii = [60.0, 5.0, 30.0, 12.0, 45.0, 8.0, 20.0];
    let dim = (420, 560);
    let disks = rows(dim, &radii, &[100.0]);
    assert!(disks.len() > 11);
    each_once(&find(drawn(dim, &disks, 0.0, 3.0, 7)), &disks, 0.8, "sizes");
}

#[test]
fn a_single_one_is_found_whatever_its_size() {
    for radius in [6.0, 20.0, 75.0] {
        let disks = [(DVec2::new(131.0, 118.0), radius, 90.0)];
        for noise in [0.0, 6.0] {
            let picture = drawn((240, 260), &disks, 0.0, noise, 8);
            let what = format!("radius {radius}, noise {noise}");
            each_once(&find(picture), &disks, 0.75, &what);
        }
    }
}

#[test]
fn noise_of_any_grain_is_nothing() {
    for (seed, level) in [(1, 2.0), (2, 10.0), (3, 60.0)] {
        let picture = drawn((300, 320), &[], 0.0, level, seed);
        let found = find(picture);
        assert!(found.objects.is_empty(), "{level}: {}", found.objects.len());
    }
}
