//! What can go wrong around an experiment.

use crate::draw::DrawError;
use std::path::PathBuf;

/// Why an experiment could not be run, drawn or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SandboxError {
    /// A folder that cannot take the figures.
    #[error("cannot write into {path}: {reason}; choose another folder with --out")]
    Folder {
        /// The folder as given.
        path: PathBuf,
        /// What the system said.
        reason: std::io::Error,
    },
    /// A file that cannot be read or written.
    #[error("{path}: {reason}")]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        reason: std::io::Error,
    },
    /// A claim or a drawing asks for something the run did not record.
    #[error("the record has no {kind} called {name}")]
    NotRecorded {
        /// Number, table, column or grid.
        kind: &'static str,
        /// Its name.
        name: String,
    },
    /// A crate below refused what the experiment asked of it.
    #[error("{experiment}: {reason}")]
    Refused {
        /// What was being done.
        experiment: &'static str,
        /// The refusal in the words of the crate below.
        reason: String,
    },
    /// An experiment that is not one of those asked among.
    #[error("--only must be one of {known}, got {id}")]
    Unknown {
        /// What was asked for.
        id: String,
        /// The ids there are.
        known: String,
    },
    /// A figure could not be drawn.
    #[error(transparent)]
    Draw(#[from] DrawError),
}

impl SandboxError {
    /// A refusal from below, with what was being done.
    pub(crate) fn refused<E: std::fmt::Display>(experiment: &'static str) -> impl Fn(E) -> Self {
        move |reason| Self::Refused {
            experiment,
            reason: reason.to_string(),
        }
    }
}
