//! The report's program, run by Octave, against the same situations as scenes under its rules.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: fixtures are small whole numbers, and a broken one should stop it"
)]

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use scene::Scene;
use scene::snake::Outcome;
use serde_json::Value;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/oracle")
}

/// The rows of a CSV file of numbers, without its heading.
fn rows(path: &Path) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(path).unwrap();
    text.lines()
        .skip(1)
        .map(|line| line.split(',').map(|word| word.parse().unwrap()).collect())
        .collect()
}

/// Positions by step, and the tolerance of each step.
type Steps = BTreeMap<u64, (Vec<[f64; 2]>, f64)>;

fn expected(run: &Path, tolerance: impl Fn(u64) -> f64, first: f64) -> Steps {
    let mut steps = Steps::new();
    for row in rows(&run.join("positions.csv")) {
        let step = row[0] as u64;
        let entry = steps
            .entry(step)
            .or_insert_with(|| (Vec::new(), tolerance(step)));
        entry.0.push([row[2] - first, row[3] - first]);
    }
    steps
}

/// Run `scene` and compare every recorded step; returns the worst difference over its tolerance.
fn compare(scene: &mut Scene, expected: &Steps) -> (Outcome, f64) {
    scene.plan.recording.every = None;
    scene.plan.recording.steps = expected.keys().copied().collect();
    let record = scene.run(&mut |_| ControlFlow::Continue(())).unwrap();
    let mut worst = 0.0_f64;
    for (step, (nodes, tolerance)) in expected {
        let frame = record.frames.iter().find(|f| f.step == *step);
        let frame = frame.unwrap_or_else(|| panic!("step {step} was not reached"));
        assert_eq!(frame.nodes().len(), nodes.len());
        for (i, (p, q)) in frame.nodes().iter().zip(nodes).enumerate() {
            let off = (p.x - q[0]).abs().max((p.y - q[1]).abs());
            assert!(
                off <= *tolerance,
                "step {step}, node {i}: off by {off:e}, may be {tolerance:e}"
            );
            worst = worst.max(off / tolerance);
        }
    }
    (record.outcome, worst)
}

fn snake_run(name: &str) {
    let run = folder().join("snake").join(name);
    let text = std::fs::read_to_string(run.join("run.json")).unwrap();
    let json: Value = serde_json::from_str(&text).unwrap();
    let number = |key: &str| json[key].as_f64().unwrap();
    let clicks: Vec<String> = rows(&run.join("points.csv"))
        .iter()
        .map(|p| format!("[{}, {}]", p[0] - 1.0, p[1] - 1.0))
        .collect();
    // numbers as floats, since the file's integers would be read as integers
    let text = format!(
        "title = \"{name}\"\nrules = \"report\"\n\
         [picture]\nfile = \"{image}\"\n[field]\nscale = {scale:?}\n\
         [snake]\nnodes = {n}\ntopology = \"open\"\nstart = {{ points = [{clicks}] }}\n\
         [material]\ntether = {w0:?}\ntension = {w1:?}\nrigidity = {w2:?}\n\
         [densities]\nmass = {mu:?}\ndamping = {gam:?}\n\
         [run]\ndt = {dt:?}\ntime = {tend:?}\nforce = true\n",
        image = json["image"].as_str().unwrap(),
        scale = number("scale"),
        n = number("n"),
        clicks = clicks.join(", "),
        w0 = number("w0"),
        w1 = number("w1"),
        w2 = number("w2"),
        mu = number("mu"),
        gam = number("gam"),
        dt = number("dt"),
        tend = number("tend"),
    );
    let mut scene = Scene::parse(name, &text, &folder()).unwrap();
    assert!((scene.snake.body().spacing - number("h")).abs() < 1e-12 * number("h"));
    // ours is the limit of K, the oracle's that of K P, which is never stricter (errata §7); where the
    // highest mode moves the mean a little they differ in the sixth digit
    let elastic = scene.plan.scheme.step_limit(&scene.snake).unwrap();
    let limit = elastic / number("dt_limit_without_image");
    assert!(
        (1.0 - 1e-5..=1.0 + 1e-9).contains(&limit),
        "limit is {limit} of the one claimed"
    );
    let tolerances: BTreeMap<u64, f64> = rows(&run.join("tolerance.csv"))
        .iter()
        .map(|row| (row[0] as u64, row[3]))
        .collect();
    let steps = expected(&run, |step| tolerances[&step], 1.0);
    let (outcome, worst) = compare(&mut scene, &steps);
    println!("{name}: worst difference {worst:.3} of the tolerance");
    let done = number("steps") as u64;
    match json["status"].as_str().unwrap() {
        "ok" => assert_eq!(outcome, Outcome::Finished { step: done }),
        "index_error" => {
            let failing = number("failing_node") as usize - 1;
            match outcome {
                Outcome::LeftField { step, node, .. } => assert_eq!((step, node), (done, failing)),
                other => panic!("expected an index error, got: {other}"),
            }
        }
        other => panic!("unknown status {other}"),
    }
}

