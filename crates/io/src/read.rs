//! Texts read from files or standard input, never more than is sensible.

use std::io::Read;
use std::path::{Path, PathBuf};

use crate::IoError;

/// What is read when a file is called `-`.
const STANDARD_INPUT: &str = "standard input";

/// What a file is called in a message: standard input by its name.
#[must_use]
pub fn called(path: &Path) -> PathBuf {
    if path.as_os_str() == "-" {
        PathBuf::from(STANDARD_INPUT)
    } else {
        path.to_owned()
    }
}

/// What some programs write before any text.
const MARK: char = '\u{feff}';

/// The text of a file, or of standard input for `-`; `wanted` says what is needed.
///
/// # Errors
///
/// A file that cannot be read, that holds more than `most` bytes, or that is not text in UTF-8.
pub fn read_text(path: &Path, wanted: &str, most: u64) -> Result<String, IoError> {
    let bytes = read_bytes(path, wanted, |_| most)?;
    let mut text = String::from_utf8(bytes).map_err(|error| {
        let what = foreign(error.as_bytes());
        IoError::file(&called(path), format!("{what}; {wanted} is needed"))
    })?;
    if text.starts_with(MARK) {
        text.drain(..MARK.len_utf8());
    }
    Ok(text)
}

/// The bytes of a file, or of standard input for `-`; `wanted` says what is needed.
///
/// # Errors
///
/// A file that cannot be read or that holds more than `most` bytes.
pub fn read_file(path: &Path, wanted: &str, most: u64) -> Result<Vec<u8>, IoError> {
    read_bytes(path, wanted, |_| most)
}

/// The bytes of a file, or of standard input for `-`, of which there may be so many as `most` says of the first 64.
///
/// # Errors
///
/// A file that cannot be read or that holds more.
pub(crate) fn read_bytes(
    path: &Path,
    wanted: &str,
    most: impl Fn(&[u8]) -> u64,
) -> Result<Vec<u8>, IoError> {
    let refuse = |what: String| IoError::file(&called(path), format!("{what}; {wanted} is needed"));
    let broken = |error: std::io::Error| refuse(format!("cannot be read: {error}"));
    let mut bytes = Vec::new();
    let mut reader: Box<dyn Read> = if path.as_os_str() == "-" {
        Box::new(std::io::stdin().lock())
    } else {
        Box::new(std::fs::File::open(path).map_err(broken)?)
    };
    reader
        .by_ref()
        .take(64)
        .read_to_end(&mut bytes)
        .map_err(broken)?;
    let most = most(&bytes);
    // one byte more than allowed tells a file of just that size from a longer or endless one
    reader
        .take((most + 1).saturating_sub(bytes.len() as u64))
        .read_to_end(&mut bytes)
        .map_err(broken)?;
    if bytes.len() as u64 > most {
        return Err(refuse(format!("holds more than {} MiB", most >> 20)));
    }
    Ok(bytes)
}

/// The text that bytes are, without what some programs write before any.
///
/// # Errors
///
/// What is wrong with them.
pub(crate) fn text_of<'a>(bytes: &'a [u8], wanted: &str) -> Result<&'a str, String> {
    let text = std::str::from_utf8(bytes)
        .map_err(|_| format!("{}; {wanted} is needed", foreign(bytes)))?;
    Ok(text.strip_prefix(MARK).unwrap_or(text))
}

/// What to say of bytes that are no UTF-8.
fn foreign(bytes: &[u8]) -> String {
    if bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]) {
        return "is text in UTF-16 and must be in UTF-8".to_owned();
    }
    let valid = match std::str::from_utf8(bytes) {
        Ok(_) => bytes.len(),
        Err(error) => error.valid_up_to(),
    };
    let line = bytes[..valid].iter().filter(|&&byte| byte == b'\n').count() + 1;
    // text of another code has letters and spaces all over, and no zeros
    let text = |byte: &&u8| **byte >= 0x20 || matches!(**byte, b'\n' | b'\r' | b'\t');
    if bytes.iter().take(4096).all(|byte| text(&byte)) {
        format!("line {line} is not UTF-8 (Latin-1, perhaps), which is needed")
    } else {
        "is not text".to_owned()
    }
}
