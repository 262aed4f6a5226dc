//! The report's scheme, leapfrog, and what they are the same as.

use glam::{DMat2, DVec2};

use crate::problems::{self, Springs};
use crate::{Fault, Scheme, Start, System, report_steps};

#[test]
fn the_reports_recurrence_is_symplectic_eulers_with_backward_velocity() {
    let mut problem = problems::shared_spring(1.3, 0.7, 2.0, 0.5).unwrap();
    let (m, c, k, dt) = (1.3, 0.7, 2.0, 0.01);
    let mut state = problem.state.clone();
    let mut stepper = Scheme::Report
        .start(&mut problem.system, &state, dt, Start::FirstOrder)
        .unwrap();
    let (mut x, mut v) = (state.x.clone(), state.v.clone());
    for _ in 0..2000 {
        stepper.step(&mut problem.system, &mut state).unwrap();
        for i in 0..x.len() {
            let push = -k * x[i] - c * v[i];
            v[i] += dt / m * push;
            x[i] += dt * v[i];
            // α₁ x of 2.6e4 loses 4e-12 a step, twice summed (D21)
            assert!((state.x[i] - x[i]).length() < 1e-9);
        }
    }
}

#[test]
fn leapfrog_is_the_centred_recurrence_of_d18() {
    let mut problem = problems::ring(12, 1.3, 0.7, [0.2, 3.0, 0.4]).unwrap();
    let (m, c, dt) = (1.3, 0.7, 0.05);
    let a = c * dt / m;
    let mut state = problem.state.clone();
    // both start with x₋ = x − dt v + ½ dt² a₀, the centred one
    let n = state.len();
    let mut force = vec![DVec2::ZERO; n];
    problem.system.elastic(&state.x, &mut force);
    let mut before: Vec<DVec2> = (0..n)
        .map(|i| state.x[i] - dt * state.v[i] + 0.5 * dt * dt / m * (force[i] - c * state.v[i]))
        .collect();
    let mut x = state.x.clone();
    let mut stepper = Scheme::Leapfrog
        .start(&mut problem.system, &state, dt, Start::SecondOrder)
        .unwrap();
    for _ in 0..1000 {
        problem.system.elastic(&x, &mut force);
        let next: Vec<DVec2> = (0..n)
            .map(|i| {
                let sum = 2.0 * x[i] - (1.0 - 0.5 * a) * before[i] + dt * dt / m * force[i];
                sum / (1.0 + 0.5 * a)
            })
            .collect();
        before = std::mem::replace(&mut x, next);
        stepper.step(&mut problem.system, &mut state).unwrap();
        for i in 0..n {
            // the recurrence loses 1e-15 of x = 10 a step, twice summed
            assert!(
                (state.x[i] - x[i]).length() < 1e-10,
                "{} {}",
                state.x[i],
                x[i]
            );
        }
    }
}

#[test]
fn a_first_order_start_puts_the_nodes_before_at_x_minus_dt_v() {
    let dt = 0.1;
    for scheme in [Scheme::Report, Scheme::Leapfrog] {
        let mut problem = problems::damped_spring(1.0, 0.0, 4.0).unwrap();
        let mut state = problem.state.clone();
        let mut stepper = scheme
            .start(&mut problem.system, &state, dt, Start::FirstOrder)
            .unwrap();
        let (x, v) = (state.x.clone(), state.v.clone());
        stepper.step(&mut problem.system, &mut state).unwrap();
        for i in 0..3 {
            let before = x[i] - dt * v[i];
            let next = 2.0 * x[i] - before - dt * dt * 4.0 * x[i];
            assert!((state.x[i] - next).length() < 1e-14, "{scheme}");
        }
    }
}

#[test]
fn a_first_order_start_costs_leapfrog_an_order_and_the_second_does_not() {
    let error = |start: Start, steps: u32| {
        let mut problem = problems::damped_spring(1.0, 0.0, 4.0).unwrap();
        let mut state = problem.state.clone();
        let dt = 1.0 / f64::from(steps);
        let mut stepper = Scheme::Leapfrog
            .start(&mut problem.system, &state, dt, start)
            .unwrap();
        for _ in 0..steps {
            stepper.step(&mut problem.system, &mut state).unwrap();
        }
        (state.x[0] - (problem.exact)(1.0).x[0]).length()
    };
    let slope = |start: Start| (error(start, 200) / error(start, 800)).log2() / 2.0;
    assert!((slope(Start::FirstOrder) - 1.0).abs() < 0.1);
    assert!((slope(Start::SecondOrder) - 2.0).abs() < 0.1);
}

