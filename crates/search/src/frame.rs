//! The window of a picture that a search looks at, at the scale it works in.
//!
//! The start's bounding box and a margin around it are resampled so that an object of the start's
//! area has a radius of about [`RADIUS`] pixels: what a search costs does not depend on the size
//! of the picture, and little on that of the object.

use std::ops::Range;

use field::{Grid, Pixels};
use glam::DVec2;

use crate::along::Polygon;
use crate::lab::lab;

/// Radius of an object in the window, in its pixels.
pub(crate) const RADIUS: f64 = 64.0;

/// The most a small object is enlarged.
const MOST_ENLARGED: f64 = 1.5;

/// Levels of fewer steps than this from the lowest to the highest are those of a drawing.
const FEWEST: f64 = 6.0;

/// A window of a picture: channels of equal size, L\*a\*b\* of a color picture, one of a grey one.
#[derive(Debug)]
pub(crate) struct Frame {
    pub channels: Vec<Grid>,
    /// 1 where a pixel of the window shows the picture, 0 where it lies outside or does not count.
    pub known: Grid,
    /// Pixels of the window a pixel of the picture.
    pub scale: f64,
    /// Standard deviation of the rounding of the levels to whole steps, in units of the channels.
    pub rounding: f64,
    /// Where the window's first pixel has its corner, in the picture.
    corner: DVec2,
}

impl Frame {
    /// The window around a start with a margin of so many of its radii, in which the start times `zoom` has the usual
    /// radius.
    pub(crate) fn around(pixels: &dyn Pixels, start: &Polygon, margin: f64, zoom: f64) -> Self {
        let radius = if start.closed {
            (start.area() / std::f64::consts::PI).sqrt()
        } else {
            start.length() / std::f64::consts::TAU
        };
        let scale = (RADIUS / (zoom * radius)).min(MOST_ENLARGED);
        let (low, high) = start.bounds();
        let around = DVec2::splat(margin * radius);
        let size = ((high - low + 2.0 * around) * scale).ceil();
        // about its middle, so that a picture that is turned has the same window
        let corner = 0.5 * (low + high) - 0.5 * size / scale;
        Self::sampled(pixels, corner, scale, size)
    }

    /// All of a picture at a scale.
    pub(crate) fn whole(pixels: &dyn Pixels, scale: f64) -> Self {
        let (width, height) = pixels.size();
        let size = DVec2::new(width as f64, height as f64);
        Self::sampled(pixels, DVec2::splat(-0.5), scale, (size * scale).ceil())
    }

    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the picture or to a window of some hundred pixels first"
    )]
    fn sampled(pixels: &dyn Pixels, corner: DVec2, scale: f64, size: DVec2) -> Self {
        let (width, height) = (size.x.max(1.0) as usize, size.y.max(1.0) as usize);
        let columns = Line::new(corner.x, scale, width, pixels.size().0);
        let rows = Line::new(corner.y, scale, height, pixels.size().1);
        let color = pixels.is_color();
        let count = if color { 3 } else { 1 };
        let mut channels = vec![Grid::zeros((height, width)); count];
        let mut known = Grid::zeros((height, width));
        // rows of the picture, each resampled along x once: three channels and the weight
        let mut made: Vec<(usize, Vec<[f64; 4]>)> = Vec::new();
        let mut sums = vec![[0.0_f64; 4]; width];
        let mut empty = false;
        for y in 0..height {
            sums.fill([0.0; 4]);
            for &(row, weight) in &rows.taps[y] {
                if made.iter().all(|(made, _)| *made != row) {
                    if made.len() == KEPT {
                        made.rotate_left(1);
                        made.truncate(KEPT - 1);
                    }
                    made.push((row, columns.resampled(pixels, row)));
                }
                let values = made.iter().find(|(made, _)| *made == row);
                for (sums, values) in sums
                    .iter_mut()
                    .zip(values.iter().flat_map(|(_, list)| list))
                {
                    for (sum, value) in sums.iter_mut().zip(values) {
                        *sum += weight * value;
                    }
                }
            }
            for (x, [a, b, c, weight]) in sums.iter().copied().enumerate() {
                empty |= weight <= 0.5;
                let share = if weight > 0.0 { weight.recip() } else { 0.0 };
                if color {
                    let values = lab([a * share, b * share, c * share]);
                    for (channel, value) in channels.iter_mut().zip(values) {
                        channel[[y, x]] = value;
                    }
                } else {
                    channels[0][[y, x]] = a * share;
                }
                let within = rows.within[y] && columns.within[x] && weight > 0.5;
                known[[y, x]] = f64::from(u8::from(within));
            }
        }
        if empty {
            fill(&mut channels, &known);
        }
        let step = least_step(pixels, corner, size / scale);
        let percent = if color {
            100.0 / 255.0
        } else {
            to_percent(&mut channels[0], &known)
        };
        // a drawing of a few levels has not been rounded to them
        let drawn = step * percent > 100.0 / FEWEST;
        let rounding = if drawn {
            0.0
        } else {
            step * percent / 12.0_f64.sqrt()
        };
        Self {
            channels,
            known,
            scale,
            rounding,
            corner,
        }
    }

    /// Height and width.
    pub(crate) fn dim(&self) -> (usize, usize) {
        self.known.dim()
    }

    /// A point of the picture in the window.
    pub(crate) fn to_window(&self, p: DVec2) -> DVec2 {
        (p - self.corner) * self.scale - 0.5
    }

    /// A point of the window in the picture.
    pub(crate) fn to_picture(&self, p: DVec2) -> DVec2 {
        (p + 0.5) / self.scale + self.corner
    }
}

