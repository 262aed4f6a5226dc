//! A ZIP of `ImageJ` ROIs.

use std::collections::BTreeSet;
use std::io::{Cursor, Read as _, Write as _};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use super::decode;
use crate::IoError;
use crate::limits::{MOST_CONTOUR_BYTES, MOST_SHAPES};
use crate::shapes::budget::Budget;
use crate::shapes::format::Reading;
use crate::shapes::{Shape, Shapes};
use crate::text::clip_to;

/// How many bytes those of a packed file may become, and so many besides.
const MOST_TIMES: u64 = 200;
const BESIDES: u64 = 1 << 20;

pub(super) fn read(
    bytes: &[u8],
    reading: &Reading,
    budget: &mut Budget,
) -> Result<Shapes, IoError> {
    let broken = |error: &dyn std::fmt::Display| {
        let error = clip_to(&error.to_string(), 100);
        IoError::text(
            None,
            format!("the ZIP cannot be read: {error}; a whole one is needed"),
        )
    };
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| broken(&error))?;
    if archive.len() > MOST_SHAPES {
        return Err(broken(&format!("it holds more than {MOST_SHAPES} files")));
    }
    let most = (bytes.len() as u64 * MOST_TIMES + BESIDES).min(MOST_CONTOUR_BYTES);
    let mut taken = 0;
    let mut shapes = Shapes::new();
    for index in 0..archive.len() {
        let mut file = archive.by_index(index).map_err(|error| broken(&error))?;
        let name = file.name().map_err(|error| broken(&error))?.into_owned();
        let stem = name.rsplit(['/', '\\']).next().unwrap_or_default();
        let ending = stem
            .len()
            .checked_sub(4)
            .and_then(|at| stem.split_at_checked(at));
        let Some((stem, _)) = ending.filter(|(_, end)| end.eq_ignore_ascii_case(".roi")) else {
            continue;
        };
        let within = |what: &dyn std::fmt::Display| {
            IoError::text(None, format!("{}: {what}", clip_to(&name, 60)))
        };
        let mut inflated = Vec::new();
        let read = file
            .by_ref()
            .take(most - taken + 1)
            .read_to_end(&mut inflated);
        read.map_err(|error| within(&clip_to(&error.to_string(), 100)))?;
        taken += inflated.len() as u64;
        if taken > most {
            return Err(within(&format!(
                "the files of the ZIP take more than {most} bytes, which are the most for one of its size"
            )));
        }
        let own = decode::shapes(&inflated, reading, budget).map_err(|what| within(&what))?;
        for mut shape in own {
            if shape.id.is_none() && !stem.is_empty() {
                shape.id = Some(clip_to(stem, 200));
            }
            shapes.push(shape);
        }
    }
    if shapes.is_empty() {
        return Err(broken(&"it holds no file that ends in .roi"));
    }
    Ok(shapes)
}

pub(super) fn write(shapes: &[Shape], files: &[Vec<u8>]) -> Result<Vec<u8>, String> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
    let mut names = BTreeSet::new();
    for ((number, shape), file) in (1..).zip(shapes).zip(files) {
        let kept = |c: char| {
            if c.is_alphanumeric() || matches!(c, '-' | '_') {
                c
            } else {
                '_'
            }
        };
        let mut name: String = shape
            .id
            .iter()
            .flat_map(|id| id.chars().take(60))
            .map(kept)
            .collect();
        if name.is_empty() || names.contains(&name.to_lowercase()) {
            name = format!("{name}_{number}");
        }
        names.insert(name.to_lowercase());
        let written = writer.start_file(format!("{name}.roi"), options);
        written.map_err(|error| error.to_string())?;
        writer.write_all(file).map_err(|error| error.to_string())?;
    }
    let done = writer.finish().map_err(|error| error.to_string())?;
    Ok(done.into_inner())
}
