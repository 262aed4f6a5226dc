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
        /// Number, table, column, grid or run.
        kind: &'static str,
        /// Its name.
        name: String,
    },
    /// A crate below refused what an experiment asked of it, in that crate's words.
    #[error("{0}")]
    Refused(String),
    /// Something went wrong in an experiment.
    #[error("{experiment}: {reason}")]
    In {
        /// Which.
        experiment: &'static str,
        /// What.
        reason: Box<Self>,
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

/// What experiments return; a record unless something else is named.
pub type Result<T = crate::Record, E = SandboxError> = std::result::Result<T, E>;

/// A refusal in words.
pub fn refused(reason: impl std::fmt::Display) -> SandboxError {
    SandboxError::Refused(reason.to_string())
}

/// Errors of the crates below become refusals.
macro_rules! refusals {
    ($($error:ty),*) => {
        $(impl From<$error> for SandboxError {
            fn from(error: $error) -> Self {
                refused(error)
            }
        })*
    };
}

refusals!(
    banded::BandedError,
    elastic::ElasticError,
    field::FieldError,
    io::IoError,
    fit::FitError,
    integrator::Fault,
    integrator::SchemeError,
    outline::OutlineError,
    scene::SceneError,
    snake::SimulationError,
    snake::SnakeError
);
