//! Where the edge lies along the normals of an outline: to a fraction of a pixel, with error bars.
//!
//! An outline that some search has found lies within a few pixels of its edge. Here it becomes a
//! snake that moves along its own normals only, so that nothing can fold or slide, and is pulled by
//! the picture alone:
//!
//! - **Edge.** Across the outline the picture is a step that a Gaussian has blurred: levels inside
//!   and outside, smoothed along the curve, and one σ for the whole outline, the one under which the
//!   profiles are best explained. The pull on a node is the slope of the likelihood of such a step,
//!   its stiffness the Fisher information.
//! - **Blur.** An edge that is blurred over more than two pixels is read in blocks of two, four or eight.
//! - **Body.** Rigidity, out of a rest shape that is the outline itself without its short waves. How
//!   stiff it is follows from the picture by generalised cross-validation (\[craven79\],
//!   with the factor of \[kim04\]): noisy edges are smoothed over more pixels than clear ones.
//! - **Curvature.** Blur moves a curved edge inwards by σ²κ/2. That is added again.
//! - **Error bars.** The inverse of the final stiffness (\[wahba83\]), and what is unknown of the two
//!   levels.
//! - **Doubt.** Where no blurred step explains the profile (a line, a halo, a second edge beside the
//!   first), the outline stays where it was found, and has no error bar. If that is most of it, it is
//!   left as it was, whole.
//!
//! Units: pixels, the first pixel's center at (0, 0). O(length of the outline); the rest of the
//! picture is not looked at.

mod blocks;
mod coarse;
mod normal;
mod patch;
mod profile;
mod reading;
mod refine;
mod stiffness;

pub use refine::{Blurred, Precise, Rules, as_found, refine};
