//! Parameters from the image under the node, against exact motions and laws.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a snake that cannot be built should stop it"
)]

use crate::common;

use std::ops::ControlFlow;
use std::sync::Arc;

use elastic::{End, Material, Profile, Topology};
use field::{ForceField, Grid, Map};
use glam::DVec2;
use integrator::{Scheme, Start, State, System as _};
use proptest as _;
use snake::{
    Body, Certificate, Damping, Maps, Sampling, Schedule, Snake, SnakeError, Turning, World,
};
use {banded as _, lanes as _, outline as _, thiserror as _};

fn map(factor: impl Fn(f64, f64) -> f64) -> Option<Arc<Map>> {
    let grid = Grid::from_shape_fn((64, 64), |(y, x)| factor(x as f64, y as f64));
    Some(Arc::new(Map::new(&grid).unwrap()))
}

/// Bumps of some pixels, between 0.4 and 1.6.
fn bumps(x: f64, y: f64) -> f64 {
    1.0 + 0.3 * (0.35 * x).sin() + 0.3 * (0.25 * y + 0.1 * x).cos()
}

fn pull() -> Arc<ForceField> {
    let x = Grid::from_shape_fn((64, 64), |(y, x)| 0.3 * (0.2 * (x + y) as f64).sin());
    let y = Grid::from_shape_fn((64, 64), |(y, x)| {
        0.3 * (0.3 * x as f64 - 0.1 * y as f64).cos()
    });
    Arc::new(ForceField::from_components(&x, &y).unwrap())
}

fn oval(n: usize) -> (Body, State) {
    let nodes = elastic::ellipse(DVec2::new(30.0, 31.0), DVec2::new(12.0, 7.0), 0.3, n);
    let body = Body::of(
        &elastic::circle(DVec2::ZERO, 10.0, n),
        Topology::Closed,
        1.0,
    )
    .unwrap()
    .with_material(Material::uniform(0.05, 3.0, 2.0))
    .with_damping(0.2);
    let mut state = State::at_rest(nodes);
    state.v.fill(DVec2::new(0.7, -0.4));
    (body, state)
}

fn after(snake: &mut Snake, start: &State, scheme: Scheme, dt: f64, steps: u64) -> State {
    let mut state = start.clone();
    let mut stepper = scheme.start(snake, &state, dt, Start::SecondOrder).unwrap();
    let outcome = common::run(snake, &mut *stepper, &mut state, steps, &mut |_, _| {
        ControlFlow::Continue(())
    });
    assert!(outcome.is_ok(), "{scheme}: {outcome:?}");
    state
}

#[test]
fn a_constant_map_is_the_plain_parameter_bit_for_bit_under_every_scheme() {
    let (body, start) = oval(24);
    let world = World::default().with_image(pull(), Sampling::Bilinear);
    let plain = Body {
        material: Material::uniform(0.05 * 0.7, 3.0 * 1.1, 2.0 * 0.9),
        mass: Profile::Uniform(1.3),
        damping: Profile::Uniform(0.2 * 0.6),
        ..body.clone()
    };
    let mapped = Body {
        maps: Maps {
            tether: map(|_, _| 0.7),
            tension: map(|_, _| 1.1),
            rigidity: map(|_, _| 0.9),
            mass: map(|_, _| 1.3),
            damping: map(|_, _| 0.6),
            every: 0.0,
        },
        ..body
    };
    for &scheme in Scheme::ALL {
        let run = |body: &Body| {
            let mut snake = Snake::new(body.clone(), world.clone()).unwrap();
            after(&mut snake, &start, scheme, 0.02, 50)
        };
        assert_eq!(run(&mapped), run(&plain), "{scheme}");
    }
}

/// Nodes above each other that fly to the right, without any elasticity.
fn front(mass: f64, damping: f64, speed: f64) -> (Body, State) {
    let nodes: Vec<DVec2> = (0..6)
        .map(|i| DVec2::new(2.0, 10.0 + f64::from(i)))
        .collect();
    let body = Body::of(&nodes, Topology::open(End::Free), mass)
        .unwrap()
        .with_damping(damping);
    let mut state = State::at_rest(nodes);
    state.v.fill(DVec2::new(speed, 0.0));
    (body, state)
}

