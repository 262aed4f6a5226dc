//! The parts of a PNG file that its picture is made of, read no further than its end.

use std::io::{BufRead, Read as _};

use image::metadata::Orientation;

use super::PixelSize;
use super::source::{Found, after, cut, exact, skip, too_little, too_much};

/// The largest factor by which deflate makes anything smaller.
pub(super) const MOST_DEFLATED: u64 = 1032;

/// Bytes of a palette, or of what is transparent in it.
const MOST_SMALL: u64 = 1024;

/// Read the file up to its end chunk: head, palette and pixels; of the rest only the orientation is kept, so that no
/// profile or text is inflated.
pub(super) fn gather(input: &mut dyn BufRead, most: u64) -> Result<Found, String> {
    let mut found = Found::new(exact::<8>(input)?.to_vec());
    let (mut width, mut height, mut raw) = (0_u64, 0_u64, None);
    let mut coded = 0_u64;
    loop {
        let length = exact::<4>(input)?;
        let name = exact::<4>(input)?;
        let bytes = u64::from(u32::from_be_bytes(length));
        let kept = match &name {
            b"IHDR" | b"PLTE" | b"tRNS" => bytes <= MOST_SMALL,
            b"IDAT" | b"IEND" => true,
            b"eXIf" if bytes <= 1 << 16 => {
                let mut body = Vec::new();
                input
                    .take(bytes)
                    .read_to_end(&mut body)
                    .map_err(|e| after(&e))?;
                found.orientation = Orientation::from_exif_chunk(&body);
                skip(input, 4)?;
                continue;
            }
            b"pHYs" if bytes == 9 => {
                let [x3, x2, x1, x0, y3, y2, y1, y0, unit] = exact::<9>(input)?;
                let meters = |each: [u8; 4]| 1.0 / f64::from(u32::from_be_bytes(each));
                let (x, y) = (meters([x3, x2, x1, x0]), meters([y3, y2, y1, y0]));
                if unit == 1 {
                    found.pixel_size = PixelSize::new(x, y, "m");
                }
                skip(input, 4)?;
                continue;
            }
            b"acTL" => {
                let note = "the picture is an animation: its still picture is taken";
                found.notes.push(note.to_owned());
                false
            }
            _ => false,
        };
        if !kept {
            skip(input, bytes + 4)?;
            continue;
        }
        if &name == b"IDAT" {
            coded += bytes;
            // stored as it is, deflate adds five bytes to every block of at least some hundred
            let Some(raw) = raw else {
                return Err("the picture cannot be decoded: it has no head".to_owned());
            };
            if coded > raw + raw / 16 + (1 << 16) {
                return Err(too_much());
            }
        }
        found.bytes.extend(length);
        found.bytes.extend(name);
        let start = found.bytes.len();
        let read = input.take(bytes + 4).read_to_end(&mut found.bytes);
        if (read.map_err(|e| after(&e))? as u64) < bytes + 4 {
            return Err(cut());
        }
        if &name == b"IHDR" {
            let body = &found.bytes[start..];
            (width, height, raw) = head(body)?;
            found.size(width, height, most)?;
        }
        if &name == b"IEND" {
            break;
        }
    }
    if raw.is_some_and(|raw| coded.saturating_mul(MOST_DEFLATED) < raw) {
        return Err(too_little(coded, width, height));
    }
    Ok(found)
}

/// Width, height and bytes before they are deflated.
fn head(body: &[u8]) -> Result<(u64, u64, Option<u64>), String> {
    let &[w3, w2, w1, w0, h3, h2, h1, h0, depth, color, ..] = body else {
        return Err("the picture cannot be decoded: its head is too short".to_owned());
    };
    let width = u64::from(u32::from_be_bytes([w3, w2, w1, w0]));
    let height = u64::from(u32::from_be_bytes([h3, h2, h1, h0]));
    let channels = match color {
        2 => 3,
        4 => 2,
        6 => 4,
        _ => 1,
    };
    let row = |width: u64| {
        let bits = width.saturating_mul(channels * u64::from(depth));
        bits.div_ceil(8) + 1
    };
    let raw = row(width).saturating_mul(height);
    Ok((width, height, Some(raw)))
}
