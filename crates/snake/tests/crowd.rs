//! Snakes that meet, divide, and are kept in order.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a snake that cannot be built should stop it"
)]

use crate::common;

use elastic::{Material, Topology};
use glam::DVec2;
use integrator::{Scheme, Start, State};
use proptest as _;
use snake::{
    Body, Contact, EventKind, Plastic, Pressure, Rest, Simulation, Snake, Stepping, Upkeep, Wall,
    WallLaw, World,
};
use {banded as _, field as _, outline as _, thiserror as _};

const LAYER: Contact = Contact {
    stiffness: 60.0,
    damping: 0.0,
    friction: 0.0,
    wall_friction: 0.0,
    stick: 1.0,
    adhesion: 0.0,
    range: 0.0,
    gap: 0.2,
    stop: 0.3,
    own: false,
};

fn timing(scheme: Scheme, dt: f64) -> Stepping {
    Stepping {
        scheme,
        dt,
        tolerance: None,
        relax: None,
        each: false,
        start: Start::SecondOrder,
        force: false,
    }
}

fn ball(center: DVec2, radius: f64, n: usize, v: DVec2) -> (Body, State) {
    let nodes = elastic::circle(center, radius, n);
    let body = Body::of(&nodes, Topology::Closed, 1.0)
        .unwrap()
        .with_material(Material::uniform(1.0, 20.0, 4.0));
    let mut state = State::at_rest(nodes);
    state.v.fill(v);
    (body, state)
}

fn free((body, state): (Body, State)) -> (Snake, State) {
    (Snake::new(body, World::default()).unwrap(), state)
}

fn two() -> Vec<(Snake, State)> {
    vec![
        free(ball(DVec2::new(0.0, 0.0), 3.0, 40, DVec2::new(2.0, 0.3))),
        free(ball(DVec2::new(7.5, 1.5), 2.0, 25, DVec2::new(-1.0, 0.0))),
    ]
}

#[test]
fn two_balls_that_meet_keep_momentum_under_every_scheme() {
    for scheme in [
        Scheme::Report,
        Scheme::Leapfrog,
        Scheme::Imex,
        Scheme::Newmark,
    ] {
        let mut crowd = common::simulation(
            two(),
            timing(scheme, 2e-3),
            (Some(LAYER), Upkeep::default()),
            true,
        )
        .unwrap();
        let p = crowd.momentum();
        let (mut met, mut deepest) = (0.0_f64, 0.0_f64);
        for _ in 0..2500 {
            assert!(crowd.step().unwrap().is_continue());
            met = met.max(crowd.energies().forces[1]);
            deepest = deepest.max(crowd.deepest());
        }
        assert!(met > 0.1, "{}: they never met", scheme.name());
        // the report's form of the step cancels digits: rounding times μ/dt²
        let off = crowd.momentum().distance(p) / p.length();
        assert!(off < 1e-8, "{}: {off}", scheme.name());
        // the stop, and the way of a step
        assert!(deepest < 0.3 + 0.01, "{}: {deepest}", scheme.name());
    }
}

#[test]
fn contacts_alone_keep_angular_momentum_too() {
    // dust without elasticity: a translating frame resists turning, and would hide what contacts do
    let mut snakes = two();
    for (snake, _) in &mut snakes {
        let dust = snake
            .body()
            .clone()
            .with_material(Material::uniform(0.0, 0.0, 0.0));
        snake.set_body(dust).unwrap();
    }
    let mut crowd = common::simulation(
        snakes,
        timing(Scheme::Leapfrog, 2e-3),
        (Some(LAYER), Upkeep::default()),
        true,
    )
    .unwrap();
    let (p, l) = (crowd.momentum(), crowd.angular_momentum());
    let mut met = 0.0_f64;
    for _ in 0..2500 {
        assert!(crowd.step().unwrap().is_continue());
        met = met.max(crowd.energies().forces[1]);
    }
    assert!(met > 0.1, "they never met");
    assert!(crowd.momentum().distance(p) < 1e-12 * p.length());
    assert!((crowd.angular_momentum() - l).abs() < 1e-11 * l.abs().max(p.length()));
}

