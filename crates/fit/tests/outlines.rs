//! Outlines that are known exactly, and changes of an image that must not change them.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use crate::common::{apart, disc, drawn, found, whole};
use std::ops::ControlFlow;

use elastic::{Material, Topology};
use fit::{Contour, FitForce, Image, Options, Prepared, force};
use glam::DVec2;
use integrator::{Scheme, State};
use snake::{
    Body, Certificate, Outcome, Rest, Sampling, Simulation, Snake, Stepping, Until, World,
};

/// What smooths an edge: the Gaussian, the pixel's own area and the masks of the two derivatives.
/// Square pixels.
fn width_of(sigma: f64) -> f64 {
    sigma * sigma + 1.0 / 12.0 + 2.0 / 3.0
}

#[test]
fn a_disc_is_found_with_the_inward_shift_of_its_curvature() {
    // |∇(G ∗ disc)| is √(R/r) e^(−(r−R)²/2s²) nearly: steepest at R − s²/2R
    let (center, radius) = (DVec2::new(48.3, 44.8), 30.0);
    for sigma in [1.0, 2.0, 3.0] {
        let options = Options { sigma, ..whole() };
        let start = Contour::circle(center + DVec2::new(1.0, -0.7), radius + 2.0);
        let fit = found(disc(center, radius), &start, &options);
        assert!(fit.is_outline(), "{fit:?}");
        let n = fit.contour.points.len() as f64;
        let mean = fit
            .contour
            .points
            .iter()
            .map(|p| p.distance(center))
            .sum::<f64>()
            / n;
        let shift = width_of(sigma) / (2.0 * radius);
        assert!((mean - (radius - shift)).abs() < 0.03, "{sigma}: {mean}");
        // its own outline's elasticity pulls every node alike, so it is a circle
        let most = fit
            .contour
            .points
            .iter()
            .map(|p| (p.distance(center) - mean).abs());
        assert!(most.fold(0.0, f64::max) < 0.05, "{sigma}");
        let held = fit.nodes.iter().filter(|node| node.held).count();
        assert_eq!(held, fit.nodes.len());
    }
}

#[test]
fn an_ellipse_is_found_to_a_tenth_of_a_pixel() {
    let (center, half) = (DVec2::new(50.2, 45.7), DVec2::new(34.0, 26.0));
    let levels = drawn((101, 91), |p| ((p - center) / half).length() < 1.0);
    let options = Options {
        sigma: 1.0,
        tension: 2.0,
        rigidity: 10.0,
        ..whole()
    };
    let start = Contour::ellipse(center + DVec2::new(-1.0, 0.5), half + 2.0);
    let fit = found(levels, &start, &options);
    assert!(fit.is_outline(), "{fit:?}");
    for p in &fit.contour.points {
        // distance to first order
        let q = (*p - center) / half;
        let off = (q.length_squared() - 1.0) / (2.0 * (q / half).length());
        assert!(off.abs() < 0.1, "{p}: {off}");
    }
}

#[test]
fn the_sides_of_a_bar_are_found_as_exactly_as_they_are_drawn() {
    // straight edges between pixels are not moved by smoothing
    let (low, high) = (DVec2::new(20.0, 30.37), DVec2::new(100.0, 60.81));
    let inside = |p: DVec2| p.cmpgt(low).all() && p.cmplt(high).all();
    let options = Options {
        sigma: 1.5,
        tension: 0.5,
        rigidity: 1.0,
        ..whole()
    };
    let start = Contour::rectangle(low - 2.0, high + 2.0);
    let fit = found(drawn((121, 91), inside), &start, &options);
    assert!(matches!(fit.outcome, Outcome::Settled { .. }));
    let mut seen = [0, 0];
    for (p, node) in fit.contour.points.iter().zip(&fit.nodes) {
        // far from the corners
        if (40.0..80.0).contains(&p.x) {
            let side = usize::from(p.y > 45.0);
            let edge = [low.y, high.y][side];
            seen[side] += 1;
            // the grid of 16 points a pixel puts the edge off by 1/32 at most
            assert!((p.y - edge).abs() < 0.04, "{p}");
            let out = [DVec2::NEG_Y, DVec2::Y][side];
            assert!(node.normal.dot(out) > 0.999, "{node:?}");
            assert!(node.slope < 0.0 && node.strength > 0.8, "{node:?}");
            let balance = p.y + node.offset.unwrap() * node.normal.y;
            assert!((balance - edge).abs() < 0.04, "{node:?}");
        }
    }
    assert!(seen[0] > 5 && seen[1] > 5, "{seen:?}");
}

#[test]
fn exposure_does_not_matter() {
    let center = DVec2::new(48.3, 44.8);
    let start = Contour::circle(center + DVec2::new(2.0, -1.0), 26.0);
    let levels = disc(center, 22.0);
    let usual = found(levels.clone(), &start, &whole());
    for (factor, offset) in [(0.01, 0.0), (0.3, 60.0), (-1.0, 255.0), (250.0, -3000.0)] {
        let other = found(levels.mapv(|v| factor * v + offset), &start, &whole());
        // rounding alone, of levels up to 5e4 in sums of some hundred
        let off = apart(&usual.contour, &other.contour);
        assert!(off < 1e-6, "{factor}, {offset}: {off}");
        assert_eq!(usual.steps, other.steps);
    }
}

