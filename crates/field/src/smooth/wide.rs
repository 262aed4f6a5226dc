//! Wide smoothing at a cost that does not grow with σ: down to every d-th line, smooth there, and up again.
//!
//! ```text
//! c[j] = Σ_k g(k) I[jd + k]      a Gaussian of σ = d thins the lines out, d = ⌊σ/2⌋
//! c′   = h ∗ c                   on the thin lines: whatever is left of the smoothing asked for
//! S[i] = Σ_j g(i − jd) c′[j]     the same Gaussian fills in, its weights made to sum to 1 at each i
//! ```
//!
//! The filter h is found from the transfer functions: T of the smoothing asked for (a Gaussian, or cos²ᵖ of so many
//! passes), divided by that of both windows as they stand, sampled and cut. So all that is lost is what the
//! thinning folds over: a wave of amplitude 1 is off by at most 1e-6, and a picture by far less, since most of it
//! is no such wave. The sums are in `f32`, in parts of 16 terms, which adds a few of its roundings. Beyond the border
//! the lines are the image's mirror, as everywhere here.

use super::Smoothing;
use crate::grid::mirrored;
use pulp::{Simd, WithSimd};
use std::f64::consts::PI;

/// Reach of the window in units of its σ: what is cut off is 2e-8 of its middle, and h makes up for it.
const REACH: usize = 6;

/// Reach of h in thin lines; it falls off as a Gaussian of at most 2 lines.
const THIN_REACH: usize = 16;

/// Terms that are summed before the sum is added to the others': a sum of a thousand would lose digits.
const PART: usize = 16;

/// Vectors of columns worked on at once: their sums stay in registers.
const COLUMNS: usize = 4;

/// What a line is made of: weights of lines, and which.
type Terms = Vec<(f32, usize)>;

/// A wide smoothing along one axis.
#[derive(Debug, Clone)]
pub(crate) struct Wide {
    /// Lines from one thin line to the next.
    step: usize,
    /// g, from the middle on, 0 … `REACH` · `step`.
    window: Vec<f64>,
    /// h, from the middle on.
    thin: Vec<f64>,
}

