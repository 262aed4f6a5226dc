//! Changes of a scene in motion.

use serde::{Deserialize, Serialize};

use super::Pair;

/// A change of a scene in motion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Body {
    /// Pull a node by a spring to a place; a further pull takes its place.
    Drag {
        /// Number of the snake.
        snake: usize,
        /// Which node.
        node: usize,
        /// To where.
        to: Pair,
    },
    /// Pull no longer.
    Drop,
    /// Hold a node where it is.
    Pin {
        /// Number of the snake.
        snake: usize,
        /// Which node.
        node: usize,
    },
    /// Let a node go.
    Unpin {
        /// Number of the snake.
        snake: usize,
        /// Which node.
        node: usize,
    },
    /// Push everything away from a place; a further push takes its place.
    Push {
        /// From where.
        at: Pair,
        /// How far it is felt.
        reach: f64,
    },
    /// Push no longer.
    Leave,
    /// Give a snake a velocity.
    Throw {
        /// Number of the snake.
        snake: usize,
        /// The velocity. L T⁻¹.
        velocity: Pair,
    },
    /// Add a ball of that outline.
    Ball {
        /// Its outline, as drawn.
        points: Vec<Pair>,
    },
    /// Take a snake out.
    Delete {
        /// Its number.
        snake: usize,
    },
    /// Another gravity for all.
    Gravity {
        /// The acceleration. L T⁻².
        g: Pair,
    },
    /// One more wall, or another place for one.
    Wall {
        /// Its number; None for one more.
        #[serde(default)]
        index: Option<usize>,
        /// A point of it.
        point: Pair,
        /// The side where snakes may be.
        normal: Pair,
    },
    /// Take a wall away.
    NoWall {
        /// Its number.
        index: usize,
    },
    /// Set a parameter of a snake, or of all.
    Set {
        /// tether, tension, rigidity, mass, damping or internal.
        key: String,
        /// The value, in the units of the parameter.
        value: f64,
        /// Number of the snake; None for all.
        #[serde(default)]
        snake: Option<usize>,
    },
    /// Set mass and damping of a snake, or of all, together: a point of the damping atlas.
    Plane {
        /// μ, the mass of a node.
        mass: f64,
        /// γ, its damping.
        damping: f64,
        /// Number of the snake; None for all.
        #[serde(default)]
        snake: Option<usize>,
    },
    /// Move by another scheme, or by other steps.
    Stepping {
        /// The scheme; None for the one that is used.
        #[serde(default)]
        scheme: Option<String>,
        /// The step; None for the one that is used. T.
        #[serde(default)]
        dt: Option<f64>,
    },
    /// Whether curves push each other.
    Contact {
        /// Whether they do.
        on: bool,
    },
}
