//! A film as GIF, with one palette for all frames: of each frame only what has changed.

use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};

use ::gif::{DisposalMethod, Encoder, Frame, Repeat};
use image::RgbImage;

use super::changed;
use crate::IoError;
use crate::paint::OBJECTS;
use crate::write::{Whole, unwritable};

/// Greys of a film in grey; each color of an object is mixed half and half with so many.
const GREYS: usize = 200;
const MIXED: usize = 10;

/// Steps of a channel of a film in color.
const STEPS: usize = 6;

/// What a frame leaves as it was.
const UNCHANGED: u8 = 255;

/// Thresholds by the place of a pixel, in sixteenths, so that steps are not seen (Bayer 1973).
const ORDER: [[u8; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];

pub(super) struct Gif {
    path: PathBuf,
    size: (u16, u16),
    hold: u16,
    /// The file, until its first frame.
    file: Option<Whole>,
    encoder: Option<Encoder<BufWriter<Whole>>>,
    palette: Vec<[u8; 3]>,
    color: bool,
    shown: Vec<u8>,
}

impl std::fmt::Debug for Gif {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Gif")
            .field("path", &self.path)
            .field("size", &self.size)
            .finish_non_exhaustive()
    }
}

impl Gif {
    pub(super) fn begin(
        path: &Path,
        size: (u32, u32),
        hold: u16,
        color: bool,
    ) -> Result<Self, IoError> {
        let side = |length: u32| {
            u16::try_from(length).map_err(|_| {
                IoError::file(
                    path,
                    format!(
                        "a GIF has sides of at most {} pixels, got {length}",
                        u16::MAX
                    ),
                )
            })
        };
        Ok(Self {
            path: path.to_owned(),
            size: (side(size.0)?, side(size.1)?),
            hold,
            file: Some(Whole::begin(path)?),
            encoder: None,
            palette: Vec::new(),
            color,
            shown: Vec::new(),
        })
    }

    fn refuse(&self, error: impl std::fmt::Display) -> IoError {
        unwritable(&self.path, error)
    }

    pub(super) fn show(&mut self, image: &RgbImage) -> Result<(), IoError> {
        if let Some(file) = self.file.take() {
            self.palette = if self.color { colors() } else { greys() };
            let bytes: Vec<u8> = self.palette.iter().flatten().copied().collect();
            let encoder = Encoder::new(BufWriter::new(file), self.size.0, self.size.1, &bytes);
            let mut encoder = encoder.map_err(|error| self.refuse(error))?;
            encoder
                .set_repeat(Repeat::Infinite)
                .map_err(|error| self.refuse(error))?;
            self.encoder = Some(encoder);
        }
        let now: Vec<u8> = image
            .enumerate_pixels()
            .map(|(x, y, pixel)| self.entry(x, y, pixel.0))
            .collect();
        let first = self.shown.is_empty();
        let size = (u32::from(self.size.0), u32::from(self.size.1));
        let [left, top, width, height] = if first {
            [0, 0, size.0, size.1]
        } else {
            changed(size, |at| self.shown[at] == now[at])
        };
        let mut buffer = Vec::with_capacity(width as usize * height as usize);
        for y in top..top + height {
            let row = y as usize * size.0 as usize;
            for at in row + left as usize..row + (left + width) as usize {
                let same = !first && self.shown[at] == now[at];
                buffer.push(if same { UNCHANGED } else { now[at] });
            }
        }
        // within the film, whose sides have sixteen bits
        let side = |length: u32| u16::try_from(length).unwrap_or(u16::MAX);
        let frame = Frame {
            delay: self.hold,
            dispose: DisposalMethod::Keep,
            transparent: Some(UNCHANGED),
            left: side(left),
            top: side(top),
            width: side(width),
            height: side(height),
            buffer: buffer.into(),
            ..Frame::default()
        };
        self.shown = now;
        let path = &self.path;
        let written = self
            .encoder
            .as_mut()
            .map(|encoder| encoder.write_frame(&frame));
        written
            .transpose()
            .map(|_| ())
            .map_err(|error| unwritable(path, error))
    }

    /// The entry of the palette for a pixel.
    fn entry(&self, x: u32, y: u32, [r, g, b]: [u8; 3]) -> u8 {
        let byte = |index: usize| u8::try_from(index).unwrap_or(0);
        if !self.color {
            if r == g && g == b {
                return byte((usize::from(r) * (GREYS - 1) + 127) / 255);
            }
            let all = &self.palette[..GREYS + OBJECTS.len() * (MIXED + 1)];
            return byte(nearest(all, [r, g, b]));
        }
        if let Some(own) = OBJECTS.iter().position(|color| *color == [r, g, b]) {
            return byte(STEPS * STEPS * STEPS + own);
        }
        let threshold = f64::from(ORDER[y as usize % 4][x as usize % 4]) / 16.0 + 1.0 / 32.0;
        let step = |level: u8| {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "from 0 to 5"
            )]
            let step = (f64::from(level) / 255.0 * (STEPS - 1) as f64 + threshold).floor() as usize;
            step.min(STEPS - 1)
        };
        byte((step(r) * STEPS + step(g)) * STEPS + step(b))
    }

    pub(super) fn end(self) -> Result<(), IoError> {
        let refuse = |error: &dyn std::fmt::Display| unwritable(&self.path, error);
        let Some(encoder) = self.encoder else {
            return Err(refuse(&"a film has no frame"));
        };
        let mut writer = encoder.into_inner().map_err(|error| refuse(&error))?;
        writer.flush().map_err(|error| refuse(&error))?;
        writer
            .into_inner()
            .map_err(|error| refuse(error.error()))?
            .end()
    }
}

fn nearest(palette: &[[u8; 3]], color: [u8; 3]) -> usize {
    let off = |own: &[u8; 3]| {
        let each = own
            .iter()
            .zip(color)
            .map(|(&a, b)| i32::from(a) - i32::from(b));
        each.map(|d| d * d).sum::<i32>()
    };
    let best = palette.iter().enumerate().min_by_key(|(_, own)| off(own));
    best.map_or(0, |(at, _)| at)
}

fn level(step: usize, steps: usize) -> u8 {
    u8::try_from(255 * step / (steps - 1)).unwrap_or(u8::MAX)
}

/// Greys, then of each object its color and the color halfway to greys.
fn greys() -> Vec<[u8; 3]> {
    let mut palette: Vec<[u8; 3]> = (0..GREYS).map(|step| [level(step, GREYS); 3]).collect();
    for color in OBJECTS {
        palette.push(color);
        let half = |grey: u8| color.map(|own| own.midpoint(grey));
        palette.extend((0..MIXED).map(|step| half(level(step, MIXED))));
    }
    palette.resize(256, [0; 3]);
    palette
}

/// Steps of red, green and blue, then the colors of objects.
fn colors() -> Vec<[u8; 3]> {
    let each = 0..STEPS * STEPS * STEPS;
    let color = |at: usize| {
        [at / STEPS / STEPS, at / STEPS % STEPS, at % STEPS].map(|step| level(step, STEPS))
    };
    let mut palette: Vec<[u8; 3]> = each.map(color).collect();
    palette.extend(OBJECTS);
    palette.resize(256, [0; 3]);
    palette
}
