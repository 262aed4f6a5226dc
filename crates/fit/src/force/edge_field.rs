//! The edge force of an image's grey: made as a whole, or only where someone looks.

use field::{EdgeForce, FieldError, ForceField};

use super::{NORMAL_AT_1, check_smoothing};
use crate::{Image, Problem};

/// How the corrected edge force of a picture is computed.
///
/// Lazy fields differ from whole ones by at most `1e-6 · gain · L` in either component, with L the
/// largest level, 255 for pictures of 8 and 16 bits (tested); the same bytes each time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Computing {
    /// Lazily where that pays and will do: in a fit always, in a scene from 2048 × 2048 pixels on.
    #[default]
    Auto,
    /// In tiles where the curve goes, in `f32`. Not for masked pictures, σ above some 18 pixels, or
    /// contrasts so low that rounding would be felt.
    Lazy,
    /// All of it, in doubles.
    Whole,
}

/// Rounding of a lazy field may take this share of the pull of an edge as high as the contrast.
const FELT: f64 = 2e-3;

/// Largest levels that are computed with in f32, whose numbers go from 1e-38 to 3e38 before they
/// lose digits.
const LEAST_LEVEL: f64 = 1e-12;
const MOST_LEVEL: f64 = 1e12;

/// Which of its two parts an edge field was refused for.
pub(crate) enum Part {
    /// The smoothing.
    Smoothing,
    /// How it is computed.
    Computing,
}

/// The edge force of an image whose levels spread over `contrast`; [`Computing::Auto`] makes all of
/// it up to so many pixels.
pub(super) fn edge_field(
    image: &Image,
    contrast: f64,
    rule: EdgeForce,
    (computing, whole_up_to): (Computing, u64),
) -> Result<ForceField, (Part, Problem)> {
    let refuse = |error: FieldError| (Part::Smoothing, error.into());
    let (width, height) = image.size();
    let small = (width * height) as u64 <= whole_up_to;
    let lazily = match computing {
        Computing::Auto => !small,
        Computing::Lazy => true,
        Computing::Whole => false,
    };
    if lazily {
        rule.smoothing.validate().map_err(refuse)?;
        match lazy(image, contrast, &rule).map_err(refuse)? {
            Ok(field) => return Ok(field),
            Err(why) if computing == Computing::Lazy => {
                let message = format!("{why}; \"whole\" is needed");
                return Err((Part::Computing, Problem::Other(message)));
            }
            Err(_) => {}
        }
    }
    check_smoothing(rule.smoothing, image.size()).map_err(|problem| (Part::Smoothing, problem))?;
    let masked = image.masked(image.pixels().levels()).map_err(refuse)?;
    masked.edge_force(&rule).map_err(refuse)
}

/// The lazy field, or why it will not do.
fn lazy(
    image: &Image,
    contrast: f64,
    rule: &EdgeForce,
) -> Result<Result<ForceField, String>, FieldError> {
    let field = match image.pixels().lazy_edge_force(rule) {
        Ok(Some(field)) => field,
        Ok(None) => return Ok(Err("does not know of pixels that do not count".to_owned())),
        Err(error @ FieldError::TooMuch { .. }) => return Ok(Err(error.to_string())),
        Err(error) => return Err(error),
    };
    // beyond these the squares and differences of f32 leave its range, which a constant never does
    let largest = image.pixels().largest();
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
        let felt = off * (sigma * sigma + 2.0 / 3.0) / (NORMAL_AT_1 * contrast);
        if felt > FELT {
            let percent = 100.0 * felt;
            return Ok(Err(format!(
                "is not fine enough for a contrast of {contrast:.3} levels: rounding up to {percent:.1} % of the pull"
            )));
        }
    }
    Ok(Ok(field))
}
