//! What each pixel around a point counts, and the sums; the same operations for one point and for many.

use super::Pair;
use pulp::Simd;

/// Where a coordinate lies along its axis.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axis {
    /// The pixels on both sides; the same one twice if there is only one.
    pub(super) index: [usize; 2],
    /// From the first of them to the second, 0 … 1; NaN for a NaN coordinate.
    pub(super) t: f64,
    /// 1, or 0 where the coordinate was moved onto the field.
    pub(super) slide: f64,
}

impl Axis {
    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number from 0 to n − 2"
    )]
    pub(super) fn new(x: f64, n: usize) -> Self {
        let (first, t, slide) = cell(x, (n - 1) as f64, n.saturating_sub(2) as f64);
        let first = first as usize;
        Self {
            index: [first, (first + 1).min(n - 1)],
            t,
            slide,
        }
    }
}

/// 2⁵²: the sum of it and a whole number below it has that number in its last bits.
pub(super) const WHOLE: f64 = 4_503_599_627_370_496.0;

/// The first pixel of a coordinate's cell, the place in the cell, and whether the coordinate could stay (1 or 0).
///
/// `last` is the last pixel, `most` the last that begins a cell. In floating point throughout, so that the
/// compiler can do several at once: adding 2⁵² and taking it away rounds to a whole number.
#[inline(always)]
pub(super) fn cell(x: f64, last: f64, most: f64) -> (f64, f64, f64) {
    let inside = x.clamp(0.0, last);
    // NaN is cell 0; its place stays NaN and carries it into the force
    let number = if inside >= 0.0 { inside } else { 0.0 };
    let rounded = (number + WHOLE) - WHOLE;
    let floor = if rounded > number {
        rounded - 1.0
    } else {
        rounded
    };
    let first = if floor > most { most } else { floor };
    let slide = if (x < 0.0) | (x > last) { 0.0 } else { 1.0 };
    (first, inside - first, slide)
}

/// Four pixels of a line with their weights.
#[derive(Debug, Clone, Copy)]
pub(super) struct Four {
    pub(super) index: [usize; 4],
    pub(super) value: [f64; 4],
    pub(super) slope: [f64; 4],
}

