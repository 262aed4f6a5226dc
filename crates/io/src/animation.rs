//! Curves that move over a picture, as a GIF: its grey levels, a few colors, and of each frame only what has changed.

use std::fmt;

use gif::{DisposalMethod, Encoder, Frame, Repeat};
use glam::DVec2;
use image::RgbImage;

use crate::{IoError, paint};

/// Greys of the ground; of each color so many are mixed with, and in so many shares.
const GREYS: u8 = 64;
const STEP: u8 = 4;
const MIXED: u8 = 16;
const SHARES: u8 = 3;

/// Colors at most: their mixtures, the greys and one for what does not change are the 256 of a palette.
const MOST: usize = 5;

/// What a frame leaves as it was.
const UNCHANGED: u8 = 255;

/// A curve of a frame.
#[derive(Debug, Clone, Copy)]
pub struct Stroke<'a> {
    /// Its nodes, in pixels of the ground.
    pub nodes: &'a [DVec2],
    /// Whether the last is joined to the first.
    pub closed: bool,
    /// The number of its color.
    pub color: usize,
}

/// An animation that grows frame by frame; it starts again when it is over.
pub struct Animation {
    encoder: Encoder<Vec<u8>>,
    ground: Vec<u8>,
    shown: Option<Vec<u8>>,
    colors: usize,
    size: (u16, u16),
}

impl fmt::Debug for Animation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut told = f.debug_struct("Animation");
        told.field("size", &self.size).field("colors", &self.colors);
        told.finish_non_exhaustive()
    }
}

/// A part of a frame.
struct Part {
    left: usize,
    top: usize,
    right: usize,
    bottom: usize,
}

impl Animation {
    /// Nothing yet, over this ground, whose grey levels are shown; for curves of these colors, five at most.
    ///
    /// # Errors
    ///
    /// A ground or colors that GIF cannot have.
    pub fn over(ground: &RgbImage, colors: &[[u8; 3]]) -> Result<Self, IoError> {
        let side = |length: u32| {
            u16::try_from(length)
                .ok()
                .filter(|length| *length > 0)
                .ok_or_else(|| {
                    refused(format!(
                        "sides of 1 to 65535 pixels are needed, got {length}"
                    ))
                })
        };
        let size = (side(ground.width())?, side(ground.height())?);
        if colors.len() > MOST {
            return Err(refused(format!(
                "at most {MOST} colors, got {}",
                colors.len()
            )));
        }
        let mut encoder =
            Encoder::new(Vec::new(), size.0, size.1, &palette(colors)).map_err(refused)?;
        encoder.set_repeat(Repeat::Infinite).map_err(refused)?;
        let grey = |pixel: &image::Rgb<u8>| {
            // the weights of Rec. 601
            let [r, g, b] = pixel.0.map(u32::from);
            let level = (299 * r + 587 * g + 114 * b + 500) / 1000;
            u8::try_from(level).unwrap_or(u8::MAX) / STEP
        };
        Ok(Self {
            encoder,
            ground: ground.pixels().map(grey).collect(),
            shown: None,
            colors: colors.len(),
            size,
        })
    }

