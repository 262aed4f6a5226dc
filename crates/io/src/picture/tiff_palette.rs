//! Pages of a TIFF whose pixels are numbers of a palette. The decoder knows only grey and colors, so
//! it is shown the page as one of grey, and the colors are looked up behind it.

use std::io::{Read, Seek, SeekFrom};
use std::sync::Arc;

use image::RgbImage;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::{ByteOrder, Tag};

use super::as_u32;
use super::decode::broken;
use super::pixels::Pixels;
use super::source::after;
use super::tiff_file::{unpacked, unsupported};

/// Where a page stands in a file.
pub(super) struct Page {
    /// Its number, from 1.
    pub number: usize,
    /// The offset of its directory.
    pub at: u64,
    pub order: ByteOrder,
}

/// A file of which two bytes are others.
struct Shown<R> {
    file: R,
    at: u64,
    bytes: [u8; 2],
}

impl<R: Read + Seek> Read for Shown<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let from = self.file.stream_position()?;
        let count = self.file.read(buffer)?;
        for (place, byte) in (self.at..).zip(self.bytes) {
            let within = place
                .checked_sub(from)
                .and_then(|i| usize::try_from(i).ok());
            if let Some(own) = within.and_then(|i| buffer[..count].get_mut(i)) {
                *own = byte;
            }
        }
        Ok(count)
    }
}

impl<R: Seek> Seek for Shown<R> {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.file.seek(to)
    }
}

/// Read a page.
pub(super) fn read(
    mut file: impl Read + Seek,
    page: &Page,
    bits: u64,
    limits: Limits,
) -> Result<Pixels, String> {
    let at = entry(&mut file, page)?;
    let grey = 1_u16;
    let bytes = match page.order {
        ByteOrder::LittleEndian => grey.to_le_bytes(),
        ByteOrder::BigEndian => grey.to_be_bytes(),
    };
    file.seek(SeekFrom::Start(0)).map_err(|e| after(&e))?;
    let shown = Shown { file, at, bytes };
    let mut decoder = Decoder::new(shown).map_err(broken)?.with_limits(limits);
    for _ in 1..page.number {
        decoder.next_image().map_err(broken)?;
    }
    let (width, height) = decoder.dimensions().map_err(broken)?;
    let map = decoder.find_tag(Tag::ColorMap).map_err(broken)?;
    let map = map.ok_or("the picture cannot be decoded: its palette is missing")?;
    let map = map.into_u16_vec().map_err(broken)?;
    let list = decoder.read_image().map_err(broken)?;
    let (DecodingResult::U8(list), Ok(bits)) = (list, u32::try_from(bits)) else {
        return Err(unsupported(&format!(
            "its palette has numbers of {bits} bits"
        )));
    };
    let numbers = if bits < 8 {
        // spread over eight bits, and taken back
        let most = (1_u16 << bits) - 1;
        let spread = unpacked(&list, bits, (height as usize, width as usize));
        let back = |v: u8| u8::try_from(u16::from(v) * most / 255).unwrap_or(0);
        spread.into_iter().map(back).collect()
    } else {
        list
    };
    // all reds, all greens, all blues, of sixteen bits each
    let count = 1_usize << bits.min(8);
    let byte = |number: u8, c: usize| {
        let deep = map.get(c * count + usize::from(number));
        deep.map_or(0, |deep| deep.to_be_bytes()[0])
    };
    let colors = numbers.iter().flat_map(|&v| [0, 1, 2].map(|c| byte(v, c)));
    let image = RgbImage::from_raw(as_u32(width as usize), height, colors.collect());
    let image =
        image.ok_or("the picture cannot be decoded: it has fewer pixels than its size says")?;
    Ok(Pixels::Colors(Arc::new(image)))
}

/// The offset of what the directory of a page says about its colors.
fn entry(file: &mut (impl Read + Seek), page: &Page) -> Result<u64, String> {
    let mut bytes = |at: u64, count: usize| -> Result<[u8; 8], String> {
        let mut read = [0; 8];
        file.seek(SeekFrom::Start(at)).map_err(|e| after(&e))?;
        file.read_exact(&mut read[..count]).map_err(|e| after(&e))?;
        Ok(read)
    };
    let little = page.order == ByteOrder::LittleEndian;
    let short = |[a, b, ..]: [u8; 8]| {
        if little {
            u16::from_le_bytes([a, b])
        } else {
            u16::from_be_bytes([a, b])
        }
    };
    let wide = short(bytes(2, 2)?) == 43;
    let (count, begin, step, value) = if wide {
        let eight = bytes(page.at, 8)?;
        let count = if little {
            u64::from_le_bytes(eight)
        } else {
            u64::from_be_bytes(eight)
        };
        (count, 8, 20, 12)
    } else {
        (u64::from(short(bytes(page.at, 2)?)), 2, 12, 8)
    };
    for number in 0..count {
        let at = page.at.saturating_add(begin + step * number);
        if short(bytes(at, 2)?) == Tag::PhotometricInterpretation.to_u16() {
            return Ok(at + value);
        }
    }
    Err("the picture cannot be decoded: it does not say what its colors are".to_owned())
}
