//! The account of energies closes where parameters change with place.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a snake that cannot be built should stop it"
)]

use crate::strays;

use crate::common;

use std::ops::ControlFlow;
use std::sync::Arc;

use elastic::{Material, Topology};
use field::{ForceField, Grid, Map};
use glam::DVec2;
use integrator::{Scheme, Start, State};
use proptest as _;
use snake::{
    Body, Contact, Damping, Energies, Frame, Ledger, Maps, Pace, Sampling, Schedule, Simulation,
    Snake, Stepping, Upkeep, Wall, WallLaw, World,
};
use {banded as _, lanes as _, outline as _, thiserror as _};

fn map(factor: impl Fn(f64, f64) -> f64) -> Option<Arc<Map>> {
    let grid = Grid::from_shape_fn((64, 64), |(y, x)| factor(x as f64, y as f64));
    Some(Arc::new(Map::new(&grid).unwrap()))
}

fn bumps(x: f64, y: f64) -> f64 {
    1.0 + 0.4 * (0.5 * x).sin() + 0.4 * (0.4 * y + 0.1 * x).cos()
}

/// A force that is no gradient.
fn whirl() -> Arc<ForceField> {
    let x = Grid::from_shape_fn((64, 64), |(y, _)| 0.1 * (y as f64 - 30.0));
    let y = Grid::from_shape_fn((64, 64), |(_, x)| -0.05 * (x as f64 - 30.0));
    Arc::new(ForceField::from_components(&x, &y).unwrap())
}

/// An oval that is bent, turns and flies, with a map for each of its parameters.
fn oval() -> (Body, State) {
    let n = 24;
    let nodes = elastic::ellipse(DVec2::new(30.0, 31.0), DVec2::new(12.0, 7.0), 0.3, n);
    let mut body = Body::of(
        &elastic::circle(DVec2::ZERO, 10.0, n),
        Topology::Closed,
        1.0,
    )
    .unwrap()
    .with_material(Material::uniform(0.05, 3.0, 2.0))
    .with_damping(0.2);
    body.maps = Maps {
        tether: map(bumps),
        tension: map(|x, y| bumps(y, x)),
        rigidity: map(|x, y| bumps(x + 5.0, y)),
        mass: map(|x, y| bumps(x, y + 9.0)),
        damping: map(|x, y| bumps(x + y, y)),
        every: 0.0,
    };
    let mut state = State::at_rest(nodes);
    for (x, v) in state.x.iter().zip(&mut state.v) {
        *v = DVec2::new(0.7, -0.4) + 0.1 * (*x - DVec2::new(30.0, 31.0)).perp();
    }
    (body, state)
}

/// How far the sum of all terms gets from what it was, as a share of the largest of them.
fn gap(body: &Body, world: &World, start: &State, scheme: Scheme, dt: f64) -> (f64, Energies) {
    let mut snake = Snake::new(body.clone(), world.clone()).unwrap();
    let ledger = Ledger::begin(&mut snake, start).unwrap();
    let ledger = ledger
        .under(scheme, Start::SecondOrder, &mut snake)
        .unwrap();
    strays::over_four(&mut snake, ledger, start, scheme, dt)
}

#[test]
fn the_account_closes_to_rounding_for_the_schemes_of_known_algebra() {
    let (mut body, start) = oval();
    body.schedules.rigidity = Some(Schedule::new(vec![(0.0, 1.0), (40.0, 3.0)]).unwrap());
    body.schedules.mass = Some(Schedule::new(vec![(0.0, 1.0), (40.0, 2.0)]).unwrap());
    let world = World::default()
        .with_gravity(DVec2::new(0.2, 0.5))
        .with_image(whirl(), Sampling::Bilinear);
    let still = |every: f64| {
        let mut body = body.clone();
        body.maps.every = every;
        body
    };
    let mut report = body.clone();
    report.frame = Frame::report();
    // the report's scheme forms places of 30 from terms of 2 μ x/dt²: some roundings of x/dt in the velocity
    for (body, scheme, bound) in [
        (&body, Scheme::Leapfrog, 1e-13),
        (&body, Scheme::Report, 1e-9),
        (&report, Scheme::Report, 1e-9),
        (&report, Scheme::Leapfrog, 1e-13),
        (&still(0.3), Scheme::Leapfrog, 1e-13),
        (&still(0.3), Scheme::Report, 1e-9),
    ] {
        let (gap, energies) = gap(body, &world, &start, scheme, 0.02);
        assert!(gap < bound, "{scheme}: {gap}");
        assert!(energies.parameters.abs() > 0.01, "{scheme}: {energies:?}");
    }
}

