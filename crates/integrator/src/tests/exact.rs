//! Exact motion: any step, all regimes, closed or not.

use glam::DVec2;
use proptest::prelude::*;

use crate::oscillator::Oscillator;
use crate::problems::{self, Problem};
use crate::{Scheme, SchemeError, Start, System};

fn error_after(scheme: Scheme, problem: &Problem, dt: f64, steps: u32) -> f64 {
    let (mut system, mut state) = (problem.system.clone(), problem.state.clone());
    let mut stepper = scheme
        .start(&mut system, &state, dt, Start::SecondOrder)
        .unwrap();
    for _ in 0..steps {
        stepper.step(&mut system, &mut state).unwrap();
    }
    let exact = (problem.exact)(dt * f64::from(steps));
    state
        .x
        .iter()
        .zip(&exact.x)
        .map(|(a, b)| (a - b).length())
        .fold(0.0, f64::max)
}

/// A ring of 200 nodes with stiffnesses from 1 to `ratio`.
fn ring(damping: f64, ratio: f64) -> Problem {
    problems::ring(200, 1.0, damping, [1.0, 0.0, ratio / 16.0]).unwrap()
}

#[test]
fn a_free_ring_is_right_after_one_step_of_any_length() {
    for damping in [0.0, 1.0, 30.0] {
        for ratio in [1e2, 1e4, 1e6] {
            let problem = ring(damping, ratio);
            for dt in [1e-3, 0.1, 5.0, 100.0] {
                for scheme in [Scheme::Exact, Scheme::Etd2] {
                    let error = error_after(scheme, &problem, dt, 1);
                    assert!(
                        error < 1e-9,
                        "{scheme} γ {damping}, ratio {ratio}, dt {dt}: {error}"
                    );
                }
            }
            // far beyond, what is left is the phase: λ t² of 1e6 · 1e8 has lost 1e7 digits of rounding
            let error = error_after(Scheme::Exact, &problem, 1e4, 1);
            assert!(error < 1e-6, "γ {damping}, ratio {ratio}: {error}");
        }
    }
}

#[test]
fn a_chain_with_ends_is_right_after_one_step_through_its_eigenvectors() {
    let problem = problems::chain(40, 2.0, 0.6, 50.0).unwrap();
    for dt in [1e-3, 0.3, 20.0] {
        for scheme in [Scheme::Exact, Scheme::Etd2] {
            // Jacobi's eigenvalues are right to 1e-14 of the largest, phases to √λ t of that
            let error = error_after(scheme, &problem, dt, 1);
            assert!(error < 1e-10, "{scheme}, dt {dt}: {error}");
        }
    }
}

#[test]
fn a_constant_force_is_exact_in_etd2_and_free_fall_in_both() {
    for damping in [0.0, 0.7] {
        let problem = problems::free_fall(1.5, damping, DVec2::new(0.3, 9.8)).unwrap();
        // rounding of positions of some hundreds
        let error = error_after(Scheme::Etd2, &problem, 5.0, 1);
        assert!(error < 1e-12, "{damping}: {error}");
    }
    // kicks at both ends and straight on between are the parabola itself
    let problem = problems::free_fall(1.5, 0.0, DVec2::new(0.3, 9.8)).unwrap();
    assert!(error_after(Scheme::Exact, &problem, 5.0, 1) < 1e-12);
}

#[test]
fn what_cannot_be_taken_apart_is_refused_with_the_reason() {
    let mut problem = problems::chain(8, 1.0, 0.5, 1.0).unwrap();
    problem.system.damping[3] = 0.6;
    let refused = Scheme::Exact.start(&mut problem.system, &problem.state, 0.1, Start::FirstOrder);
    let Err(SchemeError::NoModes { why, .. }) = refused else {
        panic!("{refused:?}")
    };
    assert!(
        why.contains("0.5") && why.contains("0.6") && why.contains("radau-5"),
        "{why}"
    );

    let mut problem = problems::chain(crate::modes::MOST + 1, 1.0, 0.5, 1.0).unwrap();
    let refused = Scheme::Etd2.start(&mut problem.system, &problem.state, 0.1, Start::FirstOrder);
    assert!(
        matches!(refused, Err(SchemeError::NoModes { .. })),
        "{refused:?}"
    );
    // a ring of any size has waves
    let mut problem = problems::ring(crate::modes::MOST + 1, 1.0, 0.5, [1.0, 1.0, 1.0]).unwrap();
    assert!(
        Scheme::Exact
            .start(&mut problem.system, &problem.state, 0.1, Start::FirstOrder)
            .is_ok()
    );
}

#[test]
fn what_all_nodes_share_changes_only_the_mode_in_which_all_move_alike() {
    // a body frame: K − 1 (1ᵀK1/n²) 1ᵀ lets the ring drift although it is tethered
    let n = 24;
    let mut problem = problems::ring(n, 1.0, 0.3, [2.0, 5.0, 1.0]).unwrap();
    let band = problem.system.stiffness().band().clone();
    let share = -2.0 / n as f64;
    let framed = banded::Operator::new(band, vec![vec![1.0; n]], vec![share]).unwrap();
    problem.system.set_stiffness(framed);
    let ends = [(Scheme::Exact, 4.0, 1), (Scheme::Radau5, 0.01, 400)].map(|(scheme, dt, steps)| {
        let (mut system, mut state) = (problem.system.clone(), problem.state.clone());
        let mut stepper = scheme
            .start(&mut system, &state, dt, Start::SecondOrder)
            .unwrap();
        for _ in 0..steps {
            stepper.step(&mut system, &mut state).unwrap();
        }
        state
    });
    for i in 0..n {
        // Radau's error at this step: (√λ dt)⁵ of modes up to λ = 38
        assert!((ends[0].x[i] - ends[1].x[i]).length() < 1e-8);
    }
    // the mean moves as if free: x̄ + v̄ (1 − exp(−γt/μ)) μ/γ
    let mean = |x: &[DVec2]| x.iter().sum::<DVec2>() / n as f64;
    let gone = (1.0 - f64::exp(-0.3 * 4.0)) / 0.3;
    let drift = mean(&problem.state.x) + gone * mean(&problem.state.v);
    assert!((mean(&ends[0].x) - drift).length() < 1e-12);
}

