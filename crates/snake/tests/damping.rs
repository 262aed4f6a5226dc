//! Damping that the program chooses: report §3.4.2.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a snake that cannot be built should stop it"
)]

use std::sync::Arc;

use elastic::{Material, Motion, Profile, Topology};
use field::{EdgeForce, ForceField, Grid, Smoothing, edge_force};
use glam::DVec2;
use integrator::{Scheme, Start, State, System};
use snake::{
    Body, Certificate, Damping, Frame, Ledger, Rest, Sampling, Settling, Snake, SnakeError, Until,
    World,
};
use {banded as _, outline as _, proptest as _, thiserror as _};

/// The hard ball of chapter 2, let go squeezed: forty nodes, and a shape of 1.5 by 1.
fn ball() -> Settling {
    let nodes = elastic::ellipse(DVec2::ZERO, DVec2::new(1.5, 1.0), 0.0, 40);
    let body = Body::of(&nodes, Topology::Closed, 1.0)
        .unwrap()
        .with_material(Material::uniform(30.0, 300.0, 20.0));
    let squeezed = nodes.iter().map(|p| DVec2::new(0.7 * p.x, 1.2 * p.y));
    Settling {
        snake: Snake::new(body, World::default()).unwrap(),
        state: State::at_rest(squeezed.collect()),
        scheme: Scheme::Leapfrog,
        dt: 5e-4,
        until: Until::at_rest(Rest::default(), 400_000),
    }
}

/// A bright ellipse of semi-axes 40 and 25 with soft edges, in a picture of 128 × 96.
fn picture() -> Arc<ForceField> {
    let image = Grid::from_shape_fn((96, 128), |(y, x)| {
        let p = DVec2::new(x as f64 - 63.5, y as f64 - 47.5);
        let out = ((p / DVec2::new(40.0, 25.0)).length() - 1.0) * 31.0;
        120.0 / (1.0 + out.exp())
    });
    let rule = EdgeForce {
        smoothing: Smoothing::Gaussian(4.0),
        gain: 6.0,
    };
    Arc::new(edge_force(&image, &rule).unwrap())
}

/// A snake around that ellipse, six pixels outside.
fn fit() -> Settling {
    let nodes = elastic::ellipse(DVec2::new(64.5, 47.0), DVec2::new(46.0, 31.0), 0.0, 60);
    let body = Body::of(&nodes, Topology::Closed, 1.0)
        .unwrap()
        .with_material(Material::uniform(0.1, 40.0, 100.0));
    let world = World::default().with_image(picture(), Sampling::Bilinear);
    Settling {
        snake: Snake::new(body, world).unwrap(),
        state: State::at_rest(nodes),
        scheme: Scheme::Leapfrog,
        dt: 0.05,
        until: Until::at_rest(Rest::default(), 400_000),
    }
}

#[test]
fn a_rule_critical_for_the_slowest_mode_rests_as_soon_as_the_best_constant_found() {
    let ball = ball();
    let best = ball.best_constant(0.3, 300.0, 13).unwrap();
    let rows = ball
        .table(&[
            vec![Damping::Constant(0.2)],
            vec![Damping::Mode(0)],
            vec![Damping::Mode(4)],
            vec![Damping::Local],
            vec![Damping::InternalMode(0)],
            vec![Damping::InternalMode(4)],
        ])
        .unwrap();
    let rest = |i: usize| rows[i].time_to_rest();
    // rest is looked for at moments a fifth apart
    assert!(rest(1) < 1.5 * best.time, "{} {}", rest(1), best.time);
    // the ball as the report has it rings, and critical for a node alone creeps
    assert!(rest(0) > 5.0 * best.time && rest(3) > 3.0 * best.time);
}

