//! Pixels as a file held them, and what can be said of them without turning all into doubles.
//!
//! Long because every depth and sign of level has its own arm, and all stand side by side.

use std::sync::Arc;

use field::{EdgeForce, FieldError, ForceField, Grid, Recipe, lazy_force, level_limits};
use image::metadata::Orientation;
use image::{
    DynamicImage, ImageBuffer, Luma, Rgb, Rgb32FImage, RgbImage, buffer::ConvertBuffer as _,
};
use ndarray::{ArcArray2, Array2};

use super::as_u32;
use super::decode::{is_grey, upright};

/// Grey levels from 0 to 255 in sixteen bits: as far as one goes.
const WORDS_A_LEVEL: f64 = 257.0;

/// Grey levels from 0 to 255 in thirty-two bits.
const LONGS_A_LEVEL: f64 = 16_843_009.0;

/// The level of white, which is 1 in floats.
const WHITE: f64 = 255.0;

/// The pixels of a picture, of the depth that the file has.
#[derive(Debug, Clone)]
pub(super) enum Pixels {
    /// Grey of eight bits.
    Bytes(ArcArray2<u8>),
    /// Grey of sixteen bits.
    Words(ArcArray2<u16>),
    /// Grey of sixteen bits with a sign.
    Signed(ArcArray2<i16>),
    /// Grey of thirty-two bits.
    Long(ArcArray2<u32>),
    /// Grey of thirty-two bits with a sign.
    SignedLong(ArcArray2<i32>),
    /// Grey from 0 to 1 in floats, all finite.
    Floats(ArcArray2<f32>),
    /// Colors of eight bits.
    Colors(Arc<RgbImage>),
    /// Colors of sixteen bits.
    DeepColors(Arc<ImageBuffer<Rgb<u16>, Vec<u16>>>),
    /// Colors from 0 to 1 in floats, all finite.
    FloatColors(Arc<Rgb32FImage>),
    /// Levels in doubles, kept beside.
    Levels,
}

/// Grey in three channels is that grey exactly, as in one.
pub(super) fn luma([r, g, b]: [f64; 3]) -> f64 {
    if r.to_bits() == g.to_bits() && g.to_bits() == b.to_bits() {
        r
    } else {
        0.299 * r + 0.587 * g + 0.114 * b
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to f32 is the point"
)]
fn narrow(level: f64) -> f32 {
    level as f32
}

/// Runs `$body` with the levels of every pixel, row by row, as an iterator that can be begun again.
macro_rules! with_levels {
    ($pixels:expr, $levels:ident, $body:expr) => {
        match $pixels {
            Pixels::Bytes(list) => {
                let $levels = || list.iter().map(|&v| f64::from(v));
                Some($body)
            }
            Pixels::Words(list) => {
                let $levels = || list.iter().map(|&v| f64::from(v) / WORDS_A_LEVEL);
                Some($body)
            }
            Pixels::Signed(list) => {
                let $levels = || list.iter().map(|&v| f64::from(v) / WORDS_A_LEVEL);
                Some($body)
            }
            Pixels::Long(list) => {
                let $levels = || list.iter().map(|&v| f64::from(v) / LONGS_A_LEVEL);
                Some($body)
            }
            Pixels::SignedLong(list) => {
                let $levels = || list.iter().map(|&v| f64::from(v) / LONGS_A_LEVEL);
                Some($body)
            }
            Pixels::Floats(list) => {
                let $levels = || list.iter().map(|&v| f64::from(v) * WHITE);
                Some($body)
            }
            Pixels::Colors(list) => {
                let $levels = || list.pixels().map(|p| luma(p.0.map(f64::from)));
                Some($body)
            }
            Pixels::DeepColors(list) => {
                let level = |v: u16| f64::from(v) / WORDS_A_LEVEL;
                let $levels = || list.pixels().map(|p| luma(p.0.map(level)));
                Some($body)
            }
            Pixels::FloatColors(list) => {
                let level = |v: f32| f64::from(v) * WHITE;
                let $levels = || list.pixels().map(|p| luma(p.0.map(level)));
                Some($body)
            }
            Pixels::Levels => None,
        }
    };
}

