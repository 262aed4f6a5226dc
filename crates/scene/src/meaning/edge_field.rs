//! The corrected edge force of a picture's grey: made as a whole, or only where someone looks.

use field::{EdgeForce, FieldError, ForceField};

use super::smoothing;
use crate::limits::USUALLY_WHOLE;
use crate::{Picture, SceneError};

/// How the corrected edge force of a picture is computed.
///
/// Lazy fields differ from whole ones by at most `1e-6 · gain · L` in either component, with L the largest level, 255
/// for pictures of 8 and 16 bits (tested); the same bytes each time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Computing {
    /// Lazily where that pays and will do: in a fit always, in a scene from 2048 × 2048 pixels on.
    #[default]
    Auto,
    /// In tiles where the curve goes, in `f32`. Not for masked pictures, σ above some 18 pixels, or contrasts so low that
    /// rounding would be felt.
    Lazy,
    /// All of it, in doubles.
    Whole,
}

/// Rounding of a lazy field may take this share of the pull of an edge as high as the contrast.
const FELT: f64 = 2e-3;

/// Largest levels that are computed with in f32, whose numbers go from 1e-38 to 3e38 before they lose digits.
const LEAST_LEVEL: f64 = 1e-12;
const MOST_LEVEL: f64 = 1e12;

/// What to compute, and the keys to refuse it by.
pub(super) struct Wanted<'a> {
    pub computing: Computing,
    /// Pixels up to which [`Computing::Auto`] makes all of it.
    pub whole_up_to: u64,
    /// Of the smoothing, and of the choice.
    pub keys: [&'a str; 2],
}

impl<'a> Wanted<'a> {
    /// As scenes have it.
    pub(super) fn of(computing: Option<Computing>, keys: [&'a str; 2]) -> Self {
        Self {
            computing: computing.unwrap_or_default(),
            whole_up_to: USUALLY_WHOLE,
            keys,
        }
    }
}

/// The edge force of a picture whose levels spread over `contrast`.
pub(super) fn edge_field(
    picture: &Picture,
    contrast: f64,
    rule: EdgeForce,
    wanted: &Wanted<'_>,
) -> Result<ForceField, SceneError> {
    let [smoothing_key, key] = wanted.keys;
    let refuse = |error: FieldError| SceneError::key(smoothing_key, error);
    let (width, height) = picture.size();
    let small = (width * height) as u64 <= wanted.whole_up_to;
    let lazily = match wanted.computing {
        Computing::Auto => !small,
        Computing::Lazy => true,
        Computing::Whole => false,
    };
    if lazily {
        rule.smoothing.validate().map_err(refuse)?;
        match lazy(picture, contrast, &rule).map_err(refuse)? {
            Ok(field) => return Ok(field),
            Err(why) if wanted.computing == Computing::Lazy => {
                return Err(SceneError::key(key, format!("{why}; \"whole\" is needed")));
            }
            Err(_) => {}
        }
    }
    smoothing(smoothing_key, rule.smoothing, picture.size())?;
    let masked = picture.masked(picture.levels()).map_err(refuse)?;
    masked.edge_force(&rule).map_err(refuse)
}

/// The lazy field, or why it will not do.
fn lazy(
    picture: &Picture,
    contrast: f64,
    rule: &EdgeForce,
) -> Result<Result<ForceField, String>, FieldError> {
    let field = match picture.lazy_edge_force(rule) {
        Ok(Some(field)) => field,
        Ok(None) => return Ok(Err("does not know of pixels that do not count".to_owned())),
        Err(error @ FieldError::TooMuch { .. }) => return Ok(Err(error.to_string())),
        Err(error) => return Err(error),
    };
    // beyond these the squares and differences of f32 leave its range, which a constant never does
    let largest = picture.largest_level();
    if contrast > 0.0 && !(LEAST_LEVEL..=MOST_LEVEL).contains(&largest) {
        return Ok(Err(format!(
            "computes with levels from {LEAST_LEVEL:e} to {MOST_LEVEL:e}, and the largest is {largest:e}"
        )));
    }
    // a constant is without force in f32 too
    if contrast > 0.0 {
        let sigma = rule.smoothing.sigma();
        // of rounding, in shares of gain; then of the pull of such an edge
        let off = 5e-7 * largest;
        let felt = off * (sigma * sigma + 2.0 / 3.0) / (super::force::NORMAL_AT_1 * contrast);
        if felt > FELT {
            let percent = 100.0 * felt;
            return Ok(Err(format!(
                "is not fine enough for a contrast of {contrast:.3} levels: rounding up to {percent:.1} % of the pull"
            )));
        }
    }
    Ok(Ok(field))
}
