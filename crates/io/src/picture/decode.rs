//! From the bytes of a picture file to grey levels.

use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, Read, Seek, SeekFrom};
use std::path::Path;
use std::sync::Arc;

use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use ndarray::{Array2, Axis};

use super::finite::{finite, grid, masked_colors};
use super::pixels::Pixels;
use super::source::{Found, after, check_size, cut};
use super::tiff_file::{self, Grey};
use super::{Picture, PictureReading, jpeg, pfm, png, pnm, webp};
use crate::limits::{MOST_PIXELS, MOST_STREAM, MOST_WHOLE};
use crate::text::clip_to;

/// What to say instead of every other kind of file.
const WANTED: &str = "a PNG, JPEG, TIFF, PGM, PPM, PFM or WebP picture";

/// Bytes that tell what a file is.
const HEAD: u64 = 64;

/// Read a picture file, or standard input for `-`. Its head is looked at first, and no more is read than the picture
/// takes, so that an endless file is not read to its end.
pub(super) fn load(path: &Path, rule: &PictureReading) -> Result<Picture, String> {
    let unread = |e: std::io::Error| format!("cannot be read: {e}; {WANTED} is needed");
    if path.as_os_str() == "-" {
        return stream(std::io::stdin().lock(), rule);
    }
    let mut file = File::open(path).map_err(unread)?;
    let data = file.metadata().map_err(unread)?;
    if !data.is_file() {
        return stream(file, rule);
    }
    let mut head = Vec::new();
    let mut first = (&mut file).take(HEAD);
    first.read_to_end(&mut head).map_err(unread)?;
    file.seek(SeekFrom::Start(0)).map_err(unread)?;
    let known = format(&head)?;
    let mut reader = BufReader::new(file);
    if known == Known::Tiff {
        return tiff(&mut reader, data.len(), MOST_PIXELS, rule);
    }
    in_order(known, &mut reader, Some(data.len()), MOST_PIXELS, rule)
}

/// Read a picture from what can be read only once.
fn stream(mut input: impl Read, rule: &PictureReading) -> Result<Picture, String> {
    let unread = |e: std::io::Error| format!("cannot be read: {e}; {WANTED} is needed");
    let mut head = Vec::new();
    let mut first = input.by_ref().take(HEAD);
    first.read_to_end(&mut head).map_err(unread)?;
    let known = format(&head)?;
    let mut whole = BufReader::new(Cursor::new(head).chain(input));
    if known != Known::Tiff {
        return in_order(known, &mut whole, None, MOST_PIXELS, rule);
    }
    // a TIFF is read in any order
    let mut bytes = Vec::new();
    let mut most = whole.take(MOST_STREAM + 1);
    most.read_to_end(&mut bytes).map_err(unread)?;
    if bytes.len() as u64 > MOST_STREAM {
        return Err(format!(
            "holds more than {} MiB; through a pipe at most so much is read",
            MOST_STREAM >> 20
        ));
    }
    decode(&bytes, MOST_PIXELS, rule)
}

/// Kinds of pictures that are read.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Known {
    Png,
    Jpeg,
    Tiff,
    Webp,
    Pnm,
    Pfm,
}

/// What a file is by its first bytes.
fn format(head: &[u8]) -> Result<Known, String> {
    if head.is_empty() {
        return Err(format!("the file is empty; {WANTED} is needed"));
    }
    // with offsets of 64 bits
    if head.starts_with(b"II+\0") || head.starts_with(b"MM\0+") {
        return Ok(Known::Tiff);
    }
    if pfm::is_one(head) {
        return Ok(Known::Pfm);
    }
    match image::guess_format(head) {
        Ok(ImageFormat::Png) => Ok(Known::Png),
        Ok(ImageFormat::Jpeg) => Ok(Known::Jpeg),
        Ok(ImageFormat::Tiff) => Ok(Known::Tiff),
        Ok(ImageFormat::WebP) => Ok(Known::Webp),
        Ok(ImageFormat::Pnm) => Ok(Known::Pnm),
        Ok(other) => Err(format!(
            "a picture of the format {}, which this program does not read; {WANTED} is needed",
            other.extensions_str().first().unwrap_or(&"unknown")
        )),
        Err(_) => Err(format!(
            "not a picture this program reads; {WANTED} is needed"
        )),
    }
}

/// A picture of at most `most` pixels from the bytes of a file.
pub(super) fn decode(bytes: &[u8], most: u64, rule: &PictureReading) -> Result<Picture, String> {
    let known = format(bytes)?;
    let length = bytes.len() as u64;
    let mut reader = Cursor::new(bytes);
    if known == Known::Tiff {
        return tiff(&mut reader, length, most, rule);
    }
    in_order(known, &mut reader, Some(length), most, rule)
}

