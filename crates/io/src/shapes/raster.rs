//! Outlines as pixels: masks and label images, read and written.
//!
//! A pixel belongs to an outline if its center is inside by the even-odd rule; a center on the
//! border belongs to the side with the larger x. A pixel in several outlines has the number of the
//! one whose pixels have their mean nearest; of equal ones, the first.

use std::io::Cursor;

use glam::DVec2;
use image::{ExtendedColorType, ImageEncoder as _, codecs::png::PngEncoder};

use super::budget::{Budget, cannot};
use super::format::{Context, Format, Reading};
use super::soft::is_soft;
use super::trace::{level_lines, parts};
use super::{Shape, Shapes};
use crate::IoError;
use crate::picture::{Numbers, numbers_of};

/// Crossings of outlines with rows that are followed at once.
const MOST_CROSSINGS: f64 = 1e9;

/// The outlines of a picture, and what people should know of how they were read.
pub(super) fn read(bytes: &[u8], reading: &Reading) -> Result<(Shapes, Option<String>), IoError> {
    let refuse = |what: String| IoError::text(None, what);
    let numbers = numbers_of(bytes).map_err(refuse)?;
    let height = numbers.list.len().checked_div(numbers.width).unwrap_or(0);
    reading.check_size(numbers.width, height).map_err(refuse)?;
    let mut budget = Budget::default();
    let mut format = reading.format;
    let soft = format.is_none() && is_soft(&numbers);
    if soft {
        format = Some(Format::Soft);
    }
    let rings = rings(numbers, format, &mut budget).map_err(refuse)?;
    if rings.is_empty() {
        return Err(refuse(
            "not one pixel of an object; one at least is needed".to_owned(),
        ));
    }
    let shape = |(id, rings): (String, _)| Shape {
        id: Some(id),
        closed: Some(true),
        rings,
        ..Shape::default()
    };
    let note = "its grey lies along the borders of black and white only: read as a soft mask, with the outline halfway";
    let note = soft.then(|| note.to_owned());
    Ok((rings.into_iter().map(shape).collect(), note))
}

/// Objects by their names, each with its rings.
type Named = Vec<(String, Vec<Vec<DVec2>>)>;

/// The rings of each object with its name.
fn rings(numbers: Numbers, format: Option<Format>, budget: &mut Budget) -> Result<Named, String> {
    let Numbers {
        width,
        mut list,
        whole,
        white,
        colors,
    } = numbers;
    budget.pixels(list.len() as u64)?;
    let format = match format {
        Some(format) => format,
        None if !whole => Format::Soft,
        None => {
            let mut objects = list.iter().filter(|v| **v != 0.0);
            let first = objects.next();
            let usual = first.is_none_or(|v| [1.0, white].contains(v) || colors);
            let mask = usual && objects.all(|v| Some(v) == first);
            if mask { Format::Mask } else { Format::Labels }
        }
    };
    if format == Format::Soft {
        if colors {
            return Err("in color; a soft mask must be grey".to_owned());
        }
        list.iter_mut().for_each(|v| *v /= white);
        let lines = level_lines(&list, width, 0.5, budget)?;
        return Ok(lines
            .into_iter()
            .map(|(n, rings)| (n.to_string(), rings))
            .collect());
    }
    if format == Format::Mask {
        let inside: Vec<bool> = list.iter().map(|&v| v != 0.0).collect();
        drop(list);
        let lines = parts(&inside, width, |_, _| false).outlines(budget)?;
        return Ok(lines
            .into_iter()
            .map(|(n, rings)| (n.to_string(), rings))
            .collect());
    }
    if !whole {
        return Err("labels must be whole numbers from 0 to 4294967295".to_owned());
    }
    let name = |label: u32| {
        if colors {
            format!("#{label:06x}")
        } else {
            label.to_string()
        }
    };
    let labels = super::trace::Labels {
        height: list.len().checked_div(width).unwrap_or(0),
        list: list.iter().map(|&v| as_u32(v)).collect(),
        width,
    };
    drop(list);
    let lines = labels.outlines(budget)?;
    Ok(lines
        .into_iter()
        .map(|(n, rings)| (name(n), rings))
        .collect())
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "whole numbers of 32 bits"
)]
const fn as_u32(v: f64) -> u32 {
    v as u32
}

/// A row of pixels in an outline: y, the first x, and the x behind the last.
type Span = (usize, usize, usize);

/// Pixels that outlines may cover together, and rows that they may cross.
const MOST_WORK: f64 = 4e9;

