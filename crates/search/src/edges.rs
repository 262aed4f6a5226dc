//! Edges of a window: slopes of its channels, how steep a slope counts as an edge, and of which sign.

use field::{Grid, gaussian_weights};
use glam::DVec2;

use crate::along::Spot;
use crate::frame::Frame;
use crate::smooth::folded;

/// σ of the Gaussian that the slopes are taken of, in pixels of the window.
const SIGMA: f64 = 1.2;

/// A slope is half an edge at least where it is this many times the spread that noise alone gives.
const NOISE: f64 = 6.0;

/// And where it is this share of the steepest hundredth.
const STEEP: f64 = 0.1;

/// The slopes of a window's channels.
#[derive(Debug)]
pub(crate) struct Edges {
    /// Slopes along x and y of each pixel, channel by channel.
    slopes: Vec<[f64; 2]>,
    channels: usize,
    dim: (usize, usize),
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
        let channels = frame.channels.len();
        let mut slopes = vec![[0.0; 2]; channels * frame.known.len()];
        for (c, channel) in frame.channels.iter().enumerate() {
            scharr(
                &blurred(channel, SIGMA),
                slopes.iter_mut().skip(c).step_by(channels),
            );
        }
        let mut sizes: Vec<f64> = slopes
            .chunks_exact(channels)
            .enumerate()
            .filter(|(at, _)| counts(*at))
            .map(|(_, pixel)| {
                pixel
                    .as_flattened()
                    .iter()
                    .map(|v| v * v)
                    .sum::<f64>()
                    .sqrt()
            })
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
            channels,
            dim: frame.dim(),
            half,
            least: noisy,
            noise,
        }
    }

    /// The slopes of the channels along a normal.
    pub(crate) fn across(&self, p: DVec2, normal: DVec2) -> Across {
        let spot = Spot::of(self.dim, p);
        let mut across = [0.0; 3];
        if self.channels == 1 {
            self.along(spot, normal, &mut across[..1]);
        } else {
            self.along(spot, normal, &mut across);
        }
        across
    }

    /// The same of so many channels.
    #[inline(always)]
    fn along(&self, spot: Spot, normal: DVec2, across: &mut [f64]) {
        let count = across.len();
        let pixels = spot
            .pixels
            .map(|at| &self.slopes[at * count..(at + 1) * count]);
        for (c, one) in across.iter_mut().enumerate() {
            let slope = |axis: usize| spot.between(pixels.map(|pixel| pixel[c][axis]));
            *one = normal.x * slope(0) + normal.y * slope(1);
        }
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

/// A channel smoothed by a Gaussian; beyond the border the last pixel is repeated.
pub(crate) fn blurred(channel: &Grid, sigma: f64) -> Grid {
    let (height, width) = channel.dim();
    let mut weights = gaussian_weights(sigma);
    weights.truncate(cut(sigma) + 1);
    let total = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
    for weight in &mut weights {
        *weight /= total;
    }
    let reach = weights.len() - 1;
    let mut rows = vec![0.0; height * width];
    let mut wide = vec![0.0; width + 2 * reach];
    for (from, to) in channel
        .rows()
        .into_iter()
        .zip(rows.chunks_exact_mut(width.max(1)))
    {
        wide[..reach].fill(from[0]);
        for (wide, value) in wide[reach..].iter_mut().zip(from) {
            *wide = *value;
        }
        wide[reach + width..].fill(from[width - 1]);
        folded(&wide, 1, &weights, to);
    }
    let mut out = Grid::zeros((height, width));
    if let Some(out) = out.as_slice_mut() {
        down(&rows, width, &weights, out);
    }
    out
}

lanes::wide! {
    /// Rows of that width smoothed down their columns by weights; beyond the first and the last row these are repeated.
    fn down(rows: &[f64], width: usize, weights: &[f64], out: &mut [f64]) {
        let height = rows.len() / width.max(1);
        let row = |y: usize| &rows[y * width..(y + 1) * width];
        for (y, to) in out.chunks_exact_mut(width.max(1)).enumerate() {
            for (to, own) in to.iter_mut().zip(row(y)) {
                *to = weights[0] * own;
            }
            for (k, weight) in weights.iter().enumerate().skip(1) {
                let both = row(y.saturating_sub(k)).iter().zip(row((y + k).min(height - 1)));
                for (to, (above, below)) in to.iter_mut().zip(both) {
                    *to = *to + weight * above + weight * below;
                }
            }
        }
    }
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "four times a width of a few pixels"
)]
fn cut(sigma: f64) -> usize {
    (4.0 * sigma).ceil() as usize
}

/// Slopes along x and y of all pixels by Scharr's masks, per pixel; at the border the last pixel is repeated.
fn scharr<'a>(grid: &Grid, mut slopes: impl Iterator<Item = &'a mut [f64; 2]>) {
    let (height, width) = grid.dim();
    let side = |v: usize, n: usize| (v.saturating_sub(1), (v + 1).min(n - 1));
    for y in 0..height {
        let (up, down) = side(y, height);
        let (above, here, below) = (grid.row(up), grid.row(y), grid.row(down));
        for (x, slope) in (0..width).zip(&mut slopes) {
            let (left, right) = side(x, width);
            let across = 3.0 * (above[right] - above[left])
                + 10.0 * (here[right] - here[left])
                + 3.0 * (below[right] - below[left]);
            let along = 3.0 * (below[left] - above[left])
                + 10.0 * (below[x] - above[x])
                + 3.0 * (below[right] - above[right]);
            *slope = [across / 32.0, along / 32.0];
        }
    }
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
