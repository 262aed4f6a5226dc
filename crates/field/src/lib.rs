//! From an image to a force field: what pulls a snake to an edge.
//!
//! ```text
//!   image ── smooth ── differentiate ── length ── differentiate ──▶ ForceField ── at(p) ──▶ force
//!    I         G ∗ I       ∇(G ∗ I)     P = |∇|     gain · ∇P
//! ```
//!
//! | wanted | by |
//! | --- | --- |
//! | the program of the report's Appendix A, to the last bit, slips included | [`report_force`] |
//! | the same idea with the slips put right | [`edge_force`] |
//! | either of them fast, in `f32`, for 8-bit, 16-bit or float pixels | [`FastForce`], [`fast_force`] |
//! | … only where someone looks | [`lazy_force`] |
//! | edges in color, at several scales; lines; ends and corners | a strength grid and [`gradient_force`] |
//! | edges of one polarity | [`SignedEdge`], which asks for the curve's normal |
//! | what lies inside a curve and what outside | a [`Region`], which asks for the curve: [`TwoRegions`], [`LocalRegions`], [`LikelihoodRegions`] |
//! | texture, as channels for these | [`texture_channels`] |
//! | only some of the pixels | [`MaskedImage`] |
//! | a schedule from coarse to fine | [`coarse_to_fine`] |
//! | edges to a fraction of a pixel | [`edge_points`] |
//! | noise, contrast and blur of a picture | [`image_scale`] |
//! | a picture whose truth is known | [`drawn`] |
//! | a number at every place, from grey, edges, contrast or distance | [`Map`] and [`grey_share`], [`edge_share`], … |
//! | a longer reach | [`distance_force`], [`point_distance_force`], [`vector_flow`] (GVF), [`vector_convolution`] (VFC) |
//!
//! All but those that ask for the curve give a [`ForceField`], which is sampled between pixel centers: bilinear, bicubic, with
//! its slope, or by the report's rule. [`signal`] is the chapter's one-dimensional part, [`literal`] the slow twin
//! that checks the fast code.
//!
//! Conventions: x to the right, y **down**, pixel centers at whole numbers, the first at (0, 0); grids are indexed
//! `[[row, column]]`. Images are checked at the door: no empty ones, no pixel that is NaN or infinite. One pixel,
//! one row or a constant is a fine image; it has no edge and so no force.
//!
//! This crate does no I/O and knows nothing of what will feel the force.
//!
//! ```
//! use field::{EdgeForce, Grid, edge_force};
//! use glam::DVec2;
//!
//! // dark left of x = 15.5, bright right of it
//! let image = Grid::from_shape_fn((32, 32), |(_, x)| if x > 15 { 200.0 } else { 50.0 });
//! let field = edge_force(&image, &EdgeForce::as_strong_as_the_report())?;
//! assert!(field.at(DVec2::new(12.0, 16.0)).x > 0.0); // left of the edge: pulled right
//! assert!(field.at(DVec2::new(19.0, 16.0)).x < 0.0); // right of the edge: pulled left
//! # Ok::<(), field::FieldError>(())
//! ```

mod canny;
mod convolution;
mod diffusion;
mod distance;
pub mod drawn;
mod edge;
mod error;
mod fast;
mod force_field;
mod gradient;
mod grid;
mod levels;
pub mod literal;
mod map;
mod masked;
mod measure;
mod pixels;
mod points;
mod polarity;
mod region;
mod report;
mod sample;
mod scales;
pub mod signal;
mod smooth;
mod strength;

pub use canny::{Canny, EdgePoint, edge_points};
pub use convolution::{Falloff, vector_convolution};
pub use diffusion::{Flow, FlowRule, MOST_CYCLES, VectorFlow, vector_flow};
pub use distance::{distance_force, edge_pixels, squared_distance};
pub use edge::{EdgeForce, EdgeStages, edge_force, edge_stages, gradient_force};
pub use error::{FieldError, OutsideField};
pub use fast::{FastForce, Pixel, Recipe, fast_force, lazy_force};
pub use force_field::ForceField;
pub use gradient::{Across, mask_x, mask_y};
pub use grid::{Grid, LARGEST_PIXEL, LARGEST_SIGMA, MOST_PASSES};
pub use levels::{level_limits, level_spread};
pub use map::{Map, contrast_share, distance_share, edge_share, grey_share};
pub use masked::MaskedImage;
pub use measure::{ImageScale, image_scale, noise_sigma};
pub use pixels::{Pixels, counted_limits};
pub use points::{distance_to_points, point_distance_force};
pub use polarity::{Polarity, SignedEdge};
pub use region::{
    Classes, Density, LikelihoodRegions, LocalRegions, MOST_CLASS_BYTES, MOST_CLASSES, Means,
    Region, RegionScratch, TwoRegions, texture_channels,
};
pub use report::{REPORT_GAIN, REPORT_SCALE, ReportStages, report_force, report_stages};
pub use sample::Interpolation;
pub use scales::{CoarseToFine, Scale, coarse_to_fine};
pub use smooth::{REPORT_PASSES, Smoothing, binomial_x, binomial_y, gaussian_weights};
pub use strength::{
    Line, color_edge_strength, line_strength, multiscale_edge_strength, termination_strength,
};
