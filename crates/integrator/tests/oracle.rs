//! The report's program, run in Octave, against ours.

#![allow(clippy::unwrap_used, reason = "a test may stop")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "small counts"
)]

use banded::{Operator, Pentadiagonal};
use integrator::problems::{Springs, damped_spring};
use integrator::{Scheme, Start};

/// A file of numbers, without its first line; words become NaN.
fn rows(text: &str) -> Vec<Vec<f64>> {
    let number = |word: &str| word.trim().parse().unwrap_or(f64::NAN);
    text.lines()
        .skip(1)
        .map(|line| line.split(',').map(number).collect())
        .collect()
}

fn spring(text: &str, damping: f64) {
    let mut problem = damped_spring(1.0, damping, 1.0).unwrap();
    let mut state = problem.state.clone();
    let mut stepper = Scheme::Report
        .start(&mut problem.system, &state, 0.01, Start::FirstOrder)
        .unwrap();
    for row in rows(text) {
        let (t, exact, reported) = (row[0], row[1], row[2]);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a small count"
        )]
        let steps = (t / 0.01).round() as u64;
        while state.step < steps {
            stepper.step(&mut problem.system, &mut state).unwrap();
        }
        // rounding: 2 α x of 2e4 at each of 4000 steps
        assert!(
            (state.x[0].x - reported).abs() < 1e-10,
            "t = {t}: {} {reported}",
            state.x[0].x
        );
        // closed formulas on both sides
        let ours = (problem.exact)(t).x[0].x;
        assert!((ours - exact).abs() < 1e-13, "t = {t}: {ours} {exact}");
    }
}

#[test]
fn an_underdamped_spring_moves_as_in_the_reports_program() {
    spring(include_str!("oracle/m1_c0.3_k1.csv"), 0.3);
}

#[test]
fn a_critically_damped_spring_has_c_2_and_moves_as_in_the_reports_program() {
    spring(include_str!("oracle/m1_c2_k1.csv"), 2.0);
}

#[test]
fn an_overdamped_spring_moves_as_in_the_reports_program() {
    spring(include_str!("oracle/m1_c4_k1.csv"), 4.0);
}

/// K of the kinds in `thresholds.csv` from its differences, ends cut, free or closed (D3).
fn stiffness(n: usize, kind: &str, [w0, w1, w2]: [f64; 3], h: f64) -> Operator {
    let closed = kind == "closed";
    let mut k = Pentadiagonal::new(n, closed).unwrap();
    k.add_identity(w0);
    let (first, second) = ([-1.0, 1.0], [1.0, -2.0, 1.0]);
    for (stencil, weight) in [(&first[..], w1 / (h * h)), (&second[..], w2 / h.powi(4))] {
        let reach = stencil.len();
        // a stencil starting at `i − (reach − 1)`: beyond the ends its nodes are held at e = 0
        for shift in 0..n + reach - 1 {
            let at = |j: usize| (shift + j + n + 1 - reach) as i64 - n as i64;
            let row: Vec<(usize, f64)> = stencil
                .iter()
                .enumerate()
                .filter_map(|(j, &value)| {
                    let node = at(j);
                    if closed {
                        (shift < n).then(|| ((node.rem_euclid(n as i64)) as usize, value))
                    } else {
                        (0..n as i64)
                            .contains(&node)
                            .then_some((node as usize, value))
                    }
                })
                .collect();
            if kind != "free" || row.len() == reach {
                k.add_outer(weight, &row);
            }
        }
    }
    Operator::from(k)
}

#[test]
fn the_largest_stable_step_is_the_formulas() {
    let text = include_str!("oracle/thresholds.csv");
    for (line, row) in text.lines().skip(1).zip(rows(text)) {
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a small count"
        )]
        let n = row[0] as usize;
        let kind = line.split(',').nth(1).unwrap();
        let k = stiffness(n, kind, [row[2], row[3], row[4]], row[5]);
        let system = Springs::new(k, row[6], row[7]);
        // bisection to 1e-13 of a matrix assembled in another order
        let limit = Scheme::Report.step_limit(&system).unwrap();
        assert!((limit / row[11] - 1.0).abs() < 1e-10, "{line}: {limit}");
        let limit = Scheme::Leapfrog.step_limit(&system).unwrap();
        assert!((limit / row[15] - 1.0).abs() < 1e-10, "{line}: {limit}");
        // and Octave's own bisection on the spectral radius printed nine digits, good to six
        assert!((Scheme::Report.step_limit(&system).unwrap() / row[13] - 1.0).abs() < 1e-6);
    }
}
