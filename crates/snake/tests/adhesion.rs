//! Adhesion: curves that share a border, and the angle at which they part.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a snake that cannot be built should stop it"
)]

use crate::common;

use elastic::{Material, Topology};
use glam::DVec2;
use integrator::{Scheme, Start, State};
use proptest as _;
use snake::{Body, Contact, Pressure, Rest, Simulation, Snake, Stepping, Upkeep, World};
use {banded as _, field as _, outline as _, thiserror as _};

const GAP: f64 = 0.1;

const STICKY: Contact = Contact {
    stiffness: 20_000.0,
    damping: 0.0,
    friction: 0.0,
    wall_friction: 0.0,
    stick: 1.0,
    adhesion: 1.2,
    range: 0.15,
    gap: GAP,
    stop: 0.1,
    own: false,
};

fn timing(dt: f64) -> Stepping {
    Stepping {
        scheme: Scheme::Leapfrog,
        dt,
        tolerance: None,
        relax: None,
        each: false,
        start: Start::SecondOrder,
        force: false,
    }
}

/// Bags of radius 3 side by side: skins a hundredth as long at rest, so under a tension that is the same
/// all round, and as good as incompressible. Tension 2, mass 1 and damping per length as it is.
fn bags(n: usize, damping: f64) -> Vec<(Snake, State)> {
    let each = |x: f64| {
        let nodes = elastic::circle(DVec2::new(x, 0.0), 3.0, n);
        let small = elastic::circle(DVec2::ZERO, 0.03, n);
        let body = Body::of(&small, Topology::Closed, 100.0)
            .unwrap()
            .with_material(Material::uniform(0.0, 0.02, 0.0))
            .with_damping(100.0 * damping);
        let area = elastic::signed_area(&nodes);
        let world = World::default().with(Pressure::area(20_000.0, area));
        (Snake::new(body, world).unwrap(), State::at_rest(nodes))
    };
    vec![each(-3.06), each(3.06)]
}

/// Center and radius of the circle that fits points best: least squares of `|p|² − 2 c·p − d`.
fn circle_through(points: &[DVec2]) -> (DVec2, f64) {
    let n = points.len() as f64;
    let mean = points.iter().sum::<DVec2>() / n;
    let (mut xx, mut xy, mut yy, mut right) = (0.0, 0.0, 0.0, DVec2::ZERO);
    let around = |p: &DVec2| *p - mean;
    let spread = points
        .iter()
        .map(|p| around(p).length_squared())
        .sum::<f64>()
        / n;
    for p in points.iter().map(around) {
        xx += p.x * p.x;
        xy += p.x * p.y;
        yy += p.y * p.y;
        right += 0.5 * (p.length_squared() - spread) * p;
    }
    let det = xx * yy - xy * xy;
    let at = DVec2::new(yy * right.x - xy * right.y, xx * right.y - xy * right.x) / det;
    let center = mean + at;
    (center, (spread + at.length_squared()).sqrt())
}

fn settled(n: usize, adhesion: f64) -> Simulation {
    let law = Contact {
        adhesion,
        // five times the spacing of 240 nodes: on coarser ones the end of a border catches on every node
        range: 0.4,
        damping: 40.0,
        ..STICKY
    };
    let mut crowd = common::simulation(
        bags(n, 0.6),
        timing(0.006),
        (Some(law), Upkeep::default()),
        true,
    )
    .unwrap();
    crowd.watch(Rest::default());
    while crowd.t() < 60.0 && !crowd.is_at_rest() {
        assert!(crowd.step().unwrap().is_continue());
    }
    crowd
}

#[test]
fn two_equal_bags_part_at_the_angle_of_youngs_equation() {
    for adhesion in [0.4, 0.8, 1.2] {
        let crowd = settled(240, adhesion);
        let mut centers = Vec::new();
        let mut found = (0.0, 0.0);
        for member in crowd.members() {
            let x = &member.state().x;
            let length: f64 = (0..x.len())
                .map(|i| x[i].distance(x[(i + 1) % x.len()]))
                .sum();
            let body = member.snake().body();
            let tension = 0.02 * length / (body.spacing * x.len() as f64);
            let free: Vec<DVec2> = x.iter().copied().filter(|p| p.x.abs() > 0.9).collect();
            let (center, radius) = circle_through(&free);
            centers.push(center);
            found = (radius, tension);
        }
        let (radius, tension) = found;
        // from the border's middle, half a gap before the curve itself
        let cos = 0.5 * (centers[0].distance(centers[1]) - GAP) / radius;
        let exact = 1.0 - 0.5 * adhesion / tension;
        // the range is an eighth of the radius, and the end of the border stays a node short of where it would go
        assert!(
            (cos - exact).abs() < 0.04,
            "{adhesion}: {cos}, exactly {exact}"
        );
    }
}

#[test]
fn without_adhesion_they_touch_and_no_more() {
    let crowd = settled(60, 0.0);
    let [one, two] = [0, 1].map(|k| elastic::center(&crowd.members()[k].state().x, None));
    assert!((one.distance(two) - 6.12).abs() < 0.01);
}

#[test]
fn adhesion_keeps_energy_and_momentum() {
    let mut snakes = bags(60, 0.0);
    for v in &mut snakes[0].1.v {
        *v = DVec2::new(0.1, 0.3);
    }
    let mut crowd = common::simulation(
        snakes,
        timing(1e-3),
        (Some(STICKY), Upkeep::default()),
        true,
    )
    .unwrap();
    let (p, first) = (crowd.momentum(), crowd.energies());
    let (mut off, mut moved, mut least) = (0.0_f64, 0.0_f64, 0.0_f64);
    for _ in 0..8000 {
        assert!(crowd.step().unwrap().is_continue());
        let now = crowd.energies();
        off = off.max((now.total() - first.total()).abs());
        moved = moved.max(now.kinetic);
        least = least.min(now.forces[1]);
    }
    assert!(crowd.momentum().distance(p) < 1e-12 * 2.0 * 1885.0);
    // they grew together by more than half a radius of border
    assert!(least < -1.5 * STICKY.adhesion, "{least}");
    // skins come within reach, leave it and change partners, and the sum closes all the same
    let size = first.values().iter().fold(0.0_f64, |a, e| a.max(e.abs()));
    assert!(off < 1e-12 * size, "{off} of {size}, {moved} moved");
}

#[test]
fn they_lie_no_deeper_in_each_other_than_the_stop() {
    let crowd = settled(120, 1.2);
    assert!(crowd.deepest() < STICKY.stop, "{}", crowd.deepest());
    // in the middle of the border
    let inner = |k: usize| {
        let x = &crowd.members()[k].state().x;
        let side = x.iter().filter(|p| p.y.abs() < 0.5 && p.x.abs() < 1.0);
        let (sum, count) = side.fold((0.0, 0.0), |(sum, count), p| (sum + p.x, count + 1.0));
        sum / count
    };
    let layer = (inner(1) - inner(0)).abs();
    // a layer between them, pressed by the tension of the skins over the radius from both sides
    assert!((layer / GAP - 1.0).abs() < 0.1, "{layer}");
}
