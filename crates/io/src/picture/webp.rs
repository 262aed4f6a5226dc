//! The bytes of a WebP file, read no further than its head says.

use std::io::{BufRead, Read as _};

use super::source::{Found, after, cut, exact, too_little};

/// Pixels that a byte can stand for: lossless areas of one color take next to nothing.
const MOST_PIXELS: u64 = 1 << 16;

/// Bytes besides, of a head.
const HEAD: u64 = 12;

/// Read the whole file.
pub(super) fn gather(input: &mut dyn BufRead) -> Result<Found, String> {
    let mut found = Found::new(exact::<8>(input)?.to_vec());
    let &[_, _, _, _, a, b, c, d] = &found.bytes[..] else {
        return Err(cut());
    };
    let length = u64::from(u32::from_le_bytes([a, b, c, d]));
    let read = input.take(length).read_to_end(&mut found.bytes);
    if (read.map_err(|e| after(&e))? as u64) < length {
        return Err(cut());
    }
    Ok(found)
}

/// Refuse a file that is too short for its pixels.
pub(super) fn enough(length: u64, width: u64, height: u64) -> Result<(), String> {
    if width * height / MOST_PIXELS > length.saturating_sub(HEAD) {
        return Err(too_little(length, width, height));
    }
    Ok(())
}
