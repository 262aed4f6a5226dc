//! Elasticity above the second order is part of the body: in its matrix, its frame, its account.
#![allow(clippy::unwrap_used, reason = "a test may stop")]

use std::f64::consts::{PI, TAU};

use elastic::{End, Material, Profile, Topology};
use glam::DVec2;
use integrator::{Scheme, Start, State, System};
use snake::{Body, Certificate, Frame, Ledger, Schedule, Snake, Tips, Turning, World};

const N: usize = 40;
const WEIGHTS: [f64; 5] = [0.0, 0.5, 0.4, 0.3, 0.2];

/// A ring with weights of the orders 0 to 4.
fn ring(weights: [f64; 5]) -> Body {
    let nodes = elastic::circle(DVec2::ZERO, N as f64 / TAU, N);
    let [tether, tension, rigidity, third, fourth] = weights;
    Body::of(&nodes, Topology::Closed, 1.0)
        .unwrap()
        .with_material(
            Material::uniform(tether, tension, rigidity)
                .with_higher(vec![third.into(), fourth.into()]),
        )
}

/// λ of a wave about the ring: Σ ωₘ (4 sin² θ/2 / h²)ᵐ.
fn stiffness(body: &Body, weights: [f64; 5], wave: f64) -> f64 {
    let s = (2.0 * (PI * wave / N as f64).sin() / body.spacing).powi(2);
    weights.iter().rev().fold(0.0, |sum, w| w + s * sum)
}

/// The ring deformed by one of its waves.
fn bent(body: &Body, wave: f64, size: f64) -> State {
    let place = |(i, r): (usize, &DVec2)| {
        *r + size * DVec2::new((TAU * wave * i as f64 / N as f64).cos(), 0.0)
    };
    State::at_rest(body.rest.iter().enumerate().map(place).collect())
}

/// How far a run of that scheme is from the exact swing at its end.
fn off(scheme: Scheme, dt: f64, steps: u32, wave: f64) -> f64 {
    let body = ring(WEIGHTS);
    let omega = stiffness(&body, WEIGHTS, wave).sqrt();
    let mut state = bent(&body, wave, 0.1);
    let mut snake = Snake::new(body.clone(), World::default()).unwrap();
    let mut stepper = scheme
        .start(&mut snake, &state, dt, Start::SecondOrder)
        .unwrap();
    for _ in 0..steps {
        stepper.step(&mut snake, &mut state).unwrap();
    }
    let exact = bent(&body, wave, 0.1 * (omega * state.t).cos());
    let far = |(a, b): (&DVec2, &DVec2)| a.distance(*b);
    state.x.iter().zip(&exact.x).map(far).fold(0.0, f64::max)
}

#[test]
fn every_limit_is_that_of_the_stiffest_wave_of_all_orders() {
    let body = ring(WEIGHTS);
    let lambda = stiffness(&body, WEIGHTS, N as f64 / 2.0);
    let snake = Snake::new(body, World::default()).unwrap();
    let limit = Scheme::Leapfrog.step_limit(&snake).unwrap();
    assert!((limit / (2.0 / lambda.sqrt()) - 1.0).abs() < 1e-9);
    let certificate = Certificate::of(&snake, None);
    assert!((certificate.elastic / lambda.sqrt() - 1.0).abs() < 1e-9);
    assert!(certificate.complete && certificate.modes.len() == N);
    for (scheme, limit) in certificate.steps {
        let implicit = matches!(
            scheme,
            Scheme::Imex | Scheme::Newmark | Scheme::Gauss4 | Scheme::Radau5 | Scheme::Exact
        );
        assert!(!implicit || limit.is_none(), "{scheme:?}: {limit:?}");
    }
}

#[test]
fn one_exact_step_of_any_length_is_the_closed_form() {
    for wave in [2.0, 5.0, 20.0] {
        for dt in [0.1, 3.0, 100.0] {
            // frequencies are right to 1e-15 of the largest, which is 8 here, over a time of 100
            assert!(off(Scheme::Exact, dt, 1, wave) < 1e-13, "{wave} {dt}");
        }
    }
}

