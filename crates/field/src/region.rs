//! Forces from what lies inside a closed curve and what outside, without looking at the area.
//!
//! Sums over the inside of a polygon are differences of row sums at its border (Green's theorem), so a step costs
//! the pixels the curve crosses, not its area. Not here yet: open curves, and holes.

mod classes;
mod cluster;
mod likelihood;
mod local;
mod mixture;
mod rows;
mod texture;
mod two;

pub use classes::{Classes, MOST_CLASS_BYTES, MOST_CLASSES};
pub use likelihood::{Density, LikelihoodRegions};
pub use local::LocalRegions;
pub use texture::texture_channels;
pub use two::{Means, TwoRegions};

use glam::DVec2;
use rows::Crossings;
use std::fmt::Debug;

/// A force along the normal of a closed curve, from what it encloses and what not.
///
/// **Signs need no choice.** A positive push lets the curve grow, whichever way the polygon runs and whichever side is the
/// brighter: inside is what the polygon encloses, and the statistics of both sides come from the picture. No kind
/// here turns inside and outside round, as methods without a curve of their own may.
///
/// A picture is prepared once and shared by all copies. Curves of fewer than three nodes enclose nothing.
pub trait Region: Debug + Send + Sync {
    /// Force density along the outward normal where `polygon` is the curve and its border passed through each of `points`; overwrites
    /// `push`.
    ///
    /// At the polygon's own nodes it is what they feel; at all pixels, a map of what would join the inside (above 0) and what would leave it.
    /// The shorter of `points` and `push` says for how many. A place that is none (NaN) may make every push NaN. Allocates nothing once
    /// `scratch` has grown to its size.
    fn push_at(
        &self,
        polygon: &[DVec2],
        points: &[DVec2],
        scratch: &mut RegionScratch,
        push: &mut [f64],
    );

    /// [`Region::push_at`] the nodes.
    fn push_into(&self, polygon: &[DVec2], scratch: &mut RegionScratch, push: &mut [f64]) {
        self.push_at(polygon, polygon, scratch, push);
    }

    /// The energy whose derivative by the normal motion of the curve is minus the push; `None` if there is none.
    fn energy(&self, polygon: &[DVec2]) -> Option<f64>;
}

/// Memory that a [`Region`] uses again from step to step. Any kind may use any one's.
#[derive(Debug, Clone, Default)]
pub struct RegionScratch {
    crossings: Crossings,
    /// Push, pixels on one side and slope of the cost by class.
    table: Vec<f64>,
    side: Vec<f64>,
    slope: Vec<f64>,
}

/// Twice the area of a closed polygon with its sign.
fn signed_area(polygon: &[DVec2]) -> f64 {
    let Some(&last) = polygon.last() else {
        return 0.0;
    };
    let from = std::iter::once(&last).chain(polygon);
    from.zip(polygon).map(|(a, b)| a.perp_dot(*b)).sum()
}

#[cfg(test)]
mod tests;
