//! Local stiffness, critical and internal damping against eigenvalues and conservation laws.
#![allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    reason = "a test may stop, and one that says equal means equal"
)]

use banded::Dense;
use elastic::{
    End, InternalDamping, Material, Motion, Profile, Topology, critical_damping, elastic_force,
    ellipse, greatest_stiffness, local_stiffness, stiffness,
};
use glam::DVec2;
use std::f64::consts::TAU;

fn topologies() -> [Topology; 4] {
    [
        Topology::Closed,
        Topology::open(End::Free),
        Topology::open(End::Anchored),
        Topology::Open {
            head: End::Clamped,
            tail: End::Free,
        },
    ]
}

/// Densities and masses without a pattern, some zero.
fn rough(n: usize) -> (Material, Profile) {
    let along = |k: f64| {
        let value = |i: usize| (3.0 * (k * (i + 1) as f64).sin()).max(0.0);
        Profile::PerNode((0..n).map(value).collect())
    };
    let material = Material {
        tether: along(0.7),
        tension: along(1.3),
        rigidity: along(2.1),
        higher: vec![along(0.4), along(0.2)],
    };
    let mass = (0..n)
        .map(|i| 0.2 + (i * i) as f64 % 1.7)
        .collect::<Vec<_>>();
    (material, mass.into())
}

#[test]
fn eigenvalues_lie_between_the_local_stiffness_and_gershgorins_bound() {
    let (n, h) = (24, 0.8);
    for topology in topologies() {
        let (material, mass) = rough(n);
        let k = stiffness(topology, &material, h, n).unwrap();
        let root = |i: usize| mass.at(i).sqrt();
        let values = Dense::from_fn(n, |i, j| k.entry(i, j) / (root(i) * root(j)))
            .eigen()
            .unwrap()
            .values;
        let over = |rows: Vec<f64>| {
            let ratio = |(i, r): (usize, f64)| r / mass.at(i);
            rows.into_iter().enumerate().map(ratio).fold(0.0, f64::max)
        };
        let least = over(local_stiffness(topology, &material, h, n).unwrap());
        let most = over(greatest_stiffness(topology, &material, h, n).unwrap());
        let largest = values[n - 1];
        assert!(least <= largest * (1.0 + 1e-13), "{topology:?}");
        assert!(largest <= most * (1.0 + 1e-13), "{topology:?}");
    }
}

#[test]
fn an_anchored_string_has_the_eigenvalues_of_its_formula() {
    let (n, h, tether, tension) = (17, 0.5, 0.3, 2.0);
    let material = Material::uniform(tether, tension, 0.0);
    let k = stiffness(Topology::open(End::Anchored), &material, h, n).unwrap();
    let mut values = Dense::from_fn(n, |i, j| k.entry(i, j))
        .eigen()
        .unwrap()
        .values;
    values.sort_by(f64::total_cmp);
    for (mode, value) in (1..).zip(values) {
        let sine = (f64::from(mode) * TAU / 4.0 / (n + 1) as f64).sin();
        let exact = tether + 4.0 * tension / (h * h) * sine * sine;
        assert!((value - exact).abs() < 1e-12 * exact, "{mode}: {value}");
    }
}

#[test]
fn on_an_even_ring_gershgorins_bound_is_reached() {
    let (n, h) = (16, 0.5);
    let material = Material::uniform(0.3, 2.0, 0.7);
    let bound = greatest_stiffness(Topology::Closed, &material, h, n).unwrap();
    let exact = 0.3 + 4.0 * 2.0 / 0.25 + 16.0 * 0.7 / 0.0625;
    assert!(bound.iter().all(|r| (r - exact).abs() < 1e-13 * exact));
    let here = local_stiffness(Topology::Closed, &material, h, n).unwrap();
    let exact = 0.3 + 2.0 * 2.0 / 0.25 + 6.0 * 0.7 / 0.0625;
    assert!(here.iter().all(|k| (k - exact).abs() < 1e-13 * exact));
}

#[test]
fn critically_damped_nodes_do_not_ring_and_slightly_less_damped_ones_do() {
    let mass = Profile::from(vec![1.0, 4.0, 2.0]);
    let k = [9.0, 1.0, -5.0];
    let gamma = critical_damping(&mass, &k);
    assert_eq!(gamma, [6.0, 4.0, 0.0]);
    // the discriminant of μ z² + γ z + k
    for i in 0..2 {
        assert_eq!(gamma[i].powi(2) - 4.0 * mass.at(i) * k[i], 0.0);
    }
    assert!(critical_damping(&mass, &[]).is_empty());
}

