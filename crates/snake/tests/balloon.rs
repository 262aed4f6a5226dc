//! Pressure: its laws, its energy, and what a balloon does at edges.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a snake that cannot be built should stop it"
)]

use crate::common;

use elastic::{End, Material, Topology};
use field::{EdgeForce, Grid, Smoothing, TwoRegions, edge_force};
use glam::{DMat2, DVec2};
use integrator::{Scheme, Start, State};
use proptest::prelude::*;
use snake::{
    Acting, Body, Curve, Force, ImageForce, Ledger, Pressure, RegionForce, Rest, Sampling,
    Schedule, Simulation, Snake, SnakeError, Stepping, Until, World,
};
use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;
use std::sync::Arc;
use {banded as _, outline as _, thiserror as _};

const MIDDLE: DVec2 = DVec2::splat(60.0);

fn curve(x: &[DVec2]) -> Curve<'_> {
    Curve {
        t: 0.0,
        x,
        v: &[],
        mass: &[],
        closed: true,
        spacing: 0.7,
    }
}

fn forces(force: &mut dyn Force, x: &[DVec2]) -> Vec<DVec2> {
    let mut felt = vec![DVec2::ZERO; x.len()];
    force.add(&curve(x), &mut felt).unwrap();
    felt
}

/// A potato of either orientation.
fn potato(bumps: &[f64], turned: bool) -> Vec<DVec2> {
    let n = bumps.len();
    let sign = if turned { -1.0 } else { 1.0 };
    let node = |i: usize| MIDDLE + bumps[i] * DVec2::from_angle(sign * TAU * i as f64 / n as f64);
    (0..n).map(node).collect()
}

proptest! {
    #[test]
    fn the_force_is_minus_the_gradient_of_the_energy_whichever_way_the_curve_runs(
        bumps in prop::collection::vec(2.0..9.0_f64, 12), turned: bool, k in -3.0..3.0_f64,
    ) {
        let x = potato(&bumps, turned);
        for mut pressure in [
            Pressure::constant(k),
            Pressure::gas(k.abs(), 70.0),
            Pressure::area(k.abs(), 70.0),
        ] {
            let felt = forces(&mut pressure, &x);
            let mut total = DVec2::ZERO;
            let mut slopes = vec![DMat2::ZERO; x.len()];
            prop_assert!(pressure.add_slope(&curve(&x), &mut slopes));
            for i in 0..x.len() {
                total += felt[i];
                for axis in [DVec2::X, DVec2::Y] {
                    let mut at = |by: f64| {
                        let mut x = x.clone();
                        x[i] += by * axis;
                        (pressure.energy(&curve(&x)).unwrap(), forces(&mut pressure, &x)[i])
                    };
                    let ((high, after), (low, before)) = (at(1e-4), at(-1e-4));
                    let expected = -(high - low) / 2e-4;
                    // energies of some hundreds, differences over 1e-4: 1e-9, and curvature
                    prop_assert!((0.7 * felt[i].dot(axis) - expected).abs() < 1e-6);
                    let slope = (after - before) / 2e-4;
                    prop_assert!((slopes[i] * axis - slope).length() < 1e-6);
                }
            }
            // forces of order 10 at most
            prop_assert!(total.length() < 1e-12);
        }
    }

    #[test]
    fn no_slope_of_all_nodes_together_is_steeper_than_the_bound(
        bumps in prop::collection::vec(2.0..9.0_f64, 12), way in prop::collection::vec(-1.0..1.0_f64, 24),
        k in -3.0..3.0_f64,
    ) {
        let x = potato(&bumps, false);
        let way: Vec<DVec2> = way.chunks(2).map(|p| DVec2::new(p[0], p[1])).collect();
        let squares: f64 = way.iter().map(|w| w.length_squared()).sum();
        for mut pressure in [Pressure::constant(k), Pressure::gas(k.abs(), 70.0), Pressure::area(k.abs(), 70.0)] {
            let bound = pressure.pull(0.7, Some(&curve(&x))).stiffness;
            let mut at = |by: f64| {
                let moved: Vec<DVec2> = x.iter().zip(&way).map(|(x, w)| *x + by * *w).collect();
                forces(&mut pressure, &moved)
            };
            let (high, low) = (at(1e-4), at(-1e-4));
            let back: f64 = (0..12).map(|i| (low[i] - high[i]).dot(way[i])).sum::<f64>() / 2e-4;
            prop_assert!(back <= (bound + 1e-6) * squares, "{back} {bound}");
        }
    }
}