#[test]
fn implicit_schemes_take_steps_far_beyond_the_explicit_limit() {
    let body = ring(WEIGHTS);
    let mut snake = Snake::new(body.clone(), World::default()).unwrap();
    let dt = 50.0 * Scheme::Leapfrog.step_limit(&snake).unwrap();
    for scheme in [
        Scheme::Imex,
        Scheme::BackwardEuler,
        Scheme::LinearlyImplicit,
        Scheme::Newmark,
        Scheme::Gauss4,
        Scheme::Radau5,
        Scheme::Exact,
    ] {
        // the stiffest wave on top of a long one
        let mut state = bent(&body, 2.0, 0.1);
        for (i, x) in state.x.iter_mut().enumerate() {
            x.y += if i % 2 == 0 { 0.05 } else { -0.05 };
        }
        let before = snake.energies(&state).mechanical();
        let mut stepper = scheme
            .start(&mut snake, &state, dt, Start::SecondOrder)
            .unwrap();
        for _ in 0..300 {
            stepper.step(&mut snake, &mut state).unwrap();
        }
        let after = snake.energies(&state).mechanical();
        // none of these puts energy into a linear system; Newmark's and Gauss' keep it but for rounding
        assert!(
            after < before * (1.0 + 1e-9),
            "{scheme:?}: {after} of {before}"
        );
    }
    let mut state = bent(&body, 20.0, 1e-6);
    let started = Scheme::Leapfrog.start(&mut snake, &state, dt, Start::SecondOrder);
    let grown = started.is_err() || {
        let mut stepper = started.unwrap();
        (0..20).any(|_| stepper.step(&mut snake, &mut state).is_err())
            || snake.energies(&state).mechanical() > 1.0
    };
    assert!(grown, "the explicit one does not");
}

#[test]
fn every_scheme_keeps_its_order_with_orders_above_the_second_in_the_matrix() {
    for (scheme, order, steps) in [
        (Scheme::Leapfrog, 2.0, 400),
        (Scheme::Newmark, 2.0, 100),
        (Scheme::Gauss4, 4.0, 20),
        (Scheme::Radau5, 5.0, 20),
    ] {
        let error = |steps: u32| off(scheme, 20.0 / f64::from(steps), steps, 4.0);
        let measured = (error(steps) / error(2 * steps)).log2();
        assert!((measured - order).abs() < 0.15, "{scheme:?}: {measured}");
    }
}

#[test]
fn a_rest_shape_that_turns_takes_them_with_it() {
    let mut body = ring([0.1, 0.5, 0.4, 0.3, 0.2]).with_frame(Frame::turning());
    for (i, r) in body.rest.iter_mut().enumerate() {
        *r *= 1.0 + 0.2 * (TAU * 3.0 * i as f64 / N as f64).cos();
    }
    body.recenter().unwrap();
    let mut snake = Snake::new(body.clone(), World::default()).unwrap();
    let turn = DVec2::from_angle(1.1);
    let turned = |state: &State| {
        State::at_rest(
            state
                .x
                .iter()
                .map(|x| DVec2::ONE + turn.rotate(*x))
                .collect(),
        )
    };
    let rest = turned(&State::at_rest(body.rest.clone()));
    assert!((snake.angle(&rest.x) - 1.1).abs() < 1e-12);
    assert!(snake.energies(&rest).elastic() < 1e-20);
    // a turned start gives the turned run
    let mut first = bent(&body, 4.0, 0.3);
    let mut second = turned(&first);
    for state in [&mut first, &mut second] {
        let mut stepper = Scheme::Newmark
            .start(&mut snake, state, 0.05, Start::SecondOrder)
            .unwrap();
        for _ in 0..100 {
            stepper.step(&mut snake, state).unwrap();
        }
    }
    let again = turned(&first);
    for (a, b) in again.x.iter().zip(&second.x) {
        assert!(a.distance(*b) < 1e-10);
    }
    // and so does the frame with an equation of its own, against the fit
    let body = ring([0.1, 0.5, 0.4, 0.3, 0.2]).with_frame(Frame::turning());
    let mut fit = Snake::new(body.clone(), World::default()).unwrap();
    let mut own = Turning::new(&fit).unwrap();
    let mut state = bent(&body, 3.0, 0.2);
    for (v, x) in state.v.iter_mut().zip(&state.x) {
        *v = 0.1 * x.perp();
    }
    let mut inside = own.enter(&state);
    let systems: [(&mut dyn System, &mut State); 2] =
        [(&mut fit, &mut state), (&mut own, &mut inside)];
    for (system, state) in systems {
        let mut stepper = Scheme::Rk4
            .start(system, state, 0.01, Start::SecondOrder)
            .unwrap();
        for _ in 0..300 {
            stepper.step(system, state).unwrap();
        }
    }
    for (a, b) in own.leave(&inside).x.iter().zip(&state.x) {
        assert!(a.distance(*b) < 1e-6, "{a} {b}");
    }
}

