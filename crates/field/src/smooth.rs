//! Smoothing: binomial passes as in the report, and the Gaussian they stand for.
//!
//! One pass of the mask [¼ ½ ¼] has variance ½ px², so `passes` of them come close to a Gaussian of
//! σ = √(passes/2). At the border the line goes on as its own mirror image, `S(0) = S(1)`, which keeps the sum.
//! Every function here smooths one axis; both axes are one after the other, in either order.

pub(crate) mod wide;

use crate::error::{FieldError, positive};
use crate::grid::{Grid, LARGEST_SIGMA, mirrored, reasonable_passes};

/// Passes of the report's program: σ = √10 ≈ 3.16 px.
pub const REPORT_PASSES: u32 = 20;

/// How strongly an image is smoothed before it is differentiated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Smoothing {
    /// So many passes of the mask [¼ ½ ¼] along each axis; the report takes [`REPORT_PASSES`].
    Binomial(u32),
    /// A sampled Gaussian of this σ in pixels, cut where its weights fall below the last bit of an `f64`.
    Gaussian(f64),
}

impl Smoothing {
    /// σ in pixels: `√(passes/2)` for binomial passes (D36).
    #[must_use]
    pub fn sigma(self) -> f64 {
        match self {
            Self::Binomial(passes) => (f64::from(passes) / 2.0).sqrt(),
            Self::Gaussian(sigma) => sigma,
        }
    }

    /// Refuses a σ that is not above 0 or beyond reason, and an absurd number of passes.
    ///
    /// # Errors
    /// [`FieldError::NotPositive`] and [`FieldError::TooMuch`].
    pub fn validate(self) -> Result<(), FieldError> {
        match self {
            Self::Binomial(passes) => reasonable_passes(passes),
            Self::Gaussian(sigma) => {
                positive("sigma", sigma)?;
                let most = LARGEST_SIGMA;
                if sigma > most {
                    return Err(FieldError::TooMuch {
                        name: "sigma",
                        value: sigma,
                        most,
                    });
                }
                Ok(())
            }
        }
    }

    /// Smooths along both axes, x first. The order does not matter beyond rounding.
    pub(crate) fn apply(self, image: &Grid) -> Grid {
        match self {
            Self::Binomial(passes) => binomial_y(&binomial_x(image, passes), passes),
            Self::Gaussian(sigma) => {
                let weights = gaussian_weights(sigma);
                convolve_y(&convolve_x(image, &weights), &weights)
            }
        }
    }
}

/// Smooths every row: `passes` times the mask [¼ ½ ¼] along x, mirrored at both ends.
///
/// ```
/// use field::binomial_x;
/// let spike = ndarray::array![[0.0, 4.0, 0.0]];
/// assert_eq!(binomial_x(&spike, 1), ndarray::array![[1.0, 2.0, 1.0]]);
/// ```
///
/// Exact in `f64` for 8-bit pixels and up to 22 passes. O(pixels · passes). Report §4.2.1.
#[must_use]
pub fn binomial_x(image: &Grid, passes: u32) -> Grid {
    let mut out = row_major(image);
    for mut row in out.rows_mut() {
        if let Some(line) = row.as_slice_mut() {
            for _ in 0..passes {
                binomial_pass(line);
            }
        }
    }
    out
}

/// Smooths every column: `passes` times the mask [¼ ½ ¼] along y, mirrored at both ends.
///
/// The transpose of [`binomial_x`], to the bit.
#[must_use]
pub fn binomial_y(image: &Grid, passes: u32) -> Grid {
    let mut out = row_major(image);
    let (height, width) = out.dim();
    let Some(pixels) = out.as_slice_mut() else {
        return out;
    };
    let mut above = vec![0.0; width];
    for _ in 0..passes {
        above.copy_from_slice(&pixels[..width]);
        for y in 0..height {
            let (head, tail) = pixels.split_at_mut((y + 1) * width);
            let row = &mut head[y * width..];
            if y + 1 < height {
                for ((a, c), &b) in above.iter_mut().zip(row).zip(&tail[..width]) {
                    let here = *c;
                    *c = 0.25 * *a + 0.5 * here + 0.25 * b;
                    *a = here;
                }
            } else {
                for (a, c) in above.iter_mut().zip(row) {
                    let here = *c;
                    *c = 0.25 * *a + 0.5 * here + 0.25 * here;
                }
            }
        }
    }
    out
}