impl Pixels {
    /// Width and height; None if they are those of levels kept beside.
    pub(super) fn size(&self) -> Option<(usize, usize)> {
        let of = |(height, width): (usize, usize)| Some((width, height));
        match self {
            Self::Bytes(list) => of(list.dim()),
            Self::Words(list) => of(list.dim()),
            Self::Signed(list) => of(list.dim()),
            Self::Long(list) => of(list.dim()),
            Self::SignedLong(list) => of(list.dim()),
            Self::Floats(list) => of(list.dim()),
            Self::Colors(list) => Some((list.width() as usize, list.height() as usize)),
            Self::DeepColors(list) => Some((list.width() as usize, list.height() as usize)),
            Self::FloatColors(list) => Some((list.width() as usize, list.height() as usize)),
            Self::Levels => None,
        }
    }

    /// Whether some pixel is of more than grey.
    pub(super) fn has_color(&self) -> bool {
        match self {
            Self::Colors(list) => !list.pixels().all(|p| is_grey(p.0)),
            Self::DeepColors(list) => !list.pixels().all(|p| is_grey(p.0)),
            Self::FloatColors(list) => !list.pixels().all(|p| is_grey(p.0.map(f32::to_bits))),
            _ => false,
        }
    }

    /// Whether each pixel or channel is of eight bits, so that it can be shown as it is.
    pub(super) const fn is_shallow(&self) -> bool {
        matches!(self, Self::Bytes(_) | Self::Colors(_) | Self::Levels)
    }

    /// The same as it is looked at.
    pub(super) fn turned(self, orientation: Orientation) -> Self {
        match self {
            Self::Bytes(list) => Self::Bytes(upright(list.into_owned(), orientation).into_shared()),
            Self::Words(list) => Self::Words(upright(list.into_owned(), orientation).into_shared()),
            Self::Signed(list) => {
                Self::Signed(upright(list.into_owned(), orientation).into_shared())
            }
            Self::Long(list) => Self::Long(upright(list.into_owned(), orientation).into_shared()),
            Self::SignedLong(list) => {
                Self::SignedLong(upright(list.into_owned(), orientation).into_shared())
            }
            Self::Floats(list) => {
                Self::Floats(upright(list.into_owned(), orientation).into_shared())
            }
            Self::Colors(list) => {
                let mut image = DynamicImage::ImageRgb8(Arc::unwrap_or_clone(list));
                image.apply_orientation(orientation);
                Self::Colors(Arc::new(image.into_rgb8()))
            }
            Self::DeepColors(list) => {
                let mut image = DynamicImage::ImageRgb16(Arc::unwrap_or_clone(list));
                image.apply_orientation(orientation);
                Self::DeepColors(Arc::new(image.into_rgb16()))
            }
            other => other,
        }
    }

