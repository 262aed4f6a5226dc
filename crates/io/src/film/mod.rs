//! Pictures that move, written frame by frame: GIF, animated PNG, or a video by the program ffmpeg.
//!
//! One frame is in memory, and the one before where a format keeps what has not changed.

mod apng;
mod gif;
mod video;

use std::path::Path;

use glam::DVec2;
use image::RgbImage;

use crate::IoError;

/// A format of films.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum FilmFormat {
    /// GIF, in 256 colors: greys and those of objects, or of a picture in color 216 and those.
    Gif,
    /// An animated PNG, in all colors.
    Apng,
    /// MP4, MOV, MKV or `WebM` by the program ffmpeg, where it is installed.
    Video,
}

/// Endings of the names of films.
const ENDINGS: [(&str, FilmFormat); 8] = [
    ("gif", FilmFormat::Gif),
    ("png", FilmFormat::Apng),
    ("apng", FilmFormat::Apng),
    ("mp4", FilmFormat::Video),
    ("m4v", FilmFormat::Video),
    ("mov", FilmFormat::Video),
    ("mkv", FilmFormat::Video),
    ("webm", FilmFormat::Video),
];

impl FilmFormat {
    /// The format of a file of that name; None for an ending that no format has.
    #[must_use]
    pub fn by_ending(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_lowercase();
        ENDINGS
            .iter()
            .find(|(known, _)| *known == ending)
            .map(|(_, format)| *format)
    }
}

/// A film that grows frame by frame; its file has its name at the end.
#[derive(Debug)]
pub struct Film {
    size: (u32, u32),
    kind: Kind,
}

#[derive(Debug)]
enum Kind {
    Gif(Box<gif::Gif>),
    Apng(Box<apng::Apng>),
    Video(Box<video::Video>),
}

impl Film {
    /// Begin a film of frames of that size, each shown for so many hundredths of a second;
    /// `color` says whether there is color in them besides the colors of objects, for a GIF, which has 256.
    ///
    /// # Errors
    ///
    /// A place that cannot be written, or is no file; a size that the format cannot have; a video where its program
    /// is not there.
    pub fn begin(
        path: &Path,
        format: FilmFormat,
        size: (u32, u32),
        hold: u16,
        color: bool,
    ) -> Result<Self, IoError> {
        if size.0 == 0 || size.1 == 0 {
            return Err(IoError::file(
                path,
                format!(
                    "frames of {}×{} pixels; at least 1×1 is needed",
                    size.0, size.1
                ),
            ));
        }
        let hold = hold.max(1);
        let kind = match format {
            FilmFormat::Gif => Kind::Gif(Box::new(gif::Gif::begin(path, size, hold, color)?)),
            FilmFormat::Apng => Kind::Apng(Box::new(apng::Apng::begin(path, size, hold)?)),
            FilmFormat::Video => Kind::Video(Box::new(video::Video::begin(path, size, hold)?)),
        };
        Ok(Self { size, kind })
    }

    /// Show a frame.
    ///
    /// # Errors
    ///
    /// A frame of another size; a full disk; what the program of a video refuses.
    pub fn show(&mut self, frame: &RgbImage) -> Result<(), IoError> {
        if frame.dimensions() != self.size {
            let (width, height) = frame.dimensions();
            let (wide, high) = self.size;
            let message = format!("a frame of {width}×{height} pixels in a film of {wide}×{high}");
            return Err(IoError::text(None, message));
        }
        match &mut self.kind {
            Kind::Gif(gif) => gif.show(frame),
            Kind::Apng(apng) => apng.show(frame),
            Kind::Video(video) => video.show(frame),
        }
    }

    /// Finish the file.
    ///
    /// # Errors
    ///
    /// As [`Film::show`]; a film without a frame.
    pub fn end(self) -> Result<(), IoError> {
        match self.kind {
            Kind::Gif(gif) => gif.end(),
            Kind::Apng(apng) => apng.end(),
            Kind::Video(video) => video.end(),
        }
    }
}

/// The pieces of a curve that is drawn in dashes: so long, and so far apart. Pixels.
#[must_use]
pub fn dashes(nodes: &[DVec2], closed: bool, on: f64, off: f64) -> Vec<Vec<DVec2>> {
    let n = nodes.len();
    let edges = if closed { n } else { n.saturating_sub(1) };
    let (on, off) = (on.max(0.5), off.max(0.5));
    let (mut pieces, mut piece) = (Vec::new(), Vec::new());
    // what is left of the dash, or of the space behind it
    let (mut drawn, mut left) = (true, on);
    for i in 0..edges {
        let (mut a, b) = (nodes[i], nodes[(i + 1) % n]);
        if drawn && piece.is_empty() {
            piece.push(a);
        }
        loop {
            let length = a.distance(b);
            if length < left || !length.is_finite() {
                left -= if length.is_finite() { length } else { 0.0 };
                break;
            }
            a += (b - a) * (left / length);
            if drawn {
                piece.push(a);
                pieces.push(std::mem::take(&mut piece));
                left = off;
            } else {
                piece = vec![a];
                left = on;
            }
            drawn = !drawn;
        }
        if drawn {
            piece.push(b);
        }
    }
    let begun = piece
        .windows(2)
        .any(|pair| pair[0].distance(pair[1]) > 1e-9);
    if drawn && begun {
        pieces.push(piece);
    }
    pieces
}

/// The smallest part of a frame, as left, top, width and height, that holds all that has changed; a pixel at least.
fn changed(size: (u32, u32), same: impl Fn(usize) -> bool) -> [u32; 4] {
    let (wide, high) = size;
    let (mut left, mut top, mut right, mut bottom) = (wide, high, 0, 0);
    let mut at = 0;
    for y in 0..high {
        for x in 0..wide {
            if !same(at) {
                (left, right) = (left.min(x), right.max(x + 1));
                (top, bottom) = (top.min(y), y + 1);
            }
            at += 1;
        }
    }
    if right == 0 {
        [0, 0, 1, 1]
    } else {
        [left, top, right - left, bottom - top]
    }
}

#[cfg(test)]
mod tests;
