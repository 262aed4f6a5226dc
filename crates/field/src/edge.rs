//! The corrected edge force: the gradient of the gradient's length.

use crate::error::{FieldError, positive};
use crate::force_field::ForceField;
use crate::gradient::{Across, mask_x, mask_y};
use crate::grid::{Grid, admit};
use crate::smooth::{REPORT_PASSES, Smoothing};

/// What the corrected edge force is made with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeForce {
    /// Smoothing along both axes before anything is differentiated.
    pub smoothing: Smoothing,
    /// Force per unit of ∇P. Any finite number above 0.
    pub gain: f64,
}

impl EdgeForce {
    /// The report's twenty passes, and the gain that gives the report's force at a straight vertical edge.
    ///
    /// The report's masks count twice, its program multiplies by 10 and its display by 0.15: 2 · 2 · 10 · 0.15 = 6.
    #[must_use]
    pub const fn as_strong_as_the_report() -> Self {
        Self {
            smoothing: Smoothing::Binomial(REPORT_PASSES),
            gain: 6.0,
        }
    }
}

/// Every stage of [`edge_force`], for showing.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgeStages {
    /// G ∗ I, smoothed along both axes.
    pub smoothed: Grid,
    /// ∂/∂x of `smoothed`.
    pub gradient_x: Grid,
    /// ∂/∂y of `smoothed`.
    pub gradient_y: Grid,
    /// P = |∇(G ∗ I)|, grey levels per pixel. The energy of a point is −`gain` · P.
    pub strength: Grid,
    /// `gain` · ∇P.
    pub force: ForceField,
}

/// The corrected edge force, the same for an edge in any direction.
///
/// ```text
/// P = |∇(G ∗ I)|        F = gain · ∇P
/// ```
///
/// Both axes are smoothed, the masks are halved so that they are derivatives, the image is its own mirror on
/// all four sides, and the force is the gradient of one scalar: minus the gradient of the energy −`gain` · P,
/// by the same stencil. Contrast may be of either sign.
///
/// Report Eq. F = ∇(|∇(G ∗ S)|) of §4.2.1, taken at its word in two dimensions (D38, D39, D40, D43).
/// O(pixels · passes).
///
/// # Errors
/// An image that is empty or has a pixel that is not finite or too large; a smoothing that
/// [`Smoothing::validate`] refuses; a `gain` that is not above 0.
pub fn edge_force(image: &Grid, rule: &EdgeForce) -> Result<ForceField, FieldError> {
    edge_stages(image, rule).map(|stages| stages.force)
}

/// [`edge_force`] with every stage kept.
///
/// # Errors
/// Those of [`edge_force`].
pub fn edge_stages(image: &Grid, rule: &EdgeForce) -> Result<EdgeStages, FieldError> {
    positive("gain", rule.gain)?;
    rule.smoothing.validate()?;
    let smoothed = rule.smoothing.apply(&admit(image, 1.0)?);
    let (gradient_x, gradient_y) = gradient(&smoothed);
    let strength = length(&gradient_x, &gradient_y);
    let force = gradient_force(&strength, rule.gain)?;
    Ok(EdgeStages {
        smoothed,
        gradient_x,
        gradient_y,
        strength,
        force,
    })
}

/// `gain` times the gradient of a grid: the force whose energy is −`gain` · `potential`.
///
/// The report's masks, halved, on the mirrored grid.
///
/// # Errors
/// An empty grid, or one with a value that is not finite.
pub fn gradient_force(potential: &Grid, gain: f64) -> Result<ForceField, FieldError> {
    let (x, y) = gradient(&admit(potential, 1.0)?);
    ForceField::from_components(&(x * gain), &(y * gain))
}

/// The length of a gradient.
#[expect(
    clippy::imprecise_flops,
    reason = "pixels are bounded, so squares neither overflow nor matter when lost"
)]
fn length(x: &Grid, y: &Grid) -> Grid {
    Grid::from_shape_fn(x.dim(), |at| (x[at] * x[at] + y[at] * y[at]).sqrt())
}

/// Both derivatives by the halved masks on the mirrored image.
pub(crate) fn gradient(image: &Grid) -> (Grid, Grid) {
    (
        mask_x(image, Across::Mirror) * 0.5,
        mask_y(image, Across::Mirror) * 0.5,
    )
}
