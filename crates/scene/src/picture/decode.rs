//! From the bytes of a picture file to grey levels.

use std::fs::File;
use std::io::{Cursor, Read as _};
use std::path::Path;
use std::sync::{Arc, OnceLock};

use field::Grid;
use image::{ColorType, DynamicImage, ImageDecoder as _, ImageFormat, ImageReader, Limits, Rgb};
use ndarray::Array2;
use tiff::decoder::{Decoder, DecodingResult};

use super::pixels::{Pixels, luma};
use super::{Invalid, Picture};
use crate::error::clip;
use crate::limits::{MOST_PIXEL_BYTES, MOST_PIXELS, MOST_WHOLE};

/// What to say instead of every other kind of file.
const WANTED: &str = "a PNG, JPEG, TIFF, PGM or PPM picture";

/// Bytes that tell what a file is.
const HEAD: u64 = 64;

/// Read a picture file. Its head is looked at first, so that an endless file that is no picture is
/// not read to its end.
pub(super) fn load(path: &Path, invalid: Invalid) -> Result<Picture, String> {
    let unread = |e: std::io::Error| format!("cannot be read: {e}; {WANTED} would do");
    let mut file = File::open(path).map_err(unread)?;
    let mut bytes = Vec::new();
    let mut head = file.by_ref().take(HEAD);
    head.read_to_end(&mut bytes).map_err(unread)?;
    format(&bytes)?;
    let most = MOST_PIXELS * MOST_PIXEL_BYTES;
    file.take(most).read_to_end(&mut bytes).map_err(unread)?;
    decode(&bytes, MOST_PIXELS, invalid)
}

/// What a file is by its first bytes.
fn format(head: &[u8]) -> Result<ImageFormat, String> {
    if head.is_empty() {
        return Err(format!("the file is empty; {WANTED} would do"));
    }
    match image::guess_format(head) {
        Ok(
            known @ (ImageFormat::Png | ImageFormat::Jpeg | ImageFormat::Tiff | ImageFormat::Pnm),
        ) => Ok(known),
        _ => Err(format!(
            "not a picture this program reads; {WANTED} would do"
        )),
    }
}

/// A picture of at most `most` pixels from the bytes of a file.
pub(super) fn decode(bytes: &[u8], most: u64, invalid: Invalid) -> Result<Picture, String> {
    let format = format(bytes)?;
    if format == ImageFormat::Tiff
        && let Some(picture) = grey_floats(bytes, most, invalid)?
    {
        return Ok(picture);
    }
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut limits = Limits::default();
    limits.max_alloc = Some(most.saturating_mul(MOST_PIXEL_BYTES).max(1 << 20));
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(broken)?;
    let kept = matches!(
        decoder.color_type(),
        ColorType::L8 | ColorType::L16 | ColorType::Rgb8
    );
    let most = if kept { most } else { most.min(MOST_WHOLE) };
    check_size(decoder.dimensions(), most)?;
    let image = DynamicImage::from_decoder(decoder).map_err(broken)?;
    from_image(image, invalid)
}

/// Refuse a picture without a pixel, or too large to hold in memory.
fn check_size((width, height): (u32, u32), most: u64) -> Result<(), String> {
    let pixels = u64::from(width) * u64::from(height);
    if pixels == 0 {
        return Err(format!(
            "the picture is {width}×{height}; at least one pixel would do"
        ));
    }
    if pixels > most {
        return Err(format!(
            "the picture is {width}×{height}, {pixels} pixels; at most {most} would do"
        ));
    }
    Ok(())
}

/// A TIFF of one float a pixel, which the general reader does not know; None if it is another one.
fn grey_floats(bytes: &[u8], most: u64, invalid: Invalid) -> Result<Option<Picture>, String> {
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(broken)?;
    if !matches!(decoder.colortype(), Ok(tiff::ColorType::Gray(32 | 64))) {
        return Ok(None);
    }
    let (width, height) = decoder.dimensions().map_err(broken)?;
    let most = most.min(MOST_WHOLE);
    check_size((width, height), most)?;
    let mut limits = tiff::decoder::Limits::default();
    let bytes = most.saturating_mul(MOST_PIXEL_BYTES).max(1 << 20);
    limits.decoding_buffer_size = usize::try_from(bytes).unwrap_or(usize::MAX);
    limits.intermediate_buffer_size = limits.decoding_buffer_size;
    let levels: Vec<f64> = match decoder.with_limits(limits).read_image().map_err(broken)? {
        DecodingResult::F32(list) => list.iter().map(|&v| f64::from(v) * 255.0).collect(),
        DecodingResult::F64(list) => list.iter().map(|&v| v * 255.0).collect(),
        _ => {
            return Err(
                "its pixels are whole numbers of 32 bits or more; 8 or 16 bits or floats \
                        would do"
                    .to_owned(),
            );
        }
    };
    let (levels, valid) = grid(width as usize, height as usize, levels, invalid)?;
    let mut picture = Picture::from_levels(levels);
    picture.valid = valid;
    Ok(Some(picture))
}

