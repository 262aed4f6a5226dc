//! Pictures that are one of many in a file or a stream.

use std::io::{BufRead, Seek};

use super::decode::{Known, in_order, tiff};
use super::{Picture, PictureReading};
use crate::limits::MOST_PIXELS;

/// A picture from a TIFF of so many bytes.
pub(crate) fn decode_tiff<R: BufRead + Seek>(
    reader: &mut R,
    length: u64,
    rule: &PictureReading,
) -> Result<Picture, String> {
    tiff(reader, length, MOST_PIXELS, rule)
}

/// The next of the pictures that stand one behind the other in a stream of PGM or PPM; None where it has ended.
pub(crate) fn decode_next(
    input: &mut dyn BufRead,
    rule: &PictureReading,
) -> Result<Option<Picture>, String> {
    let there = |e: std::io::Error| format!("cannot be read: {e}");
    let begin = input.fill_buf().map_err(there)?;
    match begin {
        [] => return Ok(None),
        [b'P', ..] => {}
        _ => return Err(format!("the stream has no picture here; {STREAMED}")),
    }
    in_order(Known::Pnm, input, None, MOST_PIXELS, rule).map(Some)
}

/// What to say of another stream.
const STREAMED: &str = "PGM or PPM pictures one behind the other are needed";
