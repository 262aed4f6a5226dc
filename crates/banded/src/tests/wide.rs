//! Bands of any width against the dense twin, and against the pentadiagonal one.

use proptest::prelude::*;

use super::{backward_error, coordinates, springs, with_vector};
use crate::{Banded, BandedError, BandedFactor, Factor};

/// Springs over every distance the band allows.
fn wide<const P: usize>(n: usize, cyclic: bool, weights: &[f64], floor: f64) -> Banded<P> {
    let mut a = Banded::new(n, cyclic).unwrap();
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
        let mut wide = Banded::<2>::new(a.len(), a.is_cyclic()).unwrap();
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
            let mut a = Banded::<4>::new(600, cyclic).unwrap();
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
        let refused = Banded::<3>::new(needed - 1, cyclic);
        assert_eq!(
            refused,
            Err(BandedError::TooSmall {
                needed,
                got: needed - 1
            })
        );
        for row in 0..10 {
            let mut a = Banded::<3>::new(10, cyclic).unwrap();
            (0..10).for_each(|i| a.add(i, i, 2.0));
            a.add(row, row, -3.0);
            let refused = BandedFactor::new(&a);
            assert_eq!(refused, Err(BandedError::NotPositive { row, pivot: -1.0 }));
            a.add(row, row, f64::NAN);
            assert_eq!(BandedFactor::new(&a), Err(BandedError::NotFinite { row }));
        }
    }
    // a ring of springs over one, two and three nodes, free to move as a whole
    let mut a = Banded::<3>::new(50, true).unwrap();
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
