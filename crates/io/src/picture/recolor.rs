//! Pictures of one sequence, alike in color and in what is known of their pixels.

use std::sync::Arc;

use image::{Rgb, RgbImage};

use super::pixels::Pixels;
use super::{Picture, PixelSize, as_u32};

impl Picture {
    /// A grey picture as one in color, red, green and blue alike; one in color as it is.
    pub(crate) fn into_color(self) -> Self {
        if self.color {
            return self;
        }
        let (width, height) = self.size;
        let (width, height) = (as_u32(width), as_u32(height));
        let pixels = match &self.pixels {
            Pixels::Bytes(list) => {
                let triples = list.iter().flat_map(|&level| [level; 3]).collect();
                RgbImage::from_raw(width, height, triples)
                    .map(|image| Pixels::Colors(Arc::new(image)))
            }
            Pixels::Words(list) => {
                let triples = list.iter().flat_map(|&level| [level; 3]).collect();
                let image = image::ImageBuffer::from_raw(width, height, triples);
                image.map(|image| Pixels::DeepColors(Arc::new(image)))
            }
            _ => Some(Pixels::FloatColors(Arc::new(image::Rgb32FImage::from_fn(
                width,
                height,
                |x, y| {
                    #[expect(
                        clippy::cast_possible_truncation,
                        reason = "colors in floats have 24 bits"
                    )]
                    let share = (self.level_at(x as usize, y as usize) / 255.0) as f32;
                    Rgb([share; 3])
                },
            )))),
        };
        let Some(pixels) = pixels else { return self };
        let levels = self.levels.clone();
        Self {
            pixels,
            levels,
            color: true,
            ..self
        }
    }

    /// A picture in color by its grey levels; a grey one as it is.
    pub(crate) fn into_grey(self) -> Self {
        if !self.color {
            return self;
        }
        let of = Self::from_levels(self.levels().clone());
        Self {
            deep: self.deep,
            valid: self.valid,
            notes: self.notes,
            pixel_size: self.pixel_size,
            ..of
        }
    }

    /// The levels that are shown black and white, where the picture is of more than eight bits.
    #[must_use]
    pub fn shown_limits(&self) -> Option<(f64, f64)> {
        self.deep.then(|| self.seen())
    }

    /// The picture as a person sees it, between limits that are those of another of the same sequence.
    #[must_use]
    pub fn shown_between(&self, limits: Option<(f64, f64)>) -> RgbImage {
        let Some((low, high)) = limits.filter(|_| self.deep) else {
            return self.shown();
        };
        self.pixels.stretched(low, high).unwrap_or_else(|| {
            let (width, height) = self.size;
            RgbImage::from_fn(as_u32(width), as_u32(height), |x, y| {
                let level = self.level_at(x as usize, y as usize);
                Rgb([crate::paint::byte(255.0 * (level - low) / (high - low)); 3])
            })
        })
    }

    /// Take a size of pixels where none is known.
    pub(crate) fn take_pixel_size(&mut self, size: Option<&PixelSize>) {
        if self.pixel_size.is_none() {
            self.pixel_size = size.cloned();
        }
    }
}

#[cfg(test)]
#[allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    reason = "a test: a broken set-up should stop it; levels of bytes are exact"
)]
mod tests {
    use super::*;

    #[test]
    fn levels_stay_what_they_were_and_only_the_color_changes() {
        let grey = Picture::decode(b"P5\n3 2\n255\n\x01\x02\x03\xf0\xf1\xff").unwrap();
        let color = grey.clone().into_color();
        assert!(color.is_color() && color.channels().len() == 3);
        for (x, y) in [(0, 0), (2, 0), (0, 1), (2, 1)] {
            let level = grey.level_at(x, y);
            assert_eq!(color.color_at(x, y), [level; 3]);
            assert!((color.levels()[[y, x]] - level).abs() < 1e-9);
        }
        let color = Picture::decode(b"P6\n1 1\n255\n\x10\x20\x30").unwrap();
        let grey = color.clone().into_grey();
        assert!(!grey.is_color() && grey.channels().len() == 1);
        assert_eq!(grey.levels(), color.levels());
    }
}
