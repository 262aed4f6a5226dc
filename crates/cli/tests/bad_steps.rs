//! Steps, times and matrices that cannot be meant, and large ones that can: a clear line, or the right answer.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::{Folder, changed, scene};

/// Every scheme by name, from the program itself.
fn schemes(folder: &Folder) -> Vec<String> {
    let answer = folder.snake(&["list", "schemes"]);
    let name = |line: &str| line.split_whitespace().next().unwrap().to_owned();
    answer.out.lines().map(name).collect()
}

#[test]
fn steps_and_times_that_are_no_numbers_are_refused_as_typed() {
    let folder = Folder::new();
    folder.write("s.toml", scene(&[]));
    for (dt, says) in [
        ("0", "above 0"),
        ("-0.01", "-0.01"),
        ("nan", "NaN"),
        ("inf", "inf"),
        ("1e300", "too large"),
    ] {
        folder.refused(&["run", "s.toml", "--dt", dt], &["--dt", says]);
    }
    for scheme in schemes(&folder) {
        // no scheme, with a limit or without, makes anything of such a step but a refusal, or ends at once
        let args = ["run", "s.toml", "--scheme", &scheme, "--dt", "1e300"];
        let answer = folder.snake(&args);
        assert!(matches!(answer.code, Some(1 | 2)), "{answer:?}");
        assert!(!answer.err.contains("panic"), "{answer:?}");
        assert!(!answer.err.to_lowercase().contains("nan"), "{answer:?}");
    }
    for steps in ["nan", "1e300", "-3", "2.5"] {
        let answer = folder.snake(&["run", "s.toml", "--steps", steps]);
        assert_eq!(answer.code, Some(2), "{answer:?}");
        assert!(
            answer.err.contains("--steps") || answer.err.contains(steps),
            "{answer:?}"
        );
        changed(
            "steps = 5",
            &format!("steps = {steps}"),
            &["steps", "line 20"],
        );
    }
    let none = folder.snake(&["run", "s.toml", "--steps", "0"]);
    assert_eq!(none.code, Some(0), "{none:?}");
    assert!(none.err.contains("finished after 0 steps"), "{none:?}");
}

#[test]
fn mass_is_needed_by_every_scheme_but_the_gradient_flow_and_damping_is_never_negative() {
    let folder = Folder::new();
    folder.write("s.toml", scene(&[("mass = 1.0", "mass = 0.0")]));
    folder.write("n.toml", scene(&[("damping = 0.1", "damping = -0.1")]));
    for scheme in schemes(&folder) {
        let light = ["run", "s.toml", "--scheme", &scheme];
        if scheme == "gradient-flow" {
            assert_eq!(folder.snake(&light).code, Some(0));
        } else {
            folder.refused(&light, &["densities.mass", "above 0", "gradient-flow"]);
        }
        let fed = ["run", "n.toml", "--scheme", &scheme];
        folder.refused(&fed, &["densities.damping", "at least 0, got -0.1"]);
    }
}

#[test]
fn a_singular_stiffness_is_moved_by_every_scheme_that_has_inertia_or_damping_to_hold_it() {
    let folder = Folder::new();
    let flabby = ("rigidity = 1.0", "rigidity = 0.0");
    let slack = ("tension = 1.0", "tension = 0.0");
    // nothing brings a loose snake back at all, nothing brings an untethered one back as a whole
    let loose = scene(&[("tether = 0.1", "tether = 0.0"), slack, flabby]);
    folder.write("loose.toml", &loose);
    folder.write("free.toml", scene(&[("tether = 0.1", "tether = 0.0")]));
    for scheme in schemes(&folder) {
        for name in ["loose.toml", "free.toml"] {
            let answer = folder.snake(&["run", name, "--scheme", &scheme, "--out", "-"]);
            assert_eq!(answer.code, Some(0), "{scheme}, {name}: {answer:?}");
            assert!(!answer.out.contains("NaN"), "{scheme}, {name}: {answer:?}");
        }
    }
    // with neither there is no equation to solve
    folder.write(
        "nothing.toml",
        loose.replace("damping = 0.1", "damping = 0.0"),
    );
    folder.refused(
        &["run", "nothing.toml", "--scheme", "gradient-flow"],
        &[
            "cannot be factored",
            "needed: mass, damping or stiffness above 0",
        ],
    );
}

/// A ring of so many nodes, one pixel apart.
fn ring(nodes: usize) -> String {
    let radius = nodes as f64 / std::f64::consts::TAU;
    scene(&[
        ("nodes = 20", &format!("nodes = {nodes}")),
        ("radius = 5.0", &format!("radius = {radius}")),
    ])
}

/// Runs a ring by an explicit scheme, an implicit one and the exact one, and looks where its nodes went.
fn runs(nodes: usize) {
    let folder = Folder::new();
    folder.write("s.toml", ring(nodes));
    for scheme in ["leapfrog", "sbdf2", "exact"] {
        let answer = folder.snake(&["run", "s.toml", "--scheme", scheme, "--out", "o.csv"]);
        assert_eq!(answer.code, Some(0), "{scheme}: {answer:?}");
        let text = std::fs::read_to_string(folder.path("o.csv")).unwrap();
        let points: Vec<f64> = text
            .lines()
            .filter_map(|line| line.split_once(',')?.0.parse().ok())
            .collect();
        assert_eq!(points.len(), nodes, "{scheme}");
        // at rest in its shape, it flies: v (1 − e^(−γt))/γ in five steps of a hundredth
        let way = (1.0 - (-0.1_f64 * 0.05).exp()) / 0.1;
        let radius = nodes as f64 / std::f64::consts::TAU;
        let rightmost = points.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let off = rightmost - (30.0 + radius + way);
        // schemes of order 2, and rounding of numbers as large as the ring
        assert!(off.abs() < 1e-5, "{scheme}: {off}");
    }
}

#[test]
fn ten_thousand_nodes_run() {
    runs(10_000);
}

#[test]
fn a_million_nodes_run() {
    runs(1_000_000);
}

#[test]
fn a_thousand_seconds_take_as_many_steps_as_they_should() {
    let folder = Folder::new();
    let run = |text: &str| {
        folder.write("s.toml", scene(&[("steps = 5", text)]));
        let answer = folder.snake(&["run", "s.toml", "--record", "-"]);
        assert_eq!(answer.code, Some(0), "{answer:?}");
        let last = answer.out.lines().rev().nth(1).unwrap().to_owned();
        (answer.err, last)
    };
    let (said, last) = run("time = 1000.0");
    assert!(
        said.contains("finished after 100000 steps, t = 1000.000000"),
        "{said}"
    );
    assert!(last.starts_with("{\"step\":100000,\"t\":1000.0,"), "{last}");
    // the report's loop adds dt until the end is passed, and goes round once more (D20)
    folder.write(
        "r.toml",
        format!(
            "rules = {{ clock = \"report\" }}\n{}",
            scene(&[("steps = 5", "time = 1000.0")])
        ),
    );
    let answer = folder.snake(&["run", "r.toml"]);
    assert!(
        answer.err.contains("finished after 100001 steps"),
        "{answer:?}"
    );
}
