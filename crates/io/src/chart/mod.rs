//! Charts as pictures: what goes on along an outline over the frames, and where things went.

mod axes;
mod colors;
mod kymograph;
mod paths;

pub use kymograph::Kymograph;
pub use paths::{Path, paths};
