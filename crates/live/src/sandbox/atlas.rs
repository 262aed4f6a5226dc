//! The plane of mass and damping of a snake: where it rings, creeps, zigzags and blows up (report §3.4.2, §3.4.3).

use scene::elastic::Profile;
use scene::integrator::Scheme;
use scene::snake::{Certificate, ModeOfMotion, Parameter, Snake};
use serde_json::{Value, json};

use super::Sandbox;
use crate::LiveError;

/// Columns and rows of the plane.
const COLUMNS: usize = 60;
const ROWS: usize = 44;

/// Places of the plane, along mass and damping, at which limits are found.
const LATTICE: (usize, usize) = (9, 9);

/// A logarithm that stands for any number.
const FAR: f64 = 50.0;

/// The plane reaches so many times below and above the values of now.
const REACH: f64 = 100.0;

/// Moments of the motion of one spring.
const MOMENTS: usize = 241;

/// What a whole snake does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Regime {
    Rings,
    Mixed,
    Creeps,
    Zigzags,
    Grows,
}

impl Regime {
    const ALL: [(Self, &'static str); 5] = [
        (Self::Rings, "all modes ring"),
        (Self::Mixed, "slow modes creep, fast ones ring"),
        (Self::Creeps, "all modes creep"),
        (Self::Zigzags, "a mode changes sides at every step"),
        (Self::Grows, "blows up"),
    ];

    fn words(self) -> &'static str {
        let all = Self::ALL.iter();
        all.filter(|(regime, _)| *regime == self)
            .map(|(_, words)| *words)
            .next()
            .unwrap_or_default()
    }
}

/// A snake seen from its slowest and its fastest mode.
struct Plane<'a> {
    snake: &'a Snake,
    scheme: Scheme,
    dt: f64,
    /// Stiffness of the slowest mode that resists, and of the fastest. M T⁻².
    stiffness: [f64; 2],
    /// How steeply forces push back where the snake is. M T⁻².
    slope: f64,
}

impl Plane<'_> {
    /// What the snake does with that mass and damping; `beyond`: how far beyond its limit the step is, as a logarithm.
    fn regime(&self, mass: f64, damping: f64, beyond: f64) -> Regime {
        if beyond > 0.0 {
            return Regime::Grows;
        }
        let [slow, fast] = self.stiffness.map(|k| damping < 2.0 * (mass * k).sqrt());
        if self.zigzags(mass, damping) {
            return Regime::Zigzags;
        }
        match (slow, fast) {
            (true, _) => Regime::Rings,
            (false, true) => Regime::Mixed,
            (false, false) => Regime::Creeps,
        }
    }

    /// How far the step is beyond the limit of the scheme, as the logarithm of both: below 0 within it.
    fn beyond(&self, mass: f64, damping: f64) -> f64 {
        let mut body = self.snake.body().clone();
        let set = body
            .set(Parameter::Mass, Profile::Uniform(mass))
            .and_then(|()| body.set(Parameter::Damping, Profile::Uniform(damping)));
        let mut snake = self.snake.clone();
        if set.and_then(|()| snake.set_body(body)).is_err() {
            return FAR;
        }
        let limit = Certificate::limit_for_slope(&snake, self.scheme, self.slope);
        limit.map_or(-FAR, |limit| (self.dt / limit).ln().clamp(-FAR, FAR))
    }

    /// The same on a lattice over the plane, row by row: a limit takes long to be found, and its logarithm is nearly
    /// straight between places so near.
    fn lattice(&self, x: (f64, f64), y: (f64, f64)) -> Vec<f64> {
        let at = |(low, high): (f64, f64), i: usize, count: usize| {
            low * (high / low).powf(i as f64 / (count - 1) as f64)
        };
        let places = (0..LATTICE.1).flat_map(|j| (0..LATTICE.0).map(move |i| (i, j)));
        let beyond = places.map(|(i, j)| self.beyond(at(x, i, LATTICE.0), at(y, j, LATTICE.1)));
        beyond.collect()
    }

    /// Whether the fastest mode changes sides at every step, where the roots of a step are known.
    fn zigzags(&self, mass: f64, damping: f64) -> bool {
        let a = damping * self.dt / mass;
        let b = self.stiffness[1] * self.dt * self.dt / mass;
        let (trace, product) = match self.scheme {
            Scheme::Report => (2.0 - a - b, 1.0 - a),
            Scheme::Leapfrog => (
                (2.0 - b) / (1.0 + 0.5 * a),
                (1.0 - 0.5 * a) / (1.0 + 0.5 * a),
            ),
            _ => return false,
        };
        let square = 0.25 * trace * trace - product;
        square >= 0.0 && 0.5 * trace - square.sqrt() < 0.0
    }
}