macro_rules! snake_runs {
    ($($name:ident),* $(,)?) => {
        $(#[test]
        fn $name() {
            snake_run(stringify!($name));
        })*

        #[test]
        fn every_oracle_run_is_tested() {
            let mut tested = vec![$(stringify!($name)),*];
            tested.sort_unstable();
            let mut there: Vec<String> = std::fs::read_dir(folder().join("snake"))
                .unwrap()
                .map(|entry| entry.unwrap().file_name().into_string().unwrap())
                .collect();
            there.sort_unstable();
            assert_eq!(tested, there);
        }
    };
}

snake_runs![
    apple,
    clamp_top,
    disturb_ch43,
    dt_stable,
    dt_unstable,
    ellipse_damped,
    ellipse_heavy,
    ellipse_light,
    ellipse_noisy,
    ellipse_stiff,
    exit_bottom,
    exit_right,
    step_full,
    step_soft,
    step_stiff,
];

/// A shipped scene against the oracle's ball of the same parameters.
fn ball(scene: &str, name: &str) {
    let run = folder().join("ball").join(name);
    let json: Value =
        serde_json::from_str(&std::fs::read_to_string(run.join("run.json")).unwrap()).unwrap();
    let tolerance = json["tolerance"].as_f64().unwrap();
    let steps = expected(&run, |_| tolerance, 0.0);
    let mut scene = Scene::named(scene).unwrap();
    assert!((scene.snake.body().spacing - json["h"].as_f64().unwrap()).abs() < 1e-14);
    let limit = json["dt_limit"].as_f64().unwrap();
    // a penalty wall stiffens the limit; the oracle's figure leaves it out
    assert!(scene.step_limit().unwrap() <= limit * (1.0 + 1e-6));
    let (outcome, worst) = compare(&mut scene, &steps);
    println!("{name}: worst difference {worst:.3} of the tolerance");
    assert_eq!(outcome, Outcome::Finished { step: 7000 });
}

#[test]
fn the_very_soft_ball_flows_as_the_oracles() {
    ball("very-soft-ball", "very_soft");
}

#[test]
fn the_soft_ball_moves_as_the_oracles() {
    ball("soft-ball", "soft");
}

#[test]
fn the_rigid_ball_moves_as_the_oracles() {
    ball("rigid-ball", "rigid");
}

#[test]
fn the_hard_ball_moves_as_the_oracles() {
    ball("hard-ball", "hard");
}

#[test]
fn the_very_hard_ball_moves_as_the_oracles() {
    ball("very-hard-ball", "very_hard");
}

#[test]
fn the_ball_at_a_penalty_wall_moves_as_the_oracles() {
    ball("rigid-ball-penalty", "rigid_penalty");
}
