//! Pictures: read from files, or made of levels.
//!
//! Inside, a picture is grey *levels* from 0 (black) to 255 (white), whatever the file held: eight
//! bits as they are, sixteen divided by 257 (with a sign or without),
//! thirty-two by 16843009, floats (0 … 1) times 255. So
//! a force has the same size
//! for the same picture at any depth, and the report's parameters mean what they meant. Colour
//! becomes grey by `0.299 R + 0.587 G + 0.114 B`, not rounded; the colors are kept for forces that ask
//! for them. A picture that says how it is to be looked at (EXIF, TIFF tag 274) is turned upright.
//! Some pixels may not count: those a mask says, those that are no numbers, those that are
//! transparent altogether (alpha 0), but where all are. Any other alpha changes nothing.

mod decode;
mod finite;
mod jpeg;
mod memory;
mod numbers;
mod pfm;
mod pixel_size;
mod pixels;
mod png;
mod pnm;
mod reading;
mod recolor;
mod sequence;
mod source;
mod tiff_bands;
mod tiff_file;
mod tiff_pages;
mod tiff_palette;
mod tiff_size;
mod webp;

use std::path::Path;
use std::sync::OnceLock;

use field::{EdgeForce, FieldError, ForceField, Grid, MaskedImage};
use image::RgbImage;
use ndarray::Array2;
use pixels::Pixels;

use crate::IoError;
use crate::limits::MOST_PIXELS;

pub(crate) use decode::broken;
pub(crate) use numbers::{Numbers, numbers_of};
pub use pixel_size::PixelSize;
pub use reading::{Invalid, PictureReading};
pub(crate) use sequence::{decode_next, decode_tiff};
pub(crate) use tiff_pages::pages_of_channel;

/// A picture: grey levels to compute with, and colours to look at.
///
/// Kept as it came: 8 or 16 bits a pixel or channel stay that. Levels in doubles and what is displayed are made when
/// they are first asked for, and kept.
#[derive(Debug, Clone)]
pub struct Picture {
    size: (usize, usize),
    pixels: Pixels,
    levels: OnceLock<Grid>,
    display: OnceLock<RgbImage>,
    /// Whether its colors are more than grey.
    color: bool,
    /// Whether its levels are of more than eight bits, of any range, and so are stretched to be seen.
    deep: bool,
    /// Which pixels count; all if none.
    valid: Option<Array2<bool>>,
    /// What people should know of it.
    notes: Vec<String>,
    /// How large a pixel is, if the file says so.
    pixel_size: Option<PixelSize>,
}

impl Picture {
    /// Read a picture file, or standard input for `-`: PNG, JPEG, TIFF, WebP, PGM/PPM, PFM;
    /// grey or colour; of 8, 16 or 32 bits or float.
    /// No more is read than the picture takes.
    ///
    /// # Errors
    ///
    /// A file that cannot be opened, is empty or has been cut, is no picture of a known format, has
    /// no pixel, more than its bytes can hold or than there is memory for, or holds numbers that are not finite.
    pub fn load(path: &Path) -> Result<Self, IoError> {
        Self::load_with(path, Invalid::Refuse)
    }

    /// [`Picture::load`] with a word on pixels that are no finite numbers.
    ///
    /// # Errors
    ///
    /// As [`Picture::load`]; not one pixel that is a number.
    pub fn load_with(path: &Path, invalid: Invalid) -> Result<Self, IoError> {
        let rule = PictureReading {
            invalid,
            ..PictureReading::default()
        };
        Self::load_as(path, &rule)
    }

    /// [`Picture::load`] with a word on what of the file is read and how.
    ///
    /// # Errors
    ///
    /// As [`Picture::load`]; a page or a channel that is not there.
    pub fn load_as(path: &Path, rule: &PictureReading) -> Result<Self, IoError> {
        decode::load(path, rule)
            .map_err(|message| IoError::file(&crate::read::called(path), message))
    }

    /// [`Picture::load_as`] from the bytes of a file of that name, for messages.
    ///
    /// # Errors
    ///
    /// As [`Picture::load_as`].
    pub fn decode_named(bytes: &[u8], name: &Path, rule: &PictureReading) -> Result<Self, IoError> {
        Self::decode_as(bytes, rule).map_err(|message| IoError::file(name, message))
    }

