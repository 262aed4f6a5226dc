//! A picture as a whole for searches of many objects: edges and classes of pixels at one scale.

use std::sync::OnceLock;

use field::{Grid, Pixels};
use glam::DVec2;

use crate::along::sample;
use crate::codebook::Codebook;
use crate::edges::{Across, Edges, dot, percentile, size};
use crate::frame::Frame;

/// A picture at one scale, with what all searches of its objects share. Places and lengths are in its own pixels.
#[derive(Debug)]
pub struct Whole {
    frame: Frame,
    edges: Edges,
    codebook: OnceLock<Codebook>,
}

impl Whole {
    /// A picture made larger or smaller: means over areas where it is made smaller, linear between pixels otherwise.
    #[must_use]
    pub fn new(pixels: &dyn Pixels, scale: f64) -> Self {
        let frame = Frame::whole(pixels, scale);
        let edges = Edges::of(&frame, |at| known(&frame, at));
        Self {
            frame,
            edges,
            codebook: OnceLock::new(),
        }
    }

    /// Height and width.
    #[must_use]
    pub fn dim(&self) -> (usize, usize) {
        self.frame.dim()
    }

    /// Pixels a pixel of the picture.
    #[must_use]
    pub const fn scale(&self) -> f64 {
        self.frame.scale
    }

    /// A point of the picture here.
    #[must_use]
    pub fn inward(&self, p: DVec2) -> DVec2 {
        self.frame.to_window(p)
    }

    /// A point from here in the picture.
    #[must_use]
    pub fn outward(&self, p: DVec2) -> DVec2 {
        self.frame.to_picture(p)
    }

    /// Lightness of a grey picture in percent of its range, or CIE L\*a\*b\*.
    #[must_use]
    pub fn channels(&self) -> &[Grid] {
        &self.frame.channels
    }

    /// Which pixels show the picture and count.
    #[must_use]
    pub fn known(&self) -> Vec<bool> {
        (0..self.frame.known.len())
            .map(|at| known(&self.frame, at))
            .collect()
    }

    /// The slopes of the channels along a normal.
    #[must_use]
    pub fn across(&self, p: DVec2, normal: DVec2) -> [f64; 3] {
        self.edges.across(p, normal)
    }

    /// The length of the slope over all channels and directions.
    #[must_use]
    pub fn slope(&self, p: DVec2) -> f64 {
        size(self.across(p, DVec2::X)).hypot(size(self.across(p, DVec2::Y)))
    }

    /// The slope that counts as half an edge in the picture as a whole.
    #[must_use]
    pub const fn half(&self) -> f64 {
        self.edges.half()
    }

    /// The least slope that may count as half an edge anywhere: so many times what noise alone gives. The noise of an
    /// enlarged picture is not white, and less of it is smoothed away.
    #[must_use]
    pub fn least(&self) -> f64 {
        self.edges.least() * self.frame.scale.max(1.0).powf(1.5)
    }

    /// Standard deviation of white noise that leaves as much as that of the channels where it is smoothed over several
    /// pixels.
    #[must_use]
    pub fn noise(&self) -> f64 {
        self.edges.noise() * self.frame.scale.max(1.0).powf(1.5)
    }

    /// How much likelier each pixel is among `inside` than among `outside`, by its class of color and texture: a
    /// logarithm, cut at ±2.
    #[must_use]
    pub fn likelihood(&self, inside: &[bool], outside: &[bool]) -> Grid {
        let counts =
            |side: &[bool], at: usize| side.get(at) == Some(&true) && known(&self.frame, at);
        let codebook = self
            .codebook
            .get_or_init(|| Codebook::of(&self.frame, |at| known(&self.frame, at)));
        let ratios = codebook.ratios(|at| {
            let inside = counts(inside, at);
            (inside || counts(outside, at)).then_some(inside)
        });
        codebook.map(&ratios, self.frame.dim())
    }

    /// The median color of some pixels less that of others, to length 1; None if there is no difference.
    #[must_use]
    pub fn polarity(&self, inside: &[bool], outside: &[bool]) -> Option<[f64; 3]> {
        let mut difference = [0.0; 3];
        for (difference, channel) in difference.iter_mut().zip(&self.frame.channels) {
            let median = |side: &[bool]| {
                let both = channel.iter().zip(side).enumerate();
                let chosen = both.filter(|(at, (_, one))| **one && known(&self.frame, *at));
                let mut list: Vec<f64> = chosen.map(|(_, (value, _))| *value).collect();
                percentile(&mut list, 0.5)
            };
            *difference = median(inside) - median(outside);
        }
        crate::codebook::unit(difference)
    }
}

fn known(frame: &Frame, at: usize) -> bool {
    frame.known.as_slice().is_some_and(|known| known[at] > 0.0)
}

/// A value of a grid between its pixels, linear; beyond its border the last pixel is repeated.
#[must_use]
pub fn at(grid: &Grid, p: DVec2) -> f64 {
    sample(grid, p)
}

/// A grid smoothed by a Gaussian; beyond the border the last pixel is repeated.
#[must_use]
pub fn blurred(grid: &Grid, sigma: f64) -> Grid {
    crate::edges::blurred(grid, sigma)
}

/// The slope against a polarity: above 0 from the color of the object to that of its ground.
#[must_use]
pub fn signed(across: Across, polarity: Option<[f64; 3]>) -> f64 {
    polarity.map_or_else(|| size(across), |direction| -dot(across, direction))
}

/// The value that a share of a list does not reach; 0 for an empty one. The list is reordered.
#[must_use]
pub fn quantile(list: &mut [f64], share: f64) -> f64 {
    percentile(list, share)
}
