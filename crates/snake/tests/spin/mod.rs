//! A body that spins, for the tests of frames that turn.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use elastic::{Material, Motion, Profile, Topology};
use glam::DVec2;
use integrator::{Scheme, Start, State, System};
use snake::{Body, Frame};

pub(crate) const N: usize = 24;

/// A lopsided closed body whose mass and material differ from node to node.
pub(crate) fn body(frame: Frame) -> Body {
    let nodes = elastic::ellipse(DVec2::new(3.0, -2.0), DVec2::new(5.0, 3.0), 0.3, N);
    let wave = |by: f64| Profile::PerNode((0..N).map(|i| 1.0 + by * (i as f64).sin()).collect());
    let mut body = Body::of(&nodes, Topology::Closed, 1.0)
        .unwrap()
        .with_material(Material {
            tether: wave(0.3).scaled(0.5),
            tension: wave(0.2).scaled(2.0),
            rigidity: wave(-0.4),
            higher: Vec::new(),
        })
        .with_frame(frame);
    body.mass = wave(0.5);
    body.recenter().unwrap();
    body
}

/// The body at rest in its shape but for a wave through it, flying and spinning.
pub(crate) fn spinning(body: &Body, omega: f64, wave: f64) -> State {
    let x: Vec<DVec2> = (0..N)
        .map(|i| body.rest[i] * (1.0 + wave * (3.0 * i as f64).cos()) + DVec2::new(40.0, 25.0))
        .collect();
    let mut state = State::at_rest(x);
    let motion = Motion::of(&state.x, &state.v, &body.mass, body.spacing);
    for (v, x) in state.v.iter_mut().zip(&state.x) {
        *v = DVec2::new(0.2, -0.1) + omega * (*x - motion.center).perp();
    }
    state
}

pub(crate) fn go(system: &mut dyn System, state: &mut State, scheme: Scheme, dt: f64, steps: u64) {
    let mut stepper = scheme.start(system, state, dt, Start::SecondOrder).unwrap();
    for _ in 0..steps {
        stepper.step(system, state).unwrap();
    }
}

pub(crate) fn farthest(a: &[DVec2], b: &[DVec2]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| a.distance(*b))
        .fold(0.0, f64::max)
}
