//! A picture in blocks of several pixels, each the mean of its pixels: what an edge is read in that is blurred over
//! many.

use field::Pixels;
use glam::DVec2;

/// A picture whose pixels are squares of pixels of another.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Blocks<'a> {
    pixels: &'a dyn Pixels,
    /// Length of a square's side, in pixels of the other.
    side: usize,
}

impl<'a> Blocks<'a> {
    pub(crate) fn of(pixels: &'a dyn Pixels, side: usize) -> Self {
        Self {
            pixels,
            side: side.max(1),
        }
    }

    /// Pixels along a side of a block.
    pub(crate) const fn side(self) -> usize {
        self.side
    }

    /// Width and height; squares at the border may be cut.
    pub(crate) fn size(self) -> (usize, usize) {
        let (width, height) = self.pixels.size();
        (width.div_ceil(self.side), height.div_ceil(self.side))
    }

    pub(crate) fn is_color(self) -> bool {
        self.pixels.is_color()
    }

    /// The level of a block.
    pub(crate) fn level(&self, x: usize, y: usize) -> [f64; 1] {
        self.mean(x, y, |x, y| [self.pixels.level(x, y)])
    }

    /// The color of a block.
    pub(crate) fn color(&self, x: usize, y: usize) -> [f64; 3] {
        self.mean(x, y, |x, y| self.pixels.color(x, y))
    }

    /// Whether all pixels of the picture count.
    pub(crate) fn all_count(self) -> bool {
        self.pixels.valid().is_none()
    }

    /// Whether all pixels of a block count.
    pub(crate) fn counts(self, x: usize, y: usize) -> bool {
        self.pixels
            .valid()
            .is_none_or(|valid| self.within(x, y).all(|(x, y)| valid[[y, x]]))
    }

    /// The pixels of a block.
    fn within(&self, x: usize, y: usize) -> impl Iterator<Item = (usize, usize)> {
        let (width, height) = self.pixels.size();
        let range = |at: usize, most: usize| at * self.side..((at + 1) * self.side).min(most);
        let columns = range(x, width);
        range(y, height).flat_map(move |y| columns.clone().map(move |x| (x, y)))
    }

    fn mean<const N: usize>(
        &self,
        x: usize,
        y: usize,
        at: impl Fn(usize, usize) -> [f64; N],
    ) -> [f64; N] {
        if self.side == 1 {
            return at(x, y);
        }
        let (mut sum, mut count) = ([0.0; N], 0.0);
        for (x, y) in self.within(x, y) {
            for (sum, value) in sum.iter_mut().zip(at(x, y)) {
                *sum += value;
            }
            count += 1.0;
        }
        sum.map(|sum| sum / count)
    }

    /// A place of the picture in blocks, and back.
    pub(crate) fn to_blocks(self, p: DVec2) -> DVec2 {
        (p + 0.5) / self.side as f64 - 0.5
    }

    /// See [`Self::to_blocks`].
    pub(crate) fn to_picture(self, p: DVec2) -> DVec2 {
        (p + 0.5) * self.side as f64 - 0.5
    }

    /// σ in the picture of a blur in blocks, less what the means over the blocks add to it. Pixels.
    pub(crate) fn blur(self, blur: f64) -> f64 {
        let side = self.side as f64;
        (side * side * blur * blur - (side * side - 1.0) / 12.0)
            .max(0.0)
            .sqrt()
    }
}
