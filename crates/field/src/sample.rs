//! Forces between pixel centers, and how fast they change there.
//!
//! Along each axis a point sees two (bilinear) or four (bicubic) pixels, each with a weight for the value and one
//! for the slope; the weights of the two axes multiply. A coordinate beyond the outermost pixel centers is moved
//! there, and has slope 0.

use glam::{DMat2, DVec2};

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

/// Four pixels of a line with their weights; unused ones have weight 0.
#[derive(Debug, Clone, Copy)]
struct Stencil {
    index: [usize; 4],
    value: [f64; 4],
    slope: [f64; 4],
}

/// The cell of a coordinate clamped to `0 … n−1`, the place in it, and whether it had to be moved.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to 0 … n−1 before"
)]
#[inline]
pub(crate) fn cell(x: f64, n: usize) -> (usize, f64, bool) {
    let last = n - 1;
    let inside = x.clamp(0.0, last as f64);
    // NaN stays NaN and is cell 0: the weight carries it into the force
    let first = (inside as usize).min(last.saturating_sub(1));
    (first, inside - first as f64, x < 0.0 || x > last as f64)
}

impl Stencil {
    #[inline]
    fn new(x: f64, n: usize, rule: Interpolation) -> Self {
        let (first, t, moved) = cell(x, n);
        if n == 1 {
            // a NaN coordinate still gives a NaN force
            return Self {
                index: [0; 4],
                value: [1.0 + 0.0 * t, 0.0, 0.0, 0.0],
                slope: [0.0; 4],
            };
        }
        let slide = if moved { 0.0 } else { 1.0 };
        let (value, slope) = match rule {
            Interpolation::Bilinear => ([0.0, 1.0 - t, t, 0.0], [0.0, -slide, slide, 0.0]),
            Interpolation::Bicubic => {
                let s = 1.0 - t;
                (
                    [
                        -0.5 * t * s * s,
                        1.0 + t * t * (1.5 * t - 2.5),
                        1.0 + s * s * (1.5 * s - 2.5),
                        -0.5 * s * t * t,
                    ],
                    [
                        slide * (s * t - 0.5 * s * s),
                        slide * t * (4.5 * t - 5.0),
                        slide * -s * (4.5 * s - 5.0),
                        slide * (0.5 * t * t - s * t),
                    ],
                )
            }
        };
        let index = [
            first.saturating_sub(1),
            first,
            first + 1,
            (first + 2).min(n - 1),
        ];
        let mut stencil = Self {
            index,
            value,
            slope,
        };
        // beyond the border the line goes on straight: f[−1] = 2 f[0] − f[1]
        if first == 0 {
            stencil.fold(0, 1, 2);
        }
        if first + 2 > n - 1 {
            stencil.fold(3, 2, 1);
        }
        stencil
    }

    /// Gives the weight of a missing pixel to the two nearest ones.
    #[inline]
    fn fold(&mut self, missing: usize, near: usize, next: usize) {
        for weights in [&mut self.value, &mut self.slope] {
            let w = std::mem::replace(&mut weights[missing], 0.0);
            weights[near] += 2.0 * w;
            weights[next] -= w;
        }
    }
}

/// [`value`] by the bilinear rule for rows that stand one after another, two pixels or more each way.
///
/// The same operations in the same order, so the same digits.
#[inline]
pub(crate) fn bilinear_flat(forces: &[DVec2], (height, width): (usize, usize), p: DVec2) -> DVec2 {
    let ((x, tx, _), (y, ty, _)) = (cell(p.x, width), cell(p.y, height));
    let here = y * width + x;
    let above = &forces[here..here + 2];
    let below = &forces[here + width..here + width + 2];
    let above = above[0] * (1.0 - tx) + above[1] * tx;
    let below = below[0] * (1.0 - tx) + below[1] * tx;
    above * (1.0 - ty) + below * ty
}

/// The force at a point of a field of `(rows, columns)` forces.
#[inline]
pub(crate) fn value(
    force: impl Fn(usize, usize) -> DVec2,
    (height, width): (usize, usize),
    p: DVec2,
    rule: Interpolation,
) -> DVec2 {
    if rule == Interpolation::Bilinear {
        let ((x, tx, _), (y, ty, _)) = (cell(p.x, width), cell(p.y, height));
        let (right, down) = ((x + 1).min(width - 1), (y + 1).min(height - 1));
        let above = force(y, x) * (1.0 - tx) + force(y, right) * tx;
        let below = force(down, x) * (1.0 - tx) + force(down, right) * tx;
        return above * (1.0 - ty) + below * ty;
    }
    let (x, y) = (
        Stencil::new(p.x, width, rule),
        Stencil::new(p.y, height, rule),
    );
    let row = |j: usize| {
        (0..4)
            .map(|i| force(y.index[j], x.index[i]) * x.value[i])
            .sum::<DVec2>()
    };
    (0..4).map(|j| row(j) * y.value[j]).sum()
}

/// The force at a point and its slope: the columns are ∂F/∂x and ∂F/∂y.
#[inline]
pub(crate) fn value_and_slope(
    force: impl Fn(usize, usize) -> DVec2,
    (height, width): (usize, usize),
    p: DVec2,
    rule: Interpolation,
) -> (DVec2, DMat2) {
    let (x, y) = (
        Stencil::new(p.x, width, rule),
        Stencil::new(p.y, height, rule),
    );
    let used = if rule == Interpolation::Bilinear && width > 1 && height > 1 {
        1..3
    } else {
        0..4
    };
    let (mut value, mut slope) = (DVec2::ZERO, DMat2::ZERO);
    for j in used.clone() {
        let (mut row, mut row_slope) = (DVec2::ZERO, DVec2::ZERO);
        for i in used.clone() {
            let force = force(y.index[j], x.index[i]);
            row += force * x.value[i];
            row_slope += force * x.slope[i];
        }
        value += row * y.value[j];
        slope.x_axis += row_slope * y.value[j];
        slope.y_axis += row * y.slope[j];
    }
    (value, slope)
}

#[cfg(test)]
mod tests;
