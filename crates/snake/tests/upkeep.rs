//! Rest shapes that yield, creep and grow against what is solved; outlines that stay outlines under any push.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a snake that cannot be built should stop it"
)]

use crate::common;

use std::any::Any;
use std::sync::Arc;

use elastic::{End, Material, Topology};
use field::{EdgeForce, ForceField, Grid, Smoothing, edge_force};
use glam::DVec2;
use integrator::{Fault, Scheme, Start, State};
use proptest::prelude::*;
use snake::{
    Body, Curve, EventKind, Force, Plastic, Pull, Rest, Sampling, Simulation, Snake, Stepping,
    Until, Upkeep, World,
};
use {banded as _, thiserror as _};

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

/// A straight chain of 11 nodes that was 10 long, stretched to `length` and held there.
fn held_chain(length: f64, plastic: Plastic, dt: f64) -> Simulation {
    let rest: Vec<DVec2> = (0..11).map(|i| DVec2::new(f64::from(i), 0.0)).collect();
    let body = Body::of(&rest, Topology::open(End::Free), 1.0)
        .unwrap()
        .with_material(Material::uniform(0.0, 3.0, 0.0));
    let nodes = rest.iter().map(|r| *r * (length / 10.0)).collect();
    let mut snake = Snake::new(body, World::default()).unwrap();
    snake.hold(0..11).unwrap();
    let upkeep = Upkeep {
        every: 1,
        plastic: Some(plastic),
        ..Upkeep::default()
    };
    let snakes = vec![(snake, State::at_rest(nodes))];
    common::simulation(snakes, timing(Scheme::Leapfrog, dt), (None, upkeep), true).unwrap()
}

fn length_at_rest(crowd: &Simulation) -> f64 {
    let rest = &crowd.members()[0].snake().body().rest;
    rest[0].distance(rest[rest.len() - 1])
}

#[test]
fn below_the_yield_strain_nothing_is_forgotten_and_above_it_all_that_is_beyond() {
    let law = Plastic {
        yields_at: 0.2,
        rate: 1.5,
    };
    // 19 % stretched and 21 %
    for (length, yields) in [(11.9, false), (12.1, true), (16.0, true)] {
        let mut crowd = held_chain(length, law, 1e-3);
        let whole = crowd.energies().total();
        for k in 1..=3000_u32 {
            assert!(crowd.step().unwrap().is_continue());
            // ṙ = rate (u − (1 + y) r), and none below the yield strain
            let end = if yields { length / 1.2 } else { 10.0 };
            let exact = end + (10.0 - end) * (-1.5 * 1.2 * 1e-3 * f64::from(k)).exp();
            let found = length_at_rest(&crowd);
            // what is free is that of the step's start: the rate times the step times the yield strain
            let off = 1.5e-3 * 0.2 * (10.0 - end).abs() + 1e-12;
            assert!((found - exact).abs() < off, "{length}: {found} {exact}");
        }
        // what yielding took from the energy is booked
        assert!((crowd.energies().total() - whole).abs() < 1e-9 * whole);
        assert_eq!(crowd.energies().upkeep > 0.0, yields);
    }
}

#[test]
fn what_creeps_relaxes_by_an_exponential() {
    let law = Plastic {
        yields_at: 0.0,
        rate: 0.7,
    };
    let mut crowd = held_chain(14.0, law, 0.01);
    let first = crowd.energies().tension;
    while crowd.t() < 2.0 - 1e-9 {
        assert!(crowd.step().unwrap().is_continue());
    }
    // the stretch falls by exp(−rate t), its energy by the square of that; no error but rounding
    let exact = first * (-2.0 * 0.7 * crowd.t()).exp();
    assert!((crowd.energies().tension / exact - 1.0).abs() < 1e-9);
}

/// A pull on the last node alone.
#[derive(Debug, Clone)]
struct Load(f64);

