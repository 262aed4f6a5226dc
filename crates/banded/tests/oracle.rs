//! What an independent program found for the same matrices.
#![allow(clippy::unwrap_used, reason = "a test may stop the process")]

use std::fs;
use std::path::Path;

use banded::{Dense, Operator, Pentadiagonal, largest_eigenvalue, smallest_eigenvalue};

const NAMES: [&str; 6] = [
    "a_closed", "a_free", "a_report", "b_closed", "b_free", "b_report",
];

fn text(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/oracle")
        .join(name);
    fs::read_to_string(path).unwrap()
}

fn numbers(line: &str) -> Vec<f64> {
    line.split(',').map(|word| word.parse().unwrap()).collect()
}

fn matrix(name: &str) -> Pentadiagonal {
    let rows: Vec<Vec<f64>> = text(&format!("{name}.csv")).lines().map(numbers).collect();
    let n = rows.len();
    let mut a = Pentadiagonal::new(n, rows[0][n - 1].abs() > 0.0).unwrap();
    for i in 0..n {
        for j in i..n {
            if rows[i][j].abs() > 0.0 {
                a.add(i, j, rows[i][j]);
            }
        }
    }
    let whole = Dense::from_fn(n, |i, j| rows[i][j]);
    assert_eq!(a.dense(), whole, "{name} is a symmetric band");
    a
}

/// Eigenvalues of the matrix, and of it without the mean; both ascending.
fn eigenvalues(name: &str) -> [Vec<f64>; 2] {
    let rows: Vec<Vec<f64>> = text(&format!("{name}_eig.csv"))
        .lines()
        .skip(1)
        .map(numbers)
        .collect();
    [0, 1].map(|k| {
        let mut column: Vec<f64> = rows.iter().map(|row| row[k]).collect();
        column.sort_by(f64::total_cmp);
        column
    })
}

/// Both programs are right to a few units in the last place of the largest eigenvalue.
fn check(name: &str, found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{name}");
    let largest = expected.iter().fold(0.0_f64, |most, e| most.max(e.abs()));
    for (found, expected) in found.iter().zip(expected) {
        let difference = (found - expected).abs();
        assert!(
            difference <= 4e-15 * largest,
            "{name}: {found} is not {expected}"
        );
    }
}

#[test]
fn dense_eigenvalues_are_the_oracles() {
    for name in NAMES {
        let found = matrix(name).dense().eigen().unwrap();
        check(name, &found.values, &eigenvalues(name)[0]);
    }
}

#[test]
fn taking_the_mean_out_by_two_columns_gives_the_oracles_eigenvalues() {
    for name in NAMES {
        let band = matrix(name);
        let n = band.len();
        let mut sums = vec![0.0; n];
        band.multiply_scalars_into(&vec![1.0; n], &mut sums);
        // P K P = K − (1 (K1)ᵀ + K1 1ᵀ)/n + 1ᵀK1/n² 1 1ᵀ
        let whole: f64 = sums.iter().sum();
        let size = 1.0 / f64::from(u32::try_from(n).unwrap());
        let middle = vec![whole * size * size, -size, -size, 0.0];
        let operator = Operator::new(band, vec![vec![1.0; n], sums], middle).unwrap();
        let found = operator.dense().eigen().unwrap();
        check(name, &found.values, &eigenvalues(name)[1]);
    }
}

#[test]
fn extreme_eigenvalues_are_the_oracles() {
    for name in NAMES {
        let a = matrix(name);
        let ones = vec![1.0; a.len()];
        let expected = &eigenvalues(name)[0];
        let found = [
            smallest_eigenvalue(&a.clone().into(), &ones),
            largest_eigenvalue(&a.clone().into(), &ones),
        ];
        check(name, &found, &[expected[0], expected[a.len() - 1]]);
    }
}

#[test]
fn largest_eigenvalue_decides_the_oracles_step_limits() {
    let mut compared = 0;
    for line in text("thresholds.csv").lines().skip(1) {
        let words: Vec<&str> = line.split(',').collect();
        if words[1] == "free" {
            continue; // its ends are assembled elsewhere
        }
        let n: usize = words[0].parse().unwrap();
        let value = |k: usize| words[k].parse::<f64>().unwrap();
        let h = value(5);
        let (tether, tension, rigidity) = (value(2), value(3) / (h * h), value(4) / h.powi(4));
        let cyclic = words[1] == "closed";
        let mut a = Pentadiagonal::new(n, cyclic).unwrap();
        a.add_identity(tether + 2.0 * tension + 6.0 * rigidity);
        for i in 0..n {
            if cyclic || i + 1 < n {
                a.add(i, (i + 1) % n, -tension - 4.0 * rigidity);
            }
            if cyclic || i + 2 < n {
                a.add(i, (i + 2) % n, rigidity);
            }
        }
        let found = largest_eigenvalue(&a.clone().into(), &vec![1.0; n]);
        let expected = value(9);
        // the oracle's own two columns (with and without the mean) differ by 4e-16 of it
        assert!(
            (found - expected).abs() <= 1e-12 * expected,
            "{line}: {found}"
        );
        compared += 1;
    }
    assert_eq!(compared, 8);
}
