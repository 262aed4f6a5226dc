//! The certificate against closed formulas and against runs.

use elastic::{End, Material, Profile, Topology};
use field::ForceField;
use integrator::Start;
use std::sync::Arc;

use super::*;
use crate::{Body, Sampling, Wall, WallLaw, World};

fn ring(n: usize, damping: f64) -> Snake {
    let circle = elastic::circle(DVec2::splat(20.0), 10.0, n);
    let body = Body::of(&circle, Topology::Closed, 2.0)
        .unwrap()
        .with_material(Material::uniform(0.3, 4.0, 5.0))
        .with_damping(damping);
    Snake::new(body, World::default()).unwrap()
}

fn strip(n: usize) -> Snake {
    let line = elastic::segment(DVec2::new(3.0, 20.0), DVec2::new(30.0, 20.0), n);
    let body = Body::of(&line, Topology::open(End::Anchored), 1.0)
        .unwrap()
        .with_material(Material::uniform(0.1, 10.0, 10.0))
        .with_damping(4.0);
    Snake::new(body, World::default()).unwrap()
}

#[test]
fn a_ring_has_the_frequencies_of_its_symbol() {
    let snake = ring(24, 0.5);
    let certificate = Certificate::of(&snake, None);
    let h = snake.body().spacing;
    let highest = ((0.3 + 16.0 / (h * h) + 80.0 / h.powi(4)) / 2.0).sqrt();
    assert!(certificate.complete);
    assert_eq!(certificate.modes.len(), 24);
    assert!((certificate.elastic / highest - 1.0).abs() < 1e-12);
    // the frame lets it go where it will, and only damping stops it
    assert!(certificate.modes[0].frequency < 1e-6);
    assert!((certificate.modes[0].decay() - 0.25).abs() < 1e-12);
}

#[test]
fn largest_steps_are_where_runs_begin_to_blow_up() {
    let mut snake = strip(20);
    let certificate = Certificate::of(&snake, None);
    for scheme in [Scheme::Report, Scheme::Leapfrog, Scheme::Rk4] {
        let entry = certificate.steps.iter().find(|(known, _)| *known == scheme);
        let limit = entry.and_then(|(_, limit)| *limit).unwrap();
        let mut grows = |dt: f64| {
            let mut x = snake.body().rest.clone();
            for (i, p) in x.iter_mut().enumerate() {
                p.y += if i % 2 == 0 { 0.1 } else { -0.1 };
            }
            let mut state = State::at_rest(x);
            let mut stepper = scheme
                .start(&mut snake, &state, dt, Start::SecondOrder)
                .unwrap();
            (0..3000).any(|_| {
                stepper.step(&mut snake, &mut state).is_err()
                    || state
                        .x
                        .iter()
                        .any(|p| p.length().is_nan() || p.length() > 1e6)
            })
        };
        assert!(!grows(0.97 * limit), "{scheme:?} below its limit");
        assert!(grows(1.03 * limit), "{scheme:?} above its limit");
    }
    assert!(
        certificate
            .steps
            .iter()
            .any(|(scheme, limit)| *scheme == Scheme::Newmark && limit.is_none())
    );
}

#[test]
fn time_to_rest_is_when_a_run_is_at_rest() {
    // the slowest mode of a pinned strip: half a wave
    let line = elastic::segment(DVec2::new(0.0, 0.0), DVec2::new(20.0, 0.0), 21);
    for damping in [0.3, 8.0] {
        let body = Body::of(&line, Topology::open(End::Pinned), 1.0)
            .unwrap()
            .with_material(Material::uniform(0.2, 3.0, 0.0))
            .with_damping(damping);
        let mut body = body;
        body.frame.reaction = false;
        body.rest = line.iter().map(|p| *p - DVec2::new(10.0, 0.0)).collect();
        let mut snake = Snake::new(body, World::default()).unwrap();
        let certificate = Certificate::of(&snake, None);
        let rest = certificate.time_to_rest().unwrap();
        // odd about the middle, so that the mean stays where it is
        let bent = |i: usize| (std::f64::consts::TAU * i as f64 / 20.0).sin();
        let x = (0..21)
            .map(|i| line[i] + DVec2::new(0.0, bent(i)))
            .collect();
        let mut state = State::at_rest(x);
        let dt = rest / 4000.0;
        let mut stepper = Scheme::Newmark
            .start(&mut snake, &state, dt, Start::SecondOrder)
            .unwrap();
        for _ in 0..4000 {
            stepper.step(&mut snake, &mut state).unwrap();
        }
        let left = state.x.iter().map(|p| p.y.abs()).fold(0.0, f64::max);
        // at rest as promised; the mode that moves here may be faster than the slowest
        assert!(left < 0.02, "γ = {damping}: {left} left after {rest}");
    }
}

