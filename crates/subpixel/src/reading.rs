//! Profiles compared with a step that a Gaussian has blurred.

use std::f64::consts::PI;

use search::smooth::smoothed;

use crate::normal::{density, distribution};
use crate::profile::{NOISE_LEFT, Profiles, SAMPLE};

/// Length of the stretch beside the edge that a level is the mean of. Pixels.
pub(crate) const PLATEAU: f64 = 3.0;

/// σ along the curve over which levels are smoothed, and over which profiles are when they are judged. Pixels.
const ALONG: f64 = 10.0;
const JUDGED: f64 = 5.0;

/// Blurs that are tried. Pixels.
pub(crate) const BLURS: [f64; 9] = [0.5, 0.65, 0.8, 0.95, 1.1, 1.3, 1.55, 1.85, 2.2];

/// Levels are exact to this share of the largest at best.
const ROUNDING: f64 = 1e-7;

/// The half of a normal distribution that lies nearest to its middle lies within so many σ.
const HALF: f64 = 0.6745;

/// Profiles of the nodes of a curve at the distance `spacing`.
pub(crate) struct Edge<'a> {
    pub profiles: &'a Profiles,
    pub spacing: f64,
    pub closed: bool,
}

/// What the profiles say of where the edge is.
#[derive(Debug)]
pub(crate) struct Reading {
    /// Slope of the logarithm of the likelihood along the normal, and its Fisher information.
    pub gradient: Vec<f64>,
    pub information: Vec<f64>,
    /// Level inside less level outside.
    pub heights: Vec<f64>,
    /// Standard deviation of a pixel's noise, and of whatever else the step does not explain.
    pub noise: f64,
    /// Variance of the offset for want of knowledge of the two levels. Square pixels.
    pub level: Vec<f64>,
}

/// A blurred step at the samples of a profile: how much of the inside there is, and the slope.
struct Model {
    share: Vec<f64>,
    slope: Vec<f64>,
}

