//! One tile of a field, from pixels to forces, without leaving the cache.
//! Long because its passes share one room and one order of rows.
//!
//! A tile of w × h forces works on rows of w + 4 numbers, two more at either end because two masks follow each
//! other, and reads a margin around those as wide as its filters reach. It goes down the tile, a group of rows at a
//! time. Pixels of as many rows as the filters see are kept in strips, as wide as a register, so that a filter down
//! the tile reads one vector after the other; a filter along the rows does the same once blocks of N × N numbers are
//! transposed. What lies beyond the image comes out right by itself where the image is mirrored; where the report's
//! program pads with zeros, zeros are written.

use super::masks::{self, Gradients, Put};
use super::pixel::{Columns, Pixel};
use super::plan::{Kind, Plan};
use super::room::{CACHE_LINE, Room, Rows};
use super::slide::{SPARE, slide_block};
use super::vector::{Four, Lanes, Wide};
use ndarray::ArrayView2;
use pulp::{Simd, WithSimd};

/// Columns and rows of a tile when a whole image is computed.
///
/// Wide, so that memory is read and written in long runs. All buffers of a tile together stay below 400 KiB for the
/// report's smoothing and below 0.9 MiB for the widest filter.
pub(super) const TILE: (usize, usize) = (524, 1020);

/// Columns and rows of a tile when only a band is wanted.
pub(super) const SMALL_TILE: (usize, usize) = (124, 64);

/// Columns of a tile, four more than its forces, are a multiple of this: the widest vectors.
pub(super) const QUANTUM: usize = 16;

/// Rows that are taken from pixels to forces at once.
const GROUP: usize = 2 * QUANTUM;

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
    /// A few rows of pixels, and the same transposed.
    pixels: Room,
    turned: Room,
    /// Pixels, or pixels smoothed along x, in strips.
    strips: Room,
    /// Rows that are being made into forces.
    rows: Room,
}

/// Computes one tile and writes row `r` of it to `out[r * out_stride ..][.. width]`.
pub(super) struct Job<'a, P: Pixel> {
    pub(super) plan: &'a Plan,
    pub(super) image: ArrayView2<'a, P>,
    pub(super) place: Place,
    pub(super) scratch: &'a mut Scratch,
    pub(super) out: &'a mut [[f32; 2]],
    pub(super) out_stride: usize,
    /// Whether there are more forces, in all tiles, than caches hold.
    pub(super) many: bool,
}

impl<P: Pixel> WithSimd for Job<'_, P> {
    /// Whether a pixel was met that is not finite or too large.
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        if S::IS_SCALAR {
            self.work::<Four, 4>(Four)
        } else {
            match S::F32_LANES {
                4 => self.work::<Wide<S>, 4>(Wide(simd)),
                8 => self.work::<Wide<S>, 8>(Wide(simd)),
                _ => self.work::<Wide<S>, 16>(Wide(simd)),
            }
        }
    }
}

impl<P: Pixel> Job<'_, P> {
    /// `B` is how many numbers a vector has, for blocks of as many vectors.
    #[inline(always)]
    fn work<L: Lanes, const B: usize>(self, lanes: L) -> bool {
        let (image, place, scratch) = (&self.image, self.place, self.scratch);
        let put = &mut Put {
            out: self.out,
            stride: self.out_stride,
            width: place.width,
            many: self.many,
        };
        let largest = match &self.plan.kind {
            Kind::Report { odd } => report_tile::<L, B, P>(lanes, odd, image, place, scratch, put),
            Kind::Edge { even_x, even_y } => {
                edge_tile::<L, B, P>(lanes, [even_x, even_y], image, place, scratch, put)
            }
        };
        if self.many {
            lanes.wait();
        }
        largest > self.plan.largest_pixel.to_bits()
    }
}

