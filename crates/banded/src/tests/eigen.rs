//! The eigenbasis against its definition and its slow twin, and what the dense solver refuses.

use proptest::prelude::*;

use super::{largest, springs, with_vector};
use crate::{BandedError, Dense};

proptest! {
    #[test]
    fn eigenvectors_diagonalise((a, _) in with_vector()) {
        let dense = a.dense();
        let eigen = dense.eigen().unwrap();
        let twin = dense.eigen_by_rotations().unwrap();
        for (value, twin) in eigen.values.iter().zip(&twin.values) {
            prop_assert!((value - twin).abs() <= 1e-13 * a.norm());
        }
        for (k, (value, vector)) in eigen.values.iter().zip(&eigen.vectors).enumerate() {
            for (image, v) in dense.multiply(vector).iter().zip(vector) {
                // some hundreds of rotations pass over each row, each adds half a unit
                prop_assert!((image - value * v).abs() <= 1e-13 * a.norm());
            }
            for (other, second) in eigen.vectors.iter().enumerate() {
                let dot: f64 = vector.iter().zip(second).map(|(v, w)| v * w).sum();
                let expected = if other == k { 1.0 } else { 0.0 };
                prop_assert!((dot - expected).abs() <= 1e-13);
            }
        }
    }
}

#[test]
fn eigenbasis_of_a_large_or_degenerate_matrix_is_orthogonal() {
    let ring = springs(120, true, &[1.0, 1.0, 100.0], 0.0).dense();
    let blocks = Dense::from_fn(40, |i, j| if i / 2 == j / 2 { 1.0 } else { 0.0 });
    for a in [
        ring,
        blocks,
        Dense::from_fn(7, |_, _| 0.0),
        Dense::from_fn(1, |_, _| -3.0),
    ] {
        let n = a.len();
        let eigen = a.eigen().unwrap();
        let norm = largest(&eigen.values);
        for i in 0..n {
            for j in 0..n {
                let (v, w) = (&eigen.vectors[i], &eigen.vectors[j]);
                let dot: f64 = v.iter().zip(w).map(|(v, w)| v * w).sum();
                let image: f64 = v.iter().zip(a.multiply(w)).map(|(v, w)| v * w).sum();
                let (unit, value) = if i == j {
                    (1.0, eigen.values[i])
                } else {
                    (0.0, 0.0)
                };
                // each of n reflections and some n rotations a row add half a unit
                assert!((dot - unit).abs() <= 1e-13, "{n}: {i} {j}");
                assert!((image - value).abs() <= 1e-13 * norm, "{n}: {i} {j}");
            }
        }
    }
}

#[test]
fn dense_refuses_what_has_no_answer() {
    let singular = Dense::from_fn(2, |_, _| 1.0);
    assert!(matches!(
        singular.solve(&[1.0, 1.0]),
        Err(BandedError::Singular { row: 1, .. })
    ));
    assert!(matches!(
        singular.solve(&[1.0]),
        Err(BandedError::Length { .. })
    ));
    let skew = Dense::from_fn(2, |i, j| if i < j { 1.0 } else { 0.0 });
    assert!(matches!(
        skew.eigen(),
        Err(BandedError::NotSymmetric { .. })
    ));
}