#[test]
fn a_schedule_hardens_them_and_the_account_knows() {
    let mut body = ring(WEIGHTS).with_damping(0.05);
    body.schedules.higher = Some(Schedule::new(vec![(0.0, 1.0), (2.0, 3.0)]).unwrap());
    let mut state = bent(&body, 4.0, 0.3);
    let mut snake = Snake::new(body, World::default()).unwrap();
    let entry = |snake: &Snake| snake.stiffness().band().entry(0, 4);
    let soft = entry(&snake);
    let mut ledger = Ledger::begin(&mut snake, &state).unwrap();
    let begin = ledger.energies(&mut snake, &state);
    let mut stepper = Scheme::Newmark
        .start(&mut snake, &state, 1e-3, Start::SecondOrder)
        .unwrap();
    for _ in 0..3000 {
        stepper.step(&mut snake, &mut state).unwrap();
        ledger.book(&mut snake, &state).unwrap();
    }
    assert!((entry(&snake) / soft - 3.0).abs() < 1e-12);
    let end = ledger.energies(&mut snake, &state);
    assert!(end.higher.unwrap() > 0.0 && end.parameters < 0.0);
    // second order at 40 steps the fastest swing that is excited
    let size = begin.total().abs();
    assert!((end.total() - begin.total()).abs() < 1e-5 * size);
    let names = snake::Energies::names(&snake);
    assert_eq!(names[4], "higher");
    assert_eq!(names.len(), end.values().len());
}

#[test]
fn ends_of_every_kind_hold_them_and_free_ones_grow() {
    let strip = elastic::segment(DVec2::ZERO, DVec2::new(19.0, 0.0), 20);
    let third = Material::uniform(0.0, 0.0, 0.0).with_higher(vec![Profile::Uniform(1.0)]);
    let parabola = |x: &DVec2| *x + DVec2::new(0.0, 0.01 * x.x * x.x);
    for (end, costs) in [
        (End::Free, false),
        (End::Pinned, false),
        (End::Clamped, true),
        (End::Anchored, true),
    ] {
        let body = Body::of(&strip, Topology::open(end), 1.0).unwrap();
        let mut snake = Snake::new(body.with_material(third.clone()), World::default()).unwrap();
        let mut state = State::at_rest(strip.iter().map(parabola).collect());
        // order 3 is blind to a parabola; a vice or an anchor is not
        let energy = snake.energies(&state).elastic();
        assert_eq!(energy > 1e-6, costs, "{end:?}: {energy}");
        let mut stepper = Scheme::Newmark
            .start(&mut snake, &state, 0.5, Start::SecondOrder)
            .unwrap();
        for _ in 0..100 {
            stepper.step(&mut snake, &mut state).unwrap();
        }
        let after = snake.energies(&state).mechanical();
        assert!((after - energy).abs() < 1e-9 * (1.0 + energy), "{end:?}");
    }
    let body = Body::of(&strip, Topology::open(End::Free), 1.0).unwrap();
    let snake = Snake::new(body.with_material(third), World::default()).unwrap();
    // a ridge along the x axis, as long as the map
    let ridge = field::Grid::from_shape_fn((9, 40), |(y, _)| 1.0 - (y as f64 - 4.0).abs() / 4.0);
    let mut tips = Tips::new(ridge.into(), 0.5, 24, false, true);
    let state = State::at_rest(strip.iter().map(|x| *x + DVec2::new(3.0, 4.0)).collect());
    let (grown, longer) = tips.grow(&snake, &state).unwrap().unwrap();
    assert_eq!((longer.len(), grown.body().len()), (21, 21));
    assert_eq!(grown.body().material, snake.body().material);
    assert_eq!(grown.stiffness().band().half_width(), 3);
}