#[test]
fn the_account_closes_by_the_order_of_other_schemes() {
    let (mut body, start) = oval();
    // smooth on the scale of a step: the corners of a bilinear map are not what is asked here
    for map in [
        &mut body.maps.tether,
        &mut body.maps.tension,
        &mut body.maps.rigidity,
        &mut body.maps.mass,
        &mut body.maps.damping,
    ] {
        *map = self::map(|x, y| 0.5 + 0.01 * x + 0.01 * y);
    }
    let world = World::default().with_image(whirl(), Sampling::Bilinear);
    for (scheme, order) in [
        (Scheme::Imex, 1.0),
        (Scheme::BackwardEuler, 1.0),
        (Scheme::LinearlyImplicit, 1.0),
        (Scheme::Newmark, 2.0),
        (Scheme::Gauss4, 2.0),
        (Scheme::Rk4, 2.0),
    ] {
        let at = |dt: f64| gap(&body, &world, &start, scheme, dt).0;
        let (coarse, fine) = (at(0.02), at(0.01));
        assert!(fine < 0.02, "{scheme}: {fine}");
        let found = (coarse / fine).log2();
        assert!(found > order - 0.3, "{scheme}: order {found}");
    }
}

#[test]
fn the_account_closes_at_walls_in_a_turning_frame_and_with_inner_damping() {
    let (body, start) = oval();
    let floor = |law| Wall::new(DVec2::new(0.0, 41.0), DVec2::NEG_Y, law).unwrap();
    let impact = WallLaw::Impact {
        restitution: 0.5,
        friction: 0.2,
    };
    let world = World::default()
        .with_gravity(DVec2::new(0.0, 2.0))
        .with_wall(floor(impact));
    let (open, energies) = gap(&body, &world, &start, Scheme::Leapfrog, 0.02);
    assert!(
        energies.contact > 0.1 && open < 1e-12,
        "{open} {energies:?}"
    );
    let mut inner = body.clone();
    inner.internal = 0.1;
    let (open, _) = gap(&inner, &World::default(), &start, Scheme::Leapfrog, 0.01);
    assert!(open < 1e-12, "{open}");
    // a turning rest shape is not quadratic: order 5 in the way of a step, so 4 in all
    let mut turning = body;
    turning.frame = Frame::turning();
    let at = |dt: f64| gap(&turning, &World::default(), &start, Scheme::Leapfrog, dt).0;
    let (coarse, fine) = (at(0.04), at(0.02));
    assert!(fine < 1e-6 && coarse / fine > 4.0, "{coarse} {fine}");
}

#[test]
fn what_a_map_puts_in_is_booked_under_parameters() {
    // nothing but a change of mass: a front that flies over a ramp of it
    let nodes: Vec<DVec2> = (0..6)
        .map(|i| DVec2::new(4.0, 10.0 + f64::from(i)))
        .collect();
    let mut body = Body::of(&nodes, Topology::open(elastic::End::Free), 1.0).unwrap();
    body.maps.mass = map(|x, _| 0.5 * x.max(1.0));
    let mut start = State::at_rest(nodes);
    start.v.fill(DVec2::new(2.0, 0.0));
    let (gap, energies) = gap(&body, &World::default(), &start, Scheme::Leapfrog, 0.0625);
    // ½ h Σ Δμ v², with Δμ = 0.5 · 8 over the way
    let put_in = 0.5 * 6.0 * 4.0 * 4.0;
    assert!(gap < 1e-13);
    assert!((energies.parameters + put_in).abs() < 1e-11, "{energies:?}");
}