impl Wide {
    /// The filters of a valid smoothing with a σ of 6 px or more: below, the direct sum is as cheap.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "σ was checked: 6 … 1e4"
    )]
    pub(crate) fn new(smoothing: Smoothing) -> Self {
        let sigma = smoothing.sigma();
        let step = (sigma / 2.0).max(1.0) as usize;
        let z = |k: usize| k as f64 / step as f64;
        let window: Vec<f64> = (0..=REACH * step)
            .map(|k| (-0.5 * z(k) * z(k)).exp())
            .collect();
        let sum = window[0] + 2.0 * window[1..].iter().sum::<f64>();
        let window: Vec<f64> = window.iter().map(|w| w / sum).collect();
        // h is even, so its weights are a cosine sum over its transfer function on 0 … π
        let points = 8 * THIN_REACH;
        let transfer: Vec<f64> = (0..=points)
            .map(|i| {
                let omega = PI * i as f64 / (points * step) as f64;
                let wave = (1..).zip(&window[1..]);
                let through = wave.map(|(k, w)| 2.0 * w * (omega * f64::from(k)).cos());
                let through = window[0] + through.sum::<f64>();
                wanted(smoothing, omega) / (through * through)
            })
            .collect();
        let weight = |m: usize| {
            let inner = (1..points).map(|i| {
                let angle = PI * (m * i) as f64 / points as f64;
                transfer[i] * angle.cos()
            });
            let end = if m.is_multiple_of(2) { 0.5 } else { -0.5 };
            (0.5 * transfer[0] + inner.sum::<f64>() + end * transfer[points]) / points as f64
        };
        let mut thin: Vec<f64> = (0..=THIN_REACH).map(weight).collect();
        let sum = thin[0] + 2.0 * thin[1..].iter().sum::<f64>();
        thin.iter_mut().for_each(|w| *w /= sum);
        Self { step, window, thin }
    }

    /// Smooths every column of a picture of rows of `width`.
    ///
    /// About 25 multiplications a pixel, whatever σ; memory is two pictures and the thin lines.
    pub(crate) fn along_y(&self, picture: &[f32], width: usize) -> Vec<f32> {
        let Some(&level) = picture.first() else {
            return Vec::new();
        };
        let height = picture.len() / width;
        // about the first pixel: a constant picture stays one to the last bit
        let pixels: Vec<f32> = picture.iter().map(|v| v - level).collect();
        let reach = self.window.len() - 1;
        // thin lines that some line needs, and as many more as h reaches
        let after = REACH + (height - 1) / self.step + 1;
        let count = REACH + after + 1;
        let mut weights = vec![0.0; height];
        let mut thinned = |j: usize| -> Terms {
            let center =
                (j * self.step).cast_signed() - ((REACH + THIN_REACH) * self.step).cast_signed();
            weights.fill(0.0);
            let rows = (0..=2 * reach).map(|k| {
                (
                    k,
                    mirrored(center + k.cast_signed() - reach.cast_signed(), height),
                )
            });
            let (mut first, mut last) = (height, 0);
            for (k, row) in rows {
                weights[row] += self.window[k.abs_diff(reach)];
                (first, last) = (first.min(row), last.max(row));
            }
            let used = weights[first..=last].iter().zip(first..);
            used.filter(|(w, _)| **w > 0.0)
                .map(|(&w, row)| (narrow(w), row))
                .collect()
        };
        let thin: Vec<Terms> = (0..count + 2 * THIN_REACH).map(&mut thinned).collect();
        let thin = combine(&thin, &pixels, width);
        let smooth = |j: usize| -> Terms {
            (0..=2 * THIN_REACH)
                .map(|m| (narrow(self.thin[m.abs_diff(THIN_REACH)]), j + m))
                .collect()
        };
        let smooth: Vec<Terms> = (0..count).map(smooth).collect();
        let smooth = combine(&smooth, &thin, width);
        let filled = |i: usize| -> Terms {
            let terms: Vec<(f64, usize)> = (i / self.step..count)
                .take(2 * REACH + 2)
                .filter_map(|j| {
                    let distance = (i + REACH * self.step).abs_diff(j * self.step);
                    self.window.get(distance).map(|&w| (w, j))
                })
                .collect();
            let sum: f64 = terms.iter().map(|(w, _)| w).sum();
            terms.iter().map(|&(w, j)| (narrow(w / sum), j)).collect()
        };
        let filled: Vec<Terms> = (0..height).map(filled).collect();
        let mut out = combine(&filled, &smooth, width);
        out.iter_mut().for_each(|v| *v += level);
        out
    }

    /// Smooths every row of a picture of rows of `width`.
    pub(crate) fn along_x(&self, picture: &[f32], width: usize) -> Vec<f32> {
        let height = picture.len() / width;
        let turned = self.along_y(&turned(picture, width), height);
        self::turned(&turned, height)
    }
}

/// Rows of `width` become columns.
fn turned(picture: &[f32], width: usize) -> Vec<f32> {
    const BLOCK: usize = 16;
    let height = picture.len() / width;
    let mut out = vec![0.0; picture.len()];
    for y in (0..height).step_by(BLOCK) {
        let rows = BLOCK.min(height - y);
        for x in (0..width).step_by(BLOCK) {
            for column in x..width.min(x + BLOCK) {
                let to = &mut out[column * height + y..][..rows];
                for (row, to) in to.iter_mut().enumerate() {
                    *to = picture[(y + row) * width + column];
                }
            }
        }
    }
    out
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to f32 is the point"
)]
fn narrow(weight: f64) -> f32 {
    weight as f32
}

/// Transfer function of a smoothing at a frequency of `omega` per pixel.
fn wanted(smoothing: Smoothing, omega: f64) -> f64 {
    match smoothing {
        Smoothing::Binomial(passes) => (2.0 * f64::from(passes) * (0.5 * omega).cos().ln()).exp(),
        Smoothing::Gaussian(sigma) => (-0.5 * (sigma * omega) * (sigma * omega)).exp(),
    }
}

/// Lines that are sums of weighted rows.
fn combine(lines: &[Terms], rows: &[f32], width: usize) -> Vec<f32> {
    let mut out = vec![0.0; lines.len() * width];
    lanes::registers().dispatch(Combine {
        lines,
        rows,
        width,
        out: &mut out,
    });
    out
}

struct Combine<'a> {
    lines: &'a [Terms],
    rows: &'a [f32],
    width: usize,
    out: &'a mut [f32],
}