impl Four {
    /// Four pixels around a coordinate of a line of `n`, whichever of them there are.
    #[inline]
    pub(super) fn new(axis: Axis, n: usize) -> Self {
        let first = axis.index[0];
        let index = [
            first.saturating_sub(1),
            first,
            axis.index[1],
            (first + 2).min(n - 1),
        ];
        let mut four = Self {
            index,
            value: cubic(axis.t),
            slope: cubic_slope(axis.t, axis.slide),
        };
        // beyond the border the line goes on straight: f[−1] = 2 f[0] − f[1]
        if first == 0 {
            four.fold(0, 1, 2);
        }
        if first + 2 > n - 1 {
            four.fold(3, 2, 1);
        }
        four
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

/// Weights of cubic convolution, a = −½.
#[inline(always)]
pub(super) fn cubic(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [
        -0.5 * t * s * s,
        1.0 + t * t * (1.5 * t - 2.5),
        1.0 + s * s * (1.5 * s - 2.5),
        -0.5 * s * t * t,
    ]
}

/// Their derivatives, times `slide`.
#[inline(always)]
pub(super) fn cubic_slope(t: f64, slide: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [
        slide * (s * t - 0.5 * s * s),
        slide * t * (4.5 * t - 5.0),
        slide * -s * (4.5 * s - 5.0),
        slide * (0.5 * t * t - s * t),
    ]
}

/// Two forces of one row: x, y of the left one, x, y of the right one.
pub(super) type Two = [f64; 4];

/// Four forces of one row.
pub(super) type Run = [f64; 8];

/// Between the two forces of a row.
#[inline(always)]
fn between(row: Two, w: Two) -> Pair {
    let mut part = [0.0; 4];
    for l in 0..4 {
        part[l] = row[l] * w[l];
    }
    [part[0] + part[2], part[1] + part[3]]
}

/// Between four forces.
///
/// ```text
/// above = f[0] (1 − tx) + f[1] tx,  below = f[2] (1 − tx) + f[3] tx,  F = above (1 − ty) + below ty
/// ```
#[inline(always)]
pub(super) fn bilinear([above, below]: [Two; 2], tx: f64, ty: f64) -> Pair {
    let (sx, sy) = (1.0 - tx, 1.0 - ty);
    let w = [sx, sx, tx, tx];
    let (above, below) = (between(above, w), between(below, w));
    [above[0] * sy + below[0] * ty, above[1] * sy + below[1] * ty]
}

/// [`bilinear`] and its slope: ∂F/∂x, then ∂F/∂y.
#[inline(always)]
pub(super) fn bilinear_slope(
    [above, below]: [Two; 2],
    [tx, ty]: [f64; 2],
    [slide_x, slide_y]: [f64; 2],
) -> (Pair, [f64; 4]) {
    let (sx, sy) = (1.0 - tx, 1.0 - ty);
    let w = [sx, sx, tx, tx];
    let across = |row: Two| [row[2] - row[0], row[3] - row[1]];
    let (slope_above, slope_below) = (across(above), across(below));
    let (above, below) = (between(above, w), between(below, w));
    (
        [above[0] * sy + below[0] * ty, above[1] * sy + below[1] * ty],
        [
            (slope_above[0] * sy + slope_below[0] * ty) * slide_x,
            (slope_above[1] * sy + slope_below[1] * ty) * slide_x,
            (below[0] - above[0]) * slide_y,
            (below[1] - above[1]) * slide_y,
        ],
    )
}

/// Four rows of four forces, weighed down the columns.
#[inline(always)]
fn down<S: Simd>(simd: S, rows: &[Run; 4], w: [f64; 4]) -> Run {
    let mut sums = [0.0; 8];
    let [a, b, c, d] = rows.each_ref().map(|row| S::as_simd_f64s(row).0);
    let w = w.map(|w| simd.splat_f64s(w));
    for (l, sum) in S::as_mut_simd_f64s(&mut sums).0.iter_mut().enumerate() {
        let first = simd.add_f64s(simd.mul_f64s(a[l], w[0]), simd.mul_f64s(b[l], w[1]));
        let second = simd.add_f64s(simd.mul_f64s(c[l], w[2]), simd.mul_f64s(d[l], w[3]));
        *sum = simd.add_f64s(first, second);
    }
    sums
}

/// The columns weighed: (0 and 2) and (1 and 3).
#[inline(always)]
fn along(columns: Run, w: [f64; 4]) -> Pair {
    let mut half = [0.0; 4];
    for l in 0..4 {
        half[l] = columns[l] * w[l / 2] + columns[l + 4] * w[2 + l / 2];
    }
    [half[0] + half[2], half[1] + half[3]]
}

/// Between sixteen forces: down the columns first, then along the row of four sums.
#[inline(always)]
pub(super) fn bicubic<S: Simd>(simd: S, rows: [Run; 4], [wx, wy]: [[f64; 4]; 2]) -> Pair {
    along(down(simd, &rows, wy), wx)
}

/// [`bicubic`] and its slope: ∂F/∂x, then ∂F/∂y.
#[inline(always)]
pub(super) fn bicubic_slope<S: Simd>(
    simd: S,
    rows: [Run; 4],
    [wx, wy]: [[f64; 4]; 2],
    [slope_x, slope_y]: [[f64; 4]; 2],
) -> (Pair, [f64; 4]) {
    let columns = down(simd, &rows, wy);
    let x = along(columns, slope_x);
    let y = along(down(simd, &rows, slope_y), wx);
    (along(columns, wx), [x[0], x[1], y[0], y[1]])
}
