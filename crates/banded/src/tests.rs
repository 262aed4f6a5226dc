//! Laws of the band, the factor and the operator, against the dense twin.

mod circulant;
mod complex;
mod eigen;
mod operator;
mod slice;
mod wide;

use glam::DVec2;
use proptest::prelude::*;

use crate::{
    Band, BandedError, Dense, Factor, Pentadiagonal, largest_eigenvalue, smallest_eigenvalue,
};

/// A sum of springs of random strengths and shapes: never negative, positive by `floor`.
fn springs(n: usize, cyclic: bool, weights: &[f64], floor: f64) -> Pentadiagonal {
    let mut a = Pentadiagonal::new(n, cyclic).unwrap();
    a.add_identity(floor);
    for i in 0..n {
        let weight = |k: usize| weights[(3 * i + k) % weights.len()];
        if cyclic || i + 1 < n {
            a.add_outer(weight(0), &[(i, -1.0), ((i + 1) % n, 1.0)]);
        }
        if cyclic || i + 2 < n {
            let bend = [
                (i, 1.0),
                ((i + 1) % n, -2.0 * weight(1)),
                ((i + 2) % n, 1.0),
            ];
            a.add_outer(weight(2), &bend);
        }
    }
    a
}

fn matrices() -> impl Strategy<Value = Pentadiagonal> {
    let weights = proptest::collection::vec(0.01..10.0_f64, 7..20);
    (5..40_usize, any::<bool>(), weights, -6.0..1.0_f64)
        .prop_map(|(n, cyclic, weights, floor)| springs(n, cyclic, &weights, 10.0_f64.powf(floor)))
}

fn vectors(n: usize) -> impl Strategy<Value = Vec<DVec2>> {
    let point = (-1.0..1.0_f64, -1.0..1.0_f64).prop_map(|(x, y)| DVec2::new(x, y));
    proptest::collection::vec(point, n)
}

fn with_vector() -> impl Strategy<Value = (Pentadiagonal, Vec<DVec2>)> {
    matrices().prop_flat_map(|a| {
        let n = a.len();
        (Just(a), vectors(n))
    })
}

