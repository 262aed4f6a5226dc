//! Many points at once.
//!
//! Points are taken in groups. First all cells of a group are found, several at once in wide registers and without
//! a branch; then each point looks at two (or four) short runs of forces. The sums are those for a single
//! point, operation by operation, so the digits are the same.

use super::group::{GROUP, Group, Place, Weights};
use super::weights::{
    Run, Two, WHOLE, bicubic, bicubic_slope, bilinear, bilinear_slope, cubic, cubic_slope,
};
use super::{Interpolation, Pair, value, value_and_slope};
use glam::{DMat2, DVec2};
use ndarray::Array2;
use pulp::{Simd, WithSimd};

/// A force as it is kept.
pub(crate) trait Kept: Copy {
    /// In `f64`.
    fn wide(self) -> Pair;
    /// Two of a row.
    fn two(row: &[Self; 2]) -> Two;
    /// Four of a row.
    fn four(row: &[Self; 4]) -> Run;
}

impl Kept for DVec2 {
    #[inline(always)]
    fn wide(self) -> Pair {
        self.to_array()
    }
    #[inline(always)]
    fn two([a, b]: &[Self; 2]) -> Two {
        [a.x, a.y, b.x, b.y]
    }
    #[inline(always)]
    fn four([a, b, c, d]: &[Self; 4]) -> Run {
        [a.x, a.y, b.x, b.y, c.x, c.y, d.x, d.y]
    }
}

impl Kept for [f32; 2] {
    #[inline(always)]
    fn wide(self) -> Pair {
        self.map(f64::from)
    }
    #[inline(always)]
    fn two(row: &[Self; 2]) -> Two {
        widened(row.as_flattened())
    }
    #[inline(always)]
    fn four(row: &[Self; 4]) -> Run {
        widened(row.as_flattened())
    }
}

/// Numbers side by side in memory are converted in one go.
#[inline(always)]
fn widened<const N: usize>(numbers: &[f32]) -> [f64; N] {
    let mut wide = [0.0; N];
    for l in 0..N {
        wide[l] = f64::from(numbers[l]);
    }
    wide
}

/// Rows of forces that stand one after another: a whole field, or a window of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Flat<'a, F> {
    forces: &'a [F],
    /// Rows and columns of the whole field.
    dim: (usize, usize),
    /// Row and column of the first force.
    first: (usize, usize),
    /// From one row to the next.
    stride: usize,
}

impl<'a, F: Kept> Flat<'a, F> {
    /// The forces of a grid whose rows stand one after another.
    pub(crate) fn new(forces: &'a Array2<F>) -> Option<Self> {
        let dim = forces.dim();
        let whole = |forces| Self::window(forces, dim, (0, 0), dim.1);
        forces.as_slice().map(whole)
    }

    /// Some rows and columns of a field of `dim`, from `first` on, `stride` in a row.
    ///
    /// Only points whose neighbourhoods lie in it may be asked for.
    pub(crate) const fn window(
        forces: &'a [F],
        dim: (usize, usize),
        first: (usize, usize),
        stride: usize,
    ) -> Self {
        Self {
            forces,
            dim,
            first,
            stride,
        }
    }

    /// Where its forces lie, for [`Group::find`].
    fn place(self) -> Place {
        let (height, width) = self.dim;
        let stride = self.stride as f64;
        let before = self.first.0 as f64 * stride + self.first.1 as f64;
        Place {
            last: [(width - 1) as f64, (height - 1) as f64],
            stride,
            whole: WHOLE - before,
        }
    }

    /// The force at a pixel center that lies in it.
    #[inline(always)]
    pub(crate) fn kept(self, row: usize, column: usize) -> F {
        self.forces[(row - self.first.0) * self.stride + column - self.first.1]
    }

    #[inline(always)]
    fn get(self, row: usize, column: usize) -> Pair {
        self.kept(row, column).wide()
    }
}

/// Forces of a flat field at points, as many of either.
struct Values<'a, F, const CUBIC: bool> {
    field: Flat<'a, F>,
    points: &'a [DVec2],
    forces: &'a mut [DVec2],
}

impl<F: Kept, const CUBIC: bool> WithSimd for Values<'_, F, CUBIC> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            field,
            points,
            forces,
        } = self;
        if CUBIC {
            bicubic_values(simd, field, points, forces);
        } else {
            bilinear_values(field, points, forces);
        }
    }
}

