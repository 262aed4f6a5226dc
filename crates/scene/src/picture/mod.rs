//! Pictures: read from files, or drawn from numbers.
//!
//! Inside, a picture is grey *levels* from 0 (black) to 255 (white), whatever the file held: eight
//! bits as they are, sixteen divided by 257, floats (0 … 1) times 255. So a force has the same size
//! for the same picture at any depth, and the report's parameters mean what they meant. Colour
//! becomes grey by `0.299 R + 0.587 G + 0.114 B`, not rounded; the colors are kept for forces that ask
//! for them. Transparency is ignored. Some pixels may not count: those a mask says, those that are no numbers.

mod decode;
mod drawn;
mod pixels;

use std::path::Path;
use std::sync::{Arc, OnceLock};

use field::{EdgeForce, FieldError, ForceField, Grid, MaskedImage};
use image::RgbImage;
use ndarray::Array2;
use pixels::Pixels;

use crate::SceneError;
use crate::limits::MOST_PIXELS;

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
    /// Colors of more than eight bits; those of eight bits are what is displayed.
    deep: Option<Arc<Vec<[f32; 3]>>>,
    /// Which pixels count; all if none.
    valid: Option<Array2<bool>>,
}

/// What becomes of pixels that are no finite numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Invalid {
    /// The picture is refused.
    #[default]
    Refuse,
    /// They do not count.
    Mask,
}

/// The pictures that come with the program, by name.
const SHIPPED: [(&str, &[u8]); 2] = [
    ("apple", include_bytes!("../../pictures/apple.png")),
    (
        "disturbing-edge",
        include_bytes!("../../pictures/disturbing_edge.pgm"),
    ),
];

impl Picture {
    /// Read a picture file: PNG, JPEG, TIFF, PGM/PPM; grey or colour; 8 bit, 16 bit or float.
    ///
    /// # Errors
    ///
    /// A file that cannot be opened, is empty or truncated, is no picture of a known format, has
    /// no pixel or too many, or holds numbers that are not finite.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        Self::load_with(path, Invalid::Refuse)
    }

    /// [`Picture::load`] with a word on pixels that are no finite numbers.
    ///
    /// # Errors
    ///
    /// As [`Picture::load`]; not one pixel that is a number.
    pub fn load_with(path: &Path, invalid: Invalid) -> Result<Self, SceneError> {
        decode::load(path, invalid).map_err(|message| SceneError::file(path, message))
    }

    /// A picture that comes with the program.
    ///
    /// # Errors
    ///
    /// A name that none has; the message has the nearest one.
    pub fn shipped(name: &str) -> Result<Self, SceneError> {
        let Some((_, bytes)) = SHIPPED.iter().find(|(known, _)| *known == name) else {
            let nearest = crate::error::nearest(name, SHIPPED.iter().map(|(known, _)| *known));
            let message = format!("no shipped picture \"{name}\"; did you mean \"{nearest}\"?");
            return Err(SceneError::key("picture.shipped", message));
        };
        Self::decode(bytes).map_err(|message| SceneError::key("picture.shipped", message))
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
        decode::decode(bytes, most, Invalid::Refuse)
    }

    /// A picture of grey levels; shown rounded and clamped to 0 … 255.
    #[must_use]
    pub fn from_levels(levels: Grid) -> Self {
        let (height, width) = levels.dim();
        let mut picture = Self::of((width, height), Pixels::Levels);
        picture.levels = OnceLock::from(levels);
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
            deep: None,
            valid: None,
        }
    }

    /// Grey levels, 0 … 255, indexed `[[y, x]]`: eight bytes a pixel from the first call on.
    #[must_use]
    pub fn levels(&self) -> &Grid {
        // pixels that are levels have them from the start
        let levels = || self.pixels.levels().unwrap_or_default();
        self.levels.get_or_init(levels)
    }

    /// The picture as a person sees it.
    #[must_use]
    pub fn display(&self) -> &RgbImage {
        if let Pixels::Colors(colors) = &self.pixels {
            return colors;
        }
        self.display.get_or_init(|| {
            let (width, height) = self.size;
            let shown = self.pixels.display();
            shown.unwrap_or_else(|| {
                RgbImage::from_fn(as_u32(width), as_u32(height), |x, y| {
                    let level = crate::paint::byte(self.levels()[[y as usize, x as usize]]);
                    image::Rgb([level; 3])
                })
            })
        })
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
                "the mask has {a}×{b} pixels and the picture {width}×{height}; as many would do"
            ));
        }
        let mut valid = mask.levels().mapv(|level| level > 0.0);
        if let Some(before) = &self.valid {
            valid.zip_mut_with(before, |now, &before| *now &= before);
        }
        if !valid.iter().any(|&ok| ok) {
            return Err("leaves no pixel; one that is not black would do".to_owned());
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
        let (width, height) = self.size();
        let channel = |c: usize| {
            Grid::from_shape_fn((height, width), |(y, x)| match &self.deep {
                Some(colors) => f64::from(colors[y * width + x][c]),
                None => f64::from(self.display().get_pixel(as_u32(x), as_u32(y)).0[c]),
            })
        };
        (0..3).map(channel).collect()
    }

    /// A grid of this picture's size with the word on which of its pixels count.
    pub(crate) fn masked(&self, grid: &Grid) -> Result<MaskedImage, FieldError> {
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
    pub(crate) fn lazy_edge_force(
        &self,
        rule: &EdgeForce,
    ) -> Result<Option<ForceField>, FieldError> {
        if self.valid.is_some() {
            return Ok(None);
        }
        let lazy = match self.pixels.lazy_edge_force(rule) {
            Some(lazy) => lazy,
            None => pixels::lazy_edge_force_of(self.levels(), rule),
        };
        lazy.map(Some)
    }

    /// The largest level there may be.
    pub(crate) fn largest_level(&self) -> f64 {
        match &self.pixels {
            Pixels::Levels => self.levels().iter().fold(0.0, |most, v| most.max(v.abs())),
            _ => 255.0,
        }
    }

    /// Whether its pixels were finite and within bounds before anyone looked: those of 8 and 16 bits are.
    pub(crate) const fn is_tame(&self) -> bool {
        !matches!(self.pixels, Pixels::Levels)
    }

    /// [`Picture::contrast`] of its levels.
    pub(crate) fn grey_contrast(&self) -> f64 {
        match (&self.valid, self.levels.get()) {
            (None, None) => pixels::spread(&mut self.pixels.ordered()),
            _ => self.contrast(self.levels()),
        }
    }

    /// Spread of a grid of this picture's size: from the 2nd to the 98th percentile of what counts, or where
    /// these are one, from the least to the largest. 0 for a constant.
    pub(crate) fn contrast(&self, grid: &Grid) -> f64 {
        let mut levels: Vec<f64> = match &self.valid {
            None => grid.iter().copied().collect(),
            Some(valid) => {
                let both = grid.iter().zip(valid);
                both.filter(|(_, ok)| **ok).map(|(&v, _)| v).collect()
            }
        };
        pixels::spread(&mut pixels::Ordered::Levels(&mut levels))
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
