//! Whole runs of scenes: what must be the same, and what must be kept.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use std::ops::ControlFlow;
use std::path::Path;

use scene::integrator::{Scheme, Start, State};
use scene::{Record, SCENES, Scene};

fn run(scene: &mut Scene) -> Record {
    scene.run(&mut |_| ControlFlow::Continue(())).unwrap()
}

/// A shipped scene with some of its text replaced.
fn changed(name: &str, changes: &[(&str, &str)]) -> Scene {
    let (_, text) = SCENES.iter().find(|(known, _)| *known == name).unwrap();
    let text = changes.iter().fold((*text).to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{name} has no {from}");
        text.replace(from, to)
    });
    Scene::parse(name, &text, Path::new(".")).unwrap()
}

#[test]
fn every_shipped_scene_runs_ten_steps_and_gives_the_same_bytes_twice() {
    for (name, _) in SCENES {
        let ten = || {
            let mut scene = Scene::named(name).unwrap();
            scene.plan.until.steps = 10;
            scene.plan.recording.every = Some(5);
            scene.plan.recording.velocities = true;
            let record = run(&mut scene);
            assert_eq!(record.outcome.step(), 10, "{name}: {}", record.outcome);
            (
                record.written().to_json_lines().unwrap(),
                record.written().to_csv(),
            )
        };
        assert_eq!(ten(), ten(), "{name}");
    }
}

/// Run 60 steps whole, and cut after 25; returns the largest difference of the ends.
fn cut(mut scene: Scene) -> f64 {
    scene.plan.until.steps = 60;
    scene.plan.until.rest = None;
    scene.plan.recording = scene::Recording {
        steps: vec![25],
        velocities: true,
        ..scene::Recording::default()
    };
    let whole = run(&mut scene);
    let middle = whole.frames.iter().find(|frame| frame.step == 25).unwrap();
    scene.start = State {
        t: middle.t,
        step: middle.step,
        x: middle.nodes().to_vec(),
        v: middle.velocities().unwrap().to_vec(),
    };
    scene.plan.until.steps = 35;
    let rest = run(&mut scene);
    let (one, two) = (whole.last().unwrap(), rest.last().unwrap());
    assert_eq!((one.step, two.step), (60, 60));
    assert!((one.t - two.t).abs() < 1e-12 * one.t);
    let middle = one.nodes().len() / 2;
    let moved = one.nodes()[middle].distance(whole.frames[0].nodes()[middle]);
    assert!(moved > 1e-3, "nothing moved: {moved}");
    one.nodes()
        .iter()
        .zip(two.nodes())
        .map(|(p, q)| (*p - *q).abs().max_element())
        .fold(0.0, f64::max)
}

#[test]
fn a_leapfrog_run_cut_in_two_is_the_run_whole_to_the_bit() {
    for name in [
        "ringing-oval",
        "bent-strip-free",
        "hinged-strip",
        "step-edge",
        "very-soft-ball-friction",
    ] {
        let off = cut(Scene::named(name).unwrap());
        assert!(off == 0.0, "{name} is off by {off:e}");
    }
}

#[test]
fn a_run_of_the_report_cut_in_two_is_the_run_whole_up_to_rounding() {
    for name in ["soft-ball", "rigid-ball", "bent-strip-anchored"] {
        let mut scene = Scene::named(name).unwrap();
        scene.plan.scheme = Scheme::Report;
        scene.plan.start_rule = Start::FirstOrder;
        // the position before is rebuilt from the velocity: one rounding of |x| < 50, 7e-15, which
        // 35 further steps may multiply by their number
        let off = cut(scene);
        assert!(off < 35.0 * 7e-15, "{name} is off by {off:e}");
    }
}

/// Largest relative change of the energy of the oval let go without damping, what the scheme holds back left in.
fn drift(dt: f64) -> f64 {
    let mut scene = changed("ringing-oval", &[("damping = 0.3", "damping = 0.0")]);
    scene.plan.until.steps = (10.0 / dt).round() as u64;
    scene.plan.dt = dt;
    scene.plan.recording.every = Some(1);
    let record = run(&mut scene);
    let totals: Vec<f64> = record
        .frames
        .iter()
        .map(|frame| frame.energies.as_ref().unwrap().mechanical())
        .collect();
    let swing = record
        .frames
        .iter()
        .map(|f| f.energies.as_ref().unwrap().kinetic)
        .fold(0.0, f64::max);
    assert!(
        swing > 0.1 * totals[0],
        "it moves: {swing} of {}",
        totals[0]
    );
    totals
        .iter()
        .map(|e| (e / totals[0] - 1.0).abs())
        .fold(0.0, f64::max)
}

#[test]
fn the_energy_of_an_undamped_scene_stays_within_the_second_order_of_the_scheme() {
    let (coarse, fine) = (drift(0.02), drift(0.01));
    assert!(coarse < 1e-2, "{coarse:e}");
    let ratio = coarse / fine;
    assert!(
        (3.6..4.4).contains(&ratio),
        "halving the step divides the error by {ratio}"
    );
}

