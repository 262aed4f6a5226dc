//! Pictures: read from files, or drawn from numbers.
//!
//! Inside, a picture is grey *levels* from 0 (black) to 255 (white), whatever the file held: eight
//! bits as they are, sixteen divided by 257, floats (0 … 1) times 255. So a force has the same size
//! for the same picture at any depth, and the report's parameters mean what they meant. Colour
//! becomes grey by `0.299 R + 0.587 G + 0.114 B`, not rounded; transparency is ignored.

use std::io::Cursor;
use std::path::Path;

use field::{EdgeForce, Grid, Smoothing};
use glam::DVec2;
use image::{DynamicImage, ImageReader, Limits, RgbImage};

use crate::SceneError;
use crate::file::{DrawnText, RegionText};

/// A picture: grey levels to compute with, and colours to look at.
#[derive(Debug, Clone)]
pub struct Picture {
    /// Grey levels, 0 … 255, indexed `[[y, x]]`.
    pub levels: Grid,
    /// The same as a person sees it.
    pub display: RgbImage,
}

/// Pixels a picture may have: what one force field of f64 pairs in 8 GiB holds.
const MOST_PIXELS: u64 = 1 << 29;

/// The pictures that come with the program, by name.
const SHIPPED: [(&str, &[u8]); 2] = [
    ("apple", include_bytes!("../pictures/apple.png")),
    ("disturbing-edge", include_bytes!("../pictures/disturbing_edge.pgm")),
];

