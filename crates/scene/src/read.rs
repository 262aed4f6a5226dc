//! Texts read from files or standard input, never more than is sensible.

use std::io::Read;
use std::path::{Path, PathBuf};

use crate::SceneError;

/// What is read when a file is called `-`.
const STANDARD_INPUT: &str = "standard input";

/// The file's name for people.
pub(crate) fn called(path: &Path) -> PathBuf {
    if path.as_os_str() == "-" {
        PathBuf::from(STANDARD_INPUT)
    } else {
        path.to_owned()
    }
}

/// The text of a file, or of standard input for `-`; `wanted` says what would do instead.
pub(crate) fn text(path: &Path, wanted: &str, most: u64) -> Result<String, SceneError> {
    let refuse =
        |what: String| SceneError::file(&called(path), format!("{what}; {wanted} would do"));
    let broken = |error: std::io::Error| refuse(format!("cannot be read: {error}"));
    let mut bytes = Vec::new();
    let reader: Box<dyn Read> = if path.as_os_str() == "-" {
        Box::new(std::io::stdin().lock())
    } else {
        Box::new(std::fs::File::open(path).map_err(broken)?)
    };
    // one byte more than allowed tells a file of just that size from a longer or endless one
    reader
        .take(most + 1)
        .read_to_end(&mut bytes)
        .map_err(broken)?;
    if bytes.len() as u64 > most {
        return Err(refuse(format!("holds more than {} MiB", most >> 20)));
    }
    let text = String::from_utf8(bytes).map_err(|_| refuse("is not text".to_owned()))?;
    // what some programs write before any text
    Ok(match text.strip_prefix('\u{feff}') {
        Some(rest) => rest.to_owned(),
        None => text,
    })
}
