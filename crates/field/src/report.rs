//! The force field of the report's Appendix A, slips included.

use crate::error::{FieldError, positive};
use crate::force_field::ForceField;
use crate::gradient::{Across, mask_x, mask_y};
use crate::grid::{Grid, admit, reasonable_passes};
use crate::smooth::{binomial_x, binomial_y};

/// The factor of the report's display, which its force inherits: 255 becomes grey 38 of 64 (D48).
pub const REPORT_SCALE: f64 = 0.15;

/// The factor at the end of the report's program (D40).
pub const REPORT_GAIN: f64 = 10.0;

/// Every stage of [`report_force`], for showing.
#[derive(Debug, Clone, PartialEq)]
pub struct ReportStages {
    /// The image smoothed along x only (D38).
    pub smoothed_x: Grid,
    /// The image smoothed along y only.
    pub smoothed_y: Grid,
    /// Twice the x derivative of `smoothed_x`.
    pub derivative_x: Grid,
    /// Twice the y derivative of `smoothed_y`.
    pub derivative_y: Grid,
    /// `|derivative_x|`.
    pub absolute_x: Grid,
    /// `|derivative_y|`.
    pub absolute_y: Grid,
    /// `gain` times twice the x derivative of `absolute_x`, and the same for y.
    pub force: ForceField,
}

/// The force field of the report's program.
///
/// ```text
/// Fx = gain · bx ∗ |bx ∗ Gx ∗ (scale · I)|        Fy = gain · by ∗ |by ∗ Gy ∗ (scale · I)|
/// ```
///
/// Gx is `passes` binomial passes along x alone (D38), bx the report's mask (twice the derivative, D40); each
/// component is by itself, so this is not the gradient of anything and not rotation invariant (D39).
/// The report has `passes` = 20, `scale` = 0.15 and `gain` = 10; [`edge_force`](crate::edge_force) is the
/// corrected one.
///
/// For 8-bit pixels, 20 passes and `scale` = 1 every operation is exact but the last, so the result does not
/// depend on the order of the sums: it equals the report's program bit for bit. At other scales to rounding.
/// A force is in grey levels per pixel and pixel. O(pixels · passes).
///
/// Report §4.2.2 and Appendix A.
///
/// # Errors
/// An image that is empty or has a pixel that is not finite or too large; a `scale` or `gain` that is not above
/// 0; more than [`MOST_PASSES`](crate::MOST_PASSES) passes.
pub fn report_force(
    image: &Grid,
    passes: u32,
    scale: f64,
    gain: f64,
) -> Result<ForceField, FieldError> {
    report_stages(image, passes, scale, gain).map(|stages| stages.force)
}

/// [`report_force`] with every stage kept.
///
/// # Errors
/// Those of [`report_force`].
pub fn report_stages(
    image: &Grid,
    passes: u32,
    scale: f64,
    gain: f64,
) -> Result<ReportStages, FieldError> {
    positive("scale", scale)?;
    positive("gain", gain)?;
    reasonable_passes(passes)?;
    let image = admit(image, scale)?;
    let smoothed_x = binomial_x(&image, passes);
    let smoothed_y = binomial_y(&image, passes);
    let derivative_x = mask_x(&smoothed_x, Across::Zero);
    let derivative_y = mask_y(&smoothed_y, Across::Zero);
    let absolute_x = derivative_x.mapv(f64::abs);
    let absolute_y = derivative_y.mapv(f64::abs);
    let force_x = mask_x(&absolute_x, Across::Zero) * gain;
    let force_y = mask_y(&absolute_y, Across::Zero) * gain;
    let force = ForceField::from_components(&force_x, &force_y)?;
    Ok(ReportStages {
        smoothed_x,
        smoothed_y,
        derivative_x,
        derivative_y,
        absolute_x,
        absolute_y,
        force,
    })
}