#[test]
fn a_circle_is_pushed_outwards_by_k_a_length_as_equation_5_6_says() {
    for turned in [false, true] {
        let mut x = elastic::circle(MIDDLE, 20.0, 200);
        if turned {
            x.reverse();
        }
        let spacing = elastic::length(&x, true) / 200.0;
        let here = Curve {
            spacing,
            ..curve(&x)
        };
        let mut felt = vec![DVec2::ZERO; 200];
        Pressure::constant(1.5).add(&here, &mut felt).unwrap();
        for (f, x) in felt.iter().zip(&x) {
            // half the chord over two edges against an edge: cos(π/n) of it
            let outward = (*x - MIDDLE) / 20.0;
            assert!((*f - 1.5 * outward).length() < 1.5 * (PI / 200.0).powi(2));
        }
    }
}

#[test]
fn an_open_curve_has_no_inside_and_is_refused() {
    let nodes = elastic::segment(DVec2::ZERO, DVec2::X * 9.0, 10);
    let ends = Topology::Open {
        head: End::Free,
        tail: End::Free,
    };
    let body = Body::of(&nodes, ends, 1.0).unwrap();
    let error = Snake::new(body.clone(), World::default().with(Pressure::constant(1.0)));
    assert!(matches!(error, Err(SnakeError::NeedsClosed { name }) if name == "pressure"));
    let mut snake = Snake::new(body, World::default()).unwrap();
    let late = snake.add_force(Acting::new(Pressure::gas(1.0, 1.0)));
    assert!(matches!(late, Err(SnakeError::NeedsClosed { .. })));
    assert!(snake.world().forces.is_empty());
}

#[test]
fn numbers_that_are_no_pressure_are_refused_by_name() {
    for bad in [
        Pressure::constant(f64::NAN),
        Pressure::gas(-1.0, 5.0),
        Pressure::gas(1.0, 0.0),
        Pressure::area(1.0, f64::INFINITY),
        Pressure::automatic(f64::INFINITY, Pressure::constant(1.0)),
        Pressure::automatic(1.0, Pressure::constant(f64::NAN)),
    ] {
        assert!(bad.validate(9).is_err(), "{bad:?}");
    }
}

#[test]
fn a_gas_or_an_area_is_a_number_at_any_area_and_pushes_a_turned_curve_back() {
    let mut x = elastic::circle(MIDDLE, 5.0, 40);
    for mut pressure in [Pressure::gas(2.0, 200.0), Pressure::area(2.0, 200.0)] {
        let outward = forces(&mut pressure, &x)[0]; // met the right way round
        assert!(outward.x > 0.0);
        let flat: Vec<DVec2> = x.iter().map(|p| DVec2::new(p.x, MIDDLE.y)).collect();
        assert!(forces(&mut pressure, &flat).iter().all(|f| f.is_finite()));
        assert!(pressure.energy(&curve(&flat)).unwrap().is_finite());
        let point = vec![MIDDLE; 40];
        assert!(forces(&mut pressure, &point).iter().all(|f| f.is_finite()));
        x.reverse();
        // outwards was the same side of the material: that turns the nodes back
        assert!(forces(&mut pressure, &x)[39].x < 0.0);
        x.reverse();
    }
    let mut sucks = Pressure::constant(-1.0);
    assert!(forces(&mut sucks, &x)[0].x < 0.0);
    x.reverse();
    assert!(forces(&mut sucks, &x).iter().all(|f| *f == DVec2::ZERO));
}

/// A bright ring from 28 to 32, as bright as `faint` within `half` of angle 0 and 100 elsewhere.
fn ring(faint: f64, half: f64) -> Grid {
    Grid::from_shape_fn((121, 121), |(y, x)| {
        let q = DVec2::new(x as f64, y as f64) - MIDDLE;
        let bright = if q.to_angle().abs() < half {
            faint
        } else {
            100.0
        };
        bright * (2.5 - (q.length() - 30.0).abs()).clamp(0.0, 1.0)
    })
}