impl Sandbox {
    /// The plane of mass and damping about those of a snake, and one spring in the same regime beside it.
    pub(crate) fn atlas(&self, id: Option<usize>) -> Result<Value, LiveError> {
        let member = self.member_or_first(id)?;
        let body = member.snake().body();
        let n = body.len();
        let (mass, damping) = (mean(&body.mass, n), mean(&body.damping, n));
        let certificate = Certificate::of(member.snake(), Some(member.state()));
        let Some([slow, fast]) = ends(&certificate) else {
            return Err(LiveError::new(
                "nothing of this snake resists deformation, so that no mode rings or creeps",
            ));
        };
        // ω² μ of a mode is its stiffness
        let stiffness = [slow, fast].map(|mode| mode.frequency.powi(2) * mass);
        let stepping = self.simulation().stepping();
        let plane = Plane {
            snake: member.snake(),
            scheme: stepping.scheme,
            dt: stepping.dt,
            stiffness,
            slope: certificate.image_slope,
        };
        let critical = 2.0 * (mass * stiffness[0]).sqrt();
        let (x, y) = (
            span(mass),
            span(if damping > 0.0 { damping } else { critical }),
        );
        let at = |(low, high): (f64, f64), i: usize, count: usize| {
            low * (high / low).powf((i as f64 + 0.5) / count as f64)
        };
        let lattice = plane.lattice(x, y);
        let cell = |k: usize| {
            let (row, column) = (k / COLUMNS, k % COLUMNS);
            let share = |i: usize, count: usize| (i as f64 + 0.5) / count as f64;
            let beyond = between(&lattice, share(column, COLUMNS), share(row, ROWS));
            let regime = plane.regime(at(x, column, COLUMNS), at(y, row, ROWS), beyond);
            Regime::ALL.iter().position(|(known, _)| *known == regime)
        };
        let cells: Vec<usize> = (0..COLUMNS * ROWS).filter_map(cell).collect();
        let words: Vec<&str> = Regime::ALL.iter().map(|(_, words)| *words).collect();
        Ok(json!({
            "columns": COLUMNS, "rows": ROWS, "cells": cells, "regimes": words,
            "mass": [x.0, x.1], "damping": [y.0, y.1],
            "now": [mass, damping], "is": plane.regime(mass, damping, plane.beyond(mass, damping)).words(),
            "slowest": stiffness[0], "fastest": stiffness[1],
            "critical": critical,
            "spring": spring(slow.frequency, damping / (2.0 * mass)),
        }))
    }
}

/// The slowest mode that resists, and the fastest.
fn ends(certificate: &Certificate) -> Option<[ModeOfMotion; 2]> {
    let most = certificate.elastic;
    let resists = |mode: &&ModeOfMotion| mode.frequency > 1e-6 * most;
    let slow = certificate
        .modes
        .iter()
        .filter(resists)
        .min_by(|a, b| a.frequency.total_cmp(&b.frequency))?;
    let fast = ModeOfMotion {
        frequency: most,
        fading: slow.fading,
    };
    Some([*slow, fast])
}

/// A spring let go at 1, by the formulas of the damped oscillator: its times and places, and in words.
fn spring(frequency: f64, fading: f64) -> Value {
    let (w, b) = (frequency, fading);
    let time = 4.0 * std::f64::consts::TAU / w;
    let place = |t: f64| {
        let fade = (-b * t).exp();
        if b < w {
            let own = (w * w - b * b).sqrt();
            fade * ((own * t).cos() + b / own * (own * t).sin())
        } else if b > w {
            let own = (b * b - w * w).sqrt();
            // both roots, so that nothing overflows
            let (slow, fast) = (-w * w / (b + own), -(b + own));
            (fast * (slow * t).exp() - slow * (fast * t).exp()) / (fast - slow)
        } else {
            fade * (1.0 + b * t)
        }
    };
    let moments = (0..MOMENTS).map(|i| time * i as f64 / (MOMENTS - 1) as f64);
    let ratio = b / w;
    let words = if ratio < 0.999 {
        "rings"
    } else if ratio > 1.001 {
        "creeps"
    } else {
        "critical: first at rest"
    };
    json!({
        "time": time, "ratio": ratio, "frequency": w, "words": words,
        "places": moments.map(place).collect::<Vec<f64>>(),
    })
}

/// A value between those of the lattice, at shares of both axes.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "from 0 to the size of the lattice"
)]
fn between(lattice: &[f64], u: f64, v: f64) -> f64 {
    let (columns, rows) = LATTICE;
    let place = |share: f64, count: usize| {
        let at = share.clamp(0.0, 1.0) * (count - 1) as f64;
        let first = (at.floor() as usize).min(count - 2);
        (first, at - first as f64)
    };
    let ((i, a), (j, b)) = (place(u, columns), place(v, rows));
    let row = |j: usize| (1.0 - a) * lattice[j * columns + i] + a * lattice[j * columns + i + 1];
    (1.0 - b) * row(j) + b * row(j + 1)
}

/// The values of an axis about a value.
fn span(value: f64) -> (f64, f64) {
    (value / REACH, value * REACH)
}

pub(super) fn mean(profile: &Profile, n: usize) -> f64 {
    profile.to_vec(n).iter().sum::<f64>() / n as f64
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may stop the process")]
mod tests {
    use super::*;

    #[test]
    fn the_spring_obeys_its_equation() {
        for (w, b) in [(2.0, 0.3), (2.0, 2.0), (2.0, 9.0), (0.1, 0.0)] {
            let drawn = spring(w, b);
            let places: Vec<f64> = serde_json::from_value(drawn["places"].clone()).unwrap();
            let h = drawn["time"].as_f64().unwrap() / (MOMENTS - 1) as f64;
            assert!((places[0] - 1.0).abs() < 1e-12);
            for three in places.windows(3) {
                let acceleration = (three[2] - 2.0 * three[1] + three[0]) / (h * h);
                let velocity = (three[2] - three[0]) / (2.0 * h);
                let sum = acceleration + 2.0 * b * velocity + w * w * three[1];
                // the differences err by h²/12 of a fourth derivative
                let error = h * h * (w + b).powi(4);
                assert!(sum.abs() <= error, "{w} {b}: {sum} of {error}");
            }
        }
    }
}
