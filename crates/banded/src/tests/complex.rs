//! Complex shifts against the real system of twice the size.

use glam::DVec2;
use proptest::prelude::*;

use super::{largest, springs, with_vector};
use crate::{
    BandedError, Complex, ComplexFactor, ComplexPoint, Dense, Factor, Operator, Pentadiagonal,
};

/// `[[Re, −Im], [Im, Re]]`: the real matrix that does to (Re x, Im x) what a complex one does to x.
fn doubled(a: &Dense, shift: &[Complex]) -> Dense {
    let n = shift.len();
    Dense::from_fn(2 * n, |i, j| match (i < n, j < n) {
        (true, true) => a[(i, j)] + if i == j { shift[i].re } else { 0.0 },
        (false, false) => a[(i - n, j - n)] + if i == j { shift[i - n].re } else { 0.0 },
        (true, false) => {
            if i == j - n {
                -shift[i].im
            } else {
                0.0
            }
        }
        (false, true) => {
            if i - n == j {
                shift[j].im
            } else {
                0.0
            }
        }
    })
}

/// `max |b − A x| / (‖A‖ max |x|)` over rows and coordinates.
fn backward_error(a: &Dense, x: &[ComplexPoint], b: &[ComplexPoint]) -> f64 {
    let norm = a
        .rows()
        .map(|row| row.iter().map(|a| a.abs()).sum())
        .fold(0.0_f64, f64::max);
    let mut worst = 0.0_f64;
    for coordinate in 0..2 {
        let stack = |points: &[ComplexPoint]| -> Vec<f64> {
            let re = points.iter().map(|p| p.re[coordinate]);
            re.chain(points.iter().map(|p| p.im[coordinate])).collect()
        };
        let (x, b) = (stack(x), stack(b));
        let rest: Vec<f64> = a
            .multiply(&x)
            .iter()
            .zip(&b)
            .map(|(ax, b)| b - ax)
            .collect();
        worst = worst.max(largest(&rest) / (norm * largest(&x)).max(f64::MIN_POSITIVE));
    }
    worst
}

/// `z² μ + z γ` with uneven masses and dampings.
fn shifts(n: usize, z: Complex, gamma: f64) -> Vec<Complex> {
    let mu = |i: usize| if i.is_multiple_of(3) { 0.5 } else { 1.5 };
    (0..n)
        .map(|i| z * z * mu(i) + z * (gamma * mu(i + 1)))
        .collect()
}

