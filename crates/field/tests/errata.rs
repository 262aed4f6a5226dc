//! Where the report is wrong about images, pinned with numbers. D.. are the errata's.
//!
//! The one-dimensional ones (D35, D36, D41, D44 to D47) stand with the code, in `src/signal/tests.rs`; D48, D51,
//! D54 and D56 in `oracle.rs`.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::float_cmp,
    reason = "a test may stop, and exact means exact"
)]

use field::{
    Across, EdgeForce, ForceField, Grid, REPORT_PASSES, Smoothing, edge_force, edge_stages,
    literal, report_force, report_stages,
};
use glam::DVec2;

/// The corrected force with the report's four-fold masks and ten-fold gain, so that the two compare.
const CORRECTED: EdgeForce = EdgeForce {
    smoothing: Smoothing::Binomial(20),
    gain: 40.0,
};

/// A sharp unit edge through the middle; its normal points `degrees` from x towards y.
fn edge(degrees: f64) -> Grid {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let inside = |y: usize, x: usize| (x as f64 - 50.0) * cos + (y as f64 - 50.0) * sin > 1e-9;
    Grid::from_shape_fn((101, 101), |(y, x)| if inside(y, x) { 1.0 } else { 0.0 })
}

fn report(image: &Grid) -> ForceField {
    report_force(image, REPORT_PASSES, 1.0, 10.0).unwrap()
}

/// Largest x component, normal and tangential component and curl, away from the border.
struct Largest {
    x: f64,
    normal: f64,
    tangential: f64,
    curl: f64,
}

fn largest(field: &ForceField, degrees: f64) -> Largest {
    let normal = DVec2::from_angle(degrees.to_radians());
    let (fx, fy) = field.components();
    let mut l = Largest {
        x: 0.0,
        normal: 0.0,
        tangential: 0.0,
        curl: 0.0,
    };
    for y in 30..71 {
        for x in 30..71 {
            let force = DVec2::new(fx[[y, x]], fy[[y, x]]);
            let curl = fy[[y, x + 1]] - fy[[y, x - 1]] - fx[[y + 1, x]] + fx[[y - 1, x]];
            l.x = l.x.max(force.x.abs());
            l.normal = l.normal.max(force.dot(normal).abs());
            l.tangential = l.tangential.max(normal.perp_dot(force).abs());
            l.curl = l.curl.max((curl / 2.0).abs());
        }
    }
    l
}

#[test]
fn d37_twenty_passes_are_the_reports() {
    // the report's figure: variance ½ a pass, so 10 pixels² for its twenty, measured on a point
    let point = Grid::from_shape_fn((1, 101), |(_, x)| if x == 50 { 1.0 } else { 0.0 });
    let spread = field::binomial_x(&point, REPORT_PASSES);
    let variance: f64 = (0..101)
        .map(|x| spread[[0, x]] * (x as f64 - 50.0).powi(2))
        .sum();
    assert!((variance - 10.0).abs() < 1e-9, "{variance}");
    let told = Smoothing::Binomial(REPORT_PASSES).sigma();
    assert!((told * told - variance).abs() < 1e-9);
}

#[test]
fn d38_smoothing_one_axis_leaves_too_strong_a_force_at_flat_edges() {
    for (degrees, by_report, by_gaussian) in [(75.0, 0.43, 0.24), (85.0, 0.305, 0.107)] {
        let got = largest(&report(&edge(degrees)), degrees).x;
        assert!((got - by_report).abs() < 0.005, "{degrees}: {got}");
        let got = largest(&edge_force(&edge(degrees), &CORRECTED).unwrap(), degrees).x;
        assert!((got - by_gaussian).abs() < 0.005, "{degrees}: {got}");
    }
}

#[test]
fn d39_the_reports_force_has_curl_and_depends_on_the_edges_direction() {
    let straight = largest(&report(&edge(0.0)), 0.0);
    assert!((straight.normal - 0.90072).abs() < 5e-6 && straight.tangential < 1e-15);
    assert!((largest(&report(&edge(45.0)), 45.0).normal - 1.17).abs() < 0.005);
    let slanted = largest(&report(&edge(30.0)), 30.0);
    assert!((slanted.curl - 0.285).abs() < 0.005, "{}", slanted.curl);
    for degrees in [15.0, 30.0, 60.0, 75.0] {
        let slanted = largest(&report(&edge(degrees)), degrees);
        assert!(
            (slanted.tangential - 0.275).abs() < 0.01,
            "{}",
            slanted.tangential
        );
    }
    // the corrected force: one strength for all directions, no sideways pull, hardly any curl;
    // what is left are the pixel stairs of a sharp slanted edge
    for degrees in [0.0, 15.0, 30.0, 45.0, 60.0, 75.0] {
        let corrected = largest(&edge_force(&edge(degrees), &CORRECTED).unwrap(), degrees);
        assert!(
            (corrected.normal - 0.895).abs() < 0.006,
            "{degrees}: {}",
            corrected.normal
        );
        assert!(corrected.tangential < 0.016 && corrected.curl < 0.007);
    }
}

