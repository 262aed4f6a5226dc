//! TIFF files: what the general reader does not know of them, and what is said of those that nothing here reads.

use std::io::{BufRead, Seek};

use image::metadata::Orientation;
use ndarray::Array2;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

use super::decode::{broken, room};
use super::pixels::Pixels;
use super::source::{check_size, too_little};
use super::tiff_palette::{self, Page};
use super::{PictureReading, PixelSize, tiff_bands, tiff_size};
use crate::limits::MOST_WHOLE;
use crate::text::clip_to;

/// Bytes of a table of strips or tiles.
const MOST_TABLE: usize = 16 << 20;

/// What a file says before its pixels are read.
pub(super) struct Head {
    pub orientation: Option<Orientation>,
    pub notes: Vec<String>,
    /// How large a pixel is.
    pub pixel_size: Option<PixelSize>,
    /// Its pixels, if they are read here: of one channel, of a palette, of another page;
    /// None if the general reader is to read them.
    pub grey: Option<Grey>,
}

/// Pixels that are read.
pub(super) enum Grey {
    Pixels(Pixels),
    /// Pixels of which some do not count.
    Masked(Pixels, Array2<bool>),
    /// Levels, not all of them finite, perhaps.
    Levels(Array2<f64>),
}

/// Compressions by the number of tag 259, and whether they are read.
const COMPRESSIONS: [(u64, &str, bool); 15] = [
    (1, "none", true),
    (2, "CCITT RLE", false),
    (3, "CCITT fax 3", true),
    (4, "CCITT fax 4", true),
    (5, "LZW", true),
    (6, "old JPEG", false),
    (7, "JPEG", true),
    (8, "Deflate", true),
    (32773, "PackBits", true),
    (32946, "Deflate", true),
    (34712, "JPEG 2000", false),
    (34887, "LERC", false),
    (34925, "LZMA", false),
    (50000, "ZSTD", false),
    (50001, "WebP", false),
];