proptest! {
    #[test]
    fn shifted_solution_satisfies_the_system_to_rounding(
        (a, b) in with_vector(),
        size in -2.0..3.0_f64,
        turn in 0.0..1.5_f64,
        gamma in 0.0..10.0_f64,
    ) {
        // Re z > 0: as the poles of every stable scheme
        let z = Complex::new(turn.cos(), turn.sin()) * 10.0_f64.powf(size);
        let shift = shifts(a.len(), z, gamma);
        let factor = ComplexFactor::new(&a, &shift).unwrap();
        let b: Vec<ComplexPoint> = b.iter().map(|b| ComplexPoint::new(*b, b.perp())).collect();
        let mut x = b.clone();
        factor.solve(&mut x);
        let error = backward_error(&doubled(&a.dense(), &shift), &x, &b);
        // four real products in place of one, and growth below 3
        prop_assert!(error <= 16.0 * f64::EPSILON, "{}", error);

        let mut scalars: Vec<Complex> = b.iter().map(|b| Complex::new(b.re.y, b.im.y)).collect();
        factor.solve_scalars(&mut scalars);
        let size = scalars.iter().fold(0.0_f64, |most, s| most.max(s.abs()));
        for (x, s) in x.iter().zip(scalars) {
            // the same operations, with some differences commuted
            let allowed = 64.0 * f64::EPSILON / factor.reciprocal_condition() * size;
            prop_assert!((x.re.y - s.re).abs().max((x.im.y - s.im).abs()) <= allowed);
        }
    }

    #[test]
    fn a_real_shift_gives_the_real_factors_solution((a, b) in with_vector()) {
        let mut real = a.clone();
        real.add_identity(0.5);
        let factor = ComplexFactor::new(&a, &vec![Complex::from(0.5); a.len()]).unwrap();
        let mut expected = b.clone();
        Factor::new(&real).unwrap().solve(&mut expected);
        let mut x: Vec<ComplexPoint> = b.iter().map(|&b| b.into()).collect();
        factor.solve(&mut x);
        let size = expected.iter().fold(0.0_f64, |most, x| most.max(x.abs().max_element()));
        for (x, expected) in x.iter().zip(expected) {
            // one over a complex pivot may differ from one over a real one by a unit
            let allowed = 1e-14 / factor.reciprocal_condition() * size;
            prop_assert!((x.re - expected).abs().max_element() <= allowed);
            prop_assert_eq!(x.im, DVec2::ZERO);
        }
    }

    #[test]
    fn shifted_operator_with_columns_solves_as_the_dense_one(
        (a, b) in with_vector(),
        column in proptest::collection::vec(-1.0..1.0_f64, 40),
    ) {
        let n = a.len();
        let column = column[..n].to_vec();
        let operator = Operator::new(a, vec![column, vec![1.0; n]], vec![1.0, 0.2, 0.2, 2.0]).unwrap();
        let shift = shifts(n, Complex::new(2.0, 1.0), 1.0);
        let b: Vec<ComplexPoint> = b.iter().map(|b| ComplexPoint::new(*b, b.perp())).collect();
        let mut x = b.clone();
        operator.factor_shifted(&shift).unwrap().solve(&mut x);
        let error = backward_error(&doubled(&operator.dense(), &shift), &x, &b);
        // the band alone is as well conditioned as the whole, within n
        prop_assert!(error <= 1e-13, "{}", error);
    }
}

#[test]
fn a_shift_that_is_an_eigenvalue_is_refused() {
    for cyclic in [false, true] {
        let a = springs(24, cyclic, &[1.0, 0.7, 0.3, 2.0], 0.1);
        for value in a.dense().eigen().unwrap().values {
            match ComplexFactor::new(&a, &[Complex::from(-value); 24]) {
                Err(BandedError::Singular { .. } | BandedError::Unstable { .. }) => {}
                other => panic!("{value}: {other:?}"),
            }
        }
    }
}

#[test]
fn a_pivot_too_small_to_go_without_exchange_is_refused() {
    // [[ε, 1], [1, 0]] in the corner: regular, but not without exchanging rows
    let mut a = Pentadiagonal::new(6, false).unwrap();
    a.add(0, 1, 1.0);
    let shift = |first: f64| [first, 0.0, 1.0, 1.0, 1.0, 1.0].map(Complex::from);
    assert!(matches!(
        ComplexFactor::new(&a, &shift(1e-14)),
        Err(BandedError::Unstable { .. })
    ));
    assert!(matches!(
        ComplexFactor::new(&a, &shift(0.0)),
        Err(BandedError::Singular { row: 0, .. })
    ));
    assert!(matches!(
        ComplexFactor::new(&a, &[Complex::from(1.0); 5]),
        Err(BandedError::Length { .. })
    ));
    let nan = [Complex::new(1.0, f64::NAN); 6];
    assert_eq!(
        ComplexFactor::new(&a, &nan),
        Err(BandedError::NotFinite { row: 0 })
    );
}

#[test]
fn one_over_a_complex_number_neither_overflows_nor_loses_digits() {
    for (re, im) in [
        (3.0, 4.0),
        (-4.0, 3.0),
        (1e200, 1e200),
        (1e-200, -2e-200),
        (0.0, 2.0),
    ] {
        let z = Complex::new(re, im);
        let one = z * z.recip();
        assert!((one.re - 1.0).abs() <= 4.0 * f64::EPSILON, "{z:?}");
        assert!(one.im.abs() <= 4.0 * f64::EPSILON, "{z:?}");
    }
}
