//! A band with a few dense columns against the dense twin.

use glam::DVec2;
use proptest::prelude::*;

use super::{backward_error, coordinates, springs, with_vector};
use crate::{BandedError, Operator, Pentadiagonal};

proptest! {
    #[test]
    fn operator_with_columns_solves_as_the_dense_one(
        (a, b) in with_vector(),
        columns in proptest::collection::vec(proptest::collection::vec(-1.0..1.0_f64, 40), 1..4),
        s in 0.1..2.0_f64,
    ) {
        let n = a.len();
        let k = columns.len();
        let columns: Vec<Vec<f64>> = columns.iter().map(|column| column[..n].to_vec()).collect();
        let middle = (0..k * k).map(|e| if e / k == e % k { s } else { 0.05 * s }).collect();
        let operator = Operator::new(a.clone(), columns, middle).unwrap();
        let dense = operator.dense();
        let mut out = vec![DVec2::ZERO; n];
        operator.multiply_into(&b, &mut out);
        let mut x = b.clone();
        operator.factor().unwrap().solve(&mut x);
        let (b, out) = (coordinates(&b), coordinates(&out));
        for (k, x) in coordinates(&x).iter().enumerate() {
            // B alone may be worse conditioned than the whole, by 1e7 here
            prop_assert!(backward_error(&dense, x, &b[k]) <= 1e-9);
            for (out, expected) in out[k].iter().zip(dense.multiply(&b[k])) {
                prop_assert!((out - expected).abs() <= 1e-13 * (a.norm() + 1.0));
            }
        }
    }
}

#[test]
fn taking_the_mean_out_leaves_the_residual_at_rounding() {
    for n in [5, 50, 1000] {
        // ends held at rest: K 1 is not zero, so both columns matter
        let mut k = Pentadiagonal::new(n, false).unwrap();
        k.add_identity(6.0e3 + 2.0);
        (1..n).for_each(|i| k.add(i - 1, i, -4.0e3 - 1.0));
        (2..n).for_each(|i| k.add(i - 2, i, 1.0e3));
        let mut sums = vec![0.0; n];
        k.multiply_scalars_into(&vec![1.0; n], &mut sums);
        let size = 1.0 / f64::from(u32::try_from(n).unwrap());
        let whole = sums.iter().sum::<f64>() * size * size;
        let norm = k.norm();
        let columns = vec![vec![1.0; n], sums];
        let operator = Operator::new(k, columns, vec![whole, -size, -size, 0.0]).unwrap();
        for exponent in [2, 7, 12] {
            let a = operator.shifted(1.0, &vec![norm * 10.0_f64.powi(-exponent); n]);
            let wave =
                |i: usize| DVec2::from_angle(0.7 * f64::from(u32::try_from(i % 97).unwrap()));
            let b: Vec<DVec2> = (0..n).map(|i| wave(i) + DVec2::X).collect();
            let (mut x, mut product) = (b.clone(), b.clone());
            a.factor().unwrap().solve(&mut x);
            a.multiply_into(&x, &mut product);
            let rest = (0..n)
                .map(|i| (b[i] - product[i]).length())
                .fold(0.0, f64::max);
            let moved = x.iter().map(|x| x.length()).fold(0.0, f64::max);
            // the product's sum over all nodes rounds by itself
            assert!(
                rest <= 1e-14 * norm * moved,
                "{n} 1e{exponent}: {:e}",
                rest / (norm * moved)
            );
        }
    }
}

#[test]
fn shifted_operator_is_the_sum() {
    let mut band = Pentadiagonal::new(5, false).unwrap();
    band.add_outer(1.0, &[(0, 1.0), (1, 1.0)]);
    let operator = Operator::new(band, vec![vec![1.0; 5]], vec![0.5]).unwrap();
    let shifted = operator.shifted(2.0, &[1.0, 2.0, 3.0, 4.0, 5.0]).dense();
    assert_eq!(shifted.rows().next().unwrap(), [4.0, 3.0, 1.0, 1.0, 1.0]);
    assert_eq!(shifted.rows().last().unwrap(), [1.0, 1.0, 1.0, 1.0, 6.0]);
}

#[test]
fn corrections_that_do_not_fit_are_refused() {
    let band = springs(6, true, &[1.0], 1.0);
    let make = |columns, middle| Operator::new(band.clone(), columns, middle).unwrap_err();
    assert!(matches!(
        make(vec![vec![1.0; 5]], vec![1.0]),
        BandedError::Length { got: 5, .. }
    ));
    assert!(matches!(
        make(vec![vec![1.0; 6]; 2], vec![1.0]),
        BandedError::Length { got: 1, .. }
    ));
    let skew = vec![0.0, 1.0, 2.0, 0.0];
    assert!(matches!(
        make(vec![vec![1.0; 6]; 2], skew),
        BandedError::NotSymmetric { .. }
    ));
    let many = make(vec![vec![1.0; 6]; 5], vec![0.0; 25]);
    assert_eq!(many, BandedError::TooManyColumns { most: 4, got: 5 });
}