/// The sizes of a tile's buffers.
#[derive(Debug, Clone, Copy)]
struct Sizes {
    /// Columns of the intermediate results.
    n: usize,
    /// Columns read on either side of those: the filter's reach, to the next vector.
    margin: usize,
    /// Rows that a group's filters see beside the group.
    around: usize,
    /// Rows that there is room for in a strip.
    long: usize,
    /// The column and the row of the mirrored image that are read first.
    left: isize,
    top: isize,
}

impl Sizes {
    /// Rows are read from `early` before the reach of the first on.
    fn new<const B: usize>(place: Place, reach: usize, early: usize) -> Self {
        let around = 2 * (reach + SPARE);
        // strips an odd number of lines of the cache apart
        let per_line = CACHE_LINE / B;
        let rows = (GROUP + around).next_multiple_of(B);
        let lines = rows.div_ceil(per_line) | 1;
        let margin = (reach + SPARE).next_multiple_of(B);
        let first = |at: usize, before: usize| at.cast_signed() - 2 - before.cast_signed();
        Self {
            n: (place.width + 4).next_multiple_of(QUANTUM),
            margin,
            around,
            long: lines * per_line,
            left: first(place.x, margin),
            top: first(place.y, reach + SPARE + early),
        }
    }

    /// Columns with both margins.
    const fn wide(&self) -> usize {
        self.n + 2 * self.margin
    }
}

/// Which rows and columns of a tile's rows lie inside the image.
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
        if self.columns.start > 0 {
            line[..self.columns.start].fill(0.0);
        }
        if self.columns.end < line.len() {
            line[self.columns.end..].fill(0.0);
        }
    }
}

/// Lines of an image, a block of rows at a time.
struct Reader<'a, 'b, P: Pixel> {
    image: &'a ArrayView2<'b, P>,
    columns: Columns,
    /// The line of the mirrored image that comes next.
    next: isize,
    rows: Rows<'a>,
    largest: u32,
}

impl<'a, 'b, P: Pixel> Reader<'a, 'b, P> {
    fn new(image: &'a ArrayView2<'b, P>, sizes: &Sizes, room: &'a mut Room, block: usize) -> Self {
        let wide = sizes.wide();
        Self {
            image,
            columns: Columns::new(sizes.left, wide, image.ncols()),
            next: sizes.top,
            rows: Rows::new(room.fit(Rows::size(block, wide)), wide),
            largest: 0,
        }
    }

    /// The next `count` rows of the tile.
    #[inline(always)]
    fn read<L: Lanes>(&mut self, lanes: L, count: usize) {
        for i in 0..count {
            let met = self
                .columns
                .load(self.image, self.next, self.rows.get_mut(i));
            self.largest = self.largest.max(met);
            // what comes a group later is fetched meanwhile
            let later = self.next + GROUP.cast_signed();
            if let Some(pixels) = self.columns.inside(self.image, later) {
                lanes.expect(pixels);
            }
            self.next += 1;
        }
    }

    /// `B` of them, in vectors.
    #[inline(always)]
    fn rows<L: Lanes, const B: usize>(&self) -> [&[L::V]; B] {
        let mut rows: [&[L::V]; B] = [&[]; B];
        for (i, row) in rows.iter_mut().enumerate() {
            *row = L::view(self.rows.get(i));
        }
        rows
    }
}

/// The last rows of each strip become its first.
#[inline(always)]
fn move_up<V: Copy>(strips: &mut [V], sizes: &Sizes) {
    for strip in strips.chunks_exact_mut(sizes.long) {
        strip.copy_within(GROUP..GROUP + sizes.around, 0);
    }
}

/// Writes vectors one below the other.
#[inline(always)]
fn put_block<L: Lanes, const B: usize>(out: &mut [f32], at: usize, step: usize, r: [L::V; B]) {
    for j in 0..B {
        let at = at + j * step;
        L::view_mut(&mut out[at..at + B])[0] = r[j];
    }
}

