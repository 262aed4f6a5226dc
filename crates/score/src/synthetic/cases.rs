//! The cases by name, and the series in noise.

use super::{Case, Shape};
use glam::DVec2;

/// A case by its name: pictures of 256 × 256 pixels (`disk_small` of 64 × 64).
fn named(name: &str, shape: Shape, change: impl FnOnce(&mut Case)) -> Case {
    let mut case = Case {
        name: name.to_owned(),
        size: [256, 256],
        shape,
        center: DVec2::splat(128.0),
        ..Case::default()
    };
    change(&mut case);
    case
}

/// A disc, an ellipse and a star of five lobes, all of the area of a circle of radius 55 (the star: of
/// that mean radius)
/// in 200 × 200 pixels, each without noise and with a contrast of 10, 5 and 2 times the noise, with so many seeds of
/// it. Each with that ratio, which is infinite without noise.
///
/// The contrast is of 64 levels about the middle, so that noise is hardly cut off at 0 and 255.
#[must_use]
pub fn series(seeds: u64) -> Vec<(Case, f64)> {
    let ellipse = |a: f64, b: f64| Shape::Ellipse {
        half: [a, b],
        angle: 30.0_f64.to_radians(),
    };
    let star = Shape::Star {
        radius: 55.0,
        depth: 0.3,
        lobes: 5,
    };
    let mut all = Vec::new();
    for ratio in [f64::INFINITY, 10.0, 5.0, 2.0] {
        for (name, shape) in [
            ("disk", ellipse(55.0, 55.0)),
            ("ellipse", ellipse(82.5, 110.0 / 3.0)),
            ("star", star.clone()),
        ] {
            all.extend((1..=seeds).map(|seed| {
                let case = Case {
                    name: name.to_owned(),
                    shape: shape.clone(),
                    center: DVec2::new(99.3, 100.6),
                    bright: 160.0,
                    dark: 96.0,
                    noise: 64.0 / ratio,
                    seed,
                    ..Case::default()
                };
                (case, ratio)
            }));
        }
    }
    all
}

/// Single objects of known outline: bias at weak and strong curvature, either polarity, weak contrast, thin and dented
/// forms, corners, noise, uneven light and something bright nearby.
#[must_use]
pub fn cases() -> Vec<Case> {
    let circle = |radius: f64| Shape::Ellipse {
        half: [radius, radius],
        angle: 0.0,
    };
    let disk = |name: &str, change: &dyn Fn(&mut Case)| {
        named(name, circle(60.0), |case| {
            case.center = DVec2::new(127.3, 128.6);
            change(case);
        })
    };
    let long = |a: f64, b: f64| Shape::Ellipse {
        half: [a, b],
        angle: 30.0_f64.to_radians(),
    };
    let star = Shape::Star {
        radius: 70.0,
        depth: 0.3,
        lobes: 5,
    };
    let polygon = |corners: &[(f64, f64)]| {
        Shape::Polygon(corners.iter().map(|&p| DVec2::from(p) - 128.0).collect())
    };
    let u = polygon(&[
        (58.0, 58.0),
        (103.0, 58.0),
        (103.0, 150.0),
        (153.0, 150.0),
        (153.0, 58.0),
        (198.0, 58.0),
        (198.0, 198.0),
        (58.0, 198.0),
    ]);
    let square = polygon(&[(64.0, 64.0), (192.0, 64.0), (192.0, 192.0), (64.0, 192.0)]);
    let noise =
        |sigma: f64, seed: u64| move |case: &mut Case| (case.noise, case.seed) = (sigma, seed);
    let bar = [DVec2::new(40.0, 38.0), DVec2::new(216.0, 46.0)];
    vec![
        disk("disk", &|_| {}),
        named("disk_small", circle(6.0), |case| {
            (case.size, case.center) = ([64, 64], DVec2::new(31.5, 32.25));
        }),
        disk("disk_dark", &|case| {
            (case.bright, case.dark) = (60.0, 200.0);
        }),
        disk("disk_weak", &|case| {
            (case.bright, case.dark) = (112.0, 104.0);
            (case.noise, case.seed) = (4.0, 1);
        }),
        named("ellipse", long(90.0, 40.0), |_| {}),
        named("ellipse_thin", long(100.0, 12.0), |_| {}),
        named("star", star, |_| {}),
        named("u_shape", u, |_| {}),
        named("box", square, |case| case.blur = 0.0),
        disk("disk_n10", &noise(10.0, 10)),
        disk("disk_n20", &noise(20.0, 20)),
        disk("disk_n40", &noise(40.0, 40)),
        disk("disk_n80", &noise(80.0, 80)),
        disk("disk_sp", &|case| {
            (case.salt_and_pepper, case.seed) = (0.1, 7);
        }),
        disk("disk_shade", &|case| {
            (case.noise, case.seed, case.shade) = (5.0, 5, 0.4);
        }),
        disk("distractor", &|case| case.distractor = Some(bar)),
    ]
}
