//! The equations of a frame that turns: report Eq. 5.2 to 5.4, term by term.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a snake that cannot be built should stop it"
)]

use std::f64::consts::TAU;

use crate::spin::{N, body, farthest, go, spinning};
use elastic::{BestFit, Material, Profile, Topology};
use glam::DVec2;
use integrator::{Scheme, Start, State};
use snake::{Body, Frame, Snake, SnakeError, Term, Turning, World};
use {banded as _, field as _, outline as _, proptest as _, thiserror as _};

#[test]
fn the_equations_of_the_turning_frame_give_the_motion_of_the_best_fit() {
    let body = body(Frame::turning());
    let snake = Snake::new(
        body.clone(),
        World::default().with_gravity(DVec2::new(0.0, 0.05)),
    )
    .unwrap();
    let run = |steps: u64| {
        let dt = 6.0 / steps as f64;
        let start = spinning(&body, 0.9, 0.1);
        let mut state = start.clone();
        go(&mut snake.clone(), &mut state, Scheme::Rk4, dt, steps);
        let mut turning = Turning::new(&snake).unwrap();
        let mut framed = turning.enter(&start);
        assert!(farthest(&turning.leave(&framed).x, &start.x) < 1e-12);
        assert!(farthest(&turning.leave(&framed).v, &start.v) < 1e-12);
        go(&mut turning, &mut framed, Scheme::Rk4, dt, steps);
        let space = turning.leave(&framed);
        let angle = turning.angle(&framed) - snake.angle(&state.x);
        let angle = angle - TAU * (angle / TAU).round();
        (farthest(&space.x, &state.x), angle.abs(), space)
    };
    let (coarse, fine) = (run(400), run(800));
    assert!(fine.0 < 1e-5 && fine.1 < 1e-6);
    assert!((coarse.0 / fine.0).log2() > 3.6);
    // the fit by mass of the same curve is near, not the same: the curve is deformed by a tenth
    let by_mass = BestFit::new(&body.rest, &fine.2.x, &body.mass).angle;
    let near = (by_mass - snake.angle(&fine.2.x)).abs();
    assert!(near < 0.05, "{near}");
}

#[test]
fn the_turning_frame_keeps_its_order_under_every_scheme_with_mass() {
    // inertial forces depend on velocities, which leapfrog and Newmark's method see half a step early
    let body = body(Frame::turning());
    let snake = Snake::new(body.clone().with_damping(0.1), World::default()).unwrap();
    let start = spinning(&body, 0.9, 0.1);
    let end = |scheme: Scheme, steps: u64| {
        let mut turning = Turning::new(&snake).unwrap();
        let mut state = turning.enter(&start);
        go(&mut turning, &mut state, scheme, 2.0 / steps as f64, steps);
        turning.leave(&state)
    };
    let truth = end(Scheme::DormandPrince { tolerance: 1e-12 }, 20);
    for (scheme, order) in [
        (Scheme::Leapfrog, 1.0),
        (Scheme::Newmark, 1.0),
        (Scheme::Rk4, 4.0),
        (Scheme::Gauss4, 4.0),
        (Scheme::Sbdf2, 2.0),
        (Scheme::BackwardEuler, 1.0),
    ] {
        let error = |steps| farthest(&end(scheme, steps).x, &truth.x);
        let (coarse, fine) = (error(200), error(400));
        let found = (coarse / fine).log2();
        assert!(found > order - 0.3, "{}: {found}", scheme.name());
    }
}

