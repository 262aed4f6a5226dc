//! Orders of convergence, measured by halving the step.

use crate::problems::{self, Problem};
use crate::{DormandPrince, Scheme, Start};

/// Largest error of a position or velocity at time `t` after `steps` steps.
///
/// Both together, since one alone may pass through zero where the other is largest.
fn errors(scheme: Scheme, problem: &Problem, t: f64, steps: u32) -> f64 {
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
    most(&state.x, &exact.x).max(most(&state.v, &exact.v))
}

/// Halve the step twice; the mean slope must be the order claimed, to 0.1.
fn check(scheme: Scheme, problem: &Problem, t: f64, steps: u32) {
    let order = f64::from(scheme.order());
    // low orders show in short steps only, high ones drown in rounding there
    let steps = match scheme.order() {
        1 => 32 * steps,
        2 => 8 * steps,
        4 => 6 * steps,
        _ => steps,
    };
    let (coarse, fine) = (
        errors(scheme, problem, t, steps),
        errors(scheme, problem, t, 4 * steps),
    );
    let slope = (coarse / fine).log2() / 2.0;
    assert!(
        (slope - order).abs() < 0.1,
        "{scheme}: {slope}; {coarse} {fine}"
    );
}

/// The schemes with mass and a step of their own.
fn inert() -> impl Iterator<Item = Scheme> {
    let other = |s: &Scheme| !matches!(s, Scheme::DormandPrince { .. } | Scheme::GradientFlow);
    Scheme::ALL.iter().copied().filter(other)
}

/// Those of them that make an error without external forces.
fn inexact() -> impl Iterator<Item = Scheme> {
    inert().filter(|s| !matches!(s, Scheme::Exact | Scheme::Etd2))
}

#[test]
fn every_scheme_has_its_order_on_springs_in_all_regimes() {
    for damping in [0.3, 2.0, 4.0] {
        let problem = problems::damped_spring(1.0, damping, 1.0).unwrap();
        for scheme in inexact() {
            check(scheme, &problem, 3.0, 12);
        }
    }
}

#[test]
fn every_scheme_has_its_order_where_half_the_stiffness_is_external() {
    let problem = problems::shared_spring(1.0, 0.5, 2.0, 0.5).unwrap();
    for scheme in inert() {
        check(scheme, &problem, 3.0, 12);
    }
}

#[test]
fn every_scheme_has_its_order_when_pushed_in_time() {
    let problem = problems::driven_spring(1.0, 0.5, 2.0, 3.0).unwrap();
    for scheme in inert() {
        check(scheme, &problem, 2.5, 16);
    }
}

#[test]
fn every_scheme_has_its_order_on_a_ring_that_is_not_stiff() {
    let problem = problems::ring(12, 1.0, 0.4, [0.2, 0.5, 0.05]).unwrap();
    for scheme in inexact() {
        check(scheme, &problem, 2.0, 16);
    }
}

#[test]
fn the_gradient_flow_has_order_1() {
    // without mass a spring creeps: γ u̇ = −k u, a quarter of k external (half would be the
    // trapezoidal rule)
    let scheme = Scheme::GradientFlow;
    let problem = problems::shared_spring(1.0, 2.0, 3.0, 0.25).unwrap();
    let error = |steps: u32| {
        let (mut system, mut state) = (problem.system.clone(), problem.state.clone());
        let dt = 1.0 / f64::from(steps);
        let mut stepper = scheme
            .start(&mut system, &state, dt, Start::FirstOrder)
            .unwrap();
        for _ in 0..steps {
            stepper.step(&mut system, &mut state).unwrap();
        }
        (state.x[0].x - (-1.5_f64).exp()).abs()
    };
    let slope = (error(400) / error(1600)).log2() / 2.0;
    assert!((slope - 1.0).abs() < 0.1, "{slope}");
}