#[test]
fn d40_each_mask_counts_twice() {
    let ramp = Grid::from_shape_fn((9, 9), |(_, x)| x as f64);
    assert_eq!(field::mask_x(&ramp, Across::Mirror)[[4, 4]], 2.0);
    // 2 · 2 · 10 · 0.15 = 6 against the corrected gain of 1, at a straight edge away from the border
    let image = edge(0.0);
    let (fx, _) = report_force(&image, 20, 0.15, 10.0).unwrap().components();
    let (corrected, _) = edge_force(&image, &EdgeForce::as_strong_as_the_report())
        .unwrap()
        .components();
    for x in 0..101 {
        assert!((fx[[50, x]] - corrected[[50, x]]).abs() < 1e-12);
    }
}

#[test]
fn d41_d42_turned_masks_turn_the_forces() {
    let [_, _, bx, by] = literal::masks();
    // on a picture that rises along y the y mask finds the slope that the x mask finds along x; turned the other way
    // it would find its negative
    let along_x = Grid::from_shape_fn((9, 9), |(_, x)| 3.0 * x as f64);
    let along_y = Grid::from_shape_fn((9, 9), |(y, _)| 3.0 * y as f64);
    let at = |picture: &Grid, mask: &Grid| literal::conv2(picture, mask)[[5, 5]];
    assert_eq!((at(&along_x, &bx), at(&along_y, &by)), (6.0, 6.0));
    assert_eq!((at(&along_y, &bx), at(&along_x, &by)), (0.0, 0.0));
    // conv2 turns the mask: bx gives right minus left, and used as correlation its negative
    let ramp = Grid::from_shape_fn((3, 3), |(_, x)| x as f64);
    let center = literal::conv2(&ramp, &bx)[[2, 2]];
    let correlation: f64 = ramp.iter().zip(&bx).map(|(i, b)| i * b).sum();
    assert_eq!((center, correlation), (2.0, -2.0));
}

#[test]
fn d43_zeros_across_weaken_the_outermost_rows() {
    let image = Grid::from_shape_fn((40, 40), |(_, x)| if x >= 20 { 1.0 } else { 0.0 });
    let (fx, _) = report(&image).components();
    let (fy, fx_none) = {
        let (x, y) = report(&image.t().to_owned()).components();
        (y, x)
    };
    for x in 0..40 {
        assert_eq!(fx[[0, x]], 0.625 * fx[[20, x]]);
        assert_eq!(fx[[1, x]], 0.9375 * fx[[20, x]]);
        assert_eq!(fx[[2, x]], fx[[20, x]]);
        assert_eq!(fy[[x, 0]], 0.625 * fy[[x, 20]]);
        assert_eq!(fx_none[[20, x]], 0.0);
    }
    let (fx, _) = edge_force(&image, &CORRECTED).unwrap().components();
    for x in 0..40 {
        assert!((fx[[0, x]] - fx[[20, x]]).abs() < 1e-14);
    }
    // the mirror, renewed each pass, keeps the sum of every row
    let random = Grid::from_shape_fn((5, 17), |(y, x)| ((y * 31 + x * 17) % 23) as f64);
    for (before, after) in random
        .rows()
        .into_iter()
        .zip(field::binomial_x(&random, 20).rows())
    {
        assert!((before.sum() - after.sum()).abs() < 1e-12);
    }
}

#[test]
fn d51_the_reports_interpolation_jumps_at_halves_and_the_bilinear_does_not() {
    let image = Grid::from_shape_fn((9, 12), |(y, x)| ((y * 29 + x * x * 7) % 31) as f64);
    let field = report(&image);
    let f = |column, row| field.pixel(column, row).unwrap();
    let jump = |at: DVec2, by: DVec2| {
        let before = field.at_report(at - by).unwrap();
        (
            field.at_report(at + by).unwrap() - before,
            field.at(at + by) - field.at(at - by),
        )
    };
    // own axis: at x = k + ½ the jump is minus half a second difference
    let (report, bilinear) = jump(DVec2::new(4.5, 3.0), DVec2::new(1e-9, 0.0));
    let second = f(4, 3).x - 2.0 * f(5, 3).x + f(6, 3).x;
    assert!((report.x + second / 2.0).abs() < 1e-6 && second.abs() > 1.0);
    assert!(bilinear.length() < 1e-6);
    // across: nearest row, so the jump is a whole first difference
    let (report, bilinear) = jump(DVec2::new(4.0, 3.5), DVec2::new(0.0, 1e-9));
    assert!((report.x - (f(4, 4).x - f(4, 3).x)).abs() < 1e-6 && report.x.abs() > 1.0);
    assert!(bilinear.length() < 1e-6);
}