#[test]
fn damping_that_grows_along_the_way_gives_the_exact_motion_by_the_order_of_each_scheme() {
    // μ v' = −k (x − 2) v from x = 2: v = v₀ − k u²/2μ, u = x − 2, so u = w tanh(k w t/2μ) with w² = 2 μ v₀/k
    let (mu, k, v0, end) = (2.0_f64, 0.3, 6.0, 4.0);
    let w: f64 = (2.0 * mu * v0 / k).sqrt();
    let exact = 2.0 + w * (k * w * end / (2.0 * mu)).tanh();
    let (mut body, start) = front(mu, 1.0, v0);
    body.maps.damping = map(|x, _| k * (x - 2.0).max(0.0));
    for (scheme, order, least) in [
        (Scheme::Report, 1.0, 0.2),
        (Scheme::Leapfrog, 2.0, 2e-3),
        (Scheme::Rk4, 4.0, 1e-7),
        (Scheme::DormandPrince { tolerance: 1e-10 }, 0.0, 1e-7),
        (Scheme::BackwardEuler, 1.0, 0.2),
        (Scheme::Imex, 1.0, 0.2),
        (Scheme::Newmark, 2.0, 2e-3),
        (Scheme::GeneralizedAlpha { rho: 0.8 }, 1.0, 0.2),
        (Scheme::Sbdf2, 1.0, 0.2),
        (Scheme::LinearlyImplicit, 1.0, 0.2),
        (Scheme::Gauss4, 2.0, 2e-3),
        (Scheme::Radau5, 2.0, 2e-3),
        (Scheme::Exact, 1.0, 0.2),
        (Scheme::Etd2, 1.0, 0.2),
    ] {
        let error = |steps: u64| {
            let mut snake = Snake::new(body.clone(), World::default()).unwrap();
            let state = after(&mut snake, &start, scheme, end / steps as f64, steps);
            (state.x[3].x - exact).abs()
        };
        let (coarse, fine) = (error(100), error(200));
        assert!(fine < least, "{scheme}: {fine}");
        let found = (coarse / fine).log2();
        // a piece of a pixel is where the map has its corner: not all of them see the order at this step
        assert!(
            order < 0.5 || found > order - 0.3,
            "{scheme}: order {found}"
        );
    }
}

#[test]
fn a_node_whose_mass_changes_keeps_its_velocity_and_falls_as_fast() {
    let (mut body, start) = front(1.0, 0.0, 3.0);
    body.maps.mass = map(|x, _| 1.0 + 0.2 * x);
    let world = World::default().with_gravity(DVec2::new(0.0, 2.0));
    for scheme in [Scheme::Leapfrog, Scheme::Newmark, Scheme::Rk4] {
        let mut snake = Snake::new(body.clone(), world.clone()).unwrap();
        let state = after(&mut snake, &start, scheme, 0.0625, 64);
        // sixty-four sums of numbers below 8
        assert!(
            (state.v[2] - DVec2::new(3.0, 8.0)).length() < 1e-13,
            "{scheme}"
        );
        assert!(snake.mass()[2] > 3.0);
    }
}

#[test]
fn mass_that_grows_along_the_way_slows_the_loss_of_speed_as_it_should() {
    // μ v' = −γ v with μ = 1 + a (x − 2): dv/dx = −γ/μ, so v = v₀ − (γ/a) ln μ
    let (gamma, a, v0) = (0.8, 0.25, 5.0);
    let (mut body, start) = front(1.0, gamma, v0);
    body.maps.mass = map(|x, _| 1.0 + a * (x - 2.0).max(0.0));
    let error = |steps: u64| {
        let mut snake = Snake::new(body.clone(), World::default()).unwrap();
        let state = after(
            &mut snake,
            &start,
            Scheme::Leapfrog,
            4.0 / steps as f64,
            steps,
        );
        let mu: f64 = 1.0 + a * (state.x[1].x - 2.0);
        (state.v[1].x - (v0 - gamma / a * mu.ln())).abs()
    };
    let (coarse, fine) = (error(100), error(200));
    assert!(
        fine < 1e-3 && (coarse / fine).log2() > 1.8,
        "{coarse} {fine}"
    );
}

#[test]
fn a_map_and_a_snake_moved_together_move_the_same() {
    let (body, start) = oval(24);
    let at = |by: DVec2| {
        let mut body = body.clone();
        body.maps.rigidity = map(|x, y| bumps(x - by.x, y - by.y));
        body.maps.damping = map(|x, y| bumps(y - by.y, x - by.x));
        let mut start = start.clone();
        start.x.iter_mut().for_each(|x| *x += by);
        let mut snake = Snake::new(body, World::default()).unwrap();
        after(&mut snake, &start, Scheme::Leapfrog, 0.02, 200)
    };
    let (here, there) = (at(DVec2::ZERO), at(DVec2::new(8.0, -4.0)));
    for (a, b) in here.x.iter().zip(&there.x) {
        // places up to 50 are rounded to 7e-15, some hundred times
        assert!((*a + DVec2::new(8.0, -4.0)).distance(*b) < 1e-11);
    }
}