#[test]
fn chosen_steps_agree_with_short_ones_and_their_account_closes() {
    let (body, start) = oval();
    let mut snake = Snake::new(body.clone(), World::default()).unwrap();
    let mut state = start.clone();
    let mut pace = Pace::chosen(Scheme::Leapfrog, &mut snake, &state, 0.25, 1e-6).unwrap();
    let ledger = Ledger::begin(&mut snake, &state).unwrap();
    let mut ledger = ledger
        .under(Scheme::Leapfrog, Start::SecondOrder, &mut snake)
        .unwrap();
    let first = ledger.energies(&mut snake, &state).total();
    let mut worst = 0.0_f64;
    let outcome = common::run(
        &mut snake,
        pace.stepper(),
        &mut state,
        16,
        &mut |snake, state| {
            ledger.book(snake, state).unwrap();
            worst = worst.max((ledger.energies(snake, state).total() - first).abs());
            ControlFlow::Continue(())
        },
    );
    assert!(outcome.is_ok() && pace.summary().unwrap().made > 100);
    assert!(worst < 1e-11 * first, "{worst} of {first}");
    let mut twin = Snake::new(body, World::default()).unwrap();
    let mut fine = start;
    let mut stepper = Scheme::Rk4
        .start(&mut twin, &fine, 1.0 / 512.0, Start::SecondOrder)
        .unwrap();
    for _ in 0..2048 {
        stepper.step(&mut twin, &mut fine).unwrap();
    }
    for (a, b) in state.x.iter().zip(&fine.x) {
        assert!(a.distance(*b) < 2e-3, "{}", a.distance(*b));
    }
}

#[test]
fn a_ledger_and_a_second_run_change_no_byte() {
    let (body, start) = oval();
    for scheme in [
        Scheme::Leapfrog,
        Scheme::Report,
        Scheme::Newmark,
        Scheme::Imex,
    ] {
        let last = |booked: bool| {
            let mut snake = Snake::new(body.clone(), World::default()).unwrap();
            snake.damp(Damping::Renewed(0.5), &start).unwrap();
            let mut state = start.clone();
            let mut stepper = scheme
                .start(&mut snake, &state, 0.02, Start::SecondOrder)
                .unwrap();
            let mut ledger = Ledger::begin(&mut snake, &state).unwrap();
            common::run(
                &mut snake,
                &mut *stepper,
                &mut state,
                100,
                &mut |snake, state| {
                    if booked {
                        ledger.book(snake, state).unwrap();
                    }
                    ControlFlow::Continue(())
                },
            )
            .unwrap();
            state
        };
        assert_eq!(last(true), last(false), "{scheme}");
        assert_eq!(last(true), last(true), "{scheme}");
    }
}

#[test]
fn damping_chosen_again_and_again_leaves_the_account_closed() {
    for (scheme, open) in [(Scheme::Leapfrog, 1e-12), (Scheme::Report, 1e-9)] {
        let (body, start) = oval();
        let mut snake = Snake::new(body, World::default()).unwrap();
        // with the stiffness that the map lends the nodes where they are
        snake.damp(Damping::Renewed(0.3), &start).unwrap();
        let chosen = snake.body().damping.clone();
        let mut state = start;
        let mut stepper = scheme
            .start(&mut snake, &state, 0.01, Start::SecondOrder)
            .unwrap();
        let mut ledger = Ledger::begin(&mut snake, &state)
            .and_then(|ledger| ledger.under(scheme, Start::SecondOrder, &mut snake))
            .unwrap();
        let first = ledger.energies(&mut snake, &state).total();
        for _ in 0..300 {
            stepper.step(&mut snake, &mut state).unwrap();
            ledger.book(&mut snake, &state).unwrap();
            let gap = (ledger.energies(&mut snake, &state).total() - first).abs();
            // rounding of places over the step is in the report's velocities (D21)
            assert!(gap < open * first, "{scheme}: {gap} of {first}");
        }
        assert_ne!(snake.body().damping, chosen, "it never changed");
    }
}

