//! An outline followed through a sequence of frames.
//!
//! ```
//! use fit::{Contour, Image};
//! use glam::DVec2;
//! use track::{Options, State, Tracker};
//!
//! // a bright disc of radius 14 that moves three pixels a frame
//! let frame = |t: f64| {
//!     let center = DVec2::new(30.0 + 3.0 * t, 40.0);
//!     let inside = |p: DVec2| (14.5 - p.distance(center)).clamp(0.0, 1.0);
//!     let level = |(y, x)| 60.0 + 120.0 * inside(DVec2::new(x as f64, y as f64));
//!     Image::grey(field::Grid::from_shape_fn((80, 120), level))
//! };
//! let mut tracker = Tracker::new(&frame(0.0), &[Contour::circle(DVec2::new(30.0, 40.0), 14.0)], &Options::default())?;
//! for t in 1..8 {
//!     let tracked = tracker.next(&frame(f64::from(t)))?;
//!     let outline = &tracked.outlines[0];
//!     assert_eq!((outline.id, outline.state), (1, State::Seen));
//!     let middle = outline.points.iter().sum::<DVec2>() / outline.points.len() as f64;
//!     assert!(middle.distance(DVec2::new(30.0 + 3.0 * f64::from(t), 40.0)) < 0.5, "{middle}");
//! }
//! # Ok::<(), track::TrackError>(())
//! ```
//!
//! In each frame an object is
//!
//! 1. **predicted**: where the picture's flow carries it and what it encloses, where it was, and where it flies to by
//!    its own motion;
//! 2. **searched**, by its appearance, where no prediction is good enough;
//! 3. **corrected**: the best closed chain of offsets along its normals, exactly, from what lies inside, outside and
//!    across each node, as a similarity first, then in slow waves, then in full;
//! 4. **learnt**: its appearance, node by node, as far as it was seen; its motion; its rest shape.
//!
//! Where it is not seen it flies on, and says so.
//!
//! Of many objects, each knows where the others are expected: what belongs to another is none of its own, and what may
//! belong to either says nothing. Of two that end on one, the one with less evidence looks elsewhere, and ends if both
//! stay together. Outlines in contact have a common border. With [`Options::births`], the frame is also compared with
//! what all objects together look like: one that has become two closed regions, or has a neck that is darker than both
//! its sides, divides (which is undone if its children do not last for two frames); a region that looks like objects
//! and is none of them is a new one, or one that comes back; and one whose place is empty is lost.
//!
//! Units: pixels, x to the right and y down, the first pixel's center at (0, 0); times in frames. This crate reads no
//! files.

mod assign;
mod blend;
mod body;
mod born;
mod by_hand;
mod candidates;
mod contact;
mod correct;
mod crowd;
mod divide;
mod edges;
mod error;
mod evidence;
mod follow;
mod holes;
mod light;
mod mixed;
mod neck;
mod options;
mod palette;
mod plane;
mod predict;
mod profile;
mod region;
mod remesh;
mod result;
mod ring;
mod seek;
mod shape;
mod sight;
mod start;
mod step;
mod tables;
mod tracker;
mod twin;
mod view;
mod window;

pub use blend::blended;
pub use contact::bordered;
pub use error::TrackError;
pub use options::{Options, Start};
pub use predict::Prediction;
pub use result::{Event, Happening, Outline, Tracked};
pub use start::overlap;
pub use step::State;
pub use tracker::Tracker;
