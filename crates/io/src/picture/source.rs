//! The bytes of a picture file, of which no more is read than the picture takes.

use std::io::{BufRead, Error, Read as _};

use image::metadata::Orientation;

use super::PixelSize;

/// Bytes of a description that are looked at.
pub(super) const MOST_DESCRIPTION: usize = 1 << 20;

/// What is needed of a file: a smaller one that holds the same picture, and what the file says about it.
#[derive(Debug)]
pub(super) struct Found {
    pub bytes: Vec<u8>,
    pub orientation: Option<Orientation>,
    pub pixel_size: Option<PixelSize>,
    /// Bytes that the decoder holds besides the pixels.
    pub working: u64,
    /// What people should know of the picture.
    pub notes: Vec<String>,
}

impl Found {
    pub(super) fn new(bytes: Vec<u8>) -> Self {
        Self {
            bytes,
            orientation: None,
            pixel_size: None,
            working: 0,
            notes: Vec::new(),
        }
    }

    /// Refuse a picture without a pixel, or of more than `most`.
    pub(super) fn size(&self, width: u64, height: u64, most: u64) -> Result<(), String> {
        check_size(width, height, most)
    }
}

/// Refuse a picture without a pixel, or too large to hold in memory.
pub(super) fn check_size(width: u64, height: u64, most: u64) -> Result<(), String> {
    let pixels = width.saturating_mul(height);
    if pixels == 0 {
        return Err(format!(
            "the picture is {width}×{height}; it must have at least one pixel"
        ));
    }
    if pixels > most {
        return Err(format!(
            "the picture is {width}×{height}, {pixels} pixels; it must have at most {most}"
        ));
    }
    Ok(())
}

/// Read a few bytes, all of them.
pub(super) fn exact<const N: usize>(input: &mut dyn BufRead) -> Result<[u8; N], String> {
    let mut bytes = [0; N];
    input.read_exact(&mut bytes).map_err(|e| after(&e))?;
    Ok(bytes)
}

/// Pass over bytes without keeping them.
pub(super) fn skip(input: &mut dyn BufRead, length: u64) -> Result<(), String> {
    let passed = std::io::copy(&mut input.take(length), &mut std::io::sink());
    match passed {
        Ok(passed) if passed == length => Ok(()),
        Ok(_) => Err(cut()),
        Err(error) => Err(after(&error)),
    }
}

/// An error on the way through a file.
pub(super) fn after(error: &Error) -> String {
    if error.kind() == std::io::ErrorKind::UnexpectedEof {
        cut()
    } else {
        format!("cannot be read: {error}")
    }
}

/// What to say of a file that has been cut.
pub(super) fn cut() -> String {
    "the picture cannot be decoded: the file ends before the picture does; a whole one is needed"
        .to_owned()
}

/// What to say of a head that promises more than the file holds.
pub(super) fn too_little(bytes: u64, width: u64, height: u64) -> String {
    format!(
        "the picture cannot be decoded: {bytes} bytes cannot hold its {width}×{height} pixels; \
         a whole one is needed"
    )
}

/// What to say of a file that holds more than its head promises.
pub(super) fn too_much() -> String {
    "the picture cannot be decoded: the file holds more data than its size explains".to_owned()
}