/// One pass of [¼ ½ ¼] over a line, in place.
pub(crate) fn binomial_pass(line: &mut [f64]) {
    let Some(&first) = line.first() else { return };
    let mut left = first;
    for i in 0..line.len() {
        let here = line[i];
        let right = line.get(i + 1).copied().unwrap_or(here);
        line[i] = 0.25 * left + 0.5 * here + 0.25 * right;
        left = here;
    }
}

/// Weights of a sampled one-dimensional Gaussian, center first: `w[0]`, `w[1]` = w(±1), ….
///
/// ```text
/// w(k) = e^(−k²/2σ²) / Σ_j e^(−j²/2σ²)
/// ```
///
/// They sum to 1 over both sides. The normalisation is that of one dimension; the report prints the
/// two-dimensional 1/(2πσ²) for its one-dimensional signal (D35). Cut at |k| ≤ 8.6 σ + 1, where a weight is
/// below 1e-16 of the first.
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "σ was checked: 0 < σ ≤ 1e4"
)]
pub fn gaussian_weights(sigma: f64) -> Vec<f64> {
    let radius = (8.6 * sigma).ceil() as usize + 1;
    let mut weights: Vec<f64> = (0..=radius)
        .map(|k| {
            let z = k as f64 / sigma;
            (-0.5 * z * z).exp()
        })
        .collect();
    let sum = weights[0] + 2.0 * weights[1..].iter().rev().sum::<f64>();
    for w in &mut weights {
        *w /= sum;
    }
    weights
}

/// Convolves a line with symmetric weights (center first), mirrored at both ends.
pub(crate) fn convolve_line(line: &[f64], weights: &[f64], out: &mut [f64]) {
    let n = line.len();
    for (i, value) in out.iter_mut().enumerate() {
        let i = i.cast_signed();
        let mut sum = 0.0;
        for (k, &w) in weights.iter().enumerate().skip(1).rev() {
            let k = k.cast_signed();
            sum += w * (line[mirrored(i - k, n)] + line[mirrored(i + k, n)]);
        }
        *value = sum + weights[0] * line[i.unsigned_abs()];
    }
}

fn convolve_x(image: &Grid, weights: &[f64]) -> Grid {
    let mut out = row_major(image);
    let mut line = vec![0.0; out.ncols()];
    for mut row in out.rows_mut() {
        if let Some(row) = row.as_slice_mut() {
            line.copy_from_slice(row);
            convolve_line(&line, weights, row);
        }
    }
    out
}

fn convolve_y(image: &Grid, weights: &[f64]) -> Grid {
    let (height, width) = image.dim();
    let mut out = Grid::zeros((height, width));
    for y in 0..height {
        let mut row = out.row_mut(y);
        let i = y.cast_signed();
        for (k, &w) in weights.iter().enumerate().skip(1).rev() {
            let k = k.cast_signed();
            let above = image.row(mirrored(i - k, height));
            let below = image.row(mirrored(i + k, height));
            ndarray::Zip::from(&mut row)
                .and(above)
                .and(below)
                .for_each(|s, &a, &b| *s += w * (a + b));
        }
        ndarray::Zip::from(&mut row)
            .and(image.row(y))
            .for_each(|s, &c| *s += weights[0] * c);
    }
    out
}

/// A copy in row-major order, whatever the order of the original.
pub(crate) fn row_major(image: &Grid) -> Grid {
    image.as_standard_layout().into_owned()
}
