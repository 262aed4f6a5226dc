//! Edges of a window: slopes of its channels, how steep a slope counts as an edge, and of which sign.

use field::{Grid, gaussian_weights};
use glam::DVec2;

use crate::along::sample;
use crate::frame::Frame;

/// σ of the Gaussian that the slopes are taken of, in pixels of the window.
const SIGMA: f64 = 1.2;

/// A slope is half an edge at least where it is this many times the spread that noise alone gives.
const NOISE: f64 = 6.0;

/// And where it is this share of the steepest hundredth.
const STEEP: f64 = 0.1;

/// The slopes of a window's channels.
#[derive(Debug)]
pub(crate) struct Edges {
    /// Slopes along x and y, channel by channel.
    slopes: Vec<[Grid; 2]>,
    /// The slope that counts as half an edge.
    half: f64,
    /// The least that it may be, for noise.
    least: f64,
    /// Standard deviation of the noise of the channels.
    noise: f64,
}

/// The slopes of all channels across a curve at a place.
pub(crate) type Across = [f64; 3];

impl Edges {
    /// The slopes of a window; those where `counts` is true say how steep an edge is.
    pub(crate) fn of(frame: &Frame, counts: impl Fn(usize) -> bool) -> Self {
        let slopes: Vec<[Grid; 2]> = frame
            .channels
            .iter()
            .map(|channel| scharr(&blurred(channel, SIGMA)))
            .collect();
        let mut sizes: Vec<f64> = (0..frame.known.len())
            .filter(|&at| counts(at))
            .map(|at| size_at(&slopes, at))
            .collect();
        let noise = noise(frame, &counts);
        // what the slopes of a Gaussian leave of white noise
        let left = (8.0 * std::f64::consts::PI).sqrt().recip() / (SIGMA * SIGMA);
        let noisy = NOISE * left * noise.max(frame.rounding);
        let half = percentile(&mut sizes, 0.75)
            .max(STEEP * percentile(&mut sizes, 0.99))
            .max(noisy);
        Self {
            slopes,
            half,
            least: noisy,
            noise,
        }
    }

    /// The slopes of the channels along a normal.
    pub(crate) fn across(&self, p: DVec2, normal: DVec2) -> Across {
        let mut across = [0.0; 3];
        for (one, [x, y]) in across.iter_mut().zip(&self.slopes) {
            *one = normal.x * sample(x, p) + normal.y * sample(y, p);
        }
        across
    }

    /// How much of an edge a slope is, from 0 to 1: half where it is as steep as three quarters of the window are not.
    pub(crate) fn strength(&self, slope: f64) -> f64 {
        if slope > 0.0 {
            slope / (slope + self.half)
        } else {
            0.0
        }
    }

    /// The slope that counts as half an edge.
    pub(crate) const fn half(&self) -> f64 {
        self.half
    }

    /// The least slope that may count as half an edge: some times that of noise.
    pub(crate) const fn least(&self) -> f64 {
        self.least
    }

    /// Standard deviation of the noise of the channels.
    pub(crate) const fn noise(&self) -> f64 {
        self.noise
    }
}

/// The standard deviation of the noise of a window, over all channels: from second differences along both axes, which
/// straight edges do not have (\[immerkaer96\]), their median, which few corners do not move.
fn noise(frame: &Frame, counts: &impl Fn(usize) -> bool) -> f64 {
    let (height, width) = frame.dim();
    let d = if frame.scale > 1.0 { 2 } else { 1 };
    let mut total = 0.0;
    for channel in &frame.channels {
        let mut sizes = Vec::new();
        for y in d..height.saturating_sub(d) {
            for x in d..width.saturating_sub(d) {
                if !counts(y * width + x) {
                    continue;
                }
                let at = |i: usize, j: usize| channel[[y + j * d - d, x + i * d - d]];
                let second = at(0, 0) - 2.0 * at(1, 0) + at(2, 0)
                    - 2.0 * (at(0, 1) - 2.0 * at(1, 1) + at(2, 1))
                    + at(0, 2)
                    - 2.0 * at(1, 2)
                    + at(2, 2);
                sizes.push(second.abs());
            }
        }
        let sigma = percentile(&mut sizes, 0.5) / (0.6745 * 6.0);
        total += sigma * sigma;
    }
    total.sqrt()
}

/// The length of a slope over all channels.
pub(crate) fn size(across: Across) -> f64 {
    dot(across, across).sqrt()
}

pub(crate) fn dot(a: Across, b: Across) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The size of the slopes of a pixel, by its number.
fn size_at(slopes: &[[Grid; 2]], at: usize) -> f64 {
    let squares = slopes.iter().flatten().map(|grid| {
        let value = grid.as_slice().map_or(0.0, |list| list[at]);
        value * value
    });
    squares.sum::<f64>().sqrt()
}

/// A channel smoothed by a Gaussian; beyond the border the last pixel is repeated.
pub(crate) fn blurred(channel: &Grid, sigma: f64) -> Grid {
    let (height, width) = channel.dim();
    let mut weights = gaussian_weights(sigma);
    weights.truncate(cut(sigma) + 1);
    let total = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
    for weight in &mut weights {
        *weight /= total;
    }
    let mut rows = Grid::zeros((height, width));
    for (from, mut to) in channel.rows().into_iter().zip(rows.rows_mut()) {
        for (x, value) in to.iter_mut().enumerate() {
            let mut sum = weights[0] * from[x];
            for (k, weight) in weights.iter().enumerate().skip(1) {
                sum += weight * (from[x.saturating_sub(k)] + from[(x + k).min(width - 1)]);
            }
            *value = sum;
        }
    }
    let mut out = Grid::zeros((height, width));
    for (y, mut to) in out.rows_mut().into_iter().enumerate() {
        to.scaled_add(weights[0], &rows.row(y));
        for (k, &weight) in weights.iter().enumerate().skip(1) {
            to.scaled_add(weight, &rows.row(y.saturating_sub(k)));
            to.scaled_add(weight, &rows.row((y + k).min(height - 1)));
        }
    }
    out
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "four times a width of a few pixels"
)]
fn cut(sigma: f64) -> usize {
    (4.0 * sigma).ceil() as usize
}

/// Slopes along x and y by Scharr's masks, per pixel; at the border the last pixel is repeated.
fn scharr(grid: &Grid) -> [Grid; 2] {
    let (height, width) = grid.dim();
    let side = |v: usize, n: usize| (v.saturating_sub(1), (v + 1).min(n - 1));
    let mut slopes = [Grid::zeros((height, width)), Grid::zeros((height, width))];
    for y in 0..height {
        let (up, down) = side(y, height);
        let (above, here, below) = (grid.row(up), grid.row(y), grid.row(down));
        for x in 0..width {
            let (left, right) = side(x, width);
            let across = 3.0 * (above[right] - above[left])
                + 10.0 * (here[right] - here[left])
                + 3.0 * (below[right] - below[left]);
            let along = 3.0 * (below[left] - above[left])
                + 10.0 * (below[x] - above[x])
                + 3.0 * (below[right] - above[right]);
            slopes[0][[y, x]] = across / 32.0;
            slopes[1][[y, x]] = along / 32.0;
        }
    }
    slopes
}

/// The value that such a share of all are below; 0 of none.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a share of the list's length"
)]
pub(crate) fn percentile(values: &mut [f64], share: f64) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let at = ((values.len() - 1) as f64 * share).round() as usize;
    let (_, value, _) = values.select_nth_unstable_by(at, f64::total_cmp);
    *value
}