/// [`Values`] and slopes.
struct Slopes<'a, F, const CUBIC: bool> {
    field: Flat<'a, F>,
    points: &'a [DVec2],
    forces: &'a mut [DVec2],
    slopes: &'a mut [DMat2],
}

impl<F: Kept, const CUBIC: bool> WithSimd for Slopes<'_, F, CUBIC> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            field,
            points,
            forces,
            slopes,
        } = self;
        if CUBIC {
            bicubic_slopes(simd, field, points, forces, slopes);
        } else {
            bilinear_slopes(field, points, forces, slopes);
        }
    }
}

/// The forces of a flat field at many points: the shorter slice says how many.
pub(crate) fn sample_flat<F: Kept>(
    field: Flat<'_, F>,
    points: &[DVec2],
    rule: Interpolation,
    forces: &mut [DVec2],
) {
    let arch = lanes::registers();
    if field.dim.0.min(field.dim.1) < 2 {
        for (&p, force) in points.iter().zip(forces) {
            *force = one(field, p, rule);
        }
    } else if rule == Interpolation::Bilinear {
        arch.dispatch(Values::<F, false> {
            field,
            points,
            forces,
        });
    } else {
        arch.dispatch(Values::<F, true> {
            field,
            points,
            forces,
        });
    }
}

/// The forces and slopes of a flat field at many points: the shortest slice says how many.
pub(crate) fn sample_flat_with_slope<F: Kept>(
    field: Flat<'_, F>,
    points: &[DVec2],
    rule: Interpolation,
    forces: &mut [DVec2],
    slopes: &mut [DMat2],
) {
    let arch = lanes::registers();
    if field.dim.0.min(field.dim.1) < 2 {
        for ((&p, force), slope) in points.iter().zip(forces).zip(slopes) {
            (*force, *slope) = one_with_slope(field, p, rule);
        }
    } else if rule == Interpolation::Bilinear {
        arch.dispatch(Slopes::<F, false> {
            field,
            points,
            forces,
            slopes,
        });
    } else {
        arch.dispatch(Slopes::<F, true> {
            field,
            points,
            forces,
            slopes,
        });
    }
}

/// One point, wherever it lies.
#[inline(never)]
fn one<F: Kept>(field: Flat<'_, F>, p: DVec2, rule: Interpolation) -> DVec2 {
    value(|row, column| field.get(row, column), field.dim, p, rule)
}

#[inline(never)]
fn one_with_slope<F: Kept>(field: Flat<'_, F>, p: DVec2, rule: Interpolation) -> (DVec2, DMat2) {
    value_and_slope(|row, column| field.get(row, column), field.dim, p, rule)
}

/// The four forces of a cell.
#[inline(always)]
fn corners<F: Kept>([above, below]: [&[F]; 2], at: usize) -> Option<[Two; 2]> {
    // both have the same length, which the compiler sees only here
    let n = above.len().min(below.len());
    if at >= n.saturating_sub(1) {
        return None;
    }
    let (above, below) = (above.get(at..at + 2)?, below.get(at..at + 2)?);
    Some([F::two(above.first_chunk()?), F::two(below.first_chunk()?)])
}

/// The sixteen forces around a cell.
#[inline(always)]
fn sixteen<F: Kept>([a, b, c, d]: [&[F]; 4], at: usize) -> Option<[Run; 4]> {
    let end = at.wrapping_add(4);
    let (a, b, c, d) = (
        a.get(at..end)?,
        b.get(at..end)?,
        c.get(at..end)?,
        d.get(at..end)?,
    );
    Some([
        F::four(a.first_chunk()?),
        F::four(b.first_chunk()?),
        F::four(c.first_chunk()?),
        F::four(d.first_chunk()?),
    ])
}

/// The field as seen from each of `N` rows, all of one length, so that one look at the length is enough.
#[inline(always)]
fn rows<'a, F, const N: usize>(field: Flat<'a, F>) -> [&'a [F]; N] {
    let stride = field.stride;
    let n = field.forces.len().saturating_sub((N - 1) * stride);
    std::array::from_fn(|j| {
        field
            .forces
            .get(j * stride..j * stride + n)
            .unwrap_or_default()
    })
}

