//! Objects followed through the frames of a sequence, against truth.
//!
//! Everything is fed frame by frame, and keeps what it needs of objects, not of frames.
//!
//! | wanted | by |
//! | --- | --- |
//! | one object: overlap, boundary and distance a frame, and their means | [`Following`] |
//! | many objects as images of labels: SEG, DET, TRA, IDF1, switches, divisions | [`Tracks`] |
//! | outlines as an image of labels | [`labelled`] |
//! | the best one-to-one match of rows and columns | [`assignment`] |
//!
//! ```
//! use ndarray::array;
//! use score::tracking::{Lineage, Tracks};
//!
//! // one object divides in two; what was found misses one of the two
//! let mut tracks = Tracks::default();
//! tracks.add(&array![[5, 5, 5, 5]], &array![[1, 1, 1, 1]])?;
//! tracks.add(&array![[5, 5, 0, 0]], &array![[2, 2, 3, 3]])?;
//! let line = |label, begin, end, parent| Lineage { label, begin, end, parent };
//! let truth = [line(1, 0, 0, 0), line(2, 1, 1, 1), line(3, 1, 1, 1)];
//! let scores = tracks.finish(&[line(5, 0, 1, 0)], &truth)?;
//! // a node and an edge are missing, and an edge within a track should be one from a parent
//! assert_eq!((scores.errors.missed, scores.errors.added, scores.errors.changed), (1, 1, 1));
//! assert_eq!(scores.tra, Some(1.0 - 12.5 / 33.0));
//! # Ok::<(), score::ScoreError>(())
//! ```

mod assignment;
mod davis;
mod divisions;
mod following;
mod graph;
mod identities;
mod labels;
mod overlaps;
#[cfg(test)]
mod tests;
mod tracks;
#[cfg(test)]
mod twins;

pub use assignment::assignment;
pub use davis::boundary_f;
pub use following::{Followed, FollowedFrame, Following};
pub use graph::GraphErrors;
pub use labels::labelled;
pub use tracks::{Lineage, TrackScores, Tracks};
