//! Objects that look like the one that is followed, and are not it.

use field::Pixels;
use glam::DVec2;

use crate::body::{Body, Seen};
use crate::evidence::{Evidence, Look};
use crate::follow::MARGIN;
use crate::profile::Profiles;
use crate::ring;
use crate::tables::{Strips, depth};
use crate::window::Window;

/// What is found so many radii from where the object was, and had this share of its evidence there then, is another
/// one.
const APART: f64 = 1.0;
const TWIN: f64 = 0.7;

impl Body {
    /// Whether what was found elsewhere was already there when the object was seen last: then it is another one
    /// like it.
    pub(crate) fn was_there(&self, found: &Seen, radius: f64) -> bool {
        let Some((image, middle)) = &self.seen_in else {
            return false;
        };
        if ring::middle(&found.curve).distance(*middle) < APART * radius {
            return false;
        }
        let before = self.evidence_in(image.pixels(), &found.curve, radius, Some(&self.profiles));
        before.mean > TWIN * found.evidence.mean
    }

    /// What a picture says for a curve anywhere in it, in cells, by what is remembered of this body; `radius` of the
    /// object in cells.
    pub(crate) fn evidence_in(
        &self,
        pixels: &dyn Pixels,
        curve: &[DVec2],
        radius: f64,
        profiles: Option<&Profiles>,
    ) -> Evidence {
        let (low, high) = ring::bounds(curve);
        let margin = DVec2::splat(depth(radius) + MARGIN);
        let window = Window::of(pixels, self.block, self.light, low - margin, high + margin);
        let ratios = self.remembered().ratios();
        let look = Look {
            window: &window,
            palette: &self.palette,
            ratios: &ratios,
            profiles,
            edges: None,
        };
        Evidence::of(look, &Strips::of(curve, radius))
    }
}
