//! What can be wrong with a start or a frame.

use fit::FitError;

/// Why a track cannot begin or go on.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TrackError {
    /// Not one outline to begin with.
    #[error("at least one outline is needed to follow")]
    NoStart,
    /// A start that encloses nothing, is open, or lies outside the frame.
    #[error(
        "start {index}: must be a closed outline with an area in the frame of {width}×{height} pixels"
    )]
    Start {
        /// Its number, from 0.
        index: usize,
        /// Of the frame. Pixels.
        width: usize,
        /// Of the frame. Pixels.
        height: usize,
    },
    /// The first outline could not be found.
    #[error("start {index}: {error}")]
    Fit {
        /// Its number, from 0.
        index: usize,
        /// What is wrong.
        error: FitError,
    },
    /// A frame of another size than the first.
    #[error("frame {frame}: must be {}×{} pixels as the first, got {}×{}", needed.0, needed.1, got.0, got.1)]
    Size {
        /// Its number, from 0.
        frame: usize,
        /// Width and height of the first.
        needed: (usize, usize),
        /// Its own.
        got: (usize, usize),
    },
    /// An object that is not followed.
    #[error("no object {id} is followed; there are {known:?}")]
    NoObject {
        /// The number asked for.
        id: u32,
        /// The numbers there are.
        known: Vec<u32>,
    },
}