#[test]
fn the_second_equation_holds_as_it_stands() {
    // d/dt (I ω + Σ μ q × ė) + Σ γ q × v = Σ q × f: what is left of it over the run is of the scheme's order
    let body = body(Frame::turning()).with_damping(0.3);
    let snake = Snake::new(body.clone(), World::default()).unwrap();
    let left = |steps: u64| {
        let mut turning = Turning::new(&snake).unwrap();
        let mut state = turning.enter(&spinning(&body, 0.9, 0.1));
        let dt = 5.0 / steps as f64;
        let spin = |state: &State| {
            (0..N)
                .map(|i| {
                    let (q, e) = (state.x[i], state.v[i]);
                    body.mass.at(i) * q.perp_dot(state.v[N + 1].x * q.perp() + e)
                })
                .sum::<f64>()
        };
        let drag = |state: &State| {
            let back = DVec2::from_angle(-state.x[N + 1].x).rotate(state.v[N]);
            (0..N)
                .map(|i| {
                    let q = state.x[i];
                    0.3 * q.perp_dot(back + state.v[N + 1].x * q.perp() + state.v[i])
                })
                .sum::<f64>()
        };
        // Simpson's rule over pairs of steps
        let mut lost = 0.0;
        let begin = spin(&state);
        let mut stepper = Scheme::Rk4
            .start(&mut turning, &state, dt, Start::SecondOrder)
            .unwrap();
        for _ in 0..steps / 2 {
            let first = drag(&state);
            stepper.step(&mut turning, &mut state).unwrap();
            let middle = drag(&state);
            stepper.step(&mut turning, &mut state).unwrap();
            lost += dt / 3.0 * (first + 4.0 * middle + drag(&state));
        }
        ((spin(&state) + lost - begin) / begin).abs()
    };
    let (coarse, fine) = (left(400), left(800));
    assert!(fine < 1e-7, "{fine}");
    assert!((coarse / fine).log2() > 3.6, "{coarse} {fine}");
}

/// A ring of 16 equal nodes of radius 1, and the stiffness of its waves of that number.
fn ring() -> (Snake, impl Fn(f64) -> f64) {
    let n = 16;
    let nodes = elastic::circle(DVec2::ZERO, 1.0, n);
    let (tether, tension, rigidity) = (2.0, 1.0, 0.05);
    let body = Body::of(&nodes, Topology::Closed, 1.0)
        .unwrap()
        .with_material(Material::uniform(tether, tension, rigidity));
    let h = body.spacing;
    let stiffness = move |wave: f64| {
        let s = 4.0 * (0.5 * TAU * wave / n as f64).sin().powi(2) / (h * h);
        tether + tension * s + rigidity * s * s
    };
    (Snake::new(body, World::default()).unwrap(), stiffness)
}

/// The ring at radius `rho`, its frame turning at ω, with the wave `amplitude · e^{i wave φ}` that swings at `rate`.
fn waving(rho: f64, omega: f64, wave: f64, amplitude: f64, rate: f64) -> State {
    let n = 16;
    let angle = |i: usize| TAU * i as f64 / n as f64;
    let mut state = State::at_rest(
        (0..n)
            .map(|i| {
                rho * DVec2::from_angle(angle(i)) + amplitude * DVec2::from_angle(wave * angle(i))
            })
            .collect(),
    );
    for i in 0..n {
        state.v[i] = rate * amplitude * DVec2::from_angle(wave * angle(i)).perp();
    }
    state.x.extend([DVec2::ZERO; 2]);
    state.v.extend([DVec2::ZERO, DVec2::new(omega, 0.0)]);
    state
}

