//! Forces along the curve's own normals: regions and edges of one polarity.
#![allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    reason = "a test: a snake that cannot be built should stop it, and nothing is nothing"
)]

use crate::common;

use elastic::{End, Material, Topology};
use field::{Grid, LocalRegions, Polarity, Region, SignedEdge, Smoothing, TwoRegions};
use glam::{DMat2, DVec2};
use integrator::{Scheme, Start, State};
use proptest as _;
use snake::{
    Acting, Body, Curve, Force, ImageForce, RegionForce, Sampling, SignedEdgeForce, Snake,
    SnakeError, World,
};
use std::ops::ControlFlow;
use std::sync::Arc;
use {banded as _, outline as _, thiserror as _};

const MIDDLE: DVec2 = DVec2::new(60.0, 58.0);

/// A bright disk of radius 25 on a dark ground, its border one pixel wide.
fn disk() -> Grid {
    Grid::from_shape_fn((121, 121), |(y, x)| {
        let r = DVec2::new(x as f64, y as f64).distance(MIDDLE);
        40.0 + 100.0 * (25.5 - r).clamp(0.0, 1.0)
    })
}

fn curve(x: &[DVec2], closed: bool) -> Curve<'_> {
    Curve {
        t: 0.0,
        x,
        v: &[],
        mass: &[],
        closed,
        spacing: 1.1,
    }
}

fn forces(force: &mut dyn Force, x: &[DVec2], closed: bool) -> Vec<DVec2> {
    let mut felt = vec![DVec2::ZERO; x.len()];
    force.add(&curve(x, closed), &mut felt).unwrap();
    felt
}

/// Mean distance of the nodes from the middle where a circle is after a time of 500, and how far it is off it there.
fn fit(force: impl Force + 'static, at: DVec2, radius: f64) -> (f64, f64) {
    let x = elastic::circle(at, radius, 80);
    let mut body = Body::of(&x, Topology::Closed, 1.0).unwrap();
    body.rest = elastic::circle(DVec2::ZERO, 1e-6, 80);
    let body = body
        .with_material(Material::uniform(0.0, 0.5, 0.5))
        .with_damping(2.0);
    let mut snake = Snake::new(body, World::default().with(force)).unwrap();
    let mut state = State::at_rest(x);
    let mut stepper = Scheme::Leapfrog
        .start(&mut snake, &state, 0.05, Start::SecondOrder)
        .unwrap();
    common::run(
        &mut snake,
        &mut *stepper,
        &mut state,
        10_000,
        &mut |_, _| ControlFlow::Continue(()),
    )
    .unwrap();
    let radii: Vec<f64> = state.x.iter().map(|p| p.distance(MIDDLE)).collect();
    let mean = radii.iter().sum::<f64>() / 80.0;
    let worst = radii.iter().map(|r| (r - 25.0).abs()).fold(0.0, f64::max);
    (mean, worst)
}

#[test]
fn two_regions_draw_a_circle_to_the_disk_from_inside_outside_and_aside() {
    let region = Arc::new(TwoRegions::new(&disk(), 1e-4).unwrap());
    for (at, radius) in [
        (MIDDLE, 8.0),
        (MIDDLE, 45.0),
        (MIDDLE + DVec2::new(20.0, 8.0), 14.0),
    ] {
        let (mean, worst) = fit(RegionForce::new(region.clone()), at, radius);
        // tension pulls inwards by 0.5/25 of a push that changes by one within a pixel
        assert!(
            (mean - 25.0).abs() < 0.3 && worst < 0.8,
            "{radius}: {mean} {worst}"
        );
    }
}

#[test]
fn a_region_pushes_the_same_whichever_way_the_curve_runs() {
    let whole = TwoRegions::new(&disk(), 1e-3).unwrap();
    let local = LocalRegions::new(&whole, 9.0).unwrap();
    let both: [Arc<dyn Region>; 2] = [Arc::new(whole), Arc::new(local)];
    for region in both {
        let mut force = RegionForce::new(region);
        let mut x = elastic::ellipse(MIDDLE, DVec2::new(30.0, 18.0), 0.4, 50);
        let one = forces(&mut force, &x, true);
        x.reverse();
        let other = forces(&mut force, &x, true);
        for (a, b) in one.iter().zip(other.iter().rev()) {
            // forces of order 10
            assert!((*a - *b).length() < 1e-9, "{a} {b}");
        }
    }
}

#[test]
fn the_regions_push_is_the_slope_of_its_energy_up_to_the_square_of_the_spacing() {
    // a smooth picture: no pixel matters more than another
    let picture = Grid::from_shape_fn((121, 121), |(y, x)| {
        let r = DVec2::new(x as f64, y as f64).distance(MIDDLE);
        100.0 / (1.0 + ((r - 25.0) / 6.0).exp())
    });
    let region = TwoRegions::new(&picture, 1e-3).unwrap();
    let mut force = RegionForce::new(Arc::new(region.clone()));
    let off = |force: &mut RegionForce, n: usize| {
        let x = elastic::ellipse(MIDDLE, DVec2::new(28.0, 20.0), 0.0, n);
        let felt = forces(force, &x, true);
        // swell by a wave, since pixels make a single node's energy uneven
        let swell = |by: f64| -> f64 {
            let moved: Vec<DVec2> = x.iter().map(|p| *p + by * (*p - MIDDLE) / 25.0).collect();
            region.energy(&moved).unwrap()
        };
        let slope = (swell(0.5) - swell(-0.5)) / 1.0;
        let work: f64 = (0..n)
            .map(|i| 1.1 * felt[i].dot(x[i] - MIDDLE) / 25.0)
            .sum();
        (work + slope).abs() / slope.abs()
    };
    let (coarse, fine) = (off(&mut force, 16), off(&mut force, 64));
    assert!(fine < 0.02 && coarse > 2.0 * fine, "{coarse} {fine}");
}

