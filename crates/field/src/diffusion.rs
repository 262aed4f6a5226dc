//! Gradient vector flow: edge forces that diffuse into the regions without edges.
//!
//! The field V minimises a trade between smoothness and staying at the gradient of an edge map, so it
//! reaches as far as the picture is wide, and into deep bays. Solved by multigrid until the
//! residual is what was asked for; a fixed number of sweeps would leave the far pixels at zero.

use crate::edge::gradient;
use crate::error::{FieldError, positive};
use crate::force_field::ForceField;
use crate::grid::{Grid, admit};

mod multigrid;

/// How far a flow diffuses, and how exactly it is solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VectorFlow {
    /// What the diffusion weighs against the edge map.
    pub rule: FlowRule,
    /// Stop when the residual is below this share of the right-hand side (root mean square); 1e-6 is plenty.
    pub residual: f64,
}

/// The two weights g and h of a flow's equation, from the edge map f, scaled to a largest value of 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FlowRule {
    /// `g = μ`, `h = |∇f|²`: the original; μ in 0.05 … 0.5. \[xu98\]
    Plain {
        /// μ.
        smoothness: f64,
    },
    /// `g = e^(−|∇f|/κ)`, `h = 1 − g`: no smoothing across edges, so narrow bays are entered. \[xu98b\]
    Generalised {
        /// κ.
        spread: f64,
    },
}

/// What a flow came to.
#[derive(Debug, Clone, PartialEq)]
pub struct Flow {
    /// The field V.
    pub field: ForceField,
    /// Multigrid cycles spent, the more of the two components.
    pub cycles: u32,
    /// The residual reached, as a share of the right-hand side.
    pub residual: f64,
}

/// The most multigrid cycles spent before the solver gives what it has.
pub const MOST_CYCLES: u32 = 200;

/// Gradient vector flow of an edge map.
///
/// ```text
/// g ∇²V − h (V − ∇f) = 0        on the mirrored picture, both components alike
/// ```
///
/// `edge_map` is any strength, large at edges; it is scaled to a largest value of 1, so the flow does not
/// depend on its unit. Forces are in that scale per pixel. Not the gradient of anything.
/// O(pixels) a cycle, some ten cycles.
///
/// A flow that stops at [`MOST_CYCLES`] says so by its `residual`.
///
/// \[xu98\], \[xu98b\]
///
/// # Errors
/// No pixels, a value that is not finite; a weight or residual that is not above 0.
pub fn vector_flow(edge_map: &Grid, flow: &VectorFlow) -> Result<Flow, FieldError> {
    match flow.rule {
        FlowRule::Plain { smoothness } => positive("smoothness", smoothness)?,
        FlowRule::Generalised { spread } => positive("spread", spread)?,
    }
    positive("residual", flow.residual)?;
    let map = admit(edge_map, 1.0)?;
    let (low, high) = map
        .iter()
        .fold((f64::MAX, f64::MIN), |(l, h), &v| (l.min(v), h.max(v)));
    let range = high - low;
    if range <= 0.0 {
        let zero = Grid::zeros(map.dim());
        let field = ForceField::from_components(&zero, &zero)?;
        return Ok(Flow {
            field,
            cycles: 0,
            residual: 0.0,
        });
    }
    let (fx, fy) = gradient(&map.mapv(|v| (v - low) / range));
    // ∇²V = h/g (V − ∇f): one weight a pixel is enough
    let reaction = Grid::from_shape_fn(map.dim(), |at| {
        let square = fx[at] * fx[at] + fy[at] * fy[at];
        match flow.rule {
            FlowRule::Plain { smoothness } => square / smoothness,
            // (1 − g)/g = e^(|∇f|/κ) − 1
            FlowRule::Generalised { spread } => (square.sqrt() / spread).min(60.0).exp_m1(),
        }
    });
    let solver = multigrid::Solver::new(&reaction);
    let (x, cycles_x, residual_x) = solver.solve(&(&reaction * &fx), flow.residual, MOST_CYCLES);
    let (y, cycles_y, residual_y) = solver.solve(&(&reaction * &fy), flow.residual, MOST_CYCLES);
    let field = ForceField::from_components(&x, &y)?;
    Ok(Flow {
        field,
        cycles: cycles_x.max(cycles_y),
        residual: residual_x.max(residual_y),
    })
}

#[cfg(test)]
mod tests;