#[test]
fn a_spinning_ring_widens_by_the_formula_and_without_the_centrifugal_force_not_at_all() {
    // μ ω² ρ = λ (ρ − 1), λ that of the ring's own wave
    let (snake, stiffness) = ring();
    let (omega, lambda) = (0.8, stiffness(1.0));
    let wide = lambda / (lambda - omega * omega);
    assert!(wide > 1.2, "{wide}");
    for (turning, rho) in [
        (Turning::new(&snake).unwrap(), wide),
        (
            Turning::new(&snake).unwrap().without(Term::Centrifugal),
            1.0,
        ),
    ] {
        let mut turning = turning;
        let mut state = waving(rho, omega, 2.0, 0.0, 0.0);
        go(&mut turning, &mut state, Scheme::Rk4, 0.01, 2000);
        for q in &state.x[..16] {
            // an equilibrium stays one, up to rounding
            assert!((q.length() - rho).abs() < 1e-11, "{} {rho}", q.length());
        }
        assert!((turning.angle(&state) - omega * 20.0).abs() < 1e-10);
    }
    // and in space, by the best fit: the same widened ring spins for ever
    let mut body = snake.body().clone();
    body.frame = Frame::turning();
    let mut free = Snake::new(body, World::default()).unwrap();
    let mut state = State::at_rest(waving(wide, omega, 2.0, 0.0, 0.0).x[..16].to_vec());
    for i in 0..16 {
        state.v[i] = omega * state.x[i].perp();
    }
    go(&mut free, &mut state, Scheme::Rk4, 0.01, 2000);
    for x in &state.x {
        // the scheme's fourth order: (0.01)⁴ times the time
        assert!((x.length() - wide).abs() < 1e-8, "{}", x.length());
    }
    assert!(
        ((free.angle(&state.x) - omega * 20.0) / TAU).fract().abs() < 1e-8
            || (1.0 - ((free.angle(&state.x) - omega * 20.0) / TAU).fract().abs()) < 1e-8
    );
}

#[test]
fn waves_on_a_spinning_ring_swing_at_the_rate_of_each_set_of_terms() {
    // z̈ + 2iω ż + (λ − ω²) z = 0 for a wave of two: z = a e^{ist}, each term left out when it is off
    let (snake, stiffness) = ring();
    let (omega, stiff) = (0.8, stiffness(2.0));
    for (coriolis, centrifugal) in [(true, true), (false, true), (true, false), (false, false)] {
        let mut turning = Turning::new(&snake).unwrap();
        let (mut half, mut square) = (omega, stiff - omega * omega);
        if !coriolis {
            turning = turning.without(Term::Coriolis);
            half = 0.0;
        }
        if !centrifugal {
            turning = turning.without(Term::Centrifugal);
            square = stiff;
        }
        let lambda = stiffness(1.0);
        let rho = if centrifugal {
            lambda / (lambda - omega * omega)
        } else {
            1.0
        };
        for sign in [-1.0, 1.0] {
            let rate = -half + sign * (half * half + square).sqrt();
            let (amplitude, time) = (1e-5, 10.0);
            let mut state = waving(rho, omega, 2.0, amplitude, rate);
            go(&mut turning, &mut state, Scheme::Rk4, 0.005, 2000);
            // the wave of two as it is now, its phase against that expected
            let z: DVec2 = (0..16)
                .map(|i| DVec2::from_angle(-TAU * i as f64 / 8.0).rotate(state.x[i]))
                .sum::<DVec2>()
                / 16.0;
            let off = DVec2::from_angle(-rate * time).rotate(z) - DVec2::new(amplitude, 0.0);
            // what is of second order in the amplitude, and of fourth in the step
            assert!(
                off.length() < 1e-3 * amplitude,
                "{coriolis} {centrifugal} {rate}: {off}"
            );
        }
    }
}

#[test]
fn without_the_coriolis_force_a_breathing_ring_forgets_its_angular_momentum() {
    let (snake, _) = ring();
    let spin = |state: &State| {
        let inertia: f64 = state.x[..16].iter().map(|q| q.length_squared()).sum();
        inertia * state.v[17].x
    };
    let breathe = |turning: &mut Turning| {
        let mut state = waving(1.3, 0.8, 2.0, 0.0, 0.0);
        let begin = spin(&state);
        let (mut slip, mut change) = (0.0_f64, 0.0_f64);
        let mut stepper = Scheme::Rk4
            .start(turning, &state, 0.01, Start::SecondOrder)
            .unwrap();
        for _ in 0..500 {
            stepper.step(turning, &mut state).unwrap();
            slip = slip.max((spin(&state) / begin - 1.0).abs());
            change = change.max((state.v[17].x / 0.8 - 1.0).abs());
        }
        (slip, change)
    };
    let (slip, change) = breathe(&mut Turning::new(&snake).unwrap());
    // the fourth order of the scheme; I ω is kept and ω is not
    assert!(slip < 1e-7 && change > 0.05, "{slip} {change}");
    let (slip, change) = breathe(&mut Turning::new(&snake).unwrap().without(Term::Coriolis));
    // no force along the ring is left: ω is kept and I ω is not
    assert!(change < 1e-10 && slip > 0.05, "{slip} {change}");
}

