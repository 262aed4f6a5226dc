//! Grids of numbers at pixel centers, and the door every image passes through.

use crate::error::FieldError;
use ndarray::Array2;

/// One number at each pixel center, indexed `[[row, column]]` = `[[y, x]]`.
///
/// x runs to the right, y down, and the first pixel center is at (0, 0).
pub type Grid = Array2<f64>;

/// The largest magnitude a pixel may have: its gradient can still be squared and summed.
pub const LARGEST_PIXEL: f64 = 1e140;

/// The most binomial passes accepted: σ ≈ 70 px. A Gaussian says the same for less.
pub const MOST_PASSES: u32 = 10_000;

/// The widest Gaussian accepted, in pixels.
pub const LARGEST_SIGMA: f64 = 10_000.0;

/// Checks an image on its way in and copies it, times `scale`, into row-major memory.
///
/// Refuses an image without pixels, one with a pixel that is not finite (the first in reading order is named),
/// and one with a pixel beyond [`LARGEST_PIXEL`].
pub(crate) fn admit(image: &Grid, scale: f64) -> Result<Grid, FieldError> {
    let (height, width) = image.dim();
    if height == 0 || width == 0 {
        return Err(FieldError::Empty { width, height });
    }
    for ((row, column), &value) in image.indexed_iter() {
        if !value.is_finite() {
            return Err(FieldError::NotFinite { column, row, value });
        }
        if (value * scale).abs() > LARGEST_PIXEL {
            let most = LARGEST_PIXEL / scale;
            return Err(FieldError::TooLarge {
                column,
                row,
                value,
                most,
            });
        }
    }
    Ok(Grid::from_shape_fn((height, width), |at| scale * image[at]))
}

/// Refuses a number of passes beyond [`MOST_PASSES`].
pub(crate) fn reasonable_passes(passes: u32) -> Result<(), FieldError> {
    if passes <= MOST_PASSES {
        Ok(())
    } else {
        let (value, most) = (f64::from(passes), f64::from(MOST_PASSES));
        Err(FieldError::TooMuch {
            name: "passes",
            value,
            most,
        })
    }
}

/// Index into a line of `n` that goes on as its own mirror image at both ends, for any `i`.
///
/// Half-sample mirror: … 1 0 | 0 1 … n−1 | n−1 n−2 …, the report's `S(0) = S(1)`.
pub(crate) fn mirrored(i: isize, n: usize) -> usize {
    let n = n.cast_signed();
    let m = i.rem_euclid(2 * n);
    (if m < n { m } else { 2 * n - 1 - m }).unsigned_abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mirrored_line_repeats_its_end_samples() {
        let seen: Vec<usize> = (-4..8).map(|i| mirrored(i, 3)).collect();
        assert_eq!(seen, [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0, 1]);
        assert_eq!(mirrored(-17, 1), 0);
    }
}
