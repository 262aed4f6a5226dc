//! Scenes that touch walls against mechanics and against each other's schemes, from text to record.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use std::ops::ControlFlow;
use std::path::Path;

use scene::integrator::Scheme;
use scene::{Frame, SCENES, Scene};

/// A rod at the left border of an empty picture, gravity along it and into it.
const BORDER: &str = r#"
title = "A rod at the border of a picture"
[picture.drawn]
size = [60, 80]
region = { box = [200.0, 200.0, 210.0, 210.0] }
[snake]
nodes = 5
topology = "open"
start = { segment = { from = [0.0, 10.0], to = [0.0, 20.0] } }
[material]
tether = 0.0
tension = 10.0
rigidity = 0.0
[densities]
mass = 1.0
damping = 0.0
[world]
gravity = [-0.5, 1.0]
[run]
dt = 0.01
steps = 800
[record]
velocities = true
"#;

fn inert() -> impl Iterator<Item = Scheme> {
    let other = |scheme: &Scheme| *scheme != Scheme::GradientFlow;
    Scheme::ALL.iter().copied().filter(other)
}

/// Mean place and velocity at the end, by component.
fn end(mut scene: Scene, scheme: Scheme) -> ([f64; 2], [f64; 2]) {
    scene.plan.scheme = scheme;
    scene.plan.recording.velocities = true;
    let record = scene.run(&mut |_| ControlFlow::Continue(())).unwrap();
    let last = record.frames.last().unwrap();
    let points = |frame: &Frame| (frame.nodes().to_vec(), frame.velocities().unwrap().to_vec());
    let (nodes, velocities) = points(last);
    let count = f64::from(u32::try_from(nodes.len()).unwrap());
    let mean = |of: &dyn Fn(usize) -> f64| (0..nodes.len()).map(of).sum::<f64>() / count;
    (
        [mean(&|i| nodes[i].x), mean(&|i| nodes[i].y)],
        [mean(&|i| velocities[i].x), mean(&|i| velocities[i].y)],
    )
}

#[test]
fn what_lies_at_the_border_of_a_picture_falls_along_it_as_freely_as_beside_it() {
    for scheme in inert() {
        let scene = Scene::parse("border", BORDER, Path::new(".")).unwrap();
        let (at, v) = end(scene, scheme);
        // from a mean height of 15, ½ g t² = 32 in 8
        assert!((at[1] - 47.0).abs() < 0.32, "{scheme}: {at:?}");
        assert!((v[1] - 8.0).abs() < 0.08, "{scheme}: {v:?}");
        assert!(at[0].abs() < 0.01, "{scheme}: {at:?}");
    }
}

#[test]
fn a_ball_on_a_rough_wall_falls_alike_under_every_scheme() {
    let (_, text) = SCENES
        .iter()
        .find(|(name, _)| *name == "very-soft-ball-friction")
        .unwrap();
    let scene = || Scene::parse("ball", text, Path::new(".")).unwrap();
    let (reference, _) = end(scene(), Scheme::DormandPrince { tolerance: 1e-9 });
    for scheme in inert() {
        let (at, _) = end(scene(), scheme);
        // the ball is of size 1; contacts are known to a step
        let off = (at[0] - reference[0]).hypot(at[1] - reference[1]);
        assert!(off < 0.02, "{scheme}: {at:?} for {reference:?}");
    }
}

#[test]
fn a_ball_that_hits_a_smooth_wall_squarely_does_not_bulge_along_it() {
    for scheme in inert() {
        let mut scene = Scene::named("rigid-ball-impact").unwrap();
        scene.plan.scheme = scheme;
        let record = scene.run(&mut |_| ControlFlow::Continue(())).unwrap();
        let (first, last) = (
            record.frames.first().unwrap(),
            record.frames.last().unwrap(),
        );
        let center = |frame: &Frame| {
            let count = f64::from(u32::try_from(frame.nodes().len()).unwrap());
            frame.nodes().iter().map(|x| x.y).sum::<f64>() / count
        };
        let (from, to) = (center(first), center(last));
        let bulge = first.nodes().iter().zip(last.nodes());
        let bulge = bulge.map(|(a, b)| ((b.y - to) - (a.y - from)).abs());
        let most = bulge.fold(0.0, f64::max);
        assert!(most < 1e-9, "{scheme}: {most}");
    }
}

/// The same rod in a scene with contacts, on a slope of 30 degrees that pushes back and rubs, moving down at 3.
const RUBBING: &str = r#"
title = "A rod on a rough slope"
[snake]
nodes = 5
topology = "open"
start = { segment = { from = [0.0, 0.0], to = [3.4641016151377544, -2.0] } }
velocity = [2.598076211353316, -1.5]
[material]
tether = 0.0
tension = 10.0
rigidity = 0.0
[densities]
mass = 1.0
damping = 0.0
[world]
gravity = [0.0, -1.0]
[[world.wall]]
point = [0.0, 0.0]
normal = [0.5, 0.8660254037844386]
law = { penalty = { stiffness = 1000.0 } }
[contact]
stiffness = 1000.0
stop = 0.5
wall-friction = 0.3
[run]
dt = 0.001
steps = 5000
[record]
velocities = true
"#;

#[test]
fn kicks_between_steps_cost_no_scheme_a_part_of_its_forces() {
    for scheme in inert() {
        let scene = Scene::parse("rubbing", RUBBING, Path::new(".")).unwrap();
        let (_, v) = end(scene, scheme);
        let speed = v[0].hypot(v[1]);
        let asked = 3.0 + 5.0 * (0.5 - 0.3 * 0.75_f64.sqrt());
        assert!(
            (speed - asked).abs() < 0.02 * asked,
            "{scheme}: {speed} for {asked}"
        );
    }
}