/// Read the head of a file of `length` bytes, and its pixels if they are of one channel.
pub(super) fn read(
    mut reader: impl BufRead + Seek,
    length: u64,
    most: u64,
    rule: &PictureReading,
) -> Result<Head, String> {
    let mut decoder = Decoder::new(&mut reader).map_err(broken)?;
    let mut notes = Vec::new();
    if decoder.more_images() && rule.page.is_none() {
        notes.push("the picture file holds several pages: the first is taken".to_owned());
    }
    let said = tiff_size::said(&mut decoder);
    let wanted = tiff_bands::find(&mut decoder, &said, rule)?;
    let pixel_size = said.pixel_size;
    let tag = |decoder: &mut Decoder<_>, tag: Tag| decoder.find_tag_unsigned::<u64>(tag);
    let orientation = tag(&mut decoder, Tag::Orientation).unwrap_or_default();
    let orientation = orientation.and_then(|number| u8::try_from(number).ok());
    let orientation = orientation.and_then(Orientation::from_exif);
    let compression = tag(&mut decoder, Tag::Compression).map_err(broken)?;
    let compression = compression.unwrap_or(1);
    known_compression(compression)?;
    let photometric = tag(&mut decoder, Tag::PhotometricInterpretation).map_err(broken)?;
    let (width, height) = decoder.dimensions().map_err(broken)?;
    let (width, height) = (u64::from(width), u64::from(height));
    check_size(width, height, most)?;
    if photometric == Some(3) {
        let bits = tag(&mut decoder, Tag::BitsPerSample)
            .map_err(broken)?
            .unwrap_or(1);
        enough(compression, bits, [width, height, length])?;
        room(width * height * 5)?;
        let page = Page {
            number: wanted.page,
            at: decoder.ifd_pointer().map_or(0, |pointer| pointer.0),
            order: decoder.byte_order(),
        };
        let pixels = tiff_palette::read(reader, &page, bits, limits(width * height, length))?;
        let pixels = match &wanted.channel {
            Some(name) => {
                let at = channel(name, pixels.channel_names())?;
                pixels.one(at).unwrap_or(pixels)
            }
            None => pixels,
        };
        return Ok(Head {
            orientation,
            notes,
            pixel_size,
            grey: Some(Grey::Pixels(pixels)),
        });
    }
    let color = match decoder.colortype() {
        Ok(color) => color,
        Err(error) => return Err(unsupported(&error.to_string())),
    };
    let samples = u64::from(color.num_samples());
    let several = samples > 1 && (wanted.channel.is_some() || wanted.page > 1);
    if several || matches!(color, tiff::ColorType::Multiband { .. }) {
        let bits = samples * u64::from(color.bit_depth());
        enough(compression, bits, [width, height, length])?;
        let bytes = width * height * bits.div_ceil(8);
        if bits / samples > 16 || samples > 4 {
            check_size(width, height, most.min(MOST_WHOLE))?;
        }
        room(bytes.saturating_mul(3))?;
        let mut decoder = decoder.with_limits(limits(bytes, length));
        let grey = tiff_bands::read(&mut decoder, &wanted)?;
        return Ok(Head {
            orientation,
            notes,
            pixel_size,
            grey: Some(grey),
        });
    }
    let bits = match color {
        tiff::ColorType::Gray(bits) => bits,
        other => {
            let samples = u64::from(other.num_samples());
            let bits = samples * u64::from(other.bit_depth());
            enough(compression, bits, [width, height, length])?;
            room(width * height * bits.div_ceil(8) * 2)?;
            return Ok(Head {
                orientation,
                notes,
                pixel_size,
                grey: None,
            });
        }
    };
    enough(compression, u64::from(bits), [width, height, length])?;
    let formats = decoder.find_tag_unsigned_vec::<u64>(Tag::SampleFormat);
    let format = formats
        .ok()
        .flatten()
        .and_then(|list| list.first().copied());
    let format = format.unwrap_or(1);
    let known = match format {
        1 => matches!(bits, 1 | 2 | 4 | 8 | 16 | 32),
        2 => matches!(bits, 8 | 16 | 32),
        3 => matches!(bits, 16 | 32 | 64),
        _ => false,
    };
    if !known {
        let kind = match format {
            1 => "whole numbers",
            2 => "signed whole numbers",
            3 => "floats",
            _ => "numbers of an unknown kind",
        };
        return Err(unsupported(&format!(
            "its pixels are {kind} of {bits} bits"
        )));
    }
    if format == 3 || bits > 16 {
        check_size(width, height, most.min(MOST_WHOLE))?;
    }
    let bytes = width * height * u64::from(bits).div_ceil(8);
    room(2 * bytes)?;
    let mut decoder = decoder.with_limits(limits(bytes, length));
    let read = decoder.read_image().map_err(broken)?;
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a picture that has been decoded is in memory"
    )]
    let dim = (height as usize, width as usize);
    let grey = grey(read, u32::from(bits), dim)?;
    Ok(Head {
        orientation,
        notes,
        pixel_size,
        grey: Some(grey),
    })
}

/// What the decoder may take for so many bytes of pixels in a file of `length`.
fn limits(bytes: u64, length: u64) -> Limits {
    let mut limits = Limits::default();
    let most = usize::try_from(bytes.max(1 << 20)).unwrap_or(usize::MAX);
    limits.decoding_buffer_size = most;
    limits.intermediate_buffer_size = most.max(usize::try_from(length).unwrap_or(usize::MAX));
    limits.ifd_value_size = MOST_TABLE;
    limits
}

/// The number from 0 of the channel that is called so, among channels of these names.
pub(super) fn channel(wanted: &str, names: &[impl AsRef<str>]) -> Result<usize, String> {
    let same = |name: &&str| name.eq_ignore_ascii_case(wanted.trim());
    let each = names.iter().map(AsRef::as_ref);
    if let Some(at) = each.clone().position(|name| same(&name)) {
        return Ok(at);
    }
    let number = wanted.trim().parse::<usize>().ok();
    if let Some(number) = number.filter(|number| (1..=names.len()).contains(number)) {
        return Ok(number - 1);
    }
    let all: Vec<String> = each.take(20).map(|name| clip_to(name, 30)).collect();
    Err(format!(
        "no channel is called {}; the channels are {} ({})",
        clip_to(wanted, 30),
        all.join(", "),
        names.len()
    ))
}