/// Largest stray of the sum of all terms at the end of a step, the sum at the start, and the crowd after a time of 5.
fn stray(
    snakes: Vec<(Snake, State)>,
    scheme: Scheme,
    dt: f64,
    law: Contact,
) -> (f64, f64, Simulation) {
    let timing = timing(scheme, dt);
    let mut crowd =
        common::simulation(snakes, timing, (Some(law), Upkeep::default()), true).unwrap();
    let first = crowd.energies().total();
    let mut gap = 0.0_f64;
    while crowd.t() < 5.0 - 0.5 * dt {
        assert!(crowd.step().unwrap().is_continue());
        gap = gap.max((crowd.energies().total() - first).abs());
    }
    (gap, first, crowd)
}

#[test]
fn the_account_of_a_crowd_closes_to_rounding_at_any_step() {
    let law = Contact {
        damping: 1.0,
        friction: 0.3,
        ..LAYER
    };
    for (scheme, dt) in [
        (Scheme::Leapfrog, 4e-3),
        (Scheme::Leapfrog, 1e-3),
        (Scheme::Report, 4e-3),
    ] {
        let (gap, first, mut crowd) = stray(two(), scheme, dt, law);
        let lost = crowd.energies().contact;
        assert!(lost > 0.05, "damping and friction took {lost}");
        // nodes enter and leave the layer and pass from edge to edge; the report's form of the step loses digits: μ v x / dt² a step (D21)
        let digits = if scheme == Scheme::Report {
            1e-9
        } else {
            1e-13
        };
        assert!(gap < digits * first, "{}, {dt}: {gap}", scheme.name());
    }
}

#[test]
fn what_kicks_hold_back_is_a_leapfrogs_swing_and_no_more() {
    // dust: all that acts is the contacts, and nothing is lost until it is in folds, whose depths jump; what jumps is booked
    let mut snakes = two();
    for (snake, _) in &mut snakes {
        let dust = snake.body().clone();
        let dust = dust.with_material(Material::uniform(0.0, 0.0, 0.0));
        snake.set_body(dust).unwrap();
    }
    let timing = timing(Scheme::Leapfrog, 2e-3);
    let mut crowd =
        common::simulation(snakes, timing, (Some(LAYER), Upkeep::default()), true).unwrap();
    let first = crowd.energies();
    let (mut held, mut swing, mut lost) = (0.0_f64, 0.0_f64, 0.0_f64);
    for _ in 0..2500 {
        assert!(crowd.step().unwrap().is_continue());
        let now = crowd.energies();
        assert!((now.total() - first.total()).abs() < 1e-13 * first.total());
        if crowd.steps() < 800 {
            swing = swing.max(now.scheme.abs());
            held = held.max(now.forces[1]);
            lost = lost.max(now.contact.abs());
        }
    }
    assert!(held > 0.1, "they never met");
    // no impulse was needed, and no jump of a depth: edges follow each other without one
    assert!(lost < 1e-13 * first.total(), "{lost}");
    // a node pushes on two, so |C|² sums up to at most four times 2 k E, and S = ⅛ dt²/μ |C|²
    let most = 2e-3 * 2e-3 * LAYER.stiffness * held;
    assert!(swing > 0.0 && swing < most, "{swing} of {most}");
}

#[test]
fn without_an_account_a_crowd_moves_the_same() {
    let law = Contact {
        damping: 1.0,
        friction: 0.3,
        ..LAYER
    };
    let start = |energies: bool| {
        let stepping = Stepping::of(Scheme::Leapfrog, 2e-3);
        let rules = (Some(law), Upkeep::default());
        common::simulation(two(), stepping, rules, energies).unwrap()
    };
    let (mut with, mut without) = (start(true), start(false));
    for _ in 0..1500 {
        assert!(with.step().unwrap().is_continue());
        assert!(without.step().unwrap().is_continue());
    }
    for (a, b) in with.members().iter().zip(without.members()) {
        assert_eq!(a.state(), b.state());
    }
    assert!(with.energies().contact > 0.0);
    assert!(without.energies().contact.abs() < f64::MIN_POSITIVE);
}

