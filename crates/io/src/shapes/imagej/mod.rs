//! `ImageJ` ROI files, one alone or many in a ZIP.
//!
//! Coordinates of areas count from the corner of the first pixel, those of lines and points from
//! its center, as `ImageJ` draws them. Written are floats of 32 bits: 24 bits of each number.

mod archive;
mod decode;
mod encode;

pub(crate) use encode::roi;

use super::budget::{Budget, cannot};
use super::format::Reading;
use super::{Shape, Shapes};
use crate::IoError;

/// Types of outlines by their number.
const POLYGON: u8 = 0;
const RECTANGLE: u8 = 1;
const OVAL: u8 = 2;
const LINE: u8 = 3;
const FREELINE: u8 = 4;
const POLYLINE: u8 = 5;
const FREEHAND: u8 = 7;
const TRACED: u8 = 8;
const ANGLE: u8 = 9;
const POINT: u8 = 10;

/// Where things stand in a file, by their offset.
const COORDINATES: usize = 64;
/// The option that floats stand behind the whole numbers.
const SUBPIXEL: u16 = 128;

pub(super) fn read(bytes: &[u8], reading: &Reading) -> Result<Shapes, IoError> {
    let mut budget = Budget::default();
    if bytes.starts_with(b"Iout") {
        let shapes = decode::shapes(bytes, reading, &mut budget);
        return shapes.map_err(|what| IoError::text(None, what));
    }
    archive::read(bytes, reading, &mut budget)
}

/// Outlines as a ZIP of ROIs.
pub(super) fn write(shapes: &[Shape]) -> Result<Vec<u8>, IoError> {
    let refuse = |what: String| cannot("imagej", what);
    let each = (1..).zip(shapes).map(|(number, shape)| {
        roi(shape).map_err(|what| refuse(format!("outline {number} {what}")))
    });
    let files: Vec<Vec<u8>> = each.collect::<Result<_, _>>()?;
    archive::write(shapes, &files).map_err(refuse)
}

/// One outline as a ROI.
pub(super) fn write_one(shapes: &[Shape]) -> Result<Vec<u8>, IoError> {
    let refuse = |what: String| cannot("roi", what);
    match shapes {
        [shape] => roi(shape).map_err(|what| refuse(format!("outline 1 {what}"))),
        _ => {
            let got = shapes.len();
            Err(refuse(format!(
                "a ROI is one outline, got {got}; a ZIP of them holds several"
            )))
        }
    }
}