/// A picture of a format that is read from its beginning to its end.
pub(super) fn in_order(
    known: Known,
    input: &mut dyn BufRead,
    length: Option<u64>,
    most: u64,
    rule: &PictureReading,
) -> Result<Picture, String> {
    if rule.page.is_some_and(|page| page != 1) {
        return Err("the picture file has one page; no other can be asked for".to_owned());
    }
    let (mut found, format) = match known {
        Known::Jpeg => (jpeg::gather(input, most)?, ImageFormat::Jpeg),
        Known::Png => (png::gather(input, most)?, ImageFormat::Png),
        Known::Webp => (webp::gather(input)?, ImageFormat::WebP),
        Known::Pfm => return of_channel(finite(pfm::read(input, length, most)?, rule)?, rule),
        Known::Pnm | Known::Tiff => {
            let head = pnm::head(input, length, most)?;
            let data = Cursor::new(head.bytes).chain(input.take(head.data));
            let decoder = image::codecs::pnm::PnmDecoder::new(data).map_err(broken)?;
            return image(decoder, Found::new(Vec::new()), most, rule);
        }
    };
    // handed on, so that it is not kept twice
    let bytes = std::mem::take(&mut found.bytes);
    let many = bytes.len() as u64;
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(Limits::no_limits());
    let mut decoder = reader.into_decoder().map_err(broken)?;
    if known == Known::Webp {
        let (width, height) = decoder.dimensions();
        webp::enough(many, u64::from(width), u64::from(height))?;
        found.orientation = decoder.orientation().ok();
    }
    image(decoder, found, most, rule)
}

/// A picture from a decoder that has read its head.
fn image(
    decoder: impl ImageDecoder,
    found: Found,
    most: u64,
    rule: &PictureReading,
) -> Result<Picture, String> {
    let (width, height) = decoder.dimensions();
    let (width, height) = (u64::from(width), u64::from(height));
    check_size(width, height, most)?;
    let turned = turned(found.orientation, rule);
    let color = decoder.color_type();
    if color.bytes_per_pixel() > 4 {
        check_size(width, height, most.min(MOST_WHOLE))?;
    }
    let bytes = decoder.total_bytes();
    // the pixels, those without alpha, and those turned
    let copies = 1 + u64::from(color.has_alpha()) + u64::from(turned != Orientation::NoTransforms);
    room(bytes.saturating_mul(copies).saturating_add(found.working))?;
    let mut image = DynamicImage::from_decoder(decoder).map_err(broken)?;
    image.apply_orientation(turned);
    let mut picture = from_image(image, rule)?;
    picture.notes.splice(..0, found.notes);
    picture.notes.extend(note(turned));
    picture.pixel_size = found.pixel_size.map(|size| size.turned(turned));
    of_channel(picture, rule)
}

/// How to turn a picture, if it is to be.
fn turned(orientation: Option<Orientation>, rule: &PictureReading) -> Orientation {
    orientation
        .filter(|_| !rule.as_stored)
        .unwrap_or(Orientation::NoTransforms)
}

/// The channel of a picture in color that is asked for.
fn of_channel(mut picture: Picture, rule: &PictureReading) -> Result<Picture, String> {
    let Some(wanted) = &rule.channel else {
        return Ok(picture);
    };
    let names = picture.pixels.channel_names();
    let at = tiff_file::channel(wanted, names)?;
    picture.pixels = picture.pixels.one(at).unwrap_or(picture.pixels);
    let of = Picture::of_pixels(picture.pixels);
    Ok(Picture {
        valid: picture.valid,
        notes: picture.notes,
        pixel_size: picture.pixel_size,
        ..of
    })
}

/// A picture from a TIFF file, which is read in any order.
pub(super) fn tiff<R: BufRead + Seek>(
    reader: &mut R,
    length: u64,
    most: u64,
    rule: &PictureReading,
) -> Result<Picture, String> {
    let head = tiff_file::read(&mut *reader, length, most, rule)?;
    let turned = turned(head.orientation, rule);
    let Some(grey) = head.grey else {
        reader.seek(SeekFrom::Start(0)).map_err(|e| after(&e))?;
        let mut decoder = image::codecs::tiff::TiffDecoder::new(reader).map_err(broken)?;
        let mut limits = Limits::no_limits();
        limits.max_alloc = Some(decoder.total_bytes().saturating_mul(4).max(16 << 20));
        decoder.set_limits(limits).map_err(broken)?;
        let mut found = Found::new(Vec::new());
        (found.orientation, found.notes) = (Some(turned), head.notes);
        found.pixel_size = head.pixel_size;
        return image(decoder, found, most, rule);
    };
    let mut picture = match grey {
        Grey::Pixels(pixels) => Picture::of_pixels(pixels.turned(turned)),
        Grey::Masked(pixels, valid) => {
            let mut picture = Picture::of_pixels(pixels.turned(turned));
            picture.mask_alpha(upright(valid, turned));
            picture
        }
        Grey::Levels(levels) => {
            let (levels, valid) = grid(upright(levels, turned), rule)?;
            let mut picture = Picture::from_levels(levels);
            (picture.valid, picture.deep) = (valid, true);
            picture
        }
    };
    picture.notes.splice(..0, head.notes);
    picture.notes.extend(note(turned));
    picture.pixel_size = head.pixel_size.map(|size| size.turned(turned));
    Ok(picture)
}

