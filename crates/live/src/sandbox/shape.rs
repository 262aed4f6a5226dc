//! How a snake is deformed: strain, area, and its modes.

use glam::DVec2;
use scene::elastic;
use scene::snake::Member;
use serde_json::{Value, json};

use super::Sandbox;
use crate::LiveError;

/// Modes that are looked at, either way round.
const MODES: usize = 24;

impl Sandbox {
    /// Deformation, area and the share of each mode of a snake.
    pub(crate) fn shape(&self, id: Option<usize>) -> Result<Value, LiveError> {
        let member = self.member_or_first(id)?;
        let (snake, state) = (member.snake(), member.state());
        let mut e = vec![DVec2::ZERO; state.len()];
        snake.deformation_into(&state.x, &mut e);
        let closed = member.is_closed();
        let lengths: Vec<f64> = e.iter().map(|e| e.length()).collect();
        let area = closed.then(|| elastic::signed_area(&state.x).abs());
        let rest = closed.then(|| elastic::signed_area(&snake.body().rest).abs());
        Ok(json!({
            "snake": member.id(),
            "deformation": lengths,
            "rms": elastic::rms(&e),
            "area": area, "area-at-rest": rest,
            "length": elastic::length(&state.x, closed),
            "length-at-rest": elastic::length(&snake.body().rest, closed),
            "modes": modes(&e, closed),
            "speed": speed(member),
        }))
    }
}

/// Mean velocity of a snake's nodes.
fn speed(member: &Member) -> f64 {
    let v = &member.state().v;
    (v.iter().copied().sum::<DVec2>() / v.len() as f64).length()
}

/// Size of each mode of a deformation: of a closed curve the waves that run round it, both ways together; of an open
/// one those of cosine that end level. They add up, squared, to the mean square of the deformation where all are asked.
fn modes(e: &[DVec2], closed: bool) -> Vec<f64> {
    let n = e.len();
    let most = if closed { n / 2 } else { n - 1 };
    let wave = |k: usize| {
        let turn = |i: usize| {
            if closed {
                std::f64::consts::TAU * (k * i % n) as f64 / n as f64
            } else {
                std::f64::consts::PI * k as f64 * (i as f64 + 0.5) / n as f64
            }
        };
        let (mut cosine, mut sine) = (DVec2::ZERO, DVec2::ZERO);
        for (i, e) in e.iter().enumerate() {
            let (s, c) = turn(i).sin_cos();
            cosine += c * *e;
            sine += s * *e;
        }
        let both = if closed {
            cosine.length_squared() + sine.length_squared()
        } else {
            cosine.length_squared()
        };
        // the first of all, and the last of an even ring, are there once
        let once = k == 0 || (closed && 2 * k == n);
        let twice = if once { 1.0 } else { 2.0 };
        (twice * both).sqrt() / n as f64
    };
    (0..=most.min(MODES)).map(wave).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_modes_add_up_to_the_deformation() {
        for closed in [true, false] {
            for n in [9, 10] {
                let place = |i: usize| {
                    let t = i as f64;
                    DVec2::new((1.7 * t).sin() + 0.2, (0.3 * t * t).cos())
                };
                let e: Vec<DVec2> = (0..n).map(place).collect();
                let whole = e.iter().map(|e| e.length_squared()).sum::<f64>() / n as f64;
                let parts: f64 = modes(&e, closed).iter().map(|a| a * a).sum();
                assert!(
                    (parts / whole - 1.0).abs() < 1e-12,
                    "{closed} {n}: {parts} {whole}"
                );
            }
        }
    }
}
