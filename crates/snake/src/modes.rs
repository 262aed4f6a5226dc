//! The modes of a snake's elastic force, by the shortest way there is to each.

use banded::{Circulant, Dense, Slices};
use integrator::System;

use crate::Snake;

/// The most nodes whose modes are found one by one where the curve is not a ring of equal nodes.
const MOST: usize = 400;

/// A stiffness below this share of the largest cannot be told from none.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// How many of the slowest modes are found where there are more nodes than that.
const SLOWEST: usize = 8;

/// One way for the whole curve to move, as a damped oscillator `ü + 2 ζ ω u̇ + ω² u = 0`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeOfMotion {
    /// ω: its frequency without damping. T⁻¹. 0: nothing brings it back.
    pub frequency: f64,
    /// γ/(2μ) as this mode feels it. T⁻¹.
    pub fading: f64,
}

impl ModeOfMotion {
    /// ζ: below 1 it rings, above 1 it creeps, at 1 it is first at rest. Infinite where ω = 0.
    #[must_use]
    pub fn damping_ratio(&self) -> f64 {
        if self.frequency > 0.0 || self.fading > 0.0 {
            self.fading / self.frequency
        } else {
            0.0
        }
    }

    /// The rate at which it decays in the end: the slower of its two roots; for ω = 0, that of its
    /// velocity. T⁻¹.
    #[must_use]
    pub fn decay(&self) -> f64 {
        let (b, w) = (self.fading, self.frequency);
        if w > 0.0 && b > w {
            w * (w / (b + ((b - w) * (b + w)).sqrt()))
        } else if w > 0.0 {
            b
        } else {
            2.0 * b
        }
    }
}

/// Values at nodes that may move.
pub(crate) fn free<'a>(snake: &'a Snake, values: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
    let pairs = values.iter().zip(snake.held());
    pairs.filter(|(_, held)| !**held).map(|(&value, _)| value)
}

/// Modes from the slowest up, and whether these are all.
pub(crate) fn modes(snake: &Snake) -> (Vec<ModeOfMotion>, bool) {
    let (mass, damping) = (snake.mass(), snake.damping());
    let least = free(snake, mass).fold(f64::INFINITY, f64::min);
    if least == f64::INFINITY {
        return (Vec::new(), true); // every node is held
    }
    if least <= 0.0 {
        let frantic = ModeOfMotion {
            frequency: f64::INFINITY,
            fading: f64::INFINITY,
        };
        return (vec![frantic], false);
    }
    if let Some(values) = waves(snake) {
        let fading = 0.5 * damping[0] / mass[0];
        let modes = values.iter().map(|value| mode(value / mass[0], fading));
        return (modes.collect(), true);
    }
    if snake.len() <= MOST
        && let Some(modes) = every(snake)
    {
        return (modes, true);
    }
    outermost(snake)
}

fn mode(stiffness: f64, fading: f64) -> ModeOfMotion {
    ModeOfMotion {
        frequency: stiffness.max(0.0).sqrt(),
        fading,
    }
}

/// All modes by the dense eigenbasis of the nodes that move.
fn every(snake: &Snake) -> Option<Vec<ModeOfMotion>> {
    let (mass, damping, held) = (snake.mass(), snake.damping(), snake.held());
    let nodes: Vec<usize> = (0..snake.len()).filter(|&i| !held[i]).collect();
    let matrix = snake.stiffness().dense();
    let scaled = Dense::from_fn(nodes.len(), |a, b| {
        let (i, j) = (nodes[a], nodes[b]);
        matrix[(i, j)] / (mass[i].sqrt() * mass[j].sqrt())
    });
    let eigen = scaled.eigen().ok()?;
    let most = eigen.values.last()?.abs();
    let fading = |u: &[f64]| -> f64 {
        let each = nodes.iter().zip(u);
        each.map(|(&i, u)| u * u * damping[i] / mass[i]).sum()
    };
    let modes = eigen.values.iter().zip(&eigen.vectors).map(|(&value, u)| {
        // what cannot be told from 0 is none
        let own = if value < ROUNDING * most { 0.0 } else { value };
        mode(own, 0.5 * fading(u))
    });
    Some(modes.collect())
}

