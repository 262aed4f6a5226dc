//! The slow obvious twin: the report's Appendix A line by line, `conv2` and all.
//!
//! Kept to check [`report_force`](crate::report_force) and to be timed beside it; see there for the formulas.

use crate::error::FieldError;
use crate::force_field::ForceField;
use crate::grid::{Grid, admit};
use ndarray::{Array2, ArrayView2, Axis, concatenate, s};

/// Full two-dimensional convolution, zeros beyond the border: `conv2(image, mask)`.
///
/// ```text
/// out[r, c] = Σ mask[i, j] · image[r − i, c − j]
/// ```
///
/// The result is larger than the image by the mask less one in each direction. O(pixels · mask).
#[must_use]
pub fn conv2(image: &Grid, mask: &Grid) -> Grid {
    let ((h, w), (mh, mw)) = (image.dim(), mask.dim());
    let mut out = Array2::zeros((h + mh - 1, w + mw - 1));
    for ((i, j), &weight) in mask.indexed_iter() {
        for ((y, x), &value) in image.indexed_iter() {
            out[[y + i, x + j]] += weight * value;
        }
    }
    out
}

/// The masks of Appendix A: `ax`, `ay`, `bx`, `by`.
#[must_use]
pub fn masks() -> [Grid; 4] {
    let ax = ndarray::array![[0.0, 0.0, 0.0], [0.25, 0.5, 0.25], [0.0, 0.0, 0.0]];
    let bx = ndarray::array![[0.25, 0.0, -0.25], [0.5, 0.0, -0.5], [0.25, 0.0, -0.25]];
    let (ay, by) = (ax.t().to_owned(), bx.t().to_owned());
    [ax, ay, bx, by]
}

/// `image` with its first and last column repeated.
fn mirror_columns(image: &Grid) -> Grid {
    mirror(image.view(), Axis(1))
}

/// `image` with its first and last row repeated.
fn mirror_rows(image: &Grid) -> Grid {
    mirror(image.view(), Axis(0))
}

fn mirror(image: ArrayView2<'_, f64>, axis: Axis) -> Grid {
    let last = image.len_of(axis) - 1;
    let first = image.slice_axis(axis, (0..1).into());
    let end = image.slice_axis(axis, (last..=last).into());
    // shapes agree by construction
    concatenate(axis, &[first, image, end]).unwrap_or_default()
}

/// `x(2:ny+1, 3:nx+2)` of a column-mirrored image convolved with a 3×3 mask.
fn crop_x(full: &Grid) -> Grid {
    let (h, w) = full.dim();
    full.slice(s![1..h - 1, 2..w - 2]).to_owned()
}

/// `x(3:ny+2, 2:nx+1)` of a row-mirrored image convolved with a 3×3 mask.
fn crop_y(full: &Grid) -> Grid {
    let (h, w) = full.dim();
    full.slice(s![2..h - 2, 1..w - 1]).to_owned()
}

/// [`report_force`](crate::report_force), as the appendix is written: `ov0` is `scale` times the image.
///
/// O(pixels · passes · 18), and it allocates at every line, as the program does.
///
/// # Errors
/// An image that is empty or has a pixel that is not finite or too large.
pub fn report_force(
    image: &Grid,
    passes: u32,
    scale: f64,
    gain: f64,
) -> Result<ForceField, FieldError> {
    let [ax, ay, bx, by] = masks();
    let mut imax = admit(image, scale)?;
    let mut imay = imax.clone();
    for _ in 0..passes {
        imax = crop_x(&conv2(&mirror_columns(&imax), &ax));
        imay = crop_y(&conv2(&mirror_rows(&imay), &ay));
    }
    let forcex = crop_x(&conv2(&mirror_columns(&imax), &bx).mapv(f64::abs));
    let forcex = crop_x(&conv2(&mirror_columns(&forcex), &bx)) * gain;
    let forcey = crop_y(&conv2(&mirror_rows(&imay), &by).mapv(f64::abs));
    let forcey = crop_y(&conv2(&mirror_rows(&forcey), &by)) * gain;
    ForceField::from_components(&forcex, &forcey)
}