#[test]
fn a_quarter_turn_of_image_and_start_turns_the_outline() {
    let (center, half) = (DVec2::new(50.2, 40.7), DVec2::new(34.0, 21.0));
    let levels = drawn((101, 81), |p| ((p - center) / half).length() < 1.0);
    let start = Contour::ellipse(center + DVec2::new(1.0, 2.0), half + 3.0);
    let upright = found(levels.clone(), &start, &whole());
    // (x, y) to (height − 1 − y, x)
    let turn = |p: &DVec2| DVec2::new(80.0 - p.y, p.x);
    let turned = field::Grid::from_shape_fn((101, 81), |(y, x)| levels[[80 - x, y]]);
    let start = Contour::closed(start.points.iter().map(turn).collect());
    let lying = found(turned, &start, &whole());
    let expected = Contour::closed(upright.contour.points.iter().map(turn).collect());
    let off = apart(&expected, &lying.contour);
    // sums in another order
    assert!(off < 1e-6, "{off}");
}

/// Where the curve of a fit rests when it is moved by small explicit steps, inertia and all.
fn explicit_rest(prepared: &Prepared, start: &[DVec2]) -> Vec<DVec2> {
    let options = prepared.options();
    let material = Material::uniform(options.tether, options.tension, options.rigidity);
    let body = Body::of(start, Topology::Closed, 1.0).unwrap();
    let body = body.with_material(material).with_damping(options.damping);
    let field = prepared.field().unwrap().clone();
    let world = World::default().with_image(field, Sampling::Bilinear);
    let snake = Snake::new(body, world).unwrap();
    let dt = 0.5 * Certificate::limit(&snake, Scheme::Leapfrog).unwrap().dt;
    let stepping = Stepping::of(Scheme::Leapfrog, dt);
    let mut simulation = Simulation::of(snake, State::at_rest(start.to_vec()), stepping).unwrap();
    let strict = Rest {
        balance: 1e-7,
        travel: 1e-6,
        shape: false,
    };
    let until = Until::at_rest(strict, 1_000_000);
    let outcome = simulation.run(&until, &mut |_| ControlFlow::Continue(()));
    let outcome = outcome.unwrap();
    assert!(matches!(outcome, Outcome::Settled { .. }), "{outcome}");
    simulation.members()[0].state().x.clone()
}

#[test]
fn a_short_way_to_rest_ends_where_small_steps_end() {
    let (center, half) = (DVec2::new(50.2, 45.7), DVec2::new(34.0, 26.0));
    let levels = drawn((101, 91), |p| ((p - center) / half).length() < 1.0);
    let image = Image::grey(levels);
    let start = Contour::ellipse(center + DVec2::new(2.0, -1.5), half + 4.0);
    for (strength, sigma, steps) in [
        (0.3, 2.0, 150),
        (1.0, 2.0, 150),
        (3.0, 2.0, 300),
        (1.0, 3.2, 150),
        // a force that turns within a pixel: nodes swing about the edge, each in its turn
        (1.0, 1.0, 1000),
    ] {
        let options = Options {
            strength,
            sigma,
            ..whole()
        };
        let prepared = Prepared::of(&image, &options).unwrap();
        let session = prepared.session(&start).unwrap();
        let slow = Contour::closed(explicit_rest(&prepared, session.start()));
        let short = session.finish();
        assert!(short.steps < steps, "{strength}, {sigma}: {}", short.steps);
        // what is left of the way when a fit is called at rest: a ten-thousandth of its size is
        // 0.004 pixels
        let off = apart(&short.contour, &slow);
        assert!(off < 0.01, "{strength}, {sigma}: {off}");
    }
}

#[test]
fn a_chosen_force_reaches_farther_than_the_usual_one() {
    let center = DVec2::new(48.0, 45.0);
    let start = Contour::circle(center, 40.0);
    let levels = disc(center, 22.0);
    let mean = |options: &Options| {
        let fit = found(levels.clone(), &start, options);
        let radii = fit.contour.points.iter().map(|p| p.distance(center));
        radii.sum::<f64>() / fit.contour.points.len() as f64
    };
    assert!(mean(&whole()) > 35.0);
    let kinds = [
        force::ImageForceKind::Edge(force::Edge::default()),
        force::ImageForceKind::Gvf(force::Gvf::default()),
    ];
    let both = Options {
        forces: vec![
            FitForce::of(kinds[0].clone()),
            FitForce::Image {
                kind: kinds[1].clone(),
                weight: 0.5,
            },
        ],
        ..whole()
    };
    assert!((mean(&both) - 22.0).abs() < 0.5, "{}", mean(&both));
}
