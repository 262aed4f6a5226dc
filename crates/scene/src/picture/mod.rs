//! Pictures: read from files, or drawn from numbers.
//!
//! Inside, a picture is grey *levels* from 0 (black) to 255 (white), whatever the file held: eight
//! bits as they are, sixteen divided by 257, floats (0 … 1) times 255. So a force has the same size
//! for the same picture at any depth, and the report's parameters mean what they meant. Colour
//! becomes grey by `0.299 R + 0.587 G + 0.114 B`, not rounded; transparency is ignored.

mod decode;
mod drawn;

use std::path::Path;

use field::Grid;
use image::RgbImage;

use crate::SceneError;
use crate::limits::MOST_PIXELS;

/// A picture: grey levels to compute with, and colours to look at.
#[derive(Debug, Clone)]
pub struct Picture {
    /// Grey levels, 0 … 255, indexed `[[y, x]]`.
    pub levels: Grid,
    /// The same as a person sees it.
    pub display: RgbImage,
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
    /// too few pixels to find an edge in or too many, or holds numbers that are not finite.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        decode::load(path).map_err(|message| SceneError::file(path, message))
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
        decode::decode(bytes, most)
    }

    /// A picture of grey levels; shown rounded and clamped to 0 … 255.
    #[must_use]
    pub fn from_levels(levels: Grid) -> Self {
        let (height, width) = levels.dim();
        let display = RgbImage::from_fn(as_u32(width), as_u32(height), |x, y| {
            let level = crate::paint::byte(levels[[y as usize, x as usize]]);
            image::Rgb([level; 3])
        });
        Self { levels, display }
    }

    /// Width and height.
    #[must_use]
    pub fn size(&self) -> (usize, usize) {
        let (height, width) = self.levels.dim();
        (width, height)
    }
}

pub(crate) fn as_u32(length: usize) -> u32 {
    u32::try_from(length).unwrap_or(u32::MAX)
}
