//! The forces an image can exert on a curve, in units a person can set, and how they are made of
//! it.
//!
//! Every kind has a `strength`. Strength 1 is the pull, at its strongest, of a straight edge of 120
//! grey levels under the report's rules; here it is that of an edge as high as the image's own
//! contrast, so that exposure does not matter, and at any smoothing.

mod edge_field;
mod kind;
mod reach;
mod region;
mod region_kind;
mod sight;
mod strength;

use field::{FieldError, ForceField, Grid, Smoothing};

pub use crate::error::{ForceError, ForceKey};
pub use crate::limits::check_smoothing;
pub use edge_field::Computing;
pub use kind::{
    CoarseToFine, ColorEdge, Distance, Edge, Gvf, ImageForceKind, Line, Scales, Termination, Vfc,
};
pub use region_kind::{Densities, Likelihood, LocalRegions, Regions, Texture};
pub use sight::Sight;

use crate::Problem;

/// Force of strength 1: a gain of 6 on 120 levels, smoothed with σ² = 10, at its strongest, one σ
/// from the edge, where the normal density is 0.242. M L T⁻².
pub const PULL: f64 = 6.0 * 120.0 / 10.0 * NORMAL_AT_1;

/// e^(−½)/√(2π) and 1/√(2π): the normal density at one σ and at none.
pub(crate) const NORMAL_AT_1: f64 = 0.241_970_724_519_143_37;
pub(crate) const NORMAL_AT_0: f64 = 0.398_942_280_401_432_7;

/// A force field with what it is the gradient of.
#[derive(Debug)]
pub struct Made {
    /// The field.
    pub field: ForceField,
    /// The energy of a point of the curve, per unit of its length, at pixel centers; None if there
    /// is none.
    pub energy: Option<Grid>,
}

fn above_nothing(contrast: f64) -> f64 {
    if contrast > 0.0 { contrast } else { 1.0 }
}

/// An error of the force as a whole.
fn all(problem: impl Into<Problem>) -> ForceError {
    ForceError::new(ForceKey::All, problem)
}

/// An error of `field` under a key.
fn by(key: ForceKey) -> impl Fn(FieldError) -> ForceError {
    move |error| ForceError::new(key, error)
}

fn above_zero(key: ForceKey, value: f64) -> Result<f64, ForceError> {
    Problem::above_zero(value).map_err(|problem| ForceError::new(key, problem))
}

/// Force at the strongest.
fn pull(strength: f64) -> Result<f64, ForceError> {
    Ok(PULL * above_zero(ForceKey::Strength, strength)?)
}

/// σ, checked against the size of the image.
fn checked(key: ForceKey, sigma: f64, size: (usize, usize)) -> Result<f64, ForceError> {
    check_smoothing(Smoothing::Gaussian(sigma), size)
        .map_err(|problem| ForceError::new(key, problem))?;
    Ok(sigma)
}
