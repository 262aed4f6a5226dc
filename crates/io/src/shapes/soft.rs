//! Soft masks: whether a picture of whole numbers is one and not labels, and the probabilities that one holds.

use std::path::Path;

use ndarray::Array2;

use super::format::{self, Format, Reading};
use crate::limits::MOST_STREAM;
use crate::picture::{Numbers, numbers_of};
use crate::read::read_bytes;
use crate::{IoError, is_standard};

/// Black and white are at most so many pixels from any grey of a soft mask, along rows and columns.
const BORDER: usize = 4;

/// Whether there are black, white and grey, and all grey has black and white near: a mask drawn smoothly. Labels whose
/// numbers are between have pixels of which that is not so.
pub(super) fn is_soft(numbers: &Numbers) -> bool {
    let Numbers {
        width,
        list,
        whole,
        white,
        colors,
    } = numbers;
    let (black, white) = (|v: &f64| *v == 0.0, |v: &f64| v.total_cmp(white).is_eq());
    let bytes = *whole && !colors && [255.0, 65535.0].iter().any(white);
    let grey = |v: &f64| !black(v) && !white(v);
    if !bytes || !list.iter().any(grey) || !list.iter().any(black) || !list.iter().any(white) {
        return false;
    }
    let height = list.len() / width;
    let about = |at: usize, most: usize| at.saturating_sub(BORDER)..(at + BORDER + 1).min(most);
    list.iter()
        .enumerate()
        .filter(|(_, v)| grey(v))
        .all(|(at, _)| {
            let near = |is: &dyn Fn(&f64) -> bool| {
                about(at / width, height)
                    .any(|y| about(at % width, *width).any(|x| is(&list[y * width + x])))
            };
            near(&black) && near(&white)
        })
}

/// The probabilities of a soft mask, as a network gives them; None of a file that is read as anything else.
///
/// # Errors
///
/// A file that cannot be read, or is too large.
pub fn load_soft(path: &Path, reading: &Reading) -> Result<Option<Array2<f64>>, IoError> {
    if is_standard(path) {
        // it can be read once, for the outlines
        return Ok(None);
    }
    let bytes = read_bytes(path, "a picture", |_| MOST_STREAM)?;
    let picture = matches!(format::kind(&bytes), format::Kind::Picture);
    Ok(picture.then(|| probabilities(&bytes, reading)).flatten())
}

/// The probabilities of a picture that is read as a soft mask; None of any other.
fn probabilities(bytes: &[u8], reading: &Reading) -> Option<Array2<f64>> {
    let numbers = numbers_of(bytes).ok()?;
    let soft = match reading.format {
        Some(format) => format == Format::Soft,
        None => !numbers.whole || is_soft(&numbers),
    };
    let height = numbers.list.len().checked_div(numbers.width)?;
    let list: Vec<f64> = numbers.list.iter().map(|v| v / numbers.white).collect();
    let grid = Array2::from_shape_vec((height, numbers.width), list).ok()?;
    (soft && !numbers.colors).then_some(grid)
}