#[test]
fn what_maps_make_of_the_material_is_the_profile_made_by_hand() {
    let (mut body, start) = oval(24);
    body.maps.tether = map(bumps);
    body.maps.tension = map(bumps);
    body.maps.rigidity = map(|x, y| bumps(y, x));
    let slow = |p: DVec2, f: &dyn Fn(f64, f64) -> f64| -> f64 {
        let (i, j) = (p.x.floor(), p.y.floor());
        let (a, b) = (p.x - i, p.y - j);
        let mut sum = 0.0;
        for (x, u) in [(i, 1.0 - a), (i + 1.0, a)] {
            for (y, v) in [(j, 1.0 - b), (j + 1.0, b)] {
                sum += u * v * f(x, y);
            }
        }
        sum
    };
    let n = start.len();
    let mut by_hand = body.clone();
    by_hand.maps = Maps::default();
    let each = |f: &dyn Fn(usize) -> f64| Profile::PerNode((0..n).map(f).collect());
    let turned = |x: f64, y: f64| bumps(y, x);
    by_hand.material = Material {
        tether: each(&|i| 0.05 * slow(start.x[i], &bumps)),
        tension: each(&|i| 3.0 * slow(0.5 * (start.x[i] + start.x[(i + 1) % n]), &bumps)),
        rigidity: each(&|i| 2.0 * slow(start.x[i], &turned)),
        higher: Vec::new(),
    };
    let mut snake = Snake::new(body, World::default()).unwrap();
    assert!(advanced(&mut snake, 0.0, &start.x));
    let twin = Snake::new(by_hand, World::default()).unwrap();
    let (a, b) = (snake.stiffness().dense(), twin.stiffness().dense());
    for i in 0..n {
        for j in 0..n {
            // the largest are near 100
            assert!((a[(i, j)] - b[(i, j)]).abs() < 1e-12);
        }
    }
}

#[test]
fn elastic_forces_of_a_mapped_material_keep_the_momentum() {
    let (mut body, start) = oval(24);
    body.damping = Profile::Uniform(0.0);
    body.maps.tether = map(bumps);
    body.maps.tension = map(bumps);
    body.maps.rigidity = map(|x, y| bumps(y, x));
    for scheme in [Scheme::Leapfrog, Scheme::Rk4, Scheme::Imex, Scheme::Newmark] {
        let mut snake = Snake::new(body.clone(), World::default()).unwrap();
        let state = after(&mut snake, &start, scheme, 0.02, 500);
        let momentum: DVec2 = state.v.iter().sum();
        let before: DVec2 = start.v.iter().sum();
        assert!(momentum.distance(before) < 1e-10, "{scheme}: {momentum}");
        assert!(state.x[0].distance(start.x[0]) > 1.0);
    }
}

#[test]
fn the_motion_does_not_depend_on_the_number_of_nodes() {
    let at = |n: usize| {
        let (mut body, start) = oval(n);
        body.maps.tension = map(bumps);
        body.maps.rigidity = map(|x, y| bumps(y, x));
        body.maps.damping = map(bumps);
        body.maps.mass = map(|x, y| bumps(x, -y));
        let world = World::default().with_image(pull(), Sampling::Bilinear);
        let mut snake = Snake::new(body, world).unwrap();
        let dt = 0.02 * (50.0 / n as f64).powi(2);
        let steps = (6.0 / dt).round();
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "some thousand"
        )]
        after(&mut snake, &start, Scheme::Leapfrog, dt, steps as u64).x
    };
    let finest = at(200);
    let off = |n: usize| {
        let x = at(n);
        let pairs = x.iter().enumerate();
        let apart = pairs.map(|(i, x)| x.distance(finest[i * (200 / n)]));
        apart.fold(0.0, f64::max)
    };
    let (coarse, fine) = (off(50), off(100));
    // second order: of the two differences to 200 nodes the first has 15/16 of its error, the second 3/4
    assert!(fine < 0.02 && coarse / fine > 3.0, "{coarse} {fine}");
}

