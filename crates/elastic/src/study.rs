//! How good curvature and force are on even, uneven, rough and noisy nodes: the comparison of report §5.3.
//!
//! A circle, an ellipse and a logarithmic spiral, for each the exact curvature and the exact arc length at
//! every node. What is timed is timed elsewhere; here are errors and orders, the same at every run.

use crate::{End, Estimate, Material, SpacingRule, Spacings, Topology};
use crate::{curvature, elastic_force, spacing};
use glam::DVec2;
use std::f64::consts::TAU;

/// One line of the comparison.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Finding {
    /// What was computed: the name of an [`Estimate`], or of a force or energy and its spacing.
    pub quantity: &'static str,
    /// `circle`, `ellipse` or `spiral`.
    pub curve: &'static str,
    /// `even`, `smooth`, `rough` or `noisy`.
    pub nodes: &'static str,
    /// How many nodes the error belongs to.
    pub n: usize,
    /// Root mean square of the error over that of the exact values.
    pub error: f64,
    /// log₂ of the error at `n` over that at `2 n`: 2 for second order, 0 or less where it does not converge.
    pub order: f64,
}

/// Every estimate of curvature, and the elastic force and energy with one spacing and with their own, on three curves
/// and four kinds of nodes.
///
/// The curves are a circle, an ellipse of axes 3 : 2 and one turn of the spiral `r = exp(0.2 θ)`. `even` nodes are even in arc
/// length; `smooth` ones have edges that differ by up to a factor of 3 and change slowly; `rough` ones
/// alternate, 0.7 and 1.3 of the mean; `noisy` ones are even and displaced at random by up to 1e-5 of a radius. Forces
/// are those of a smooth deformation with a few waves along the curve, at the nodes away from the ends of the
/// spiral; energies on the closed curves only. The same numbers at every run. O(n), no less than 16 nodes.
#[must_use]
pub fn spacing_study(n: usize) -> Vec<Finding> {
    let n = n.max(16);
    let mut findings = Vec::new();
    for curve in [Curve::Circle, Curve::Ellipse, Curve::Spiral] {
        for nodes in [Nodes::Even, Nodes::Smooth, Nodes::Rough, Nodes::Noisy] {
            let (coarse, fine) = (errors(curve, nodes, n), errors(curve, nodes, 2 * n));
            for ((quantity, error), (_, finer)) in coarse.into_iter().zip(fine) {
                findings.push(Finding {
                    quantity,
                    curve: curve.name(),
                    nodes: nodes.name(),
                    n,
                    error,
                    order: (error / finer).log2(),
                });
            }
        }
    }
    findings
}

#[derive(Clone, Copy, PartialEq)]
enum Curve {
    Circle,
    Ellipse,
    Spiral,
}

#[derive(Clone, Copy)]
enum Nodes {
    Even,
    Smooth,
    Rough,
    Noisy,
}

/// Semi-axes of the ellipse.
const AXES: DVec2 = DVec2::new(1.5, 1.0);

/// Growth of the spiral.
const GROWTH: f64 = 0.2;

impl Curve {
    const fn name(self) -> &'static str {
        match self {
            Self::Circle => "circle",
            Self::Ellipse => "ellipse",
            Self::Spiral => "spiral",
        }
    }

    const fn topology(self) -> Topology {
        match self {
            Self::Circle | Self::Ellipse => Topology::Closed,
            Self::Spiral => Topology::open(End::Free),
        }
    }

    /// The place and the curvature at parameter `t`.
    fn at(self, t: f64) -> (DVec2, f64) {
        let turn = DVec2::from_angle(t);
        match self {
            Self::Circle => (turn, 1.0),
            Self::Ellipse => {
                let v = AXES * turn.perp();
                (AXES * turn, AXES.x * AXES.y / v.length().powi(3))
            }
            Self::Spiral => {
                let r = (GROWTH * t).exp();
                (r * turn, 1.0 / (r * GROWTH.hypot(1.0)))
            }
        }
    }

    /// The whole length, and the parameters at these parts of it.
    fn places(self, parts: &[f64]) -> (f64, Vec<f64>) {
        match self {
            Self::Circle => (TAU, parts.iter().map(|u| TAU * u).collect()),
            // r grows evenly with the length
            Self::Spiral => {
                let grown = (GROWTH * TAU).exp_m1();
                let place = |u: &f64| (u * grown).ln_1p() / GROWTH;
                let length = grown * GROWTH.hypot(1.0) / GROWTH;
                (length, parts.iter().map(place).collect())
            }
            Self::Ellipse => {
                // speed is even and periodic: the mean over even steps is exact to rounding
                let length = |t: f64| {
                    let steps = 64;
                    let middle = |k: u32| (f64::from(k) + 0.5) / f64::from(steps);
                    let speed = |x: f64| (AXES * DVec2::from_angle(x).perp()).length();
                    (0..steps).map(|k| speed(TAU * middle(k))).sum::<f64>() * t / f64::from(steps)
                };
                let whole = length(TAU);
                (
                    whole,
                    parts.iter().map(|u| ellipse_place(u * whole)).collect(),
                )
            }
        }
    }
}

