//! A contact sheet of results: each cropped around its object and enlarged.

use std::path::{Path, PathBuf};

use glam::DVec2;
use io::{Picture, RgbImage};

use super::rows::{Row, Truth};
use super::set::Case;
use crate::crop::Crop;

/// Side of a tile. Pixels.
const TILE: u32 = 360;
/// Between two tiles, and around all.
const GAP: u32 = 6;

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
    let points = curves.iter().flat_map(|(curve, _)| curve.iter().copied());
    let mut crop = Crop::about(&picture, points, TILE);
    for (curve, color) in curves {
        crop.draw(curve, true, color);
    }
    Ok(crop.image)
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
