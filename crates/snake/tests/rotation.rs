//! A body frame that turns: report §5.2, by the best fit and by its own equations.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a snake that cannot be built should stop it"
)]

use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::sync::Arc;

use elastic::{BestFit, Material, Motion, Profile, Topology};
use field::{EdgeForce, ForceField, Grid, Smoothing, edge_force};
use glam::DVec2;
use integrator::{Scheme, Start, State, System};
use snake::{
    Body, Frame, Ledger, Sampling, Snake, SnakeError, Term, Turn, Turning, Until, World, run,
};
use {banded as _, proptest as _, thiserror as _};

const N: usize = 24;

/// A lopsided closed body whose mass and material differ from node to node.
fn body(frame: Frame) -> Body {
    let nodes = elastic::ellipse(DVec2::new(3.0, -2.0), DVec2::new(5.0, 3.0), 0.3, N);
    let wave = |by: f64| Profile::PerNode((0..N).map(|i| 1.0 + by * (i as f64).sin()).collect());
    let mut body = Body::of(&nodes, Topology::Closed, 1.0)
        .unwrap()
        .with_material(Material {
            tether: wave(0.3).scaled(0.5),
            tension: wave(0.2).scaled(2.0),
            rigidity: wave(-0.4),
        })
        .with_frame(frame);
    body.mass = wave(0.5);
    body.recenter().unwrap();
    body
}

/// The body at rest in its shape but for a wave through it, flying and spinning.
fn spinning(body: &Body, omega: f64, wave: f64) -> State {
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

fn go(system: &mut dyn System, state: &mut State, scheme: Scheme, dt: f64, steps: u64) {
    let mut stepper = scheme.start(system, state, dt, Start::SecondOrder).unwrap();
    for _ in 0..steps {
        stepper.step(system, state).unwrap();
    }
}

fn farthest(a: &[DVec2], b: &[DVec2]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| a.distance(*b))
        .fold(0.0, f64::max)
}

fn turned(state: &State, by: DVec2) -> State {
    State {
        x: state.x.iter().map(|&p| by.rotate(p)).collect(),
        v: state.v.iter().map(|&p| by.rotate(p)).collect(),
        ..state.clone()
    }
}

#[test]
fn a_rigid_rotation_costs_nothing_where_the_frame_turns() {
    let state = turned(
        &spinning(&body(Frame::turning()), 0.0, 0.0),
        DVec2::from_angle(2.5),
    );
    for (frame, free) in [(Frame::turning(), true), (Frame::corrected(), false)] {
        let mut snake = Snake::new(body(frame), World::default()).unwrap();
        let energy = snake.energies(&state).elastic();
        let mut force = vec![DVec2::ZERO; N];
        snake.strain_force(&state.x, &mut force);
        let strongest = force.iter().map(|f| f.length()).fold(0.0, f64::max);
        // stiffnesses of some tens and places of 50: rounding of 1e-12
        assert_eq!(strongest < 1e-11, free, "{strongest}");
        assert_eq!(energy < 1e-20, free, "{energy}");
        let mut e = vec![DVec2::ZERO; N];
        snake.deformation_into(&state.x, &mut e);
        assert_eq!(elastic::rms(&e) < 1e-12, free);
    }
}

#[test]
fn the_force_of_a_turning_rest_shape_is_minus_the_gradient_of_the_least_energy() {
    let body = body(Frame::turning());
    let h = body.spacing;
    let mut state = turned(&spinning(&body, 0.0, 0.2), DVec2::from_angle(1.0));
    let mut snake = Snake::new(body, World::default()).unwrap();
    let mut force = vec![DVec2::ZERO; N];
    snake.strain_force(&state.x, &mut force);
    let center = snake.center(&state.x);
    let arms = state.x.iter().zip(&force);
    let torque: f64 = arms.map(|(x, f)| (*x - center).perp_dot(*f)).sum();
    let sum: DVec2 = force.iter().sum();
    // sums of 24 forces of up to 100 with arms of up to 6
    assert!(
        torque.abs() < 1e-10 && sum.length() < 1e-11,
        "{torque} {sum}"
    );
    for (i, direction) in [(0, DVec2::X), (5, DVec2::Y), (17, DVec2::new(0.6, 0.8))] {
        let step = 1e-4;
        let mut energy = |by: f64| {
            let place = state.x[i];
            state.x[i] += by * direction;
            let energy = snake.energies(&state).elastic();
            state.x[i] = place;
            energy
        };
        let slope = (energy(step) - energy(-step)) / (2.0 * step);
        let found = force[i].dot(direction);
        // the third derivative times step², and rounding over step: 1e-7 of forces of order ten
        assert!(
            (found + slope / h).abs() < 1e-6 * (1.0 + found.abs()),
            "{found} {slope}"
        );
    }
}

