//! A film as an animated PNG: each frame is a PNG of what has changed, whose data stand in chunks of the whole.
//!
//! (The chunks: <https://www.w3.org/TR/png-3/#apng-frame-based-animation>.)

use std::io::{BufWriter, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder as _, RgbImage, imageops};

use super::changed;
use crate::IoError;
use crate::write::{Whole, unwritable};

/// What every PNG begins with, and where the chunk stands that counts frames: behind the head.
const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
const COUNT_AT: u64 = 8 + 25;

#[derive(Debug)]
pub(super) struct Apng {
    path: PathBuf,
    size: (u32, u32),
    hold: u16,
    file: Whole,
    writer: BufWriter<std::fs::File>,
    frames: u32,
    /// Chunks of frames, which are counted.
    chunks: u32,
    shown: Option<RgbImage>,
}

impl Apng {
    pub(super) fn begin(path: &Path, size: (u32, u32), hold: u16) -> Result<Self, IoError> {
        let mut file = Whole::begin(path)?;
        let Some(beside) = file.file() else {
            return Err(IoError::file(
                path,
                "an animated PNG is written in any order; the name of a file is needed",
            ));
        };
        let writer = beside
            .as_file()
            .try_clone()
            .map_err(|error| unwritable(path, error))?;
        let mut all = Self {
            path: path.to_owned(),
            size,
            hold,
            file,
            writer: BufWriter::new(writer),
            frames: 0,
            chunks: 0,
            shown: None,
        };
        let mut head = [size.0.to_be_bytes(), size.1.to_be_bytes()].concat();
        // eight bits of red, green and blue; deflated, filtered, rows in order
        head.extend([8, 2, 0, 0, 0]);
        all.put(SIGNATURE)?;
        all.chunk(b"IHDR", &head)?;
        all.chunk(b"acTL", &[0; 8])?;
        Ok(all)
    }

    fn put(&mut self, bytes: &[u8]) -> Result<(), IoError> {
        let written = self.writer.write_all(bytes);
        written.map_err(|error| unwritable(&self.path, error))
    }

    fn chunk(&mut self, kind: &[u8; 4], data: &[u8]) -> Result<(), IoError> {
        let length = u32::try_from(data.len()).map_err(|error| unwritable(&self.path, error))?;
        let body = [&kind[..], data].concat();
        self.put(&length.to_be_bytes())?;
        self.put(&body)?;
        self.put(&checksum(&body).to_be_bytes())
    }

    /// The number of the next chunk of a frame.
    const fn number(&mut self) -> [u8; 4] {
        let number = self.chunks;
        self.chunks += 1;
        number.to_be_bytes()
    }

    pub(super) fn show(&mut self, frame: &RgbImage) -> Result<(), IoError> {
        let [left, top, width, height] = match &self.shown {
            None => [0, 0, self.size.0, self.size.1],
            Some(shown) => {
                let (old, new) = (shown.as_raw(), frame.as_raw());
                changed(self.size, |at| {
                    old[3 * at..3 * at + 3] == new[3 * at..3 * at + 3]
                })
            }
        };
        let part = imageops::crop_imm(frame, left, top, width, height).to_image();
        let mut bytes = Vec::new();
        let encoder = PngEncoder::new_with_quality(
            &mut bytes,
            CompressionType::Default,
            FilterType::Adaptive,
        );
        let written = encoder.write_image(part.as_raw(), width, height, ExtendedColorType::Rgb8);
        written.map_err(|error| unwritable(&self.path, error))?;
        let mut control = self.number().to_vec();
        control.extend(
            [width, height, left, top]
                .into_iter()
                .flat_map(u32::to_be_bytes),
        );
        control.extend(self.hold.to_be_bytes());
        control.extend(100_u16.to_be_bytes());
        // what was shown stays, and what is new replaces it
        control.extend([0, 0]);
        self.chunk(b"fcTL", &control)?;
        for data in data_of(&bytes) {
            if self.frames == 0 {
                self.chunk(b"IDAT", data)?;
            } else {
                let numbered = [&self.number()[..], data].concat();
                self.chunk(b"fdAT", &numbered)?;
            }
        }
        self.frames += 1;
        self.shown = Some(frame.clone());
        Ok(())
    }

    pub(super) fn end(mut self) -> Result<(), IoError> {
        if self.frames == 0 {
            return Err(unwritable(&self.path, "a film has no frame"));
        }
        self.chunk(b"IEND", &[])?;
        let place = self.writer.seek(SeekFrom::Start(COUNT_AT));
        place.map_err(|error| unwritable(&self.path, error))?;
        // so many frames, shown again and again
        let count = [self.frames.to_be_bytes(), [0; 4]].concat();
        self.chunk(b"acTL", &count)?;
        self.writer
            .flush()
            .map_err(|error| unwritable(&self.path, error))?;
        drop(self.writer);
        self.file.end()
    }
}

/// The data of the chunks of a PNG that hold its pixels.
fn data_of(png: &[u8]) -> Vec<&[u8]> {
    let mut list = Vec::new();
    let mut rest = png.get(SIGNATURE.len()..).unwrap_or_default();
    while let Some((length, after)) = rest.split_first_chunk::<4>() {
        let length = usize::try_from(u32::from_be_bytes(*length)).unwrap_or(usize::MAX);
        let Some((kind, after)) = after.split_first_chunk::<4>() else {
            break;
        };
        let Some((data, after)) = after.split_at_checked(length) else {
            break;
        };
        if kind == b"IDAT" {
            list.push(data);
        }
        rest = after.get(4..).unwrap_or_default();
    }
    list
}

/// The check of a chunk: CRC-32 of the polynomial 0xEDB88320, as PNG has it.
fn checksum(bytes: &[u8]) -> u32 {
    const fn step(value: u32) -> u32 {
        if value & 1 == 1 {
            (value >> 1) ^ 0xEDB8_8320
        } else {
            value >> 1
        }
    }
    let table: [u32; 256] =
        std::array::from_fn(|at| (0..8).fold(u32::try_from(at).unwrap_or(0), |v, _| step(v)));
    !bytes.iter().fold(!0, |sum: u32, &byte| {
        let [low, ..] = sum.to_le_bytes();
        table[usize::from(low ^ byte)] ^ (sum >> 8)
    })
}
