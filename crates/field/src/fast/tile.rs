//! One tile of a field, from pixels to forces, without leaving the cache.
//!
//! A tile of w × h forces works on lines of w + 4 numbers, two more at either end because two masks follow each
//! other, and reads a margin of `radius` more pixels around those. The lines of intermediate stages are kept three
//! at a time. What lies beyond the image comes out right by itself where the image is mirrored; where the
//! report's program pads with zeros, zeros are written.

use super::lines::{Line, QUANTUM, average, filter, length, neighbours, subtract};
use super::pixel::{Columns, Pixel};
use super::plan::{Kind, Plan};
use ndarray::ArrayView2;
use pulp::{Simd, WithSimd};

/// Columns and rows of a tile when a whole image is computed.
///
/// Lines of 256 numbers; all buffers of a tile together stay below 400 KiB for the report's smoothing and below
/// 0.9 MiB for the widest filter.
pub(super) const TILE: (usize, usize) = (252, 256);

/// Columns and rows of a tile when only a band is wanted.
pub(super) const SMALL_TILE: (usize, usize) = (124, 64);

/// Where a tile lies.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) x: usize,
    pub(super) y: usize,
    pub(super) width: usize,
    pub(super) height: usize,
}

/// The memory of one worker, used again for every tile.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    pixels: Vec<f32>,
    smoothed: Vec<f32>,
    lines: Vec<Line>,
}

impl Scratch {
    fn fit(&mut self, n: usize, height: usize, radius: usize, smoothed: bool) {
        let rows = height + 4 + 2 * radius;
        if smoothed {
            // a line of pixels is smoothed as soon as it is read
            resize_exactly(&mut self.pixels, stride(n, radius));
            resize_exactly(&mut self.smoothed, rows * n);
        } else {
            resize_exactly(&mut self.pixels, rows * stride(n, radius));
        }
        if self
            .lines
            .first()
            .is_none_or(|line| line.as_ref().len() != n)
        {
            self.lines = vec![Line::zeros(n); 11];
        }
    }
}

/// A vector of this length and no memory beyond it.
fn resize_exactly(numbers: &mut Vec<f32>, n: usize) {
    numbers.truncate(n);
    numbers.reserve_exact(n - numbers.len());
    numbers.resize(n, 0.0);
}

/// A few numbers more than needed: rows must not lie a power of two apart.
fn stride(n: usize, radius: usize) -> usize {
    n + (2 * radius).next_multiple_of(16) + 16
}

/// Computes one tile and writes row `r` of it to `out[r * out_stride ..][.. width]`.
pub(super) struct Job<'a, P: Pixel> {
    pub(super) plan: &'a Plan,
    pub(super) image: ArrayView2<'a, P>,
    pub(super) place: Place,
    pub(super) scratch: &'a mut Scratch,
    pub(super) out: &'a mut [[f32; 2]],
    pub(super) out_stride: usize,
}

impl<P: Pixel> WithSimd for Job<'_, P> {
    /// Whether a pixel was met that is not finite or too large.
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        let Self {
            plan,
            image,
            place,
            scratch,
            out,
            out_stride,
        } = self;
        let n = (place.width + 4).next_multiple_of(QUANTUM);
        scratch.fit(
            n,
            place.height,
            plan.radius,
            matches!(plan.kind, Kind::Edge { .. }),
        );
        let stride = stride(n, plan.radius);
        let margin = (plan.radius + 2).cast_signed();
        let (x, y) = (
            place.x.cast_signed() - margin,
            place.y.cast_signed() - margin,
        );
        let mut largest = 0;
        let columns = Columns::new(x, place.width + 2 * (plan.radius + 2), image.ncols());
        let mut rows = Rows {
            out,
            stride: out_stride,
            width: place.width,
        };
        match &plan.kind {
            Kind::Report { odd } => {
                for (row, line) in (y..).zip(scratch.pixels.chunks_exact_mut(stride)) {
                    largest = largest.max(columns.load(&image, row, line));
                }
                let borders = Borders::new(image.dim(), place, n);
                report_tile(
                    simd,
                    odd,
                    stride,
                    place.height,
                    &borders,
                    scratch,
                    &mut rows,
                );
            }
            Kind::Edge { even_x, even_y } => {
                let Scratch {
                    pixels, smoothed, ..
                } = &mut *scratch;
                for (row, line) in (y..).zip(smoothed.chunks_exact_mut(n)) {
                    largest = largest.max(columns.load(&image, row, pixels));
                    filter::<S, false>(simd, pixels, plan.radius, 1, even_x, line);
                }
                edge_tile(simd, even_y, n, place.height, scratch, &mut rows);
            }
        }
        largest > plan.largest_pixel.to_bits()
    }
}

/// Where the forces of a tile go.
struct Rows<'a> {
    out: &'a mut [[f32; 2]],
    stride: usize,
    width: usize,
}

