//! The outline of an object in an image, from a contour drawn roughly around it.
//!
//! ```
//! use fit::{Contour, Image, Options, fit};
//! use glam::DVec2;
//!
//! // a bright disc of radius 30 on a dark ground, its border smooth over a pixel
//! let center = DVec2::new(48.0, 44.0);
//! let inside = |p: DVec2| (30.5 - p.distance(center)).clamp(0.0, 1.0);
//! let level = |(y, x)| 40.0 + 160.0 * inside(DVec2::new(x as f64, y as f64));
//! let image = Image::grey(field::Grid::from_shape_fn((96, 96), level));
//!
//! let options = Options { sigma: 1.0, ..Options::default() };
//! let found = fit(&image, &Contour::circle(DVec2::new(49.0, 43.0), 33.0), &options)?;
//! let radii = found.contour.points.iter().map(|p| p.distance(center));
//! let mean = radii.sum::<f64>() / found.contour.points.len() as f64;
//! assert!(found.is_outline() && (mean - 30.0).abs() < 0.05, "{mean}");
//! # Ok::<(), fit::FitError>(())
//! ```
//!
//! The contour becomes an elastic curve, the image a force that pulls it to edges, and the curve
//! comes to rest: on the edge, or where its elasticity stops it. [`Options`] has every choice with
//! its unit and default; [`Fit`] says what was found, how the image supports it as a whole and node
//! by node, and what was chosen.
//!
//! | wanted | by |
//! | --- | --- |
//! | one contour in one image | [`fit`] |
//! | many contours in one image | [`Prepared`], which makes its forces once |
//! | many of them on several threads | [`fit_many`] |
//! | a curve that is watched, pulled, pinned | [`Session`] |
//! | how firmly the image holds an outline, part by part | [`Prepared::pluck`] |
//! | other forces than the edge force | [`force::ImageForceKind`] in [`Options::forces`] |
//! | pixels of other depths, colors, masks | [`Image`], [`Pixels`] |
//!
//! # The way to rest
//!
//! Only where the curve comes to rest is of interest, not how it swings there. So it moves without
//! inertia, in steps of [`integrator::Relaxation`]: at first as short as the image's detail asks
//! for (no node farther than a quarter of σ), so that it finds the edge that a slow motion finds;
//! then longer and longer, until a step is one of Newton's method on the elastic force and the
//! slope of the edge together. Tens to hundreds of steps lead to where thousands of small ones
//! lead.
//!
//! Units: pixels with x to the right and y down, the first pixel's center at (0, 0); grey levels of
//! any range, since all strengths are relative to the image's own contrast.
//!
//! This crate does no I/O, names no flag and no file, and knows no text. Its errors say which
//! option is concerned ([`OptionKey`]), what is needed and what was given.

mod contour;
mod edit;
mod error;
mod evidence;
mod finder;
pub mod force;
mod image;
mod limits;
mod many;
mod nodes;
mod options;
mod pluck;
mod prepared;
mod report;
mod result;
mod session;
mod setup;

pub use contour::Contour;
pub use edit::Edit;
pub use error::{FitError, OptionKey, Problem};
pub use evidence::{Doubt, Evidence, Narrow};
pub use field::Pixels;
pub use image::Image;
pub use many::{Job, fit_many, in_order};
pub use options::{FitForce, MakeForce, Method, Nodes, Options, Step};
pub use pluck::{Pluck, Plucked, Stretch};
pub use prepared::Prepared;
pub use report::Searched;
pub use result::{Choices, Fit, Moved, NodeEvidence, StepReason};
pub use search;
pub use session::Session;

/// Fit a contour to an image: find the outline that it is drawn around.
///
/// # Errors
///
/// As [`Prepared::of`] and [`Prepared::fit`].
pub fn fit(image: &Image, start: &Contour, options: &Options) -> Result<Fit, FitError> {
    Prepared::of(image, options)?.fit(start)
}