/// Give pixels of which nothing is known the values of their nearest known neighbours, so that they have no edge.
fn fill(channels: &mut [Grid], known: &Grid) {
    let (height, width) = known.dim();
    let mut done = known.mapv(|known| known > 0.0);
    let mut front: Vec<(usize, usize)> = done
        .indexed_iter()
        .filter(|(_, done)| **done)
        .map(|(at, _)| at)
        .collect();
    while !front.is_empty() {
        let mut next = Vec::new();
        for (y, x) in front {
            let beside = [
                (y.wrapping_sub(1), x),
                (y + 1, x),
                (y, x.wrapping_sub(1)),
                (y, x + 1),
            ];
            for (j, i) in beside {
                if j < height && i < width && !done[[j, i]] {
                    done[[j, i]] = true;
                    for channel in &mut *channels {
                        channel[[j, i]] = channel[[y, x]];
                    }
                    next.push((j, i));
                }
            }
        }
        front = next;
    }
}

/// The least difference of neighbouring pixels that is not 0, on some rows and columns of a part of a picture; 0
/// where there is none.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the picture first"
)]
fn least_step(pixels: &dyn Pixels, corner: DVec2, size: DVec2) -> f64 {
    let (width, height) = pixels.size();
    let range = |from: f64, size: f64, most: usize| {
        let from = from.clamp(0.0, (most - 1) as f64);
        let to = (from + size).clamp(0.0, most as f64);
        from as usize..to as usize
    };
    let columns = range(corner.x, size.x, width);
    let rows = range(corner.y, size.y, height);
    let some = |range: &Range<usize>| range.clone().step_by(range.len().div_ceil(16).max(1));
    let mut least = f64::INFINITY;
    let mut see = |a: f64, b: f64| {
        let step = (a - b).abs();
        if step > 0.0 && step.is_finite() {
            least = least.min(step);
        }
    };
    for y in some(&rows) {
        for x in columns.clone().skip(1) {
            see(pixels.level(x, y), pixels.level(x - 1, y));
        }
    }
    for x in some(&columns) {
        for y in rows.clone().skip(1) {
            see(pixels.level(x, y), pixels.level(x, y - 1));
        }
    }
    if least.is_finite() { least } else { 0.0 }
}

/// Levels that differ by less than this share of the largest are equal.
const ROUNDING: f64 = 1e-9;

