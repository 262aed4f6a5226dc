//! The snake of Kass, Witkin and Terzopoulos (1988), with the parameters by which other programs know it.
//!
//! ```
//! use classic::{Picture, Rules, settle};
//! use glam::DVec2;
//!
//! // a bright disc of radius 20 with a soft border, and 100 points around it
//! let inside = |p: DVec2| 1.0 / (1.0 + ((p.distance(DVec2::splat(40.0)) - 20.0) / 1.5).exp());
//! let level = |row: usize, column: usize, _| inside(DVec2::new(column as f64, row as f64));
//! let picture = Picture { height: 80, width: 80, channels: 1, level };
//! let circle = |i| DVec2::splat(40.0) + 26.0 * DVec2::from_angle(f64::from(i) * 0.02 * std::f64::consts::PI);
//! let start: Vec<DVec2> = (0..100).map(circle).collect();
//!
//! let settled = settle(&picture, &start, &Rules::default(), &|| false)?;
//! let mean = settled.points.iter().map(|p| p.distance(DVec2::splat(40.0))).sum::<f64>() / 100.0;
//! assert!((mean - 20.0).abs() < 0.5, "{mean}");
//! # Ok::<(), classic::ClassicError>(())
//! ```
//!
//! Points `v` of index `i` minimise `∫ α |v'|² + β |v''|² − E(v)` with `E` the weighted sum of grey levels and of
//! the size of their Sobel gradient. A step is implicit in the elastic part and explicit in the picture's
//! (\[kass88\] Eq. 14 to 19), and its length is limited by a hyperbolic tangent. Between pixels `E` is the quadratic
//! spline through them. Everything is counted in points, not in arc length: α and β mean another stiffness for
//! another number of points. [`fit`](https://docs.rs/snakes) has none of these bounds; this crate is here for those
//! who have their parameters.
//!
//! Two rules are stricter than what is usual. A snake that still moves one way is not at rest, however slowly it does
//! ([`Stop::Settled`]); and one that has collapsed onto a point is tried again with points between its own
//! ([`Settled::between`]).
//!
//! Units: pixels with x to the right and y down, the first pixel's center at (0, 0).

#![cfg_attr(
    test,
    allow(
        clippy::float_cmp,
        clippy::unwrap_used,
        reason = "a test that says equal means equal, and may stop the process"
    )
)]

mod energy;
mod error;
mod matrix;
mod rest;
mod rules;
mod spline;
mod walk;

pub use energy::Picture;
pub use error::ClassicError;
pub use rules::{Border, Ends, Rules};
pub use walk::{Settled, Stop, settle};
