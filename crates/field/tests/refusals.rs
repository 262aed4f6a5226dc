//! Bad input gets one line that says what is needed; odd but good input gets its answer.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::float_cmp,
    reason = "a test may stop, and exact means exact"
)]

use field::{
    EdgeForce, FieldError, ForceField, Grid, Smoothing, edge_force, gradient_force, literal,
    report_force,
};
use glam::DVec2;
use ndarray::Array2;

const RULE: EdgeForce = EdgeForce {
    smoothing: Smoothing::Binomial(20),
    gain: 1.0,
};

fn both(image: &Grid) -> [Result<ForceField, FieldError>; 3] {
    [
        report_force(image, 20, 0.15, 10.0),
        edge_force(image, &RULE),
        literal::report_force(image, 20, 0.15, 10.0),
    ]
}

#[test]
fn an_empty_image_is_refused_with_its_shape() {
    for (height, width) in [(0, 0), (0, 5), (5, 0)] {
        for result in both(&Grid::zeros((height, width))) {
            assert_eq!(result.unwrap_err(), FieldError::Empty { width, height });
        }
    }
    let message = both(&Grid::zeros((0, 5)))[0]
        .as_ref()
        .unwrap_err()
        .to_string();
    assert_eq!(
        message,
        "an image needs at least one row and one column, got 5 × 0"
    );
}

#[test]
fn the_first_pixel_that_is_no_number_is_named() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut image = Grid::zeros((7, 9));
        image[[3, 5]] = bad;
        image[[6, 0]] = f64::NAN;
        for result in both(&image) {
            let Err(FieldError::NotFinite {
                column: 5,
                row: 3,
                value,
            }) = result
            else {
                panic!("{result:?}")
            };
            assert_eq!(value.to_bits(), bad.to_bits());
        }
    }
    let mut image = Grid::zeros((1, 1));
    image[[0, 0]] = f64::NAN;
    let message = both(&image)[0].as_ref().unwrap_err().to_string();
    assert_eq!(
        message,
        "pixel (0, 0) is NaN; every pixel must be a finite number"
    );
}

#[test]
fn pixels_that_would_overflow_are_refused() {
    let image = Grid::from_elem((3, 3), 1e150);
    assert!(matches!(
        edge_force(&image, &RULE),
        Err(FieldError::TooLarge {
            column: 0,
            row: 0,
            ..
        })
    ));
    let image = Grid::from_shape_fn((3, 3), |(_, x)| x as f64 * 1e139);
    assert!(edge_force(&image, &RULE).unwrap().largest().is_finite());
}

#[test]
fn parameters_that_are_not_positive_are_refused_by_name() {
    let image = Grid::zeros((5, 5));
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let named = |result: Result<ForceField, FieldError>, wanted: &str| match result {
            Err(FieldError::NotPositive { name, .. }) => assert_eq!(name, wanted),
            other => panic!("{other:?}"),
        };
        named(report_force(&image, 20, bad, 10.0), "scale");
        named(report_force(&image, 20, 0.15, bad), "gain");
        named(edge_force(&image, &EdgeForce { gain: bad, ..RULE }), "gain");
        let smoothing = Smoothing::Gaussian(bad);
        named(
            edge_force(&image, &EdgeForce { smoothing, ..RULE }),
            "sigma",
        );
    }
    let error = report_force(&image, 20, -1.0, 10.0).unwrap_err();
    assert_eq!(
        error.to_string(),
        "scale must be finite and above 0, got -1"
    );
}

#[test]
fn absurd_smoothing_is_refused_with_the_limit() {
    let image = Grid::zeros((5, 5));
    let error = report_force(&image, u32::MAX, 1.0, 10.0).unwrap_err();
    assert_eq!(
        error.to_string(),
        "passes must be at most 10000, got 4294967295"
    );
    let smoothing = Smoothing::Gaussian(1e5);
    assert!(matches!(
        edge_force(&image, &EdgeForce { smoothing, ..RULE }),
        Err(FieldError::TooMuch { name: "sigma", .. })
    ));
}

#[test]
fn fields_of_nothing_or_of_no_numbers_are_refused() {
    assert!(matches!(
        ForceField::new(Array2::default((0, 3))),
        Err(FieldError::Empty { .. })
    ));
    let forces = Array2::from_elem((2, 2), DVec2::new(0.0, f64::NAN));
    assert!(matches!(
        ForceField::new(forces),
        Err(FieldError::NotFinite {
            column: 0,
            row: 0,
            ..
        })
    ));
    let error =
        ForceField::from_components(&Grid::zeros((2, 3)), &Grid::zeros((3, 2))).unwrap_err();
    assert_eq!(
        error.to_string(),
        "both grids must have the same shape, got 3 × 2 and 2 × 3"
    );
    assert!(gradient_force(&Grid::zeros((0, 0)), 1.0).is_err());
}

#[test]
fn tiny_images_have_fields_too() {
    for (height, width) in [(1, 1), (1, 9), (9, 1), (2, 2), (3, 3)] {
        let image = Grid::from_shape_fn((height, width), |(y, x)| (x * x + 3 * y) as f64);
        for result in both(&image) {
            let field = result.unwrap();
            assert_eq!((field.width(), field.height()), (width, height));
            let (fx, fy) = field.components();
            // one column has no x derivative, one row no y derivative
            assert!(width > 1 || fx.iter().all(|&f| f == 0.0));
            assert!(height > 1 || fy.iter().all(|&f| f == 0.0));
            for p in [DVec2::ZERO, DVec2::new(0.5, 0.5), DVec2::new(-3.0, 99.0)] {
                assert!(field.at(p).is_finite());
            }
        }
        // the fast program is the slow one
        assert_eq!(
            report_force(&image, 20, 1.0, 10.0).unwrap(),
            literal::report_force(&image, 20, 1.0, 10.0).unwrap()
        );
    }
}

#[test]
fn a_constant_image_has_no_force_at_all() {
    let exactly_zero = |field: ForceField| field.largest() == 0.0;
    for value in [0.0, 1.0, 0.1, -7.3, 65535.0] {
        let image = Grid::from_elem((11, 13), value);
        assert!(exactly_zero(edge_force(&image, &RULE).unwrap()));
        let gaussian = EdgeForce {
            smoothing: Smoothing::Gaussian(2.5),
            gain: 1.0,
        };
        assert!(exactly_zero(edge_force(&image, &gaussian).unwrap()));
        assert!(exactly_zero(report_force(&image, 20, 0.15, 10.0).unwrap()));
    }
}

#[test]
fn a_transposed_view_is_an_image_like_any_other() {
    let image = Grid::from_shape_fn((6, 8), |(y, x)| ((x * 5 + y * 3) % 7) as f64);
    let reversed_axes = image.clone().reversed_axes();
    let copied = Grid::from_shape_fn((8, 6), |(y, x)| image[[x, y]]);
    assert_eq!(
        edge_force(&reversed_axes, &RULE).unwrap(),
        edge_force(&copied, &RULE).unwrap()
    );
}
