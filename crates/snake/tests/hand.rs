//! The hand: springs, pushes and holds that come and go, and an account that closes all the while.
#![allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    reason = "a test: a snake that cannot be built should stop it, and nothing is nothing"
)]

use crate::common;

use elastic::{Material, Topology};
use field::{ForceField, Grid};
use glam::{DMat2, DVec2};
use integrator::{Scheme, Start, State, System};
use proptest::prelude::*;
use snake::{
    Acting, Body, Curve, Force, Freeze, Ledger, Path, Repulsor, Sampling, Snake, SnakeError,
    Spring, World,
};
use std::ops::ControlFlow;
use std::sync::Arc;
use {banded as _, thiserror as _};

fn curve<'a>(x: &'a [DVec2], v: &'a [DVec2], t: f64) -> Curve<'a> {
    Curve {
        t,
        x,
        v,
        mass: &[],
        closed: true,
        spacing: 0.8,
    }
}

fn forces(force: &mut dyn Force, x: &[DVec2]) -> Vec<DVec2> {
    let mut felt = vec![DVec2::ZERO; x.len()];
    force.add(&curve(x, &[], 0.0), &mut felt).unwrap();
    felt
}

proptest! {
    #[test]
    fn every_force_of_the_hand_is_minus_the_gradient_of_its_energy(
        places in prop::collection::vec(-5.0..5.0_f64, 12), way in prop::collection::vec(-1.0..1.0_f64, 12),
        k in 0.1..4.0_f64, at in prop::array::uniform2(-6.0..6.0_f64),
    ) {
        let points = |flat: &[f64]| -> Vec<DVec2> { flat.chunks(2).map(|p| DVec2::new(p[0], p[1])).collect() };
        let (x, way, at) = (points(&places), points(&way), DVec2::from(at));
        let squares: f64 = way.iter().map(|w| w.length_squared()).sum();
        let all: [Box<dyn Force>; 6] = [
            Box::new(Spring::at_node(3, at, k)),
            Box::new(Spring::at_nearest(&x, true, DVec2::new(0.3, 0.2), at, k).unwrap()),
            Box::new(Spring::pin(&x, 2, k).unwrap()),
            Box::new(Repulsor::new(at, 4.0, k)),
            Box::new(Repulsor::new(at, 4.0, -k)),
            Box::new(Freeze::new(&x[1..], 1..4, k).unwrap()),
        ];
        for mut force in all {
            let name = force.name();
            let felt = forces(&mut *force, &x);
            let mut slopes = vec![DMat2::ZERO; x.len()];
            prop_assert!(force.add_slope(&curve(&x, &[], 0.0), &mut slopes));
            for i in 0..x.len() {
                for axis in [DVec2::X, DVec2::Y] {
                    let mut at = |by: f64| {
                        let mut x = x.clone();
                        x[i] += by * axis;
                        (force.energy(&curve(&x, &[], 0.0)).unwrap(), forces(&mut *force, &x)[i])
                    };
                    let ((high, after), (low, before)) = (at(1e-5), at(-1e-5));
                    // energies of some tens over 1e-5, and the third derivative
                    let expected = -(high - low) / 2e-5;
                    prop_assert!((0.8 * felt[i].dot(axis) - expected).abs() < 1e-6, "{name}");
                    prop_assert!((slopes[i] * axis - (after - before) / 2e-5).length() < 1e-4, "{name}");
                }
            }
            let bound = force.pull(0.8, None).stiffness;
            let mut moved = |by: f64| {
                let x: Vec<DVec2> = x.iter().zip(&way).map(|(x, w)| *x + by * *w).collect();
                forces(&mut *force, &x)
            };
            let (high, low) = (moved(1e-5), moved(-1e-5));
            let back = (0..x.len()).map(|i| (low[i] - high[i]).dot(way[i])).sum::<f64>() / 2e-5;
            prop_assert!(back <= (bound + 1e-5) * squares, "{name}: {back} {bound}");
        }
    }
}

#[test]
fn a_repulsor_pushes_its_strength_at_most_and_nothing_beyond_its_reach() {
    let mut push = Repulsor::new(DVec2::ZERO, 3.0, 2.5);
    let at = |push: &mut Repulsor, x: f64| forces(push, &[DVec2::X * x])[0].x;
    assert!((at(&mut push, 3.0 / 5.0_f64.sqrt()) - 2.5).abs() < 1e-14);
    for i in 0..=100 {
        assert!(at(&mut push, 0.04 * f64::from(i)) <= 2.5 + 1e-14);
    }
    for x in [0.0, 3.0, 7.0] {
        assert_eq!(at(&mut push, x), 0.0);
    }
}

