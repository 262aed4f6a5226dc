//! The pictures that are named: files, folders of them, names with `*` and `?` that no shell has read.

use std::path::{Path, PathBuf};

use scene::SceneError;

use crate::commands::key;

/// Endings of the names of pictures in a folder.
const ENDINGS: [&str; 12] = [
    "png", "jpg", "jpeg", "tif", "tiff", "pgm", "ppm", "pnm", "pbm", "pfm", "webp", "btf",
];

/// The files and folders that names stand for: of one with `*`, `?` or `[…]` that is not the name of a file itself, all
/// that are called so, in the order of their names.
pub(super) fn matched(names: &[PathBuf]) -> Result<Vec<PathBuf>, SceneError> {
    let mut list = Vec::new();
    for name in names {
        let pattern = name.to_str().filter(|text| text.contains(['*', '?', '[']));
        let Some(pattern) = pattern.filter(|_| name.symlink_metadata().is_err()) else {
            list.push(name.clone());
            continue;
        };
        let found = glob::glob(pattern).map_err(|error| {
            let message = format!("{pattern} is neither a file nor a pattern of names: {error}");
            key("picture", message)
        })?;
        let before = list.len();
        for path in found {
            list.push(path.map_err(|error| key("picture", error))?);
        }
        if list.len() == before {
            let message = format!("no file is called {pattern}; needed: a name that some have");
            return Err(key("picture", message));
        }
    }
    Ok(list)
}

/// The files of all pictures, those of folders by name.
pub(super) fn files(images: &[PathBuf]) -> Result<Vec<PathBuf>, SceneError> {
    let mut list = Vec::new();
    for image in images {
        if image.is_dir() {
            list.append(&mut inside(image)?);
        } else {
            list.push(image.clone());
        }
    }
    Ok(list)
}

/// The pictures of a folder.
fn inside(folder: &Path) -> Result<Vec<PathBuf>, SceneError> {
    let refuse = |error: std::io::Error| key("picture", format!("{}: {error}", folder.display()));
    let mut list = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(refuse)? {
        let path = entry.map_err(refuse)?.path();
        let ending = path
            .extension()
            .map(|ending| ending.to_string_lossy().to_lowercase());
        if path.is_file() && ending.is_some_and(|ending| ENDINGS.contains(&ending.as_str())) {
            list.push(path);
        }
    }
    if list.is_empty() {
        let endings = ENDINGS.join(", ");
        let message = format!("{} holds no picture ({endings})", folder.display());
        return Err(key("picture", message));
    }
    list.sort();
    Ok(list)
}
