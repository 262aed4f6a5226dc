use elastic::{End, Material, Profile, Topology};
use glam::DVec2;

use super::*;
use crate::{Body, Damping, Frame, World};

/// A straight strip, or a ring where the topology is closed, of unit spacing.
fn curve(n: usize, topology: Topology, material: Material) -> Body {
    let x = if topology.is_closed() {
        elastic::circle(DVec2::ZERO, n as f64 / std::f64::consts::TAU, n)
    } else {
        (0..n).map(|i| DVec2::new(i as f64, 0.0)).collect()
    };
    let mut body = Body::of(&x, topology, 2.0).unwrap().with_material(material);
    body.spacing = 1.0;
    body.with_damping(0.3)
}

fn wave(n: usize, mean: f64, share: f64) -> Profile {
    let at = |i: usize| mean * (1.0 + share * (9.0 * i as f64 / n as f64).sin());
    Profile::PerNode((0..n).map(at).collect())
}

fn start(body: &Body) -> integrator::State {
    integrator::State::at_rest(body.rest.clone())
}

#[test]
fn slow_modes_of_long_curves_are_those_of_the_dense_eigenbasis() {
    let n = 430;
    let soft = Material::uniform(0.0, 5.0, 0.0);
    let stiff = Material::uniform(0.0, 0.3, 20.0);
    let mut uneven = stiff.clone();
    uneven.rigidity = wave(n, 20.0, 0.7);
    uneven.tether = wave(n, 0.01, 0.5);
    for (topology, material) in [
        (Topology::open(End::Free), soft.clone()),
        (Topology::open(End::Pinned), soft),
        (Topology::open(End::Free), stiff.clone()),
        (Topology::open(End::Clamped), stiff.clone()),
        (Topology::open(End::Pinned), uneven.clone()),
        (Topology::Closed, uneven),
    ] {
        for frame in [Frame::corrected(), Frame::report()] {
            let mut body = curve(n, topology, material.clone()).with_frame(frame);
            body.mass = wave(n, 2.0, 0.3);
            body.recenter().unwrap();
            let mut snake = Snake::new(body.clone(), World::default()).unwrap();
            let (found, complete) = modes(&snake);
            let all = every(&snake).unwrap();
            assert!(!complete, "{topology:?}");
            let resist = |modes: &[ModeOfMotion]| -> Vec<ModeOfMotion> {
                let moving = modes.iter().filter(|mode| mode.frequency > 0.0);
                moving.copied().collect()
            };
            let (few, truth) = (resist(&found), resist(&all));
            assert_eq!(
                found.len() - few.len(),
                all.len() - truth.len(),
                "{topology:?}"
            );
            for (k, (few, truth)) in few[..few.len() - 1].iter().zip(&truth).enumerate() {
                let off = few.frequency / truth.frequency - 1.0;
                assert!(
                    off.abs() < 1e-5,
                    "{topology:?} {frame:?} {k}: {few:?}, {truth:?}"
                );
                let off = few.fading / truth.fading - 1.0;
                assert!(
                    off.abs() < 1e-2,
                    "{topology:?} {frame:?} {k}: {few:?}, {truth:?}"
                );
            }
            let fastest = truth.last().unwrap().frequency;
            assert!((few.last().unwrap().frequency / fastest - 1.0).abs() < 1e-9);
            // and so is what is chosen by them
            for k in [0, 1, 20] {
                let state = start(&body);
                snake.damp(Damping::Mode(k), &state).unwrap();
                let gamma = snake.damping()[0] / snake.mass()[0];
                let off = gamma / (2.0 * truth[k].frequency) - 1.0;
                assert!(off.abs() < 1e-5, "{topology:?} {k}: {off}");
            }
        }
    }
}

#[test]
fn critical_damping_of_a_long_clamped_strip_is_that_of_its_slowest_wave() {
    // ω = (4.730041/L)² √(B/μ) of a clamped beam, in the continuum (Rayleigh 1877, §174); the frame
    // takes the mean out of
    // even ones, so the first odd one: 7.853205
    for n in [201, 401, 801, 1601] {
        let mut body = curve(
            n,
            Topology::open(End::Clamped),
            Material::uniform(0.0, 0.0, 20.0),
        );
        body.frame.reaction = false;
        let snake = Snake::new(body, World::default()).unwrap();
        let length = n as f64 - 1.0;
        let odd = (7.853_205 / length).powi(2) * 10.0_f64.sqrt();
        let found = [0, 1, 2].map(|k| resisting(&snake, k).unwrap());
        let near = found.iter().any(|w| (w / odd - 1.0).abs() < 0.05);
        assert!(near, "{n}: {found:?}, {odd}");
    }
}

#[test]
fn rings_of_pure_rigidity_keep_their_slow_modes() {
    for n in [300, 3000, 30_000] {
        let body = curve(n, Topology::Closed, Material::uniform(0.0, 0.0, 20.0));
        let snake = Snake::new(body, World::default()).unwrap();
        let (modes, complete) = modes(&snake);
        assert!(complete);
        let zeros = modes.iter().filter(|mode| mode.frequency <= 0.0).count();
        assert_eq!(zeros, 1, "{n}");
        let slow = 4.0 * (std::f64::consts::PI / n as f64).sin().powi(2) * 10.0_f64.sqrt();
        for k in [1, 2] {
            assert!((modes[k].frequency / slow - 1.0).abs() < 1e-6, "{n}");
        }
    }
}