    /// [`Picture::decode`] with a word on what of the file is read and how.
    ///
    /// # Errors
    ///
    /// As [`Picture::decode`]; a page or a channel that is not there.
    pub fn decode_as(bytes: &[u8], rule: &PictureReading) -> Result<Self, String> {
        decode::decode(bytes, MOST_PIXELS, rule)
    }

    /// A picture from the bytes of a file.
    ///
    /// # Errors
    ///
    /// As [`Picture::load`], as a message without the file's name.
    pub fn decode(bytes: &[u8]) -> Result<Self, String> {
        Self::decode_small(bytes, MOST_PIXELS)
    }

    /// [`Picture::decode`] with a bound of one's own on the pixels, and so on the memory.
    ///
    /// # Errors
    ///
    /// As [`Picture::decode`]; more than `most` pixels.
    pub fn decode_small(bytes: &[u8], most: u64) -> Result<Self, String> {
        decode::decode(bytes, most, &PictureReading::default())
    }

    /// A picture of grey levels; shown rounded and clamped to 0 … 255.
    #[must_use]
    pub fn from_levels(levels: Grid) -> Self {
        let (height, width) = levels.dim();
        let mut picture = Self::of((width, height), Pixels::Levels);
        picture.levels = OnceLock::from(levels);
        picture
    }

    /// A picture of these pixels.
    fn of_pixels(pixels: Pixels) -> Self {
        let size = pixels.size().unwrap_or_default();
        let mut picture = Self::of(size, pixels);
        picture.color = picture.pixels.has_color();
        picture.deep = !picture.pixels.is_shallow();
        picture
    }

    /// A grey picture of these pixels.
    const fn of(size: (usize, usize), pixels: Pixels) -> Self {
        Self {
            size,
            pixels,
            levels: OnceLock::new(),
            display: OnceLock::new(),
            color: false,
            deep: false,
            valid: None,
            notes: Vec::new(),
            pixel_size: None,
        }
    }

    /// Grey levels, 0 … 255, indexed `[[y, x]]`: eight bytes a pixel from the first call on.
    #[must_use]
    pub fn levels(&self) -> &Grid {
        // pixels that are levels have them from the start
        let levels = || self.pixels.levels().unwrap_or_default();
        self.levels.get_or_init(levels)
    }

    /// The grey level of one pixel, without those of the others.
    #[must_use]
    pub fn level_at(&self, x: usize, y: usize) -> f64 {
        let kept = self.pixels.level_at(x, y);
        kept.unwrap_or_else(|| self.levels()[[y, x]])
    }

    /// Red, green and blue of one pixel, 0 … 255; of a grey picture its level three times.
    #[must_use]
    pub fn color_at(&self, x: usize, y: usize) -> [f64; 3] {
        let kept = self.pixels.color_at(x, y);
        kept.unwrap_or_else(|| [self.level_at(x, y); 3])
    }

    /// The picture as a person sees it: eight bits as they are; deeper ones from their 2nd to their 98th percentile.
    #[must_use]
    pub fn display(&self) -> &RgbImage {
        if let Pixels::Colors(colors) = &self.pixels {
            return colors;
        }
        self.display.get_or_init(|| self.shown())
    }

    /// [`Picture::display`], made anew and not kept.
    pub(crate) fn shown(&self) -> RgbImage {
        if let Some(display) = self.display.get() {
            return display.clone();
        }
        let (width, height) = self.size;
        let (low, high) = self.seen();
        let shown = if self.deep {
            self.pixels.stretched(low, high)
        } else {
            self.pixels.display()
        };
        shown.unwrap_or_else(|| {
            RgbImage::from_fn(as_u32(width), as_u32(height), |x, y| {
                let level = self.levels()[[y as usize, x as usize]];
                let shown = if self.deep {
                    255.0 * ((level - low) / (high - low))
                } else {
                    level
                };
                image::Rgb([crate::paint::byte(shown); 3])
            })
        })
    }

    /// The levels that are shown black and white.
    fn seen(&self) -> (f64, f64) {
        if !self.deep {
            return (0.0, 255.0);
        }
        let [least, low, high, largest] = self.grey_limits();
        if high > low {
            (low, high)
        } else if largest > least {
            (least, largest)
        } else {
            (0.0, 255.0)
        }
    }

