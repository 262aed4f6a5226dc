//! The pictures that are named: files, folders of them, names with `*` and `?` that no shell has read.

use std::path::{Component, Path, PathBuf};

use io::Picture;
use io::frames::is_picture;
use scene::SceneError;

use super::flags::{Flags, Pages};
use crate::commands::key;

/// The files and folders that names stand for: of one with `*`, `?` or `[…]` that is not the name of a file itself,
/// all that are called so, in the order of their names.
pub(crate) fn matched(names: &[PathBuf]) -> Result<Vec<PathBuf>, SceneError> {
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
            let path = path.map_err(|error| key("picture", error))?;
            // a name that begins with a dot is meant only where the pattern has the dot
            if !is_hidden(&path) || is_hidden(name) {
                list.push(path);
            }
        }
        if list.len() == before {
            let message = format!("no file is called {pattern}; needed: a name that some have");
            return Err(key("picture", message));
        }
    }
    Ok(list)
}

/// Whether the name of a file or of a folder on the way to it begins with a dot.
fn is_hidden(path: &Path) -> bool {
    path.components().any(|part| match part {
        Component::Normal(name) => name.as_encoded_bytes().starts_with(b"."),
        _ => false,
    })
}

/// A picture to be read.
#[derive(Debug, Clone)]
pub(super) struct Input {
    pub(super) image: PathBuf,
    /// Its page in the file, if that has been chosen.
    pub(super) page: Option<usize>,
    /// The file's name, or that with the number of the page: what its results and its starts are called by.
    pub(super) name: PathBuf,
}

/// All pictures, those of folders by name, and each page if all are asked for.
pub(super) fn pictures(images: &[PathBuf], flags: &Flags) -> Result<Vec<Input>, SceneError> {
    let mut files = Vec::new();
    for image in images {
        if image.is_dir() {
            files.append(&mut inside(image)?);
        } else {
            files.push(image.clone());
        }
    }
    let one = |page: Option<usize>, image: PathBuf| Input {
        page,
        name: image.clone(),
        image,
    };
    let mut list = Vec::new();
    for image in files {
        let page = match flags.page {
            None => None,
            Some(Pages::One(page)) => Some(page),
            Some(Pages::All) if image.as_os_str() == "-" => {
                let message = "all is of files, which are read more than once; got standard input";
                return Err(key("--page", message));
            }
            // what cannot be read is refused when its turn comes
            Some(Pages::All) => match Picture::pages(&image, flags.channel.as_deref()).unwrap_or(1)
            {
                1 => None,
                count => {
                    list.extend((1..=count).map(|page| Input {
                        name: named(&image, page, count),
                        page: Some(page),
                        image: image.clone(),
                    }));
                    continue;
                }
            },
        };
        list.push(one(page, image));
    }
    Ok(list)
}

/// The name of a page, with as many digits as the last of them.
fn named(image: &Path, page: usize, count: usize) -> PathBuf {
    let digits = count.to_string().len();
    let mut name = image.file_stem().unwrap_or_default().to_owned();
    name.push(format!("_page{page:0digits$}"));
    if let Some(ending) = image.extension() {
        name.push(".");
        name.push(ending);
    }
    image.with_file_name(name)
}

/// The pictures of a folder but those whose names begin with a dot.
fn inside(folder: &Path) -> Result<Vec<PathBuf>, SceneError> {
    let refuse = |error: std::io::Error| key("picture", format!("{}: {error}", folder.display()));
    let mut list = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(refuse)? {
        let path = entry.map_err(refuse)?.path();
        let hidden = path
            .file_name()
            .is_some_and(|name| is_hidden(Path::new(name)));
        if path.is_file() && !hidden && is_picture(&path) {
            list.push(path);
        }
    }
    if list.is_empty() {
        let endings = io::frames::ENDINGS.join(", ");
        let message = format!("{} holds no picture ({endings})", folder.display());
        return Err(key("picture", message));
    }
    list.sort();
    Ok(list)
}
