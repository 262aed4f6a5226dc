//! The outlines of many objects in one picture, such as cells: one for each, and a label for each pixel.
//!
//! 1. **Seeds.** Circles of half the size of their objects, points, labels, or automatic ([`Seeds`]).
//! 2. **Model.** Pixels of the whole picture are sorted into classes of color and texture; each has a likelihood inside
//!    objects and outside, first by the seeds, then by what was found. The color across an outline follows from it.
//! 3. **Search.** The best closed curve along rays from each seed, by dynamic programming; what is nearer to another
//!    seed, in units of radii, is unlikely. Then the best curve in a band about the result.
//! 4. **Last stage.** An outline that is large against the blur of its edge is moved onto it below a pixel.
//! 5. **Contact.** Outlines that overlap or nearly touch get one common border.
//!
//! Automatic seeds are blobs over all sizes, lighter or darker than their surroundings. About each the best outline is
//! found, and of all outlines the set without overlap is chosen whose worth is largest: length times edge and
//! likelihood, less for one that is not convex. One outline is tried for two neighbours, and several for one.
//!
//! Units: pixels, x to the right and y down, the first pixel's center at (0, 0).

mod all;
mod auto;
mod contact;
mod jobs;
mod judge;
mod model;
mod points;
mod propose;
mod rays;
mod region;
mod relief;
mod ribbon;
mod rules;
mod seeded;
mod seeds;
mod select;
mod spans;
mod support;
mod tree;

pub use all::{Instances, Object, outline_all};
pub use rules::Rules;
pub use seeds::{Circle, SeedError, Seeds};
pub use support::Support;
