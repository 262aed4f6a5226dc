//! Pixels that are no finite numbers: refused, or left out.

use std::sync::Arc;

use field::Grid;
use ndarray::Array2;

use super::decode::broken;
use super::pixels::{Pixels, luma};
use super::{Invalid, Picture, PictureReading};

/// Grey levels, all of them finite, and which of them count.
pub(super) fn grid(
    mut levels: Grid,
    rule: &PictureReading,
) -> Result<(Grid, Option<Array2<bool>>), String> {
    let mut valid = None;
    if let Some(((y, x), level)) = levels.indexed_iter().find(|(_, v)| !v.is_finite()) {
        if rule.invalid == Invalid::Refuse {
            return Err(format!(
                "pixel ({x}, {y}) is {level}; all must be finite numbers"
            ));
        }
        let Some(&first) = levels.iter().find(|v| v.is_finite()) else {
            return Err("not one of its pixels is a number; one at least is needed".to_owned());
        };
        valid = Some(levels.mapv(f64::is_finite));
        levels.mapv_inplace(|level| if level.is_finite() { level } else { first });
    }
    Ok((levels, valid))
}

/// A picture of floats, of which some may be no numbers.
pub(super) fn finite(pixels: Pixels, rule: &PictureReading) -> Result<Picture, String> {
    match pixels {
        Pixels::Floats(list) if !list.iter().all(|v| v.is_finite()) => {
            let (levels, valid) = grid(list.mapv(|v| 255.0 * f64::from(v)), rule)?;
            let mut picture = Picture::from_levels(levels);
            (picture.valid, picture.deep) = (valid, true);
            Ok(picture)
        }
        Pixels::FloatColors(colors) if !colors.iter().all(|v| v.is_finite()) => {
            let dim = (colors.height() as usize, colors.width() as usize);
            masked_colors(Arc::unwrap_or_clone(colors), dim, rule)
        }
        pixels => Ok(Picture::of_pixels(pixels)),
    }
}

/// Colors in floats of which some are no numbers: those pixels do not count.
pub(super) fn masked_colors(
    mut colors: image::Rgb32FImage,
    dim: (usize, usize),
    rule: &PictureReading,
) -> Result<Picture, String> {
    let levels = colors
        .pixels()
        .map(|p| luma(p.0.map(|v| f64::from(v) * 255.0)));
    let levels = Grid::from_shape_vec(dim, levels.collect()).map_err(broken)?;
    let (levels, valid) = grid(levels, rule)?;
    colors
        .iter_mut()
        .filter(|v| !v.is_finite())
        .for_each(|v| *v = 0.0);
    let mut picture = Picture::of_pixels(Pixels::FloatColors(Arc::new(colors)));
    picture.levels = std::sync::OnceLock::from(levels);
    picture.valid = valid;
    Ok(picture)
}