    /// Show these curves, the first below, for so many hundredths of a second.
    ///
    /// # Errors
    ///
    /// A color that there is not.
    pub fn show(&mut self, strokes: &[Stroke<'_>], width: f64, hold: u16) -> Result<(), IoError> {
        let mut now = self.ground.clone();
        let (columns, rows) = (u32::from(self.size.0), u32::from(self.size.1));
        for stroke in strokes {
            if stroke.color >= self.colors {
                let got = stroke.color;
                return Err(refused(format!(
                    "{} colors, and number {got} is asked for",
                    self.colors
                )));
            }
            paint::covered(
                (columns, rows),
                (stroke.nodes, stroke.closed),
                width,
                |x, y, cover| {
                    let at = (y * columns + x) as usize;
                    now[at] = mixed(now[at], self.ground[at], stroke.color, cover);
                },
            );
        }
        let part = self.changed(&now);
        let wide = usize::from(self.size.0);
        let mut buffer = Vec::with_capacity((part.bottom - part.top) * (part.right - part.left));
        for y in part.top..part.bottom {
            for at in y * wide + part.left..y * wide + part.right {
                let same = self
                    .shown
                    .as_ref()
                    .is_some_and(|shown| shown[at] == now[at]);
                buffer.push(if same { UNCHANGED } else { now[at] });
            }
        }
        let side = |length: usize| u16::try_from(length).unwrap_or(u16::MAX); // within the ground, which has fewer
        let frame = Frame {
            delay: hold,
            dispose: DisposalMethod::Keep,
            transparent: Some(UNCHANGED),
            left: side(part.left),
            top: side(part.top),
            width: side(part.right - part.left),
            height: side(part.bottom - part.top),
            buffer: buffer.into(),
            ..Frame::default()
        };
        self.encoder.write_frame(&frame).map_err(refused)?;
        self.shown = Some(now);
        Ok(())
    }

    /// The smallest part that holds all changes, a pixel at least.
    fn changed(&self, now: &[u8]) -> Part {
        let (wide, high) = (usize::from(self.size.0), usize::from(self.size.1));
        let Some(shown) = &self.shown else {
            return Part {
                left: 0,
                top: 0,
                right: wide,
                bottom: high,
            };
        };
        let mut part = Part {
            left: wide,
            top: high,
            right: 0,
            bottom: 0,
        };
        for (at, _) in now
            .iter()
            .zip(shown)
            .enumerate()
            .filter(|(_, (a, b))| a != b)
        {
            let (x, y) = (at % wide, at / wide);
            part.left = part.left.min(x);
            part.right = part.right.max(x + 1);
            part.top = part.top.min(y);
            part.bottom = part.bottom.max(y + 1);
        }
        if part.right == 0 {
            return Part {
                left: 0,
                top: 0,
                right: 1,
                bottom: 1,
            };
        }
        part
    }

    /// The bytes of the file.
    ///
    /// # Errors
    ///
    /// None in practice.
    pub fn end(self) -> Result<Vec<u8>, IoError> {
        self.encoder.into_inner().map_err(refused)
    }
}

fn refused(error: impl ToString) -> IoError {
    IoError::Format {
        format: "GIF",
        message: error.to_string(),
    }
}

/// Greys, then for each color its mixtures with greys by rising share, then itself.
fn palette(colors: &[[u8; 3]]) -> Vec<u8> {
    let grey = |index: u8, count: u8| 255 * u32::from(index) / u32::from(count - 1);
    let byte = |value: u32| u8::try_from(value).unwrap_or(u8::MAX);
    let mut table: Vec<u8> = Vec::with_capacity(3 * 256);
    for index in 0..GREYS {
        table.extend([byte(grey(index, GREYS)); 3]);
    }
    for color in colors {
        for share in 1..SHARES {
            let share = u32::from(share);
            for under in 0..MIXED {
                let under = grey(under, MIXED) * (u32::from(SHARES) - share);
                table.extend(
                    color.map(|over| byte((under + share * u32::from(over)) / u32::from(SHARES))),
                );
            }
        }
        table.extend(color);
    }
    table.resize(3 * 256, 0);
    table
}

/// The entry of a color over a ground, or what was there where it covers too little.
fn mixed(before: u8, ground: u8, color: usize, cover: f64) -> u8 {
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share from 0 to 1"
    )]
    let share = (cover.clamp(0.0, 1.0) * f64::from(SHARES)).round() as u8;
    let each = (SHARES - 1) * MIXED + 1;
    let first = u8::try_from(color).map_or(UNCHANGED, |color| GREYS + color * each);
    match share {
        0 => before,
        share if share == SHARES => first + each - 1,
        // a curve over another one covers it
        share if before >= GREYS && share == 1 => before,
        share => first + (share - 1) * MIXED + ground / (GREYS / MIXED),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COLORS: [[u8; 3]; 2] = [[86, 180, 233], [230, 97, 1]];

    /// The frames of a file as pictures, as a viewer lays them over one another.
    fn frames(bytes: &[u8]) -> Vec<Vec<[u8; 3]>> {
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(bytes).unwrap();
        let (wide, high) = (usize::from(decoder.width()), usize::from(decoder.height()));
        let (mut canvas, mut all) = (vec![[0; 3]; wide * high], Vec::new());
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            for (at, pixel) in frame.buffer.chunks(4).enumerate() {
                let (x, y) = (at % usize::from(frame.width), at / usize::from(frame.width));
                if pixel[3] > 0 {
                    let place = (y + usize::from(frame.top)) * wide + x + usize::from(frame.left);
                    canvas[place] = [pixel[0], pixel[1], pixel[2]];
                }
            }
            all.push(canvas.clone());
        }
        all
    }

    #[test]
    fn a_moving_line_is_read_back_where_it_was_in_each_frame() {
        let ground =
            RgbImage::from_fn(30, 20, |x, _| image::Rgb([8 * u8::try_from(x).unwrap(); 3]));
        let mut animation = Animation::over(&ground, &COLORS).unwrap();
        let line = |x: f64| [DVec2::new(x, 3.0), DVec2::new(x, 16.0)];
        for x in [5.0, 9.0, 9.0, 20.0] {
            let nodes = line(x);
            let stroke = Stroke {
                nodes: &nodes,
                closed: false,
                color: 1,
            };
            animation.show(&[stroke], 1.0, 4).unwrap();
        }
        let all = frames(&animation.end().unwrap());
        assert_eq!(all.len(), 4);
        for (frame, column) in all.iter().zip([5, 9, 9, 20]) {
            for x in [5, 9, 20] {
                let pixel = frame[10 * 30 + x];
                assert_eq!(pixel == COLORS[1], x == column, "{x} {pixel:?}");
            }
            // the ground is as it was, in 64 greys
            let corner = i32::from(frame[29][0]) - 8 * 29;
            assert!(corner.abs() <= 4, "{corner}");
        }
    }

    #[test]
    fn more_colors_than_a_palette_holds_and_a_color_that_is_not_there_are_refused() {
        let ground = RgbImage::new(4, 4);
        assert!(Animation::over(&ground, &[[0; 3]; 6]).is_err());
        assert!(Animation::over(&RgbImage::new(70_000, 1), &[]).is_err());
        let mut animation = Animation::over(&ground, &COLORS).unwrap();
        let stroke = Stroke {
            nodes: &[DVec2::ZERO],
            closed: false,
            color: 2,
        };
        assert!(animation.show(&[stroke], 1.0, 1).is_err());
    }
}
