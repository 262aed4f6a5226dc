//! Pixels as a file held them, and what can be said of them without turning all into doubles.

use std::sync::Arc;

use field::{EdgeForce, FieldError, ForceField, Grid, Recipe, lazy_force};
use image::{ImageBuffer, Luma, RgbImage, buffer::ConvertBuffer as _};
use ndarray::{ArcArray2, Array2};

use super::as_u32;

/// Grey levels from 0 to 255 in sixteen bits: as far as one goes.
const WORDS_A_LEVEL: f64 = 257.0;

/// The pixels of a picture.
#[derive(Debug, Clone)]
pub(super) enum Pixels {
    /// Grey of eight bits.
    Bytes(ArcArray2<u8>),
    /// Grey of sixteen bits.
    Words(ArcArray2<u16>),
    /// Colors of eight bits.
    Colors(Arc<RgbImage>),
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

/// The grey levels of colors, row by row.
fn lumas(colors: &RgbImage) -> impl Iterator<Item = f64> {
    colors.pixels().map(|p| luma(p.0.map(f64::from)))
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to f32 is the point"
)]
fn narrow(level: f64) -> f32 {
    level as f32
}

impl Pixels {
    /// Grey levels, 0 … 255; None if they are kept beside.
    pub(super) fn levels(&self) -> Option<Grid> {
        match self {
            Self::Bytes(bytes) => Some(bytes.mapv(f64::from)),
            Self::Words(words) => Some(words.mapv(|v| f64::from(v) / WORDS_A_LEVEL)),
            Self::Colors(colors) => {
                let dim = (colors.height() as usize, colors.width() as usize);
                Grid::from_shape_vec(dim, lumas(colors).collect()).ok()
            }
            Self::Levels => None,
        }
    }

    /// As a person sees them; None if that is not seen from them alone.
    pub(super) fn display(&self) -> Option<RgbImage> {
        match self {
            Self::Bytes(bytes) => shown::<u8>(bytes),
            Self::Words(words) => shown::<u16>(words),
            Self::Colors(colors) => Some(RgbImage::clone(colors)),
            Self::Levels => None,
        }
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
            Self::Colors(colors) => {
                let dim = (colors.height() as usize, colors.width() as usize);
                let grey = lumas(colors).map(narrow).collect();
                let grey = Array2::from_shape_vec(dim, grey).ok()?;
                Some(lazy_force(grey, &Recipe::Edge(*rule)))
            }
            Self::Levels => None,
        }
    }

    /// Their levels, ready to be asked for the k-th of all.
    pub(super) fn ordered(&self) -> Ordered<'static> {
        match self {
            Self::Bytes(bytes) => {
                let mut counts = vec![0; 1 << 8];
                bytes.iter().for_each(|&v| counts[usize::from(v)] += 1);
                Ordered::Counts(counts, 1.0)
            }
            Self::Words(words) => {
                let mut counts = vec![0; 1 << 16];
                words.iter().for_each(|&v| counts[usize::from(v)] += 1);
                Ordered::Counts(counts, WORDS_A_LEVEL)
            }
            Self::Colors(colors) => Ordered::Own(lumas(colors).collect()),
            Self::Levels => Ordered::Own(Vec::new()),
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

fn shown<P>(grey: &ArcArray2<P>) -> Option<RgbImage>
where
    Luma<P>: image::Pixel<Subpixel = P>,
    P: image::Primitive,
    for<'a> ImageBuffer<Luma<P>, &'a [P]>: image::buffer::ConvertBuffer<RgbImage>,
{
    let (height, width) = grey.dim();
    let pixels = grey.as_slice()?;
    let grey = ImageBuffer::<Luma<P>, _>::from_raw(as_u32(width), as_u32(height), pixels)?;
    Some(grey.convert())
}

/// Levels that can be asked for the k-th smallest.
pub(super) enum Ordered<'a> {
    /// How often each value occurs, and values to a level.
    Counts(Vec<u64>, f64),
    Levels(&'a mut [f64]),
    Own(Vec<f64>),
}

impl Ordered<'_> {
    fn len(&self) -> usize {
        match self {
            Self::Counts(counts, _) => {
                usize::try_from(counts.iter().sum::<u64>()).unwrap_or(usize::MAX)
            }
            Self::Levels(levels) => levels.len(),
            Self::Own(levels) => levels.len(),
        }
    }

    fn at(&mut self, k: usize) -> f64 {
        match self {
            Self::Counts(counts, values) => {
                let mut below = 0;
                let value = counts.iter().position(|&count| {
                    below += count;
                    below > k as u64
                });
                value.unwrap_or(0) as f64 / *values
            }
            Self::Levels(levels) => *levels.select_nth_unstable_by(k, f64::total_cmp).1,
            Self::Own(levels) => *levels.select_nth_unstable_by(k, f64::total_cmp).1,
        }
    }
}

/// From the 2nd to the 98th percentile, or where these are one, from the least to the largest; 0 for a constant.
pub(super) fn spread(levels: &mut Ordered<'_>) -> f64 {
    let n = levels.len();
    if n == 0 {
        return 0.0;
    }
    let mut at = |part: usize| levels.at((n - 1) * part / 100);
    let (least, largest) = (at(0), at(100));
    // less than the rounding of colors to grey leaves
    if largest - least <= 1e-12 * least.abs().max(largest.abs()) {
        return 0.0;
    }
    let spread = at(98) - at(2);
    if spread > 0.0 {
        spread
    } else {
        largest - least
    }
}
