//! Numbers that a user gives have an effect, or it is told that they have none.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a scene that cannot be read should stop it"
)]

use std::ops::ControlFlow::Continue;
use std::path::Path;

use scene::snake::Certificate;
use scene::{Record, Scene, SceneError};

fn scene(head: &str, tail: &str) -> Result<Scene, SceneError> {
    let text = format!(
        "version = 1\ntitle = \"told\"\n[snake]\nnodes = 12\ntopology = \"closed\"\n{head}\n\
         start = {{ circle = {{ center = [8.0, 8.0], radius = 5.0 }} }}\n\
         rest = {{ circle = {{ center = [8.0, 8.0], radius = 4.0 }} }}\n\
         [material]\ntether = 1.0\ntension = 4.0\nrigidity = 1.0\n\
         [densities]\nmass = 1.0\ndamping = 0.1\n{tail}"
    );
    Scene::parse("told", &text, Path::new("."))
}

fn ran(head: &str, tail: &str) -> Record {
    scene(head, tail)
        .unwrap()
        .run(&mut |_| Continue(()))
        .unwrap()
}

#[test]
fn the_tolerance_of_chosen_steps_reaches_dormand_and_prince() {
    let run = |tolerance: &str| {
        let tail = format!(
            "[run]\nscheme = \"dormand-prince\"\ndt = \"auto\"\noutput = \"every\"\ntime = 5.0\ntolerance = {tolerance}\n"
        );
        ran("", &tail)
    };
    let steps = ["1e-2", "1e-5", "1e-8"].map(|tolerance| {
        let record = run(tolerance);
        (record.outcome.step(), record.last().unwrap().nodes()[0])
    });
    assert!(
        steps[0].0 < steps[1].0 && steps[1].0 < steps[2].0,
        "{steps:?}"
    );
    // errors against the finest: within some tolerances, for they add up
    assert!(steps[0].1.distance(steps[2].1) < 0.2);
    assert!(steps[1].1.distance(steps[2].1) < 2e-4);
    // with one of its own besides, one of the two would have no effect
    let tail = "[run]\nscheme = \"dormand-prince(1e-3)\"\ndt = \"auto\"\ntime = 5.0\n";
    let error = scene("", tail).and_then(|scene| scene.check()).unwrap_err();
    assert!(error.to_string().contains("run.scheme"), "{error}");
}

#[test]
fn a_velocity_that_gradient_flow_leaves_out_is_told_and_is_no_energy() {
    let tail = "[run]\nscheme = \"SCHEME\"\ndt = 0.01\nsteps = 200\n[record]\nenergies = true\nevery = 1\n";
    for (scheme, told) in [("gradient-flow", true), ("leapfrog", false)] {
        let record = ran("velocity = [3.0, 0.5]", &tail.replace("SCHEME", scheme));
        let said = record
            .remarks
            .iter()
            .any(|remark| remark.contains("velocity"));
        assert_eq!(said, told, "{scheme}: {:?}", record.remarks);
        let totals: Vec<f64> = (record.frames.iter())
            .map(|frame| frame.energies.as_ref().unwrap().total())
            .collect();
        let off = totals
            .iter()
            .fold(0.0_f64, |off, t| off.max((t / totals[0] - 1.0).abs()));
        assert!(off < 0.05, "{scheme}: {off}");
        let kinetic = record.frames[0].energies.as_ref().unwrap().kinetic;
        assert_eq!(kinetic > 0.0, !told);
    }
}

#[test]
fn chosen_steps_without_number_are_refused_with_the_number() {
    let tail = "[run]\nscheme = \"leapfrog\"\ndt = \"auto\"\noutput = 1e9\nsteps = 5\n";
    let error = scene("", tail).and_then(|scene| scene.check()).unwrap_err();
    assert!(error.to_string().contains("run.output"), "{error}");
    assert!(error.to_string().contains("sub-steps or more"), "{error}");
}

#[test]
fn one_largest_step_whoever_is_asked() {
    let tail = "[[force]]\nkind = \"area\"\npressure = 40.0\n[run]\ndt = 0.01\nsteps = 5\n";
    let scene = scene("", tail).unwrap();
    let limit = scene.step_limit().unwrap();
    let certificate = Certificate::of(&scene.of_the_run(), None);
    let told = certificate
        .steps
        .iter()
        .find(|(scheme, _)| *scheme == scene.plan.scheme);
    assert!((told.unwrap().1.unwrap() / limit - 1.0).abs() < 1e-12);
    assert!(
        certificate
            .to_string()
            .contains("wherever the curve may go")
    );
    let mut beyond = scene.clone();
    beyond.plan.dt = 10.0;
    let said = beyond.check().unwrap_err().to_string();
    let number = said.split_whitespace().filter_map(|word| {
        let digits = word.trim_end_matches([';', ',', '.']);
        digits.parse::<f64>().ok()
    });
    let near = |n: f64| (n / limit - 1.0).abs() < 1e-3;
    assert!(number.into_iter().any(near), "{said}: {limit}");
}