/// What to say of a picture that is stored otherwise than it is looked at.
fn note(turned: Orientation) -> Option<String> {
    (turned != Orientation::NoTransforms).then(|| {
        format!(
            "the picture is stored turned (orientation {}): x and y are those of the picture upright",
            turned.to_exif()
        )
    })
}

/// A grid as it is looked at.
pub(super) fn upright<T: Clone>(grid: Array2<T>, orientation: Orientation) -> Array2<T> {
    // whether rows become columns, and which axes run the other way after that
    let (across, back_x, back_y) = match orientation {
        Orientation::NoTransforms => return grid,
        Orientation::FlipHorizontal => (false, true, false),
        Orientation::Rotate180 => (false, true, true),
        Orientation::FlipVertical => (false, false, true),
        Orientation::Rotate90FlipH => (true, false, false),
        Orientation::Rotate90 => (true, true, false),
        Orientation::Rotate270FlipH => (true, true, true),
        Orientation::Rotate270 => (true, false, true),
    };
    let mut view = if across { grid.t() } else { grid.view() };
    if back_x {
        view.invert_axis(Axis(1));
    }
    if back_y {
        view.invert_axis(Axis(0));
    }
    view.as_standard_layout().into_owned()
}

/// Refuse what there is no memory for, before anything is done.
pub(super) fn room(bytes: u64) -> Result<(), String> {
    crate::limits::room(bytes)
        .map_err(|message| format!("the picture {message}; a smaller one is needed"))
}

/// What to say of a file that cannot be decoded.
pub(crate) fn broken(error: impl std::fmt::Display) -> String {
    let error = clip_to(&error.to_string(), 160);
    if error.contains("unexpected end of file") || error.contains("failed to fill whole buffer") {
        return cut();
    }
    format!("the picture cannot be decoded: {error}; a whole one of a usual kind is needed")
}

fn from_image(image: DynamicImage, rule: &PictureReading) -> Result<Picture, String> {
    let dim = (image.height() as usize, image.width() as usize);
    let bytes = |list| Array2::from_shape_vec(dim, list).map_err(broken);
    let words = |list| Array2::from_shape_vec(dim, list).map_err(broken);
    let seen = seen(&image, dim)?;
    let pixels = match image {
        DynamicImage::ImageLuma8(i) => Pixels::Bytes(bytes(i.into_raw())?.into_shared()),
        DynamicImage::ImageLumaA8(i) => {
            Pixels::Bytes(bytes(i.pixels().map(|p| p.0[0]).collect())?.into_shared())
        }
        DynamicImage::ImageLuma16(i) => Pixels::Words(words(i.into_raw())?.into_shared()),
        DynamicImage::ImageLumaA16(i) => {
            Pixels::Words(words(i.pixels().map(|p| p.0[0]).collect())?.into_shared())
        }
        DynamicImage::ImageRgb16(_) | DynamicImage::ImageRgba16(_) => {
            Pixels::DeepColors(Arc::new(image.into_rgb16()))
        }
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
            let colors = image.into_rgb32f();
            if colors.iter().all(|v| v.is_finite()) {
                Pixels::FloatColors(Arc::new(colors))
            } else {
                return masked_colors(colors, dim, rule);
            }
        }
        other => {
            let colors = other.into_rgb8();
            if colors.pixels().any(|p| !is_grey(p.0)) {
                Pixels::Colors(Arc::new(colors))
            } else {
                let grey = bytes(colors.pixels().map(|p| p.0[0]).collect())?;
                Pixels::Bytes(grey.into_shared())
            }
        }
    };
    let mut picture = Picture::of_pixels(pixels);
    if let Some(seen) = seen {
        picture.mask_alpha(seen);
    }
    Ok(picture)
}

/// Which pixels are seen at all; None if nothing is said of it.
fn seen(image: &DynamicImage, dim: (usize, usize)) -> Result<Option<Array2<bool>>, String> {
    let list: Vec<bool> = match image {
        DynamicImage::ImageLumaA8(i) => i.pixels().map(|p| p.0[1] > 0).collect(),
        DynamicImage::ImageLumaA16(i) => i.pixels().map(|p| p.0[1] > 0).collect(),
        DynamicImage::ImageRgba8(i) => i.pixels().map(|p| p.0[3] > 0).collect(),
        DynamicImage::ImageRgba16(i) => i.pixels().map(|p| p.0[3] > 0).collect(),
        DynamicImage::ImageRgba32F(i) => i.pixels().map(|p| p.0[3] > 0.0).collect(),
        _ => return Ok(None),
    };
    Array2::from_shape_vec(dim, list).map(Some).map_err(broken)
}

pub(super) fn is_grey<T: PartialEq>([r, g, b]: [T; 3]) -> bool {
    r == g && g == b
}
