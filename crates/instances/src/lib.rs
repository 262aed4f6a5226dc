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
//! Without seeds, or with points, regions are proposed first: the components above each level of the smoothed picture,
//! nested in each other, at the levels where their borders are steepest; their parts around each peak and each depth;
//! and what is left of them beside objects already chosen. Each is judged by the share of its border that is an edge
//! against its own contrast, by its shape, and by its contrast against noise and against that of the others. The set
//! without much overlap that is worth most in all is chosen, of light or of dark objects, whichever is worth more; a
//! point chooses among the regions that hold no other. A region then stands for its seed in steps 2 to 5.
//!
//! Units: pixels, x to the right and y down, the first pixel's center at (0, 0).

mod all;
mod auto;
mod beside;
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
pub use beside::in_contact;
pub use rules::Rules;
pub use seeds::{Circle, SeedError, Seeds};
pub use support::Support;
