//! Slips of the report that are about when a scene records.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use std::ops::ControlFlow;
use std::path::Path;

use scene::Scene;

const STRIP: &str = "title = \"a strip\"\n[snake]\nnodes = 6\ntopology = { head = \"free\", tail = \"free\" }\n\
    start = { points = [[0.0, 0.0], [5.0, 0.0]] }\n[material]\ntether = 0.0\ntension = 1.0\nrigidity = 1.0\n\
    [densities]\nmass = 1.0\ndamping = 1.0\n[world]\ngravity = [0.0, 1.0]\n\
    [run]\ndt = 0.01\nsteps = 200\n[record]\nevery = 70\n";

#[test]
fn d34_frames_are_kept_before_the_first_step_and_after_every_70() {
    let scene = Scene::parse("strip", STRIP, Path::new(".")).unwrap();
    let record = scene.run(&mut |_| ControlFlow::Continue(())).unwrap();
    let steps: Vec<u64> = record.frames.iter().map(|frame| frame.step).collect();
    // and at the end, whenever that is
    assert_eq!(steps, [0, 70, 140, 200]);
}
