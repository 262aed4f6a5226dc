//! Measures of outlines, and of their agreement with truth.
//!
//! ```
//! use glam::DVec2;
//! use score::{Agreement, Measures, border, filled, iou};
//!
//! let square = |x: f64, side: f64| {
//!     let corner = |i: f64, j: f64| DVec2::new(x + i * side, 2.0 + j * side);
//!     vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)]
//! };
//! let (truth, found) = ([square(2.0, 10.0)], [square(4.0, 10.0)]);
//!
//! // as masks: 8 columns of 10 in common, 12 in all
//! let (a, b) = (filled(&truth, (16, 20)), filled(&found, (16, 20)));
//! assert_eq!(iou(&a, &b)?, 8.0 / 12.0);
//! assert_eq!(border(&a).len(), 1);
//!
//! // as curves: nowhere farther apart than the shift
//! let agreement = Agreement::of(&found, &truth, 2.5)?;
//! assert!((agreement.hausdorff - 2.0).abs() < 1e-12 && agreement.f() == 1.0);
//!
//! // by itself
//! let measures = Measures::of(&found)?;
//! assert_eq!((measures.area, measures.perimeter, measures.solidity), (100.0, 40.0, 1.0));
//! # Ok::<(), score::ScoreError>(())
//! ```
//!
//! | wanted | by |
//! | --- | --- |
//! | a mask of outlines, the outlines of a mask | [`filled`], [`border`] |
//! | how well two masks agree | [`iou`] |
//! | how far two outlines are apart | [`Agreement`] |
//! | whether an outline lies outside or inside of the truth, to a fraction of a pixel | [`Deviation`] |
//! | how well two images of labels agree | [`Instances`] |
//! | how well objects are followed through a sequence | [`tracking`] |
//! | distance from the truth along a normal, and whether a band holds it | [`along_normal`], [`calibration`] |
//! | a picture whose truth is a formula | [`synthetic`] |
//! | a sequence of frames whose truth is a formula | [`sequences`] |
//! | area, axes, roundness and so on of one outline | [`Measures`], [`curvature_extremes`], [`GreyMeans`] |
//!
//! An *outline* is one closed polygon or several: each a list of nodes, the last joined to the first. A point is inside
//! if a ray from it meets them an odd number of times, so a polygon in another is a hole, whichever way round it runs.
//! Nothing here depends on where a polygon begins or on its sense.
//!
//! Units: pixels with x to the right and y down, the first pixel's center at (0, 0). This crate reads no files.

#![cfg_attr(
    test,
    allow(
        clippy::float_cmp,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a test that says equal means equal, and its numbers are small"
    )
)]

mod agreement;
mod border;
mod curvature;
mod deviation;
mod error;
mod grey;
mod instances;
mod mask;
mod measures;
mod normal;
pub mod sequences;
pub mod synthetic;
pub mod table;
pub mod tracking;

pub use agreement::Agreement;
pub use border::border;
pub use curvature::curvature_extremes;
pub use deviation::Deviation;
pub use error::ScoreError;
pub use grey::GreyMeans;
pub use instances::{Instances, THRESHOLDS};
pub use mask::{filled, iou};
pub use measures::Measures;
pub use normal::{along_normal, calibration};