#[test]
fn a_step_is_checked_against_the_stiffest_patch_before_anyone_is_there() {
    let (mut body, start) = oval(24);
    let soft = Snake::new(body.clone(), World::default()).unwrap();
    body.maps.rigidity = map(|x, _| if x > 50.0 { 100.0 } else { 1.0 });
    body.maps.mass = map(|x, _| if x < 5.0 { 0.25 } else { 1.0 });
    let mut snake = Snake::new(body.clone(), World::default()).unwrap();
    let limit = Certificate::limit(&snake, Scheme::Leapfrog).unwrap().dt;
    let plain = Certificate::limit(&soft, Scheme::Leapfrog).unwrap().dt;
    assert!(limit < 0.15 * plain, "{limit} {plain}");
    let before = Certificate::of(&snake, None);
    assert!(
        snake
            .check_step(Scheme::Leapfrog, 1.01 * limit, false)
            .is_err()
    );
    assert!(
        snake
            .check_step(Scheme::Leapfrog, 0.99 * limit, false)
            .is_ok()
    );
    // standing where it is soft changes nothing
    snake.advance(0.0, &start.x);
    assert!(Scheme::Leapfrog.step_limit(&snake).unwrap() > 5.0 * limit);
    assert_eq!(Certificate::of(&snake, None).steps, before.steps);
    // and a flight over the patch at that step stays whole
    let mut start = start;
    start.v.fill(DVec2::new(10.0, 0.0));
    let mut snake = Snake::new(body.clone().with_damping(0.0), World::default()).unwrap();
    let steps = 4.0 / limit;
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "some thousand"
    )]
    let state = after(
        &mut snake,
        &start,
        Scheme::Leapfrog,
        0.9 * limit,
        steps as u64,
    );
    assert!(state.x.iter().all(|x| x.x > 50.0 && x.x < 120.0));
    let spread = elastic::center(&state.x, None);
    assert!(state.x.iter().all(|x| x.distance(spread) < 20.0));
}

/// Whether bringing the snake to that time and place changed what schemes have their numbers from.
fn advanced(snake: &mut Snake, t: f64, x: &[DVec2]) -> bool {
    let before = snake.revision();
    snake.advance(t, x);
    snake.revision() != before
}

#[test]
fn a_map_looked_at_now_and_then_holds_between_the_looks() {
    let (mut body, start) = front(1.0, 1.0, 4.0);
    body.maps.damping = map(|x, _| x);
    body.maps.every = 1.0;
    let mut snake = Snake::new(body, World::default()).unwrap();
    let right =
        |by: f64| -> Vec<DVec2> { start.x.iter().map(|x| *x + DVec2::new(by, 0.0)).collect() };
    assert!(advanced(&mut snake, 0.0, &right(0.0)));
    assert_eq!(snake.damping()[0].to_bits(), 2.0_f64.to_bits());
    assert!(!advanced(&mut snake, 0.5, &right(2.0)));
    assert_eq!(snake.damping()[0].to_bits(), 2.0_f64.to_bits());
    assert!(advanced(&mut snake, 1.25, &right(4.0)));
    assert_eq!(snake.damping()[0].to_bits(), 6.0_f64.to_bits());
    assert!(!advanced(&mut snake, 1.9, &right(5.0)));
    assert!(advanced(&mut snake, 2.0, &right(5.0)));
}

#[test]
fn rules_schedules_and_maps_multiply_and_a_new_body_stands_where_the_old_one_stood() {
    let (mut body, start) = front(1.0, 0.5, 1.0);
    body.maps.damping = map(|x, _| x);
    body.schedules.damping = Some(Schedule::new(vec![(0.0, 1.0), (1.0, 3.0)]).unwrap());
    let mut snake = Snake::new(body.clone(), World::default()).unwrap();
    snake.advance(1.0, &start.x);
    assert_eq!(snake.damping()[4].to_bits(), 3.0_f64.to_bits());
    snake.set_body(body.with_damping(1.0)).unwrap();
    assert_eq!(snake.damping()[4].to_bits(), 6.0_f64.to_bits());
    snake
        .damp(Damping::Constant(0.25), &State { t: 1.0, ..start })
        .unwrap();
    assert_eq!(snake.damping()[4].to_bits(), 1.5_f64.to_bits());
}

#[test]
fn factors_that_will_not_do_are_refused_and_so_is_a_frame_of_its_own_equation() {
    let (body, _) = oval(24);
    let refused = |maps: Maps| {
        let body = Body {
            maps,
            ..body.clone()
        };
        Snake::new(body, World::default()).unwrap_err().to_string()
    };
    let none = Maps::default;
    assert_eq!(
        refused(Maps {
            rigidity: map(|x, _| x - 1.0),
            ..none()
        }),
        "a factor of the rigidity must be finite and at least 0, got -1"
    );
    assert_eq!(
        refused(Maps {
            mass: map(|x, _| x),
            ..none()
        }),
        "a factor of the mass must be finite and above 0, got 0"
    );
    assert_eq!(
        refused(Maps {
            every: f64::NAN,
            ..none()
        }),
        "the time between looks must be finite and at least 0, got NaN"
    );
    let turning = Body {
        maps: Maps {
            tension: map(bumps),
            ..none()
        },
        ..body.clone()
    };
    let snake = Snake::new(turning, World::default()).unwrap();
    assert!(matches!(
        Turning::new(&snake),
        Err(SnakeError::NotInTurningFrame { .. })
    ));
}