#[test]
fn a_spring_takes_hold_of_the_nearest_point_whatever_lies_there() {
    let x = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (4.0, 4.0)].map(DVec2::from);
    let grip = |from: (f64, f64), closed| {
        Spring::at_nearest(&x, closed, DVec2::from(from), DVec2::ZERO, 1.0)
            .unwrap()
            .grip()
    };
    assert_eq!(grip((1.0, -2.0), false), (0, 0.25));
    assert_eq!(grip((9.0, -2.0), false), (1, 0.0));
    // nodes that coincide are one point; the edge back to the start is there if closed
    assert_eq!(grip((9.0, 9.0), false).1, 0.0);
    assert_eq!(grip((1.0, 2.0), true), (3, 0.625));
    assert_eq!(grip((1.0, 2.0), false), (0, 0.25));
    assert!(Spring::at_nearest(&x[..1], true, DVec2::ZERO, DVec2::ZERO, 1.0).is_err());
    assert!(Spring::at_nearest(&x, true, DVec2::NAN, DVec2::ZERO, 1.0).is_err());
}

#[test]
fn the_pull_of_a_spring_does_not_depend_on_the_number_of_nodes() {
    let shift = |n: usize| {
        let x = elastic::circle(DVec2::ZERO, 5.0, n);
        let body = Body::of(&x, Topology::Closed, 1.0).unwrap();
        let body = body.with_material(Material::uniform(0.0, 200.0, 50.0));
        let spring = Spring::at_node(0, DVec2::X * 8.0, 3.0);
        let mut snake = Snake::new(body, World::default().with(spring)).unwrap();
        let mut state = State::at_rest(x);
        let scheme = Scheme::Newmark;
        let mut stepper = scheme
            .start(&mut snake, &state, 0.02, Start::SecondOrder)
            .unwrap();
        let go = &mut |_: &mut Snake, _: &State| ControlFlow::Continue(());
        common::run(&mut snake, &mut *stepper, &mut state, 100, go).unwrap();
        snake.center(&state.x).x
    };
    let (few, many) = (shift(24), shift(96));
    // a regular polygon's length is short of the circle's by (π/n)²/6: 0.3 % of the mass at 24
    assert!(few > 0.1 && (few / many - 1.0).abs() < 0.01, "{few} {many}");
}

#[test]
fn values_that_will_not_do_are_refused_and_nothing_changes() {
    let mut snake = ring();
    let bad: [Box<dyn Force>; 7] = [
        Box::new(Spring::at_node(40, DVec2::ZERO, 1.0)),
        Box::new(Spring::at_node(0, DVec2::NAN, 1.0)),
        Box::new(Spring::at_node(0, DVec2::ZERO, -1.0)),
        Box::new(Spring::at_node(0, DVec2::ZERO, 1.0).with_damping(f64::NAN)),
        Box::new(Repulsor::new(DVec2::ZERO, 0.0, 1.0)),
        Box::new(Repulsor::new(DVec2::ZERO, 1.0, f64::INFINITY)),
        Box::new(Freeze::new(&[DVec2::ZERO; 99], 40..41, 1.0).unwrap()),
    ];
    for force in bad {
        assert!(snake.add_force(Acting::boxed(force)).is_err());
    }
    let spring = || Acting::new(Spring::at_node(0, DVec2::ZERO, 1.0));
    let missing = snake.replace_force("spring", spring());
    assert!(matches!(missing, Err(SnakeError::NoSuchForce { name }) if name == "spring"));
    assert!(matches!(
        snake.hold([0, 40]),
        Err(SnakeError::NoSuchNode { node: 40, .. })
    ));
    assert!(!snake.held().contains(&true) && snake.world().forces.len() == 1);
    assert!(snake.remove_force("spring").is_none());
}

/// A soft ring in a field that turns.
fn ring() -> Snake {
    let x = Grid::from_shape_fn((40, 40), |(y, _)| 0.4 * (y as f64 - 20.0));
    let y = Grid::from_shape_fn((40, 40), |(_, x)| -0.1 * (x as f64 - 20.0));
    let whirl = Arc::new(ForceField::from_components(&x, &y).unwrap());
    let body = Body::of(&start().x, Topology::Closed, 1.0)
        .unwrap()
        .with_material(Material::uniform(0.1, 3.0, 2.0))
        .with_damping(0.3);
    let world = World::default().with_image(whirl, Sampling::Bilinear);
    Snake::new(body, world).unwrap()
}

