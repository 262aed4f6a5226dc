//! What all searches in a picture share: how likely each pixel is inside an object, and the color across its border.

use field::Grid;
use glam::DVec2;
use ndarray::Array2;
use search::whole::{Whole, at, quantile, signed};

/// A slope is half an edge at least at this share of what it is in the picture as a whole.
const DIM: f64 = 1.0;

/// Logarithm of the likelihood of a pixel that is nearer to another seed.
const RIVAL: f64 = -2.0;

/// Logarithm of the likelihood of a pixel that is known to belong to the seed, and below 0 of another.
const KNOWN: f64 = 1.0;

/// What all searches share.
#[derive(Debug)]
pub(crate) struct Model<'a> {
    pub whole: &'a Whole,
    /// How much likelier each pixel is inside an object than outside: a logarithm.
    pub likelihood: Option<Grid>,
    /// The number of the seed that each pixel is known to belong to, from 1; 0 for none.
    pub owners: Option<Array2<u32>>,
    /// Direction of color from the ground to the objects; None for edges of any polarity.
    pub polarity: Option<[f64; 3]>,
}

/// A seed at the scale of the model.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Seed {
    pub center: DVec2,
    /// Its number, from 1; 0 for one that is not counted.
    pub number: u32,
    /// Half the radius of a disk of the object's area.
    pub inner: f64,
    /// Other seeds near this one, and how their radii compare to its own.
    pub rivals: Vec<(DVec2, f64)>,
}

impl Model<'_> {
    /// Whether a place belongs to another seed: as far as that is known, or because that one is nearer in units of
    /// radii.
    pub(crate) fn is_of_rival(&self, seed: &Seed, p: DVec2) -> bool {
        if let Some(owner) = self.owner(p) {
            return owner > 0 && owner != seed.number;
        }
        let own = p.distance_squared(seed.center);
        let mut rivals = seed.rivals.iter();
        rivals.any(|(center, share)| p.distance_squared(*center) < own * share * share)
    }

    /// How much likelier a place is inside the object of a seed than outside.
    pub(crate) fn likelihood(&self, seed: &Seed, p: DVec2) -> f64 {
        if self.is_of_rival(seed, p) {
            return RIVAL;
        }
        let likelihood = self.likelihood.as_ref();
        let plain = likelihood.map_or(0.0, |grid| at(grid, p));
        let known = self.owner(p).map_or(
            0.0,
            |owner| {
                if owner == seed.number { KNOWN } else { -KNOWN }
            },
        );
        plain + known
    }

    /// The number of the seed that a place is known to belong to, 0 for none.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a place in the picture, or none of its pixels"
    )]
    fn owner(&self, p: DVec2) -> Option<u32> {
        let place = p.round().max(DVec2::ZERO);
        let owners = self.owners.as_ref()?;
        Some(
            owners
                .get((place.y as usize, place.x as usize))
                .map_or(0, |one| *one),
        )
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
