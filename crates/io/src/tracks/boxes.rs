//! Tracks as boxes, as the MOT challenge has them: `frame,id,left,top,width,height,confidence,-1,-1,-1`.
//!
//! Frames, and the corner of the first pixel, are counted from 1.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use super::Tracked;
use crate::IoError;
use crate::write::{Whole, unwritable};

#[derive(Debug)]
pub(super) struct Boxes {
    path: PathBuf,
    file: Whole,
}

impl Boxes {
    pub(super) fn begin(path: &Path) -> Result<Self, IoError> {
        Ok(Self {
            path: path.to_owned(),
            file: Whole::begin(path)?,
        })
    }

    pub(super) fn frame(&mut self, frame: usize, tracked: &[&Tracked]) -> Result<(), IoError> {
        let mut text = String::new();
        for one in tracked {
            let Some((low, high)) = one.bounds() else {
                continue;
            };
            // from the center of the first pixel to its corner at 1, 1
            let (corner, size) = (low + 1.5, high - low);
            let sure = one.confidence.unwrap_or(1.0);
            let [x, y, width, height] = [corner.x, corner.y, size.x, size.y];
            // writing to a String cannot fail
            let _ = writeln!(
                text,
                "{},{},{x},{y},{width},{height},{sure},-1,-1,-1",
                frame + 1,
                one.id
            );
        }
        let written = self.file.write_all(text.as_bytes());
        written.map_err(|error| unwritable(&self.path, error))
    }

    pub(super) fn end(self) -> Result<(), IoError> {
        self.file.end()
    }
}