impl Rows<'_> {
    /// Differences along x and along y become a row of forces.
    #[inline(always)]
    fn put(&mut self, row: usize, x: &Line, [above, below]: [&Line; 2]) {
        let out = &mut self.out[row * self.stride..][..self.width];
        let (right, left) = (&x.shifted(3)[..self.width], &x.shifted(1)[..self.width]);
        let (below, above) = (
            &below.shifted(2)[..self.width],
            &above.shifted(2)[..self.width],
        );
        for i in 0..self.width {
            out[i] = [right[i] - left[i], below[i] - above[i]];
        }
    }
}

/// Which rows and columns of a tile's lines lie inside the image.
struct Borders {
    rows: std::ops::Range<usize>,
    columns: std::ops::Range<usize>,
}

impl Borders {
    fn new((height, width): (usize, usize), place: Place, n: usize) -> Self {
        let span = |first: usize, n: usize, of: usize| {
            2_usize.saturating_sub(first)..(of + 2 - first).min(n)
        };
        Self {
            rows: span(place.y, place.height + 4, height),
            columns: span(place.x, n, width),
        }
    }

    /// Zeros beyond the image's left and right border.
    #[inline(always)]
    fn clear_outside(&self, line: &mut [f32]) {
        line[..self.columns.start].fill(0.0);
        line[self.columns.end..].fill(0.0);
    }
}

/// Fx and Fy of the report's program: smoothing and first difference in one odd filter each.
#[inline(always)]
fn report_tile<S: Simd>(
    simd: S,
    odd: &[f32],
    stride: usize,
    height: usize,
    borders: &Borders,
    scratch: &mut Scratch,
    out: &mut Rows<'_>,
) {
    let radius = odd.len();
    let pixels = &scratch.pixels[..];
    let [d0, d1, d2, a0, a1, a2, e0, e1, e2, spare, other] = &mut scratch.lines[..] else {
        return;
    };
    let (mut d, mut a, mut e) = ([d0, d1, d2], [a0, a1, a2], [e0, e1, e2]);
    for i in 0..height + 4 {
        // x: differences of line i, magnitude of line i − 1, force of line i − 2
        d.rotate_left(1);
        if borders.rows.contains(&i) {
            filter::<S, true>(
                simd,
                pixels,
                (i + radius) * stride + radius,
                1,
                odd,
                d[2].as_mut(),
            );
        } else {
            d[2].as_mut().fill(0.0);
        }
        if i < 2 {
            continue;
        }
        a.rotate_left(1);
        if borders.rows.contains(&(i - 1)) {
            average::<S, true>(
                simd,
                [d[0].as_ref(), d[1].as_ref(), d[2].as_ref()],
                a[2].as_mut(),
            );
        } else {
            a[2].as_mut().fill(0.0);
        }
        // y: the same for line i − 1, whose average runs along the line
        filter::<S, true>(
            simd,
            pixels,
            (i - 1 + radius) * stride + radius,
            stride,
            odd,
            spare.as_mut(),
        );
        borders.clear_outside(spare.as_mut());
        average::<S, true>(simd, neighbours(spare), other.as_mut());
        borders.clear_outside(other.as_mut());
        e.rotate_left(1);
        average::<S, false>(simd, neighbours(other), e[2].as_mut());
        if i < 4 {
            continue;
        }
        average::<S, false>(
            simd,
            [a[0].as_ref(), a[1].as_ref(), a[2].as_ref()],
            spare.as_mut(),
        );
        out.put(i - 4, spare, [e[0], e[2]]);
    }
}

/// Both components of the corrected force, from lines smoothed along x: the gradient's length, its gradient.
#[inline(always)]
fn edge_tile<S: Simd>(
    simd: S,
    even_y: &[f32],
    n: usize,
    height: usize,
    scratch: &mut Scratch,
    out: &mut Rows<'_>,
) {
    let radius = even_y.len() - 1;
    let Scratch {
        smoothed, lines, ..
    } = scratch;
    let [s0, s1, s2, p0, p1, p2, down, above, below, gx, gy] = &mut lines[..] else {
        return;
    };
    let (mut s, mut p) = ([s0, s1, s2], [p0, p1, p2]);
    for i in 0..height + 4 {
        s.rotate_left(1);
        filter::<S, false>(simd, smoothed, (i + radius) * n, n, even_y, s[2].as_mut());
        if i < 2 {
            continue;
        }
        p.rotate_left(1);
        averages(simd, &s, [&mut *down, &mut *above, &mut *below]);
        subtract(simd, down.shifted(1), down.shifted(-1), gx.as_mut());
        subtract(simd, below.as_ref(), above.as_ref(), gy.as_mut());
        length(simd, gx.as_ref(), gy.as_ref(), p[2].as_mut());
        if i < 4 {
            continue;
        }
        averages(simd, &p, [&mut *down, &mut *above, &mut *below]);
        out.put(i - 4, down, [above, below]);
    }
}

/// What the report's two masks take differences of: three lines averaged down, the outer two along.
#[inline(always)]
fn averages<S: Simd>(simd: S, s: &[&mut Line; 3], [down, above, below]: [&mut Line; 3]) {
    average::<S, false>(
        simd,
        [s[0].as_ref(), s[1].as_ref(), s[2].as_ref()],
        down.as_mut(),
    );
    average::<S, false>(simd, neighbours(s[0]), above.as_mut());
    average::<S, false>(simd, neighbours(s[2]), below.as_mut());
}
