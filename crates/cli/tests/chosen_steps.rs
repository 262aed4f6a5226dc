//! Steps that the program chooses: what it says of them, and that they lead where small equal ones do.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::{Answer, Folder, changed, scene};

/// The line about sub-steps.
fn pace(answer: &Answer) -> String {
    let line = answer.err.lines().find(|line| line.contains("sub-steps"));
    assert!(line.is_some(), "says nothing of sub-steps: {answer:?}");
    line.unwrap().to_owned()
}

/// All numbers of a line.
fn numbers(line: &str) -> Vec<f64> {
    let words = line.split([' ', ',', '(', ')', ';']);
    words.filter_map(|word| word.parse().ok()).collect()
}

/// Nodes of a contour.
fn nodes(folder: &Folder, name: &str) -> Vec<[f64; 2]> {
    let text = std::fs::read_to_string(folder.path(name)).unwrap();
    let pair = |line: &str| {
        // of more than one curve a third column has the number
        let mut entries = line.split(',').map(str::trim);
        Some([entries.next()?.parse().ok()?, entries.next()?.parse().ok()?])
    };
    text.lines().filter_map(pair).collect()
}

/// The largest distance between nodes of the same number.
fn apart(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    assert!(!a.is_empty() && a.len() == b.len());
    let each = a
        .iter()
        .zip(b)
        .map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]));
    each.fold(0.0, f64::max)
}

/// A soft ring on a disc whose edge is steep, or not.
fn on_a_disc(gain: f64, plan: &str) -> String {
    let picture = format!(
        "[picture.drawn]\nsize = [64, 64]\nblur = 1.0\nregion = {{ circle = {{ center = [30.0, 30.0], radius = 8.0 }} }}\n\
         [field]\nsigma = 2.0\ngain = {gain}\n[snake]"
    );
    scene(&[
        ("[snake]", &picture),
        ("velocity = [1.0, 0.0]\n", ""),
        ("damping = 0.1", "damping = 1.0"),
        ("dt = 0.01\nsteps = 5\n", plan),
    ])
}

#[test]
fn the_slope_of_a_steep_picture_is_named_when_it_sets_the_step() {
    let folder = Folder::new();
    let mut limits = Vec::new();
    for (gain, says) in [
        (1e-3, "of the elastic force"),
        (300.0, "of the slope of the picture"),
    ] {
        let plan = "dt = \"auto\"\noutput = 5.0\ntime = 20.0\n";
        folder.write("s.toml", on_a_disc(gain, plan));
        let answer = folder.snake(&["run", "s.toml", "--tolerance", "1"]);
        assert_eq!(answer.code, Some(0), "{answer:?}");
        let line = pace(&answer);
        assert!(line.ends_with(says), "{line}");
        assert!(line.contains("stability"), "{line}");
        let all = numbers(&line);
        let (longest, limit) = (all[2], *all.last().unwrap());
        // what it holds to, rounded as it is said
        assert!(longest < 1.001 * limit, "{line}");
        limits.push(limit);
    }
    assert!(limits[1] < 0.5 * limits[0], "{limits:?}");
}

#[test]
fn without_an_output_step_every_sub_step_is_written() {
    let folder = Folder::new();
    let plan =
        "dt = \"auto\"\noutput = \"every\"\ntolerance = 1e-4\ntime = 3.0\n[record]\nevery = 1\n";
    folder.write("s.toml", on_a_disc(1.0, plan));
    folder.write("fine.toml", on_a_disc(1.0, "dt = 0.0005\ntime = 3.0\n"));
    for scheme in [
        "leapfrog",
        "sbdf2",
        "gauss-4",
        "gradient-flow",
        "dormand-prince",
    ] {
        let args = ["run", "s.toml", "--scheme", scheme, "--record", "r.csv"];
        let answer = folder.snake(&[&args[..], &["--out", "o.csv"]].concat());
        assert_eq!(answer.code, Some(0), "{answer:?}");
        let record = std::fs::read_to_string(folder.path("r.csv")).unwrap();
        let mut times: Vec<f64> = Vec::new();
        for line in record
            .lines()
            .skip(2)
            .filter(|line| line.split(',').nth(2) == Some("0"))
        {
            times.push(line.split(',').nth(1).unwrap().parse().unwrap());
        }
        let made = numbers(&pace(&answer))[0];
        assert!(
            (made - (times.len() - 1) as f64).abs() < 0.5,
            "{scheme}: {answer:?}"
        );
        assert!(times.windows(2).all(|pair| pair[1] > pair[0]), "{scheme}");
        let lengths: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let short = lengths.iter().copied().fold(f64::INFINITY, f64::min);
        // what is smooth enough for order 4 has one length only
        let varied = lengths.iter().any(|&h| h > 1.9 * short);
        assert!(varied || scheme == "gauss-4", "{scheme}: {lengths:?}");
        assert_eq!(times.last(), Some(&3.0), "{scheme}");
        let fine = ["run", "fine.toml", "--scheme", scheme, "--out", "f.csv"];
        assert_eq!(folder.snake(&fine).code, Some(0));
        // local errors of 1e-4 over some hundred sub-steps, damped as they add up
        let off = apart(&nodes(&folder, "o.csv"), &nodes(&folder, "f.csv"));
        assert!(off < 5e-3, "{scheme}: {off}");
    }
}

