//! What lies across the curve at each node: an edge with its polarity and width, learnt.

use crate::palette::Feature;
use crate::tables::{Strips, respaced};
use crate::window::Window;

/// Samples on either side of a node, a cell apart, and of all.
pub(crate) const HALF: usize = 4;
pub(crate) const SAMPLES: usize = 2 * HALF + 1;

/// σ along the curve of the means. Nodes.
const WIDE: f32 = 2.0;
const REACH: isize = 5;

/// Least variance. Squared units of lightness.
const LEAST: f32 = 9.0;

/// Numbers of one node.
const ROW: usize = SAMPLES * 4;

/// Means and variances at each node.
#[derive(Debug, Clone)]
pub(crate) struct Profiles {
    mean: Vec<f32>,
    variance: Vec<f32>,
    channels: usize,
}

impl Profiles {
    /// The profiles across a curve.
    pub(crate) fn learnt(window: &Window, strips: &Strips<'_>) -> Self {
        let n = strips.curve.len();
        let mut rows = vec![0.0_f32; n * ROW];
        let mut whole = vec![0.0_f32; n];
        for i in 0..n {
            let mut known = 0;
            for k in 0..SAMPLES {
                let place = strips.curve[i] + (k as f64 - HALF as f64) * strips.normals[i];
                if let Some(feature) = window.feature(place) {
                    rows[i * ROW + 4 * k..i * ROW + 4 * k + 4].copy_from_slice(&feature);
                    known += 1;
                }
            }
            whole[i] = f32::from(u8::from(known == SAMPLES));
        }
        let mut mean = vec![0.0_f32; n * ROW];
        let mut variance = vec![LEAST; n];
        let used = (SAMPLES * window.channels) as f32;
        for i in 0..n {
            let (mut total, mut squares) = (0.0_f32, 0.0_f32);
            let to = &mut mean[i * ROW..(i + 1) * ROW];
            let near = |j: isize| {
                (i.cast_signed() + j)
                    .rem_euclid(n.cast_signed())
                    .unsigned_abs()
            };
            let weight = |j: isize| (-0.5 * (j as f32 / WIDE).powi(2)).exp() * whole[near(j)];
            for j in -REACH..=REACH {
                total += weight(j);
                let row = &rows[near(j) * ROW..(near(j) + 1) * ROW];
                to.iter_mut()
                    .zip(row)
                    .for_each(|(to, v)| *to += weight(j) * v);
            }
            if total > 0.0 {
                to.iter_mut().for_each(|v| *v /= total);
                for j in -REACH..=REACH {
                    let row = &rows[near(j) * ROW..(near(j) + 1) * ROW];
                    let off: f32 = row.iter().zip(&*to).map(|(a, b)| (a - b) * (a - b)).sum();
                    squares += weight(j) * off;
                }
                variance[i] = squares / (total * used) + LEAST;
            } else {
                to.copy_from_slice(&rows[i * ROW..(i + 1) * ROW]);
                variance[i] = f32::INFINITY;
            }
        }
        Self {
            mean,
            variance,
            channels: window.channels,
        }
    }

    /// Mean square of the difference to samples about a place, over the variance.
    pub(crate) fn misfit(&self, node: usize, samples: &[Feature]) -> f64 {
        let mean = &self.mean[node * ROW..(node + 1) * ROW];
        let mut sum = 0.0_f32;
        for (sample, mean) in samples.iter().zip(mean.chunks_exact(4)) {
            for (a, b) in sample.iter().zip(mean) {
                sum += (a - b) * (a - b);
            }
        }
        f64::from(sum / (SAMPLES * self.channels) as f32 / self.variance[node])
    }

    /// Move towards others, each node by its own share.
    pub(crate) fn learn(&mut self, other: &Self, shares: &[f32]) {
        for (i, &share) in shares.iter().enumerate() {
            if !other.variance[i].is_finite() {
                continue;
            }
            if !self.variance[i].is_finite() {
                self.variance[i] = other.variance[i];
                self.mean[i * ROW..(i + 1) * ROW]
                    .copy_from_slice(&other.mean[i * ROW..(i + 1) * ROW]);
                continue;
            }
            let row = self.mean[i * ROW..(i + 1) * ROW].iter_mut();
            row.zip(&other.mean[i * ROW..(i + 1) * ROW])
                .for_each(|(a, b)| *a += share * (b - *a));
            self.variance[i] += share * (other.variance[i] - self.variance[i]);
        }
    }

    /// The same for other nodes, at places between these.
    pub(crate) fn respaced(&self, places: &[f64]) -> Self {
        let nearest: Vec<f64> = places.to_vec();
        Self {
            mean: respaced(&self.mean, ROW, &nearest),
            variance: respaced(&self.variance, 1, &nearest),
            channels: self.channels,
        }
    }
}