impl WithSimd for Combine<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            lines,
            rows,
            width,
            out,
        } = self;
        // a block of columns of all lines at a time: the rows of one stay in the cache for the next
        let block = COLUMNS * S::F32_LANES;
        let mut at = 0;
        while at + block <= width {
            for (line, terms) in lines.iter().enumerate() {
                let mut sums = [simd.splat_f32s(0.0); COLUMNS];
                for terms in terms.chunks(PART) {
                    let mut part = [simd.splat_f32s(0.0); COLUMNS];
                    for &(w, row) in terms {
                        let w = simd.splat_f32s(w);
                        let row = &rows[row * width + at..][..block];
                        let row = &S::as_simd_f32s(row).0[..COLUMNS];
                        for u in 0..COLUMNS {
                            part[u] = simd.add_f32s(part[u], simd.mul_f32s(w, row[u]));
                        }
                    }
                    for u in 0..COLUMNS {
                        sums[u] = simd.add_f32s(sums[u], part[u]);
                    }
                }
                let out = &mut out[line * width + at..][..block];
                S::as_mut_simd_f32s(out).0.copy_from_slice(&sums);
            }
            at += block;
        }
        for column in at..width {
            for (line, terms) in lines.iter().enumerate() {
                let parts = terms.chunks(PART).map(|terms| {
                    terms
                        .iter()
                        .fold(0.0, |sum, &(w, row)| sum + w * rows[row * width + column])
                });
                out[line * width + column] = parts.fold(0.0, |sum, part: f32| sum + part);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Grid;

    /// By way of `f32`.
    fn along_y(wide: &Wide, image: &Grid) -> Grid {
        let pixels: Vec<f32> = image.iter().map(|&v| narrow(v)).collect();
        let smooth = wide.along_y(&pixels, image.ncols());
        let smooth = smooth.into_iter().map(f64::from).collect();
        Grid::from_shape_vec(image.dim(), smooth).unwrap()
    }

    fn along_x(wide: &Wide, image: &Grid) -> Grid {
        let pixels: Vec<f32> = image.iter().map(|&v| narrow(v)).collect();
        let smooth = wide.along_x(&pixels, image.ncols());
        let smooth = smooth.into_iter().map(f64::from).collect();
        Grid::from_shape_vec(image.dim(), smooth).unwrap()
    }

    fn noise(height: usize, width: usize) -> Grid {
        let mut state = 0x9e37_79b9_u32;
        Grid::from_shape_simple_fn((height, width), || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 24)
        })
    }

    fn largest_difference(a: &Grid, b: &Grid) -> f64 {
        (a - b).iter().fold(0.0, |most, d| d.abs().max(most))
    }

    #[test]
    fn wide_smoothing_is_the_direct_sum_within_a_millionth_of_the_largest_pixel() {
        for (height, width) in [(160, 90), (7, 61), (1, 40), (3, 3), (1, 1)] {
            let (noise, edge) = (
                noise(height, width),
                Grid::from_shape_fn(
                    (height, width),
                    |(y, x)| if x + 2 * y > 70 { 255.0 } else { 0.0 },
                ),
            );
            for smoothing in [
                Smoothing::Gaussian(6.0),
                Smoothing::Gaussian(18.3),
                Smoothing::Gaussian(75.0),
                Smoothing::Gaussian(400.0),
                Smoothing::Binomial(72),
                Smoothing::Binomial(650),
                Smoothing::Binomial(5000),
            ] {
                let wide = Wide::new(smoothing);
                for image in [&noise, &edge] {
                    let by_wide = along_y(&wide, &along_x(&wide, image));
                    let error = largest_difference(&by_wide, &smoothing.apply(image)) / 255.0;
                    assert!(error < 1e-6, "{height} × {width}, {smoothing:?}: {error:e}");
                }
            }
        }
    }

    #[test]
    fn no_wave_is_off_by_more_than_the_stated_share() {
        // as long as the mirrored line is periodic in, so that every wave of the line is met
        let n = 240;
        let smoothing = Smoothing::Gaussian(18.3);
        let wide = Wide::new(smoothing);
        for half_waves in 0..n {
            let wave = |y: usize| (PI * half_waves as f64 * (y as f64 + 0.5) / n as f64).cos();
            let image = Grid::from_shape_fn((n, 1), |(y, _)| wave(y));
            let direct = wanted(smoothing, PI * half_waves as f64 / n as f64);
            let error = largest_difference(&along_y(&wide, &image), &(&image * direct));
            assert!(error < 1e-6, "{half_waves} half waves: {error:e}");
        }
    }

    #[test]
    fn a_constant_picture_stays_itself_to_the_last_bit() {
        let image = Grid::from_elem((70, 50), f64::from(0.1_f32));
        let wide = Wide::new(Smoothing::Gaussian(33.0));
        let smoothed = along_y(&wide, &along_x(&wide, &image));
        assert!(smoothed == image);
    }
}
