use super::*;
use crate::{ForceField, Grid};
use proptest::prelude::*;

const RULES: [Interpolation; 2] = [Interpolation::Bilinear, Interpolation::Bicubic];

fn field(height: usize, width: usize, f: impl Fn(f64, f64) -> DVec2) -> ForceField {
    let grid = |part: fn(DVec2) -> f64| {
        Grid::from_shape_fn((height, width), |(y, x)| part(f(x as f64, y as f64)))
    };
    ForceField::from_components(&grid(|f| f.x), &grid(|f| f.y)).unwrap()
}

fn wavy(height: usize, width: usize) -> ForceField {
    field(height, width, |x, y| {
        DVec2::new((x * 1.3).sin() + y * y * 0.1, (x * 0.7 - y * 1.1).cos())
    })
}

fn near(a: DVec2, b: DVec2, tolerance: f64) -> bool {
    (a - b).length() < tolerance
}

#[test]
fn pixels_keep_their_forces() {
    let field = wavy(6, 9);
    for rule in RULES {
        for (x, y) in [(0_usize, 0_usize), (3, 4), (8, 5), (8, 0), (1, 5)] {
            let p = DVec2::new(x as f64, y as f64);
            let pixel = field.pixel(x, y).unwrap();
            assert!(near(field.sample(p, rule), pixel, 1e-14));
        }
    }
}

#[test]
fn bicubic_is_exact_for_quadratic_fields_off_the_border() {
    let f = |x: f64, y: f64| DVec2::new(x * x - 2.0 * x * y + 3.0, y * y + x * y - x);
    let field = field(8, 9, f);
    for (x, y) in [(2.25, 3.5), (4.9, 2.1), (5.0, 5.5)] {
        let (value, slope) = field.sample_with_slope(DVec2::new(x, y), Interpolation::Bicubic);
        assert!(near(value, f(x, y), 1e-12));
        assert!(near(
            slope.x_axis,
            DVec2::new(2.0 * x - 2.0 * y, y - 1.0),
            1e-12
        ));
        assert!(near(slope.y_axis, DVec2::new(-2.0 * x, 2.0 * y + x), 1e-12));
    }
}

#[test]
fn bicubic_slopes_are_continuous_across_pixels_and_bilinear_ones_are_not() {
    let field = wavy(7, 8);
    let jump = |rule| {
        let slope = |x: f64| field.sample_with_slope(DVec2::new(x, 2.3), rule).1.x_axis;
        (slope(4.0 + 1e-9) - slope(4.0 - 1e-9)).length()
    };
    assert!(jump(Interpolation::Bicubic) < 1e-6);
    assert!(jump(Interpolation::Bilinear) > 0.1);
}

#[test]
fn outside_the_field_goes_on_flat() {
    let field = wavy(5, 6);
    for rule in RULES {
        let (value, slope) = field.sample_with_slope(DVec2::new(-3.0, 2.2), rule);
        assert!(near(value, field.sample(DVec2::new(0.0, 2.2), rule), 1e-14));
        assert_eq!(slope.x_axis, DVec2::ZERO);
        assert!(slope.y_axis.length() > 0.0);
        assert!(
            field
                .sample_with_slope(DVec2::new(f64::NAN, 1.0), rule)
                .0
                .is_nan()
        );
    }
}

#[test]
fn many_points_are_the_points_one_by_one() {
    let field = wavy(9, 7);
    let points: Vec<DVec2> = (0..50)
        .map(|i| DVec2::new(f64::from(i) * 0.3 - 2.0, f64::from(i) * 0.17))
        .collect();
    let (mut values, mut slopes) = (vec![DVec2::ZERO; 50], vec![DMat2::ZERO; 50]);
    for rule in RULES {
        field.sample_into(&points, rule, &mut values);
        for (&p, &value) in points.iter().zip(&values) {
            assert_eq!(value, field.sample(p, rule));
        }
        field.sample_with_slope_into(&points, rule, &mut values, &mut slopes);
        for ((&p, &value), &slope) in points.iter().zip(&values).zip(&slopes) {
            assert_eq!((value, slope), field.sample_with_slope(p, rule));
        }
    }
    assert_eq!(
        field.at(points[20]),
        field.sample(points[20], Interpolation::Bilinear)
    );
}

/// Places of every kind: inside, on pixels, on and beyond every border, and nowhere.
fn places(height: usize, width: usize) -> Vec<DVec2> {
    let axis = |n: usize| {
        let last = n as f64 - 1.0;
        let special = [
            -1e300,
            -2.5,
            -0.0,
            0.0,
            1e-300,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::NAN,
        ];
        let border = [last - 1.0, last - 0.25, last, last + 1e-12, last + 7.0];
        let inside = (0..9).map(move |i| last * f64::from(i) * 0.1237);
        special.into_iter().chain(border).chain(inside)
    };
    let all = axis(height).flat_map(|y| axis(width).map(move |x| DVec2::new(x, y)));
    all.collect()
}

fn bits(f: DVec2) -> [u64; 2] {
    // one NaN is as good as another
    f.to_array()
        .map(|v| if v.is_nan() { u64::MAX } else { v.to_bits() })
}

