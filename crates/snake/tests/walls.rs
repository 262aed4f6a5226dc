//! Every scheme at every kind of wall: what comes back is what the law asks for, and never more than went in.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a snake that cannot be built should stop it"
)]

use crate::common;

use std::ops::ControlFlow;

use elastic::{Material, Topology};
use glam::DVec2;
use integrator::{Scheme, Start, State};
use proptest as _;
use snake::{Body, Ledger, Snake, Wall, WallLaw, World};
use {banded as _, field as _, outline as _, thiserror as _};

/// A wall's law, in words, and the share of the normal speed it should return.
fn laws() -> [(&'static str, WallLaw, f64); 6] {
    let impact = |restitution| WallLaw::Impact {
        restitution,
        friction: 0.0,
    };
    let penalty = |damping| WallLaw::Penalty {
        stiffness: 100.0,
        damping,
    };
    // μ = 1, so ζ = c / (2 √k)
    let zeta: f64 = 0.25;
    let back = (-2.0 * zeta * zeta.acos() / (1.0 - zeta * zeta).sqrt()).exp();
    [
        ("clamp", WallLaw::Clamp, 0.0),
        ("impact 0", impact(0.0), 0.0),
        ("impact 0.5", impact(0.5), 0.5),
        ("impact 1", impact(1.0), 1.0),
        ("penalty, undamped", penalty(0.0), 1.0),
        ("penalty, damped", penalty(20.0 * zeta), back),
    ]
}

/// A rod of twelve nodes or a ball of twenty, in flight towards the wall x = 0, which no step ends at exactly.
fn flying(ball: bool, law: WallLaw) -> (Snake, State) {
    let wall = Wall::new(DVec2::ZERO, DVec2::X, law).unwrap();
    let (nodes, topology) = if ball {
        (
            elastic::circle(DVec2::new(4.0, 0.3), 3.0, 20),
            Topology::Closed,
        )
    } else {
        let (from, to) = (DVec2::new(0.5003, -3.0), DVec2::new(0.5003, 3.0));
        (
            elastic::segment(from, to, 12),
            Topology::open(elastic::End::Free),
        )
    };
    let body = Body::of(&nodes, topology, 1.0)
        .unwrap()
        .with_material(Material::uniform(0.0, 20.0, 5.0));
    let snake = Snake::new(body, World::default().with_wall(wall)).unwrap();
    let mut state = State::at_rest(nodes);
    state.v.fill(DVec2::new(-2.0, 0.4));
    (snake, state)
}

/// The state after that time, and the most that kinetic, elastic and wall energy ever were together, as a share of what
/// there was; what a scheme holds back because its velocities are late is counted in.
fn after(scheme: Scheme, snake: &mut Snake, start: &State, dt: f64, time: f64) -> (State, f64) {
    let mut state = start.clone();
    let first = snake.energies(&state).mechanical();
    let mut ledger = Ledger::begin(snake, &state)
        .and_then(|ledger| ledger.under(scheme, Start::SecondOrder, snake))
        .unwrap();
    let mut most = 0.0_f64;
    let mut stepper = scheme.start(snake, &state, dt, Start::SecondOrder).unwrap();
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "some thousand"
    )]
    let steps = (time / dt).round() as u64;
    common::run(
        snake,
        &mut *stepper,
        &mut state,
        steps,
        &mut |snake, state| {
            ledger.book(snake, state).unwrap();
            let energies = ledger.energies(snake, state);
            most = most.max((energies.mechanical() + energies.scheme) / first);
            ControlFlow::Continue(())
        },
    )
    .unwrap();
    assert_eq!(state.step, steps, "{scheme} arrives");
    (state, most)
}

fn inert() -> impl Iterator<Item = Scheme> {
    let other = |scheme: &Scheme| *scheme != Scheme::GradientFlow;
    Scheme::ALL.iter().copied().filter(other)
}

#[test]
fn a_rod_comes_back_with_the_speed_the_law_asks_for_under_every_scheme() {
    for scheme in inert() {
        let mut row = format!("| `{}` |", scheme.name());
        for (name, law, asked) in laws() {
            // all nodes meet the wall together, so that nothing bends and the law alone decides
            let (mut snake, start) = flying(false, law);
            let (state, _) = after(scheme, &mut snake, &start, 1e-3, 1.5);
            let slowest = state.v.iter().map(|v| v.x).fold(f64::INFINITY, f64::min);
            let fastest = state
                .v
                .iter()
                .map(|v| v.x)
                .fold(f64::NEG_INFINITY, f64::max);
            assert!(
                fastest - slowest < 1e-9,
                "{scheme}, {name}: {slowest} {fastest}"
            );
            let back = 0.5 * (slowest + fastest) / 2.0;
            row += &format!(" {back:.4} |");
            // contacts by touch are exact; of a spring a scheme of order 1 makes ω dt/2 of its speed, ω = 10, over half a
            // period, and the moment of the meeting is known to a step
            let within = match (law, scheme.order()) {
                (WallLaw::Penalty { .. }, 1) => 0.02,
                (WallLaw::Penalty { .. }, _) => 0.005,
                _ => 1e-9,
            };
            assert!(
                (back - asked).abs() <= within,
                "{scheme}, {name}: {back} for {asked}"
            );
            // nothing rubs
            let along = state
                .v
                .iter()
                .map(|v| (v.y - 0.4).abs())
                .fold(0.0, f64::max);
            assert!(along < 1e-9, "{scheme}, {name}: {along}");
        }
        println!("{row}");
    }
}

#[test]
fn a_ball_at_any_wall_gains_no_energy_under_any_scheme() {
    for scheme in inert() {
        for (name, law, _) in laws() {
            let (mut snake, start) = flying(true, law);
            let (state, most) = after(scheme, &mut snake, &start, 1e-3, 6.0);
            // a spring's force changes within a step: explicit order 1 may swing by ω dt/2, ω = 10, of what it holds
            let swing = match (law, scheme.order()) {
                (WallLaw::Penalty { .. }, 1) => 5e-3,
                _ => 5e-4,
            };
            assert!(most <= 1.0 + swing, "{scheme}, {name}: {most}");
            let deepest = state.x.iter().map(|x| x.x).fold(f64::INFINITY, f64::min);
            assert!(deepest > -0.5, "{scheme}, {name}: {deepest}");
        }
    }
}

#[test]
fn a_ball_without_mass_stays_on_its_side_of_any_wall() {
    for (name, law, _) in laws() {
        let (snake, start) = flying(true, law);
        let mut body = snake.body().clone();
        body.damping = elastic::Profile::Uniform(1.0);
        let world = snake.world().clone().with_gravity(DVec2::new(-3.0, 0.0));
        let mut snake = Snake::new(body, world).unwrap();
        let (state, _) = after(Scheme::GradientFlow, &mut snake, &start, 1e-3, 6.0);
        let deepest = state.x.iter().map(|x| x.x).fold(f64::INFINITY, f64::min);
        // a spring gives way by what rests on it: 20 nodes of weight 3 on a few, k = 100
        let law_gives = if matches!(law, WallLaw::Penalty { .. }) {
            0.5
        } else {
            1e-12
        };
        assert!(deepest >= -law_gives && deepest < 0.5, "{name}: {deepest}");
    }
}
