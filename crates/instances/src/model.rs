//! What all searches in a picture share: how likely each pixel is inside an object, and the color across its border.

use field::Grid;
use glam::DVec2;
use search::whole::{Whole, at, quantile, signed};

/// A slope is half an edge at least at this share of what it is in the picture as a whole.
const DIM: f64 = 1.0;

/// Logarithm of the likelihood of a pixel that is nearer to another seed.
const RIVAL: f64 = -2.0;

/// What all searches share.
#[derive(Debug)]
pub(crate) struct Model<'a> {
    pub whole: &'a Whole,
    /// How much likelier each pixel is inside an object than outside: a logarithm.
    pub likelihood: Option<Grid>,
    /// Direction of color from the ground to the objects; None for edges of any polarity.
    pub polarity: Option<[f64; 3]>,
}

/// A seed at the scale of the model.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Seed {
    pub center: DVec2,
    /// Half the radius of a disk of the object's area.
    pub inner: f64,
    /// Other seeds near this one, and how their radii compare to its own.
    pub rivals: Vec<(DVec2, f64)>,
}

impl Seed {
    /// Whether another seed is nearer, in units of radii.
    pub(crate) fn is_of_rival(&self, p: DVec2) -> bool {
        let own = p.distance_squared(self.center);
        let mut rivals = self.rivals.iter();
        rivals.any(|(center, share)| p.distance_squared(*center) < own * share * share)
    }
}

impl Model<'_> {
    /// How much likelier a place is inside the object of a seed than outside.
    pub(crate) fn likelihood(&self, seed: &Seed, p: DVec2) -> f64 {
        if seed.is_of_rival(p) {
            return RIVAL;
        }
        let likelihood = self.likelihood.as_ref();
        likelihood.map_or(0.0, |grid| at(grid, p))
    }

    /// The slope across a normal, above 0 if it is of the right polarity.
    pub(crate) fn signed(&self, p: DVec2, normal: DVec2) -> f64 {
        signed(self.whole.across(p, normal), self.polarity)
    }

    /// The slope that counts as half an edge around a seed: what three quarters of the places there do not have.
    pub(crate) fn half(&self, slopes: &mut [f64]) -> f64 {
        let own = quantile(slopes, 0.75);
        own.max(DIM * self.whole.half()).max(self.whole.least())
    }
}

/// How much of an edge a slope is, from 0 to 1.
pub(crate) fn strength(slope: f64, half: f64) -> f64 {
    if slope > 0.0 {
        slope / (slope + half)
    } else {
        0.0
    }
}
