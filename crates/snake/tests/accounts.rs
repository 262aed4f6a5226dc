//! Accounts that must close where a term was left out before: absent inertial forces, holds, schemes without mass.
#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: a snake that cannot be built should stop it"
)]

use crate::common;

use std::ops::ControlFlow::Continue;

use elastic::{Material, Topology};
use glam::DVec2;
use integrator::{Scheme, Start, State};
use proptest as _;
use snake::{Body, Ledger, Schedule, Snake, Term, Turning, TurningStepper, World};
use {banded as _, field as _, outline as _, thiserror as _};

fn ellipse(a: f64, b: f64, n: usize) -> Vec<DVec2> {
    let circle = elastic::circle(DVec2::ZERO, 1.0, n);
    circle.iter().map(|p| *p * DVec2::new(a, b)).collect()
}

/// Spread of the total and the largest term there was, over a run that does not turn anything but what `hand` changes.
fn spread(
    snake: &mut Snake,
    stepper: &mut dyn integrator::Stepper,
    (ledger, state): (&mut Ledger, &mut State),
    steps: u64,
    hand: &mut dyn FnMut(&mut Snake, &State),
) -> (f64, f64) {
    let first = ledger.energies(snake, state).total();
    let (mut off, mut most) = (0.0_f64, 0.0_f64);
    common::run(snake, stepper, state, steps, &mut |snake, state| {
        ledger.book(snake, state).unwrap();
        let energies = ledger.energies(snake, state);
        off = off.max((energies.total() - first).abs());
        let terms = energies.values();
        most = terms.iter().fold(most, |most, term| most.max(term.abs()));
        hand(snake, state);
        Continue(())
    })
    .unwrap();
    (off, most)
}

fn spinning() -> (Snake, State) {
    let rest = ellipse(4.0, 2.6, 30);
    let mut body = Body::of(&rest, Topology::Closed, 1.2)
        .unwrap()
        .with_material(Material::uniform(0.5, 9.0, 4.0));
    body.frame = snake::Frame::turning();
    let mut state = State::at_rest(ellipse(4.4, 2.3, 30));
    for (v, x) in state.v.iter_mut().zip(&state.x) {
        *v = 0.9 * x.perp() + DVec2::new(0.3, -0.1);
    }
    (Snake::new(body, World::default()).unwrap(), state)
}

#[test]
fn what_the_absence_of_inertial_forces_puts_in_is_booked_as_the_frames() {
    let absent: [&[Term]; 5] = [
        &[],
        &[Term::Coriolis],
        &[Term::Centrifugal],
        &[Term::Transverse],
        &[Term::Coriolis, Term::Centrifugal],
    ];
    for terms in absent {
        let (mut snake, mut state) = spinning();
        let turning = Turning::new(&snake).unwrap();
        let turning = terms
            .iter()
            .fold(turning, |turning, &term| turning.without(term));
        let mut stepper =
            TurningStepper::new(turning, Scheme::Rk4, &state, 0.005, Start::SecondOrder).unwrap();
        let mut ledger = Ledger::begin(&mut snake, &state).unwrap();
        let whole = (&mut ledger, &mut state);
        let (off, most) = spread(&mut snake, &mut stepper, whole, 400, &mut |_, _| {});
        assert!(off < 1e-6 * most, "without {terms:?}: {off} of {most}");
        let frame = ledger.energies(&mut snake, &state).frame;
        assert_eq!(frame.abs() > 1e-3, !terms.is_empty(), "{terms:?}: {frame}");
    }
}

#[test]
fn a_hold_closes_to_rounding_with_internal_damping_and_with_schedules() {
    for (internal, mass, rigidity) in [
        (0.05, false, false),
        (0.0, true, false),
        (0.05, true, true),
        (0.0, false, true),
    ] {
        for dt in [0.02, 0.005] {
            let circle = elastic::circle(DVec2::splat(25.0), 9.0, 20);
            let rest = elastic::circle(DVec2::splat(25.0), 7.0, 20);
            let mut body = Body::of(&rest, Topology::Closed, 0.8)
                .unwrap()
                .with_material(Material::uniform(0.0, 12.0, 6.0))
                .with_damping(0.05);
            body.internal = internal;
            let growing = || Some(Schedule::new(vec![(0.0, 1.0), (6.0, 2.0)]).unwrap());
            body.schedules.mass = if mass { growing() } else { None };
            body.schedules.rigidity = if rigidity { growing() } else { None };
            let mut snake = Snake::new(body, World::default()).unwrap();
            let mut state = State::at_rest(circle);
            state.v.fill(DVec2::new(0.4, 0.2));
            let scheme = Scheme::Leapfrog;
            let mut stepper = scheme
                .start(&mut snake, &state, dt, Start::SecondOrder)
                .unwrap();
            let mut ledger = Ledger::begin(&mut snake, &state)
                .unwrap()
                .under(scheme, Start::SecondOrder, &mut snake)
                .unwrap();
            let mut hand = |snake: &mut Snake, state: &State| {
                if (state.t - 2.0).abs() < 0.5 * dt {
                    snake.hold([3, 6]).unwrap();
                }
                if (state.t - 4.0).abs() < 0.5 * dt {
                    snake.release([3, 6]).unwrap();
                }
            };
            let steps = (6.0 / dt).round() as u64;
            let whole = (&mut ledger, &mut state);
            let (off, most) = spread(&mut snake, &mut *stepper, whole, steps, &mut hand);
            assert!(
                off < 1e-11 * most,
                "β {internal}, mass {mass}, rigidity {rigidity}, dt {dt}: {off} of {most}"
            );
        }
    }
}

#[test]
fn gradient_flow_has_no_kinetic_energy_and_its_account_closes_with_the_step() {
    // γ ẋ = f: what elastic energy goes, damping takes; a velocity given at the start is none of the scheme's
    let mut off = Vec::new();
    for dt in [0.04, 0.02, 0.01] {
        let rest = elastic::circle(DVec2::ZERO, 5.0, 30);
        let body = Body::of(&rest, Topology::Closed, 3.0)
            .unwrap()
            .with_material(Material::uniform(0.2, 4.0, 1.0))
            .with_damping(2.0);
        let mut snake = Snake::new(body, World::default().with_gravity(DVec2::Y)).unwrap();
        let mut state = State::at_rest(ellipse(7.0, 4.0, 30));
        state.v.fill(DVec2::new(5.0, 0.0));
        let scheme = Scheme::GradientFlow;
        let mut stepper = scheme
            .start(&mut snake, &state, dt, Start::SecondOrder)
            .unwrap();
        let mut ledger = Ledger::begin(&mut snake, &state)
            .unwrap()
            .under(scheme, Start::SecondOrder, &mut snake)
            .unwrap();
        let steps = (3.0 / dt).round() as u64;
        let whole = (&mut ledger, &mut state);
        let (spread, most) = spread(&mut snake, &mut *stepper, whole, steps, &mut |_, _| {});
        assert_eq!(ledger.energies(&mut snake, &state).kinetic.to_bits(), 0);
        off.push(spread / most);
    }
    assert!(
        off[2] < 0.02 && off[2] < 0.6 * off[1] && off[1] < 0.6 * off[0],
        "{off:?}"
    );
}
