//! What holds for every kind of region.

use super::rows::{Crossings, RowSums, walk};
use super::*;
use crate::grid::Grid;
use crate::masked::MaskedImage;
use proptest::prelude::*;
use std::f64::consts::TAU;

pub(super) fn circle(center: DVec2, radius: f64, n: usize) -> Vec<DVec2> {
    (0..n)
        .map(|i| center + radius * DVec2::from_angle(TAU * i as f64 / n as f64))
        .collect()
}

/// The pushes on a polygon.
pub(super) fn pushes(region: &dyn Region, polygon: &[DVec2]) -> Vec<f64> {
    let mut push = vec![f64::NAN; polygon.len()];
    region.push_into(polygon, &mut RegionScratch::default(), &mut push);
    push
}

/// Whether a point lies inside, by counting crossings.
pub(super) fn encloses(polygon: &[DVec2], at: DVec2) -> bool {
    let crossings = (0..polygon.len()).filter(|&i| {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        (a.y <= at.y) != (b.y <= at.y) && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x)
    });
    crossings.count() % 2 == 1
}

/// Whether the energy's slope for a shift and for growth is minus the force integrated along the border, pixel by pixel.
///
/// `force` is asked at pixel centers only, so both sides are exact but for the steps they are taken in: some hundred
/// crossings of pixel borders, each missed by up to a thousandth of a pixel.
pub(super) fn slope_agrees(
    region: &dyn Region,
    polygon: &[DVec2],
    bound: f64,
    force: impl Fn(DVec2) -> f64,
) -> bool {
    let center = polygon.iter().sum::<DVec2>() / polygon.len() as f64;
    let motions: [fn(DVec2) -> DVec2; 3] = [|_| DVec2::X, |_| DVec2::Y, |p| 0.1 * p];
    motions.iter().all(|motion| {
        let moved = |step: f64| {
            let at = |p: &DVec2| *p + step * motion(*p - center);
            region.energy(&polygon.iter().map(at).collect::<Vec<_>>())
        };
        let step = 1e-4;
        let slope = (moved(step).unwrap() - moved(-step).unwrap()) / (2.0 * step);
        let (mut work, mut size, parts) = (0.0, 0.0, 1600);
        for (i, &a) in polygon.iter().enumerate() {
            let b = polygon[(i + 1) % polygon.len()];
            // clockwise on the screen: outwards is (t.y, −t.x)
            let outward = DVec2::new(b.y - a.y, a.x - b.x) / f64::from(parts);
            for k in 0..parts {
                let p = a.lerp(b, (f64::from(k) + 0.5) / f64::from(parts));
                let part = force(p.round()) * outward.dot(motion(p - center));
                (work, size) = (work + part, size + part.abs());
            }
        }
        let agrees = (slope + work).abs() < bound * size + 1e-6;
        if !agrees {
            eprintln!("slope {slope}, work {work} of {size}");
        }
        agrees
    })
}

fn noise(height: usize, width: usize) -> Grid {
    Grid::from_shape_fn((height, width), |(y, x)| {
        ((x * 37 + y * 91 + x * y * 3) % 101) as f64
    })
}

proptest! {
    #[test]
    fn a_walk_has_the_exact_area_and_stays_within_pixels(
        points in proptest::collection::vec((-5.0..25.0_f64, -5.0..25.0_f64), 3..9),
    ) {
        let polygon: Vec<DVec2> = points.into_iter().map(DVec2::from).collect();
        // a picture wide enough for all of it
        let shifted: Vec<DVec2> = polygon.iter().map(|p| p + 6.0).collect();
        let mut area = 0.0;
        walk(&shifted, (40, 40), |row, x, height| {
            area += height * x;
            assert!(row < 40 && (0.0..=40.0).contains(&x) && height.abs() <= 1.0 + 1e-12);
        });
        prop_assert!((area - signed_area(&polygon) / 2.0).abs() < 1e-9);
        // what goes down in a row comes up again
        let mut crossings = Crossings::default();
        crossings.fill(&polygon, (20, 20));
        for row in 0..20 {
            let net: f64 = crossings.row(row).iter().map(|piece| piece.1).sum();
            prop_assert!(net.abs() < 1e-9);
        }
    }

    #[test]
    fn the_sum_inside_is_that_of_every_pixels_own_share(
        points in proptest::collection::vec((-2.0..9.0_f64, -2.0..9.0_f64), 3..4),
    ) {
        // the share of a triangle in a pixel, by cutting the triangle with the pixel's four sides
        let polygon: Vec<DVec2> = points.into_iter().map(DVec2::from).collect();
        let image = noise(7, 8);
        let rows = RowSums::new(&MaskedImage::whole(&image).unwrap());
        let got = rows.inside(&polygon);
        let (mut area, mut sum) = (0.0, 0.0);
        for ((y, x), value) in image.indexed_iter() {
            let c = DVec2::new(x as f64, y as f64);
            let mut cut = polygon.clone();
            for normal in [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y] {
                cut = half_plane(&cut, c, normal);
            }
            let share = signed_area(&cut).abs() / 2.0;
            (area, sum) = (area + share, sum + share * (value - image[[0, 0]]));
        }
        prop_assert!((got.area - area).abs() < 1e-9, "{} {}", got.area, area);
        prop_assert!((got.sum - sum).abs() < 1e-7, "{} {}", got.sum, sum);
    }
}

