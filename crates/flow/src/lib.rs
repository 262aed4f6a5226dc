//! Where points of one frame are in the next.
//!
//! - **Flow.** Each point is followed by itself: the shift under which the square of pixels about it differs least, by
//!   Newton's method from the coarsest of several halved pictures to the full one (\[lucas81\], \[bouguet00\]). A
//!   point is followed back as well; how far it ends from where it began says how far to trust it.
//! - **Similarity.** One translation, rotation and scale for all points, by least squares with weights that leave out
//!   what moves otherwise (\[holland77\], Cauchy's weights).
//!
//! Units: pixels, x to the right and y down, the first pixel's center at (0, 0). O(pixels) for a pyramid, O(points) for
//! the rest.
//!
//! ```
//! use flow::{Pyramid, Rules, carry};
//! use glam::DVec2;
//! use ndarray::Array2;
//!
//! let texture = |x: f64, y: f64| 50.0 + 20.0 * (0.5 * x).sin() * (0.4 * y + 0.1 * x).cos();
//! let frame = |moved: f64| Array2::from_shape_fn((64, 64), |(y, x)| texture(x as f64 - moved, y as f64) as f32);
//! let (first, second) = (Pyramid::of(frame(0.0), 4), Pyramid::of(frame(2.3), 4));
//! let moved = carry(&first, &second, &[DVec2::new(30.0, 30.0)], &Rules::default());
//! let to = moved[0].unwrap().to;
//! assert!(to.distance(DVec2::new(32.3, 30.0)) < 0.05, "{to}");
//! ```

mod patch;
mod points;
mod pyramid;
mod similarity;

pub use points::{Moved, Rules, carry};
pub use pyramid::Pyramid;
pub use similarity::{Similarity, similarity};