/// Bring levels to 0 … 100, so that nothing depends on the units of the picture; returns the factor.
fn to_percent(grid: &mut Grid, known: &Grid) -> f64 {
    let counted = grid.iter().zip(known).filter(|(_, known)| **known > 0.0);
    let (low, high) = counted.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (v, _)| {
        (low.min(*v), high.max(*v))
    });
    let span = high - low;
    // means of equal levels differ by their rounding
    if span > ROUNDING * low.abs().max(high.abs()) {
        grid.mapv_inplace(|v| 100.0 * ((v - low) / span).clamp(0.0, 1.0));
        100.0 / span
    } else {
        grid.fill(0.0);
        0.0
    }
}

/// Rows that are kept for the next row of the window: the last two of one are the first of the next.
const KEPT: usize = 3;

/// Which pixels of one line of the picture make each pixel of one line of the window.
struct Line {
    /// Pixels and their weights, which sum to 1.
    taps: Vec<Vec<(usize, f64)>>,
    /// Whether the middle of the pixel lies in the picture.
    within: Vec<bool>,
}

impl Line {
    /// Means over areas where the window is coarser than the picture, linear between pixels where it is finer; beyond
    /// the border the last pixel is repeated.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the picture first"
    )]
    fn new(corner: f64, scale: f64, count: usize, length: usize) -> Self {
        let last = (length - 1) as f64;
        let clamped = |at: f64| at.clamp(0.0, last) as usize;
        let taps = |i: usize| -> Vec<(usize, f64)> {
            let (from, to) = (corner + i as f64 / scale, corner + (i + 1) as f64 / scale);
            if scale >= 1.0 {
                let middle = f64::midpoint(from, to);
                let share = middle - middle.floor();
                let pair = [(middle.floor(), 1.0 - share), (middle.floor() + 1.0, share)];
                return pair.map(|(at, weight)| (clamped(at), weight)).to_vec();
            }
            let (low, high) = ((from + 0.5).floor(), (to - 0.5).ceil());
            if high < 0.0 || low > last {
                return vec![(clamped(low), 1.0)];
            }
            let (low, high) = (low.max(0.0), high.min(last));
            let count = (high - low) as usize + 1;
            let weight = |k: usize| {
                let at = low + k as f64;
                let covered = (at + 0.5).min(to) - (at - 0.5).max(from);
                (clamped(at), (covered * scale).max(0.0))
            };
            let mut taps: Vec<(usize, f64)> = (0..count).map(weight).collect();
            let sum: f64 = taps.iter().map(|(_, weight)| weight).sum();
            if sum <= 0.0 {
                return vec![(clamped(low), 1.0)];
            }
            for (_, weight) in &mut taps {
                *weight /= sum;
            }
            taps
        };
        let within = |i: usize| {
            let middle = corner + (i as f64 + 0.5) / scale;
            (-0.5..=last + 0.5).contains(&middle)
        };
        Self {
            taps: (0..count).map(taps).collect(),
            within: (0..count).map(within).collect(),
        }
    }

    /// A row of the picture along this line: sums of three channels, of a grey one the first, and of the weights of the
    /// pixels that count.
    fn resampled(&self, pixels: &dyn Pixels, row: usize) -> Vec<[f64; 4]> {
        let ends = self.taps.iter().flatten().map(|(column, _)| *column);
        let first = ends.clone().min().unwrap_or(0);
        let last = ends.max().unwrap_or(0);
        let color = pixels.is_color();
        let valid = pixels.valid();
        let values: Vec<[f64; 4]> = (first..=last)
            .map(|column| {
                if valid.is_some_and(|valid| !valid[[row, column]]) {
                    return [0.0; 4];
                }
                let [a, b, c] = if color {
                    pixels.color(column, row)
                } else {
                    [pixels.level(column, row), 0.0, 0.0]
                };
                let finite = a.is_finite() && b.is_finite() && c.is_finite();
                if finite { [a, b, c, 1.0] } else { [0.0; 4] }
            })
            .collect();
        let sum = |taps: &Vec<(usize, f64)>| {
            let mut sum = [0.0; 4];
            for &(column, weight) in taps {
                for (sum, value) in sum.iter_mut().zip(values[column - first]) {
                    *sum += weight * value;
                }
            }
            sum
        };
        self.taps.iter().map(sum).collect()
    }
}
