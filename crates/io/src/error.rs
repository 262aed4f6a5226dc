//! What can be wrong with a file. Every message names the file, the line where there is one, what
//! was found and what is needed.

use std::path::{Path, PathBuf};

/// Why a file was refused, or could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum IoError {
    /// A file or folder that cannot be read or written.
    #[error("{}: {}{message}", path.display(), place(*line))]
    File {
        /// The file or folder.
        path: PathBuf,
        /// The line of a text, from 1.
        line: Option<usize>,
        /// What is wrong and what is needed.
        message: String,
    },
    /// A text that is not of the format asked for.
    #[error("{}{message}", place(*line))]
    Text {
        /// The line, from 1.
        line: Option<usize>,
        /// What is wrong and what is needed.
        message: String,
    },
    /// A result that would take the place of a file that is read.
    #[error("{result}: {} is a file that is read; the result must be another", path.display())]
    IsRead {
        /// Which result, as the caller names it.
        result: String,
        /// The file.
        path: PathBuf,
    },
    /// Two results for one file.
    #[error("{result}: {} is taken by {other}; each result needs its own file", path.display())]
    Taken {
        /// Which result, as the caller names it.
        result: String,
        /// The file.
        path: PathBuf,
        /// The result that it is taken by.
        other: String,
    },
    /// What a format cannot hold.
    #[error("{format}: {message}")]
    Format {
        /// The format's name.
        format: &'static str,
        /// What is wrong.
        message: String,
    },
    /// A field that cannot be computed.
    #[error("field: {0}")]
    Field(#[from] field::FieldError),
}

/// What stands before a message about a line.
fn place(line: Option<usize>) -> String {
    line.map_or_else(String::new, |line| format!("line {line}: "))
}

impl IoError {
    /// An error about a file as a whole.
    #[must_use]
    pub fn file(path: &Path, message: impl ToString) -> Self {
        Self::File {
            path: path.to_owned(),
            line: None,
            message: message.to_string(),
        }
    }

    pub(crate) fn text(line: Option<usize>, message: impl ToString) -> Self {
        Self::Text {
            line,
            message: message.to_string(),
        }
    }

    /// The same about the text of this file.
    pub(crate) fn within(self, path: &Path) -> Self {
        match self {
            Self::Text { line, message } => Self::File {
                path: path.to_owned(),
                line,
                message,
            },
            other => other,
        }
    }
}
