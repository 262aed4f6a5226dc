//! What the report's own program computed: matrices, their spectra, and the curves it starts from.
//!
//! The numbers are in `oracle/`, with their origin in its README.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::float_cmp,
    reason = "a test may stop, and one that says equal means equal"
)]

use banded::{Band, Dense};
use elastic::{
    End, Material, Parameter, SpacingRule, Topology, center, spacing, spline, stiffness,
    stiffness_as_printed,
};
use glam::DVec2;
use std::path::PathBuf;

/// The lines of a file in `oracle/`, split at commas.
fn table(name: &str) -> Vec<Vec<String>> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("tests/oracle")
        .join(name);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    text.lines()
        .map(|line| line.split(',').map(str::to_owned).collect())
        .collect()
}

/// The numbers of a file without a header.
fn numbers(name: &str) -> Vec<Vec<f64>> {
    parse(&table(name))
}

/// The numbers of a file below its header.
fn below_header(name: &str) -> Vec<Vec<f64>> {
    parse(&table(name)[1..])
}

fn parse(lines: &[Vec<String>]) -> Vec<Vec<f64>> {
    lines
        .iter()
        .map(|line| line.iter().map(|cell| cell.parse().unwrap()).collect())
        .collect()
}

/// Set name, number of nodes, ω₀, ω₁, ω₂, h.
fn sets() -> Vec<(String, usize, [f64; 3], f64)> {
    table("kmatrix/sets.csv")[1..]
        .iter()
        .map(|line| {
            let value = |i: usize| line[i].parse().unwrap();
            (
                line[0].clone(),
                line[1].parse().unwrap(),
                [value(2), value(3), value(4)],
                value(5),
            )
        })
        .collect()
}

fn matrices() -> Vec<(String, Band)> {
    let mut all = Vec::new();
    for (set, n, [w0, w1, w2], h) in sets() {
        for (kind, topology) in [
            ("report", Topology::open(End::Anchored)),
            ("closed", Topology::Closed),
            ("free", Topology::open(End::Free)),
        ] {
            let k = stiffness(topology, &Material::uniform(w0, w1, w2), h, n).unwrap();
            all.push((format!("kmatrix/{set}_{kind}"), k));
        }
    }
    all
}

fn check_entries(name: &str, k: &Band) {
    let want = numbers(name);
    let largest = k.norm();
    assert_eq!(want.len(), k.len(), "{name}");
    for (i, row) in want.iter().enumerate() {
        for (j, &entry) in row.iter().enumerate() {
            // the program adds up the same terms in another order
            assert!(
                (k.entry(i, j) - entry).abs() <= 1e-15 * largest,
                "{name} {i} {j}"
            );
        }
    }
}

#[test]
fn anchored_ends_give_the_matrix_of_the_reports_program_and_the_others_theirs() {
    for (name, k) in matrices() {
        check_entries(&format!("{name}.csv"), &k);
    }
}

#[test]
fn the_matrix_of_the_text_is_printed_with_its_errors() {
    for (set, n, [w0, w1, w2], _) in sets() {
        let k = stiffness_as_printed(w0, w1, w2, n).unwrap();
        check_entries(&format!("kmatrix/{set}_text_as_printed.csv"), &k.into());
    }
}

/// PKP, where P takes off the mean.
fn without_mean(k: &Band) -> Dense {
    let n = k.len();
    let ones = vec![1.0; n];
    let mut row_sums = vec![0.0; n];
    k.multiply_scalars_into(&ones, &mut row_sums);
    let mean = |values: &[f64]| values.iter().sum::<f64>() / n as f64;
    let all = mean(&row_sums);
    Dense::from_fn(n, |i, j| {
        // symmetric to the last bit
        let sides = row_sums[i.min(j)] + row_sums[i.max(j)];
        k.entry(i, j) - sides / n as f64 + all / n as f64
    })
}