#[test]
fn a_ring_damped_by_its_local_stiffness_has_six_tenths_of_critical_damping_in_every_mode() {
    let (n, h, mu) = (32, 1.0, 2.0);
    let material = Material::uniform(0.1, 1.0, 1.0);
    let k = local_stiffness(Topology::Closed, &material, h, n).unwrap();
    let gamma = critical_damping(&mu.into(), &k)[0];
    let share = |wave: usize| {
        let sine = 4.0 * (TAU * wave as f64 / n as f64 / 2.0).sin().powi(2);
        gamma / (2.0 * (mu * (0.1 + sine + sine * sine)).sqrt())
    };
    // the least at the shortest wave, k over 0.1 + 4 + 16; the longest is the more overdamped the more nodes there are
    let least = (0..=16).map(share).fold(f64::MAX, f64::min);
    assert_eq!(least, share(16));
    assert!((least - (8.1_f64 / 20.1).sqrt()).abs() < 1e-14 && least > 0.61);
    assert!(share(1) > 7.0, "{}", share(1));
}

#[test]
fn a_damper_acts_on_mode_lambda_like_beta_lambda_and_not_on_flight() {
    let (n, h, beta) = (20, 0.7, 0.03);
    let material = Material::uniform(5.0, 2.0, 0.4);
    let damper = material.damper(beta);
    for wave in [0, 1, 4, 10] {
        let theta = TAU * f64::from(wave) / n as f64;
        let v: Vec<_> = (0..n)
            .map(|i| DVec2::from_angle(theta * i as f64))
            .collect();
        let sine = (2.0 * (theta / 2.0).sin() / h).powi(2);
        let lambda = 2.0 * sine + 0.4 * sine * sine;
        let mut force = vec![DVec2::ZERO; n];
        elastic_force(&v, Topology::Closed, &damper, h, &mut force);
        for (f, v) in force.iter().zip(&v) {
            // rounding of the stiffest mode
            assert!((*f + beta * lambda * *v).length() < 1e-13, "wave {wave}");
        }
    }
}

/// The damping force of `rough` material on velocities `v`, and its mass.
fn damped(topology: Topology, nodes: &[DVec2], v: &[DVec2]) -> (Vec<DVec2>, Profile) {
    let n = nodes.len();
    let (material, mass) = rough(n);
    let (mut seen, mut force) = (vec![DVec2::NAN; n], vec![DVec2::NAN; n]);
    InternalDamping {
        topology,
        damper: &material.damper(0.1),
        mass: &mass,
        spacing: 0.8,
    }
    .force(nodes, v, &mut seen, &mut force);
    (force, mass)
}

#[test]
fn internal_damping_leaves_rigid_motion_alone_whatever_the_ends() {
    let nodes = ellipse(DVec2::new(30.0, 10.0), DVec2::new(7.0, 3.0), 0.5, 24);
    let flight: Vec<_> = nodes
        .iter()
        .map(|x| DVec2::new(4.0, -9.0) + 1.7 * x.perp())
        .collect();
    for topology in topologies() {
        let (force, _) = damped(topology, &nodes, &flight);
        // velocities of 60, stiffness of about 0.1·16·3/0.4
        assert!(force.iter().all(|f| f.length() < 1e-11), "{topology:?}");
    }
}

#[test]
fn internal_damping_keeps_both_momenta_and_takes_energy_from_every_other_motion() {
    let nodes = ellipse(DVec2::new(30.0, 10.0), DVec2::new(7.0, 3.0), 0.5, 24);
    let v: Vec<_> = (0..24_u32)
        .map(|i| 3.0 * DVec2::from_angle(f64::from(i * i)))
        .collect();
    for topology in topologies() {
        let (force, mass) = damped(topology, &nodes, &v);
        let size: f64 = force.iter().map(|f| f.length()).sum();
        let center = Motion::of(&nodes, &v, &mass, 0.8).center;
        let sum: DVec2 = force.iter().sum();
        let torque: f64 = nodes
            .iter()
            .zip(&force)
            .map(|(x, f)| (*x - center).perp_dot(*f))
            .sum();
        assert!(sum.length() < 1e-14 * size, "{topology:?}: {sum}");
        assert!(torque.abs() < 1e-13 * size, "arms of 7: {torque}");
        let power: f64 = force.iter().zip(&v).map(|(f, v)| f.dot(*v)).sum();
        assert!(power < -0.1 * size, "{topology:?}: {power}");
    }
}