/// The part of a convex polygon within half a pixel of `c` along `normal`.
fn half_plane(polygon: &[DVec2], c: DVec2, normal: DVec2) -> Vec<DVec2> {
    let beyond = |p: DVec2| (p - c).dot(normal) - 0.5;
    let mut out = Vec::new();
    for i in 0..polygon.len() {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        let (da, db) = (beyond(a), beyond(b));
        if da <= 0.0 {
            out.push(a);
        }
        if (da <= 0.0) != (db <= 0.0) {
            out.push(a + (b - a) * (da / (da - db)));
        }
    }
    out
}

/// Every kind, over one picture with its mask.
fn kinds(picture: &MaskedImage) -> Vec<Box<dyn Region>> {
    let two = TwoRegions::masked(picture, 1.0).unwrap();
    let grey = Classes::grey(picture, 7).unwrap();
    let color = Classes::clusters(&[picture.clone(), picture.clone()], 9).unwrap();
    let parzen = Density::Parzen { bandwidth: 9.0 };
    let mixture = Density::Mixture { components: 3 };
    let likelihood = |classes, density| LikelihoodRegions::new(classes, density, 1.0).unwrap();
    vec![
        Box::new(LocalRegions::new(&two, 6.0).unwrap()),
        Box::new(likelihood(&grey, parzen)),
        Box::new(likelihood(&grey, Density::Gaussian)),
        Box::new(likelihood(&color, mixture)),
        Box::new(two),
    ]
}

#[test]
fn odd_pictures_and_odd_curves_push_with_numbers_and_constants_not_at_all() {
    for (height, width) in [(1, 1), (1, 40), (40, 1), (3, 3), (3, 100_000)] {
        let flat = MaskedImage::whole(&Grid::from_elem((height, width), 0.1)).unwrap();
        let noisy = MaskedImage::whole(&noise(height, width)).unwrap();
        let middle = DVec2::new(width as f64, height as f64) / 2.0;
        let curves = [
            vec![],
            vec![DVec2::ZERO],
            circle(middle, 4.0, 12),
            circle(middle, 0.3, 12),
            circle(DVec2::splat(-900.0), 3.0, 12),
            circle(DVec2::ZERO, 1e7, 12),
            vec![DVec2::splat(1.0); 5],
        ];
        for polygon in &curves {
            for region in kinds(&flat) {
                let push = pushes(&*region, polygon);
                assert!(push.iter().all(|&f| f == 0.0), "{region:?}");
            }
            for region in kinds(&noisy) {
                assert!(pushes(&*region, polygon).iter().all(|f| f.is_finite()));
                assert!(region.energy(polygon).is_none_or(f64::is_finite));
            }
        }
    }
}

#[test]
fn a_curve_that_is_no_place_ends_all_the_same() {
    let picture = MaskedImage::whole(&noise(9, 9)).unwrap();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e308, -1e308] {
        let mut polygon = circle(DVec2::splat(4.0), 3.0, 9);
        polygon[3].x = bad;
        polygon[6].y = bad;
        for region in kinds(&picture) {
            assert_eq!(pushes(&*region, &polygon).len(), 9);
        }
    }
}

#[test]
fn orientation_does_not_matter_and_neither_does_which_side_is_brighter() {
    let image = noise(40, 40);
    let mut polygon = circle(DVec2::new(19.3, 20.1), 9.0, 50);
    let plain = MaskedImage::whole(&image).unwrap();
    let negative = MaskedImage::whole(&image.mapv(|v| 100.0 - v)).unwrap();
    for (region, inverse) in kinds(&plain).iter().zip(kinds(&negative)) {
        let forwards = pushes(&**region, &polygon);
        let turned = pushes(&*inverse, &polygon);
        polygon.reverse();
        let backwards = pushes(&**region, &polygon);
        polygon.reverse();
        for ((a, b), c) in forwards.iter().zip(backwards.iter().rev()).zip(turned) {
            // pushes of some thousands
            assert!((a - b).abs() < 1e-6, "{region:?}");
            assert!((a - c).abs() < 1e-6, "{region:?}");
        }
    }
}

#[test]
fn what_is_masked_out_has_no_say_and_feels_nothing() {
    let image = noise(40, 40);
    let valid = ndarray::Array2::from_shape_fn((40, 40), |(y, x)| x + y > 30 || x * y % 7 == 1);
    let mut other = image.clone();
    for (at, _) in valid.indexed_iter().filter(|(_, ok)| !**ok) {
        other[at] = if at.0 % 2 == 0 { f64::NAN } else { 1e9 };
    }
    let polygon = circle(DVec2::new(19.3, 20.1), 9.0, 50);
    let (a, b) = (
        MaskedImage::new(&image, &valid).unwrap(),
        MaskedImage::new(&other, &valid).unwrap(),
    );
    for (a, b) in kinds(&a).iter().zip(kinds(&b)) {
        assert_eq!(pushes(&**a, &polygon), pushes(&*b, &polygon));
    }
    let nothing = ndarray::Array2::from_shape_fn((40, 40), |(_, x)| x > 35);
    for region in kinds(&MaskedImage::new(&image, &nothing).unwrap()) {
        assert!(pushes(&*region, &polygon).iter().all(|&f| f == 0.0));
    }
}

#[test]
fn copies_share_the_picture_and_may_go_to_other_threads() {
    let picture = MaskedImage::whole(&noise(30, 30)).unwrap();
    let polygon = circle(DVec2::splat(14.0), 7.0, 40);
    for region in kinds(&picture) {
        let here = pushes(&*region, &polygon);
        let region: std::sync::Arc<dyn Region> = region.into();
        let (there, curve) = (region.clone(), polygon.clone());
        let handle = std::thread::spawn(move || pushes(&*there, &curve));
        assert_eq!(handle.join().unwrap(), here);
        assert_eq!(pushes(&*region, &polygon), here);
    }
}