/// The pixels in an outline, row by row; `work` counts what outlines took before.
fn spans(shape: &Shape, width: usize, height: usize, work: &mut f64) -> Result<Vec<Span>, String> {
    if shape.closed == Some(false) {
        return Err("is open; closed outlines are needed".to_owned());
    }
    // edges from their upper to their lower end, with the rows that they cross
    let mut edges: Vec<(usize, usize, DVec2, DVec2)> = Vec::new();
    let mut crossings = 0.0;
    for ring in &shape.rings {
        let mut before = ring.last();
        for b in ring {
            if let Some(&a) = before {
                let (a, b) = if a.y <= b.y { (a, *b) } else { (*b, a) };
                let (first, end) = (row(a.y, height), row(b.y, height));
                if first < end {
                    crossings += (end - first) as f64;
                    edges.push((first, end, a, b));
                }
            }
            before = Some(b);
        }
    }
    if crossings > MOST_CROSSINGS {
        return Err(format!(
            "crosses rows of pixels more than {MOST_CROSSINGS:e} times, which is the most"
        ));
    }
    edges.sort_by_key(|edge| edge.0);
    let mut spans = Vec::new();
    let mut waiting = edges.iter().peekable();
    let mut active: Vec<&(usize, usize, DVec2, DVec2)> = Vec::new();
    let mut at: Vec<f64> = Vec::new();
    let mut y = edges.first().map_or(height, |edge| edge.0);
    while y < height {
        while let Some(edge) = waiting.next_if(|edge| edge.0 <= y) {
            active.push(edge);
        }
        active.retain(|edge| edge.1 > y);
        if active.is_empty() {
            match waiting.peek() {
                Some(edge) => y = edge.0,
                None => break,
            }
            continue;
        }
        at.clear();
        at.extend(active.iter().map(|(_, _, a, b)| {
            let share = (y as f64 - a.y) / (b.y - a.y);
            a.x + share * (b.x - a.x)
        }));
        at.sort_unstable_by(f64::total_cmp);
        for pair in at.chunks_exact(2) {
            let (begin, end) = (row(pair[0], width), row(pair[1], width));
            if begin < end {
                *work += (end - begin) as f64;
                spans.push((y, begin, end));
            }
        }
        y += 1;
    }
    *work += crossings;
    if *work > MOST_WORK {
        return Err(format!(
            "and those before it cover more than {MOST_WORK:e} pixels, which are the most"
        ));
    }
    Ok(spans)
}

/// A part of a picture, and which of its pixels are in an outline, row by row.
pub(crate) struct Boxed {
    pub left: usize,
    pub top: usize,
    pub width: usize,
    pub mask: Vec<bool>,
}

/// The smallest part of a picture that has all pixels of an outline; None if there is none.
pub(crate) fn boxed(
    shape: &Shape,
    [width, height]: [usize; 2],
    budget: &mut Budget,
) -> Result<Option<Boxed>, String> {
    let spans = spans(shape, width, height, &mut 0.0)?;
    let (Some(first), Some(last)) = (spans.first(), spans.last()) else {
        return Ok(None);
    };
    let left = spans.iter().map(|span| span.1).min().unwrap_or(0);
    let right = spans.iter().map(|span| span.2).max().unwrap_or(0);
    let (top, width) = (first.0, right - left);
    let count = width * (last.0 + 1 - top);
    budget.pixels(count as u64)?;
    let mut mask = vec![false; count];
    for (y, begin, end) in spans {
        let row = (y - top) * width;
        mask[row + begin - left..row + end - left].fill(true);
    }
    Ok(Some(Boxed {
        left,
        top,
        width,
        mask,
    }))
}

/// The first whole number not less, from 0 to `most`.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to what a picture has"
)]
const fn row(v: f64, most: usize) -> usize {
    v.ceil().clamp(0.0, most as f64) as usize
}

/// Which pixels are in one of the outlines, row by row.
pub(super) fn mask(shapes: &[Shape], width: usize, height: usize) -> Result<Vec<bool>, IoError> {
    let mut mask = vec![false; width * height];
    let mut work = 0.0;
    for (number, shape) in (1..).zip(shapes) {
        let spans = spans(shape, width, height, &mut work)
            .map_err(|what| cannot("mask", format!("outline {number} {what}")))?;
        for (y, begin, end) in spans {
            mask[y * width + begin..y * width + end].fill(true);
        }
    }
    Ok(mask)
}