#[test]
fn a_pile_in_a_box_comes_to_lie_without_deep_overlap() {
    let law = WallLaw::Impact {
        restitution: 0.3,
        friction: 0.3,
    };
    let mut snakes = Vec::new();
    for k in 0..6 {
        let at = DVec2::new(
            2.6 + 4.2 * f64::from(k % 2) + 0.3 * f64::from(k),
            3.0 + 4.5 * f64::from(k / 2),
        );
        let (body, state) = ball(at, 2.0, 24, DVec2::ZERO);
        let mut world = World::default().with_gravity(DVec2::new(0.0, -3.0));
        for (point, normal) in [
            (DVec2::ZERO, DVec2::Y),
            (DVec2::ZERO, DVec2::X),
            (DVec2::new(10.0, 0.0), DVec2::NEG_X),
        ] {
            world = world.with_wall(Wall::new(point, normal, law).unwrap());
        }
        let firm = Material::uniform(8.0, 200.0, 100.0);
        let body = body.with_material(firm).with_damping(0.5);
        snakes.push((Snake::new(body, world).unwrap(), state));
    }
    let law = Contact {
        stiffness: 200.0,
        damping: 4.0,
        friction: 0.3,
        ..LAYER
    };
    let mut crowd = common::simulation(
        snakes,
        timing(Scheme::Leapfrog, 2e-3),
        (Some(law), Upkeep::default()),
        true,
    )
    .unwrap();
    let mut deepest = 0.0_f64;
    for _ in 0..6000 {
        assert!(crowd.step().unwrap().is_continue());
        deepest = deepest.max(crowd.deepest());
    }
    // the stop, and the way of two steps at the speed of the fall, 12 at g 3
    assert!(deepest < 0.3 + 2.0 * 8.5 * 2e-3, "{deepest}");
    let energies = crowd.energies();
    assert!(energies.kinetic < 0.5, "{energies:?}");
}

#[test]
fn two_balls_pressed_together_come_to_rest_against_each_other() {
    let law = WallLaw::Penalty {
        stiffness: 60.0,
        damping: 0.0,
    };
    let mut snakes = Vec::new();
    for x in [2.0, 5.5] {
        let (body, state) = ball(DVec2::new(x, 0.0), 2.0, 24, DVec2::ZERO);
        let mut world = World::default();
        // a box too narrow for both, and too low to slip past each other
        for (point, normal) in [
            (DVec2::new(0.2, 0.0), DVec2::X),
            (DVec2::new(7.3, 0.0), DVec2::NEG_X),
            (DVec2::new(0.0, -2.1), DVec2::Y),
            (DVec2::new(0.0, 2.1), DVec2::NEG_Y),
        ] {
            world = world.with_wall(Wall::new(point, normal, law).unwrap());
        }
        snakes.push((Snake::new(body.with_damping(2.0), world).unwrap(), state));
    }
    let mut crowd = common::simulation(
        snakes,
        timing(Scheme::Leapfrog, 5e-3),
        (Some(LAYER), Upkeep::default()),
        true,
    )
    .unwrap();
    crowd.watch(Rest::default());
    while crowd.steps() < 30_000 && !crowd.is_at_rest() {
        assert!(crowd.step().unwrap().is_continue());
    }
    assert!(crowd.is_at_rest());
    let energies = crowd.energies();
    // at rest, and yet pressed: what is out of balance is a thousandth of what pushes
    assert!(
        energies.forces[1] > 0.01 && energies.kinetic < 1e-6,
        "{energies:?}"
    );
}