/// Two balls that fly at each other, and a third that follows.
fn balls(plan: &str) -> String {
    let also = "[[also]]\nstart = { circle = { center = [45.0, 30.0], radius = 5.0 } }\nvelocity = [-1.0, 0.0]\n\
                [[also]]\nstart = { circle = { center = [62.0, 31.0], radius = 5.0 } }\nvelocity = [-2.0, 0.0]\n\
                [contact]\nstiffness = 800.0\nstop = 1.0\n[material]";
    scene(&[
        ("[material]", also),
        ("damping = 0.1", "damping = 0.02"),
        ("dt = 0.01\nsteps = 5\n", plan),
    ])
}

#[test]
fn snakes_that_meet_are_moved_by_chosen_sub_steps_too() {
    let folder = Folder::new();
    folder.write(
        "s.toml",
        balls("dt = \"auto\"\noutput = 0.5\ntime = 10.0\n"),
    );
    folder.write("fine.toml", balls("dt = 0.001\ntime = 10.0\n"));
    let answer = folder.snake(&[
        "run",
        "s.toml",
        "--record",
        "r.jsonl",
        "--energies",
        "--out",
        "o.csv",
    ]);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    let line = pace(&answer);
    // a quarter of the 0.025 the contacts allow; the elastic force would allow ten times as much
    let says = "the contacts between snakes, with a margin to resolve them";
    assert!(line.contains("stability") && line.ends_with(says), "{line}");
    let fine = folder.snake(&["run", "fine.toml", "--out", "f.csv"]);
    assert_eq!(fine.code, Some(0), "{fine:?}");
    assert!(!fine.err.contains("sub-steps"), "{fine:?}");
    let off = apart(&nodes(&folder, "o.csv"), &nodes(&folder, "f.csv"));
    // a contact errs by the square of its part of the step, 6e-3; equal steps of that length err by as much
    assert!(off < 0.05, "{off}");
    // times are shared, so that sub-steps of one's own cannot be written
    folder.write(
        "e.toml",
        balls("dt = \"auto\"\noutput = \"every\"\ntime = 10.0\n"),
    );
    folder.refused(&["run", "e.toml"], &["run.output", "share", "needed: "]);
}

#[test]
fn any_scene_runs_with_steps_chosen_but_one_of_the_report_s_scheme() {
    let folder = Folder::new();
    let fixed = folder.snake(&["run", "soft-ball", "--steps", "2000", "--out", "f.csv"]);
    assert_eq!(fixed.code, Some(0), "{fixed:?}");
    let args = ["run", "soft-ball", "--dt", "auto", "--steps", "2000"];
    folder.refused(&args, &["run.scheme", "the scheme report", "leapfrog"]);
    folder.write("s.toml", scene(&[("steps = 5", "steps = 500")]));
    let chosen = folder.snake(&["run", "s.toml", "--dt", "auto", "--out", "o.csv"]);
    assert_eq!(chosen.code, Some(0), "{chosen:?}");
    assert!(chosen.err.contains("t = 5.000000"), "{chosen:?}");
    let equal = folder.snake(&["run", "s.toml", "--out", "f.csv"]);
    assert_eq!(equal.code, Some(0), "{equal:?}");
    assert!(apart(&nodes(&folder, "o.csv"), &nodes(&folder, "f.csv")) < 1e-2);
    folder.write("b.toml", balls("dt = 0.01\nsteps = 20\n"));
    let shared = folder.snake(&["run", "b.toml", "--dt", "auto"]);
    assert_eq!(shared.code, Some(0), "{shared:?}");
    assert!(pace(&shared).contains("held by"), "{shared:?}");
}

#[test]
fn plans_of_chosen_steps_that_cannot_be_meant_are_refused_by_their_key() {
    let plan = |plan: &str, says: &[&str]| changed("dt = 0.01\nsteps = 5\n", plan, says);
    plan(
        "dt = \"auto\"\ntime = 1.0\nscheme = \"report\"\n",
        &["run.scheme", "differences over it", "leapfrog"],
    );
    plan(
        "dt = \"auto\"\noutput = \"every\"\nsteps = 5\n",
        &["run.time", "is missing"],
    );
    plan(
        "dt = \"auto\"\noutput = \"each\"\ntime = 5.0\n",
        &["output", "\"every\""],
    );
    plan(
        "dt = \"auto\"\noutput = 0.0\ntime = 5.0\n",
        &["run.output", "above 0"],
    );
    plan(
        "dt = \"auto\"\noutput = \"every\"\ntime = nan\n",
        &["run.time", "above 0, got NaN"],
    );
    plan(
        "dt = \"auto\"\noutput = \"every\"\ntime = 0\n",
        &["run.time", "above 0, got 0"],
    );
    plan(
        "dt = 0.01\noutput = \"every\"\nsteps = 5\n",
        &["run.output", "auto"],
    );
    plan(
        "dt = \"auto\"\noutput = -1.0\ntime = 5.0\n",
        &["run.output", "above 0"],
    );
    let folder = Folder::new();
    folder.write("s.toml", scene(&[]));
    folder.refused(
        &["run", "s.toml", "--dt", "quick"],
        &["--dt", "auto, is needed"],
    );
}
