//! What a mode does: predicted by the roots of its step, and measured by a run.

use crate::prelude::*;
use elastic::{Material, Topology};
use integrator::{Scheme, Start, State};
use snake::{Body, Snake, World};
use std::f64::consts::TAU;

/// Nodes of the ring, and the numbers of its slowest and its fastest deformation.
pub(crate) const NODES: usize = 24;
const SLOW: usize = 1;
const FAST: usize = NODES / 2;
/// Spacing of its nodes, so that a frequency can be told without a ruler.
pub(crate) const SPACING: f64 = 1.0;

/// A point of any of the planes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Point {
    pub(crate) mass: f64,
    pub(crate) damping: f64,
    pub(crate) material: [f64; 3],
    pub(crate) dt: f64,
}

/// What one mode does under a scheme.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Motion {
    /// Swings about rest.
    Rings,
    /// Comes to rest from one side.
    Creeps,
    /// Changes sides at every step.
    Zigzags,
    /// Blows up.
    Grows,
}

/// What the whole ring does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Regime {
    /// Every mode rings.
    Rings,
    /// Slow modes creep, fast ones ring.
    Mixed,
    /// Every mode creeps.
    Creeps,
    /// A mode changes sides at every step: nothing physical.
    Zigzags,
    /// A mode blows up.
    Grows,
}

impl Regime {
    pub(crate) const ALL: [Self; 5] = [
        Self::Rings,
        Self::Mixed,
        Self::Creeps,
        Self::Zigzags,
        Self::Grows,
    ];

    /// Its place in [`Regime::ALL`], for tables.
    pub(crate) fn index(self) -> usize {
        Self::ALL
            .iter()
            .position(|&known| known == self)
            .unwrap_or(0)
    }

    pub(crate) const fn words(self) -> &'static str {
        match self {
            Self::Rings => "all modes ring",
            Self::Mixed => "slow modes creep, fast ones ring",
            Self::Creeps => "all modes creep",
            Self::Zigzags => "a mode zigzags",
            Self::Grows => "blows up",
        }
    }

    const fn of(slow: Motion, fast: Motion) -> Self {
        match (slow, fast) {
            (Motion::Grows, _) | (_, Motion::Grows) => Self::Grows,
            (Motion::Zigzags, _) | (_, Motion::Zigzags) => Self::Zigzags,
            (Motion::Creeps, Motion::Creeps) => Self::Creeps,
            (Motion::Creeps, Motion::Rings) => Self::Mixed,
            (Motion::Rings, _) => Self::Rings,
        }
    }
}

impl Point {
    /// λ of the slowest deformation and of the fastest.
    pub(crate) fn stiffness(&self) -> [f64; 2] {
        let [w0, w1, w2] = self.material;
        [SLOW, FAST].map(|k| {
            let s = (std::f64::consts::PI * real(k) / real(NODES)).sin().powi(2);
            w0 + 4.0 * w1 * s / SPACING.powi(2) + 16.0 * w2 * s * s / SPACING.powi(4)
        })
    }

    /// The regime by the roots of `z² − tr z + det` of the outermost modes.
    pub(crate) fn predicted(&self, scheme: Scheme) -> Regime {
        let [slow, fast] = self.stiffness().map(|stiffness| {
            let a = self.damping * self.dt / self.mass;
            let b = stiffness * self.dt * self.dt / self.mass;
            let (trace, product) = match scheme {
                Scheme::Report => (2.0 - a - b, 1.0 - a),
                _ => (
                    (2.0 - b) / (1.0 + 0.5 * a),
                    (1.0 - 0.5 * a) / (1.0 + 0.5 * a),
                ),
            };
            let square = 0.25 * trace * trace - product;
            if square < 0.0 {
                return if product > 1.0 {
                    Motion::Grows
                } else {
                    Motion::Rings
                };
            }
            let largest = 0.5 * trace.abs() + square.sqrt();
            match (largest > 1.0, trace < 0.0) {
                (true, _) => Motion::Grows,
                (false, true) => Motion::Zigzags,
                (false, false) => Motion::Creeps,
            }
        });
        Regime::of(slow, fast)
    }

    /// The regime by two runs of a snake, bent in one mode each and let go.
    pub(crate) fn measured(&self, scheme: Scheme) -> Result<Regime> {
        Ok(Regime::of(self.run(scheme, SLOW)?, self.run(scheme, FAST)?))
    }

    fn run(&self, scheme: Scheme, mode: usize) -> Result<Motion> {
        let radius = SPACING / (2.0 * (std::f64::consts::PI / real(NODES)).sin());
        let circle = elastic::circle(DVec2::ZERO, radius, NODES);
        let [tether, tension, rigidity] = self.material;
        let mut body = Body::of(&circle, Topology::Closed, self.mass)?
            .with_material(Material::uniform(tether, tension, rigidity))
            .with_damping(self.damping);
        body.spacing = SPACING;
        let mut snake = Snake::new(body, World::default())?;
        let wave = |i: usize| (TAU * real(mode * i % NODES) / real(NODES)).cos();
        let wave: Vec<f64> = (0..NODES).map(wave).collect();
        let rest = snake.body().rest.clone();
        let bent = rest
            .iter()
            .zip(&wave)
            .map(|(r, w)| *r + DVec2::new(*w, 0.0));
        let mut state = State::at_rest(bent.collect());
        let mut stepper = scheme.start(&mut snake, &state, self.dt, Start::SecondOrder)?;
        let norm: f64 = wave.iter().map(|w| w * w).sum();
        let amplitude = |state: &State| -> f64 {
            let parts = state.x.iter().zip(&rest).zip(&wave);
            parts.map(|((x, r), w)| (x.x - r.x) * w).sum::<f64>() / norm
        };
        let mut seen = vec![1.0];
        for _ in 0..STEPS {
            if stepper.step(&mut snake, &mut state).is_err() {
                return Ok(Motion::Grows);
            }
            let now = amplitude(&state);
            if now.is_nan() || now.abs() > 1e3 {
                return Ok(Motion::Grows);
            }
            if now.abs() < GONE {
                break;
            }
            seen.push(now);
        }
        Ok(judged(&seen))
    }
}

/// Steps of a run at most, and the deformation that counts as rest.
const STEPS: usize = 6000;
const GONE: f64 = 1e-11;

/// What a series of amplitudes shows, by its later half.
fn judged(seen: &[f64]) -> Motion {
    let turn = |pair: &&[f64]| (pair[0] < 0.0) != (pair[1] < 0.0);
    let turns = |part: &[f64]| part.windows(2).filter(turn).count();
    let (early, late) = seen.split_at(seen.len() / 2);
    let largest = |part: &[f64]| part.iter().fold(0.0_f64, |most, a| most.max(a.abs()));
    if seen.len() > STEPS && largest(late) > 1.2 * largest(early) {
        Motion::Grows
    } else if late.len() > 2 && turns(late) + 1 >= late.len() {
        Motion::Zigzags
    } else if turns(seen) > 0 {
        Motion::Rings
    } else {
        Motion::Creeps
    }
}