#[inline(always)]
fn bilinear_values<F: Kept>(field: Flat<'_, F>, points: &[DVec2], forces: &mut [DVec2]) {
    let mut group = Group::new();
    let rows = rows(field);
    for (points, forces) in points.chunks(GROUP).zip(forces.chunks_mut(GROUP)) {
        group.find::<false, false>(points, field.place());
        let Group {
            at, t: [tx, ty], ..
        } = &group;
        for (k, (force, _)) in forces.iter_mut().zip(points).enumerate() {
            // every cell is whole
            let Some(f) = corners(rows, at[k]) else {
                continue;
            };
            *force = DVec2::from_array(bilinear(f, tx[k], ty[k]));
        }
    }
}

#[inline(always)]
fn bilinear_slopes<F: Kept>(
    field: Flat<'_, F>,
    points: &[DVec2],
    forces: &mut [DVec2],
    slopes: &mut [DMat2],
) {
    let mut group = Group::new();
    let rows = rows(field);
    let results = forces.chunks_mut(GROUP).zip(slopes.chunks_mut(GROUP));
    for (points, (forces, slopes)) in points.chunks(GROUP).zip(results) {
        group.find::<false, true>(points, field.place());
        let Group {
            at,
            t: [tx, ty],
            slide: [slide_x, slide_y],
        } = &group;
        for (k, ((force, slope), _)) in forces.iter_mut().zip(slopes).zip(points).enumerate() {
            let Some(f) = corners(rows, at[k]) else {
                continue;
            };
            let (value, slopes) = bilinear_slope(f, [tx[k], ty[k]], [slide_x[k], slide_y[k]]);
            *force = DVec2::from_array(value);
            *slope = DMat2::from_cols_array(&slopes);
        }
    }
}

#[inline(always)]
fn bicubic_values<S: Simd, F: Kept>(
    simd: S,
    field: Flat<'_, F>,
    points: &[DVec2],
    forces: &mut [DVec2],
) {
    let mut group = Group::new();
    let [mut wx, mut wy] = [const { Weights::new() }; 2];
    let rows = rows(field);
    for (points, forces) in points.chunks(GROUP).zip(forces.chunks_mut(GROUP)) {
        let all_inner = group.find::<true, false>(points, field.place());
        let Group {
            at, t: [tx, ty], ..
        } = &group;
        wx.fill(points.len(), |k| cubic(tx[k]));
        wy.fill(points.len(), |k| cubic(ty[k]));
        for (k, (force, _)) in forces.iter_mut().zip(points).enumerate() {
            let Some(f) = sixteen(rows, at[k]) else {
                continue;
            };
            *force = DVec2::from_array(bicubic(simd, f, [wx.of(k), wy.of(k)]));
        }
        if !all_inner {
            for ((force, &p), &at) in forces.iter_mut().zip(points).zip(at) {
                if at == usize::MAX {
                    *force = one(field, p, Interpolation::Bicubic);
                }
            }
        }
    }
}

#[inline(always)]
fn bicubic_slopes<S: Simd, F: Kept>(
    simd: S,
    field: Flat<'_, F>,
    points: &[DVec2],
    forces: &mut [DVec2],
    slopes: &mut [DMat2],
) {
    let mut group = Group::new();
    let [mut wx, mut wy, mut dx, mut dy] = [const { Weights::new() }; 4];
    let rows = rows(field);
    let results = forces.chunks_mut(GROUP).zip(slopes.chunks_mut(GROUP));
    for (points, (forces, slopes)) in points.chunks(GROUP).zip(results) {
        let all_inner = group.find::<true, true>(points, field.place());
        let Group {
            at,
            t: [tx, ty],
            slide: [slide_x, slide_y],
        } = &group;
        wx.fill(points.len(), |k| cubic(tx[k]));
        wy.fill(points.len(), |k| cubic(ty[k]));
        dx.fill(points.len(), |k| cubic_slope(tx[k], slide_x[k]));
        dy.fill(points.len(), |k| cubic_slope(ty[k], slide_y[k]));
        for (k, ((force, slope), _)) in forces.iter_mut().zip(&mut *slopes).zip(points).enumerate()
        {
            let Some(f) = sixteen(rows, at[k]) else {
                continue;
            };
            let (value, slopes) =
                bicubic_slope(simd, f, [wx.of(k), wy.of(k)], [dx.of(k), dy.of(k)]);
            *force = DVec2::from_array(value);
            *slope = DMat2::from_cols_array(&slopes);
        }
        if !all_inner {
            for ((force, slope), (&p, &at)) in
                forces.iter_mut().zip(slopes).zip(points.iter().zip(at))
            {
                if at == usize::MAX {
                    (*force, *slope) = one_with_slope(field, p, Interpolation::Bicubic);
                }
            }
        }
    }
}