#[test]
fn increments_keep_the_digits_that_the_recurrence_loses() {
    // D21: far from the origin, soft and with a small step
    let drift = |scheme: Scheme| {
        let mut problem = problems::free_fall(1.0, 0.0, DVec2::ZERO).unwrap();
        for x in &mut problem.state.x {
            *x += DVec2::splat(1000.1);
        }
        problem.state.v.fill(DVec2::ZERO);
        let mut state = problem.state.clone();
        let mut stepper = scheme
            .start(&mut problem.system, &state, 1e-3, Start::FirstOrder)
            .unwrap();
        for _ in 0..5000 {
            stepper.step(&mut problem.system, &mut state).unwrap();
        }
        state
            .x
            .iter()
            .zip(&problem.state.x)
            .map(|(a, b)| (a - b).length())
            .fold(0.0, f64::max)
    };
    assert!(drift(Scheme::Leapfrog) <= 0.0);
    assert!(drift(Scheme::Report) > 1e-10, "{}", drift(Scheme::Report));
}

#[test]
fn the_report_counts_steps_by_adding_and_all_others_by_counting() {
    let counted = [
        (500.0, 50001),
        (60.0, 6001),
        (40.0, 4000),
        (30.0, 3000),
        (20.0, 2000),
    ];
    for (end, steps) in counted {
        assert_eq!(report_steps(end, 0.01), Some(steps), "{end}");
    }
    assert_eq!(report_steps(1e17, 1.0), None);
    assert_eq!(report_steps(1.0, 0.0), None);
    assert_eq!(report_steps(f64::NAN, 1.0), None);

    for &scheme in Scheme::ALL {
        let mut problem = problems::damped_spring(1.0, 1.0, 1.0).unwrap();
        let mut state = problem.state.clone();
        let mut stepper = scheme
            .start(&mut problem.system, &state, 0.01, Start::FirstOrder)
            .unwrap();
        let mut sum = 0.0;
        for _ in 0..1000 {
            stepper.step(&mut problem.system, &mut state).unwrap();
            sum += 0.01;
        }
        let t = if scheme == Scheme::Report { sum } else { 10.0 };
        assert!(
            state.t.to_bits() == f64::to_bits(t) && state.step == 1000,
            "{scheme} {}",
            state.t
        );
    }
}

#[test]
fn held_nodes_never_move() {
    for &scheme in Scheme::ALL {
        let mut problem = problems::chain(6, 1.0, 1.0, 1.0).unwrap();
        let mut band = problem.system.stiffness().band().clone();
        problem.system.held[2] = true;
        problem.system.held[5] = true;
        band.hold(&problem.system.held);
        problem.system.set_stiffness(banded::Operator::from(band));
        problem.system.gravity = DVec2::new(0.0, 1.0);
        problem.system.pull = 0.3;
        let mut state = problem.state.clone();
        let mut stepper = scheme
            .start(&mut problem.system, &state, 0.1, Start::SecondOrder)
            .unwrap();
        for _ in 0..50 {
            stepper.step(&mut problem.system, &mut state).unwrap();
        }
        for (i, held) in problem.system.held.iter().enumerate() {
            assert!(
                *held == (state.x[i] == problem.state.x[i]),
                "{scheme}, node {i}"
            );
        }
    }
}

