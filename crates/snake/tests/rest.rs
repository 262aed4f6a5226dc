//! When a run stops, and why: the traps that other programs fall into.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a snake that cannot be built should stop it"
)]

use crate::common;

use elastic::{Material, Topology};
use field::{EdgeForce, ForceField, Grid, Smoothing, edge_force};
use glam::DVec2;
use integrator::{Scheme, State};
use proptest as _;
use snake::{Body, Outcome, Rest, Sampling, Snake, Stepping, Until, World};
use std::sync::Arc;
use {banded as _, thiserror as _};

const MIDDLE: DVec2 = DVec2::new(127.5, 127.5);

/// A disc of radius 60 with a soft border, of that contrast, on a grid `zoom` times as fine.
fn disc(contrast: f64, zoom: usize) -> Arc<ForceField> {
    let side = 256 * zoom;
    let z = zoom as f64;
    let image = Grid::from_shape_fn((side, side), |(y, x)| {
        let p = (DVec2::new(x as f64, y as f64) + 0.5) / z - 0.5;
        let out = p.distance(MIDDLE) - 60.0;
        contrast / (1.0 + (out / 3.0).exp())
    });
    let rule = EdgeForce {
        smoothing: Smoothing::Gaussian(8.0 * z),
        gain: 400.0 / contrast * z * z,
    };
    Arc::new(edge_force(&image, &rule).unwrap())
}

/// A circle of that radius let go on `field`; where it ends up, and why.
fn fit(
    field: Arc<ForceField>,
    radius: f64,
    n: usize,
    zoom: f64,
    gamma: f64,
    share: f64,
) -> (f64, Outcome) {
    let middle = (MIDDLE + 0.5) * zoom - 0.5;
    let circle = elastic::circle(middle, radius * zoom, n);
    let body = Body::of(&circle, Topology::Closed, 1.0)
        .unwrap()
        .with_material(Material::uniform(
            0.0,
            2.0 * zoom * zoom,
            5.0 * zoom.powi(4),
        ))
        .with_damping(gamma);
    let world = World::default().with_image(field, Sampling::Bilinear);
    let snake = Snake::new(body, world).unwrap();
    let limit = Scheme::Leapfrog.step_limit(&snake).unwrap().min(0.5);
    let stepping = Stepping::of(Scheme::Leapfrog, share * limit);
    let until = Until::at_rest(Rest::default(), 400_000);
    let (outcome, state) = common::end(&snake, &State::at_rest(circle), stepping, &until);
    let radii = state.x.iter().map(|p| p.distance(middle) / zoom);
    (radii.sum::<f64>() / n as f64, outcome)
}

#[test]
fn slow_is_not_at_rest() {
    // heavy damping and small steps: a thousandth of a pixel a step, fifteen pixels to go
    let field = disc(140.0, 1);
    for (gamma, share) in [(0.5, 0.5), (20.0, 0.2), (20.0, 0.02)] {
        let (radius, outcome) = fit(Arc::clone(&field), 75.0, 100, 1.0, gamma, share);
        assert!(
            matches!(outcome, Outcome::Settled { .. }),
            "{gamma}: {outcome}"
        );
        assert!((radius - 60.0).abs() < 1.0, "{gamma}, {share}: {radius}");
    }
}

#[test]
fn where_it_stops_moves_neither_with_nodes_nor_step_nor_grey_levels_nor_pixels() {
    let field = disc(140.0, 1);
    let (usual, outcome) = fit(Arc::clone(&field), 75.0, 100, 1.0, 1.0, 0.5);
    assert!(matches!(outcome, Outcome::Settled { .. }));
    for n in [25, 50, 200] {
        let (radius, outcome) = fit(Arc::clone(&field), 75.0, n, 1.0, 1.0, 0.5);
        assert!(matches!(outcome, Outcome::Settled { .. }), "{n}: {outcome}");
        // the polygon of few nodes lies inside its circle: (π/n)² of the radius
        assert!(
            (radius - usual).abs() < 0.05 + 600.0 / (n * n) as f64,
            "{n}: {radius} {usual}"
        );
    }
    // a gain in proportion leaves the same force, up to rounding
    let (faint, _) = fit(disc(1.4e-4, 1), 75.0, 100, 1.0, 1.0, 0.5);
    assert!((faint - usual).abs() < 1e-3);
    let (fine, _) = fit(Arc::clone(&field), 75.0, 100, 1.0, 1.0, 0.1);
    assert!((fine - usual).abs() < 0.02, "{fine} {usual}");
    // a pixel of half the size: within what a pixel's own width changes
    let (zoomed, outcome) = fit(disc(140.0, 2), 75.0, 100, 2.0, 1.0, 0.5);
    assert!(matches!(outcome, Outcome::Settled { .. }), "{outcome}");
    assert!((zoomed - usual).abs() < 0.05, "{zoomed} {usual}");
}

#[test]
fn a_run_that_never_rests_says_why() {
    let flat = || {
        Arc::new(
            ForceField::from_components(&Grid::zeros((256, 256)), &Grid::zeros((256, 256)))
                .unwrap(),
        )
    };
    let end = |body: Body, world: World, x: &[DVec2], v: DVec2, damped: f64| {
        let snake = Snake::new(body.with_damping(damped), world).unwrap();
        let mut state = State::at_rest(x.to_vec());
        state.v.fill(v);
        let limit = Scheme::Leapfrog.step_limit(&snake);
        let dt = 0.3 * limit.unwrap_or(1.0).min(1.0);
        let until = Until::at_rest(Rest::default(), 200_000);
        common::end(&snake, &state, Stepping::of(Scheme::Leapfrog, dt), &until).0
    };
    let circle = elastic::circle(MIDDLE, 40.0, 30);
    let point = elastic::circle(DVec2::ZERO, 1e-6, 30);
    // tension with no shape to keep shrinks to nothing where no edge holds it
    let mut shrinking = Body::of(&circle, Topology::Closed, 1.0).unwrap();
    shrinking.rest.copy_from_slice(&point);
    shrinking.material = Material::uniform(0.0, 50.0, 0.0);
    let world = World::default().with_image(flat(), Sampling::Bilinear);
    let outcome = end(shrinking, world.clone(), &circle, DVec2::ZERO, 2.0);
    assert!(matches!(outcome, Outcome::Collapsed { .. }), "{outcome}");
    // a body that flies out of the picture
    let body = Body::of(&circle, Topology::Closed, 1.0).unwrap();
    let outcome = end(body.clone(), world, &circle, DVec2::X, 0.0);
    assert!(matches!(outcome, Outcome::Lost { .. }), "{outcome}");
    // a body that swings for ever
    let mut swinging = body;
    swinging.rest = elastic::ellipse(DVec2::ZERO, DVec2::new(41.0, 39.0), 0.0, 30);
    swinging.material = Material::uniform(1.0, 0.0, 0.0);
    let outcome = end(
        swinging.clone(),
        World::default(),
        &circle,
        DVec2::ZERO,
        0.0,
    );
    assert!(matches!(outcome, Outcome::Cycles { .. }), "{outcome}");
    // and one that is damped a little does come to rest
    let outcome = end(swinging, World::default(), &circle, DVec2::ZERO, 0.05);
    assert!(matches!(outcome, Outcome::Settled { .. }), "{outcome}");
}