#[test]
fn on_a_picture_the_rules_come_to_rest_on_the_same_outline() {
    let fit = fit();
    let best = fit.best_constant(0.02, 20.0, 13).unwrap();
    let rows = fit
        .table(&[
            vec![Damping::Constant(2.0)],
            vec![Damping::Mode(0)],
            vec![Damping::Local],
            vec![Damping::Renewed(1.0)],
            vec![Damping::Mode(0), Damping::InternalMode(3)],
        ])
        .unwrap();
    assert!(best.is_at_rest());
    for row in &rows {
        assert!(row.is_at_rest(), "{row}");
    }
    assert!(
        rows[1].time < 3.0 * best.time,
        "{} {}",
        rows[1].time,
        best.time
    );
}

#[test]
fn critical_for_a_mode_is_where_that_mode_no_longer_rings() {
    let mut ball = ball();
    let modes = Certificate::of(&ball.snake, None).modes;
    let resisting: Vec<_> = modes.iter().filter(|mode| mode.frequency > 0.0).collect();
    for k in [0, 4, 20] {
        ball.snake.damp(Damping::Mode(k), &ball.state).unwrap();
        let expected = 2.0 * resisting[k].frequency;
        assert!((ball.snake.damping()[0] / expected - 1.0).abs() < 1e-12);
        let ratio = Certificate::of(&ball.snake, None).modes;
        let own = ratio
            .iter()
            .filter(|mode| mode.frequency > 0.0)
            .nth(k)
            .unwrap();
        assert!((own.damping_ratio() - 1.0).abs() < 1e-9);
    }
    let error = ball.snake.damp(Damping::Mode(99), &ball.state).unwrap_err();
    assert!(
        matches!(error, SnakeError::NoMode { mode: 99, .. }),
        "{error}"
    );
}

#[test]
fn local_damping_is_critical_for_a_node_between_fixed_ones_and_on_the_edge_counts_its_slope() {
    let Settling {
        mut snake, state, ..
    } = fit();
    snake.set_world(World::default()).unwrap();
    snake.damp(Damping::Local, &state).unwrap();
    let h = snake.body().spacing;
    // the diagonal of K, written out
    let k = 0.1 + 2.0 * 40.0 / h.powi(2) + 6.0 * 100.0 / h.powi(4);
    for gamma in snake.damping() {
        assert!((gamma / (2.0 * k.sqrt()) - 1.0).abs() < 1e-12);
    }
    // on the edge itself the picture adds how steeply it pulls back along x
    let mut with = fit().snake;
    let field = picture();
    let mut x = state.x.clone();
    let place = DVec2::new(102.7, 47.3);
    x[0] = place;
    with.damp(Damping::Local, &State::at_rest(x)).unwrap();
    let at = |d: DVec2| field.at(place + d);
    let step = 1e-4;
    let slope = -(at(DVec2::new(step, 0.0)).x - at(DVec2::new(-step, 0.0)).x) / (2.0 * step);
    assert!(slope > 1.0, "{slope}");
    let found = (0.5 * with.damping()[0]).powi(2) - k;
    // the steepest direction is x but for a little shear between pixels
    assert!((found / slope - 1.0).abs() < 0.02, "{found} {slope}");
}

#[test]
fn renewed_damping_follows_the_curve_and_tells_the_scheme() {
    let mut fit = fit();
    fit.snake.damp(Damping::Renewed(0.5), &fit.state).unwrap();
    let first = fit.snake.damping().to_vec();
    for scheme in [Scheme::Leapfrog, Scheme::Newmark] {
        let (mut snake, mut state) = (fit.snake.clone(), fit.state.clone());
        let mut stepper = scheme
            .start(&mut snake, &state, 0.05, Start::SecondOrder)
            .unwrap();
        for _ in 0..6000 {
            stepper.step(&mut snake, &mut state).unwrap();
        }
        let now = snake.damping();
        let larger = now
            .iter()
            .zip(&first)
            .filter(|(now, first)| **now > 1.01 * **first);
        assert!(larger.count() > 30, "{}", scheme.name());
        // what is chosen again where it stands is what it has
        let gamma = now.to_vec();
        snake.damp(Damping::Local, &state).unwrap();
        for (a, b) in snake.damping().iter().zip(&gamma) {
            assert!((a / b - 1.0).abs() < 0.01, "{} {a} {b}", scheme.name());
        }
    }
}

