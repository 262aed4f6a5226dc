//! Further snakes of a scene.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use std::ops::ControlFlow;
use std::path::Path;

use scene::Scene;

const HANGING: &str = r#"
title = "two balls, each on its own thread, part of them frozen"
[snake]
nodes = 16
topology = "closed"
start = { circle = { center = [0.0, 0.0], radius = 2.0 } }
[material]
tether = 4.0
tension = 4.0
rigidity = 4.0
[densities]
mass = 1.0
damping = 0.5
[world]
gravity = [0.0, 1.0]
[[force]]
kind = "spring"
from = [0.0, -2.0]
path = [[0.0, 0.0, -5.0], [1.0, 1.0, -5.0]]
stiffness = 8.0
[[force]]
kind = "spring"
node = 3
to = [4.0, 4.0]
stiffness = 2.0
[[force]]
kind = "freeze"
stretch = [7, 9]
stiffness = 6.0
[[also]]
at = [[40.0, 24.0]]
[run]
scheme = "leapfrog"
dt = 0.01
steps = 300
[record]
every = 300
"#;

#[test]
fn a_snake_put_elsewhere_takes_its_springs_along() {
    let scene = Scene::parse("hanging", HANGING, Path::new(".")).unwrap();
    let record = scene.run(&mut |_| ControlFlow::Continue(())).unwrap();
    let last = record.frames.last().unwrap();
    let first = &record.frames[0];
    let mut moved = 0.0_f64;
    for (i, (one, two)) in last.curves[0]
        .nodes
        .iter()
        .zip(&last.curves[1].nodes)
        .enumerate()
    {
        // rounding of places of some tens
        assert!((two.x - one.x - 40.0).abs() < 1e-9, "node {i}: {one} {two}");
        assert!((two.y - one.y - 24.0).abs() < 1e-9, "node {i}: {one} {two}");
        moved = moved.max(one.distance(first.nodes()[i]));
    }
    assert!(moved > 0.3, "{moved}");
}