impl Force for Load {
    fn name(&self) -> &'static str {
        "load"
    }

    fn add(&mut self, curve: &Curve<'_>, force: &mut [DVec2]) -> Result<(), Fault> {
        if let Some(last) = force.last_mut() {
            last.x += self.0 / curve.spacing;
        }
        Ok(())
    }

    fn pull(&self, _spacing: f64, _curve: Option<&Curve<'_>>) -> Pull {
        Pull {
            stiffness: 0.0,
            damping: 0.0,
        }
    }

    fn boxed(&self) -> Box<dyn Force> {
        Box::new(self.clone())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

#[test]
fn under_a_steady_load_it_creeps_at_a_steady_rate() {
    let rest: Vec<DVec2> = (0..11).map(|i| DVec2::new(f64::from(i), 0.0)).collect();
    let topology = Topology::Open {
        head: End::Pinned,
        tail: End::Free,
    };
    let body = Body::of(&rest, topology, 1.0)
        .unwrap()
        .with_material(Material::uniform(0.0, 3.0, 0.0))
        .with_damping(0.02);
    let world = World::default().with(Load(0.3));
    let snakes = vec![(Snake::new(body, world).unwrap(), State::at_rest(rest))];
    let upkeep = Upkeep {
        every: 1,
        plastic: Some(Plastic {
            yields_at: 0.0,
            rate: 0.02,
        }),
        ..Upkeep::default()
    };
    let mut crowd =
        common::simulation(snakes, timing(Scheme::Leapfrog, 0.05), (None, upkeep), true).unwrap();
    let tail = |crowd: &Simulation| crowd.members()[0].state().x[10].x;
    while crowd.t() < 600.0 {
        assert!(crowd.step().unwrap().is_continue());
    }
    let (t, x) = (crowd.t(), tail(&crowd));
    while crowd.t() < 700.0 {
        assert!(crowd.step().unwrap().is_continue());
    }
    let found = (tail(&crowd) - x) / (crowd.t() - t);
    // ten edges, each strained by F/ω₁ of its length of 1; what moves is braked, by Σ γ h v of 0.7 % of F
    let exact = 10.0 * 0.02 * 0.3 / 3.0;
    assert!((found / exact - 1.0).abs() < 0.01, "{found} {exact}");
}

#[test]
fn a_ring_grows_by_an_exponential() {
    let nodes = elastic::circle(DVec2::ZERO, 3.0, 24);
    let body = Body::of(&nodes, Topology::Closed, 1.0)
        .unwrap()
        .with_material(Material::uniform(1.0, 1.0, 1.0));
    let upkeep = Upkeep {
        every: 5,
        growth: 0.1,
        ..Upkeep::default()
    };
    let snakes = vec![(
        Snake::new(body, World::default()).unwrap(),
        State::at_rest(nodes),
    )];
    let mut crowd =
        common::simulation(snakes, timing(Scheme::Leapfrog, 0.01), (None, upkeep), true).unwrap();
    for _ in 0..500 {
        assert!(crowd.step().unwrap().is_continue());
    }
    let rest = &crowd.members()[0].snake().body().rest;
    let radius = rest.iter().map(|r| r.length()).sum::<f64>() / rest.len() as f64;
    assert!(
        (radius / (3.0 * 0.5_f64.exp()) - 1.0).abs() < 1e-12,
        "{radius}"
    );
}

/// A push on every node, another in every stretch of time, from a list.
#[derive(Debug, Clone)]
struct Gusts(Arc<Vec<DVec2>>);

impl Force for Gusts {
    fn name(&self) -> &'static str {
        "gusts"
    }

    fn add(&mut self, curve: &Curve<'_>, force: &mut [DVec2]) -> Result<(), Fault> {
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a time from 0 to some tens"
        )]
        let now = (2.0 * curve.t) as usize;
        for (i, f) in force.iter_mut().enumerate() {
            // neighbors are pushed alike, those farther off otherwise
            let k = 13 * now + (8 * i) / curve.x.len();
            *f += self.0[k % self.0.len()];
        }
        Ok(())
    }

    fn pull(&self, _spacing: f64, _curve: Option<&Curve<'_>>) -> Pull {
        Pull {
            stiffness: 0.0,
            damping: 0.0,
        }
    }

    fn boxed(&self) -> Box<dyn Force> {
        Box::new(self.clone())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn whatever_pushes_an_outline_stays_an_outline(
        gusts in prop::collection::vec(prop::array::uniform2(-14.0..14.0_f64), 40), n in 20_usize..60,
    ) {
        let nodes = elastic::circle(DVec2::ZERO, 4.0, n);
        let body = Body::of(&nodes, Topology::Closed, 1.0)
            .unwrap()
            .with_material(Material::uniform(0.2, 4.0, 0.5))
            .with_damping(2.0);
        let gusts = Arc::new(gusts.into_iter().map(DVec2::from).collect());
        let world = World::default().with(Gusts(gusts));
        let upkeep = Upkeep {
            every: 1,
            stretch: Some(2.0),
            least_area: Some(0.5),
            ..Upkeep::default()
        };
        let snakes = vec![(Snake::new(body, world).unwrap(), State::at_rest(nodes))];
        let mut crowd = common::simulation(snakes, timing(Scheme::Leapfrog, 0.004), (None, upkeep), true).unwrap();
        for _ in 0..1000 {
            // pieces get finer nodes than the step was chosen for; then it is over
            if crowd.step().is_err() {
                break;
            }
            for member in crowd.members() {
                let x = &member.state().x;
                prop_assert!(elastic::signed_area(x) > 0.0, "it flipped");
                prop_assert!(outline::crossings(x, true).unwrap().is_empty(), "it crosses itself");
            }
        }
        // the log tells of every curve that is there or gone
        let mut there = 1_usize;
        for event in crowd.events() {
            match event.kind {
                EventKind::Split { pieces } => there += pieces - 1,
                EventKind::Vanished | EventKind::Merged { .. } => there -= 1,
                _ => {}
            }
        }
        prop_assert_eq!(there, crowd.members().len());
    }
}