#[test]
fn the_ledger_closes_under_damping_that_is_chosen_again() {
    let fit = fit();
    let gap = |rule: Damping, dt: f64| {
        let (mut snake, mut state) = (fit.snake.clone(), fit.state.clone());
        snake.damp(rule, &state).unwrap();
        let mut stepper = Scheme::Leapfrog
            .start(&mut snake, &state, dt, Start::SecondOrder)
            .unwrap();
        let mut ledger = Ledger::begin(&mut snake, &state).unwrap();
        let begin = ledger.energies(&mut snake, &state).total();
        let mut most = 0.0_f64;
        while state.t < 30.0 {
            stepper.step(&mut snake, &mut state).unwrap();
            ledger.book(&mut snake, &state).unwrap();
            let total = ledger.energies(&mut snake, &state).total();
            most = most.max((total - begin).abs());
        }
        most / ledger.energies(&mut snake, &state).damping
    };
    for rule in [Damping::Local, Damping::Renewed(0.5)] {
        let (coarse, fine) = (gap(rule, 0.02), gap(rule, 0.01));
        assert!(
            fine < 1e-3 && fine < 0.7 * coarse,
            "{rule}: {coarse} {fine}"
        );
    }
}

#[test]
fn internal_damping_leaves_flight_and_spin_alone_and_is_booked_as_damping() {
    let nodes = elastic::ellipse(DVec2::ZERO, DVec2::new(1.5, 1.0), 0.0, 24);
    let mut body = Body::of(&nodes, Topology::Closed, 1.0)
        .unwrap()
        .with_material(Material::uniform(3.0, 8.0, 0.3))
        .with_frame(Frame::turning());
    body.mass = Profile::PerNode((0..24).map(|i| 1.0 + 0.3 * f64::from(i).sin()).collect());
    body.recenter().unwrap();
    let mut snake = Snake::new(body.clone(), World::default()).unwrap();
    let mut state = State::at_rest(
        body.rest
            .iter()
            .map(|r| DVec2::new(0.8 * r.x, 1.1 * r.y))
            .collect(),
    );
    for (v, x) in state.v.iter_mut().zip(&state.x) {
        *v = DVec2::new(2.0, 1.0) + 0.5 * x.perp();
    }
    snake.damp(Damping::Internal(0.05), &state).unwrap();
    let whole = |state: &State| Motion::of(&state.x, &state.v, &body.mass, body.spacing);
    let begin = whole(&state);
    let mut ledger = Ledger::begin(&mut snake, &state).unwrap();
    let total = ledger.energies(&mut snake, &state).total();
    let dt = 0.5 * Scheme::Rk4.step_limit(&snake).unwrap();
    let mut stepper = Scheme::Rk4
        .start(&mut snake, &state, dt, Start::SecondOrder)
        .unwrap();
    while state.t < 80.0 {
        stepper.step(&mut snake, &mut state).unwrap();
        ledger.book(&mut snake, &state).unwrap();
    }
    let end = whole(&state);
    // forces without sum or torque: rounding and the scheme's fourth order
    assert!((end.velocity - begin.velocity).length() < 1e-12);
    assert!((end.angular_momentum / begin.angular_momentum - 1.0).abs() < 1e-5);
    assert!(end.deformation < 1e-6 * end.rotation, "{end:?}");
    let energies = ledger.energies(&mut snake, &state);
    assert!(energies.damping > 0.0);
    let gap = (energies.total() - total) / energies.damping;
    assert!(gap.abs() < 1e-3, "{gap}");
}

#[test]
fn the_step_limit_counts_internal_damping() {
    let Settling {
        mut snake,
        mut state,
        ..
    } = ball();
    let free = Scheme::Leapfrog.step_limit(&snake).unwrap();
    snake.damp(Damping::InternalMode(0), &state).unwrap();
    let limit = Scheme::Leapfrog.step_limit(&snake).unwrap();
    assert!(limit < 0.5 * free, "{limit} {free}");
    let start = snake.energies(&state).total();
    let mut stepper = Scheme::Leapfrog
        .start(&mut snake, &state, 0.99 * limit, Start::SecondOrder)
        .unwrap();
    for _ in 0..5000 {
        stepper.step(&mut snake, &mut state).unwrap();
    }
    assert!(snake.energies(&state).total() < start);
}

