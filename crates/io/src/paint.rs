//! Grids and curves as pictures: plain raster, written as PNG; curves that move, as GIF.

use std::io::Cursor;
use std::path::Path;

use field::Grid;
use glam::DVec2;
use image::{ImageFormat, Rgb, RgbImage};

pub use crate::animation::{Animation, Stroke};
pub use crate::letters::{Lettering, draw_text, text_length};
use crate::picture::as_u32;
use crate::write::write_whole;
use crate::{IoError, Picture};

/// Colors of objects, told apart by every eye (Okabe and Ito, <https://jfly.uni-koeln.de/color/>).
pub const OBJECTS: [[u8; 3]; 5] = [
    [230, 159, 0],
    [86, 180, 233],
    [0, 158, 115],
    [240, 228, 66],
    [204, 121, 167],
];

/// The color of an object by its number, from 1.
#[must_use]
pub const fn color_of(id: u32) -> [u8; 3] {
    OBJECTS[(id.wrapping_sub(1) as usize) % OBJECTS.len()]
}

/// A grey level as a byte: rounded, clamped to 0 … 255.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the range of a byte first"
)]
pub(crate) fn byte(level: f64) -> u8 {
    level.clamp(0.0, 255.0).round() as u8
}

/// A grid as grey, its least value black and its largest white.
#[must_use]
pub fn grey(grid: &Grid) -> RgbImage {
    let (least, largest) = grid
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &v| {
            (a.min(v), b.max(v))
        });
    let span = if largest > least {
        largest - least
    } else {
        1.0
    };
    painted(grid, |v| Rgb([byte(255.0 * (v - least) / span); 3]))
}

/// A signed grid: blue below zero, white at zero, red above, full colour at the largest magnitude.
#[must_use]
pub fn signed(grid: &Grid) -> RgbImage {
    let largest = grid.iter().fold(f64::MIN_POSITIVE, |a, v| a.max(v.abs()));
    painted(grid, |v| {
        let share = v / largest;
        let mix = |end: [f64; 3]| Rgb(end.map(|c| byte(255.0 + (c - 255.0) * share.abs())));
        if share < 0.0 {
            mix([33.0, 102.0, 172.0])
        } else {
            mix([178.0, 24.0, 43.0])
        }
    })
}

/// Vectors as colours: direction is hue, length is saturation, white where there is none.
#[must_use]
pub fn wheel(x: &Grid, y: &Grid) -> RgbImage {
    let length = |v: DVec2| v.length();
    let largest = x
        .iter()
        .zip(y)
        .map(|(&x, &y)| length(DVec2::new(x, y)))
        .fold(f64::MIN_POSITIVE, f64::max);
    RgbImage::from_fn(as_u32(x.ncols()), as_u32(x.nrows()), |column, row| {
        let at = [row as usize, column as usize];
        let v = DVec2::new(x[at], y[at]);
        let share = (length(v) / largest).sqrt();
        let hue = v.y.atan2(v.x);
        let channel = |shift: f64| {
            let full = 0.5 + 0.5 * (hue - shift).cos();
            byte(255.0 * (1.0 - share * (1.0 - full)))
        };
        let third = std::f64::consts::TAU / 3.0;
        Rgb([channel(0.0), channel(third), channel(2.0 * third)])
    })
}

fn painted(grid: &Grid, colour: impl Fn(f64) -> Rgb<u8>) -> RgbImage {
    RgbImage::from_fn(as_u32(grid.ncols()), as_u32(grid.nrows()), |x, y| {
        colour(grid[[y as usize, x as usize]])
    })
}

/// The picture `zoom` times as large, pixels as squares about their centers.
#[must_use]
pub fn enlarged(image: &RgbImage, zoom: f64) -> RgbImage {
    let side = |length: u32| as_u32(index(f64::from(length) * zoom).max(1));
    RgbImage::from_fn(side(image.width()), side(image.height()), |x, y| {
        let at = |i: u32, most: u32| as_u32(index(f64::from(i) / zoom + 0.5)).min(most - 1);
        *image.get_pixel(at(x, image.width()), at(y, image.height()))
    })
}