#[test]
fn a_picture_counts_with_its_steepest_slope() {
    let n = 24;
    let x = ndarray_like(40, |column| -3.0 * (column - 20.0));
    let body = ring(n, 0.5).body().clone();
    let world = World::default().with_image(Arc::new(x), Sampling::Bilinear);
    let snake = Snake::new(body, world).unwrap();
    let state = State::at_rest(elastic::circle(DVec2::splat(20.0), 10.0, n));
    for certificate in [
        Certificate::of(&snake, None),
        Certificate::of(&snake, Some(&state)),
    ] {
        assert!((certificate.image_slope - 3.0).abs() < 1e-12);
        assert!((certificate.image - 1.5_f64.sqrt()).abs() < 1e-12);
        let plain = Certificate::of(&ring(n, 0.5), None);
        let limit = |c: &Certificate| c.steps[0].1.unwrap();
        assert!(limit(&certificate) < limit(&plain));
    }
}

/// A force along x that depends on x alone.
fn ndarray_like(size: usize, force: impl Fn(f64) -> f64) -> ForceField {
    let grid = field::Grid::from_shape_fn((size, size), |(_, column)| force(column as f64));
    ForceField::from_components(&grid, &field::Grid::zeros((size, size))).unwrap()
}

#[test]
fn a_penalty_wall_and_a_node_without_mass_are_seen() {
    let law = WallLaw::Penalty {
        stiffness: 50.0,
        damping: 0.0,
    };
    let wall = Wall::new(DVec2::ZERO, DVec2::Y, law).unwrap();
    let body = ring(24, 0.0).body().clone();
    let snake = Snake::new(body.clone(), World::default().with_wall(wall)).unwrap();
    let certificate = Certificate::of(&snake, None);
    assert!((certificate.contact - 5.0).abs() < 1e-12);
    assert_eq!(certificate.time_to_rest(), None);
    assert!(certificate.to_string().contains("never comes to rest"));
    let mut light = body;
    light.mass = Profile::Uniform(0.0);
    let massless = Certificate::of(&Snake::new(light, World::default()).unwrap(), None);
    assert!(massless.elastic.is_infinite());
}

#[test]
fn a_limit_names_what_sets_it() {
    let n = 24;
    let circle = |snake: Snake| Certificate::limit(&snake, Scheme::Leapfrog).unwrap();
    let plain = circle(ring(n, 0.5));
    assert_eq!(plain.of, "the elastic force");
    // leapfrog: 4 μ/dt² is the largest stiffness, and a slope adds to it
    let elastic = 4.0 * 2.0 / (plain.dt * plain.dt);
    for (share, of) in [
        (1e-4, "the elastic force"),
        (0.3, "the elastic force and the slope of the picture"),
        (3.0, "the slope of the picture"),
    ] {
        let slope = share * elastic;
        let field = Arc::new(ndarray_like(41, |x| slope * (20.0 - x)));
        let world = World::default().with_image(field, Sampling::Bilinear);
        let snake = || Snake::new(ring(n, 0.5).body().clone(), world.clone()).unwrap();
        let limit = circle(snake());
        assert_eq!(limit.of, of, "{share}");
        let expected = plain.dt / (1.0 + share).sqrt();
        assert!(
            (limit.dt / expected - 1.0).abs() < 1e-9,
            "{share}: {limit:?}"
        );
        // elastic force implicit: nothing but the picture is left, and nothing at all with its slope in the matrix
        let imex = Certificate::limit(&snake(), Scheme::Newmark).unwrap();
        assert_eq!(imex.of, "the slope of the picture");
        assert_eq!(Certificate::limit(&snake(), Scheme::LinearlyImplicit), None);
    }
}