    /// The same picture of which only the pixels count that are not black in `mask`.
    ///
    /// # Errors
    ///
    /// A mask of another size, or one that leaves no pixel.
    pub fn with_mask(mut self, mask: &Self) -> Result<Self, String> {
        if mask.size() != self.size() {
            let ((a, b), (width, height)) = (mask.size(), self.size());
            return Err(format!(
                "the mask has {a}×{b} pixels and the picture {width}×{height}; it must have as many"
            ));
        }
        let mut valid = mask.levels().mapv(|level| level > 0.0);
        if let Some(before) = &self.valid {
            valid.zip_mut_with(before, |now, &before| *now &= before);
        }
        if !valid.iter().any(|&ok| ok) {
            return Err("leaves no pixel; one at least must not be black".to_owned());
        }
        self.valid = Some(valid);
        Ok(self)
    }

    /// Which pixels count, indexed `[[y, x]]`; None if all do.
    #[must_use]
    pub const fn valid(&self) -> Option<&Array2<bool>> {
        self.valid.as_ref()
    }

    /// Whether there is more than grey in it.
    #[must_use]
    pub const fn is_color(&self) -> bool {
        self.color
    }

    /// Its channels, 0 … 255: red, green and blue, or its levels alone if it is grey.
    #[must_use]
    pub fn channels(&self) -> Vec<Grid> {
        if !self.color {
            return vec![self.levels().clone()];
        }
        (0..3).filter_map(|c| self.pixels.channel(c)).collect()
    }

    /// What people should know of it: how it was stored, what of the file was taken.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// A grid of this picture's size with the word on which of its pixels count.
    ///
    /// # Errors
    ///
    /// A grid of another size, or with values that are not finite.
    pub fn masked(&self, grid: &Grid) -> Result<MaskedImage, FieldError> {
        match &self.valid {
            Some(valid) => MaskedImage::new(grid, valid),
            None => MaskedImage::whole(grid),
        }
    }

    /// The corrected edge force of its grey levels, computed where it is asked for and in `f32`; None where some pixels do not
    /// count.
    ///
    /// # Errors
    ///
    /// A smoothing too wide for tiles, a gain that will not do.
    pub fn lazy_edge_force(&self, rule: &EdgeForce) -> Result<Option<ForceField>, FieldError> {
        if self.valid.is_some() {
            return Ok(None);
        }
        let lazy = match self.pixels.lazy_edge_force(rule) {
            Some(lazy) => lazy,
            None => pixels::lazy_edge_force_of(self.levels(), rule),
        };
        lazy.map(Some)
    }

    /// The largest level there may be, either way.
    #[must_use]
    pub fn largest_level(&self) -> f64 {
        let beside = || {
            self.levels()
                .iter()
                .fold(0.0, |most: f64, v| most.max(v.abs()))
        };
        self.pixels.largest().unwrap_or_else(beside)
    }

    /// Whether its pixels were found finite and within bounds when they were read.
    #[must_use]
    pub const fn is_tame(&self) -> bool {
        !matches!(self.pixels, Pixels::Levels)
    }

    /// The least level, the 2nd and the 98th percentile, and the largest.
    #[must_use]
    pub fn grey_limits(&self) -> [f64; 4] {
        match (&self.valid, self.levels.get()) {
            (None, None) => self.pixels.limits().unwrap_or_default(),
            (None, Some(levels)) => field::level_limits(|| levels.iter().copied()),
            (Some(valid), _) => field::level_limits(|| {
                let both = self.levels().iter().zip(valid);
                both.filter(|(_, ok)| **ok).map(|(&v, _)| v)
            }),
        }
    }

    /// How large a pixel is, if the file says so: by the resolution of a TIFF or a PNG, by the unit that
    /// `ImageJ` notes, or by OME.
    #[must_use]
    pub const fn pixel_size(&self) -> Option<&PixelSize> {
        self.pixel_size.as_ref()
    }

    /// Leave out pixels that are transparent altogether, unless all are.
    fn mask_alpha(&mut self, seen: Array2<bool>) {
        let count = seen.iter().filter(|&&seen| !seen).count();
        if count == seen.len() {
            self.notes
                .push("all pixels are transparent: transparency is ignored".to_owned());
        } else if count > 0 {
            self.notes
                .push(format!("{count} pixels are transparent: they do not count"));
            self.valid = Some(seen);
        }
    }

    /// Width and height.
    #[must_use]
    pub const fn size(&self) -> (usize, usize) {
        self.size
    }
}

pub(crate) fn as_u32(length: usize) -> u32 {
    u32::try_from(length).unwrap_or(u32::MAX)
}
