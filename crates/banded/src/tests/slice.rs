//! Single eigenvalues against the dense eigenbasis and against closed formulas.

use std::f64::consts::PI;

use crate::{Band, Dense, Operator, Slices};

/// A free chain of springs or of bending elements with the given weights.
fn chain(n: usize, order: usize, cyclic: bool, weight: impl Fn(usize) -> f64) -> Band {
    let mut band = Band::new(n, order, cyclic).unwrap();
    let stencil: &[f64] = if order == 1 {
        &[-1.0, 1.0]
    } else {
        &[1.0, -2.0, 1.0]
    };
    let ends = if cyclic { n } else { n - order };
    for i in 0..ends {
        let row: Vec<(usize, f64)> = (stencil.iter().enumerate())
            .map(|(k, s)| ((i + k) % n, *s))
            .collect();
        band.add_outer(weight(i), &row);
    }
    band
}

fn uneven(i: usize) -> f64 {
    1.0 + 0.8 * (1.7 * i as f64).sin()
}

#[test]
fn every_eigenvalue_is_that_of_the_dense_matrix() {
    for (order, cyclic, low, holds) in [
        (1, false, false, false),
        (2, false, true, false),
        (1, true, true, false),
        (2, true, false, true),
        (2, true, true, true),
        (2, false, true, true),
    ] {
        let n = 23;
        let mut band = chain(n, order, cyclic, uneven);
        band.add_diagonal(&(0..n).map(|i| 0.1 * uneven(i + 3)).collect::<Vec<_>>());
        let held: Vec<bool> = (0..n).map(|i| holds && (i == 0 || i == 9)).collect();
        band.hold(&held);
        let column = |k: usize| -> Vec<f64> {
            let at = |i: usize| if held[i] { 0.0 } else { uneven(7 * i + k) };
            (0..n).map(at).collect()
        };
        let operator = if low {
            Operator::new(band, vec![column(0), column(1)], vec![0.3, -0.2, -0.2, 0.0]).unwrap()
        } else {
            Operator::from(band)
        };
        let weights: Vec<f64> = (0..n).map(|i| 0.5 + uneven(i + 11)).collect();
        let dense = operator.dense();
        let root = |i: usize| weights[i].sqrt();
        let scaled = Dense::from_fn(n, |i, j| dense[(i, j)] / (root(i) * root(j)));
        let truth = scaled.eigen().unwrap().values;
        let slices = Slices::new(&operator, &weights).unwrap();
        let most = truth[n - 1].abs();
        for (k, &value) in truth.iter().enumerate() {
            let found = slices.eigenvalue(k).unwrap();
            let expected = value.max(0.0);
            assert!(
                (found - expected).abs() < 1e-12 * most,
                "{order} {cyclic} {low}: {k}"
            );
        }
        assert_eq!(slices.below(2.0 * most), n);
        assert_eq!(slices.eigenvalue(n), None);
        // an eigenvector is one
        let k = n - 3;
        let u = slices.eigenvector(truth[k], &[]);
        let mut product = vec![0.0; n];
        operator.multiply_scalars_into(&u, &mut product);
        for i in 0..n {
            assert!((product[i] - truth[k] * weights[i] * u[i]).abs() < 1e-6 * most);
        }
    }
}

/// λ = 4 ω sin²(k π / 2n) of a free chain of n nodes, by \[strang99\]; a pinned one has n + 1 for n.
#[test]
fn long_chains_have_the_waves_of_the_closed_formula() {
    for n in [401, 2000, 20_000] {
        let free = Operator::from(chain(n, 1, false, |_| 3.0));
        let ones = vec![1.0; n];
        let slices = Slices::new(&free, &ones).unwrap();
        assert_eq!(slices.zeros(), 1);
        for k in 1..4 {
            let sine = (k as f64 * PI / (2.0 * n as f64)).sin();
            let expected = 12.0 * sine * sine;
            let found = slices.eigenvalue(k).unwrap();
            assert!(
                (found / expected - 1.0).abs() < 1e-5,
                "{n}, {k}: {found}, {expected}"
            );
        }
        let mut pinned = chain(n, 1, false, |_| 3.0);
        let held: Vec<bool> = (0..n).map(|i| i == 0 || i == n - 1).collect();
        pinned.hold(&held);
        let pinned = Operator::from(pinned);
        let slices = Slices::new(&pinned, &ones).unwrap();
        assert_eq!(slices.zeros(), 2, "the nodes that are held");
        let sine = (PI / (2.0 * (n as f64 - 1.0))).sin();
        let found = slices.eigenvalue(2).unwrap();
        assert!((found / (12.0 * sine * sine) - 1.0).abs() < 1e-5, "{n}");
    }
}