pub(super) fn grey(read: DecodingResult, bits: u32, dim: (usize, usize)) -> Result<Grey, String> {
    fn shaped<T>(dim: (usize, usize), list: Vec<T>) -> Result<Array2<T>, String> {
        Array2::from_shape_vec(dim, list).map_err(broken)
    }
    let pixels = match read {
        DecodingResult::U8(list) if bits < 8 => {
            Pixels::Bytes(shaped(dim, unpacked(&list, bits, dim))?.into_shared())
        }
        DecodingResult::U8(list) => Pixels::Bytes(shaped(dim, list)?.into_shared()),
        DecodingResult::U16(list) => Pixels::Words(shaped(dim, list)?.into_shared()),
        DecodingResult::I8(list) => {
            let wide = list.iter().map(|&v| i16::from(v) * 257).collect();
            Pixels::Signed(shaped(dim, wide)?.into_shared())
        }
        DecodingResult::I16(list) => Pixels::Signed(shaped(dim, list)?.into_shared()),
        DecodingResult::U32(list) => Pixels::Long(shaped(dim, list)?.into_shared()),
        DecodingResult::I32(list) => Pixels::SignedLong(shaped(dim, list)?.into_shared()),
        DecodingResult::F16(list) => {
            floats(shaped(dim, list.iter().map(|v| v.to_f32()).collect())?)
        }
        DecodingResult::F32(list) => floats(shaped(dim, list)?),
        DecodingResult::F64(mut list) => {
            list.iter_mut().for_each(|v| *v *= 255.0);
            return Ok(Grey::Levels(shaped(dim, list)?));
        }
        _ => {
            return Err(unsupported(
                "its pixels are whole numbers of more than 32 bits",
            ));
        }
    };
    match pixels {
        Pixels::Floats(list) if !list.iter().all(|v| v.is_finite()) => {
            Ok(Grey::Levels(list.mapv(|v| f64::from(v) * 255.0)))
        }
        pixels => Ok(Grey::Pixels(pixels)),
    }
}

fn floats(list: Array2<f32>) -> Pixels {
    Pixels::Floats(list.into_shared())
}

/// Pixels of less than eight bits, each row beginning with a new byte; the largest number is white.
pub(super) fn unpacked(list: &[u8], bits: u32, (height, width): (usize, usize)) -> Vec<u8> {
    let row = (width * bits as usize).div_ceil(8);
    let most = (1_u16 << bits) - 1;
    let each = 8 / bits as usize;
    let mut pixels = Vec::with_capacity(width * height);
    for row in list.chunks(row.max(1)).take(height) {
        for x in 0..width {
            let shift = 8 - bits as usize * (x % each + 1);
            let value = u16::from(row.get(x / each).copied().unwrap_or(0) >> shift) & most;
            pixels.push(u8::try_from(value * 255 / most).unwrap_or(u8::MAX));
        }
    }
    pixels
}

fn known_compression(number: u64) -> Result<(), String> {
    let found = COMPRESSIONS.iter().find(|(known, ..)| *known == number);
    match found {
        Some((_, _, true)) => Ok(()),
        _ => {
            let name = found.map_or("an unknown one", |(_, name, _)| name);
            let read = "none, PackBits, LZW, Deflate, JPEG or CCITT fax";
            Err(format!(
                "a TIFF of this kind is not supported: its compression is {name} ({number}); {read} is needed"
            ))
        }
    }
}

pub(super) fn unsupported(what: &str) -> String {
    format!(
        "a TIFF of this kind is not supported: {}; grey of up to 32 bits, RGB of 8 or 16 bits, or floats, are needed",
        clip_to(what, 160)
    )
}

/// Refuse a file that is too short for its pixels, as they are compressed.
fn enough(compression: u64, bits: u64, [width, height, length]: [u64; 3]) -> Result<(), String> {
    let raw = (width * bits).div_ceil(8).saturating_mul(height);
    let most = match compression {
        1 => 1,
        32773 => 64,
        8 | 32946 => super::png::MOST_DEFLATED,
        // strings of up to 4096 bytes in codes of 12 bits; 256 pixels of a JPEG in a byte
        _ => 4096,
    };
    if raw / most > length {
        return Err(too_little(length, width, height));
    }
    Ok(())
}