impl Picture {
    /// Read a picture file: PNG, JPEG, TIFF, PGM/PPM; grey or colour; 8 bit, 16 bit or float.
    ///
    /// # Errors
    ///
    /// A file that cannot be opened, is empty or truncated, is no picture of a known format, has
    /// no pixel or too many, or holds numbers that are not finite.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        let bytes = std::fs::read(path).map_err(|error| SceneError::file(path, error))?;
        Self::decode(&bytes).map_err(|message| SceneError::file(path, message))
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
        if bytes.is_empty() {
            return Err("the file is empty; a PNG, JPEG, TIFF or PGM picture would do".to_owned());
        }
        let reader = || ImageReader::new(Cursor::new(bytes)).with_guessed_format();
        let sized = reader().map_err(|error| error.to_string())?;
        if sized.format().is_none() {
            return Err("not a picture this program reads; PNG, JPEG, TIFF or PGM would do".into());
        }
        let (width, height) = sized.into_dimensions().map_err(|e| broken(&e))?;
        let pixels = u64::from(width) * u64::from(height);
        if pixels == 0 {
            return Err(format!(
                "the picture is {width}×{height}; at least 1×1 would do"
            ));
        }
        if pixels > MOST_PIXELS {
            return Err(format!(
                "the picture is {width}×{height}, {pixels} pixels; at most {MOST_PIXELS} would do"
            ));
        }
        let mut full = reader().map_err(|error| error.to_string())?;
        let mut limits = Limits::default();
        limits.max_alloc = Some(MOST_PIXELS * 16);
        full.limits(limits);
        Self::from_image(&full.decode().map_err(|e| broken(&e))?)
    }

    fn from_image(image: &DynamicImage) -> Result<Self, String> {
        let (width, height) = (image.width() as usize, image.height() as usize);
        let luma = |[r, g, b]: [f64; 3]| 0.299 * r + 0.587 * g + 0.114 * b;
        let levels: Vec<f64> = match image {
            DynamicImage::ImageLuma8(i) => i.as_raw().iter().map(|&v| f64::from(v)).collect(),
            DynamicImage::ImageLuma16(i) => {
                i.as_raw().iter().map(|&v| f64::from(v) / 257.0).collect()
            }
            DynamicImage::ImageLumaA8(i) => i.pixels().map(|p| f64::from(p.0[0])).collect(),
            DynamicImage::ImageLumaA16(i) => {
                i.pixels().map(|p| f64::from(p.0[0]) / 257.0).collect()
            }
            DynamicImage::ImageRgb16(_) | DynamicImage::ImageRgba16(_) => image
                .to_rgb16()
                .pixels()
                .map(|p| luma(p.0.map(|v| f64::from(v) / 257.0)))
                .collect(),
            DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => image
                .to_rgb32f()
                .pixels()
                .map(|p| {
                    // a grey float picture arrives as three equal channels: keep its value exactly
                    let [r, g, b] = p.0.map(|v| f64::from(v) * 255.0);
                    if r.to_bits() == g.to_bits() && g.to_bits() == b.to_bits() {
                        r
                    } else {
                        luma([r, g, b])
                    }
                })
                .collect(),
            _ => image
                .to_rgb8()
                .pixels()
                .map(|p| luma(p.0.map(f64::from)))
                .collect(),
        };
        if let Some(at) = levels.iter().position(|v| !v.is_finite()) {
            let (x, y) = (at % width, at / width);
            return Err(format!(
                "pixel ({x}, {y}) is {}; finite numbers would do",
                levels[at]
            ));
        }
        let levels = Grid::from_shape_vec((height, width), levels).map_err(|e| e.to_string())?;
        Ok(Self {
            display: image.to_rgb8(),
            levels,
        })
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

    /// A picture drawn from numbers: a region on a ground, blurred, with noise from a seed.
    ///
    /// A pixel's level is the share of an 8 × 8 grid of points in its square that lies in the
    /// region, between ground and region; then a Gaussian blur, then white noise, then rounding to
    /// whole levels 0 … 255.
    pub(crate) fn drawn(text: &DrawnText) -> Result<Self, SceneError> {
        let key = |name: &str, message: String| {
            SceneError::key(&format!("picture.drawn.{name}"), message)
        };
        let [width, height] = text.size;
        if width == 0 || height == 0 || (width as u64) * (height as u64) > MOST_PIXELS {
            return Err(key(
                "size",
                format!("got {width} × {height}; 1 to {MOST_PIXELS} pixels would do"),
            ));
        }
        for (name, value) in [("blur", text.blur), ("noise", text.noise)] {
            if !(0.0..=1000.0).contains(&value) {
                return Err(key(name, format!("got {value}; from 0 to 1000 would do")));
            }
        }
        let inside = |p: DVec2| match &text.region {
            RegionText::RightOf(x) => p.x > *x,
            RegionText::Box([x0, y0, x1, y1]) => {
                (*x0..=*x1).contains(&p.x) && (*y0..=*y1).contains(&p.y)
            }
            RegionText::Circle(c) => p.distance(DVec2::from_array(c.center)) <= c.radius,
            RegionText::Ellipse(e) => {
                let turned = DVec2::from_angle(-e.angle).rotate(p - DVec2::from_array(e.center));
                (turned / DVec2::from_array(e.axes)).length_squared() <= 1.0
            }
        };
        let mut levels = Grid::from_shape_fn((height, width), |(y, x)| {
            let mut share = 0.0;
            for j in 0..8 {
                for i in 0..8 {
                    let offset =
                        DVec2::new(f64::from(2 * i + 1), f64::from(2 * j + 1)) / 16.0 - 0.5;
                    if inside(DVec2::new(x as f64, y as f64) + offset) {
                        share += 1.0 / 64.0;
                    }
                }
            }
            text.background + (text.foreground - text.background) * share
        });
        if text.blur > 0.0 {
            let blur = EdgeForce {
                smoothing: Smoothing::Gaussian(text.blur),
                gain: 1.0,
            };
            levels = field::edge_stages(&levels, &blur)
                .map_err(|error| key("blur", error.to_string()))?
                .smoothed;
        }
        for (at, level) in levels.iter_mut().enumerate() {
            if text.noise > 0.0 {
                *level += text.noise * normal(text.seed, at as u64);
            }
            *level = level.clamp(0.0, 255.0).round();
        }
        Ok(Self::from_levels(levels))
    }

    /// Width and height.
    #[must_use]
    pub fn size(&self) -> (usize, usize) {
        let (height, width) = self.levels.dim();
        (width, height)
    }
}

fn broken(error: &image::ImageError) -> String {
    format!("the picture cannot be decoded: {error}")
}

pub(crate) fn as_u32(length: usize) -> u32 {
    u32::try_from(length).unwrap_or(u32::MAX)
}

/// A standard normal number for place `at` of the stream `seed`: splitmix64 and Box–Muller.
fn normal(seed: u64, at: u64) -> f64 {
    let word = |k: u64| {
        let mut z = (seed << 32)
            .wrapping_add(2 * at + k)
            .wrapping_add(0x9E37_79B9_7F4A_7C15);
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    };
    let unit = |w: u64| (w >> 11) as f64 / 9_007_199_254_740_992.0;
    let (a, b) = (unit(word(0)) + f64::EPSILON / 2.0, unit(word(1)));
    (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
}