#[test]
fn dormand_and_prince_keep_the_tolerance_and_fill_the_gaps() {
    let problem = problems::driven_spring(1.0, 0.5, 2.0, 3.0).unwrap();
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        let (mut system, mut state) = (problem.system.clone(), problem.state.clone());
        let mut stepper = DormandPrince::new(&mut system, &state, 0.1, tolerance).unwrap();
        let mut between = state.clone();
        while state.t < 10.0 {
            let from = state.t;
            stepper.advance(&mut system, &mut state).unwrap();
            for share in [0.0, 0.25, 0.5, 0.9, 1.0] {
                let t = from + share * (state.t - from);
                stepper.at(t, &mut between);
                let exact = (problem.exact)(t);
                // errors of sub-steps add up over some periods, in a spring that forgets in two
                let error = (between.x[0] - exact.x[0]).length();
                assert!(error < 20.0 * tolerance, "{tolerance} at {t}: {error}");
            }
        }
        // as a stepper it ends where it should
        let (mut system, mut state) = (problem.system.clone(), problem.state.clone());
        let scheme = Scheme::DormandPrince { tolerance };
        let mut stepper = scheme
            .start(&mut system, &state, 0.7, Start::FirstOrder)
            .unwrap();
        for _ in 0..10 {
            stepper.step(&mut system, &mut state).unwrap();
        }
        let error = (state.x[0] - (problem.exact)(7.0).x[0]).length();
        assert!(
            error < 20.0 * tolerance && state.step == 10,
            "{tolerance}: {error}"
        );
    }
}

/// A node on a spring that weakens, in a resistance that fades, pushed by `(1 + t)⁻²`:
/// `ẍ + ẋ/(1+t) + 4x/(1+t)² = 1/(1+t)²`, so `x = ¼ + ¾ cos(2 ln(1+t))` from rest at 1.
struct Fading {
    springs: problems::Springs,
    band: banded::Band,
    at: f64,
}

impl Fading {
    fn new() -> (Self, crate::State) {
        let springs = problems::damped_spring(1.0, 1.0, 4.0).unwrap().system;
        let state = crate::State::at_rest(vec![glam::DVec2::X; springs.rest.len()]);
        let band = crate::System::stiffness(&springs).band().clone();
        let mut fading = Self {
            springs,
            band,
            at: 0.0,
        };
        fading.springs.rest.fill(glam::DVec2::ZERO);
        fading.turn(0.0);
        (fading, state)
    }

    fn turn(&mut self, t: f64) {
        let fade = 1.0 / (1.0 + t);
        self.at = t;
        self.springs.damping.fill(fade);
        let mut band = self.band.clone();
        band.scale(fade * fade);
        self.springs.set_stiffness(band.into());
    }
}

impl crate::Wrapped for Fading {
    fn inner(&self) -> &dyn crate::System {
        &self.springs
    }

    fn inner_mut(&mut self) -> &mut dyn crate::System {
        &mut self.springs
    }

    fn advance(&mut self, t: f64, _: &[glam::DVec2]) {
        self.turn(t);
    }

    fn revision(&self) -> u64 {
        self.at.to_bits()
    }

    fn external_is_constant(&self) -> bool {
        false
    }

    fn external(
        &mut self,
        t: f64,
        _x: &[glam::DVec2],
        _v: &[glam::DVec2],
        force: &mut [glam::DVec2],
    ) -> Result<(), crate::Fault> {
        for force in force {
            force.x += 1.0 / ((1.0 + t) * (1.0 + t));
        }
        Ok(())
    }
}

#[test]
fn the_stages_of_runge_and_kutta_see_what_schedules_say_at_their_own_times() {
    for (scheme, order) in [
        (Scheme::Rk4, 4.0),
        // so loose that every sub-step is the step
        (Scheme::DormandPrince { tolerance: 1.0 }, 5.0),
    ] {
        let error = |steps: u32| {
            let (mut system, mut state) = Fading::new();
            let dt = 3.0 / f64::from(steps);
            let mut stepper = scheme
                .start(&mut system, &state, dt, Start::SecondOrder)
                .unwrap();
            for _ in 0..steps {
                stepper.step(&mut system, &mut state).unwrap();
            }
            let phase = 2.0 * 4.0_f64.ln();
            let exact = (0.25 + 0.75 * phase.cos(), -1.5 * phase.sin() / 4.0);
            (state.x[0].x - exact.0).hypot(state.v[0].x - exact.1)
        };
        let (coarse, fine) = (error(48), error(192));
        let found = (coarse / fine).log2() / 2.0;
        assert!(
            (found - order).abs() < 0.15,
            "{scheme}: order {found}, {coarse} {fine}"
        );
    }
}