    /// The names of its channels.
    pub(super) const fn channel_names(&self) -> &'static [&'static str] {
        match self {
            Self::Colors(_) | Self::DeepColors(_) | Self::FloatColors(_) => {
                &["red", "green", "blue"]
            }
            _ => &["grey"],
        }
    }

    /// One channel of colors as it is; None of grey.
    pub(super) fn one(&self, c: usize) -> Option<Self> {
        fn shaped<T: Clone>(size: (usize, usize), list: Vec<T>) -> Option<ArcArray2<T>> {
            let list = Array2::from_shape_vec((size.1, size.0), list).ok()?;
            Some(list.into_shared())
        }
        let size = self.size()?;
        match self {
            Self::Colors(list) => {
                let list = list.pixels().map(|p| p.0[c]).collect();
                shaped(size, list).map(Self::Bytes)
            }
            Self::DeepColors(list) => {
                let list = list.pixels().map(|p| p.0[c]).collect();
                shaped(size, list).map(Self::Words)
            }
            Self::FloatColors(list) => {
                let list = list.pixels().map(|p| p.0[c]).collect();
                shaped(size, list).map(Self::Floats)
            }
            _ => None,
        }
    }

    /// Grey levels, 0 … 255; None if they are kept beside.
    pub(super) fn levels(&self) -> Option<Grid> {
        let (width, height) = self.size()?;
        let list: Vec<f64> = with_levels!(self, levels, levels().collect())?;
        Grid::from_shape_vec((height, width), list).ok()
    }

    /// The grey level of one pixel; None if levels are kept beside.
    pub(super) fn level_at(&self, x: usize, y: usize) -> Option<f64> {
        let at = (as_u32(x), as_u32(y));
        Some(match self {
            Self::Bytes(list) => f64::from(list[[y, x]]),
            Self::Words(list) => f64::from(list[[y, x]]) / WORDS_A_LEVEL,
            Self::Signed(list) => f64::from(list[[y, x]]) / WORDS_A_LEVEL,
            Self::Long(list) => f64::from(list[[y, x]]) / LONGS_A_LEVEL,
            Self::SignedLong(list) => f64::from(list[[y, x]]) / LONGS_A_LEVEL,
            Self::Floats(list) => f64::from(list[[y, x]]) * WHITE,
            Self::Colors(list) => luma(list.get_pixel(at.0, at.1).0.map(f64::from)),
            Self::DeepColors(list) => {
                let level = |v: u16| f64::from(v) / WORDS_A_LEVEL;
                luma(list.get_pixel(at.0, at.1).0.map(level))
            }
            Self::FloatColors(list) => {
                let level = |v: f32| f64::from(v) * WHITE;
                luma(list.get_pixel(at.0, at.1).0.map(level))
            }
            Self::Levels => return None,
        })
    }

    /// Red, green and blue of one pixel, 0 … 255; None if there is but grey.
    pub(super) fn color_at(&self, x: usize, y: usize) -> Option<[f64; 3]> {
        let at = (as_u32(x), as_u32(y));
        match self {
            Self::Colors(list) => Some(list.get_pixel(at.0, at.1).0.map(f64::from)),
            Self::DeepColors(list) => {
                let level = |v: u16| f64::from(v) / WORDS_A_LEVEL;
                Some(list.get_pixel(at.0, at.1).0.map(level))
            }
            Self::FloatColors(list) => {
                let level = |v: f32| f64::from(v) * WHITE;
                Some(list.get_pixel(at.0, at.1).0.map(level))
            }
            _ => None,
        }
    }

    /// One channel of colors, 0 … 255; None if there is but grey.
    pub(super) fn channel(&self, c: usize) -> Option<Grid> {
        let (width, height) = self.size()?;
        let list: Vec<f64> = match self {
            Self::Colors(list) => list.pixels().map(|p| f64::from(p.0[c])).collect(),
            Self::DeepColors(list) => {
                let level = |v: u16| f64::from(f32::from(v) / 257.0);
                list.pixels().map(|p| level(p.0[c])).collect()
            }
            Self::FloatColors(list) => {
                let level = |v: f32| {
                    let level = v * 255.0;
                    let near = level.is_finite();
                    if near {
                        f64::from(level)
                    } else {
                        f64::from(v) * WHITE
                    }
                };
                list.pixels().map(|p| level(p.0[c])).collect()
            }
            _ => return None,
        };
        Grid::from_shape_vec((height, width), list).ok()
    }

    /// As a person sees them, if that is what they are: of eight bits a pixel or channel.
    pub(super) fn display(&self) -> Option<RgbImage> {
        match self {
            Self::Bytes(bytes) => shown(bytes),
            Self::Colors(colors) => Some(RgbImage::clone(colors)),
            _ => None,
        }
    }

    /// As a person sees them, black at the level `low` and white at `high`; None if they are kept beside.
    pub(super) fn stretched(&self, low: f64, high: f64) -> Option<RgbImage> {
        let (width, height) = self.size()?;
        let byte = |level: f64| crate::paint::byte(WHITE * (level - low) / (high - low));
        let bytes: Vec<u8> = match self {
            Self::DeepColors(list) => list
                .iter()
                .map(|&v| byte(f64::from(v) / WORDS_A_LEVEL))
                .collect(),
            Self::FloatColors(list) => list.iter().map(|&v| byte(f64::from(v) * WHITE)).collect(),
            _ => with_levels!(self, levels, {
                levels().flat_map(|level| [byte(level); 3]).collect()
            })?,
        };
        RgbImage::from_raw(as_u32(width), as_u32(height), bytes)
    }

    /// The lazy edge force of their levels; None if those are kept beside.
    pub(super) fn lazy_edge_force(
        &self,
        rule: &EdgeForce,
    ) -> Option<Result<ForceField, FieldError>> {
        match self {
            Self::Bytes(bytes) => Some(lazy_force(bytes.clone(), &Recipe::Edge(*rule))),
            Self::Words(words) => {
                let gain = rule.gain / WORDS_A_LEVEL;
                let rule = EdgeForce { gain, ..*rule };
                Some(lazy_force(words.clone(), &Recipe::Edge(rule)))
            }
            _ => {
                let (width, height) = self.size()?;
                let grey: Vec<f32> = with_levels!(self, levels, levels().map(narrow).collect())?;
                let grey = Array2::from_shape_vec((height, width), grey).ok()?;
                Some(lazy_force(grey, &Recipe::Edge(*rule)))
            }
        }
    }

    /// The largest level there may be, either way; None if they are kept beside.
    pub(super) fn largest(&self) -> Option<f64> {
        match self {
            Self::Floats(_) | Self::FloatColors(_) => {
                with_levels!(
                    self,
                    levels,
                    levels().fold(0.0, |most: f64, v| most.max(v.abs()))
                )
            }
            Self::Levels => None,
            _ => Some(WHITE),
        }
    }

    /// [`level_limits`] of their levels; None if those are kept beside.
    pub(super) fn limits(&self) -> Option<[f64; 4]> {
        match self {
            Self::Bytes(bytes) => {
                let mut counts = vec![0; 1 << 8];
                bytes.iter().for_each(|&v| counts[usize::from(v)] += 1);
                Some(limits_of_counts(&counts, 1.0))
            }
            Self::Words(words) => {
                let mut counts = vec![0; 1 << 16];
                words.iter().for_each(|&v| counts[usize::from(v)] += 1);
                Some(limits_of_counts(&counts, WORDS_A_LEVEL))
            }
            _ => with_levels!(self, levels, level_limits(levels)),
        }
    }
}

/// [`Pixels::lazy_edge_force`] of levels.
pub(super) fn lazy_edge_force_of(
    levels: &Grid,
    rule: &EdgeForce,
) -> Result<ForceField, FieldError> {
    lazy_force(levels.mapv(narrow), &Recipe::Edge(*rule))
}

fn shown(grey: &ArcArray2<u8>) -> Option<RgbImage> {
    let (height, width) = grey.dim();
    let pixels = grey.as_slice()?;
    let grey = ImageBuffer::<Luma<u8>, _>::from_raw(as_u32(width), as_u32(height), pixels)?;
    Some(grey.convert())
}

/// [`level_limits`] of values that occur so often, so many to a level.
fn limits_of_counts(counts: &[usize], values: f64) -> [f64; 4] {
    let n: usize = counts.iter().sum();
    [0, 2, 98, 100].map(|part| {
        let rank = n.saturating_sub(1) * part / 100;
        let mut below = 0;
        let value = counts.iter().position(|&count| {
            below += count;
            below > rank
        });
        value.unwrap_or(0) as f64 / values
    })
}
