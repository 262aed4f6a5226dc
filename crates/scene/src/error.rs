//! What can be wrong with a scene, a picture or a contour. Every message names the key or the
//! file, what was given, and what would do.

use std::path::PathBuf;

/// Why a scene, a picture, a contour or a record was refused.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// A value under a key that will not do.
    #[error("{key}: {message}")]
    Key {
        /// The key as written, with its table: `material.tension`.
        key: String,
        /// What was given and what would do.
        message: String,
    },
    /// Text that is no scene: syntax, unknown key, wrong type.
    #[error("line {line}: {message}")]
    Text {
        /// Line, from 1.
        line: usize,
        /// What is wrong and what would do.
        message: String,
    },
    /// No shipped scene has this name.
    #[error(
        "no shipped scene is called \"{name}\"; did you mean \"{nearest}\"? (`snake list` shows all; a file needs its ending or a folder)"
    )]
    UnknownScene {
        /// The name given.
        name: String,
        /// The nearest shipped one.
        nearest: String,
    },
    /// A file that cannot be read or written.
    #[error("{}: {message}", path.display())]
    File {
        /// The file or folder.
        path: PathBuf,
        /// What is wrong.
        message: String,
    },
    /// A step larger than the scheme can bear.
    #[error("run.dt: {0}")]
    Step(String),
}

impl SceneError {
    pub(crate) fn key(key: &str, message: impl ToString) -> Self {
        Self::Key {
            key: key.to_owned(),
            message: message.to_string(),
        }
    }

    pub(crate) fn file(path: &std::path::Path, message: impl ToString) -> Self {
        Self::File {
            path: path.to_owned(),
            message: message.to_string(),
        }
    }
}

/// At most sixty characters of what was given, on one line, for a message.
pub(crate) fn clip(given: &str) -> String {
    let mut short: String = given
        .trim()
        .chars()
        .take(60)
        .map(|c| if c.is_control() { '\u{fffd}' } else { c })
        .collect();
    if given.trim().chars().nth(60).is_some() {
        short.push('…');
    }
    short
}

/// The entry of `known` that is most like `word`.
pub(crate) fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> &'a str {
    known
        .into_iter()
        .max_by(|a, b| strsim::jaro_winkler(word, a).total_cmp(&strsim::jaro_winkler(word, b)))
        .unwrap_or("")
}
