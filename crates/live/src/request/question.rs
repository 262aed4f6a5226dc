//! Questions, by which nothing changes.

use serde::Deserialize;

use super::{Drawn, Pair, yes};

/// A question: nothing changes by it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Question {
    /// What is open: its name, its size, what can be seen of it.
    About,
    /// The shipped scenes, each with its title.
    Menu,
    /// A small drawing of a shipped scene.
    Thumb {
        /// Its name.
        name: String,
    },
    /// What can be set, with values, units and limits.
    Values {
        /// Number of a snake; None for the first.
        #[serde(default)]
        snake: Option<usize>,
    },
    /// The plane of mass and damping of a snake, with its regimes.
    Atlas {
        /// Number of the snake; None for the first.
        #[serde(default)]
        snake: Option<usize>,
    },
    /// Deformation, area, modes of a snake as it is now.
    Shape {
        /// Number of the snake; None for the first.
        #[serde(default)]
        snake: Option<usize>,
    },
    /// A part of the picture as it is to be shown: 256 times 256 pixels of four bytes each.
    Tile {
        /// How many pixels, as a power of two, become one.
        level: u32,
        /// Column of the tile.
        x: usize,
        /// Row of the tile.
        y: usize,
        /// Level that becomes black, of 255.
        low: f64,
        /// Level that becomes white, of 255.
        high: f64,
        /// 1 leaves tones as they are, more makes them lighter.
        gamma: f64,
    },
    /// Forces of the picture at places on a grid, for arrows.
    Field {
        /// The first corner of what is seen. Pixels.
        from: Pair,
        /// The other. Pixels.
        to: Pair,
        /// Places along the longer side, at most 96.
        count: usize,
    },
    /// What the forces say at a place, and the picture's level there.
    At {
        /// The place.
        at: Pair,
    },
    /// Grey along the normal of a node.
    Profile {
        /// Number of the outline.
        id: u32,
        /// Which node.
        node: usize,
    },
    /// A start as it will be.
    Preview {
        /// How it is drawn.
        drawn: Drawn,
        /// Its points. Pixels.
        points: Vec<Pair>,
        /// Whether it is closed.
        #[serde(default = "yes")]
        closed: bool,
    },
    /// All there is to know of an outline.
    Outline {
        /// Its number.
        id: u32,
    },
    /// The names of formats that can be exported.
    Formats,
    /// Outlines, tracks or the session as a file.
    Export {
        /// The name of the format.
        format: String,
    },
}
