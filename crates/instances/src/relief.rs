//! A picture as smooth grids in which objects are high, at several scales.

use field::Grid;
use search::whole::{Whole, blurred, quantile};

/// σ of the blur, in pixels of each scale.
const SIGMA: f64 = 1.0;

/// Share of the pixels that are not above the ground.
const GROUND: f64 = 0.2;

/// Share of the pixels that are lower than the ground anywhere, and how many standard deviations of noise the level of
/// an object's border lies above it at least.
const LOWEST: f64 = 0.02;
const ABOVE: f64 = 4.0;

/// Standard deviation that a Gaussian of that σ leaves of white noise of 1.
const LEFT: f64 = 0.282_094_791_773_878_14 / SIGMA;

/// What the least slope that may be half an edge is of white noise of 1.
const SLOPE: f64 = 6.0 * 0.199_471_140_200_716_35 / 1.44;

/// The smaller side of the coarsest grid, at least.
const SMALL: usize = 24;

/// A grid of heights at one scale.
#[derive(Debug, Clone)]
pub(crate) struct Relief {
    heights: Grid,
    /// Pixels of the picture a pixel, along each side.
    pub times: usize,
    /// Standard deviation of the noise.
    pub noise: f64,
}

impl Relief {
    pub(crate) fn dim(&self) -> (usize, usize) {
        self.heights.dim()
    }

    pub(crate) fn value(&self, x: usize, y: usize) -> f64 {
        self.heights[[y, x]]
    }

    /// The heights as whole numbers, the height of one, and the number of the ground.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped by its range"
    )]
    pub(crate) fn steps(&self) -> (Vec<u16>, f64, u16) {
        let all = self.heights.iter();
        let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
            (low.min(*v), high.max(*v))
        });
        let step = ((high - low) / 65_000.0).max(f64::MIN_POSITIVE);
        let values = self
            .heights
            .iter()
            .map(|v| ((v - low) / step).round() as u16);
        (values.collect(), step, (-low / step).round() as u16)
    }
}

impl Relief {
    /// The number of the height below which there is no half height of an object that noise does not explain.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped by its range"
    )]
    pub(crate) fn floor(&self, step: f64) -> u16 {
        let mut list: Vec<f64> = self.heights.iter().copied().collect();
        let low = list.iter().fold(f64::INFINITY, |low, v| low.min(*v));
        let least = quantile(&mut list, LOWEST) + ABOVE * self.noise;
        ((least - low) / step).clamp(0.0, 65_000.0) as u16
    }
}

/// A picture along a direction of color, from its own scale to the coarsest.
pub(crate) fn reliefs(whole: &Whole, direction: [f64; 3]) -> Vec<Relief> {
    let mut grid = Grid::zeros(whole.dim());
    for (channel, share) in whole.channels().iter().zip(direction) {
        grid.scaled_add(share, channel);
    }
    let mut list: Vec<f64> = grid.iter().copied().collect();
    let ground = quantile(&mut list, GROUND);
    grid.mapv_inplace(|v| v - ground);
    let noise = whole.least() / SLOPE;
    let (mut out, mut times) = (Vec::new(), 1);
    loop {
        out.push(Relief {
            heights: blurred(&grid, SIGMA),
            times,
            noise: LEFT * noise / times as f64,
        });
        let (height, width) = grid.dim();
        if height.min(width) < 2 * SMALL {
            return out;
        }
        grid = Grid::from_shape_fn((height.div_ceil(2), width.div_ceil(2)), |(y, x)| {
            let at = |j: usize, i: usize| {
                grid[[(2 * y + j).min(height - 1), (2 * x + i).min(width - 1)]]
            };
            0.25 * (at(0, 0) + at(0, 1) + at(1, 0) + at(1, 1))
        });
        times *= 2;
    }
}