#[test]
fn a_hand_may_change_maps_in_a_run_and_the_account_closes() {
    for (scheme, open) in [(Scheme::Leapfrog, 1e-11), (Scheme::Report, 1e-9)] {
        let (body, start) = oval();
        let mut snake = Snake::new(body, World::default()).unwrap();
        let mut state = start;
        let mut stepper = scheme
            .start(&mut snake, &state, 0.02, Start::SecondOrder)
            .unwrap();
        let ledger = Ledger::begin(&mut snake, &state).unwrap();
        let mut ledger = ledger
            .under(scheme, Start::SecondOrder, &mut snake)
            .unwrap();
        let first = ledger.energies(&mut snake, &state).total();
        let mut worst = 0.0_f64;
        common::run(
            &mut snake,
            &mut *stepper,
            &mut state,
            200,
            &mut |snake, state| {
                if state.step == 100 {
                    let mut body = snake.body().clone();
                    body.maps.rigidity = map(|_, _| 2.0);
                    body.maps.mass = None;
                    snake.set_body(body).unwrap();
                }
                ledger.book(snake, state).unwrap();
                worst = worst.max((ledger.energies(snake, state).total() - first).abs());
                ControlFlow::Continue(())
            },
        )
        .unwrap();
        let energies = ledger.energies(&mut snake, &state);
        assert!(
            energies.hand.abs() > 0.1 && worst < open * first,
            "{scheme}: {worst}"
        );
    }
}

#[test]
fn a_crowd_on_a_map_closes_its_account_and_keeps_its_momentum() {
    let ball = |x: f64, speed: f64| {
        let nodes = elastic::circle(DVec2::new(x, 30.0), 6.0, 24);
        let mut body = Body::of(&nodes, Topology::Closed, 1.0)
            .unwrap()
            .with_material(Material::uniform(0.0, 6.0, 6.0));
        body.maps.rigidity = map(bumps);
        body.maps.tension = map(bumps);
        let mut state = State::at_rest(nodes);
        state.v.fill(DVec2::new(speed, 0.0));
        (Snake::new(body, World::default()).unwrap(), state)
    };
    let timing = Stepping {
        scheme: Scheme::Leapfrog,
        dt: 0.01,
        tolerance: None,
        relax: None,
        each: false,
        start: Start::SecondOrder,
        force: false,
    };
    let contact = Contact {
        stiffness: 8.0,
        damping: 0.0,
        friction: 0.0,
        wall_friction: 0.0,
        stick: 1.0,
        adhesion: 0.0,
        range: 0.1,
        gap: 1.0,
        stop: 0.1,
        own: false,
    };
    let two = vec![ball(16.0, 2.0), ball(32.0, -1.0)];
    let mut crowd =
        common::simulation(two, timing, (Some(contact), Upkeep::default()), true).unwrap();
    let momentum = |crowd: &Simulation| -> DVec2 {
        let members = crowd.members().iter();
        members.flat_map(|member| member.state().v.iter()).sum()
    };
    let (before, first) = (momentum(&crowd), crowd.energies().total());
    for _ in 0..1000 {
        assert!(crowd.step().unwrap().is_continue());
    }
    // they have bounced
    assert!(crowd.members()[0].state().v.iter().sum::<DVec2>().x < 0.0);
    assert!(momentum(&crowd).distance(before) < 1e-10);
    // kicks around steps are a scheme of their own, whose account is open by order two
    let open = (crowd.energies().total() - first).abs() / first;
    assert!(open < 2e-3, "{open}");
}