/// The number of the outline of each pixel, 0 for none.
pub(crate) fn labels(shapes: &[Shape], width: usize, height: usize) -> Result<Vec<u32>, IoError> {
    let numbers = label_numbers(shapes);
    let mut list = vec![0_u32; width * height];
    // the outline of each pixel by its place, from 1, and the mean of the pixels of each outline
    let mut means: Vec<DVec2> = vec![DVec2::ZERO];
    let mut work = 0.0;
    for (place, shape) in (1_usize..).zip(shapes) {
        let spans = spans(shape, width, height, &mut work)
            .map_err(|what| cannot("labels", format!("outline {place} {what}")))?;
        let (mut sum, mut count) = (DVec2::ZERO, 0.0);
        for &(y, begin, end) in &spans {
            let n = (end - begin) as f64;
            sum += n * DVec2::new((begin + end - 1) as f64 / 2.0, y as f64);
            count += n;
        }
        means.push(if count > 0.0 { sum / count } else { sum });
        for (y, begin, end) in spans {
            for x in begin..end {
                let p = DVec2::new(x as f64, y as f64);
                let own = &mut list[y * width + x];
                let there = p.distance_squared(means[*own as usize]);
                if *own == 0 || p.distance_squared(means[place]) < there {
                    *own = u32::try_from(place).unwrap_or(u32::MAX);
                }
            }
        }
    }
    for own in &mut list {
        if *own > 0 {
            *own = numbers[*own as usize - 1];
        }
    }
    Ok(list)
}

/// The numbers that outlines have in a label image: their ids, if all are whole and different, else
/// their places from 1 on.
fn label_numbers(shapes: &[Shape]) -> Vec<u32> {
    let given = shapes
        .iter()
        .map(|shape| shape.id.as_ref()?.parse::<u32>().ok());
    let given: Option<Vec<u32>> = given.map(|id| id.filter(|&id| id > 0)).collect();
    if let Some(given) = given {
        let different: std::collections::BTreeSet<_> = given.iter().collect();
        if different.len() == given.len() {
            return given;
        }
    }
    (1..).take(shapes.len()).collect()
}

pub(super) fn write(
    shapes: &[Shape],
    format: Format,
    context: &Context,
) -> Result<Vec<u8>, IoError> {
    let (width, height) = (context.width, context.height);
    let size = u32::try_from(width).ok().zip(u32::try_from(height).ok());
    let (w, h) = size.ok_or_else(|| {
        cannot(
            format.name(),
            "a picture of at most 4294967295 pixels a side is needed",
        )
    })?;
    let refuse = |error: &dyn std::fmt::Display| cannot(format.name(), error);
    let mut bytes = Vec::new();
    if format == Format::Mask {
        let mask: Vec<u8> = mask(shapes, width, height)?
            .into_iter()
            .map(|yes| 255 * u8::from(yes))
            .collect();
        let encoder = PngEncoder::new(&mut bytes);
        let written = encoder.write_image(&mask, w, h, ExtendedColorType::L8);
        written.map_err(|error| refuse(&error))?;
        return Ok(bytes);
    }
    let labels = labels(shapes, width, height)?;
    if format == Format::DeepLabels {
        let mut file = Cursor::new(&mut bytes);
        let written = tiff::encoder::TiffEncoder::new(&mut file).and_then(|mut encoder| {
            encoder.write_image::<tiff::encoder::colortype::Gray32>(w, h, &labels)
        });
        written.map_err(|error| refuse(&error))?;
        return Ok(bytes);
    }
    let deep = label_numbers(shapes).into_iter().max().unwrap_or(0);
    if deep > u32::from(u16::MAX) {
        return Err(cannot(
            "labels",
            format!("number {deep}; 16 bits hold at most 65535, deep-labels (TIFF) is needed"),
        ));
    }
    let short = labels.iter().map(|&v| u16::try_from(v).unwrap_or(u16::MAX));
    let raw: Vec<u8> = short.flat_map(u16::to_ne_bytes).collect();
    let encoder = PngEncoder::new(&mut bytes);
    let written = encoder.write_image(&raw, w, h, ExtendedColorType::L16);
    written.map_err(|error| refuse(&error))?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::rings::inside;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_pixel_is_in_if_its_center_is(
            points in prop::collection::vec((-4.0..14.0_f64, -4.0..14.0_f64), 3..12),
        ) {
            let ring: Vec<DVec2> = points.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
            let found = mask(&[Shape::curve(ring.clone(), Some(true))], 11, 9).unwrap();
            for at in 0..99 {
                let p = DVec2::new((at % 11) as f64, (at / 11) as f64);
                prop_assert_eq!(found[at], inside(&ring, p), "{}", p);
            }
        }
    }

    #[test]
    fn a_pixel_in_two_outlines_belongs_to_the_nearer_mean() {
        let square = |x: f64| {
            let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];
            let ring = corners.map(|(a, b)| DVec2::new(x + a - 0.5, b - 0.5));
            Shape::curve(ring.to_vec(), Some(true))
        };
        let found = labels(&[square(0.0), square(2.0)], 6, 4).unwrap();
        assert_eq!(found[..6], [1, 1, 1, 2, 2, 2]);
    }
}
