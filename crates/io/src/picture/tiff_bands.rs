//! Pages of a TIFF, and pixels of several samples: colors and channels.

use std::io::{BufRead, Seek};
use std::sync::Arc;

use image::{ImageBuffer, RgbImage};
use ndarray::Array2;
use tiff::ColorType;
use tiff::decoder::{Decoder, DecodingResult};
use tiff::tags::Tag;

use super::PictureReading;
use super::decode::broken;
use super::pixels::Pixels;
use super::tiff_file::{Grey, channel, grey, unsupported};
use super::tiff_size::Said;

/// What of a file is wanted.
#[derive(Debug)]
pub(super) struct Wanted {
    /// The page, from 1.
    pub page: usize,
    /// The channel of the page.
    pub channel: Option<String>,
}

/// Go to the page that is wanted.
pub(super) fn find<R: BufRead + Seek>(
    decoder: &mut Decoder<R>,
    said: &Said,
    rule: &PictureReading,
) -> Result<Wanted, String> {
    let mut page = rule.page.unwrap_or(1);
    if page == 0 {
        return Err("page 0 is asked for; pages are numbered from 1".to_owned());
    }
    let mut own = rule.channel.clone();
    if !said.channels.is_empty()
        && let Some(wanted) = own.take()
    {
        page = (page - 1)
            .saturating_mul(said.channels.len())
            .saturating_add(channel(&wanted, &said.channels)? + 1);
    }
    for number in 1..page {
        if !decoder.more_images() {
            return Err(format!(
                "page {page} is asked for; the picture file has {number}"
            ));
        }
        decoder.next_image().map_err(broken)?;
    }
    Ok(Wanted { page, channel: own })
}

/// The samples of a page, one after another or in planes.
struct Samples {
    count: usize,
    planes: bool,
    pixels: usize,
}

impl Samples {
    /// One sample of every pixel.
    fn one<T: Copy>(&self, list: &[T], at: usize) -> Vec<T> {
        if self.planes {
            return list
                .iter()
                .skip(at * self.pixels)
                .take(self.pixels)
                .copied()
                .collect();
        }
        list.iter().skip(at).step_by(self.count).copied().collect()
    }

    /// The first three samples of every pixel.
    fn three<T: Copy>(&self, list: &[T]) -> Option<Vec<T>> {
        let step = if self.planes { self.pixels } else { 1 };
        let begin = |i: usize| if self.planes { i } else { i * self.count };
        let each = (0..self.pixels).flat_map(|i| (0..3).map(move |c| begin(i) + c * step));
        each.map(|at| list.get(at).copied()).collect()
    }
}

/// Read the page on which the decoder stands.
pub(super) fn read<R: BufRead + Seek>(
    decoder: &mut Decoder<R>,
    wanted: &Wanted,
) -> Result<Grey, String> {
    let color = decoder.colortype().map_err(broken)?;
    let (width, height) = decoder.dimensions().map_err(broken)?;
    let dim = (height as usize, width as usize);
    let planes = decoder
        .find_tag_unsigned::<u64>(Tag::PlanarConfiguration)
        .map_err(broken)?
        == Some(2);
    let samples = Samples {
        count: usize::from(color.num_samples()),
        planes,
        pixels: dim.0 * dim.1,
    };
    let bits = color.bit_depth();
    let mut list = DecodingResult::U8(Vec::new());
    decoder.read_image_to_buffer(&mut list).map_err(broken)?;
    if bits < 8 {
        return Err(unsupported(&format!(
            "it has {} samples of {bits} bits a pixel",
            samples.count
        )));
    }
    let names: Vec<String> = match color {
        ColorType::RGB(_) => ["red", "green", "blue"].map(str::to_owned).to_vec(),
        ColorType::RGBA(_) => ["red", "green", "blue", "alpha"]
            .map(str::to_owned)
            .to_vec(),
        ColorType::GrayA(_) => ["grey", "alpha"].map(str::to_owned).to_vec(),
        _ => (1..=samples.count)
            .map(|number| number.to_string())
            .collect(),
    };
    if let Some(name) = &wanted.channel {
        let at = channel(name, &names)?;
        return grey(one(&list, &samples, at), u32::from(bits), dim);
    }
    let seen = |at: usize| -> Result<Array2<bool>, String> {
        let seen: Vec<bool> = match one(&list, &samples, at) {
            DecodingResult::U8(list) => list.iter().map(|&v| v > 0).collect(),
            DecodingResult::U16(list) => list.iter().map(|&v| v > 0).collect(),
            _ => vec![true; samples.pixels],
        };
        Array2::from_shape_vec(dim, seen).map_err(broken)
    };
    match color {
        ColorType::RGB(_) | ColorType::RGBA(_) => {
            let pixels = match &list {
                DecodingResult::U8(list) => {
                    let three = samples
                        .three(list)
                        .and_then(|list| RgbImage::from_raw(width, height, list));
                    three.map(|image| Pixels::Colors(Arc::new(image)))
                }
                DecodingResult::U16(list) => {
                    let three = samples
                        .three(list)
                        .and_then(|list| ImageBuffer::from_raw(width, height, list));
                    three.map(|image| Pixels::DeepColors(Arc::new(image)))
                }
                _ => None,
            };
            let pixels =
                pixels.ok_or_else(|| unsupported("its colors are of neither 8 nor 16 bits"))?;
            if matches!(color, ColorType::RGBA(_)) {
                return Ok(Grey::Masked(pixels, seen(3)?));
            }
            Ok(Grey::Pixels(pixels))
        }
        ColorType::GrayA(_) => match grey(one(&list, &samples, 0), u32::from(bits), dim)? {
            Grey::Pixels(pixels) => Ok(Grey::Masked(pixels, seen(1)?)),
            other => Ok(other),
        },
        _ => Err(format!(
            "it has {} channels of {bits} bits without a word on their colors; one of them is needed",
            samples.count
        )),
    }
}

/// One sample of every pixel.
fn one(list: &DecodingResult, samples: &Samples, at: usize) -> DecodingResult {
    match list {
        DecodingResult::U8(list) => DecodingResult::U8(samples.one(list, at)),
        DecodingResult::U16(list) => DecodingResult::U16(samples.one(list, at)),
        DecodingResult::U32(list) => DecodingResult::U32(samples.one(list, at)),
        DecodingResult::U64(list) => DecodingResult::U64(samples.one(list, at)),
        DecodingResult::F16(list) => DecodingResult::F16(samples.one(list, at)),
        DecodingResult::F32(list) => DecodingResult::F32(samples.one(list, at)),
        DecodingResult::F64(list) => DecodingResult::F64(samples.one(list, at)),
        DecodingResult::I8(list) => DecodingResult::I8(samples.one(list, at)),
        DecodingResult::I16(list) => DecodingResult::I16(samples.one(list, at)),
        DecodingResult::I32(list) => DecodingResult::I32(samples.one(list, at)),
        DecodingResult::I64(list) => DecodingResult::I64(samples.one(list, at)),
    }
}