#[test]
fn a_turning_body_resists_no_more_than_one_that_does_not() {
    // its energy is K's less something convex: the step limit of K is enough
    let body = body(Frame::turning());
    let mut state = spinning(&body, 2.0, 0.3);
    let mut snake = Snake::new(body, World::default()).unwrap();
    let dt = 0.98 * Scheme::Leapfrog.step_limit(&snake).unwrap();
    let start = snake.energies(&state).total();
    go(&mut snake, &mut state, Scheme::Leapfrog, dt, 4000);
    let end = snake.energies(&state).total();
    assert!(end < 3.0 * start, "{start} {end}");
}

/// Drift of energy and angular momentum over one free turn, each relative.
fn drift(scheme: Scheme, steps: u64) -> (f64, f64) {
    let body = body(Frame::turning());
    let omega = 0.7;
    let mut state = spinning(&body, omega, 0.1);
    let mut snake = Snake::new(body.clone(), World::default()).unwrap();
    let mut ledger = Ledger::begin(&mut snake, &state).unwrap();
    let spin =
        |state: &State| Motion::of(&state.x, &state.v, &body.mass, body.spacing).angular_momentum;
    let (energy, momentum) = (snake.energies(&state).total(), spin(&state));
    let dt = TAU / omega / steps as f64;
    let mut stepper = scheme
        .start(&mut snake, &state, dt, Start::SecondOrder)
        .unwrap();
    let (mut gap, mut slip) = (0.0_f64, 0.0_f64);
    for _ in 0..steps {
        stepper.step(&mut snake, &mut state).unwrap();
        ledger.book(&mut snake, &state).unwrap();
        let total = ledger.energies(&mut snake, &state).total();
        gap = gap.max((total - energy).abs() / energy);
        slip = slip.max((spin(&state) - momentum).abs() / momentum);
    }
    (gap, slip)
}

#[test]
fn a_free_spinning_snake_keeps_energy_and_angular_momentum_to_the_order_of_its_scheme() {
    for (scheme, order, most) in [
        (Scheme::Leapfrog, 2.0, 1e-3),
        (Scheme::Rk4, 4.0, 1e-6),
        (Scheme::Newmark, 2.0, 1e-2),
        (Scheme::Sbdf2, 2.0, 3e-2),
        // most of the wave is gone after a turn, so it is not yet in proportion to the step
        (Scheme::Imex, 0.9, 0.5),
        (Scheme::Gauss4, 4.0, 1e-6),
        (Scheme::Exact, 2.0, 1e-2),
    ] {
        let (coarse, fine) = (drift(scheme, 800), drift(scheme, 1600));
        let name = scheme.name();
        assert!(fine.0 < most && fine.1 < most, "{name}: {fine:?}");
        let found = (coarse.0 / fine.0).log2();
        // the largest gap need not fall at the same time in both runs
        assert!(
            found > order - 0.35 || fine.0 < 1e-11,
            "{name}: energy of order {found}"
        );
        let found = (coarse.1 / fine.1).log2();
        // where the scheme keeps it exactly what is left is rounding
        assert!(
            found > order - 0.35 || fine.1 < 1e-11,
            "{name}: momentum of order {found}"
        );
    }
}

#[test]
fn a_turned_start_gives_the_turned_run() {
    let body = body(Frame::turning());
    let by = DVec2::from_angle(1.9);
    for scheme in [Scheme::Leapfrog, Scheme::Newmark, Scheme::Rk4] {
        let mut snake = Snake::new(body.clone(), World::default()).unwrap();
        let mut state = spinning(&body, 0.7, 0.1);
        let mut other = turned(&state, by);
        let limit = Scheme::Leapfrog.step_limit(&snake).unwrap();
        go(&mut snake, &mut state, scheme, 0.5 * limit, 500);
        go(&mut snake, &mut other, scheme, 0.5 * limit, 500);
        let apart = farthest(&turned(&state, by).x, &other.x);
        // rounding of places of 50 over 500 steps
        assert!(apart < 1e-9, "{}: {apart}", scheme.name());
        assert!(farthest(&state.x, &other.x) > 1.0);
    }
}

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

