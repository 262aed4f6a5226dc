//! Bands of any width against the dense twin, and against the pentadiagonal one.

use glam::DVec2;
use proptest::prelude::*;

use super::{backward_error, coordinates, springs, with_vector};
use crate::{
    Band, Banded, BandedError, BandedFactor, Circulant, Complex, ComplexPoint, Dense, Factor,
    largest_eigenvalue, smallest_eigenvalue,
};

/// Springs over every distance the band allows.
fn wide<const P: usize>(n: usize, cyclic: bool, weights: &[f64], floor: f64) -> Banded {
    let mut a = Banded::new(n, P, cyclic).unwrap();
    for i in 0..n {
        a.add(i, i, floor);
        for k in 1..=P {
            if cyclic || i + k < n {
                let weight = weights[(P * i + k) % weights.len()];
                a.add_outer(weight, &[(i, 1.0), ((i + k) % n, -1.5 * weight.sin())]);
            }
        }
    }
    a
}

fn check<const P: usize>(n: usize, cyclic: bool, weights: &[f64], floor: f64, b: &[f64]) {
    let a = wide::<P>(n, cyclic, weights, floor);
    let dense = a.dense();
    let mut x = b[..n].to_vec();
    let factor = BandedFactor::new(&a).unwrap();
    assert_eq!(factor.len(), n);
    factor.solve_scalars(&mut x);
    let error = backward_error(&dense, &x, &b[..n]);
    assert!(
        error <= 8.0 * f64::EPSILON,
        "P = {P}, n = {n}, {cyclic}: {error:e}"
    );
    let mut product = vec![f64::NAN; n];
    a.multiply_scalars_into(&x, &mut product);
    for (found, expected) in product.iter().zip(dense.multiply(&x)) {
        // 2 P + 1 products of at most 30 |x| each, in another order
        let size = x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        assert!((found - expected).abs() <= 1e-12 * size);
    }
}

proptest! {
    #[test]
    fn bands_of_any_width_are_solved_to_rounding(
        extra in 0..30_usize,
        cyclic in any::<bool>(),
        weights in proptest::collection::vec(0.01..3.0_f64, 7..20),
        floor in -6.0..1.0_f64,
        b in proptest::collection::vec(-1.0..1.0_f64, 60),
    ) {
        let floor = 10.0_f64.powf(floor);
        let least = |p: usize| extra + if cyclic { 2 * p + 1 } else { p + 1 };
        check::<1>(least(1), cyclic, &weights, floor, &b);
        check::<2>(least(2), cyclic, &weights, floor, &b);
        check::<3>(least(3), cyclic, &weights, floor, &b);
        check::<4>(least(4), cyclic, &weights, floor, &b);
        check::<7>(least(7), cyclic, &weights, floor, &b);
    }

    #[test]
    fn half_width_two_is_the_pentadiagonal((a, b) in with_vector()) {
        let mut wide = Banded::new(a.len(), 2, a.is_cyclic()).unwrap();
        for i in 0..a.len() {
            for j in i..a.len() {
                if a.entry(i, j).abs() > 0.0 {
                    wide.add(i, j, a.entry(i, j));
                }
            }
        }
        prop_assert_eq!(wide.dense(), a.dense());
        let factor = Factor::new(&a).unwrap();
        let (mut expected, mut x) = (b.clone(), b.clone());
        factor.solve(&mut expected);
        BandedFactor::new(&wide).unwrap().solve(&mut x);
        let size = expected.iter().fold(0.0_f64, |most, x| most.max(x.abs().max_element()));
        let allowed = 16.0 * f64::EPSILON / factor.reciprocal_condition() * size;
        for (x, expected) in coordinates(&x).concat().iter().zip(coordinates(&expected).concat()) {
            prop_assert!((x - expected).abs() <= allowed);
        }
    }
}

#[test]
fn condition_numbers_to_1e12_leave_the_residual_at_rounding() {
    for cyclic in [false, true] {
        for exponent in [4, 8, 12] {
            let narrow = springs(300, cyclic, &[1.0, 0.8, 1.2], 0.0);
            let floor = narrow.norm() * 10.0_f64.powi(-exponent);
            let mut a = Banded::new(600, 4, cyclic).unwrap();
            // x and y alternate, and feel each other at every node
            for i in 0..300 {
                for j in 0..300 {
                    if i <= j && narrow.entry(i, j).abs() > 0.0 {
                        a.add(2 * i, 2 * j, narrow.entry(i, j));
                        a.add(2 * i + 1, 2 * j + 1, narrow.entry(i, j));
                    }
                }
                a.add_outer(floor, &[(2 * i, 1.0), (2 * i + 1, -1.0)]);
                a.add_outer(floor, &[(2 * i, 2.0), (2 * i + 1, 0.3)]);
            }
            let b: Vec<f64> = (0..600).map(|i| f64::from(i * i % 17) - 8.0).collect();
            let mut x = b.clone();
            BandedFactor::new(&a).unwrap().solve_scalars(&mut x);
            let error = backward_error(&a.dense(), &x, &b);
            assert!(
                error <= 4.0 * f64::EPSILON,
                "{cyclic} 1e{exponent}: {error:e}"
            );
        }
    }
}