/// Eigenvalues of a closed curve of equal nodes, in ascending order.
fn waves(snake: &Snake) -> Option<Vec<f64>> {
    let equal = |values: &[f64]| values.iter().all(|v| v.to_bits() == values[0].to_bits());
    let operator = snake.stiffness();
    let even = !snake.held().contains(&true)
        && equal(snake.mass())
        && equal(snake.damping())
        && operator.columns().iter().all(|column| equal(column));
    let circulant = even
        .then(|| Circulant::new(operator.band()).ok())
        .flatten()?;
    let mut values = circulant.eigenvalues().to_vec();
    let most = values.iter().copied().fold(0.0, f64::max);
    if values[0].abs() < ROUNDING * most {
        // the rounding of the rows' sum is in all of them
        let sum = values[0];
        values.iter_mut().for_each(|value| *value -= sum);
    }
    if !operator.columns().is_empty() {
        // what all nodes share only changes the mode in which all move alike
        let mut product = vec![0.0; values.len()];
        operator.multiply_scalars_into(&vec![1.0; values.len()], &mut product);
        values[0] = product.iter().sum::<f64>() / values.len() as f64;
        if values[0] < ROUNDING * most {
            values[0] = 0.0;
        }
    }
    values.sort_by(f64::total_cmp);
    Some(values)
}

/// The weights of the spectrum: masses, and 1 for nodes that are held, which add an eigenvalue 0 each.
fn weights(snake: &Snake) -> Vec<f64> {
    let pairs = snake.mass().iter().zip(snake.held());
    pairs
        .map(|(&m, &held)| if held { 1.0 } else { m })
        .collect()
}

/// Modes that nothing brings back, the slowest of the others, and the fastest: stiffness by bisection, damping from
/// their shapes where it is not the same for all.
fn outermost(snake: &Snake) -> (Vec<ModeOfMotion>, bool) {
    let weights = weights(snake);
    let Some(slices) = Slices::new(snake.stiffness(), &weights) else {
        return (Vec::new(), false);
    };
    let (n, held) = (snake.len(), snake.held());
    let fixed = held.iter().filter(|held| **held).count();
    let zeros = slices.zeros().max(fixed);
    let ratio = |i: usize| snake.damping()[i] / weights[i];
    let first = (0..n).find(|&i| !held[i]).map_or(0.0, ratio);
    let even = (0..n).all(|i| held[i] || (ratio(i) - first).abs() <= 1e-14 * first.abs());
    let mut numbers: Vec<usize> = (fixed..n.min(zeros + SLOWEST)).collect();
    if numbers.last().is_some_and(|last| last + 1 < n) {
        numbers.push(n - 1);
    }
    if even {
        // those in between come to rest no later
        numbers.retain(|&k| k <= zeros || k + 1 == n);
    }
    let mut shapes: Vec<Vec<f64>> = Vec::new();
    let found = numbers.into_iter().map(|k| {
        let stiffness = match k {
            _ if k < zeros => 0.0,
            _ => slices.eigenvalue(k).unwrap_or(0.0),
        };
        if even {
            return mode(stiffness, 0.5 * first);
        }
        let others: Vec<&[f64]> = shapes.iter().map(Vec::as_slice).collect();
        let mut u = slices.eigenvector(stiffness, &others);
        (u.iter_mut().zip(held)).for_each(|(u, held)| *u *= if *held { 0.0 } else { 1.0 });
        let size: f64 = (0..n).map(|i| weights[i] * u[i] * u[i]).sum();
        let drag: f64 = (0..n).map(|i| snake.damping()[i] * u[i] * u[i]).sum();
        shapes.push(u);
        mode(stiffness, 0.5 * drag / size)
    });
    (found.collect(), false)
}

/// The highest frequency.
pub(crate) fn fastest(snake: &Snake) -> f64 {
    let least = free(snake, snake.mass()).fold(f64::INFINITY, f64::min);
    if least == f64::INFINITY {
        return 0.0;
    }
    if least <= 0.0 {
        return f64::INFINITY;
    }
    let weights = weights(snake);
    let slices = Slices::new(snake.stiffness(), &weights);
    let last = slices.and_then(|slices| slices.eigenvalue(snake.len() - 1));
    last.map_or(f64::INFINITY, f64::sqrt)
}

/// The frequency of mode number `k` of those that resist, counted from the slowest, or how many there are.
pub(crate) fn resisting(snake: &Snake, k: usize) -> Result<f64, usize> {
    let (modes, complete) = modes(snake);
    let known = modes.iter().filter(|mode| mode.frequency > 0.0);
    if complete || modes.iter().any(|mode| mode.frequency.is_infinite()) {
        let found = known.clone().nth(k).map(|mode| mode.frequency);
        return found.filter(|w| w.is_finite()).ok_or(known.count());
    }
    let weights = weights(snake);
    let slices = Slices::new(snake.stiffness(), &weights).ok_or(0_usize)?;
    let zeros = slices.zeros();
    let number = zeros.checked_add(k).and_then(|k| slices.eigenvalue(k));
    number.map(f64::sqrt).ok_or(snake.len() - zeros)
}

#[cfg(test)]
#[path = "modes_tests.rs"]
mod tests;