#[test]
fn re_spacing_keeps_mass_momentum_and_spin_and_books_its_energy() {
    let (mut body, mut state) = ball(DVec2::ZERO, 3.0, 30, DVec2::new(1.0, -0.5));
    // grows to twice its size, and spins
    body.rest.iter_mut().for_each(|r| *r *= 2.0);
    for (v, x) in state.v.iter_mut().zip(&state.x) {
        *v += 0.4 * x.perp();
    }
    let upkeep = Upkeep {
        every: 10,
        stretch: Some(1.5),
        ..Upkeep::default()
    };
    let mut crowd = common::simulation(
        vec![free((body, state))],
        timing(Scheme::Leapfrog, 1e-3),
        (None, upkeep),
        true,
    )
    .unwrap();
    let (m, p, total) = (mass(&crowd), crowd.momentum(), crowd.energies().total());
    for _ in 0..2000 {
        assert!(crowd.step().unwrap().is_continue());
    }
    let respaced = crowd
        .events()
        .iter()
        .filter(|e| matches!(e.kind, EventKind::Respaced { from, to } if from != to))
        .count();
    assert!(respaced > 0);
    assert!(crowd.members()[0].state().len() > 40);
    assert!((mass(&crowd) / m - 1.0).abs() < 1e-12);
    assert!(crowd.momentum().distance(p) < 1e-9 * m);
    let after = crowd.energies();
    assert!(
        (after.total() / total - 1.0).abs() < 1e-12,
        "{after:?} {total}"
    );
    let put_in = after.upkeep.abs();
    assert!(put_in < 0.05 * total, "{put_in}");
}

#[test]
fn a_curve_whose_nodes_have_come_closer_makes_its_steps_in_parts() {
    // swells to more than twice its width: it keeps its spacing, but the material between two nodes gets less and stiffer
    let end = |dt: f64| {
        let (body, state) = ball(DVec2::ZERO, 3.0, 30, DVec2::ZERO);
        let swell = Pressure::constant(7.0);
        let snake = Snake::new(body.with_damping(3.0), World::default().with(swell)).unwrap();
        let upkeep = Upkeep {
            every: 5,
            stretch: Some(1.5),
            ..Upkeep::default()
        };
        let time = timing(Scheme::Leapfrog, dt);
        let mut crowd =
            common::simulation(vec![(snake, state)], time, (None, upkeep), true).unwrap();
        while crowd.t() < 60.0 {
            assert!(crowd.step().unwrap().is_continue());
        }
        let cut = crowd
            .events()
            .iter()
            .rev()
            .find_map(|event| match event.kind {
                EventKind::Cut { cuts } => Some(cuts),
                _ => None,
            });
        let energies = crowd.energies();
        let x = &crowd.members()[0].state().x;
        let radius = x.iter().map(|p| p.length()).sum::<f64>() / x.len() as f64;
        (radius, x.len(), cut, energies)
    };
    let (plain, _) = free(ball(DVec2::ZERO, 3.0, 30, DVec2::ZERO));
    let limit = Scheme::Leapfrog.step_limit(&plain).unwrap();
    let (radius, nodes, cut, energies) = end(0.9 * limit);
    assert!(nodes > 60, "{nodes}");
    assert!(cut.is_some_and(|cuts| cuts > 2), "{cut:?}");
    assert!(energies.kinetic < 1e-6, "{energies:?}");
    // at rest, where the step has no say
    let (fine, _, uncut, _) = end(0.9 * limit / 32.0);
    assert_eq!(uncut, None);
    assert!((radius - fine).abs() < 1e-3 * fine, "{radius} {fine}");
}

/// Mass of all members.
fn mass(crowd: &Simulation) -> f64 {
    let each = crowd.members().iter().map(|member| {
        let body = member.snake().body();
        body.spacing * body.mass.to_vec(body.len()).iter().sum::<f64>()
    });
    each.sum()
}

