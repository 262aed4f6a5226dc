//! Tracks as a ZIP of `ImageJ` ROIs: each at its position in the stack, in a color of its object.

use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::Tracked;
use crate::IoError;
use crate::shapes::roi;
use crate::write::{Whole, unwritable};

/// Where the head of a ROI has its color and its position.
const COLOR: usize = 40;
const POSITION: usize = 56;

pub(super) struct Rois {
    path: PathBuf,
    file: Whole,
    zip: ZipWriter<BufWriter<File>>,
}

impl std::fmt::Debug for Rois {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Rois")
            .field("path", &self.path)
            .finish_non_exhaustive()
    }
}

impl Rois {
    pub(super) fn begin(path: &Path) -> Result<Self, IoError> {
        let mut file = Whole::begin(path)?;
        let Some(beside) = file.file() else {
            return Err(IoError::file(
                path,
                "a ZIP is written in any order; the name of a file is needed",
            ));
        };
        let writer = beside
            .as_file()
            .try_clone()
            .map_err(|error| unwritable(path, error))?;
        Ok(Self {
            path: path.to_owned(),
            file,
            zip: ZipWriter::new(BufWriter::new(writer)),
        })
    }

    pub(super) fn frame(&mut self, frame: usize, tracked: &[&Tracked]) -> Result<(), IoError> {
        let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
        let position = u32::try_from(frame + 1)
            .ok()
            .filter(|&position| i32::try_from(position).is_ok());
        let position =
            position.ok_or_else(|| unwritable(&self.path, "more frames than ImageJ counts"))?;
        for one in tracked {
            let mut shape = one.shape();
            let name = format!("frame{position:04}_id{}", one.id);
            shape.id = Some(name.clone());
            let refuse = |what: String| {
                IoError::file(
                    &self.path,
                    format!("frame {frame}, object {} {what}", one.id),
                )
            };
            let mut bytes = roi(&shape).map_err(refuse)?;
            let [r, g, b] = crate::paint::color_of(one.id);
            bytes[COLOR..COLOR + 4].copy_from_slice(&[255, r, g, b]);
            bytes[POSITION..POSITION + 4].copy_from_slice(&position.to_be_bytes());
            let started = self.zip.start_file(format!("{name}.roi"), options);
            started.map_err(|error| unwritable(&self.path, error))?;
            self.zip
                .write_all(&bytes)
                .map_err(|error| unwritable(&self.path, error))?;
        }
        Ok(())
    }

    pub(super) fn end(self) -> Result<(), IoError> {
        let mut writer = self
            .zip
            .finish()
            .map_err(|error| unwritable(&self.path, error))?;
        writer
            .flush()
            .map_err(|error| unwritable(&self.path, error))?;
        drop(writer);
        self.file.end()
    }
}