/// The picture with so many pixels made one, by their mean, that no side is longer than `longest`.
#[must_use]
pub fn shrunk(image: &RgbImage, longest: u32) -> RgbImage {
    let k = image.width().max(image.height()).div_ceil(longest).max(1);
    if k == 1 {
        return image.clone();
    }
    let (width, height) = (image.width().div_ceil(k), image.height().div_ceil(k));
    RgbImage::from_fn(width, height, |x, y| {
        let (mut sum, mut count) = ([0.0; 3], 0.0);
        for row in y * k..((y + 1) * k).min(image.height()) {
            for column in x * k..((x + 1) * k).min(image.width()) {
                let pixel = image.get_pixel(column, row).0;
                for (sum, value) in sum.iter_mut().zip(pixel) {
                    *sum += f64::from(value);
                }
                count += 1.0;
            }
        }
        Rgb(sum.map(|sum| byte(sum / count)))
    })
}

/// The root of every value, with its sign: what is weak is seen too.
pub(crate) fn rooted(grid: &Grid) -> Grid {
    grid.mapv(|v| v.abs().sqrt().copysign(v))
}

/// The picture two thirds of the way to white, as a ground for what is drawn on it.
pub(crate) fn faded(image: &RgbImage) -> RgbImage {
    let mut pale = image.clone();
    for pixel in pale.pixels_mut() {
        pixel.0 = pixel.0.map(|v| 170 + v / 3);
    }
    pale
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a length in pixels, never negative; casting saturates"
)]
const fn index(length: f64) -> usize {
    length as usize
}

/// A curve over a picture, as wide as `width` pixels, its edges softened.
pub fn draw_curve(
    image: &mut RgbImage,
    nodes: &[DVec2],
    closed: bool,
    width: f64,
    colour: [u8; 3],
) {
    let size = image.dimensions();
    covered(size, (nodes, closed), width, |x, y, cover| {
        let pixel = image.get_pixel_mut(x, y);
        for (under, over) in pixel.0.iter_mut().zip(colour) {
            let way = (f64::from(over) - f64::from(*under)) * cover;
            *under = byte(f64::from(*under) + way);
        }
    });
}

/// The pixels that a curve as wide as `width` pixels covers, edge by edge, and how much of each, above 0.
pub(crate) fn covered(
    (columns, rows): (u32, u32),
    (nodes, closed): (&[DVec2], bool),
    width: f64,
    mut each: impl FnMut(u32, u32, f64),
) {
    let segments = if closed {
        nodes.len()
    } else {
        nodes.len().saturating_sub(1)
    };
    let (columns, rows) = (f64::from(columns), f64::from(rows));
    let reach = width / 2.0 + 1.0;
    for i in 0..segments {
        let (a, b) = (nodes[i], nodes[(i + 1) % nodes.len()]);
        let low = (a.min(b) - reach).max(DVec2::ZERO);
        let high = (a.max(b) + reach).min(DVec2::new(columns - 1.0, rows - 1.0));
        let (mut y, along) = (low.y.ceil(), b - a);
        while y <= high.y {
            let mut x = low.x.ceil();
            while x <= high.x {
                let p = DVec2::new(x, y);
                let part = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
                let part = if part.is_finite() { part } else { 0.0 };
                let distance = p.distance(a + along * part);
                let cover = (width / 2.0 + 0.5 - distance).clamp(0.0, 1.0);
                if cover > 0.0 {
                    each(as_u32(index(x)), as_u32(index(y)), cover);
                }
                x += 1.0;
            }
            y += 1.0;
        }
    }
}

/// A picture with curves over it, each with its colour.
#[must_use]
pub fn overlay(picture: &Picture, curves: &[(&[DVec2], bool, [u8; 3])]) -> RgbImage {
    let mut image = picture.shown();
    let width = (f64::from(image.width().max(image.height())) / 250.0).clamp(1.0, 4.0);
    for &(nodes, closed, colour) in curves {
        draw_curve(&mut image, nodes, closed, width, colour);
    }
    image
}

/// The bytes of a PNG file.
///
/// # Errors
///
/// A picture too large for the format.
pub fn png(image: &RgbImage) -> Result<Vec<u8>, IoError> {
    let mut bytes = Cursor::new(Vec::new());
    image
        .write_to(&mut bytes, ImageFormat::Png)
        .map_err(|error| IoError::Format {
            format: "PNG",
            message: error.to_string(),
        })?;
    Ok(bytes.into_inner())
}

/// Write a PNG file, whole or not at all.
///
/// # Errors
///
/// A folder that is not there or cannot be written.
pub fn save_png(image: &RgbImage, path: &Path) -> Result<(), IoError> {
    write_whole(path, &png(image)?)
}