fn coordinates(points: &[DVec2]) -> [Vec<f64>; 2] {
    [
        points.iter().map(|p| p.x).collect(),
        points.iter().map(|p| p.y).collect(),
    ]
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// `‖b − A x‖ / (‖A‖ ‖x‖)`, by the dense twin's product.
fn backward_error(a: &Dense, x: &[f64], b: &[f64]) -> f64 {
    let rest: Vec<f64> = a.multiply(x).iter().zip(b).map(|(ax, b)| b - ax).collect();
    let norm = a
        .rows()
        .map(|row| row.iter().map(|a| a.abs()).sum())
        .fold(0.0_f64, |m, s: f64| m.max(s));
    largest(&rest) / (norm * largest(x)).max(f64::MIN_POSITIVE)
}

proptest! {
    #[test]
    fn product_is_the_dense_one((a, x) in with_vector()) {
        let mut out = vec![DVec2::NAN; a.len()];
        a.multiply_into(&x, &mut out);
        let dense = a.dense();
        for (x, out) in coordinates(&x).iter().zip(coordinates(&out)) {
            let expected = dense.multiply(x);
            let mut scalars = vec![f64::NAN; a.len()];
            a.multiply_scalars_into(x, &mut scalars);
            for i in 0..a.len() {
                // five products, in another order
                prop_assert!((out[i] - expected[i]).abs() <= 8.0 * f64::EPSILON * a.norm());
                prop_assert_eq!(out[i].to_bits(), scalars[i].to_bits());
            }
        }
    }

    #[test]
    fn quadratic_form_is_the_product_with_itself((a, x) in with_vector()) {
        let mut out = vec![DVec2::ZERO; a.len()];
        a.multiply_into(&x, &mut out);
        let expected: f64 = x.iter().zip(&out).map(|(x, ax)| x.dot(*ax)).sum();
        let size: f64 = x.iter().map(|x| x.length_squared()).sum();
        // n sums of magnitude ‖A‖ ‖x‖²/n each
        prop_assert!((a.quadratic(&x) - expected).abs() <= 1e-14 * a.norm() * size);
    }

    #[test]
    fn solution_satisfies_the_system_to_rounding((a, b) in with_vector()) {
        let factor = Factor::new(&a).unwrap();
        let mut x = b.clone();
        factor.solve(&mut x);
        let dense = a.dense();
        for (x, b) in coordinates(&x).iter().zip(coordinates(&b)) {
            let error = backward_error(&dense, x, &b);
            // some units in the last place, for condition numbers up to 1e8 here
            prop_assert!(error <= 4.0 * f64::EPSILON, "{}", error);
            let mut scalars = b.clone();
            factor.solve_scalars(&mut scalars);
            for (x, scalar) in x.iter().zip(scalars) {
                prop_assert_eq!(x.to_bits(), scalar.to_bits());
            }
        }
    }

    #[test]
    fn solution_is_the_dense_one((a, b) in with_vector()) {
        let factor = Factor::new(&a).unwrap();
        let b = &coordinates(&b)[0];
        let expected = a.dense().solve(b).unwrap();
        let mut x = b.clone();
        factor.solve_scalars(&mut x);
        let allowed = 32.0 * f64::EPSILON / factor.reciprocal_condition() * largest(&expected);
        for (x, expected) in x.iter().zip(expected) {
            prop_assert!((x - expected).abs() <= allowed);
        }
    }

    #[test]
    fn extreme_eigenvalues_are_the_dense_ones(
        (a, _) in with_vector(),
        w in proptest::collection::vec(0.1..10.0_f64, 40),
    ) {
        let n = a.len();
        // A u = λ W u has the eigenvalues of W^-½ A W^-½
        let scaled = Dense::from_fn(n, |i, j| a.entry(i, j) / (w[i] * w[j]).sqrt());
        let expected = scaled.eigen().unwrap().values;
        let band = Band::from(a.clone());
        let found = [smallest_eigenvalue(&band, &w[..n]), largest_eigenvalue(&band, &w[..n])];
        let scale = expected[n - 1];
        prop_assert!((found[0] - expected[0]).abs() <= 1e-13 * scale, "{}", found[0]);
        prop_assert!((found[1] - scale).abs() <= 1e-12 * scale, "{}", found[1]);
    }

    #[test]
    fn positive_definite_means_every_eigenvalue_is_positive((a, _) in with_vector()) {
        let smallest = a.dense().eigen().unwrap().values[0];
        let mut shifted = a.clone();
        shifted.add_identity(-smallest - 1e-9 * a.norm());
        prop_assert!(!shifted.is_positive_definite());
        let refused = matches!(Factor::new(&shifted), Err(BandedError::NotPositive { .. }));
        prop_assert!(refused);
        shifted.add_identity(2e-9 * a.norm());
        prop_assert!(shifted.is_positive_definite());
        prop_assert!(Factor::new(&shifted).is_ok());
    }
}

#[test]
fn smallest_sizes_are_solved_and_smaller_ones_refused() {
    for cyclic in [false, true] {
        let needed = if cyclic { 5 } else { 3 };
        for got in 0..needed {
            let refused = Pentadiagonal::new(got, cyclic);
            assert_eq!(refused, Err(BandedError::TooSmall { needed, got }));
        }
        for n in needed..12 {
            let a = springs(n, cyclic, &[1.0, 0.7, 0.3, 2.0], 0.1);
            let b: Vec<f64> = (0..n)
                .map(|i| if i == n / 2 { 1.0 } else { 0.25 })
                .collect();
            let mut x = b.clone();
            Factor::new(&a).unwrap().solve_scalars(&mut x);
            assert!(
                backward_error(&a.dense(), &x, &b) <= 4.0 * f64::EPSILON,
                "{n} {cyclic}"
            );
        }
    }
}

#[test]
fn condition_numbers_to_1e12_leave_the_residual_at_rounding() {
    for (n, cyclic) in [
        (5, true),
        (64, true),
        (63, false),
        (1000, true),
        (1001, false),
    ] {
        for exponent in [2, 4, 6, 8, 10, 12] {
            let uneven: Vec<f64> = (0..n)
                .map(|i| 1.0 + 0.9 * (0.37 * f64::from(i)).sin())
                .collect();
            let n = uneven.len();
            let mut a = springs(n, cyclic, &uneven, 0.0);
            let floor = a.norm() * 10.0_f64.powi(-exponent);
            a.add_identity(floor);
            let factor = Factor::new(&a).unwrap();
            let b: Vec<DVec2> = (0..n)
                .map(|i| DVec2::new((1.3 * uneven[i]).cos(), uneven[(7 * i) % n]))
                .collect();
            let mut x = b.clone();
            factor.solve(&mut x);
            let mut product = vec![DVec2::ZERO; n];
            a.multiply_into(&x, &mut product);
            let (rest, size) = (0..n).fold((0.0_f64, 0.0_f64), |(rest, size), i| {
                (
                    rest.max((b[i] - product[i]).abs().max_element()),
                    size.max(x[i].abs().max_element()),
                )
            });
            let error = rest / (a.norm() * size);
            assert!(
                error <= 4.0 * f64::EPSILON,
                "{n} {cyclic} 1e{exponent}: {error:e}"
            );
        }
    }
}

#[test]
fn singular_matrices_are_refused_with_a_row() {
    for n in [5, 6, 7, 64, 1000, 4001] {
        for cyclic in [false, true] {
            let a = springs(n, cyclic, &[1.0, 1.0, 1.0], 0.0);
            match Factor::new(&a) {
                Err(BandedError::Singular { row, .. } | BandedError::NotPositive { row, .. }) => {
                    assert!(row < n);
                }
                other => panic!("{n} {cyclic}: {other:?}"),
            }
        }
    }
}

#[test]
fn the_row_that_is_not_positive_is_named() {
    for row in 0..9 {
        let mut a = Pentadiagonal::new(9, row % 2 == 0).unwrap();
        a.add_identity(2.0);
        a.add(row, row, -3.0);
        assert_eq!(
            Factor::new(&a),
            Err(BandedError::NotPositive { row, pivot: -1.0 })
        );
        a.add(row, row, f64::NAN);
        assert_eq!(Factor::new(&a), Err(BandedError::NotFinite { row }));
        assert!(!a.is_positive_definite());
    }
}

#[test]
fn held_nodes_leave_empty_rows_and_columns() {
    let mut a = springs(9, true, &[1.0, 0.5, 2.0], 1.0);
    let before = a.dense();
    let held: Vec<bool> = (0..9).map(|i| i == 0 || i == 5).collect();
    a.hold(&held);
    for i in 0..9 {
        for j in 0..9 {
            let expected = if held[i] || held[j] {
                0.0
            } else {
                before[(i, j)]
            };
            assert_eq!(a.entry(i, j).to_bits(), expected.to_bits());
        }
    }
}

#[test]
fn outer_products_wrap_round_and_may_repeat_an_index() {
    let mut a = Pentadiagonal::new(6, true).unwrap();
    a.add_outer(2.0, &[(5, 1.0), (0, 3.0), (5, 1.0), (1, -1.0)]);
    let r = [3.0, -1.0, 0.0, 0.0, 0.0, 2.0];
    let expected = Dense::from_fn(6, |i, j| 2.0 * r[i] * r[j]);
    assert_eq!(a.dense(), expected);
}

#[test]
fn only_equal_rows_make_a_circulant() {
    let mut a = springs(8, true, &[1.0], 0.5);
    assert_eq!(
        a.circulant(),
        Some([a.diagonal()[0], a.first()[0], a.second()[0]])
    );
    a.add(3, 4, 1e-12);
    assert_eq!(a.circulant(), None);
    assert_eq!(springs(8, false, &[1.0], 0.5).circulant(), None);
}
