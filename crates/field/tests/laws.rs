//! Laws that hold for every image.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::float_cmp,
    reason = "a test may stop, and exact means exact"
)]

use field::{
    EdgeForce, ForceField, Grid, Smoothing, binomial_x, binomial_y, edge_force, edge_stages,
    gradient_force, literal, report_force,
};
use glam::DVec2;
use proptest::prelude::*;

/// Any image of whole grey levels, from one pixel to 12 × 12.
fn images() -> impl Strategy<Value = Grid> {
    (1_usize..12, 1_usize..12).prop_flat_map(|(height, width)| {
        proptest::collection::vec(0_u8..=255, height * width).prop_map(move |pixels| {
            Grid::from_shape_vec((height, width), pixels.into_iter().map(f64::from).collect())
                .unwrap()
        })
    })
}

fn smoothings() -> impl Strategy<Value = Smoothing> {
    prop_oneof![
        (0_u32..25).prop_map(Smoothing::Binomial),
        (0.3_f64..6.0).prop_map(Smoothing::Gaussian)
    ]
}

fn mirrored(image: &Grid) -> Grid {
    let width = image.ncols();
    Grid::from_shape_fn(image.dim(), |(y, x)| image[[y, width - 1 - x]])
}

/// Grey levels up to 255, masks and gain: a hundred roundings of a few hundred.
const ROUNDING: f64 = 1e-11;

fn close(a: &Grid, b: &Grid) -> bool {
    a.dim() == b.dim() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < ROUNDING)
}

proptest! {
    #[test]
    fn smoothing_keeps_the_mean_and_makes_no_new_extremes(image in images(), smoothing in smoothings()) {
        let smoothed = edge_stages(&image, &EdgeForce { smoothing, gain: 1.0 }).unwrap().smoothed;
        let extremes = |g: &Grid| g.iter().fold((f64::MAX, f64::MIN), |(l, h), &v| (l.min(v), h.max(v)));
        let ((low, high), (smooth_low, smooth_high)) = (extremes(&image), extremes(&smoothed));
        prop_assert!(smooth_low >= low - ROUNDING && smooth_high <= high + ROUNDING);
        prop_assert!((smoothed.sum() - image.sum()).abs() < 1e-12 * image.sum().max(1.0) * 10.0);
    }

    #[test]
    fn x_and_y_passes_commute(image in images(), passes in 0_u32..9) {
        // exact: 8 bits and 2 · 2 · 9 more
        prop_assert_eq!(
            binomial_x(&binomial_y(&image, passes), passes),
            binomial_y(&binomial_x(&image, passes), passes)
        );
    }

    #[test]
    fn y_passes_are_x_passes_of_the_transpose(image in images(), passes in 0_u32..30) {
        let turned = binomial_x(&image.t().to_owned(), passes);
        prop_assert_eq!(binomial_y(&image, passes), turned.t().to_owned());
    }

    #[test]
    fn a_mirrored_or_transposed_image_mirrors_or_transposes_the_field(
        image in images(), smoothing in smoothings(),
    ) {
        let rule = EdgeForce { smoothing, gain: 3.0 };
        let (fx, fy) = edge_force(&image, &rule).unwrap().components();
        let (mx, my) = edge_force(&mirrored(&image), &rule).unwrap().components();
        prop_assert!(close(&mx, &-mirrored(&fx)) && close(&my, &mirrored(&fy)));
        let (tx, ty) = edge_force(&image.t().to_owned(), &rule).unwrap().components();
        prop_assert!(close(&tx, &fy.t().to_owned()) && close(&ty, &fx.t().to_owned()));
    }

    #[test]
    fn reversing_the_contrast_or_adding_light_leaves_the_field(
        image in images(), smoothing in smoothings(), light in 0.0..100.0_f64,
    ) {
        let rule = EdgeForce { smoothing, gain: 1.0 };
        let (fx, fy) = edge_force(&image, &rule).unwrap().components();
        let (rx, ry) = edge_force(&image.mapv(|v| light - v), &rule).unwrap().components();
        prop_assert!(close(&fx, &rx) && close(&fy, &ry));
    }

    #[test]
    fn the_corrected_force_is_the_gradient_of_its_strength(
        image in images(), smoothing in smoothings(), gain in 0.1..10.0_f64,
    ) {
        let stages = edge_stages(&image, &EdgeForce { smoothing, gain }).unwrap();
        prop_assert_eq!(&gradient_force(&stages.strength, gain).unwrap(), &stages.force);
        // written out in the interior: half the average over three lines of right minus left
        let p = &stages.strength;
        for y in 1..image.nrows().saturating_sub(1) {
            for x in 1..image.ncols().saturating_sub(1) {
                let dx = |y: usize| (p[[y, x + 1]] - p[[y, x - 1]]) / 2.0;
                let dy = |x: usize| (p[[y + 1, x]] - p[[y - 1, x]]) / 2.0;
                let expected = DVec2::new(
                    gain * (dx(y - 1) + 2.0 * dx(y) + dx(y + 1)) / 4.0,
                    gain * (dy(x - 1) + 2.0 * dy(x) + dy(x + 1)) / 4.0,
                );
                prop_assert!((stages.force.pixel(x, y).unwrap() - expected).length() < ROUNDING);
            }
        }
    }

    #[test]
    fn the_fast_report_force_is_the_slow_one(image in images(), passes in 0_u32..=20) {
        // at scale 1 every sum is exact, so any order gives the same bits
        prop_assert_eq!(
            report_force(&image, passes, 1.0, 10.0).unwrap(),
            literal::report_force(&image, passes, 1.0, 10.0).unwrap()
        );
    }

    #[test]
    fn bilinear_sampling_reproduces_every_affine_field(
        (height, width) in (1_usize..9, 1_usize..9),
        c in proptest::array::uniform6(-9.0..9.0_f64),
        (u, v) in (0.0..=1.0_f64, 0.0..=1.0_f64),
    ) {
        let affine = |k: usize, x: f64, y: f64| c[k] + c[k + 1] * x + c[k + 2] * y;
        let grid = |k: usize| Grid::from_shape_fn((height, width), |(y, x)| affine(k, x as f64, y as f64));
        let field = ForceField::from_components(&grid(0), &grid(3)).unwrap();
        let p = DVec2::new(u * (width - 1) as f64, v * (height - 1) as f64);
        let expected = DVec2::new(affine(0, p.x, p.y), affine(3, p.x, p.y));
        prop_assert!((field.at(p) - expected).length() < ROUNDING);
    }

    #[test]
    fn sampling_never_leaves_the_range_of_the_forces(image in images(), (x, y) in (-20.0..30.0, -20.0..30.0)) {
        let field = edge_force(&image, &EdgeForce::as_strong_as_the_report()).unwrap();
        prop_assert!(field.at(DVec2::new(x, y)).length() <= field.largest() * (1.0 + 1e-12));
    }
}

