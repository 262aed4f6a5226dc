//! The report's 3×3 masks: a difference along one axis, an average across it.
//!
//! As convolution masks (D41; used as correlation masks all forces turn round and edges repel):
//!
//! ```text
//!        ⎡¼ 0 −¼⎤         ⎡ ¼  ½  ¼⎤
//!   bx = ⎢½ 0 −½⎥    by = ⎢ 0  0  0⎥ = bxᵀ
//!        ⎣¼ 0 −¼⎦         ⎣−¼ −½ −¼⎦
//! ```
//!
//! bx gives the average over three rows of `I(x+1) − I(x−1)`: twice the derivative (D40).
//! Along its own axis the image is mirrored; across it, [`Across`] says.

use crate::grid::Grid;

/// What lies beyond the image across the direction of a derivative.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Across {
    /// Zeros, as `conv2` pads them in the report's program: the outermost rows come out weaker (D43).
    Zero,
    /// The image's own mirror image.
    Mirror,
}

/// Twice the derivative along x, by the report's mask bx: right minus left, averaged over three rows.
///
/// ```
/// use field::{Across, mask_x};
/// let ramp = ndarray::array![[0.0, 1.0, 2.0], [0.0, 1.0, 2.0], [0.0, 1.0, 2.0]];
/// assert_eq!(mask_x(&ramp, Across::Mirror).row(0).to_vec(), [1.0, 2.0, 1.0]);
/// assert_eq!(mask_x(&ramp, Across::Zero).row(0).to_vec(), [0.75, 1.5, 0.75]);
/// ```
///
/// Report §4.2.2.
#[must_use]
pub fn mask_x(image: &Grid, across: Across) -> Grid {
    let (height, width) = image.dim();
    let difference = Grid::from_shape_fn((height, width), |(y, x)| {
        image[[y, (x + 1).min(width - 1)]] - image[[y, x.saturating_sub(1)]]
    });
    Grid::from_shape_fn((height, width), |(y, x)| {
        let (above, below) = neighbours(y, height, across, |y| difference[[y, x]]);
        0.25 * above + 0.5 * difference[[y, x]] + 0.25 * below
    })
}

/// Twice the derivative along y, by the report's mask by: below minus above, averaged over three columns.
///
/// The mask by is bx turned clockwise, that is transposed; turned the other way its sign is wrong (D42).
/// Report §4.2.2.
#[must_use]
pub fn mask_y(image: &Grid, across: Across) -> Grid {
    let (height, width) = image.dim();
    let difference = Grid::from_shape_fn((height, width), |(y, x)| {
        image[[(y + 1).min(height - 1), x]] - image[[y.saturating_sub(1), x]]
    });
    Grid::from_shape_fn((height, width), |(y, x)| {
        let (left, right) = neighbours(x, width, across, |x| difference[[y, x]]);
        0.25 * left + 0.5 * difference[[y, x]] + 0.25 * right
    })
}

/// The values before and after position `i` of `n`, with what `across` puts beyond the ends.
fn neighbours(i: usize, n: usize, across: Across, value: impl Fn(usize) -> f64) -> (f64, f64) {
    let beyond = || match across {
        Across::Zero => 0.0,
        Across::Mirror => value(i),
    };
    let before = if i > 0 { value(i - 1) } else { beyond() };
    let after = if i + 1 < n { value(i + 1) } else { beyond() };
    (before, after)
}
