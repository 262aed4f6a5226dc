//! The discrete force against Eq. 2.10, differentiated by hand, on a smooth deformation of a ring.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a material that is refused should stop it"
)]

use elastic::{Material, Profile, Topology, elastic_force};
use glam::DVec2;
use std::f64::consts::TAU;

/// Circumference of the ring at rest.
const LENGTH: f64 = 10.0;

/// Largest difference between the force of `n` nodes and `exact(s)`, for `e = (sin a s, cos 2 a s)`.
fn error(n: usize, material: &Material, exact: impl Fn(f64) -> DVec2) -> f64 {
    let (h, a) = (LENGTH / n as f64, TAU / LENGTH);
    let place = |i: usize| h * i as f64;
    let e: Vec<DVec2> = (0..n)
        .map(|i| DVec2::new((a * place(i)).sin(), (2.0 * a * place(i)).cos()))
        .collect();
    let mut force = vec![DVec2::ZERO; n];
    elastic_force(&e, Topology::Closed, material, h, &mut force);
    (0..n)
        .map(|i| (force[i] - exact(place(i))).length())
        .fold(0.0, f64::max)
}

fn order(coarse: f64, fine: f64) -> f64 {
    (coarse / fine).log2()
}

#[test]
fn the_force_of_even_parameters_converges_to_equation_2_10_with_order_two() {
    let (w0, w1, w2) = (0.7, 2.0, 0.3);
    let a = TAU / LENGTH;
    let symbol = |k: f64| w0 + w1 * k * k + w2 * k.powi(4);
    let exact = |s: f64| {
        -DVec2::new(
            symbol(a) * (a * s).sin(),
            symbol(2.0 * a) * (2.0 * a * s).cos(),
        )
    };
    let material = Material::uniform(w0, w1, w2);
    let errors = [40, 80, 160].map(|n| error(n, &material, exact));
    assert!(errors[2] < 0.01, "{errors:?}");
    for pair in errors.windows(2) {
        assert!((order(pair[0], pair[1]) - 2.0).abs() < 0.1, "{errors:?}");
    }
}

#[test]
fn the_force_of_profiles_converges_to_equation_2_10_with_order_one() {
    // ω₁(s) = 2 + sin a s and ω₂(s) = 0.3 + 0.1 cos a s; ω₁[i] stands on the edge from i to i + 1,
    // half a spacing from its node (Eq. 3.2 to the letter), hence the first order
    let a = TAU / LENGTH;
    let exact = |s: f64| {
        let component = |k: f64, phase: f64| {
            // e and its derivatives are sin(k s + phase) turned by quarter turns
            let d = |m: i32| k.powi(m) * (k * s + phase + f64::from(m) * TAU / 4.0).sin();
            let (w1, w1s) = (2.0 + (a * s).sin(), a * (a * s).cos());
            let (c, si) = ((a * s).cos(), (a * s).sin());
            let (w2, w2s, w2ss) = (0.3 + 0.1 * c, -0.1 * a * si, -0.1 * a * a * c);
            -(0.7 * d(0) - (w1s * d(1) + w1 * d(2)) + (w2ss * d(2) + 2.0 * w2s * d(3) + w2 * d(4)))
        };
        DVec2::new(component(a, 0.0), component(2.0 * a, TAU / 4.0))
    };
    let at = |n: usize| {
        let along = |f: &dyn Fn(f64) -> f64| {
            Profile::PerNode(
                (0..n)
                    .map(|i| f(a * LENGTH * i as f64 / n as f64))
                    .collect(),
            )
        };
        let material = Material {
            tether: Profile::Uniform(0.7),
            tension: along(&|x| 2.0 + x.sin()),
            rigidity: along(&|x| 0.3 + 0.1 * x.cos()),
            higher: Vec::new(),
        };
        error(n, &material, exact)
    };
    let errors = [80, 160, 320].map(at);
    assert!(errors[2] < 0.1, "{errors:?}");
    for pair in errors.windows(2) {
        assert!((order(pair[0], pair[1]) - 1.0).abs() < 0.15, "{errors:?}");
    }
}