fn start() -> State {
    State::at_rest(elastic::circle(DVec2::splat(20.0), 6.5, 40))
}

/// What a busy hand does in a run of time 4, by quarters of a unit; the largest gap of the account, against the largest term.
fn busy(scheme: Scheme, dt: f64, book_first: bool) -> (f64, snake::Energies) {
    let (mut snake, mut state) = (ring(), start());
    let mut ledger = Ledger::begin(&mut snake, &state).unwrap();
    let first = ledger.energies(&mut snake, &state).total();
    let mut stepper = scheme
        .start(&mut snake, &state, dt, Start::SecondOrder)
        .unwrap();
    let quarter = (0.25 / dt).round();
    let (mut gap, mut largest) = (0.0_f64, 0.0_f64);
    let outcome = common::run(
        &mut snake,
        &mut *stepper,
        &mut state,
        1_000_000,
        &mut |snake, state| {
            if book_first {
                ledger.book(snake, state).unwrap();
            }
            let away = state.x[5] + DVec2::new(4.0, -3.0);
            let spring = |k: f64| Acting::new(Spring::at_node(5, away, k));
            let now = state.step as f64 / quarter;
            let at = |quarters: f64| now == quarters;
            if at(2.0) {
                snake.add_force(spring(9.0)).unwrap();
            } else if at(3.0) {
                let path = Path::new(vec![(0.5, away), (3.0, DVec2::splat(20.0))]).unwrap();
                let drag = Spring::at_nearest(&state.x, true, DVec2::ZERO, path, 6.0).unwrap();
                snake
                    .add_force(Acting::new(drag.with_damping(1.0)).named("drag"))
                    .unwrap();
            } else if at(5.0) {
                snake.replace_force("spring", spring(25.0)).unwrap();
            } else if at(6.0) {
                snake.remove_force("spring").unwrap();
                snake
                    .add_force(Acting::new(Repulsor::new(DVec2::new(16.0, 18.0), 5.0, 3.0)))
                    .unwrap();
            } else if at(8.0) {
                snake.hold(20..24).unwrap();
            } else if at(10.0) {
                snake.remove_force("drag").unwrap();
                snake.release(20..24).unwrap();
                let frozen = Freeze::new(&state.x, 30..34, 4.0).unwrap();
                snake.add_force(Acting::new(frozen)).unwrap();
            } else if at(12.0) {
                let mut body = snake.body().clone();
                body.material = Material::uniform(0.1, 6.0, 2.0);
                snake.set_body(body).unwrap();
            }
            if !book_first {
                ledger.book(snake, state).unwrap();
            }
            // a change that is not booked yet is no gap
            if book_first && (2..=12).any(|q| at(f64::from(q))) {
                return ControlFlow::Continue(());
            }
            let energies = ledger.energies(snake, state);
            gap = gap.max((energies.total() - first).abs());
            largest = energies
                .values()
                .iter()
                .fold(largest, |a, e| a.max(e.abs()));
            if at(16.0) {
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        },
    );
    assert!(outcome.is_ok(), "{outcome:?}");
    (gap / largest, ledger.energies(&mut snake, &state))
}

#[test]
fn the_account_closes_while_forces_come_and_go() {
    // leapfrog and Newmark's method feel the drag's damper half a step late or more: order 1, as imex anyway
    for (scheme, small, order) in [
        (Scheme::Leapfrog, 3e-4, 0.8),
        (Scheme::Rk4, 2e-9, 3.5),
        (Scheme::Newmark, 3e-4, 0.9),
        (Scheme::Imex, 0.06, 0.8),
    ] {
        let (coarse, _) = busy(scheme, 0.01, true);
        let (fine, energies) = busy(scheme, 0.005, true);
        let found = (coarse / fine).log2();
        let closes = fine < small && found > order;
        assert!(closes, "{}: {fine}, order {found}", scheme.name());
        assert!(energies.hand.abs() > 1.0);
        // whether one books before the change or after it
        assert_eq!(busy(scheme, 0.005, false).1, energies);
    }
}

#[test]
fn the_hand_is_booked_what_the_spring_holds_when_it_is_set_and_let_go() {
    let (mut snake, mut state) = (ring(), start());
    let mut ledger = Ledger::begin(&mut snake, &state).unwrap();
    let mut stepper = Scheme::Leapfrog
        .start(&mut snake, &state, 0.01, Start::SecondOrder)
        .unwrap();
    let (mut set, mut gone) = (0.0, 0.0);
    let k = 9.0;
    common::run(
        &mut snake,
        &mut *stepper,
        &mut state,
        400,
        &mut |snake, state| {
            ledger.book(snake, state).unwrap();
            let target = DVec2::new(30.0, 20.0);
            let held = 0.5 * k * state.x[5].distance_squared(target);
            if state.step == 100 {
                set = held;
                let spring = Acting::new(Spring::at_node(5, target, k));
                snake.add_force(spring).unwrap();
            } else if state.step == 300 {
                gone = held;
                assert_eq!(snake.remove_force("spring").unwrap().name(), "spring");
            }
            ControlFlow::Continue(())
        },
    )
    .unwrap();
    let energies = ledger.energies(&mut snake, &state);
    assert_eq!(energies.forces.len(), 1);
    assert!(set > gone + 1.0, "{set} {gone}");
    assert!((energies.hand - (gone - set)).abs() < 1e-10 * set);
}

#[test]
fn a_hand_keeps_its_hold_when_the_nodes_are_spaced_anew() {
    let x = elastic::circle(DVec2::ZERO, 10.0, 40);
    for edge in [0.5, 4.0] {
        let bounds = outline::Bounds::around(edge);
        let plan = outline::respace(&x, true, &bounds, outline::Between::Chord, &[]).unwrap();
        let new = plan.draw(&x).unwrap();
        let n = new.len();
        assert!(n != 40);
        let mut spring = Spring::at_node(11, DVec2::ZERO, 1.0);
        spring.carry(&plan);
        let (node, share) = spring.grip();
        assert!(share == 0.0 && new[node].distance(x[11]) <= 1.6, "{n}");
        let mut frozen = Freeze::new(&x, 10..20, 1.0).unwrap();
        frozen.carry(&plan);
        let energy = frozen.energy(&curve(&new, &[], 0.0)).unwrap();
        // at the places they were frozen at, up to the bend of the circle between them
        let count = frozen.nodes().count();
        assert!(
            count > 2 && energy < 0.02 * count as f64,
            "{n}: {count} {energy}"
        );
    }
}

#[test]
fn held_nodes_stay_to_the_last_bit_and_move_again_when_let_go() {
    for scheme in Scheme::ALL.iter().copied() {
        let (mut snake, mut state) = (ring(), start());
        let mut stepper = scheme
            .start(&mut snake, &state, 0.005, Start::SecondOrder)
            .unwrap();
        let mut kept = DVec2::ZERO;
        common::run(
            &mut snake,
            &mut *stepper,
            &mut state,
            150,
            &mut |snake, state| {
                match state.step {
                    50 => {
                        snake.hold([7, 8]).unwrap();
                        kept = state.x[8];
                    }
                    51..=100 => assert_eq!(state.x[8], kept, "{}", scheme.name()),
                    _ => {}
                }
                if state.step == 100 {
                    assert_eq!(state.v[8], DVec2::ZERO, "{}", scheme.name());
                    snake.release([7, 8]).unwrap();
                }
                ControlFlow::Continue(())
            },
        )
        .unwrap();
        assert!(state.x[8].distance(kept) > 1e-3, "{}", scheme.name());
    }
}

#[test]
fn a_run_that_is_paused_and_changed_goes_on_as_if_it_had_never_stopped() {
    // held from step 40 to 80, in one go
    let whole = |snake: &mut Snake, state: &State| {
        match state.step {
            40 => snake.hold([3]).unwrap(),
            80 => snake.release([3]).unwrap(),
            _ => {}
        }
        ControlFlow::Continue(())
    };
    let (mut snake, mut once) = (ring(), start());
    let mut stepper = Scheme::Leapfrog
        .start(&mut snake, &once, 0.005, Start::SecondOrder)
        .unwrap();
    common::run(
        &mut snake,
        &mut *stepper,
        &mut once,
        120,
        &mut |snake, state| whole(snake, state),
    )
    .unwrap();
    // the same, stopped by the observer after 20 and after 60, and run again
    let (mut snake, mut state) = (ring(), start());
    let mut stepper = Scheme::Leapfrog
        .start(&mut snake, &state, 0.005, Start::SecondOrder)
        .unwrap();
    for stop in [20, 60, 120] {
        let outcome = common::run(
            &mut snake,
            &mut *stepper,
            &mut state,
            stop,
            &mut |snake, state| {
                let on = whole(snake, state);
                if state.step < stop {
                    on
                } else {
                    ControlFlow::Break(())
                }
            },
        );
        assert_eq!((outcome, state.step), (Ok(()), stop));
    }
    assert_eq!(state.x, once.x);
    assert_eq!(state.v, once.v);
}