/// Where the radial force of a bright disc is zero, on average over directions: the edge as found.
fn found_radius(radius: f64, sigma: f64) -> f64 {
    let middle = DVec2::new(63.3, 64.6);
    let image = Grid::from_shape_fn((128, 128), |(row, column)| {
        let corner = DVec2::new(column as f64, row as f64) - 0.5;
        let inside = (0..256).filter(|point| {
            let step = DVec2::new((point % 16) as f64, (point / 16) as f64);
            (corner + (step + 0.5) / 16.0).distance(middle) < radius
        });
        50.0 + 150.0 * inside.count() as f64 / 256.0
    });
    let rule = EdgeForce {
        smoothing: Smoothing::Gaussian(sigma),
        gain: 1.0,
    };
    let field = edge_force(&image, &rule).unwrap();
    let directions = 60;
    let zero = |k: i32| {
        let out = DVec2::from_angle(std::f64::consts::TAU * f64::from(k) / f64::from(directions));
        let (mut low, mut high) = (radius - 3.0, radius + 3.0);
        for _ in 0..40 {
            let r = f64::midpoint(low, high);
            if field.at(middle + r * out).dot(out) > 0.0 {
                low = r;
            } else {
                high = r;
            }
        }
        f64::midpoint(low, high)
    };
    (0..directions).map(zero).sum::<f64>() / f64::from(directions)
}

/// Theory, section 11.3: after a Gaussian of width σ the steepest place lies σ²/2R inside.
#[test]
fn the_edge_of_a_disc_is_found_inside_by_the_bias_of_theory() {
    for (radius, sigma) in [
        (20.0, 3.0),
        (20.0, 10.0_f64.sqrt()),
        (40.0, 10.0_f64.sqrt()),
        (40.0, 5.0),
    ] {
        let bias = radius - found_radius(radius, sigma);
        // pixels and differences blur besides, as a Gaussian of variance 2/3 + 1/12 does; the next
        // order of the series is that of (σ/R)² of it
        let blur = sigma * sigma + 0.75;
        let theory = blur / (2.0 * radius) * (1.0 + blur / (radius * radius));
        assert!(
            (bias - theory).abs() < 0.06 * theory,
            "radius {radius}, sigma {sigma}: {bias}, theory {theory}"
        );
    }
}