fn edges(picture: &Grid) -> ImageForce {
    let recipe = EdgeForce {
        smoothing: Smoothing::Gaussian(1.5),
        gain: 4.0,
    };
    let field = edge_force(picture, &recipe).unwrap();
    ImageForce::new(Arc::new(field), Sampling::Bilinear)
}

/// Where a circle of radius 12 inside comes to rest or ends under a pressure and a picture.
fn inflate(image: ImageForce, pressure: Acting, tension: f64) -> Vec<DVec2> {
    let x = elastic::circle(MIDDLE, 12.0, 120);
    let mut body = Body::of(&x, Topology::Closed, 1.0).unwrap();
    body.rest = elastic::circle(DVec2::ZERO, 1e-6, 120);
    let body = body
        .with_material(Material::uniform(0.0, tension, 0.0))
        .with_damping(3.0);
    let world = World::default().with(image).with_acting(pressure);
    let snake = Snake::new(body, world).unwrap();
    let stepping = Stepping::of(Scheme::Leapfrog, 0.05);
    let mut simulation = Simulation::of(snake, State::at_rest(x), stepping).unwrap();
    let until = Until::at_rest(Rest::default(), 4000);
    let end = simulation.run(&until, &mut |simulation| {
        // a leak ends outside the picture
        let x = &simulation.members()[0].state().x;
        if x.iter().any(|p| p.distance(MIDDLE) > 55.0) {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    });
    end.unwrap();
    simulation.members()[0].state().x.clone()
}

/// Nearest and farthest node from the middle.
fn span(x: &[DVec2]) -> (f64, f64) {
    let radii = x.iter().map(|p| p.distance(MIDDLE));
    radii.fold((f64::INFINITY, 0.0), |(a, b), r| (a.min(r), b.max(r)))
}

#[test]
fn a_strong_edge_stops_the_balloon_and_a_weak_one_is_passed() {
    let against = |bright: f64, k: f64| {
        let pressure = Acting::new(Pressure::constant(k));
        span(&inflate(edges(&ring(bright, 4.0)), pressure, 0.2))
    };
    // without pressure the edge is out of reach
    let (_, far) = against(100.0, 0.0);
    assert!(far < 13.0, "{far}");
    let (near, far) = against(100.0, 2.0);
    // the inner edge, and less than its own width beyond
    assert!(near > 27.5 && far < 30.0, "strong: {near} {far}");
    let (near, far) = against(5.0, 2.0);
    assert!(far > 50.0, "weak: {near} {far}");
}

#[test]
fn through_a_gap_in_the_edge_it_leaks_unless_the_pressure_fades() {
    let gap = || edges(&ring(0.0, 0.35));
    let (near, far) = span(&inflate(gap(), Acting::new(Pressure::constant(2.0)), 2.0));
    assert!(far > 50.0, "{near} {far}");
    // one that fades on the way arrives, and does not push on
    let fades = Schedule::new(vec![(0.0, 1.0), (14.0, 1.0), (20.0, 0.0)]).unwrap();
    let fading = Acting::new(Pressure::constant(2.0)).scheduled(fades);
    let (near, far) = span(&inflate(gap(), fading, 2.0));
    // the chord across the gap passes 28 cos 0.35 = 26.3 from the middle
    assert!(near > 25.0 && far < 30.0, "fading: {near} {far}");
}

/// How far a balloon of tension 5 enters a channel of that half width, 20 long, that leads out of a disk of radius 30.
fn channel(half: f64) -> f64 {
    let picture = Grid::from_shape_fn((121, 121), |(y, x)| {
        let q = DVec2::new(x as f64, y as f64) - MIDDLE;
        let disk = 30.5 - q.length();
        let way_out = (half + 0.5 - q.y.abs()).min(50.5 - q.x).min(q.x);
        100.0 * disk.max(way_out).clamp(0.0, 1.0)
    });
    let (_, far) = span(&inflate(
        edges(&picture),
        Acting::new(Pressure::constant(2.0)),
        5.0,
    ));
    far - 30.0
}

#[test]
fn into_a_narrow_channel_the_balloon_does_not_go() {
    // stretched 2.5 times, a tension of 5 holds a front of radius 5 · 2.5 / 2 against the pressure: wider than 5
    let (narrow, wide) = (channel(5.0), channel(14.0));
    assert!((-1.0..6.0).contains(&narrow), "{narrow}");
    assert!(wide > 17.0, "{wide}");
}

#[test]
fn the_automatic_sign_inflates_from_inside_and_deflates_from_outside() {
    let picture = Grid::from_shape_fn((121, 121), |(y, x)| {
        let r = DVec2::new(x as f64, y as f64).distance(MIDDLE);
        20.0 + 80.0 * (30.5 - r).clamp(0.0, 1.0)
    });
    let region = || RegionForce::new(Arc::new(TwoRegions::new(&picture, 1e-3).unwrap()));
    for (radius, sign) in [(8.0, 1.0), (25.0, 1.0), (36.0, -1.0), (50.0, -1.0)] {
        for turned in [false, true] {
            let mut x = elastic::circle(MIDDLE, radius, 60);
            if turned {
                x.reverse();
            }
            let mut pressure = Pressure::automatic(1.0, region());
            let out: f64 = forces(&mut pressure, &x)
                .iter()
                .zip(&x)
                .map(|(f, x)| f.dot(*x - MIDDLE))
                .sum();
            assert!(out * sign > 0.0, "{radius} {turned}");
            // and it stays so wherever the curve goes
            let elsewhere = elastic::circle(MIDDLE, 30.0 + 20.0 * sign, 60);
            let _ = forces(&mut pressure, &elsewhere);
            assert!(pressure.at(1.0) * sign > 0.0);
        }
    }
    // an edge's pull answers near the edge; where there is none, it inflates
    for (radius, sign) in [(28.0, 1.0), (33.0, -1.0), (8.0, 1.0)] {
        let mut pressure = Pressure::automatic(1.0, edges(&picture));
        let x = elastic::circle(MIDDLE, radius, 60);
        let _ = forces(&mut pressure, &x);
        assert!(pressure.at(1.0) * sign > 0.0, "{radius}");
    }
}

/// A soft ring under a squeezing weight; area at the end over area at the start.
fn squeezed(pressure: Option<Pressure>) -> f64 {
    let x = elastic::circle(MIDDLE, 10.0, 60);
    let body = Body::of(&x, Topology::Closed, 1.0)
        .unwrap()
        .with_material(Material::uniform(0.0, 0.5, 0.5))
        .with_damping(1.0);
    let mut world = World::default().with(Pressure::constant(-0.3));
    if let Some(pressure) = pressure {
        world = world.with(pressure);
    }
    let mut snake = Snake::new(body, world).unwrap();
    let mut state = State::at_rest(x);
    let start = elastic::signed_area(&state.x);
    let mut ledger = Ledger::begin(&mut snake, &state).unwrap();
    let first = ledger.energies(&mut snake, &state).total();
    let mut stepper = Scheme::Leapfrog
        .start(&mut snake, &state, 0.02, Start::SecondOrder)
        .unwrap();
    common::run(
        &mut snake,
        &mut *stepper,
        &mut state,
        3000,
        &mut |snake, state| {
            ledger.book(snake, state).unwrap();
            ControlFlow::Continue(())
        },
    )
    .unwrap();
    let energies = ledger.energies(&mut snake, &state);
    let largest = energies
        .values()
        .iter()
        .fold(0.0_f64, |a, e| a.max(e.abs()));
    // leapfrog: (ω dt)² of what swings
    assert!((energies.total() - first).abs() < 2e-3 * largest);
    elastic::signed_area(&state.x) / start
}

#[test]
fn a_gas_and_an_area_hold_what_a_load_outside_would_crush() {
    let alone = squeezed(None);
    let full = elastic::signed_area(&elastic::circle(MIDDLE, 10.0, 60));
    let gas = squeezed(Some(Pressure::gas(0.3, full)));
    let area = squeezed(Some(Pressure::area(30.0, full)));
    assert!(alone < 0.8, "{alone}");
    // p A the same always: at rest where it was, both pressures equal
    assert!((gas - 1.0).abs() < 0.01, "{gas}");
    // 0.3 of 30, less what the ring bears itself
    assert!((0.985..0.999).contains(&area), "{area}");
}
