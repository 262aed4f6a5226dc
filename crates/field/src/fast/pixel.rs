//! Pixels as they come from a camera or a file, turned into `f32` on the way into a tile.

use crate::grid::mirrored;
use ndarray::ArrayView2;

/// A pixel the fast pipeline reads: `u8`, `u16` or `f32`.
///
/// Sealed: every implementation loads at full speed and is tested.
pub trait Pixel: Copy + Send + Sync + std::fmt::Debug + sealed::Sealed + 'static {
    /// The grey level as an `f32`, exactly.
    fn level(self) -> f32;

    /// The bits of the magnitude: not below those of any finite `f32` exactly if NaN or infinite.
    #[doc(hidden)]
    fn magnitude(self) -> u32;
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for u8 {}
    impl Sealed for u16 {}
    impl Sealed for f32 {}
}

impl Pixel for u8 {
    #[inline(always)]
    fn level(self) -> f32 {
        f32::from(self)
    }
    #[inline(always)]
    fn magnitude(self) -> u32 {
        0
    }
}

impl Pixel for u16 {
    #[inline(always)]
    fn level(self) -> f32 {
        f32::from(self)
    }
    #[inline(always)]
    fn magnitude(self) -> u32 {
        0
    }
}

impl Pixel for f32 {
    #[inline(always)]
    fn level(self) -> f32 {
        self
    }
    #[inline(always)]
    fn magnitude(self) -> u32 {
        self.to_bits() & 0x7fff_ffff
    }
}

/// Which columns of the mirrored image a tile reads.
pub(super) struct Columns {
    /// Those that are the image's own.
    inside: std::ops::Range<usize>,
    /// The columns that stand in for those before and after.
    before: Vec<usize>,
    after: Vec<usize>,
}

impl Columns {
    /// `n` columns from `x0` on, of an image of `width`.
    pub(super) fn new(x0: isize, n: usize, width: usize) -> Self {
        let (end, last) = (x0 + n.cast_signed(), width.cast_signed());
        let (first_in, end_in) = (x0.clamp(0, last), end.clamp(0, last));
        let stand_ins =
            |columns: std::ops::Range<isize>| columns.map(|x| mirrored(x, width)).collect();
        Self {
            inside: first_in.unsigned_abs()..end_in.unsigned_abs(),
            before: stand_ins(x0..first_in),
            after: stand_ins(end_in..end),
        }
    }

    /// The image's own pixels among these columns, of a line `y` of its own, where they lie together.
    #[inline(always)]
    pub(super) fn inside<'a, P: Pixel>(
        &self,
        image: &'a ArrayView2<'_, P>,
        y: isize,
    ) -> Option<&'a [P]> {
        let y = usize::try_from(y).ok().filter(|&y| y < image.nrows())?;
        image.row(y).to_slice()?.get(self.inside.clone())
    }

    /// Loads these columns of line `y` of the mirrored image.
    ///
    /// Returns the largest [`Pixel::magnitude`] met.
    #[inline(always)]
    pub(super) fn load<P: Pixel>(
        &self,
        image: &ArrayView2<'_, P>,
        y: isize,
        out: &mut [f32],
    ) -> u32 {
        let row = image.row(mirrored(y, image.nrows()));
        let (head, rest) = out.split_at_mut(self.before.len());
        let (middle, tail) = rest.split_at_mut(self.inside.len());
        let mut largest = 0;
        let mut put = |level: &mut f32, pixel: P| {
            *level = pixel.level();
            largest = largest.max(pixel.magnitude());
        };
        if let Some(row) = row.as_slice() {
            for (level, &pixel) in middle.iter_mut().zip(&row[self.inside.clone()]) {
                put(level, pixel);
            }
        } else {
            for (level, column) in middle.iter_mut().zip(self.inside.clone()) {
                put(level, row[column]);
            }
        }
        for (level, &column) in head.iter_mut().zip(&self.before) {
            put(level, row[column]);
        }
        for (level, &column) in tail.iter_mut().zip(&self.after) {
            put(level, row[column]);
        }
        largest
    }
}
