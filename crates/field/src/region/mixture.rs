//! One Gaussian a side, or a mixture whose Gaussians are the picture's and whose weights are the side's.

use super::classes::Counted;
use crate::grid::Grid;

/// The most Gaussians in a mixture.
pub(super) const MOST_COMPONENTS: usize = 8;

/// Sweeps of expectation and maximisation, once for a picture.
const LEARNING: usize = 500;

/// The most sweeps over the weights of one side, in each step.
const SWEEPS: usize = 300;

/// `−Σ m ln p` of the Gaussian with the mean and the variance of each channel, and its derivative by each `m`.
///
/// Without the 2π, which both sides share.
pub(super) fn gaussian(counted: &Counted, m: &[f64], slope: &mut [f64]) -> f64 {
    let area: f64 = m.iter().sum();
    slope.fill(0.0);
    for (center, floor) in counted
        .centers()
        .columns()
        .into_iter()
        .zip(counted.within())
    {
        let mean = m.iter().zip(center).map(|(m, c)| m * c).sum::<f64>() / area;
        let away = |c: &f64| (c - mean) * (c - mean);
        let spread = m.iter().zip(center).map(|(m, c)| m * away(c)).sum::<f64>() / area;
        let variance = spread.max(*floor);
        for (slope, c) in slope.iter_mut().zip(center) {
            *slope += 0.5 * (away(c) / variance + variance.ln());
        }
    }
    m.iter().zip(slope).map(|(m, slope)| m * *slope).sum()
}

/// `−Σ m ln p` of the mixture `Σ_k w_k p_k` with the best weights, and its derivative by each `m`: −ln p.
///
/// `parts[[k, c]]` is `p_k` of class c. The cost is convex in the weights, so there is one best.
pub(super) fn mixture(parts: &Grid, m: &[f64], slope: &mut [f64]) -> f64 {
    let area: f64 = m.iter().sum();
    let count = parts.nrows();
    let mut weights = [1.0 / count as f64; MOST_COMPONENTS];
    let mut before = f64::INFINITY;
    for _ in 0..SWEEPS {
        let mut next = [0.0; MOST_COMPONENTS];
        let mut energy = 0.0;
        for (c, &m) in m.iter().enumerate().filter(|(_, m)| **m > 0.0) {
            let likely = (0..count).map(|k| weights[k] * parts[[k, c]]);
            let p: f64 = likely.sum::<f64>().max(f64::MIN_POSITIVE);
            slope[c] = -p.ln();
            energy += m * slope[c];
            for (k, next) in next.iter_mut().enumerate().take(count) {
                *next += m * parts[[k, c]] / p;
            }
        }
        // a change per pixel far below what a push can show
        if before - energy <= 1e-14 * area {
            return energy;
        }
        before = energy;
        for (weight, next) in weights.iter_mut().zip(next) {
            *weight *= next / area;
        }
    }
    before
}

/// How likely each class is under each Gaussian of the whole picture's mixture: one row a Gaussian.
///
/// The largest of each column is 1; a factor to a class is the same on both sides.
pub(super) fn learn(counted: &Counted, components: usize) -> Grid {
    let (centers, total) = (counted.centers(), counted.total());
    let (classes, channels) = centers.dim();
    let pixels: f64 = total.iter().sum();
    let mut parts = start(counted, components);
    let mut logs = Grid::zeros((components, classes));
    for _ in 0..LEARNING {
        // how much of each class each Gaussian answers for
        for c in 0..classes {
            for (k, part) in parts.iter().enumerate() {
                logs[[k, c]] = part.log(centers.row(c).iter());
            }
            let most = largest(&logs, c);
            let mut column = logs.column_mut(c);
            column.mapv_inplace(|log| (log - most).exp());
            let sum = column.sum();
            column.mapv_inplace(|p| total[c] * p / sum);
        }
        for (part, shares) in parts.iter_mut().zip(logs.rows()) {
            let share = shares.sum();
            part.weight = share / pixels;
            // a part to which no pixel is assigned stays as it is
            if part.weight > 1e-9 {
                for j in 0..channels {
                    let moment = |about: f64, power: i32| {
                        let terms = shares.iter().zip(centers.column(j));
                        terms.map(|(s, c)| s * (c - about).powi(power)).sum::<f64>() / share
                    };
                    let mean = moment(0.0, 1);
                    part.place[j] = (mean, moment(mean, 2).max(counted.within()[j]));
                }
            }
        }
    }
    for c in 0..classes {
        for (k, part) in parts.iter().enumerate() {
            logs[[k, c]] =
                part.log(centers.row(c).iter()) - part.weight.max(f64::MIN_POSITIVE).ln();
        }
        let most = largest(&logs, c);
        logs.column_mut(c).mapv_inplace(|log| (log - most).exp());
    }
    logs
}

fn largest(logs: &Grid, c: usize) -> f64 {
    logs.column(c)
        .iter()
        .fold(f64::NEG_INFINITY, |a, &b| a.max(b))
}

/// One Gaussian of a mixture: mean and variance of each channel.
struct Part {
    weight: f64,
    place: Vec<(f64, f64)>,
}

impl Part {
    /// The logarithm of weight times density, without the 2π.
    fn log<'a>(&self, point: impl Iterator<Item = &'a f64>) -> f64 {
        let terms = self.place.iter().zip(point);
        let cost: f64 = terms
            .map(|((mean, variance), c)| (c - mean) * (c - mean) / variance + variance.ln())
            .sum();
        self.weight.max(f64::MIN_POSITIVE).ln() - 0.5 * cost
    }
}

/// Means spread evenly over ± √3 standard deviations of the widest channel; narrow and wide Gaussians take turns, so that
/// those of one mean and two widths are told apart too.
fn start(counted: &Counted, components: usize) -> Vec<Part> {
    let (centers, total) = (counted.centers(), counted.total());
    let pixels: f64 = total.iter().sum();
    let channels: Vec<(f64, f64)> = (0..centers.ncols())
        .map(|j| {
            let moment = |about: f64, power: i32| {
                let terms = total.iter().zip(centers.column(j));
                terms.map(|(m, c)| m * (c - about).powi(power)).sum::<f64>() / pixels
            };
            let mean = moment(0.0, 1);
            (mean, moment(mean, 2))
        })
        .collect();
    let widest = (0..channels.len()).max_by(|&a, &b| channels[a].1.total_cmp(&channels[b].1));
    let part = |k: usize| {
        let place = (2.0 * k as f64 + 1.0) / components as f64 - 1.0;
        let width = if k.is_multiple_of(2) { 0.5 } else { 1.0 };
        let of = |(j, &(mean, variance)): (usize, &(f64, f64))| {
            let shift = if Some(j) == widest {
                place * (3.0 * variance).sqrt()
            } else {
                0.0
            };
            (mean + shift, (width * variance).max(counted.within()[j]))
        };
        Part {
            weight: 1.0 / components as f64,
            place: channels.iter().enumerate().map(of).collect(),
        }
    };
    (0..components).map(part).collect()
}