#[test]
fn what_cannot_be_solved_is_refused_with_a_row() {
    for cyclic in [false, true] {
        let needed = if cyclic { 7 } else { 4 };
        let refused = Banded::new(needed - 1, 3, cyclic);
        assert_eq!(
            refused,
            Err(BandedError::TooSmall {
                needed,
                got: needed - 1
            })
        );
        for row in 0..10 {
            let mut a = Banded::new(10, 3, cyclic).unwrap();
            (0..10).for_each(|i| a.add(i, i, 2.0));
            a.add(row, row, -3.0);
            let refused = BandedFactor::new(&a);
            assert_eq!(refused, Err(BandedError::NotPositive { row, pivot: -1.0 }));
            a.add(row, row, f64::NAN);
            assert_eq!(BandedFactor::new(&a), Err(BandedError::NotFinite { row }));
        }
    }
    // a ring of springs over one, two and three nodes, free to move as a whole
    let mut a = Banded::new(50, 3, true).unwrap();
    for i in 0..50 {
        (1..4).for_each(|k| a.add_outer(1.0, &[(i, 1.0), ((i + k) % 50, -1.0)]));
    }
    match BandedFactor::new(&a) {
        Err(BandedError::Singular { row, .. } | BandedError::NotPositive { row, .. }) => {
            assert!(row < 50);
        }
        other => panic!("{other:?}"),
    }
}

/// Largest magnitude of `A x − b`, over that of `A` times that of `x`.
fn complex_error(a: &Dense, shift: &[Complex], x: &[Complex], b: &[Complex]) -> f64 {
    let parts = |part: fn(&Complex) -> f64| a.multiply(&x.iter().map(part).collect::<Vec<f64>>());
    let (re, im) = (parts(|x| x.re), parts(|x| x.im));
    let most = |values: &[Complex]| values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let rest: Vec<Complex> = (0..b.len())
        .map(|i| Complex::new(re[i], im[i]) + shift[i] * x[i] - b[i])
        .collect();
    let size = a.rows().map(|row| row.iter().map(|a| a.abs()).sum::<f64>());
    most(&rest) / ((size.fold(0.0, f64::max) + most(shift)) * most(x))
}