#[test]
fn many_points_have_the_digits_of_one_by_one_wherever_they_lie() {
    for (height, width) in [
        (1, 1),
        (1, 9),
        (9, 1),
        (2, 2),
        (3, 3),
        (4, 4),
        (2, 7),
        (12, 31),
    ] {
        let double = wavy(height, width);
        let picture =
            ndarray::Array2::from_shape_fn((height, width), |(y, x)| (x * x + 3 * y) as f32);
        let recipe = crate::Recipe::Edge(crate::EdgeForce::as_strong_as_the_report());
        let single = crate::fast_force(picture.view(), &recipe, 1).unwrap();
        let lazy = crate::lazy_force(picture, &recipe).unwrap().scaled(0.3);
        let points = places(height, width);
        let n = points.len();
        let (mut values, mut slopes) = (vec![DVec2::ONE; n], vec![DMat2::ZERO; n]);
        for field in [&double, &single, &lazy] {
            for rule in RULES {
                field.sample_into(&points, rule, &mut values);
                for (&p, &value) in points.iter().zip(&values) {
                    assert_eq!(bits(value), bits(field.sample(p, rule)), "{rule:?} at {p}");
                    assert_eq!(value.is_nan(), p.is_nan(), "{rule:?} at {p}");
                }
                field.sample_with_slope_into(&points, rule, &mut values, &mut slopes);
                for (k, &p) in points.iter().enumerate() {
                    let (value, slope) = field.sample_with_slope(p, rule);
                    assert_eq!(bits(values[k]), bits(value), "{rule:?} at {p}");
                    assert_eq!(
                        bits(values[k]),
                        bits(field.sample(p, rule)),
                        "{rule:?} at {p}"
                    );
                    assert_eq!(
                        bits(slopes[k].x_axis),
                        bits(slope.x_axis),
                        "{rule:?} at {p}"
                    );
                    assert_eq!(
                        bits(slopes[k].y_axis),
                        bits(slope.y_axis),
                        "{rule:?} at {p}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_shortest_slice_says_how_many() {
    let field = wavy(5, 6);
    let points = vec![DVec2::splat(2.3); 200];
    for rule in RULES {
        let (mut values, mut slopes) = (vec![DVec2::ZERO; 130], vec![DMat2::ZERO; 70]);
        field.sample_into(&points[..100], rule, &mut values);
        assert!(values[99] != DVec2::ZERO && values[100] == DVec2::ZERO);
        values.fill(DVec2::ZERO);
        field.sample_with_slope_into(&points, rule, &mut values, &mut slopes);
        assert!(
            values[69] != DVec2::ZERO && values[70] == DVec2::ZERO && slopes[69] != DMat2::ZERO
        );
    }
}

/// The bilinear formula as it is written down, without a trick.
#[test]
fn bilinear_values_are_the_formula_to_the_last_bit() {
    let field = wavy(8, 11);
    let points: Vec<DVec2> = (0..500_u32)
        .map(|i| {
            DVec2::new(
                f64::from(i * 37 % 499) * 0.02,
                f64::from(i * 61 % 497) * 0.014,
            )
        })
        .collect();
    let mut values = vec![DVec2::ZERO; 500];
    field.sample_into(&points, Interpolation::Bilinear, &mut values);
    for (p, value) in points.iter().zip(values) {
        let (x, y) = (
            (0..10_usize).rfind(|&x| x as f64 <= p.x),
            (0..7_usize).rfind(|&y| y as f64 <= p.y),
        );
        let (x, y) = (x.unwrap(), y.unwrap());
        let (tx, ty) = (p.x - x as f64, p.y - y as f64);
        let f = |row, column| field.pixel(column, row).unwrap();
        let above = f(y, x) * (1.0 - tx) + f(y, x + 1) * tx;
        let below = f(y + 1, x) * (1.0 - tx) + f(y + 1, x + 1) * tx;
        assert_eq!(value, above * (1.0 - ty) + below * ty, "at {p}");
    }
}

proptest! {
    #[test]
    fn slopes_are_the_derivatives_of_the_values(
        (height, width) in (1_usize..7, 1_usize..7), (u, v) in (0.0..1.0_f64, 0.0..1.0_f64),
    ) {
        let field = wavy(height, width);
        let p = DVec2::new(u * (width - 1) as f64, v * (height - 1) as f64);
        // the difference quotient must stay inside one cell and inside the field
        let step = 1e-5;
        let clear = |x: f64| (x - x.round()).abs() > 2.0 * step;
        prop_assume!((width == 1 || clear(p.x)) && (height == 1 || clear(p.y)));
        for rule in RULES {
            let (value, slope) = field.sample_with_slope(p, rule);
            prop_assert!(near(value, field.sample(p, rule), 1e-13));
            for (axis, column) in [(DVec2::X, slope.x_axis), (DVec2::Y, slope.y_axis)] {
                let quotient =
                    (field.sample(p + step * axis, rule) - field.sample(p - step * axis, rule)) / (2.0 * step);
                // central differences: step² times a third derivative of at most 10, and rounding / step
                prop_assert!(near(column, quotient, 1e-8), "{:?}: {} and {}", rule, column, quotient);
            }
        }
    }

    #[test]
    fn both_rules_reproduce_every_affine_field(
        (height, width) in (2_usize..7, 2_usize..7),
        c in proptest::array::uniform6(-9.0..9.0_f64),
        (u, v) in (0.0..1.0_f64, 0.0..1.0_f64),
    ) {
        let f = |x: f64, y: f64| DVec2::new(c[0] + c[1] * x + c[2] * y, c[3] + c[4] * x + c[5] * y);
        let field = field(height, width, f);
        let p = DVec2::new(u * (width - 1) as f64, v * (height - 1) as f64);
        for rule in RULES {
            let (value, slope) = field.sample_with_slope(p, rule);
            prop_assert!(near(value, f(p.x, p.y), 1e-11));
            prop_assert!(near(slope.x_axis, DVec2::new(c[1], c[4]), 1e-11));
            prop_assert!(near(slope.y_axis, DVec2::new(c[2], c[5]), 1e-11));
        }
    }
}