#[test]
fn the_energies_of_a_record_sum_up_to_its_total() {
    let mut scene = Scene::named("rigid-ball-penalty").unwrap();
    scene.plan.until.steps = 1700; // the wall is met at about 1.6
    scene.plan.recording.every = Some(100);
    let record = run(&mut scene);
    let wall = record
        .frames
        .iter()
        .map(|f| f.energies.as_ref().unwrap().wall)
        .fold(0.0, f64::max);
    assert!(wall > 0.0, "the wall is met");
    let text = record.written().to_csv();
    let names: Vec<&str> = text.lines().nth(1).unwrap().split(',').collect();
    assert_eq!(names.last(), Some(&"total"));
    for line in text.lines().skip(2) {
        let numbers: Vec<f64> = line.split(',').map(|word| word.parse().unwrap()).collect();
        let (total, terms) = numbers[5..].split_last().unwrap();
        let (sum, size) = terms
            .iter()
            .fold((0.0, 0.0), |(s, a), e| (s + e, a + e.abs()));
        // seven terms, each rounded once
        assert!((total - sum).abs() <= 7.0 * f64::EPSILON * size, "{line}");
    }
}

/// Every number of a text, in order.
fn numbers(text: &str) -> Vec<f64> {
    text.split(|c: char| !(c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '+')))
        .filter(|word| word.starts_with(|c: char| c.is_ascii_digit() || c == '-'))
        .map(|word| word.parse().unwrap())
        .collect()
}

#[test]
fn both_formats_give_every_number_back_to_the_bit() {
    let mut scene = Scene::named("very-soft-ball-friction").unwrap();
    scene.plan.until.steps = 300;
    scene.plan.recording.every = Some(100);
    scene.plan.recording.velocities = true;
    let record = run(&mut scene);
    let csv = record.written().to_csv();
    let mut lines = csv.lines().skip(2);
    let json = record.written().to_json_lines().unwrap();
    for (frame, line) in record.frames.iter().zip(json.lines().skip(1)) {
        let velocities = frame.velocities().unwrap();
        let energies = frame.energies.as_ref().unwrap();
        let mut expected = vec![frame.step as f64, frame.t];
        expected.extend(frame.nodes().iter().flat_map(|p| p.to_array()));
        expected.extend(velocities.iter().flat_map(|v| v.to_array()));
        expected.extend(energies.values());
        expected.push(energies.total());
        same(&numbers(line), &expected);
        for (i, (p, v)) in frame.nodes().iter().zip(velocities).enumerate() {
            let mut expected = vec![frame.step as f64, frame.t, i as f64, p.x, p.y, v.x, v.y];
            expected.extend(energies.values());
            expected.push(energies.total());
            same(&numbers(lines.next().unwrap()), &expected);
        }
    }
    assert_eq!(lines.next(), None);
}

fn same(got: &[f64], expected: &[f64]) {
    let bits = |list: &[f64]| list.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(got), bits(expected));
}

#[test]
fn chosen_sub_steps_end_where_short_ones_do_and_say_why() {
    const ROD: &str = "title = \"t\"\n[snake]\nnodes = 9\ntopology = \"open\"\n\
        start = { segment = { from = [0.0, 0.0], to = [8.0, 1.0] } }\n\
        rest = { segment = { from = [0.0, 0.0], to = [7.0, 0.0] } }\n\
        [material]\ntether = 0.1\ntension = 20.0\nrigidity = 5.0\n\
        [densities]\nmass = 1.0\ndamping = 0.5\n[run]\n";
    let rod = |plan: &str| Scene::parse("t", &format!("{ROD}{plan}\n"), Path::new("."));
    let end = |plan: &str| {
        let record = run(&mut rod(plan).unwrap());
        (record.last().unwrap().nodes().to_vec(), record)
    };
    let (exact, slow) = end("dt = 0.0005\ntime = 5.0");
    let (chosen, record) = end("dt = \"auto\"\ntolerance = 1e-5\noutput = 1.0\ntime = 5.0");
    let off = exact.iter().zip(&chosen).map(|(a, b)| a.distance(*b));
    // local errors of 1e-5 over some hundred sub-steps, damped as they add up
    assert!(off.fold(0.0, f64::max) < 1e-3);
    assert_eq!((record.outcome.step(), slow.pace), (5, None));
    let pace = record.pace.unwrap();
    assert!(
        pace.contains("sub-steps of") && pace.contains("accuracy"),
        "{pace}"
    );
    for (plan, says) in [
        ("dt = \"auto\"\nsteps = 3", "run.output: is missing"),
        (
            "dt = \"auto\"\ntime = 1.0\ntolerance = 0.0",
            "run.tolerance: ",
        ),
        (
            "dt = 0.1\ntime = 1.0\noutput = 0.5",
            "run.output: is for chosen",
        ),
        ("dt = \"quick\"\ntime = 1.0", "\"auto\""),
    ] {
        let error = rod(plan).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
    let report = "dt = \"auto\"\ntime = 1.0\nscheme = \"report\"";
    let error = rod(report).unwrap().check().unwrap_err().to_string();
    assert!(error.starts_with("run.scheme: "), "{error}");
}