#[test]
fn the_step_limit_under_internal_damping_is_that_of_the_fastest_wave() {
    // one mode of stiffness λ: 4 − 2 dt β λ − dt² λ = 0, for any β; β K damps it by β λ
    let n = 32;
    let x = elastic::circle(DVec2::ZERO, 8.0, n);
    let mut body = Body::of(&x, Topology::Closed, 1.3)
        .unwrap()
        .with_material(Material::uniform(0.0, 5.0, 7.0));
    let h2 = body.spacing * body.spacing;
    let fastest = (5.0 * 4.0 / h2 + 7.0 * 16.0 / (h2 * h2)) / 1.3;
    for beta in [0.0, 0.01, 0.1, 1.0] {
        body.internal = beta;
        let snake = Snake::new(body.clone(), World::default()).unwrap();
        let root = ((beta * fastest).powi(2) + 4.0 * fastest).sqrt();
        let exact = (root - beta * fastest) / fastest;
        for scheme in [Scheme::Report, Scheme::Leapfrog] {
            let limit = scheme.step_limit(&snake).unwrap();
            assert!(
                (limit / exact - 1.0).abs() < 1e-9,
                "{scheme} {beta}: {limit}, {exact}"
            );
            // and where runs begin to blow up
            let grows = |dt: f64| {
                let mut snake = snake.clone();
                let mut state = State::at_rest(x.clone());
                for (i, p) in state.x.iter_mut().enumerate() {
                    *p *= if i % 2 == 0 { 1.01 } else { 0.99 };
                }
                let mut stepper = scheme
                    .start(&mut snake, &state, dt, Start::SecondOrder)
                    .unwrap();
                (0..4000).any(|_| {
                    stepper.step(&mut snake, &mut state).is_err()
                        || state
                            .x
                            .iter()
                            .any(|p| p.length().is_nan() || p.length() > 1e3)
                })
            };
            assert!(!grows(0.99 * limit), "{scheme} {beta}");
            assert!(grows(1.02 * limit), "{scheme} {beta}");
        }
        // Runge and Kutta's region ends at 2.785 on the damped side
        if beta >= 1.0 {
            let limit = Scheme::Rk4.step_limit(&snake).unwrap();
            let rate = 0.5 * fastest * (beta + (beta * beta - 4.0 / fastest).sqrt());
            assert!((limit * rate / 2.785_293_563 - 1.0).abs() < 1e-3, "{limit}");
        }
    }
}

#[test]
fn rules_are_read_as_they_are_written_and_others_refused() {
    for rule in [
        Damping::Constant(0.5),
        Damping::Mode(3),
        Damping::Local,
        Damping::Renewed(0.1),
        Damping::Internal(0.02),
        Damping::InternalMode(0),
    ] {
        assert_eq!(rule.to_string().parse::<Damping>().unwrap(), rule);
    }
    for text in [
        "",
        "constant",
        "mode(-1)",
        "mode(1.5)",
        "local(2)",
        "loco",
        "constant(x)",
    ] {
        let error = text.parse::<Damping>().unwrap_err();
        assert!(error.to_string().contains("internal-mode(k)"), "{error}");
    }
    let Settling {
        mut snake, state, ..
    } = ball();
    for rule in [
        Damping::Constant(-1.0),
        Damping::Constant(f64::NAN),
        Damping::Renewed(0.0),
        Damping::Internal(f64::INFINITY),
    ] {
        assert!(snake.damp(rule, &state).is_err(), "{rule}");
    }
    let short = State::at_rest(vec![DVec2::ZERO; 3]);
    assert!(snake.damp(Damping::Local, &short).is_err());
}
