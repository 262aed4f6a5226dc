//! The report's program, run by Octave, and what this crate says to the same images.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::float_cmp,
    reason = "a test may stop, and exact means exact"
)]

use crate::common::{csv, doubles, pgm, same_bits, table, within};
use field::{EdgeForce, REPORT_GAIN, REPORT_PASSES, REPORT_SCALE, Smoothing, literal, signal};
use glam::DVec2;

const IMAGES: [&str; 5] = [
    "apple_128",
    "disturb_112x96",
    "ellipse_96x80",
    "ellipse_noisy_96x80",
    "step_64x48",
];

#[test]
fn the_report_force_is_the_programs_to_the_bit() {
    for name in IMAGES {
        let image = pgm(&format!("{name}.pgm"));
        let wanted_x = doubles(&format!("force_{name}_forcex.f64"), &image);
        let wanted_y = doubles(&format!("force_{name}_forcey.f64"), &image);
        let field = field::report_force(&image, REPORT_PASSES, 1.0, REPORT_GAIN).unwrap();
        let (x, y) = field.components();
        same_bits(name, &x, &wanted_x);
        same_bits(name, &y, &wanted_y);
        // and the slow twin says the same
        let twin = literal::report_force(&image, REPORT_PASSES, 1.0, REPORT_GAIN).unwrap();
        assert_eq!(field, twin, "{name}");
    }
}

#[test]
fn every_stage_of_a_random_image_is_the_programs_to_the_bit() {
    let image = pgm("random_17x13.pgm");
    let stages = field::report_stages(&image, REPORT_PASSES, 1.0, REPORT_GAIN).unwrap();
    let (force_x, force_y) = stages.force.components();
    for (name, got) in [
        ("smoothx", &stages.smoothed_x),
        ("smoothy", &stages.smoothed_y),
        ("absgradx", &stages.absolute_x),
        ("absgrady", &stages.absolute_y),
        ("forcex", &force_x),
        ("forcey", &force_y),
    ] {
        same_bits(name, got, &csv(&format!("force_random_17x13_{name}.csv")));
    }
    for at in [[0, 0], [5, 7], [12, 16]] {
        assert_eq!(
            stages.derivative_x[at].abs().to_bits(),
            stages.absolute_x[at].to_bits()
        );
        assert_eq!(
            stages.derivative_y[at].abs().to_bits(),
            stages.absolute_y[at].to_bits()
        );
    }
}

#[test]
fn d48_the_displays_scale_multiplies_the_force() {
    let image = pgm("random_17x13.pgm");
    let field = field::report_force(&image, REPORT_PASSES, REPORT_SCALE, REPORT_GAIN).unwrap();
    let (x, y) = field.components();
    // forces up to 60: a few dozen roundings of 1e-16 each
    within(
        "forcex",
        1e-12,
        &x,
        &csv("force_random_17x13_scale0.15_forcex.csv"),
    );
    within(
        "forcey",
        1e-12,
        &y,
        &csv("force_random_17x13_scale0.15_forcey.csv"),
    );
    let unscaled = field::report_force(&image, REPORT_PASSES, 1.0, REPORT_GAIN).unwrap();
    let (scaled_x, scaled_y) = unscaled.scaled(REPORT_SCALE).components();
    within("scaled x", 1e-12, &x, &scaled_x);
    within("scaled y", 1e-12, &y, &scaled_y);
}

#[test]
fn the_corrected_force_is_octaves() {
    let rule = EdgeForce {
        smoothing: Smoothing::Binomial(REPORT_PASSES),
        gain: 1.0,
    };
    let check = |image: field::Grid, fx, fy, strength| {
        let stages = field::edge_stages(&image, &rule).unwrap();
        let (x, y) = stages.force.components();
        // grey levels up to 255 through 44 averaging sums: 1e-12 is twenty roundings of the largest
        within("x", 1e-12, &x, &fx);
        within("y", 1e-12, &y, &fy);
        within("strength", 1e-12, &stages.strength, &strength);
    };
    let small = |part| csv(&format!("corrected_random_17x13_{part}.csv"));
    check(
        pgm("random_17x13.pgm"),
        small("fx"),
        small("fy"),
        small("potential"),
    );
    let image = pgm("ellipse_96x80.pgm");
    let large = |part| doubles(&format!("corrected_ellipse_96x80_{part}.f64"), &image);
    check(image.clone(), large("fx"), large("fy"), large("potential"));
}

#[test]
fn d51_d54_d56_sampling_is_the_programs_index_errors_included() {
    let image = pgm("random_17x13.pgm");
    let field = field::report_force(&image, REPORT_PASSES, 1.0, REPORT_GAIN).unwrap();
    let (mut refused, mut compared) = (0, 0);
    for row in table("interp_random_17x13.csv", 1) {
        // the program counts from 1 (D59)
        let p = DVec2::new(row[1] - 1.0, row[2] - 1.0);
        // forces of up to 60, extrapolated over at most half a pixel: 1e-11 covers x − 1 + 1 as well
        let same = |got: DVec2, x: f64, y: f64| (got - DVec2::new(x, y)).length() < 1e-11;
        match field.at_report(p) {
            Ok(force) => {
                assert!(row[0] > 0.5, "{p}: the program stops here");
                assert!(same(force, row[3], row[4]), "{p}: {force} and {row:?}");
                compared += 1;
            }
            Err(outside) => {
                assert!(
                    row[0] < 0.5,
                    "{p}: the program does not stop here: {outside}"
                );
                refused += 1;
            }
        }
        let bilinear = field.at(p);
        if p.is_nan() {
            assert!(bilinear.is_nan());
        } else {
            assert!(
                same(bilinear, row[5], row[6]),
                "{p}: {bilinear} and {row:?}"
            );
        }
    }
    assert_eq!((compared, refused), (142, 77));
}

#[test]
fn the_one_dimensional_chapter_is_octaves() {
    for (name, samples) in [("step", signal::step()), ("box", signal::box_())] {
        let rows = table(&format!("signal_{name}.csv"), 1);
        let column = |k: usize| -> Vec<f64> { rows.iter().map(|r| r[k]).collect() };
        let smoothed = signal::smooth_binomial(&samples, REPORT_PASSES);
        let first = signal::first_derivative(&smoothed);
        let force = signal::force(&smoothed);
        // all exact: sums of eighths of eighths
        assert_eq!(samples, column(1), "{name}");
        assert_eq!(smoothed, column(2), "{name}");
        assert_eq!(first, column(3), "{name}");
        assert_eq!(
            first.iter().map(|d| d.abs()).collect::<Vec<_>>(),
            column(4),
            "{name}"
        );
        assert_eq!(force, column(5), "{name}");
        assert_eq!(signal::second_derivative(&smoothed), column(6), "{name}");
        assert_eq!(signal::first_derivative(&first), column(7), "{name}");
        assert_eq!(
            force.iter().map(|f| 40.0 * f).collect::<Vec<_>>(),
            column(8),
            "{name}"
        );
    }
}
