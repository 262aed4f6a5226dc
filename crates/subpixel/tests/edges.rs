//! The last stage against drawn edges whose place is known exactly.

#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use field::{Grid, drawn};
use glam::DVec2;
use search::along::Polygon;
use subpixel::{Precise, Rules, refine};

const CENTER: DVec2 = DVec2::new(47.3, 46.6);

/// A disc of level 200 on 60, blurred by a Gaussian of 1 pixel; noise of that standard deviation.
fn disc(radius: f64, noise: f64, seed: u64) -> Grid {
    blurred_disc(radius, 1, noise, seed)
}

/// The same, blurred by so many pixels.
fn blurred_disc(radius: f64, blur: i32, noise: f64, seed: u64) -> Grid {
    let inside = |p: DVec2| p.distance(CENTER) <= radius;
    let sharp = drawn::covered((94, 96), inside, (200.0, 60.0));
    let reach = 4 * blur;
    let weights: Vec<f64> = (-reach..=reach)
        .map(|k| (-0.5 * f64::from(k * k) / f64::from(blur * blur)).exp())
        .collect();
    let total: f64 = weights.iter().sum();
    let along = |grid: &Grid, (dy, dx): (isize, isize)| {
        let (height, width) = grid.dim();
        Grid::from_shape_fn(grid.dim(), |(y, x)| {
            let near = |v: usize, d: isize, n: usize| {
                (v.cast_signed() + d)
                    .clamp(0, n.cast_signed() - 1)
                    .unsigned_abs()
            };
            let value = |(k, w): (isize, &f64)| {
                w / total * grid[[near(y, k * dy, height), near(x, k * dx, width)]]
            };
            let offsets = -(reach as isize)..=reach as isize;
            offsets.zip(&weights).map(value).sum()
        })
    };
    let blurred = along(&along(&sharp, (0, 1)), (1, 0));
    let noisy = if noise > 0.0 {
        drawn::noisy(&blurred, noise, seed)
    } else {
        blurred
    };
    drawn::rounded(&noisy)
}

fn circle(radius: f64) -> Polygon {
    let turn = |i: u32| DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / 120.0);
    Polygon {
        points: (0..120).map(|i| CENTER + radius * turn(i)).collect(),
        closed: true,
    }
}

fn moved(picture: &Grid, start: &Polygon) -> Precise {
    let rules = Rules {
        reach: 1.5,
        spacing: 1.0,
        rough: 1.5,
    };
    refine(picture, start, rules).unwrap()
}

/// Root mean square and mean of how far outside the disc's border the nodes lie.
fn off(found: &Precise, radius: f64) -> (f64, f64) {
    let off: Vec<f64> = found
        .points
        .iter()
        .map(|p| p.distance(CENTER) - radius)
        .collect();
    let count = off.len() as f64;
    let squares: f64 = off.iter().map(|v| v * v).sum();
    ((squares / count).sqrt(), off.iter().sum::<f64>() / count)
}

#[test]
fn clear_edges_are_found_to_a_fiftieth_of_a_pixel_whatever_their_curvature() {
    for radius in [12.0, 18.3, 30.0, 38.0] {
        for start in [-1.2, 0.4, 1.1] {
            let found = moved(&disc(radius, 0.0, 0), &circle(radius + start));
            let (rms, mean) = off(&found, radius);
            assert!(
                rms < 0.02 && mean.abs() < 0.015,
                "{radius} {start}: {rms} {mean}"
            );
            assert!(
                found
                    .edge
                    .is_some_and(|edge| (edge.blur - 1.04).abs() < 0.15)
            );
        }
    }
}

#[test]
fn an_edge_blurred_over_many_pixels_is_found_too() {
    for (blur, noise, most) in [
        (2, 0.0, 0.02),
        (3, 0.0, 0.05),
        (5, 0.0, 0.15),
        (3, 5.0, 0.15),
    ] {
        for start in [-2.0, 2.5] {
            let picture = blurred_disc(30.0, blur, noise, 1);
            let found = moved(&picture, &circle(30.0 + start));
            let (rms, mean) = off(&found, 30.0);
            assert!(
                rms < most && mean.abs() < most,
                "{blur} {start}: {rms} {mean}"
            );
            let edge = found.edge.unwrap();
            assert!(
                (edge.blur - f64::from(blur)).abs() < 0.2 * f64::from(blur),
                "{edge:?}"
            );
            // where there is none, what the shape does not explain counts as noise
            assert!(
                (noise..noise + 4.0).contains(&(edge.noise + 1.0)),
                "{edge:?}"
            );
        }
    }
}

#[test]
fn without_the_correction_a_small_disc_would_be_too_small() {
    // blur moves the middle of the step inwards by σ²/2R, 0.045 pixels here
    let (rms, mean) = off(&moved(&disc(12.0, 0.0, 0), &circle(12.3)), 12.0);
    assert!(mean > -0.02 && rms < 0.02, "{mean} {rms}");
}

#[test]
fn error_bars_of_noisy_edges_hold_the_truth_as_often_as_they_say() {
    let (mut held, mut all, mut worst) = (0.0, 0.0, 0.0_f64);
    for noise in [14.0, 28.0] {
        for seed in 1..=10 {
            let found = moved(&disc(30.0, noise, seed), &circle(30.7));
            for (p, error) in found.points.iter().zip(&found.errors) {
                let far = (p.distance(CENTER) - 30.0).abs();
                held += f64::from(u8::from(far <= 1.96 * error.unwrap()));
                all += 1.0;
            }
            let (rms, _) = off(&found, 30.0);
            worst = worst.max(rms / noise);
        }
    }
    // 95 % bands; neighbouring nodes are not independent, so twenty pictures tell it to some percent
    let share = held / all;
    assert!((0.9..=0.99).contains(&share), "{share}");
    assert!(worst < 0.1 / 14.0, "{worst}");
}

#[test]
fn what_is_no_step_is_left_where_it_was_found() {
    // a thin bright ring: across it the level goes up and down again
    let ring = |(y, x): (usize, usize)| {
        let far = (DVec2::new(x as f64, y as f64).distance(CENTER) - 30.0).abs();
        80.0 + 100.0 * (-0.5 * (far / 1.2).powi(2)).exp()
    };
    let blank = |_: (usize, usize)| 80.0;
    for picture in [
        Grid::from_shape_fn((94, 96), ring),
        Grid::from_shape_fn((94, 96), blank),
    ] {
        let found = moved(&picture, &circle(30.4));
        assert!(
            found.edge.is_none() && found.errors.iter().all(Option::is_none),
            "{:?} {:?}",
            found.edge,
            off(&found, 30.4)
        );
        let (_, mean) = off(&found, 30.4);
        assert!(mean.abs() < 0.01, "{mean}");
    }
}

#[test]
fn an_open_curve_is_moved_onto_its_edge_too() {
    let level = |(y, x): (usize, usize)| {
        let middle = 40.3 + 0.1 * x as f64;
        60.0 + 140.0 * (0.5 + (y as f64 - middle) / 2.0).clamp(0.0, 1.0)
    };
    let picture = Grid::from_shape_fn((94, 96), level);
    let start = Polygon {
        points: vec![DVec2::new(10.0, 42.0), DVec2::new(84.0, 48.0)],
        closed: false,
    };
    let found = moved(&picture, &start);
    let off = |p: &DVec2| (p.y - 40.3 - 0.1 * p.x).abs();
    let inner = &found.points[5..found.points.len() - 5];
    assert!(inner.iter().map(off).fold(0.0, f64::max) < 0.05);
}
