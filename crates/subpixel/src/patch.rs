//! The part of a picture around an outline, for many looks at the same pixels.

use glam::DVec2;

use crate::blocks::Blocks;

/// The most pixels that are copied, per node of the outline.
const MOST_A_NODE: usize = 256;

/// Pixels around an outline, of one channel or three.
pub(crate) enum Patch<'a> {
    Grey(Part<'a, 1>),
    Color(Part<'a, 3>),
}

/// Pixels of a part of a picture: copied if there are few of them for the length of the outline.
pub(crate) struct Part<'a, const N: usize> {
    pixels: Blocks<'a>,
    at: fn(&Blocks<'a>, usize, usize) -> [f64; N],
    left: usize,
    top: usize,
    width: usize,
    copied: Vec<[f64; N]>,
    height: usize,
}

impl<'a> Patch<'a> {
    /// The pixels within `reach` of an outline.
    pub(crate) fn around(pixels: Blocks<'a>, points: &[DVec2], reach: f64) -> Self {
        if pixels.is_color() {
            Self::Color(Part::around(pixels, Blocks::color, points, reach))
        } else {
            Self::Grey(Part::around(pixels, Blocks::level, points, reach))
        }
    }
}

impl<'a, const N: usize> Part<'a, N> {
    fn around(
        pixels: Blocks<'a>,
        at: fn(&Blocks<'a>, usize, usize) -> [f64; N],
        points: &[DVec2],
        reach: f64,
    ) -> Self {
        let (width, height) = pixels.size();
        let start = (DVec2::splat(f64::INFINITY), DVec2::splat(f64::NEG_INFINITY));
        let (low, high) = points
            .iter()
            .fold(start, |(low, high), p| (low.min(*p), high.max(*p)));
        let (left, right) = (
            clamped(low.x - reach, width),
            clamped(high.x + reach, width),
        );
        let (top, bottom) = (
            clamped(low.y - reach, height),
            clamped(high.y + reach, height),
        );
        let (width, height) = (right - left + 1, bottom - top + 1);
        let mut part = Self {
            pixels,
            at,
            left,
            top,
            width,
            height,
            copied: Vec::new(),
        };
        if width.saturating_mul(height) <= MOST_A_NODE.saturating_mul(points.len()) {
            let rows = top..=bottom;
            part.copied = rows
                .flat_map(|y| (left..=right).map(move |x| at(&pixels, x, y)))
                .collect();
        }
        part
    }

    fn pixel(&self, x: usize, y: usize) -> [f64; N] {
        if !self.copied.is_empty() {
            let (i, j) = (x.wrapping_sub(self.left), y.wrapping_sub(self.top));
            if i < self.width && j < self.height {
                return self.copied[j * self.width + i];
            }
        }
        (self.at)(&self.pixels, x, y)
    }

    /// The same where all pixels that count are copied.
    #[inline]
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "cut to whole numbers that are compared with the size"
    )]
    fn within(&self, p: DVec2) -> Option<[f64; N]> {
        // beyond the left or upper side there is no such number of a pixel
        let (x, y) = (p.x - self.left as f64 - 1.0, p.y - self.top as f64 - 1.0);
        if self.copied.is_empty() || !(x >= 0.0 && y >= 0.0) {
            return None;
        }
        let (i, j) = (x as usize, y as usize);
        if i + 4 > self.width || j + 4 > self.height {
            return None;
        }
        let (across, down) = (weights(x - i as f64), weights(y - j as f64));
        let mut sum = [0.0; N];
        for (row, weight) in (j..j + 4).zip(down) {
            let first = row * self.width + i;
            for (values, share) in self.copied[first..first + 4].iter().zip(across) {
                for (sum, value) in sum.iter_mut().zip(values) {
                    *sum += weight * share * value;
                }
            }
        }
        Some(sum)
    }

    /// The picture between its pixels by cubic convolution (\[keys81\], a = −1/2); beyond the border the
    /// last pixel is
    /// repeated.
    pub(crate) fn sample(&self, p: DVec2) -> [f64; N] {
        if let Some(sum) = self.within(p) {
            return sum;
        }
        let (width, height) = self.pixels.size();
        let corner = p.floor();
        let (across, down) = (weights(p.x - corner.x), weights(p.y - corner.y));
        let columns: [usize; 4] =
            std::array::from_fn(|i| clamped(corner.x + i as f64 - 1.0, width));
        let mut sum = [0.0; N];
        for (j, weight) in down.iter().enumerate() {
            let row = clamped(corner.y + j as f64 - 1.0, height);
            for (&column, share) in columns.iter().zip(&across) {
                for (sum, value) in sum.iter_mut().zip(self.pixel(column, row)) {
                    *sum += weight * share * value;
                }
            }
        }
        sum
    }
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the picture first"
)]
pub(crate) fn clamped(at: f64, count: usize) -> usize {
    at.clamp(0.0, (count - 1) as f64) as usize
}

/// Weights of the four pixels about a place that lies by `t` behind the second.
fn weights(t: f64) -> [f64; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [
        0.5 * (-t3 + 2.0 * t2 - t),
        0.5 * (3.0 * t3 - 5.0 * t2 + 2.0),
        0.5 * (-3.0 * t3 + 4.0 * t2 + t),
        0.5 * (t3 - t2),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_of_noise_is_as_stated() {
        let squares = |t: f64| weights(t).iter().map(|w| w * w).sum::<f64>();
        let mean = (0..1000)
            .map(|k| squares((f64::from(k) + 0.5) / 1000.0))
            .sum::<f64>()
            / 1000.0;
        // the root of the mean square in two dimensions is that mean
        assert!((mean - crate::profile::NOISE_LEFT).abs() < 0.01, "{mean}");
    }

    #[test]
    fn a_plane_is_sampled_exactly() {
        let t = 0.37;
        let sum: f64 = weights(t)
            .iter()
            .zip([-1.0, 0.0, 1.0, 2.0])
            .map(|(w, x)| w * x)
            .sum();
        assert!((sum - t).abs() < 1e-15 && (weights(t).iter().sum::<f64>() - 1.0).abs() < 1e-15);
    }
}
