//! The account of energies closes, and by the order it says.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a snake that cannot be built should stop it"
)]

use crate::strays;

use elastic::{Material, Topology};
use field::{ForceField, Grid};
use glam::DVec2;
use integrator::{Scheme, Start, State};
use proptest as _;
use snake::{Body, Energies, Ledger, Sampling, Schedule, Snake, Wall, WallLaw, World};
use std::sync::Arc;
use {banded as _, thiserror as _};

/// A smooth force that is no gradient: it turns.
fn whirl() -> Arc<ForceField> {
    let x = Grid::from_shape_fn((40, 40), |(y, _)| 0.4 * (y as f64 - 20.0));
    let y = Grid::from_shape_fn((40, 40), |(_, x)| -0.1 * (x as f64 - 20.0));
    Arc::new(ForceField::from_components(&x, &y).unwrap())
}

fn oval() -> (Body, State) {
    let nodes = elastic::ellipse(DVec2::splat(20.0), DVec2::new(8.0, 5.0), 0.3, 24);
    let mut body = Body::of(
        &elastic::circle(DVec2::ZERO, 6.5, 24),
        Topology::Closed,
        1.0,
    )
    .unwrap()
    .with_material(Material::uniform(0.1, 3.0, 2.0))
    .with_damping(0.3);
    body.schedules.rigidity = Some(Schedule::new(vec![(0.0, 1.0), (4.0, 3.0)]).unwrap());
    (body, State::at_rest(nodes))
}

/// Largest change of the sum of all terms, against the largest of them, over a time of 4.
fn gap(snake: &mut Snake, start: &State, scheme: Scheme, dt: f64) -> (f64, Energies) {
    let ledger = Ledger::begin(snake, start).unwrap();
    strays::over_four(snake, ledger, start, scheme, dt)
}

#[test]
fn the_sum_of_all_terms_stays_what_it_was_by_the_order_of_the_scheme() {
    let (body, state) = oval();
    let world = World::default()
        .with_gravity(DVec2::new(0.2, 0.5))
        .with_image(whirl(), Sampling::Bilinear);
    let snake = Snake::new(body, world).unwrap();
    for (scheme, order) in [
        (Scheme::Report, 1.0),
        (Scheme::Leapfrog, 2.0),
        (Scheme::Imex, 1.0),
        (Scheme::Newmark, 2.0),
        (Scheme::Sbdf2, 2.0),
        // what schedules put in is booked to second order, the rest to fourth
        (Scheme::Rk4, 2.0),
    ] {
        let at = |dt: f64| gap(&mut snake.clone(), &state, scheme, dt).0;
        let (coarse, fine) = (at(0.02), at(0.01));
        assert!(fine < 0.02, "{}: {fine}", scheme.name());
        let found = (coarse / fine).log2();
        // the largest gap need not fall at the same time in both runs
        assert!(found > order - 0.3, "{}: order {found}", scheme.name());
    }
}

/// The largest change of the sum in a single step, against the largest term, over a time of 1.2.
fn step_gap(snake: &mut Snake, start: &State, scheme: Scheme, dt: f64) -> f64 {
    let mut state = start.clone();
    let ledger = Ledger::begin(snake, &state).unwrap();
    let mut ledger = ledger.under(scheme, Start::SecondOrder, snake).unwrap();
    let mut sum = ledger.energies(snake, &state).total();
    let (mut gap, mut largest) = (0.0_f64, 0.0_f64);
    let mut stepper = scheme.start(snake, &state, dt, Start::SecondOrder).unwrap();
    while state.t < 1.2 - 0.5 * dt {
        stepper.step(snake, &mut state).unwrap();
        ledger.book(snake, &state).unwrap();
        let energies = ledger.energies(snake, &state);
        // what a scheme of two steps began with falls to a third in each, over ten of them and more
        if state.t > 0.41 {
            gap = gap.max((energies.total() - sum).abs());
        }
        sum = energies.total();
        let values = energies.values();
        largest = values.iter().fold(largest, |a, e| a.max(e.abs()));
    }
    gap / largest
}

#[test]
fn a_single_step_of_every_scheme_leaves_over_what_its_order_says() {
    let (mut body, state) = oval();
    body.schedules.rigidity = None;
    let world = World::default()
        .with_gravity(DVec2::new(0.2, 0.5))
        .with_image(whirl(), Sampling::Bilinear);
    let snake = Snake::new(body.clone(), world.clone()).unwrap();
    body.mass = elastic::Profile::Uniform(0.0);
    let massless = Snake::new(body, world).unwrap();
    for &scheme in Scheme::ALL {
        let name = scheme.name();
        let snake = if scheme == Scheme::GradientFlow {
            &massless
        } else {
            &snake
        };
        let at = |dt: f64| step_gap(&mut snake.clone(), &state, scheme, dt);
        let (coarse, fine) = (at(0.04), at(0.02));
        let found = (coarse / fine).log2();
        println!(
            "| `{name}` | {} | {fine:.0e} | {found:.1} |",
            scheme.order()
        );
        if matches!(scheme, Scheme::Report | Scheme::Leapfrog) {
            // by their algebra: rounding, of x / dt² under the report's
            assert!(fine < 1e-11, "{name}: {fine}");
            continue;
        }
        // one order more in a single step; Simpson's rule over the cubic errs by the fifth power
        let order = f64::from((scheme.order() + 1).min(5));
        // the largest gap need not fall at the same time in both runs
        assert!(
            found > order - 0.4,
            "{name}: order {found}, {coarse} {fine}"
        );
    }
}

#[test]
fn what_the_ledger_books_is_what_happens() {
    let (body, state) = oval();
    let world = World::default().with_image(whirl(), Sampling::Bilinear);
    let mut snake = Snake::new(body, world).unwrap();
    let (_, energies) = gap(&mut snake, &state, Scheme::Leapfrog, 0.01);
    assert!(energies.damping > 0.0);
    // the rigidity grew while the oval was bent: energy was put in
    assert!(energies.parameters < 0.0);
    assert!(energies.forces[0].abs() > 0.0);
    assert!(energies.contact.abs() < f64::MIN_POSITIVE);
}

#[test]
fn contacts_are_booked_with_what_they_take() {
    let ball = elastic::circle(DVec2::new(0.0, 2.0), 1.0, 16);
    let body = || {
        Body::of(&ball, Topology::Closed, 1.0)
            .unwrap()
            .with_material(Material::uniform(0.0, 6.0, 0.5))
    };
    for law in [
        WallLaw::Impact {
            restitution: 0.4,
            friction: 0.2,
        },
        WallLaw::Penalty {
            stiffness: 400.0,
            damping: 4.0,
        },
    ] {
        let world = World::default()
            .with_gravity(DVec2::new(0.0, -2.0))
            .with_wall(Wall::new(DVec2::ZERO, DVec2::Y, law).unwrap());
        let snake = Snake::new(body(), world).unwrap();
        let mut start = State::at_rest(ball.clone());
        start.v.fill(DVec2::new(0.5, -1.0));
        let at = |dt: f64| gap(&mut snake.clone(), &start, Scheme::Leapfrog, dt);
        let (coarse, _) = at(0.004);
        let (fine, energies) = at(0.001);
        // the moment of an impact is known to a step: first order
        assert!(
            fine < 0.01 && fine < 0.5 * coarse,
            "{law:?}: {coarse} {fine}"
        );
        let lost = energies.contact + energies.damping;
        assert!(lost > 0.5, "{law:?}: {lost}");
    }
}