/// Grey levels as a grid, all of them finite, and which of them count.
fn grid(
    width: usize,
    height: usize,
    mut levels: Vec<f64>,
    invalid: Invalid,
) -> Result<(Grid, Option<Array2<bool>>), String> {
    let mut valid = None;
    if let Some(at) = levels.iter().position(|v| !v.is_finite()) {
        let (x, y, level) = (at % width.max(1), at / width.max(1), levels[at]);
        if invalid == Invalid::Refuse {
            return Err(format!(
                "pixel ({x}, {y}) is {level}; finite numbers would do, or invalid = \"mask\""
            ));
        }
        let Some(&first) = levels.iter().find(|v| v.is_finite()) else {
            return Err("not one of its pixels is a number; one would do".to_owned());
        };
        let counts = levels.iter().map(|v| v.is_finite()).collect();
        valid = Some(Array2::from_shape_vec((height, width), counts).map_err(broken)?);
        for level in &mut levels {
            if !level.is_finite() {
                *level = first;
            }
        }
    }
    let levels = Grid::from_shape_vec((height, width), levels).map_err(broken)?;
    Ok((levels, valid))
}

fn broken(error: impl std::fmt::Display) -> String {
    let error = clip(&error.to_string());
    format!("the picture cannot be decoded: {error}; a whole one would do")
}

fn from_image(image: DynamicImage, invalid: Invalid) -> Result<Picture, String> {
    let size @ (width, height) = (image.width() as usize, image.height() as usize);
    let dim = (height, width);
    let bytes = |list| Array2::from_shape_vec(dim, list).map_err(broken);
    let words = |list| Array2::from_shape_vec(dim, list).map_err(broken);
    let pixels = match image {
        DynamicImage::ImageLuma8(i) => Pixels::Bytes(bytes(i.into_raw())?.into_shared()),
        DynamicImage::ImageLumaA8(i) => {
            Pixels::Bytes(bytes(i.pixels().map(|p| p.0[0]).collect())?.into_shared())
        }
        DynamicImage::ImageLuma16(i) => Pixels::Words(words(i.into_raw())?.into_shared()),
        DynamicImage::ImageLumaA16(i) => {
            Pixels::Words(words(i.pixels().map(|p| p.0[0]).collect())?.into_shared())
        }
        DynamicImage::ImageRgb16(_)
        | DynamicImage::ImageRgba16(_)
        | DynamicImage::ImageRgb32F(_)
        | DynamicImage::ImageRgba32F(_) => return from_deep(&image, invalid),
        other => {
            let colors = other.into_rgb8();
            if !colors.pixels().any(|p| !is_grey(p.0)) {
                let grey = bytes(colors.pixels().map(|p| p.0[0]).collect())?;
                return Ok(Picture::of(size, Pixels::Bytes(grey.into_shared())));
            }
            let mut picture = Picture::of(size, Pixels::Colors(Arc::new(colors)));
            picture.color = true;
            return Ok(picture);
        }
    };
    Ok(Picture::of(size, pixels))
}

/// Colors of more than eight bits.
fn from_deep(image: &DynamicImage, invalid: Invalid) -> Result<Picture, String> {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let deep: Vec<[f32; 3]>;
    let levels: Vec<f64>;
    match image {
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
            let pixels = image.to_rgb32f();
            let level = |p: &Rgb<f32>| luma(p.0.map(|v| f64::from(v) * 255.0));
            levels = pixels.pixels().map(level).collect();
            // what is no number does not count
            let finite = |v: f32| if v.is_finite() { v * 255.0 } else { 0.0 };
            deep = pixels.pixels().map(|p| p.0.map(finite)).collect();
        }
        _ => {
            let pixels = image.to_rgb16();
            let level = |p: &Rgb<u16>| luma(p.0.map(|v| f64::from(v) / 257.0));
            levels = pixels.pixels().map(level).collect();
            let shallow = |p: &Rgb<u16>| p.0.map(|v| f32::from(v) / 257.0);
            deep = pixels.pixels().map(shallow).collect();
        }
    }
    let (levels, valid) = grid(width, height, levels, invalid)?;
    let mut picture = Picture::from_levels(levels);
    picture.display = OnceLock::from(image.to_rgb8());
    picture.valid = valid;
    if !deep.iter().all(|p| is_grey(p.map(f32::to_bits))) {
        picture.color = true;
        picture.deep = Some(Arc::new(deep));
    }
    Ok(picture)
}

fn is_grey<T: PartialEq>([r, g, b]: [T; 3]) -> bool {
    r == g && g == b
}
