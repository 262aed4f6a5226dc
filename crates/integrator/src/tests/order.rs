//! Orders of convergence, measured by halving the step.

use crate::problems::{self, Problem};
use crate::{Scheme, Start};

/// Largest error of position and velocity at time `t` after `steps` steps.
fn errors(scheme: Scheme, problem: &Problem, t: f64, steps: u32) -> (f64, f64) {
    let mut system = problem.system.clone();
    let mut state = problem.state.clone();
    let dt = t / f64::from(steps);
    let mut stepper = scheme
        .start(&mut system, &state, dt, Start::SecondOrder)
        .unwrap();
    for _ in 0..steps {
        stepper.step(&mut system, &mut state).unwrap();
    }
    let exact = (problem.exact)(t);
    let most = |a: &[glam::DVec2], b: &[glam::DVec2]| {
        a.iter()
            .zip(b)
            .map(|(a, b)| (a - b).length())
            .fold(0.0, f64::max)
    };
    (most(&state.x, &exact.x), most(&state.v, &exact.v))
}

/// Halve the step twice; the mean slope must be the order claimed, to 0.1.
fn check(scheme: Scheme, problem: &Problem, t: f64, steps: u32) {
    let order = f64::from(scheme.order());
    // where errors of the next order are large, only short steps show the first
    let steps = if scheme.order() == 1 {
        8 * steps
    } else {
        steps
    };
    let coarse = errors(scheme, problem, t, 4 * steps);
    let fine = errors(scheme, problem, t, 16 * steps);
    for (what, ratio) in [
        ("position", coarse.0 / fine.0),
        ("velocity", coarse.1 / fine.1),
    ] {
        let slope = ratio.log2() / 2.0;
        assert!(
            (slope - order).abs() < 0.1,
            "{scheme}, {what}: {slope} for {order}; {coarse:?} {fine:?}"
        );
    }
}

/// The schemes with mass and a step of their own.
fn inert() -> impl Iterator<Item = Scheme> {
    let other = |s: &Scheme| !matches!(s, Scheme::DormandPrince { .. } | Scheme::GradientFlow);
    Scheme::ALL.iter().copied().filter(other)
}

#[test]
fn every_scheme_has_its_order_on_springs_in_all_regimes() {
    for damping in [0.3, 2.0, 4.0] {
        let problem = problems::damped_spring(1.0, damping, 1.0).unwrap();
        for scheme in inert() {
            check(scheme, &problem, 3.0, 16);
        }
    }
}

#[test]
fn every_scheme_has_its_order_where_half_the_stiffness_is_external() {
    let problem = problems::shared_spring(1.0, 0.5, 2.0, 0.5).unwrap();
    for scheme in inert() {
        check(scheme, &problem, 3.0, 16);
    }
}

#[test]
fn every_scheme_has_its_order_when_pushed_in_time() {
    let problem = problems::driven_spring(1.0, 0.5, 2.0, 3.0).unwrap();
    for scheme in inert() {
        check(scheme, &problem, 3.0, 24);
    }
}

#[test]
fn every_scheme_has_its_order_on_a_ring_that_is_not_stiff() {
    let problem = problems::ring(12, 1.0, 0.4, [0.2, 0.5, 0.05]).unwrap();
    for scheme in inert() {
        check(scheme, &problem, 2.0, 24);
    }
}