#[test]
fn every_underdamped_mode_dies_at_the_same_rate() {
    // D27: amplitudes fall as exp(−γ t/2μ) however stiff the mode, and so does a free drift, twice as fast
    let (mass, damping, end) = (1.5, 0.3, 20.0);
    for stiffness in [4.0, 100.0, 2500.0] {
        let mut problem = problems::damped_spring(mass, damping, stiffness).unwrap();
        let mut state = problem.state.clone();
        let energy = |state: &crate::State| {
            let x = state.x[0];
            0.5 * stiffness * x.length_squared() + 0.5 * mass * state.v[0].length_squared()
        };
        let start = energy(&state);
        let mut stepper = Scheme::Leapfrog
            .start(&mut problem.system, &state, 1e-3, Start::SecondOrder)
            .unwrap();
        while state.t < end {
            stepper.step(&mut problem.system, &mut state).unwrap();
        }
        let rate = -(energy(&state) / start).ln() / end;
        // the energy wavers by γ/2√(μλ) about its mean: 6 % at most, over 20 time units
        assert!((rate - damping / mass).abs() < 0.004, "{stiffness}: {rate}");
    }
    let mut problem = problems::free_fall(mass, damping, DVec2::ZERO).unwrap();
    let mut state = problem.state.clone();
    let mut stepper = Scheme::Leapfrog
        .start(&mut problem.system, &state, 1e-3, Start::SecondOrder)
        .unwrap();
    while state.t < end {
        stepper.step(&mut problem.system, &mut state).unwrap();
    }
    let left = (-damping / mass * end).exp();
    assert!(
        (state.v[1].y + left).abs() < 1e-6,
        "translation is stopped as well: {}",
        state.v[1]
    );
}

/// A spring whose stiffness, mass and damping change at t = 1.
struct Stiffening {
    now: Springs,
    later: Springs,
    revision: u64,
}

impl System for Stiffening {
    fn len(&self) -> usize {
        3
    }
    fn mass(&self) -> &[f64] {
        self.now.mass()
    }
    fn damping(&self) -> &[f64] {
        self.now.damping()
    }
    fn held(&self) -> &[bool] {
        self.now.held()
    }
    fn stiffness(&self) -> &banded::Operator {
        self.now.stiffness()
    }
    fn advance(&mut self, t: f64, _: &[DVec2]) {
        // steps of 1/1024 meet the time exactly
        if t >= 1.0 && self.revision == 0 {
            self.revision = 1;
            std::mem::swap(&mut self.now, &mut self.later);
        }
    }
    fn revision(&self) -> u64 {
        self.revision
    }
    fn elastic(&mut self, x: &[DVec2], force: &mut [DVec2]) {
        self.now.elastic(x, force);
    }
    fn external(
        &mut self,
        t: f64,
        x: &[DVec2],
        v: &[DVec2],
        force: &mut [DVec2],
    ) -> Result<(), Fault> {
        self.now.external(t, x, v, force)
    }
    fn external_slope(&mut self, t: f64, x: &[DVec2], slope: &mut [DMat2]) -> bool {
        self.now.external_slope(t, x, slope)
    }
}

#[test]
fn schedules_reach_every_scheme() {
    let dt = 1.0 / 1024.0;
    for &scheme in Scheme::ALL {
        let first = problems::shared_spring(1.0, 0.5, 4.0, 0.25).unwrap();
        let second = problems::shared_spring(2.0, 1.5, 30.0, 0.25).unwrap();
        let mut system = Stiffening {
            now: first.system,
            later: second.system,
            revision: 0,
        };
        let mut state = first.state.clone();
        let mut stepper = scheme
            .start(&mut system, &state, dt, Start::SecondOrder)
            .unwrap();
        while state.t < 2.0 {
            stepper.step(&mut system, &mut state).unwrap();
        }
        let expected = if scheme == Scheme::GradientFlow {
            first.state.x[0].x * f64::exp(-4.0 / 0.5 - 30.0 / 1.5)
        } else {
            let middle = (first.exact)(1.0);
            let [(u, _), (w, _)] = problems::spring_motion(2.0, 1.5, 30.0, 1.0);
            u * middle.x[0].x + w * middle.v[0].x
        };
        // first order schemes are off by some dt
        assert!(
            (state.x[0].x - expected).abs() < 1e-2,
            "{scheme}: {} {expected}",
            state.x[0].x
        );
        assert_eq!(system.revision, 1);
    }
}

#[test]
fn the_same_steps_give_the_same_bytes() {
    for &scheme in Scheme::ALL {
        let run = || {
            let mut problem = problems::ring(16, 1.0, 0.5, [0.2, 1.0, 0.1]).unwrap();
            problem.system.pull = 0.1;
            let mut state = problem.state.clone();
            let mut stepper = scheme
                .start(&mut problem.system, &state, 0.05, Start::SecondOrder)
                .unwrap();
            for _ in 0..100 {
                stepper.step(&mut problem.system, &mut state).unwrap();
            }
            state
        };
        assert_eq!(run(), run(), "{scheme}");
    }
}