#[test]
fn what_is_left_of_two_curves_that_merge_keeps_its_mass_and_its_momentum() {
    // drawn out to half as long again as at rest, of two masses, and deep in each other
    let stretched = |center: DVec2, density: f64| {
        let (mut body, state) = ball(center, 3.0, 60, DVec2::new(0.4, -0.2));
        body.rest.iter_mut().for_each(|r| *r /= 1.5);
        body.spacing /= 1.5;
        body.mass = density.into();
        free((body, state))
    };
    let snakes = vec![
        stretched(DVec2::ZERO, 1.0),
        stretched(DVec2::new(4.0, 0.0), 2.0),
    ];
    let upkeep = Upkeep {
        every: 1,
        merge: Some(0.5),
        ..Upkeep::default()
    };
    let time = timing(Scheme::Leapfrog, 1e-3);
    let mut crowd = common::simulation(snakes, time, (None, upkeep), true).unwrap();
    let (m, p) = (mass(&crowd), crowd.momentum());
    assert!(crowd.step().unwrap().is_continue());
    assert_eq!(crowd.members().len(), 1, "{:?}", crowd.events());
    // each circle loses the arc that lies in the other, an angle of 2 acos(2/3) of it
    let left = 1.0 - (2.0_f64 / 3.0).acos() / std::f64::consts::PI;
    // the corner is met within an edge of 60
    assert!(
        (mass(&crowd) / (m * left) - 1.0).abs() < 0.03,
        "{} {m}",
        mass(&crowd) / m
    );
    assert!((crowd.momentum() / (p * left) - 1.0).abs().max_element() < 0.03);
}

#[test]
fn an_outline_pinched_in_two_becomes_two() {
    let (body, state) = ball(DVec2::ZERO, 4.0, 60, DVec2::ZERO);
    let mut body = body.with_damping(4.0);
    body.material = Material::uniform(20.0, 0.0, 0.0);
    // a rest shape whose waist has passed through itself
    for r in &mut body.rest {
        r.y *= (r.x / 4.0).powi(2) * 1.6 - 0.25;
    }
    let upkeep = Upkeep {
        every: 5,
        stretch: Some(2.0),
        least_area: Some(0.5),
        ..Upkeep::default()
    };
    let mut crowd = common::simulation(
        vec![free((body, state))],
        timing(Scheme::Leapfrog, 5e-3),
        (None, upkeep),
        true,
    )
    .unwrap();
    let (before, mut last, mut loops) = (mass(&crowd), mass(&crowd), 0);
    for _ in 0..2000 {
        assert!(crowd.step().unwrap().is_continue());
        let cut = |event: &&snake::Event| matches!(event.kind, EventKind::LoopRemoved { .. });
        let removed = crowd.events().iter().filter(cut).count();
        let now = mass(&crowd);
        // a loop takes its own along, and nothing else changes the mass
        assert!(now < last * (1.0 + 1e-12), "{now} {last}");
        assert!(
            removed > loops || now > last * (1.0 - 1e-12),
            "{now} {last}"
        );
        (last, loops) = (now, removed);
    }
    // one where it was pinched, of 4 nodes of 60, and slivers
    assert!(last > 0.85 * before, "{last} {before}");
    assert_eq!(crowd.members().len(), 2, "{:?}", crowd.events());
    for member in crowd.members() {
        assert!(elastic::signed_area(&member.state().x) > 0.5);
        assert!(
            outline::crossings(&member.state().x, true)
                .unwrap()
                .is_empty()
        );
    }
}

#[test]
fn a_plastic_ring_keeps_a_dent_and_an_elastic_one_does_not() {
    let dent = |plastic: Option<Plastic>| {
        let (body, mut state) = ball(DVec2::ZERO, 3.0, 36, DVec2::ZERO);
        for x in &mut state.x {
            x.y *= 0.6;
            x.x *= 1.2;
        }
        let upkeep = Upkeep {
            every: 1,
            plastic,
            ..Upkeep::default()
        };
        let snakes = vec![free((body.with_damping(3.0), state))];
        let mut crowd =
            common::simulation(snakes, timing(Scheme::Leapfrog, 2e-3), (None, upkeep), true)
                .unwrap();
        let first = crowd.energies().total();
        for _ in 0..10_000 {
            assert!(crowd.step().unwrap().is_continue());
        }
        assert!((crowd.energies().total() / first - 1.0).abs() < 1e-3);
        let x = &crowd.members()[0].state().x;
        let wide = |k: usize| x.iter().map(|p| p[k].abs()).fold(0.0, f64::max);
        wide(0) / wide(1)
    };
    assert!((dent(None) - 1.0).abs() < 1e-3);
    let kept = dent(Some(Plastic {
        yields_at: 0.05,
        rate: 5.0,
    }));
    assert!(kept > 1.2, "{kept}");
}