impl Edge<'_> {
    fn model(&self, blur: f64) -> Model {
        let z = (0..self.profiles.count()).map(|k| -self.profiles.offset(k) / blur);
        let (share, slope) = z.map(|z| (distribution(z), density(z) / blur)).unzip();
        Model { share, slope }
    }

    /// Levels inside and outside, smoothed along the curve.
    fn sides(&self, blur: f64) -> [Vec<f64>; 2] {
        let near = 2.0 * blur + 0.2;
        [-1.0, 1.0].map(|sign| {
            let beside: Vec<usize> = (0..self.profiles.count())
                .filter(|&k| {
                    let way = sign * self.profiles.offset(k);
                    way >= near && way <= near + PLATEAU
                })
                .collect();
            let mean = |i: usize| {
                let row = self.profiles.row(i);
                beside.iter().map(|&k| row[k]).sum::<f64>() / beside.len().max(1) as f64
            };
            let list: Vec<f64> = (0..self.profiles.nodes()).map(mean).collect();
            smoothed(&list, ALONG / self.spacing, self.closed)
        })
    }

    /// Length of curve that a smoothed value is a mean of, for a Gaussian of that σ.
    fn averaged(&self, sigma: f64) -> f64 {
        (2.0 * PI.sqrt() * sigma).min(self.spacing * self.profiles.nodes() as f64)
    }

    pub(crate) fn read(&self, blur: f64) -> Reading {
        let [inner, outer] = self.sides(blur);
        let model = self.model(blur);
        let n = self.profiles.nodes();
        let (mut gradient, mut information) = (vec![0.0; n], vec![0.0; n]);
        let window = 2.0 * blur + 1.0;
        let near: Vec<usize> = (0..self.profiles.count())
            .filter(|&k| self.profiles.offset(k).abs() <= window)
            .collect();
        let mut squares = Vec::with_capacity(n * near.len());
        for i in 0..n {
            let (row, height) = (self.profiles.row(i), inner[i] - outer[i]);
            for &k in &near {
                let left = row[k] - outer[i] - height * model.share[k];
                let slope = height * model.slope[k];
                gradient[i] += slope * left;
                information[i] += slope * slope;
                squares.push(left * left);
            }
        }
        let mean = squares.iter().sum::<f64>() / squares.len().max(1) as f64;
        let middle = squares.len() / 2;
        let median = squares
            .select_nth_unstable_by(middle, f64::total_cmp)
            .1
            .sqrt()
            / HALF;
        let rounding = ROUNDING * self.profiles.largest();
        let noise = (median.max(0.5 * mean.sqrt()) / NOISE_LEFT)
            .max(rounding)
            .max(f64::MIN_POSITIVE);
        let unit = self.spacing * SAMPLE / (noise * noise);
        for value in gradient.iter_mut().chain(&mut information) {
            *value *= unit;
        }
        let heights: Vec<f64> = inner.iter().zip(&outer).map(|(a, b)| a - b).collect();
        let area = self.averaged(ALONG) * PLATEAU;
        let variance = |height: &f64| {
            // an error of both levels moves the edge by 2 √π blur of its share of the height
            let way = 2.0 * PI.sqrt() * blur * noise / height.abs().max(1e-3 * noise);
            way * way / (2.0 * area)
        };
        let level = heights.iter().map(variance).collect();
        Reading {
            gradient,
            information,
            heights,
            noise,
            level,
        }
    }

    /// How much of the profile about each node a blurred step explains, 0 … 1, apart from noise.
    pub(crate) fn explained(&self, blur: f64, noise: f64) -> Vec<f64> {
        let [inner, outer] = self.sides(blur);
        let model = self.model(blur);
        let n = self.profiles.nodes();
        // neighbouring samples share pixels: a third more is left than of independent ones
        let rest = 1.3 * (NOISE_LEFT * noise).powi(2) / self.averaged(JUDGED);
        let (mut left, mut all) = (vec![0.0; n], vec![0.0; n]);
        for k in 0..self.profiles.count() {
            if self.profiles.offset(k).abs() > 2.0 * blur + PLATEAU {
                continue;
            }
            let column: Vec<f64> = (0..n).map(|i| self.profiles.row(i)[k]).collect();
            let column = smoothed(&column, JUDGED / self.spacing, self.closed);
            for (i, level) in column.iter().enumerate() {
                let step = outer[i] + (inner[i] - outer[i]) * model.share[k];
                left[i] += (level - step).powi(2) - rest;
                all[i] += (level - f64::midpoint(inner[i], outer[i])).powi(2);
            }
        }
        let share = |i: usize| {
            let good = self.profiles.is_whole(i) && all[i] > 0.0;
            if good {
                (1.0 - left[i].max(0.0) / all[i]).max(0.0)
            } else {
                0.0
            }
        };
        (0..n).map(share).collect()
    }

    /// The number of the blur under which the profiles are best explained, beginning from one.
    pub(crate) fn best_blur(&self, from: usize) -> usize {
        let misfit = |blur: f64| -> f64 {
            let [inner, outer] = self.sides(blur);
            let model = self.model(blur);
            let near: Vec<usize> = (0..self.profiles.count())
                .filter(|&k| {
                    self.profiles.offset(k).abs() <= BLURS[BLURS.len() - 1] + PLATEAU - 1.7
                })
                .collect();
            let mut total = 0.0;
            for i in 0..self.profiles.nodes() {
                let (row, height) = (self.profiles.row(i), inner[i] - outer[i]);
                for &k in &near {
                    let left = row[k] - outer[i] - height * model.share[k];
                    total += left * left;
                }
            }
            total
        };
        let mut known = [f64::NAN; BLURS.len()];
        let mut at = from;
        loop {
            let low = at.saturating_sub(1);
            let high = (at + 1).min(BLURS.len() - 1);
            let mut best = at;
            for one in [at, low, high] {
                if known[one].is_nan() {
                    known[one] = misfit(BLURS[one]);
                }
                if known[one] < known[best] {
                    best = one;
                }
            }
            if best == at {
                return at;
            }
            at = best;
        }
    }
}
