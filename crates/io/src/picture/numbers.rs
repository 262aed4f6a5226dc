//! The numbers that a picture holds, for those that are labels and not levels.

use super::pixels::Pixels;
use super::{Picture, PictureReading, decode};
use crate::limits::MOST_WHOLE;

/// The numbers of a picture, row by row.
#[derive(Debug)]
pub(crate) struct Numbers {
    pub width: usize,
    pub list: Vec<f64>,
    /// Whether all are whole numbers from 0 to 4294967295.
    pub whole: bool,
    /// The number that is white.
    pub white: f64,
    /// Whether they are colors, red in the third byte from below.
    pub colors: bool,
}

/// The numbers of a picture file; those of less than eight bits are spread over eight.
///
/// # Errors
///
/// As [`Picture::decode`]; a picture whose pixels are changed by how it is packed.
pub(crate) fn numbers_of(bytes: &[u8]) -> Result<Numbers, String> {
    if bytes.starts_with(b"\xff\xd8\xff") {
        return Err(
            "a JPEG does not keep its pixels as they are; a PNG or TIFF is needed".to_owned(),
        );
    }
    let picture = decode::decode(bytes, MOST_WHOLE, &PictureReading::default())?;
    Ok(of(&picture))
}

fn of(picture: &Picture) -> Numbers {
    let color = |[r, g, b]: [u8; 3]| f64::from(u32::from_be_bytes([0, r, g, b]));
    let (list, white): (Vec<f64>, f64) = match &picture.pixels {
        Pixels::Bytes(list) => (list.iter().map(|&v| f64::from(v)).collect(), 255.0),
        Pixels::Words(list) => (list.iter().map(|&v| f64::from(v)).collect(), 65535.0),
        Pixels::Signed(list) => (list.iter().map(|&v| f64::from(v)).collect(), 32767.0),
        Pixels::Long(list) => (
            list.iter().map(|&v| f64::from(v)).collect(),
            f64::from(u32::MAX),
        ),
        Pixels::SignedLong(list) => (
            list.iter().map(|&v| f64::from(v)).collect(),
            f64::from(i32::MAX),
        ),
        Pixels::Floats(list) => (list.iter().map(|&v| f64::from(v)).collect(), 1.0),
        Pixels::Colors(colors) => (colors.pixels().map(|p| color(p.0)).collect(), 1.0),
        // deep colors as a person sees them
        Pixels::DeepColors(_) | Pixels::FloatColors(_) => (
            picture.display().pixels().map(|p| color(p.0)).collect(),
            1.0,
        ),
        Pixels::Levels => {
            let near = |v: f64| {
                if (v - v.round()).abs() < 1e-9 * v.abs().max(1.0) {
                    v.round()
                } else {
                    v
                }
            };
            (
                picture.levels().iter().map(|v| near(v / 255.0)).collect(),
                1.0,
            )
        }
    };
    let whole = |v: &f64| v.fract() == 0.0 && (0.0..=4_294_967_295.0).contains(v);
    Numbers {
        width: picture.size().0,
        whole: list.iter().all(whole),
        list,
        white,
        colors: matches!(
            picture.pixels,
            Pixels::Colors(_) | Pixels::DeepColors(_) | Pixels::FloatColors(_)
        ),
    }
}