#[test]
fn d52_the_reports_force_may_change_sign_without_a_zero() {
    let x = Grid::from_shape_vec((2, 5), [3.0, 3.0, -1.0, -1.0, -1.0].repeat(2)).unwrap();
    let field = ForceField::from_components(&x, &Grid::zeros((2, 5))).unwrap();
    let at = |x: f64| field.at_report(DVec2::new(x, 0.0)).unwrap().x;
    // left of 1.5 it falls from 3 to 1, from there on it is −1: a node chatters on the jump
    assert!((at(1.5 - 1e-9) - 1.0).abs() < 1e-6 && (at(1.5) + 1.0).abs() < 1e-12);
    let smallest = (0..3000)
        .map(|i| at(f64::from(i) / 1000.0).abs())
        .fold(9.0, f64::min);
    assert!(smallest > 0.999);
    // the bilinear force has its zero where it should be
    assert!(field.at(DVec2::new(1.75, 0.0)).x.abs() < 1e-12);
}

#[test]
fn d53_halves_round_away_from_zero() {
    let field = ForceField::from_components(
        &Grid::from_shape_fn((4, 6), |(_, x)| (x * x) as f64),
        &Grid::zeros((4, 6)),
    )
    .unwrap();
    // from 1: 3.5 → 4, so the base is column 4 (16 − 7·½ … counting from 0: 9 + (−½)(16 − 9))
    assert_eq!(
        field.at_report(DVec2::new(2.5, 1.0)).unwrap().x,
        9.0 - 0.5 * 7.0
    );
    // from 1: −0.5 → −1, outside
    assert!(field.at_report(DVec2::new(1.0, -1.5)).is_err());
    assert!(field.at_report(DVec2::new(1.0, -1.499)).is_ok());
}

#[test]
fn d54_d56_the_last_row_and_column_stop_the_program() {
    let field = report(&edge(0.0));
    let stops = |x, y| {
        field
            .at_report(DVec2::new(x, y))
            .err()
            .map(|outside| outside.axis)
    };
    assert_eq!(stops(99.49, 50.0), None);
    assert_eq!(stops(99.5, 50.0), Some('x'));
    assert_eq!(stops(50.0, 99.49), None);
    // y clamped to ny still stops: row ny + 1 is read (D56)
    assert_eq!(stops(50.0, 99.5), Some('y'));
    assert_eq!(stops(50.0, 100.0), Some('y'));
    assert_eq!(stops(50.0, 100.5), Some('x'));
    assert_eq!(stops(-0.51, 50.0), Some('x'));
    assert_eq!(stops(f64::NAN, 50.0), Some('x'));
    assert_eq!(stops(50.0, f64::NEG_INFINITY), Some('x'));
}

#[test]
fn d59_rows_are_y_and_columns_x_from_zero_and_down() {
    // bright below row 20: the y force pulls down from above and up from below
    let image = Grid::from_shape_fn((40, 30), |(y, _)| if y > 20 { 100.0 } else { 0.0 });
    let field = edge_force(&image, &CORRECTED).unwrap();
    assert_eq!((field.width(), field.height()), (30, 40));
    assert!(field.at(DVec2::new(15.0, 17.0)).y > 1.0);
    assert!(field.at(DVec2::new(15.0, 24.0)).y < -1.0);
    assert!(field.at(DVec2::new(15.0, 20.5)).length() < 1e-10);
}

#[test]
fn peak_forces_at_the_reports_scale() {
    // errata §3.3, an edge of 100 grey levels: 0.1351 · 100 at 3 … 4 px
    let image = edge(0.0) * 100.0;
    let stages = report_stages(&image, 20, 0.15, 10.0).unwrap();
    let (fx, _) = stages.force.components();
    let (mut peak, mut at) = (0.0, 0);
    for x in 0..101 {
        if fx[[50, x]] > peak {
            (peak, at) = (fx[[50, x]], x);
        }
    }
    assert!((peak - 13.51).abs() < 0.005, "{peak}");
    // the edge lies at 50.5: pixels above 50 are bright
    assert!((3.0..=4.0).contains(&(50.5 - at as f64)), "{at}");
    let slope = fx[[50, 50]] - fx[[50, 51]];
    assert!((slope - 6.676).abs() < 5e-4, "{slope}");
    // the corrected one has the same peak in every stage's units
    let corrected = edge_stages(&image, &EdgeForce::as_strong_as_the_report()).unwrap();
    assert!((corrected.force.largest() - peak).abs() < 1e-9);
}
