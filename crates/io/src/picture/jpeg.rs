//! The parts of a JPEG file that its picture is made of, read no further than its end.

use std::io::{BufRead, Read as _};

use image::metadata::Orientation;

use super::source::{Found, after, cut, exact, too_little, too_much};

/// What the head of a frame says.
struct Frame {
    width: u64,
    height: u64,
    /// Blocks of 8 × 8 coefficients.
    blocks: u64,
    progressive: bool,
}

/// Read the file up to its end marker, without profiles, comments and thumbnails; the orientation is kept.
///
/// Bytes after the end marker are not read. A file that ends before it has been cut: the decoder would fill what is
/// missing with grey.
pub(super) fn gather(input: &mut dyn BufRead, most: u64) -> Result<Found, String> {
    let mut found = Found::new(exact::<2>(input)?.to_vec());
    let mut frame: Option<Frame> = None;
    // bytes of coefficients
    let mut coded = 0_u64;
    // the marker that ended the coefficients before
    let mut next = None;
    loop {
        let marker = match next.take() {
            Some(marker) => marker,
            None => marker(input)?,
        };
        match marker {
            0xD9 => break,
            // nothing follows these
            0x01 | 0xD0..=0xD8 => continue,
            _ => {}
        }
        let body = segment(input)?;
        match marker {
            0xE1 if body.starts_with(b"Exif\0\0") => {
                found.orientation = Orientation::from_exif_chunk(&body[6..]);
                continue;
            }
            // profiles, thumbnails, comments: no part of the pixels
            0xE1..=0xED | 0xEF | 0xFE => continue,
            0xC0..=0xCF if !matches!(marker, 0xC4 | 0xC8 | 0xCC) => {
                let head = self::frame(marker, &body)?;
                found.size(head.width, head.height, most)?;
                frame = Some(head);
            }
            _ => {}
        }
        found.bytes.extend([0xFF, marker]);
        let length = u16::try_from(body.len() + 2).unwrap_or(u16::MAX);
        found.bytes.extend(length.to_be_bytes());
        found.bytes.extend(body);
        if marker == 0xDA {
            let Some(frame) = &frame else {
                return Err("the picture cannot be decoded: it has no frame".to_owned());
            };
            // 64 coefficients of 4 bytes are more than any code takes; scans of a progressive picture refine them
            let room = frame.blocks * 256 + (1 << 16);
            let before = found.bytes.len();
            next = Some(scan(input, &mut found.bytes, room.saturating_sub(coded))?);
            coded += (found.bytes.len() - before) as u64;
        }
    }
    found.bytes.extend([0xFF, 0xD9]);
    if let Some(frame) = &frame {
        // a block takes a bit in each of its codes at least: two, or one where scans share them
        let bits = if frame.progressive { 1 } else { 2 };
        if coded < frame.blocks * bits / 8 {
            return Err(too_little(coded, frame.width, frame.height));
        }
        found.working = if frame.progressive {
            frame.blocks * 128
        } else {
            0
        };
    }
    Ok(found)
}

/// The next marker, past fill bytes and whatever else stands before it.
fn marker(input: &mut dyn BufRead) -> Result<u8, String> {
    let mut last = 0;
    loop {
        let [byte] = exact::<1>(input)?;
        if last == 0xFF && byte != 0xFF && byte != 0 {
            return Ok(byte);
        }
        last = byte;
    }
}

/// What a marker is followed by, without its length.
fn segment(input: &mut dyn BufRead) -> Result<Vec<u8>, String> {
    let length = u64::from(u16::from_be_bytes(exact::<2>(input)?));
    let length = length
        .checked_sub(2)
        .ok_or("the picture cannot be decoded: a part of it has no length")?;
    let mut body = Vec::new();
    input
        .take(length)
        .read_to_end(&mut body)
        .map_err(|e| after(&e))?;
    if (body.len() as u64) < length {
        return Err(cut());
    }
    Ok(body)
}

fn frame(marker: u8, body: &[u8]) -> Result<Frame, String> {
    let &[_, h1, h0, w1, w0, count, ref rest @ ..] = body else {
        return Err("the picture cannot be decoded: its frame is too short".to_owned());
    };
    let (height, width) = (u16::from_be_bytes([h1, h0]), u16::from_be_bytes([w1, w0]));
    let (height, width) = (u64::from(height), u64::from(width));
    let sampling: Vec<(u64, u64)> = rest
        .chunks(3)
        .take(usize::from(count))
        .filter_map(|part| part.get(1))
        .map(|&both| (u64::from(both >> 4), u64::from(both & 15)))
        .collect();
    let most = |of: fn(&(u64, u64)) -> u64| sampling.iter().map(of).max().unwrap_or(1).max(1);
    let (h, v) = (most(|s| s.0), most(|s| s.1));
    let blocks = sampling
        .iter()
        .map(|&(across, down)| (width * across).div_ceil(8 * h) * (height * down).div_ceil(8 * v));
    Ok(Frame {
        width,
        height,
        blocks: blocks.sum(),
        progressive: matches!(marker, 0xC2 | 0xC6 | 0xCA | 0xCE),
    })
}

/// Take in coefficients, with their restarts, and return the marker that ends them.
fn scan(input: &mut dyn BufRead, bytes: &mut Vec<u8>, room: u64) -> Result<u8, String> {
    let start = bytes.len();
    let mut before = 0;
    loop {
        let part = input.fill_buf().map_err(|e| after(&e))?;
        if part.is_empty() {
            return Err(cut());
        }
        // a zero hides a byte that only looks like a marker, and bytes of ones may fill
        let ends = |before: u8, byte: u8| {
            before == 0xFF && !matches!(byte, 0 | 0xFF) && !(0xD0..=0xD7).contains(&byte)
        };
        let mut marker = None;
        let mut used = 0;
        for &byte in part {
            used += 1;
            if ends(before, byte) {
                marker = Some(byte);
                break;
            }
            before = byte;
        }
        let taken = used - usize::from(marker.is_some());
        bytes.extend(&part[..taken]);
        input.consume(used);
        if let Some(marker) = marker {
            // the first byte of the marker, and what fills before it
            while bytes.len() > start && bytes.last() == Some(&0xFF) {
                bytes.pop();
            }
            return Ok(marker);
        }
        if (bytes.len() - start) as u64 > room {
            return Err(too_much());
        }
    }
}