/// Filters strips down: a group of rows.
#[inline(always)]
fn along_y<L: Lanes, const B: usize, const ODD: bool>(
    lanes: L,
    strips: &[L::V],
    sizes: &Sizes,
    weights: &[f32],
    (out, begin, step): (&mut [f32], usize, usize),
) {
    for (i, strip) in strips.chunks_exact(sizes.long).enumerate() {
        for first in (0..GROUP).step_by(B) {
            let window = &strip[first..first + B + sizes.around];
            let r = slide_block::<L, B, ODD>(lanes, window, weights);
            put_block::<L, B>(out, begin + first * step + i * B, step, r);
        }
    }
}

/// Fx and Fy of the report's program: smoothing and first difference in one odd filter each.
#[inline(always)]
fn report_tile<L: Lanes, const B: usize, P: Pixel>(
    lanes: L,
    odd: &[f32],
    image: &ArrayView2<'_, P>,
    place: Place,
    scratch: &mut Scratch,
    put: &mut Put<'_>,
) -> u32 {
    let reach = odd.len();
    let sizes = Sizes::new::<B>(place, reach, 1);
    let (n, wide, long) = (sizes.n, sizes.wide(), sizes.long);
    let strips = L::view_mut(scratch.strips.fit(long * wide));
    let turned = L::view_mut(scratch.turned.fit(wide * B));
    let mut reader = Reader::new(image, &sizes, &mut scratch.pixels, B);
    let borders = Borders::new(image.dim(), place, n);
    let numbers = scratch.rows.fit(Rows::size(2 * GROUP + 4, n) + 4 * n);
    let (x, numbers) = numbers.split_at_mut(Rows::size(GROUP, n));
    let (y, numbers) = numbers.split_at_mut(Rows::size(GROUP, n));
    let (b, numbers) = numbers.split_at_mut(Rows::size(1, n));
    let (e, four) = numbers.split_at_mut(Rows::size(3, n));
    let (mut x, mut y) = (Rows::new(x, n), Rows::new(y, n));
    let (mut b, mut e) = (Rows::new(b, n), Rows::new(e, n));
    let four = L::view_mut(four);
    four.fill(lanes.splat(0.0));
    let skip = sizes.margin - reach - SPARE;
    for first in (0..place.height + 4).step_by(GROUP) {
        let mut row = if first == 0 { 0 } else { sizes.around };
        if first > 0 {
            move_up(strips, &sizes);
        }
        while row < GROUP + sizes.around {
            let count = B.min(GROUP + sizes.around - row);
            reader.read(lanes, count);
            let rows = reader.rows::<L, B>();
            for (at, strip) in strips.chunks_exact_mut(long).enumerate() {
                let strip = &mut strip[row..row + B];
                for j in 0..B {
                    strip[j] = rows[j][at];
                }
            }
            row += count;
        }
        // x: differences d of row i, their magnitude a of row i − 1, its average of row i − 2; two of d and a are kept
        for block in (0..GROUP).step_by(B) {
            let from = block + reach + SPARE + 1;
            for (strip, turned) in strips.chunks_exact(long).zip(turned.chunks_exact_mut(B)) {
                let mut r = [lanes.splat(0.0); B];
                r.copy_from_slice(&strip[from..from + B]);
                lanes.turn(&mut r);
                turned.copy_from_slice(&r);
            }
            let rows = first + block;
            let inside = rows > 0
                && borders.rows.contains(&(rows - 1))
                && borders.rows.contains(&(rows + B - 1));
            let (out, begin, step) = x.columns();
            for (strip, four) in four.chunks_exact_mut(4).enumerate() {
                let window = &turned[skip + strip * B..][..B + sizes.around];
                let mut r = slide_block::<L, B, true>(lanes, window, odd);
                lanes.turn(&mut r);
                let r = if inside {
                    magnitudes::<L, B, true>(lanes, r, four, rows, &borders)
                } else {
                    magnitudes::<L, B, false>(lanes, r, four, rows, &borders)
                };
                put_block::<L, B>(out, begin + block * step + strip * B, step, r);
            }
        }
        // y: the same for the row before, whose average runs along it
        let inner = &strips[sizes.margin / B * long..][..n / B * long];
        along_y::<L, B, true>(lanes, inner, &sizes, odd, y.columns());
        for i in 0..GROUP.min(place.height + 4 - first) {
            let row = first + i;
            borders.clear_outside(y.get_mut(i));
            masks::along::<L, true>(lanes, &y, i, b.get_mut(0));
            borders.clear_outside(b.get_mut(0));
            masks::along::<L, false>(lanes, &b, 0, e.get_mut(row % 3));
            if row >= 4 {
                put.row(lanes, row - 4, (&x, i), (&e, [(row - 2) % 3, row % 3]));
            }
        }
    }
    reader.largest
}