/// The force of a soft-edged ellipse of semi-axes 30 and 18, turned by that much, in a picture of 100 × 100.
fn oval(angle: f64) -> Arc<ForceField> {
    let back = DVec2::from_angle(-angle);
    let image = Grid::from_shape_fn((100, 100), |(y, x)| {
        let p = back.rotate(DVec2::new(x as f64, y as f64) - 49.5);
        let out = ((p / DVec2::new(30.0, 18.0)).length() - 1.0) * 22.0;
        140.0 / (1.0 + out.exp())
    });
    let rule = EdgeForce {
        smoothing: Smoothing::Gaussian(3.0),
        gain: 2.0,
    };
    Arc::new(edge_force(&image, &rule).unwrap())
}

#[test]
fn on_an_image_that_turns_the_turning_frame_stays_undeformed_and_the_other_does_not() {
    let follow = |frame: Frame, turn: f64| {
        let nodes = elastic::ellipse(DVec2::splat(49.5), DVec2::new(30.0, 18.0), 0.0, 60);
        let body = Body::of(&nodes, Topology::Closed, 1.0)
            .unwrap()
            .with_material(Material::uniform(0.05, 20.0, 60.0))
            .with_damping(0.5)
            .with_frame(frame);
        let world = World::default().with_image(oval(0.0), Sampling::Bilinear);
        let mut snake = Snake::new(body, world).unwrap();
        let mut state = State::at_rest(nodes);
        let dt = 0.1;
        let mut stepper = Scheme::Leapfrog
            .start(&mut snake, &state, dt, Start::SecondOrder)
            .unwrap();
        // a quarter of a turn in 90 pictures, twenty steps each
        let _ = run(
            &mut snake,
            &mut *stepper,
            &mut state,
            &Until::steps(6000),
            &mut |snake, state| {
                if state.step % 20 == 0 && state.step <= 1800 {
                    let angle = turn * state.step as f64 / 1800.0;
                    let world = World::default().with_image(oval(angle), Sampling::Bilinear);
                    return match snake.set_world(world) {
                        Ok(()) => ControlFlow::Continue(()),
                        Err(_) => ControlFlow::Break(()),
                    };
                }
                ControlFlow::Continue(())
            },
        );
        assert_eq!(state.step, 6000);
        let mut e = vec![DVec2::ZERO; 60];
        snake.deformation_into(&state.x, &mut e);
        (elastic::rms(&e), snake.angle(&state.x), state)
    };
    let (small, angle, state) = follow(Frame::turning(), 0.25 * TAU);
    let (still, _, _) = follow(Frame::turning(), 0.0);
    let (large, ..) = follow(Frame::corrected(), 0.25 * TAU);
    // a blurred edge lies a little inside its ellipse, and that much it is deformed on a still image too;
    // pixels are not the same in all directions
    assert!((small - still).abs() < 0.05 * still, "{small} {still}");
    assert!(large > 10.0 * still, "{large}");
    assert!((angle - 0.25 * TAU).abs() < 0.01, "{angle}");
    // the turning one is on the outline: its nodes at the long end are where the ellipse is now
    let ellipse = |state: &State| {
        let level = |x: &DVec2| ((*x - 49.5) / DVec2::new(18.0, 30.0)).length() - 1.0;
        state.x.iter().map(|x| level(x).abs()).fold(0.0, f64::max)
    };
    assert!(ellipse(&state) < 0.05);
}

#[test]
fn names_are_read_as_they_are_written_and_others_refused() {
    for turn in Turn::ALL {
        assert_eq!(turn.to_string().parse::<Turn>().unwrap(), *turn);
    }
    for term in Term::ALL {
        assert_eq!(term.to_string().parse::<Term>().unwrap(), *term);
    }
    let error = "euler".parse::<Term>().unwrap_err();
    assert!(error.to_string().contains("transverse"), "{error}");
    assert!("fits".parse::<Turn>().is_err());
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
