//! The part of a picture about some curves, at a size to look at.

use glam::DVec2;
use io::{Picture, RgbImage, paint};

/// Around the curves, as a share of their size.
const MARGIN: f64 = 0.12;
/// A range of levels below this is stretched to be seen.
const DIM: u8 = 128;

/// A part of a picture, and where its pixels are now.
#[derive(Debug)]
pub(crate) struct Crop {
    pub(crate) image: RgbImage,
    low: DVec2,
    zoom: f64,
}

impl Crop {
    /// The part about these points, as wide or as high as `side`; all of the picture for none.
    pub(crate) fn about(picture: &Picture, points: impl Iterator<Item = DVec2>, side: u32) -> Self {
        let (width, height) = picture.size();
        let last = DVec2::new(width as f64, height as f64) - 1.0;
        let within = points.map(|p| p.clamp(DVec2::ZERO, last));
        let (low, high) = within.fold((last, DVec2::ZERO), |(low, high), p| {
            (low.min(p), high.max(p))
        });
        let (low, high) = if low.cmple(high).all() {
            (low, high)
        } else {
            (DVec2::ZERO, last)
        };
        let room = MARGIN * (high - low).max_element();
        let low = (low - room).max(DVec2::ZERO).floor();
        let high = (high + room).min(last).ceil();
        let part = cropped(picture.display(), low, high);
        let longest = part.width().max(part.height());
        // means of whole squares of pixels first, so that nothing is passed over
        let small = paint::shrunk(&part, longest.div_ceil((longest / side).max(1)));
        let fewer = f64::from(longest.div_ceil(small.width().max(small.height())));
        let zoom = f64::from(side - 1) / f64::from(small.width().max(small.height()));
        Self {
            image: paint::enlarged(&small, zoom),
            low: low + 0.5 * (fewer - 1.0),
            zoom: zoom / fewer,
        }
    }

    /// Where points of the picture are.
    pub(crate) fn place(&self, curve: &[DVec2]) -> Vec<DVec2> {
        curve.iter().map(|p| (*p - self.low) * self.zoom).collect()
    }

    /// Draw a curve of the picture.
    pub(crate) fn draw(&mut self, curve: &[DVec2], closed: bool, color: [u8; 3]) {
        let drawn = self.place(curve);
        paint::draw_curve(&mut self.image, &drawn, closed, 2.0, color);
    }
}

/// A part of a picture, its levels stretched if they are all much alike.
fn cropped(image: &RgbImage, low: DVec2, high: DVec2) -> RgbImage {
    let size = high - low + 1.0;
    let part = RgbImage::from_fn(whole(size.x), whole(size.y), |x, y| {
        *image.get_pixel(whole(low.x) + x, whole(low.y) + y)
    });
    // so many of each level, as a picture may be large
    let mut counts = [0_usize; 256];
    let levels = || part.pixels().flat_map(|pixel| pixel.0);
    levels().for_each(|level| counts[usize::from(level)] += 1);
    let count: usize = counts.iter().sum();
    let at = |rank: usize| {
        let mut below = 0;
        let level = counts.iter().position(|&here| {
            below += here;
            below > rank
        });
        level
            .and_then(|level| u8::try_from(level).ok())
            .unwrap_or(u8::MAX)
    };
    let (dark, bright) = (at(count / 100), at(count - 1 - count / 100));
    if bright - dark >= DIM || bright == dark {
        return part;
    }
    let stretched = |level: u8| {
        let share = u32::from(level.clamp(dark, bright) - dark) * 255;
        u8::try_from(share / u32::from(bright - dark)).unwrap_or(u8::MAX)
    };
    let mut part = part;
    part.pixels_mut()
        .for_each(|pixel| pixel.0 = pixel.0.map(stretched));
    part
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a whole number of pixels within a picture"
)]
const fn whole(length: f64) -> u32 {
    length as u32
}
