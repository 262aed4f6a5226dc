//! Which files the frames are: as they are named, or all of a folder.

use std::path::{Path, PathBuf};

use super::names::{Gap, gaps, is_beside, is_listed, sequence};
use super::order::natural_order;
use super::video::is_video;
use crate::IoError;
use crate::text::clip_to;

/// Endings of the names of pictures, in small letters.
pub const ENDINGS: [&str; 12] = [
    "png", "jpg", "jpeg", "tif", "tiff", "pgm", "ppm", "pnm", "pbm", "pfm", "webp", "btf",
];

/// Whether a file is a picture by the ending of its name, in any case of letters.
///
/// ```
/// use io::frames::is_picture;
///
/// assert!(is_picture("a/b.TIF".as_ref()) && !is_picture("notes.txt".as_ref()));
/// ```
#[must_use]
pub fn is_picture(path: &Path) -> bool {
    let ending = path
        .extension()
        .map(|ending| ending.to_string_lossy().to_lowercase());
    ending.is_some_and(|ending| ENDINGS.contains(&ending.as_str()))
}

/// Files in order, and what is known of them.
#[derive(Debug, Default)]
pub(super) struct Listing {
    pub files: Vec<PathBuf>,
    pub gaps: Vec<Gap>,
    pub notes: Vec<String>,
}

pub(super) fn name_of(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

/// The files that these names stand for.
pub(super) fn listing(inputs: &[PathBuf]) -> Result<Listing, IoError> {
    let mut all = Listing::default();
    if let [one] = inputs
        && one.is_dir()
    {
        return folder(one);
    }
    for input in inputs {
        if input.is_dir() {
            let own = folder(input)?;
            let before = all.files.len();
            all.gaps.extend(own.gaps.into_iter().map(|gap| Gap {
                before: gap.before + before,
                ..gap
            }));
            all.notes.extend(own.notes);
            all.files.extend(own.files);
        } else {
            all.files.push(input.clone());
        }
    }
    if inputs.iter().any(|input| input.is_dir()) {
        return Ok(all);
    }
    let names: Vec<String> = all.files.iter().map(|path| name_of(path)).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let folder = all.files.first().and_then(|path| path.parent());
    let together = all.files.iter().all(|path| path.parent() == folder);
    if together && is_listed(&names) {
        all.notes
            .push("the files are taken in the order of their numbers".to_owned());
        all.files
            .sort_by(|a, b| natural_order(&name_of(a), &name_of(b)));
    }
    let names: Vec<String> = all.files.iter().map(|path| name_of(path)).collect();
    all.gaps = gaps(&names.iter().map(String::as_str).collect::<Vec<_>>());
    Ok(all)
}

/// The sequence of pictures in a folder.
fn folder(path: &Path) -> Result<Listing, IoError> {
    let refuse = |message: String| IoError::file(path, message);
    let unread = |error: std::io::Error| {
        refuse(format!(
            "cannot be read: {error}; a folder of frames is needed"
        ))
    };
    let (mut files, mut videos) = (Vec::new(), Vec::new());
    for entry in std::fs::read_dir(path).map_err(unread)? {
        let file = entry.map_err(unread)?.path();
        let hidden = name_of(&file).starts_with('.');
        if hidden || !file.is_file() {
            continue;
        }
        if is_picture(&file) {
            files.push(file);
        } else if is_video(&file) {
            videos.push(name_of(&file));
        }
    }
    // the folder has them in any order
    files.sort();
    videos.sort();
    if files.is_empty() {
        let message = match &videos[..] {
            [] => format!(
                "holds no picture ({}); a folder of frames is needed",
                ENDINGS.join(", ")
            ),
            [first, ..] => format!(
                "holds no picture, but {}; a video is given by its own name",
                clip_to(first, 60)
            ),
        };
        return Err(refuse(message));
    }
    let mut list = Listing::default();
    let (beside, frames): (Vec<PathBuf>, Vec<PathBuf>) = files
        .into_iter()
        .partition(|file| is_beside(&name_of(file)));
    let frames = match (frames.is_empty(), beside.len()) {
        (true, _) => {
            list.notes.push(
                "the pictures are masks or labels by their names; there are no others".to_owned(),
            );
            beside
        }
        (false, 0) => frames,
        (false, count) => {
            let first = clip_to(&name_of(&beside[0]), 60);
            list.notes.push(format!(
                "{count} files are masks or the like by their names and no frames, as {first}"
            ));
            frames
        }
    };
    let names: Vec<String> = frames.iter().map(|file| name_of(file)).collect();
    let found = sequence(&names.iter().map(String::as_str).collect::<Vec<_>>()).map_err(refuse)?;
    if let Some(&first) = found.left_out.first() {
        let count = found.left_out.len();
        let first = clip_to(&names[first], 60);
        list.notes.push(format!(
            "{count} files are not of the sequence and left out, as {first}"
        ));
    }
    list.files = found.order.iter().map(|&at| frames[at].clone()).collect();
    list.gaps = found.gaps;
    Ok(list)
}
