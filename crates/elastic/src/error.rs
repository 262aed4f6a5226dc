//! What can be wrong with a curve or a material, each with what was given and what is needed.

use crate::Bound;
use banded::BandedError;
use glam::DVec2;

/// What can be wrong with a curve or a material.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ElasticError {
    /// Fewer nodes than the differences reach over.
    #[error("a curve with these ends needs at least {needed} nodes, got {got}")]
    TooFewNodes {
        /// The least that is allowed.
        needed: usize,
        /// What was given.
        got: usize,
    },
    /// Fewer points than a curve can be drawn through.
    #[error("a curve needs at least {needed} points to go through, got {got}")]
    TooFewPoints {
        /// The least that is allowed.
        needed: usize,
        /// What was given.
        got: usize,
    },
    /// A parameter of the curve is out of its range, or not a number.
    #[error("{name} must be {bound}, got {value}{}", at_node(*.node))]
    BadParameter {
        /// Which parameter: `tension`, `mass`, …
        name: &'static str,
        /// At which node; none if the parameter is uniform.
        node: Option<usize>,
        /// What was given.
        value: f64,
        /// What is needed.
        bound: Bound,
    },
    /// A profile does not have one value a node.
    #[error("{name} must have one value for each of the {needed} nodes, got {got}")]
    WrongLength {
        /// Which profile: `tension`, `mass`, …
        name: &'static str,
        /// The number of nodes.
        needed: usize,
        /// The number of values.
        got: usize,
    },
    /// A spacing that nothing can be divided by.
    #[error("the spacing must be from 1e-75 to 1e75, got {value}{}", coincident(*.value))]
    BadSpacing {
        /// What was given.
        value: f64,
    },
    /// An edge that nothing can be divided by.
    #[error("edge {index} must be from 1e-75 to 1e75 long, got {length}{}", if *.length == 0.0 { "; do its nodes coincide?" } else { "" })]
    BadEdge {
        /// Which edge: from the node of this number to the next.
        index: usize,
        /// How long it is.
        length: f64,
    },
    /// A spacing whose power nothing can be divided by.
    #[error("1 over the spacing to the power {power} must be an ordinary number, got a spacing of {spacing}{}", coincident(*.spacing))]
    BadPower {
        /// What was given.
        spacing: f64,
        /// The power that the order asks for.
        power: usize,
    },
    /// Elasticity without weights, or of too high an order.
    #[error("elasticity has weights of the orders 0 to at most {highest}, so 1 to {} of them, got {weights}", highest + 1)]
    BadOrder {
        /// The highest order that is allowed.
        highest: usize,
        /// How many weights were given.
        weights: usize,
    },
    /// Orders above the second where each edge has a length of its own.
    #[error("edges of their own lengths know no orders above the second, got order {order}")]
    OrderOfSpacings {
        /// The order of the material.
        order: usize,
    },
    /// The stiffness matrix is not finite, though each density is.
    #[error("the densities are too large for a spacing of {spacing}: the stiffness is not finite")]
    TooStiff {
        /// The spacing that divides them.
        spacing: f64,
    },
    /// A coordinate is infinite or not a number.
    #[error("{name} {index} must be finite, got ({}, {})", .value.x, .value.y)]
    NotFinite {
        /// What stands there: `node`, `point`.
        name: &'static str,
        /// Which one, from 0.
        index: usize,
        /// What was given.
        value: DVec2,
    },
    /// A coordinate is so large that its square is no number.
    #[error("{name} {index} must lie within 1e150 of the origin, got ({}, {})", .value.x, .value.y)]
    TooFar {
        /// What stands there: `node`, `point`.
        name: &'static str,
        /// Which one, from 0.
        index: usize,
        /// What was given.
        value: DVec2,
    },
    /// All points are one and the same, so the curve has no length.
    #[error("the {count} points all lie at ({}, {}), so the curve has no length; move one", .at.x, .at.y)]
    NoLength {
        /// How many points there are.
        count: usize,
        /// Where they are.
        at: DVec2,
    },
    /// The stiffness matrix was refused.
    #[error(transparent)]
    Banded(#[from] BandedError),
}

fn at_node(node: Option<usize>) -> String {
    node.map_or_else(String::new, |i| format!(" at node {i}"))
}

fn coincident(spacing: f64) -> &'static str {
    if spacing.abs() > 0.0 || spacing.is_nan() {
        ""
    } else {
        "; do all nodes coincide?"
    }
}