/// A constant torque about the origin: a force along the ring, in its place.
#[derive(Debug, Clone)]
struct Torque(f64);

impl snake::Force for Torque {
    fn name(&self) -> &'static str {
        "torque"
    }
    fn add(
        &mut self,
        curve: &snake::Curve<'_>,
        force: &mut [DVec2],
    ) -> Result<(), integrator::Fault> {
        for (force, x) in force.iter_mut().zip(curve.x) {
            *force += self.0 * x.normalize_or_zero().perp();
        }
        Ok(())
    }
    fn boxed(&self) -> Box<dyn snake::Force> {
        Box::new(self.clone())
    }
    fn as_any(&self) -> &dyn std::any::Any {
        self
    }
}

#[test]
fn a_torque_turns_the_frame_and_without_the_transverse_force_it_twists_the_body() {
    let (snake, stiffness) = ring();
    let (push, time) = (1e-4, 3.0_f64);
    let mut snake = snake;
    snake
        .set_world(World::default().with(Torque(push)))
        .unwrap();
    let twist = |state: &State| state.x[0].to_angle();
    let mut state = waving(1.0, 0.0, 2.0, 0.0, 0.0);
    let mut turning = Turning::new(&snake).unwrap();
    go(&mut turning, &mut state, Scheme::Rk4, 0.01, 300);
    // all of it goes to the frame: θ̈ = push, as a rigid ring of radius and mass one
    assert!((turning.angle(&state) - 0.5 * push * time * time).abs() < 1e-10);
    assert!(twist(&state).abs() < 1e-12);
    // α̈ = push − λ α in the body, θ̈ = λ α for the frame: nothing of the torque is lost
    let mut state = waving(1.0, 0.0, 2.0, 0.0, 0.0);
    let mut turning = turning.without(Term::Transverse);
    go(&mut turning, &mut state, Scheme::Rk4, 0.01, 300);
    let lambda = stiffness(1.0);
    let expected = push / lambda * (1.0 - (lambda.sqrt() * time).cos());
    assert!(
        (twist(&state) - expected).abs() < 1e-4 * expected,
        "{} {expected}",
        twist(&state)
    );
    let whole = turning.angle(&state) + twist(&state);
    assert!(
        (whole - 0.5 * push * time * time).abs() < 1e-4 * whole,
        "{whole}"
    );
}

#[test]
fn what_a_turning_frame_cannot_carry_is_refused() {
    let bare = Body::of(&body(Frame::turning()).rest, Topology::Closed, 1.0).unwrap();
    let refused = |body: Body| {
        let snake = Snake::new(body, World::default()).unwrap();
        Turning::new(&snake).unwrap_err()
    };
    let error = refused(bare.clone());
    assert_eq!(
        error,
        SnakeError::NotInTurningFrame {
            needed: "some elasticity"
        }
    );
    let mut report = body(Frame::report());
    report.recenter().unwrap();
    assert!(matches!(
        refused(report),
        SnakeError::NotInTurningFrame { .. }
    ));
    let mut body = body(Frame::turning());
    body.mass = Profile::Uniform(0.0);
    let error = refused(body);
    assert!(error.to_string().contains("mass"), "{error}");
}
