//! To rest in growing steps: where it ends, how it begins, what is refused.

use glam::DVec2;

use crate::problems::{self, Springs};
use crate::{Relaxation, SchemeError, State, Stepper, System};

/// A stiff ring in gravity on soft springs, thrown out of shape.
fn ring(damping: f64) -> (Springs, State) {
    let problem = problems::ring(24, 2.0, damping, [0.0, 20.0, 70.0]).unwrap();
    let (mut system, mut state) = (problem.system, problem.state);
    system.gravity = DVec2::new(0.02, 0.2);
    system.pull = 0.01;
    for (i, x) in state.x.iter_mut().enumerate() {
        *x += DVec2::new(3.0 * (i as f64).sin(), -2.0);
    }
    (system, state)
}

fn largest_net(system: &mut Springs, state: &State) -> f64 {
    let mut net = vec![DVec2::ZERO; state.len()];
    system.elastic(&state.x, &mut net);
    let zero = vec![DVec2::ZERO; state.len()];
    system.external(0.0, &state.x, &zero, &mut net).unwrap();
    net.iter().map(|f| f.length()).fold(0.0, f64::max)
}

#[test]
fn a_curve_far_from_rest_is_there_after_tens_of_steps_none_longer_than_its_reach() {
    // the slowest motion takes 2 γ/0.01 = 1000 of time to fall by e
    let (mut system, mut state) = ring(5.0);
    let mut stepper = Relaxation::new(&mut system, &state, 0.01, 4.0).unwrap();
    let mut steps = 0;
    // 40 away at first: gravity 2 · 0.2 against 0.01
    while largest_net(&mut system, &state) > 1e-9 {
        let before = state.x.clone();
        stepper.step(&mut system, &mut state).unwrap();
        let ways = before.iter().zip(&state.x).map(|(a, b)| a.distance(*b));
        let moved = ways.fold(0.0, f64::max);
        assert!(moved <= 4.0 * (1.0 + 1e-12), "{moved}");
        assert!((moved - stepper.moved()).abs() < 1e-9);
        steps += 1;
        assert!(steps < 60);
    }
    assert!(stepper.dt() > 1e3, "{}", stepper.dt());
    assert!(stepper.solves() >= steps && state.t > 1e3);
}

#[test]
fn a_short_step_follows_the_motion_to_second_order() {
    // error of one step: a third power of it
    let error = |dt: f64| {
        let mut spring = problems::damped_spring(1.0, 0.3, 1.0).unwrap();
        let mut state = spring.state.clone();
        let mut stepper = Relaxation::new(&mut spring.system, &state, dt, 1e9).unwrap();
        stepper.step(&mut spring.system, &mut state).unwrap();
        let exact = (spring.exact)(dt);
        (state.x[0] - exact.x[0]).length() + (state.v[0] - exact.v[0]).length()
    };
    for dt in [0.1, 0.05, 0.025] {
        let ratio = error(dt) / error(0.5 * dt);
        assert!((ratio - 8.0).abs() < 0.8, "{dt}: {ratio}");
    }
}

#[test]
fn a_changed_system_is_begun_again_with_the_first_step() {
    let (mut system, mut state) = ring(5.0);
    let mut stepper = Relaxation::new(&mut system, &state, 0.01, 4.0).unwrap();
    while largest_net(&mut system, &state) > 1e-9 {
        stepper.step(&mut system, &mut state).unwrap();
    }
    let long = stepper.dt();
    system.gravity = DVec2::new(-0.2, 0.0);
    stepper.resume(&mut system, &state);
    stepper.step(&mut system, &mut state).unwrap();
    assert!(long > 1e3 && stepper.dt() <= 0.01);
    for _ in 0..200 {
        stepper.step(&mut system, &mut state).unwrap();
    }
    assert!(largest_net(&mut system, &state) < 1e-9);
}

#[test]
fn a_reach_that_is_none_is_refused() {
    let (mut system, state) = ring(1.0);
    for reach in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = Relaxation::new(&mut system, &state, 0.1, reach).unwrap_err();
        assert!(matches!(refused, SchemeError::BadReach { .. }), "{refused}");
    }
    let refused = Relaxation::new(&mut system, &state, f64::NAN, 1.0).unwrap_err();
    assert!(matches!(refused, SchemeError::BadStep { .. }), "{refused}");
}
