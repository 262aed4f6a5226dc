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
//! is no such wave. Beyond the border the lines are the image's mirror, as everywhere here.

use super::Smoothing;
use crate::grid::{Grid, mirrored};
use std::f64::consts::PI;

/// Reach of the window in units of its σ: what is cut off is 2e-8 of its middle, and h makes up for it.
const REACH: usize = 6;

/// Reach of h in thin lines; it falls off as a Gaussian of at most 2 lines.
const THIN_REACH: usize = 16;

/// Columns worked on at once: the sums stay in the first cache.
const COLUMNS: usize = 512;

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

    /// Smooths every column.
    ///
    /// About 25 multiplications a pixel, whatever σ; memory is two grids and the thin lines.
    pub(crate) fn along_y(&self, image: &Grid) -> Grid {
        let (height, width) = image.dim();
        let Some(&level) = image.first() else {
            return image.clone();
        };
        // about the first pixel: a constant picture stays one to the last bit
        let pixels: Vec<f64> = image.iter().map(|v| v - level).collect();
        let reach = self.window.len() - 1;
        // thin lines that some line needs, and as many more as h reaches
        let after = REACH + (height - 1) / self.step + 1;
        let count = REACH + after + 1;
        let mut thin = vec![0.0; (count + 2 * THIN_REACH) * width];
        let mut weights = vec![0.0; height];
        for (j, line) in thin.chunks_exact_mut(width).enumerate() {
            let center =
                (j * self.step).cast_signed() - ((REACH + THIN_REACH) * self.step).cast_signed();
            weights.fill(0.0);
            for k in 0..=2 * reach {
                let row = mirrored(center + k.cast_signed() - reach.cast_signed(), height);
                weights[row] += self.window[k.abs_diff(reach)];
            }
            let terms: Vec<(f64, usize)> = (weights.iter().copied().zip(0..))
                .filter(|&(w, _)| w > 0.0)
                .collect();
            combine(&terms, &pixels, width, line);
        }
        let mut smooth = vec![0.0; count * width];
        for (j, line) in smooth.chunks_exact_mut(width).enumerate() {
            let terms: Vec<(f64, usize)> = (0..=2 * THIN_REACH)
                .map(|m| (self.thin[m.abs_diff(THIN_REACH)], j + m))
                .collect();
            combine(&terms, &thin, width, line);
        }
        let mut out = vec![0.0; height * width];
        for (i, line) in out.chunks_exact_mut(width).enumerate() {
            let mut terms: Vec<(f64, usize)> = (0..count)
                .skip(i / self.step)
                .take(2 * REACH + 2)
                .filter_map(|j| {
                    let distance = (i + REACH * self.step).abs_diff(j * self.step);
                    self.window.get(distance).map(|&w| (w, j))
                })
                .collect();
            let sum: f64 = terms.iter().map(|(w, _)| w).sum();
            terms.iter_mut().for_each(|(w, _)| *w /= sum);
            combine(&terms, &smooth, width, line);
            line.iter_mut().for_each(|v| *v += level);
        }
        Grid::from_shape_vec((height, width), out).unwrap_or_else(|_| image.clone())
    }

    /// Smooths every row.
    pub(crate) fn along_x(&self, image: &Grid) -> Grid {
        let turned = image.t().as_standard_layout().into_owned();
        self.along_y(&turned)
            .reversed_axes()
            .as_standard_layout()
            .into_owned()
    }
}

/// Transfer function of a smoothing at a frequency of `omega` per pixel.
fn wanted(smoothing: Smoothing, omega: f64) -> f64 {
    match smoothing {
        Smoothing::Binomial(passes) => (2.0 * f64::from(passes) * (0.5 * omega).cos().ln()).exp(),
        Smoothing::Gaussian(sigma) => (-0.5 * (sigma * omega) * (sigma * omega)).exp(),
    }
}

/// `out = Σ weight · row`, columns in blocks, four rows at a time.
fn combine(terms: &[(f64, usize)], rows: &[f64], width: usize, out: &mut [f64]) {
    out.fill(0.0);
    lanes::registers().dispatch(|| {
        for (block, out) in out.chunks_mut(COLUMNS).enumerate() {
            let n = out.len();
            let row = |i: usize| &rows[i * width + block * COLUMNS..][..n];
            let (fours, rest) = terms.as_chunks::<4>();
            for &[(wa, a), (wb, b), (wc, c), (wd, d)] in fours {
                let (a, b, c, d) = (row(a), row(b), row(c), row(d));
                for i in 0..n {
                    out[i] += (wa * a[i] + wb * b[i]) + (wc * c[i] + wd * d[i]);
                }
            }
            for &(w, a) in rest {
                for (sum, a) in out.iter_mut().zip(row(a)) {
                    *sum += w * a;
                }
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

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
                    let by_wide = wide.along_y(&wide.along_x(image));
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
            let error = largest_difference(&wide.along_y(&image), &(&image * direct));
            assert!(error < 1e-6, "{half_waves} half waves: {error:e}");
        }
    }

    #[test]
    fn a_constant_picture_stays_itself_to_the_last_bit() {
        let image = Grid::from_elem((70, 50), 0.1);
        let wide = Wide::new(Smoothing::Gaussian(33.0));
        let smoothed = wide.along_y(&wide.along_x(&image));
        assert!(smoothed == Grid::from_elem((70, 50), 0.1));
    }
}