/// Averages across of magnitudes of averages across, of rows `row` to `row + B`: they are those of two rows before.
///
/// Differences and magnitudes beyond the image count as zeros.
#[inline(always)]
fn magnitudes<L: Lanes, const B: usize, const INSIDE: bool>(
    lanes: L,
    r: [L::V; B],
    four: &mut [L::V],
    row: usize,
    borders: &Borders,
) -> [L::V; B] {
    let none = lanes.splat(0.0);
    let (mut d0, mut d1, mut a0, mut a1) = (four[0], four[1], four[2], four[3]);
    let mut out = r;
    for j in 0..B {
        let row = row + j;
        let inside = INSIDE || borders.rows.contains(&row);
        let inside_before = INSIDE || (row > 0 && borders.rows.contains(&(row - 1)));
        let d2 = if inside { r[j] } else { none };
        let a2 = if inside_before {
            lanes.abs(masks::sum(lanes, d0, d1, d2))
        } else {
            none
        };
        out[j] = masks::sum(lanes, a0, a1, a2);
        (d0, d1, a0, a1) = (d1, d2, a1, a2);
    }
    four.copy_from_slice(&[d0, d1, a0, a1]);
    out
}

/// Both components of the corrected force, from lines smoothed along x: the gradient's length, its gradient.
#[inline(always)]
fn edge_tile<L: Lanes, const B: usize, P: Pixel>(
    lanes: L,
    [even_x, even_y]: [&[f32]; 2],
    image: &ArrayView2<'_, P>,
    place: Place,
    scratch: &mut Scratch,
    put: &mut Put<'_>,
) -> u32 {
    let reach = even_x.len() - 1;
    let sizes = Sizes::new::<B>(place, reach, 0);
    let (n, wide, long) = (sizes.n, sizes.wide(), sizes.long);
    let strips = L::view_mut(scratch.strips.fit(long * n));
    let turned = L::view_mut(scratch.turned.fit(wide * B));
    let mut reader = Reader::new(image, &sizes, &mut scratch.pixels, B);
    let mut smooth = Gradients::new(scratch.rows.fit(Gradients::size(GROUP, n)), GROUP, n);
    let skip = sizes.margin - reach - SPARE;
    for first in (0..place.height + 4).step_by(GROUP) {
        let mut row = if first == 0 { 0 } else { sizes.around };
        if first > 0 {
            move_up(strips, &sizes);
        }
        while row < GROUP + sizes.around {
            let count = B.min(GROUP + sizes.around - row);
            reader.read(lanes, count);
            let rows = reader.rows::<L, B>();
            for (at, turned) in turned.chunks_exact_mut(B).enumerate() {
                let mut r = [lanes.splat(0.0); B];
                for j in 0..B {
                    r[j] = rows[j][at];
                }
                lanes.turn(&mut r);
                turned.copy_from_slice(&r);
            }
            for (at, strip) in strips.chunks_exact_mut(long).enumerate() {
                let window = &turned[skip + at * B..][..B + sizes.around];
                let mut r = slide_block::<L, B, false>(lanes, window, even_x);
                lanes.turn(&mut r);
                strip[row..row + B].copy_from_slice(&r);
            }
            row += count;
        }
        along_y::<L, B, false>(lanes, strips, &sizes, even_y, smooth.rows());
        for i in 0..GROUP.min(place.height + 4 - first) {
            smooth.put(lanes, i, first + i, put);
        }
        smooth.next(GROUP);
    }
    reader.largest
}