/// The parameter at which the ellipse is `length` long, by Newton's method.
fn ellipse_place(length: f64) -> f64 {
    let speed = |x: f64| (AXES * DVec2::from_angle(x).perp()).length();
    // Simpson's rule over 512 steps: 1e-12
    let arc = |t: f64| {
        let h = t / 512.0;
        let weight = |k: u32| {
            if k.is_multiple_of(512) {
                1.0
            } else {
                2.0 + 2.0 * f64::from(k % 2)
            }
        };
        (0..=512)
            .map(|k| weight(k) * speed(h * f64::from(k)))
            .sum::<f64>()
            * h
            / 3.0
    };
    (0..6).fold(length / AXES.element_product().sqrt(), |t, _| {
        t - (arc(t) - length) / speed(t)
    })
}

impl Nodes {
    const fn name(self) -> &'static str {
        match self {
            Self::Even => "even",
            Self::Smooth => "smooth",
            Self::Rough => "rough",
            Self::Noisy => "noisy",
        }
    }

    /// The part of the length at which node `i` of `steps` stands.
    fn part(self, i: usize, steps: usize) -> f64 {
        let even = i as f64 / steps as f64;
        match self {
            Self::Even | Self::Noisy => even,
            Self::Smooth => even + 0.5 * (TAU * even).sin() / TAU,
            Self::Rough if i.is_multiple_of(2) || i == steps => even,
            Self::Rough => even - 0.3 / steps as f64,
        }
    }

    /// How far the node is off the curve.
    fn shaken(self, i: usize) -> DVec2 {
        match self {
            Self::Noisy => 1e-5 * DVec2::new(dice(2 * i), dice(2 * i + 1)),
            _ => DVec2::ZERO,
        }
    }
}

/// Between −1 and 1, the same at every run: the mixing step of splitmix64.
fn dice(i: usize) -> f64 {
    let mut z = (i as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^= z >> 31;
    (z >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// All errors on one curve with one kind of nodes.
fn errors(curve: Curve, kind: Nodes, n: usize) -> Vec<(&'static str, f64)> {
    let topology = curve.topology();
    let closed = topology.is_closed();
    let steps = if closed { n } else { n - 1 };
    let parts: Vec<f64> = (0..n).map(|i| kind.part(i, steps)).collect();
    let (length, places) = curve.places(&parts);
    let exact: Vec<(DVec2, f64)> = places.iter().map(|t| curve.at(*t)).collect();
    let nodes: Vec<DVec2> = (0..n).map(|i| exact[i].0 + kind.shaken(i)).collect();
    let inner = if closed { 0..n } else { n / 8..n - n / 8 };

    let mut out = Vec::new();
    for estimate in Estimate::ALL {
        let got = curvature(&nodes, closed, estimate);
        let pairs = inner.clone().map(|i| (got[i] - exact[i].1, exact[i].1));
        out.push((estimate.name(), relative(pairs)));
    }
    let waves = [2.0, 3.0].map(|k| k * TAU / length);
    let wave = |i: usize, factor: fn(f64) -> f64| {
        let s = parts[i] * length;
        DVec2::new(
            factor(waves[0]) * (waves[0] * s).cos(),
            factor(waves[1]) * (waves[1] * s).sin(),
        )
    };
    let e: Vec<DVec2> = (0..n).map(|i| wave(i, |_| 1.0)).collect();
    let tension = Material::uniform(0.0, 1.0, 0.0);
    let rigidity = Material::uniform(0.0, 0.0, 1.0);
    let h = spacing(&nodes, closed, SpacingRule::Closed);
    // none but nodes that coincide are refused, and these do not
    let own = Spacings::of(&nodes, topology).ok();
    let mut force = vec![DVec2::ZERO; n];
    for (material, factor, names) in [
        (
            &tension,
            (|k| -k * k) as fn(f64) -> f64,
            ["tension, one spacing", "tension, its own"],
        ),
        (
            &rigidity,
            |k| -k * k * k * k,
            ["rigidity, one spacing", "rigidity, its own"],
        ),
    ] {
        let compare = |force: &[DVec2]| {
            relative(inner.clone().map(|i| {
                let want = wave(i, factor);
                ((force[i] - want).length(), want.length())
            }))
        };
        elastic_force(&e, topology, material, h, &mut force);
        out.push((names[0], compare(&force)));
        if let Some(own) = &own {
            own.force(&e, material, &mut force);
            out.push((names[1], compare(&force)));
        }
    }
    if let (true, Some(own)) = (closed, &own) {
        // the mean of cos² is a half
        let exact = 0.25 * length * waves.map(|k| k.powi(4)).iter().sum::<f64>();
        let energy = own.energy(&e, &rigidity).rigidity;
        out.push(("bending energy, its own", (energy / exact - 1.0).abs()));
    }
    out
}

/// Root of the sum of squares of the firsts over that of the seconds.
fn relative(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (error, size) = pairs.fold((0.0, 0.0), |(a, b), (x, y)| (a + x * x, b + y * y));
    (error / size).sqrt()
}