#[test]
fn an_open_curve_has_no_regions_but_has_edges() {
    let nodes = elastic::segment(DVec2::new(36.5, 40.0), DVec2::new(36.5, 76.0), 20);
    let ends = Topology::Open {
        head: End::Free,
        tail: End::Free,
    };
    let body = Body::of(&nodes, ends, 1.0).unwrap();
    let region = RegionForce::new(Arc::new(TwoRegions::new(&disk(), 1.0).unwrap()));
    let refused = Snake::new(body.clone(), World::default().with(region));
    assert!(matches!(refused, Err(SnakeError::NeedsClosed { name }) if name == "region"));
    let edge = |polarity| {
        let edge = SignedEdge::new(&disk(), Smoothing::Gaussian(2.0), polarity, 1.0).unwrap();
        SignedEdgeForce::new(Arc::new(edge))
    };
    assert!(Snake::new(body, World::default().with(edge(Polarity::Either))).is_ok());
    // down along x = 36.5, whose normal points right: there the disk begins, 1.5 before its edge
    let middle = |polarity| forces(&mut edge(polarity), &nodes, false)[10].x;
    let dark_to_bright = middle(Polarity::DarkToBright);
    assert!(dark_to_bright.abs() > 0.1, "{dark_to_bright}");
    assert_eq!(middle(Polarity::BrightToDark), 0.0);
    assert_eq!(middle(Polarity::Either), dark_to_bright);
}

#[test]
fn of_two_edges_a_closed_curve_takes_the_one_of_its_polarity() {
    // a bright ring from 20 to 30: outwards, dark to bright at 20 and bright to dark at 30
    let ring = Grid::from_shape_fn((121, 121), |(y, x)| {
        let r = DVec2::new(x as f64, y as f64).distance(MIDDLE);
        100.0 * (5.5 - (r - 25.0).abs()).clamp(0.0, 1.0)
    });
    for (polarity, radius) in [
        (Polarity::DarkToBright, 20.0),
        (Polarity::BrightToDark, 30.0),
    ] {
        let edge = SignedEdge::new(&ring, Smoothing::Gaussian(3.0), polarity, 1.0).unwrap();
        let (mean, _) = fit(SignedEdgeForce::new(Arc::new(edge)), MIDDLE, 25.0);
        // smoothing of σ on a curved edge moves it by about σ²/2R, the other edge repels (D47)
        assert!((mean - radius).abs() < 1.0, "{polarity:?}: {mean}");
    }
}

#[test]
fn slopes_are_those_of_the_force_and_bounds_hold() {
    let edge = SignedEdge::new(&disk(), Smoothing::Gaussian(2.0), Polarity::Either, 1.0).unwrap();
    let mut signed = SignedEdgeForce::new(Arc::new(edge));
    let field = field::edge_force(&disk(), &field::EdgeForce::as_strong_as_the_report()).unwrap();
    let mut cubic = ImageForce::new(Arc::new(field), Sampling::Bicubic);
    let all: [&mut dyn Force; 2] = [&mut signed, &mut cubic];
    for force in all {
        let anywhere = force.pull(1.1, None).stiffness;
        let mut steepest = 0.0_f64;
        for radius in [21.3, 23.8, 25.1, 26.4, 29.0] {
            let x = elastic::circle(MIDDLE, radius, 60);
            let here = curve(&x, true);
            let mut slopes = vec![DMat2::ZERO; 60];
            assert!(force.add_slope(&here, &mut slopes));
            let most = force.pull(1.1, Some(&here)).stiffness;
            steepest = steepest.max(most);
            let along = |force: &mut dyn Force, by: f64| {
                // all nodes at once along x: normals stay
                let x: Vec<DVec2> = x.iter().map(|p| *p + DVec2::X * by).collect();
                forces(force, &x, true)
            };
            let (high, low) = (along(force, 1e-3), along(force, -1e-3));
            for i in 0..60 {
                let slope = (high[i] - low[i]) / 2e-3;
                let scale = 1e-3 * (1.0 + most);
                assert!(
                    (slopes[i].x_axis - slope).length() < scale,
                    "{}",
                    force.name()
                );
                assert!(-slope.x <= most + scale, "{}", force.name());
            }
        }
        assert!(
            steepest <= anywhere && steepest > 0.1 * anywhere,
            "{}",
            force.name()
        );
    }
}

#[test]
fn a_bicubic_image_has_a_slope_without_jumps() {
    let field = field::edge_force(&disk(), &field::EdgeForce::as_strong_as_the_report()).unwrap();
    let field = Arc::new(field);
    let jump = |sampling| {
        let mut force = ImageForce::new(field.clone(), sampling);
        let mut slope = |x: f64| {
            let mut slopes = [DMat2::ZERO];
            force.add_slope(&curve(&[DVec2::new(x, 58.3)], false), &mut slopes);
            slopes[0].x_axis.x
        };
        // across the column of pixels at 83
        (slope(83.0 + 1e-9) - slope(83.0 - 1e-9)).abs() / slope(83.4).abs().max(1e-3)
    };
    assert!(jump(Sampling::Bilinear) > 1e-2);
    assert!(jump(Sampling::Bicubic) < 1e-6);
    let named = Acting::new(ImageForce::new(field, Sampling::Bicubic)).named("flow");
    let world = World::default().with_acting(named);
    let energies = snake::Energies::names_with(false, world.names());
    assert!(energies.contains(&"flow".to_owned()));
}