#[test]
fn damping_in_proportion_to_an_uneven_mass_is_taken_apart() {
    let mut problem = problems::chain(12, 1.0, 0.0, 4.0).unwrap();
    for i in 0..12 {
        problem.system.mass[i] = 1.0 + 0.2 * i as f64;
        problem.system.damping[i] = 0.3 * problem.system.mass[i];
    }
    problem.system.held[5] = true;
    let mut ends = Vec::new();
    let mut stiff = problem.system.stiffness().band().clone();
    stiff.hold(&problem.system.held);
    for (scheme, dt, steps) in [
        (Scheme::Exact, 3.0, 1),
        (Scheme::DormandPrince { tolerance: 1e-12 }, 0.5, 6),
    ] {
        let mut system = problem.system.clone();
        system.set_stiffness(banded::Operator::from(stiff.clone()));
        let mut state = problem.state.clone();
        let mut stepper = scheme
            .start(&mut system, &state, dt, Start::FirstOrder)
            .unwrap();
        for _ in 0..steps {
            stepper.step(&mut system, &mut state).unwrap();
        }
        ends.push(state.x);
    }
    for (a, b) in ends[0].iter().zip(&ends[1]) {
        // the reference's tolerance, some hundred sub-steps of it
        assert!((a - b).length() < 1e-10, "{a} {b}");
    }
    assert_eq!(ends[0][5], problem.state.x[5]);
}

/// Twice half the time is the time: for the four functions at once.
fn check_doubling(c: f64, stiffness: f64, t: f64) {
    let (half, whole) = (
        Oscillator::new(c, stiffness, 0.5 * t),
        Oscillator::new(c, stiffness, t),
    );
    let left = 1.0 - stiffness * half.push;
    let push = half.push + half.kick * half.kick + left * half.push;
    // the same once more with the ramp: ½t of force is already there in the second half
    let ramp = half.ramp + left * half.ramp + half.kick * half.push + 0.5 * t * half.push;
    let kick = left * half.kick + half.kick * half.keep;
    let keep = half.keep * half.keep - stiffness * half.kick * half.kick;
    let phase = 1.0 + stiffness.sqrt() * t;
    // the time of a radian, or all there is
    let turn = t.min(1.0 / stiffness.sqrt());
    for (what, a, b, size) in [
        (
            "kick",
            kick,
            whole.kick,
            half.kick.abs().max(whole.kick.abs()),
        ),
        ("keep", keep, whole.keep, 1.0),
        // near the end of a period the sums cancel: rounding is that of their terms, and of the phase
        (
            "push",
            push,
            whole.push,
            2.0 * half.push.abs() + half.kick * half.kick + whole.kick.abs() * turn,
        ),
        (
            "ramp",
            ramp,
            whole.ramp,
            2.0 * half.ramp.abs()
                + (half.kick * half.push).abs()
                + 0.5 * t * half.push.abs()
                + whole.push.abs() * turn,
        ),
    ] {
        assert!(
            (a - b).abs() <= 1e-14 * phase * 10.0 * size,
            "{what} c {c} λ {stiffness} t {t}: {a} {b}"
        );
    }
}

#[test]
fn the_double_root_and_its_neighbourhood_are_smooth() {
    for offset in [
        0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3, -1e-15, -1e-12, -1e-9, -1e-6, -1e-3,
    ] {
        for t in [1e-3, 0.1, 1.0, 3.0, 20.0] {
            let (c, stiffness) = (2.0 * (1.0 + offset), 1.0);
            check_doubling(c, stiffness, t);
            // at the root itself G = t exp(−t), and near it no further than the offset away
            let kick = Oscillator::new(c, stiffness, t).kick;
            let exact = t * (-t).exp();
            let near = 1e-14 + 10.0 * f64::abs(offset) * (1.0 + t * t);
            assert!(
                (kick - exact).abs() <= near * exact.max(1e-10),
                "{offset} {t}: {kick} {exact}"
            );
        }
    }
}

#[test]
fn two_half_steps_are_one_near_the_end_of_a_period() {
    check_doubling(0.0, 43650.19750914903, 7.337982906061257);
}

proptest! {
    #[test]
    fn two_half_steps_are_one_in_every_regime(
        c in prop_oneof![Just(0.0), (-6.0..4.0).prop_map(|e: f64| 10.0_f64.powf(e))],
        k in prop_oneof![Just(0.0), (-8.0..6.0).prop_map(|e: f64| 10.0_f64.powf(e))],
        t in (-6.0..4.0).prop_map(|e: f64| 10.0_f64.powf(e)),
    ) {
        check_doubling(c, k, t);
    }
}
