//! PFM files: floats, grey or in color, the lowest row first.

use std::io::{BufRead, Read as _};
use std::sync::Arc;

use image::Rgb32FImage;
use ndarray::Array2;

use super::as_u32;
use super::decode::{broken, room};
use super::pixels::Pixels;
use super::source::{after, check_size, cut, exact, too_little};
use crate::limits::MOST_WHOLE;

/// Bytes that a word of the head may have.
const MOST_WORD: usize = 40;

/// Whether a file begins as one.
pub(super) fn is_one(head: &[u8]) -> bool {
    (head.starts_with(b"Pf") || head.starts_with(b"PF"))
        && head.get(2).is_some_and(u8::is_ascii_whitespace)
}

/// The word up to the next space.
fn word(input: &mut dyn BufRead) -> Result<String, String> {
    let mut word = String::new();
    loop {
        let [byte] = exact::<1>(input)?;
        if byte.is_ascii_whitespace() {
            if !word.is_empty() {
                return Ok(word);
            }
            continue;
        }
        word.push(char::from(byte));
        if word.len() > MOST_WORD {
            return Err("the picture cannot be decoded: its head does not end".to_owned());
        }
    }
}

/// Read the pixels; `length` is that of the whole file where it is known.
pub(super) fn read(
    input: &mut dyn BufRead,
    length: Option<u64>,
    most: u64,
) -> Result<Pixels, String> {
    let color = word(input)? == "PF";
    let wrong =
        |_| "the picture cannot be decoded: its head must have width, height and scale".to_owned();
    let width: u32 = word(input)?
        .parse()
        .map_err(|error: std::num::ParseIntError| wrong(error.to_string()))?;
    let height: u32 = word(input)?
        .parse()
        .map_err(|error: std::num::ParseIntError| wrong(error.to_string()))?;
    let scale: f32 = word(input)?
        .parse()
        .map_err(|error: std::num::ParseFloatError| wrong(error.to_string()))?;
    let (w, h) = (u64::from(width), u64::from(height));
    check_size(w, h, most.min(MOST_WHOLE))?;
    let values = if color { 3 } else { 1 };
    let bytes = w * h * values * 4;
    if length.is_some_and(|length| length < bytes) {
        return Err(too_little(length.unwrap_or(0), w, h));
    }
    room(2 * bytes)?;
    let mut raw = Vec::new();
    input
        .take(bytes)
        .read_to_end(&mut raw)
        .map_err(|e| after(&e))?;
    if (raw.len() as u64) < bytes {
        return Err(cut());
    }
    let row = (raw.len() / height as usize).max(4);
    let mut list: Vec<f32> = Vec::with_capacity(raw.len() / 4);
    // below zero, the lowest byte comes first
    let number = |four: &[u8]| match (four, scale < 0.0) {
        (&[a, b, c, d], true) => f32::from_le_bytes([a, b, c, d]),
        (&[a, b, c, d], false) => f32::from_be_bytes([a, b, c, d]),
        _ => 0.0,
    };
    for row in raw.chunks_exact(row).rev() {
        list.extend(row.chunks_exact(4).map(number));
    }
    if color {
        let colors = Rgb32FImage::from_raw(width, height, list).ok_or_else(cut)?;
        return Ok(Pixels::FloatColors(Arc::new(colors)));
    }
    let dim = (height as usize, width as usize);
    debug_assert_eq!(as_u32(dim.1), width);
    let list = Array2::from_shape_vec(dim, list).map_err(broken)?;
    Ok(Pixels::Floats(list.into_shared()))
}
