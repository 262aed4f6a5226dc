//! A contact sheet of results: each cropped around its object and enlarged.

use std::path::{Path, PathBuf};

use glam::DVec2;
use io::{Picture, RgbImage, paint};

use super::rows::{Row, Truth};
use super::set::Case;

/// Side of a tile. Pixels.
const TILE: u32 = 360;
/// Between two tiles, and around all.
const GAP: u32 = 6;
/// Around the curves, as a share of their size.
const MARGIN: f64 = 0.12;
/// A range of levels below this is stretched to be seen.
const DIM: u8 = 128;

/// Colors of the truth, the start and the outline found.
pub(super) const TRUTH: [u8; 3] = [0, 190, 0];
const START: [u8; 3] = [86, 180, 233];
pub(super) const FOUND: [u8; 3] = [230, 97, 1];

/// The indices of the worst rows, the worst first; of equals the first.
pub(super) fn worst(rows: &[Row], most: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..rows.len()).collect();
    order.sort_by(|&a, &b| rows[a].iou().total_cmp(&rows[b].iou()));
    order.truncate(most);
    order
}

/// One result as a picture.
///
/// # Errors
///
/// Files that cannot be read again.
pub(super) fn tile(row: &Row, case: &Case) -> Result<RgbImage, String> {
    let picture = Picture::load(&case.picture).map_err(|error| error.to_string())?;
    let truth = Truth::load(&case.mask, picture.size())?;
    let found = row.found.as_ref().map(|(curve, _)| curve);
    let mut curves: Vec<(&[DVec2], [u8; 3])> =
        truth.rings.iter().map(|ring| (&ring[..], TRUTH)).collect();
    curves.push((&row.start, START));
    curves.extend(found.map(|curve| (&curve[..], FOUND)));
    let (width, height) = picture.size();
    let last = DVec2::new(width as f64, height as f64) - 1.0;
    let points = curves.iter().flat_map(|(curve, _)| curve.iter());
    let within = points.map(|p| p.clamp(DVec2::ZERO, last));
    let (low, high) = within.fold((last, DVec2::ZERO), |(low, high), p| {
        (low.min(p), high.max(p))
    });
    let room = MARGIN * (high - low).max_element();
    let low = (low - room).max(DVec2::ZERO).floor();
    let high = (high + room).min(last).ceil();
    let zoom = f64::from(TILE - 1) / (high - low + 1.0).max_element();
    let mut image = paint::enlarged(&cropped(picture.display(), low, high), zoom);
    for (curve, color) in curves {
        let drawn: Vec<DVec2> = curve.iter().map(|p| (*p - low) * zoom).collect();
        paint::draw_curve(&mut image, &drawn, true, 2.0, color);
    }
    Ok(image)
}

/// A part of a picture, its levels stretched if they are all much alike.
fn cropped(image: &RgbImage, low: DVec2, high: DVec2) -> RgbImage {
    let size = high - low + 1.0;
    let part = RgbImage::from_fn(whole(size.x), whole(size.y), |x, y| {
        *image.get_pixel(whole(low.x) + x, whole(low.y) + y)
    });
    let mut levels: Vec<u8> = part.pixels().flat_map(|pixel| pixel.0).collect();
    levels.sort_unstable();
    let count = levels.len();
    let (dark, bright) = (levels[count / 100], levels[count - 1 - count / 100]);
    if bright - dark >= DIM || bright == dark {
        return part;
    }
    let stretched = |level: u8| {
        let share = u32::from(level.clamp(dark, bright) - dark) * 255;
        u8::try_from(share / u32::from(bright - dark)).unwrap_or(u8::MAX)
    };
    let mut part = part;
    part.pixels_mut()
        .for_each(|pixel| pixel.0 = pixel.0.map(stretched));
    part
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a whole number of pixels within a picture"
)]
const fn whole(length: f64) -> u32 {
    length as u32
}

/// All tiles on one white sheet, by rows, so many a row.
pub(super) fn sheet(tiles: &[RgbImage], columns: usize) -> RgbImage {
    let side = |count: usize| u32::try_from(count).unwrap_or(1) * (TILE + GAP) + GAP;
    let size = (side(columns), side(tiles.len().div_ceil(columns)));
    let mut sheet = RgbImage::from_pixel(size.0, size.1, [255; 3].into());
    for (index, tile) in tiles.iter().enumerate() {
        let (left, top) = (side(index % columns), side(index / columns));
        for (x, y, pixel) in tile.enumerate_pixels() {
            sheet.put_pixel(left + x, top + y, *pixel);
        }
    }
    sheet
}

/// How many tiles a row has.
pub(super) fn columns(tiles: usize) -> usize {
    (1..=6)
        .find(|columns| columns * columns >= tiles)
        .unwrap_or(6)
}

/// Whether all go onto one sheet: the name ends in .png.
pub(super) fn is_one(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("png"))
}

/// The file of one result in a folder.
pub(super) fn file(folder: &Path, place: usize, row: &Row) -> PathBuf {
    folder.join(format!(
        "{:03}_{}_{}.png",
        place + 1,
        plain(&row.stem),
        plain(&row.quality)
    ))
}

/// The file of a whole picture in a folder.
pub(super) fn plain_file(folder: &Path, stem: &str) -> PathBuf {
    folder.join(format!("{}.png", plain(stem)))
}

/// A name without characters that a file cannot have.
fn plain(text: &str) -> String {
    text.chars()
        .map(|c| {
            if c.is_alphanumeric() || "-_+.".contains(c) {
                c
            } else {
                '_'
            }
        })
        .take(60)
        .collect()
}
