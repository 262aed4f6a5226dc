//! Grids as files of numbers: NPY and TIFF.

use std::io::Cursor;

use field::Grid;
use tiff::encoder::{TiffEncoder, colortype};

use crate::IoError;

/// Grids of one size as a NumPy array of shape (grids, height, width), float64, the least byte first.
///
/// Format 1.0 of NumPy's `.npy`: a head of a multiple of 64 bytes, then the numbers, rows one after the other.
#[must_use]
pub fn npy(grids: &[&Grid]) -> Vec<u8> {
    let (height, width) = grids.first().map_or((0, 0), |grid| grid.dim());
    let mut head = format!(
        "{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {height}, {width}), }}",
        grids.len()
    );
    // magic, version and length take ten bytes, the line's end one
    while (10 + head.len() + 1) % 64 != 0 {
        head.push(' ');
    }
    head.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    // three numbers of twenty digits leave it far below
    let length = u16::try_from(head.len()).unwrap_or(u16::MAX);
    bytes.extend(length.to_le_bytes());
    bytes.extend(head.as_bytes());
    bytes.reserve(8 * grids.len() * width * height);
    for grid in grids {
        for value in *grid {
            bytes.extend(value.to_le_bytes());
        }
    }
    bytes
}

/// Grids as the pages of a TIFF, float32, one channel each.
///
/// # Errors
///
/// A grid without pixels, or more than a TIFF can hold (4 GiB).
pub fn float_tiff(grids: &[&Grid]) -> Result<Vec<u8>, IoError> {
    let refuse = |error: &dyn std::fmt::Display| IoError::Format {
        format: "TIFF",
        message: error.to_string(),
    };
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes).map_err(|e| refuse(&e))?;
    for grid in grids {
        let (height, width) = grid.dim();
        let side = |length: usize| u32::try_from(length).map_err(|e| refuse(&e));
        let (width, height) = (side(width)?, side(height)?);
        #[expect(
            clippy::cast_possible_truncation,
            reason = "the file has 32 bits a number"
        )]
        let numbers: Vec<f32> = grid.iter().map(|&value| value as f32).collect();
        encoder
            .write_image::<colortype::Gray32Float>(width, height, &numbers)
            .map_err(|e| refuse(&e))?;
    }
    Ok(bytes.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;
    use tiff::decoder::{Decoder, DecodingResult};

    fn grids() -> [Grid; 2] {
        let grid = |k: f64| Grid::from_shape_fn((3, 5), move |(y, x)| k * (y * 5 + x) as f64 - 0.1);
        [grid(1.0), grid(-1e-3)]
    }

    #[test]
    fn an_npy_file_is_read_back_by_the_rules_of_the_format() {
        let [a, b] = grids();
        let bytes = npy(&[&a, &b]);
        assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
        let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
        assert_eq!((10 + length) % 64, 0);
        let head = std::str::from_utf8(&bytes[10..10 + length]).unwrap();
        assert!(head.starts_with("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3, 5), }"));
        assert!(head.ends_with(" \n") && head.trim_end().ends_with('}'));
        let (numbers, rest) = bytes[10 + length..].as_chunks::<8>();
        assert!(rest.is_empty());
        let read: Vec<f64> = numbers
            .iter()
            .map(|&word| f64::from_le_bytes(word))
            .collect();
        let given: Vec<f64> = a.iter().chain(&b).copied().collect();
        assert_eq!(read, given);
    }

    #[test]
    fn a_tiff_is_read_back_page_by_page() {
        let [a, b] = grids();
        let bytes = float_tiff(&[&a, &b]).unwrap();
        let mut decoder = Decoder::new(Cursor::new(&bytes)).unwrap();
        for grid in [&a, &b] {
            assert_eq!(decoder.dimensions().unwrap(), (5, 3));
            let DecodingResult::F32(read) = decoder.read_image().unwrap() else {
                unreachable!("not floats");
            };
            let off = read
                .iter()
                .zip(grid)
                .map(|(&r, &g)| (f64::from(r) - g).abs());
            // the last bit of a number below 16 in 24 bits
            assert!(off.fold(0.0, f64::max) < 1e-6);
            if decoder.more_images() {
                decoder.next_image().unwrap();
            }
        }
        assert!(!decoder.more_images());
    }
}