/// Everything a band is asked for, against all n² entries.
fn as_dense(p: usize, n: usize, cyclic: bool, weights: &[f64], points: &[DVec2]) {
    let weight = |i: usize| weights[i % weights.len()];
    let mut a = Band::new(n, p, cyclic).unwrap();
    a.add_identity(0.3);
    for i in 0..n {
        let row: Vec<(usize, f64)> = (0..=p)
            .filter(|k| cyclic || i + k < n)
            .map(|k| ((i + k) % n, weight(3 * i + 2 * k) - 1.0))
            .collect();
        a.add_outer(weight(i), &row);
    }
    assert_eq!(
        (a.half_width(), a.len(), a.is_cyclic()),
        (p.max(2), n, cyclic)
    );
    let (dense, x) = (a.dense(), &points[..n]);
    let size = x
        .iter()
        .fold(0.0_f64, |most, x| most.max(x.abs().max_element()));
    let close = |found: f64, expected: f64| {
        // 2 p + 1 products in another order
        assert!(
            (found - expected).abs() <= 1e-13 * a.norm() * size,
            "p = {p}, n = {n}, {cyclic}"
        );
    };
    let mut out = vec![DVec2::NAN; n];
    a.multiply_into(x, &mut out);
    let [first, second] = coordinates(x);
    let (product, other) = (dense.multiply(&first), dense.multiply(&second));
    for i in 0..n {
        close(out[i].x, product[i]);
        close(out[i].y, other[i]);
    }
    let work: f64 = (0..n)
        .map(|i| first[i] * product[i] + second[i] * other[i])
        .sum();
    assert!((a.quadratic(x) - work).abs() <= 1e-13 * a.norm() * size * size * n as f64);

    let mut solved = x.to_vec();
    a.factor().unwrap().solve(&mut solved);
    for (x, b) in coordinates(&solved).iter().zip([first, second]) {
        assert!(backward_error(&dense, x, &b) <= 8.0 * f64::EPSILON);
    }

    let shift: Vec<Complex> = (0..n)
        .map(|i| Complex::new(weight(i), weight(i + 1)))
        .collect();
    let right: Vec<Complex> = x.iter().map(|x| Complex::new(x.x, x.y)).collect();
    let mut solved = right.clone();
    let factor = a.factor_shifted(&shift).unwrap();
    factor.solve_scalars(&mut solved);
    let error = complex_error(&dense, &shift, &solved, &right);
    assert!(
        error <= 16.0 * f64::EPSILON,
        "p = {p}, n = {n}, {cyclic}: {error:e}"
    );
    let mut pairs: Vec<ComplexPoint> = right
        .iter()
        .map(|b| ComplexPoint::new(DVec2::splat(b.re), DVec2::splat(b.im)))
        .collect();
    factor.solve(&mut pairs);
    for (pair, alone) in pairs.iter().zip(&solved) {
        assert_eq!(
            [pair.re, pair.im],
            [DVec2::splat(alone.re), DVec2::splat(alone.im)]
        );
    }

    let mass: Vec<f64> = (0..n).map(|i| 0.5 + weight(i)).collect();
    let scaled = Dense::from_fn(n, |i, j| dense[(i, j)] / (mass[i] * mass[j]).sqrt());
    let values = scaled.eigen().unwrap().values;
    let (least, most) = (values[0], values[n - 1]);
    // the dense ones round some n times
    assert!((largest_eigenvalue(&a, &mass) - most).abs() <= 1e-12 * most);
    assert!((smallest_eigenvalue(&a, &mass) - least).abs() <= 1e-12 * most);
    assert!(a.is_positive_definite());
    let mut shifted = a.clone();
    shifted.add_diagonal(
        &mass
            .iter()
            .map(|m| -m * (least + 1e-9 * most))
            .collect::<Vec<f64>>(),
    );
    assert!(!shifted.is_positive_definite());

    let held: Vec<bool> = (0..n).map(|i| weight(5 * i) > 2.0 || i == 1).collect();
    a.hold(&held);
    for i in 0..n {
        for j in 0..n {
            let expected = if held[i] || held[j] {
                0.0
            } else {
                dense[(i, j)]
            };
            assert_eq!(a.entry(i, j).to_bits(), expected.to_bits());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_band_of_any_width_does_what_the_dense_matrix_does(
        extra in 0..30_usize,
        cyclic in any::<bool>(),
        weights in proptest::collection::vec(0.1..3.0_f64, 7..20),
        points in super::vectors(70),
    ) {
        for p in 1..=Banded::WIDEST {
            let least = extra + if cyclic { 2 * p.max(2) + 1 } else { p.max(2) + 1 };
            as_dense(p, least, cyclic, &weights, &points);
        }
    }
}

#[test]
fn rings_of_any_width_have_the_waves_of_their_differences() {
    // Dᵐᵀ Dᵐ has λ = (4 sin² θ/2)ᵐ
    let n = 31;
    for p in 3..=6_i32 {
        let width = usize::try_from(p).unwrap();
        let mut a = Band::new(n, width, true).unwrap();
        let mut row = vec![0.0; width + 1];
        row[0] = 1.0;
        for _ in 0..p {
            for k in (1..=width).rev() {
                row[k] -= row[k - 1];
            }
        }
        for i in 0..n {
            let springs: Vec<_> = row
                .iter()
                .enumerate()
                .map(|(k, c)| ((i + k) % n, *c))
                .collect();
            a.add_outer(2.0, &springs);
        }
        let waves = Circulant::new(&a).unwrap();
        for (k, found) in waves.eigenvalues().iter().enumerate() {
            let sine = (std::f64::consts::PI * k as f64 / n as f64).sin();
            let expected = 2.0 * (4.0 * sine * sine).powi(p);
            // entries are whole numbers, so small eigenvalues keep their digits
            assert!(
                (found - expected).abs() <= 1e-13 * expected,
                "p = {p}, wave {k}"
            );
        }
        let most = largest_eigenvalue(&a, &vec![1.0; n]);
        assert!((most / waves.eigenvalues()[n / 2] - 1.0).abs() < 1e-12);
        a.add(3, 4, 1e-9);
        assert_eq!(Circulant::new(&a).unwrap_err(), BandedError::NotCirculant);
    }
}

#[test]
fn widths_there_are_none_of_are_refused() {
    for got in [0, 17] {
        let refused = Banded::new(99, got, true).unwrap_err();
        assert_eq!(refused, BandedError::HalfWidth { most: 16, got });
    }
    let a = Band::new(9, 3, true).unwrap();
    assert!(matches!(
        a.factor_shifted(&[Complex::default(); 8]),
        Err(BandedError::Length { expected: 9, .. })
    ));
    assert!(matches!(
        a.factor_shifted(&[Complex::default(); 9]),
        Err(BandedError::Singular { row: 0, .. })
    ));
}
