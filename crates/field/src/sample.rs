//! Forces between pixel centers, and how fast they change there.
//!
//! Along each axis a point sees two (bilinear) or four (bicubic) pixels, each with a weight for the value and one
//! for the slope; the weights of the two axes multiply. A coordinate beyond the outermost pixel centers is moved
//! there, and has slope 0.

mod group;
mod many;
mod weights;

use glam::{DMat2, DVec2};
pub(crate) use many::{Flat, sample_flat, sample_flat_with_slope};
use weights::{Axis, Four, Run, Two, bicubic, bicubic_slope, bilinear, bilinear_slope};

/// How a field is continued between pixel centers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// From the four pixels around: continuous, exact for affine fields, never beyond the pixels' range.
    Bilinear,
    /// From sixteen pixels, by cubic convolution with a = −½: its slope is continuous too, and it is exact for
    /// affine fields (for quadratic ones two pixels off the border). Overshoots at sharp turns.
    ///
    /// \[keys81\]
    Bicubic,
}

/// A force as its two components in `f64`.
pub(crate) type Pair = [f64; 2];

/// The first pixel of a coordinate's cell on a line of `n`, the place in it, and whether it had to be moved there.
///
/// NaN is cell 0 with a place that is NaN.
#[inline]
pub(crate) fn cell(x: f64, n: usize) -> (usize, f64, bool) {
    let axis = Axis::new(x, n);
    (axis.index[0], axis.t, axis.slide < 0.5)
}

/// The force at a point of a field of `(rows, columns)` forces.
#[inline]
pub(crate) fn value(
    force: impl Fn(usize, usize) -> Pair,
    (height, width): (usize, usize),
    p: DVec2,
    rule: Interpolation,
) -> DVec2 {
    let (x, y) = (Axis::new(p.x, width), Axis::new(p.y, height));
    let value = match rule {
        Interpolation::Bilinear => bilinear(corners(force, x, y), x.t, y.t),
        Interpolation::Bicubic => {
            let (x, y) = (Four::new(x, width), Four::new(y, height));
            bicubic(
                pulp::Scalar,
                sixteen(force, x.index, y.index),
                [x.value, y.value],
            )
        }
    };
    DVec2::from_array(value)
}

/// The force at a point and its slope: the columns are ∂F/∂x and ∂F/∂y.
#[inline]
pub(crate) fn value_and_slope(
    force: impl Fn(usize, usize) -> Pair,
    (height, width): (usize, usize),
    p: DVec2,
    rule: Interpolation,
) -> (DVec2, DMat2) {
    let (x, y) = (Axis::new(p.x, width), Axis::new(p.y, height));
    let (value, slope) = match rule {
        Interpolation::Bilinear => {
            bilinear_slope(corners(force, x, y), [x.t, y.t], [x.slide, y.slide])
        }
        Interpolation::Bicubic => {
            let (x, y) = (Four::new(x, width), Four::new(y, height));
            let forces = sixteen(force, x.index, y.index);
            bicubic_slope(pulp::Scalar, forces, [x.value, y.value], [x.slope, y.slope])
        }
    };
    (DVec2::from_array(value), DMat2::from_cols_array(&slope))
}

/// The four forces around a point, row by row.
#[inline(always)]
fn corners(force: impl Fn(usize, usize) -> Pair, x: Axis, y: Axis) -> [Two; 2] {
    y.index.map(|row| {
        let [left, right] = x.index.map(|column| force(row, column));
        [left[0], left[1], right[0], right[1]]
    })
}

/// The sixteen forces around a point, row by row.
#[inline(always)]
fn sixteen(force: impl Fn(usize, usize) -> Pair, x: [usize; 4], y: [usize; 4]) -> [Run; 4] {
    y.map(|row| {
        let [a, b, c, d] = x.map(|column| force(row, column));
        [a[0], a[1], b[0], b[1], c[0], c[1], d[0], d[1]]
    })
}

#[cfg(test)]
mod tests;