/// A picture's field from its levels.
fn field(level: impl Fn(DVec2) -> f64) -> Arc<ForceField> {
    let image = Grid::from_shape_fn((128, 128), |(y, x)| level(DVec2::new(x as f64, y as f64)));
    let rule = EdgeForce {
        smoothing: Smoothing::Gaussian(4.0),
        gain: 6.0,
    };
    Arc::new(edge_force(&image, &rule).unwrap())
}

fn settled(field: &Arc<ForceField>, nodes: Vec<DVec2>, topology: Topology) -> Vec<DVec2> {
    let body = Body::of(&nodes, topology, 1.0)
        .unwrap()
        .with_material(Material::uniform(0.0, 4.0, 4.0))
        .with_damping(1.0);
    let world = World::default().with_image(Arc::clone(field), Sampling::Bilinear);
    let snake = Snake::new(body, world).unwrap();
    let until = Until::at_rest(Rest::default(), 20_000);
    let stepping = Stepping::of(Scheme::Imex, 0.2);
    common::end(&snake, &State::at_rest(nodes), stepping, &until)
        .1
        .x
}

/// The farthest that a node of `a` is from the polygon `b`.
fn farthest(a: &[DVec2], b: &[DVec2], closed: bool) -> f64 {
    let n = b.len();
    let edges = if closed { n } else { n - 1 };
    let away = |p: &DVec2| {
        let each = (0..edges).map(|i| {
            let (q, r) = (b[i], b[(i + 1) % n]);
            let along = ((*p - q).dot(r - q) / (r - q).length_squared()).clamp(0.0, 1.0);
            p.distance(q + along * (r - q))
        });
        each.fold(f64::INFINITY, f64::min)
    };
    a.iter().map(away).fold(0.0, f64::max)
}

#[test]
fn where_a_snake_ends_does_not_depend_on_the_number_of_nodes() {
    let middle = DVec2::splat(63.5);
    // a blob with three lobes, and a wavy border from left to right
    let lobes = field(|p| {
        let q = p - middle;
        let border = 34.0 * (1.0 + 0.15 * (3.0 * q.to_angle()).cos());
        120.0 / (1.0 + (q.length() - border).exp())
    });
    let wave = field(|p| 120.0 / (1.0 + (64.0 + 8.0 * (p.x / 12.0).sin() - p.y).exp()));
    let around = |n| settled(&lobes, elastic::circle(middle, 42.0, n), Topology::Closed);
    let across = |n: usize| {
        let node = |i: usize| DVec2::new(8.0 + 112.0 * i as f64 / (n - 1) as f64, 70.0);
        settled(&wave, (0..n).map(node).collect(), Topology::open(End::Free))
    };
    let (ring, line) = (around(400), across(400));
    for n in [50, 100, 200] {
        let off = farthest(&around(n), &ring, true);
        assert!(off < 0.1, "closed, {n} nodes: {off}");
        let off = farthest(&across(n), &line, false);
        assert!(off < 0.1, "open, {n} nodes: {off}");
    }
}