#[test]
fn eigenvalues_agree_with_and_without_the_mean() {
    for (name, k) in matrices() {
        let want = below_header(&format!("{name}_eig.csv"));
        // both programs promise a few units in the last place of the largest eigenvalue
        let tolerance = 1e-13 * k.norm();
        for (column, matrix) in [k.dense(), without_mean(&k)].iter().enumerate() {
            let mut expected: Vec<f64> = want.iter().map(|row| row[column]).collect();
            expected.sort_by(f64::total_cmp);
            let values = matrix.eigen().unwrap().values;
            assert_eq!(values.len(), expected.len(), "{name}");
            for (value, wanted) in values.iter().zip(&expected) {
                assert!(
                    (value - wanted).abs() <= tolerance,
                    "{name}: {value} for {wanted}"
                );
            }
        }
    }
}

/// Splines and spacings agree to 1e-12 of the coordinates: both programs solve a well-conditioned
/// system of at most some twenty unknowns.
const SPLINE_AGREEMENT: f64 = 1e-12;

fn check_nodes(name: &str, nodes: &[DVec2], want: &[DVec2]) {
    assert_eq!(nodes.len(), want.len(), "{name}");
    let size = want
        .iter()
        .map(|p| p.abs().max_element())
        .fold(0.0, f64::max);
    for (i, (node, wanted)) in nodes.iter().zip(want).enumerate() {
        let off = (*node - *wanted).abs().max_element();
        assert!(
            off <= SPLINE_AGREEMENT * size,
            "{name} node {i}: {node} for {wanted}"
        );
    }
}

#[test]
fn splines_through_clicks_agree_with_the_reports_program() {
    let points = below_header("spline/control.csv");
    let sampled = below_header("spline/sampled.csv");
    let case_of = |rows: &[Vec<f64>], case: f64| -> Vec<Vec<f64>> {
        rows.iter().filter(|row| row[0] == case).cloned().collect()
    };
    let last = points.last().unwrap()[0];
    assert_eq!(last, 5.0, "five cases: 2, 3, 4, 5 and 9 points");
    let mut case = 1.0;
    while case <= last {
        let clicks: Vec<_> = case_of(&points, case)
            .iter()
            .map(|row| DVec2::new(row[2], row[3]))
            .collect();
        let rows = case_of(&sampled, case);
        let want: Vec<_> = rows.iter().map(|row| DVec2::new(row[2], row[3])).collect();
        let nodes = spline(&clicks, want.len(), Parameter::PointIndex, false).unwrap();
        let name = format!("spline case {case}");
        check_nodes(&name, &nodes, &want);
        let h = spacing(&nodes, false, SpacingRule::OpenMean);
        assert!(
            (h - rows[0][4]).abs() <= SPLINE_AGREEMENT * h,
            "{name}: h {h}"
        );
        case += 1.0;
    }
}

#[test]
fn every_run_starts_from_the_same_nodes_spacing_and_rest_shape() {
    let runs = table("start/runs.csv");
    assert_eq!(runs.len(), 11, "a header and ten runs");
    for run in &runs[1..] {
        let (name, n, h): (_, usize, f64) =
            (&run[0], run[1].parse().unwrap(), run[2].parse().unwrap());
        let clicks: Vec<_> = below_header(&format!("start/{name}_points.csv"))
            .iter()
            .map(|row| DVec2::new(row[0], row[1]))
            .collect();
        let start = below_header(&format!("start/{name}_start.csv"));
        let column = |x: usize| -> Vec<_> {
            start
                .iter()
                .map(|row| DVec2::new(row[x], row[x + 1]))
                .collect()
        };
        let nodes = spline(&clicks, n, Parameter::PointIndex, false).unwrap();
        check_nodes(name, &nodes, &column(1));
        let middle = center(&nodes, None);
        let rest: Vec<_> = nodes.iter().map(|&v| v - middle).collect();
        check_nodes(name, &rest, &column(3));
        let mine = spacing(&nodes, false, SpacingRule::OpenMean);
        assert!(
            (mine - h).abs() <= SPLINE_AGREEMENT * h,
            "{name}: h {mine} for {h}"
        );
    }
}
