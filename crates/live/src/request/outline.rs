//! Changes of outlines in a picture.

use serde::{Deserialize, Serialize};

use super::{Pair, yes};

/// How a start is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Drawn {
    /// One click inside the object.
    Click,
    /// Clicks that a smooth curve goes through.
    Spline,
    /// A line drawn by hand, or the corners of a polygon.
    Line,
    /// A box by two corners.
    Box,
    /// An ellipse by two corners of the box around it.
    Ellipse,
}

/// A change of outlines in a picture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Outline {
    /// Find the outline about a start.
    Start {
        /// How it is drawn.
        drawn: Drawn,
        /// Its points. Pixels.
        points: Vec<Pair>,
        /// Whether it is closed.
        #[serde(default = "yes")]
        closed: bool,
    },
    /// Find all objects of the picture, one outline each; those that are there stay.
    All,
    /// Take outlines from a file, whose bytes come with the message.
    File {
        /// The name of the file.
        name: String,
        /// Whether the picture is searched about each of them, or they are taken as they are.
        #[serde(default = "yes")]
        search: bool,
    },
    /// Search once more about an outline as it is now.
    Again {
        /// Its number.
        id: u32,
    },
    /// Take an outline away.
    Delete {
        /// Its number.
        id: u32,
    },
    /// Give an outline a name and a class.
    Name {
        /// Its number.
        id: u32,
        /// The name.
        label: String,
        /// The class.
        #[serde(default)]
        class: String,
    },
    /// Pull a node by a spring to a place: the stretch about it follows, the rest stays.
    Drag {
        /// Number of the outline.
        id: u32,
        /// Which node.
        node: usize,
        /// To where. Pixels.
        to: Pair,
        /// How long a stretch follows to either side. Pixels.
        reach: f64,
    },
    /// Pull no longer: the stretch settles on the edge that is nearest now.
    Drop,
    /// Hold a node where it is, whatever is done to its outline.
    Pin {
        /// Number of the outline.
        id: u32,
        /// Which node.
        node: usize,
    },
    /// Let a node go.
    Unpin {
        /// Number of the outline.
        id: u32,
        /// Which node.
        node: usize,
    },
    /// Hold all nodes from one to another.
    Freeze {
        /// Number of the outline.
        id: u32,
        /// The first.
        from: usize,
        /// The last, in the order of the nodes.
        to: usize,
    },
    /// Let all nodes go.
    Thaw {
        /// Number of the outline.
        id: u32,
    },
    /// Keep all outlines out of a disc.
    Forbid {
        /// Its middle. Pixels.
        at: Pair,
        /// Its radius. Pixels.
        radius: f64,
    },
    /// The edge under a place pulls no longer, as far as it runs on within a distance.
    NotThisEdge {
        /// Where it was pointed at. Pixels.
        at: Pair,
        /// How far along it. Pixels.
        reach: f64,
    },
    /// Draw the stretch from one node to another anew.
    Redraw {
        /// Number of the outline.
        id: u32,
        /// The node it begins at.
        from: usize,
        /// The node it ends at.
        to: usize,
        /// The new stretch. Pixels.
        points: Vec<Pair>,
    },
    /// Put a node in the middle of the edge behind a node.
    AddNode {
        /// Number of the outline.
        id: u32,
        /// The node before it.
        node: usize,
    },
    /// Take a node out.
    DeleteNode {
        /// Number of the outline.
        id: u32,
        /// Which node.
        node: usize,
    },
    /// Cut an outline in two between two of its nodes.
    Cut {
        /// Number of the outline.
        id: u32,
        /// One node.
        from: usize,
        /// The other.
        to: usize,
    },
    /// Make one outline of two that touch.
    Join {
        /// Number of the one that stays.
        id: u32,
        /// Number of the other.
        other: u32,
    },
    /// Give outlines that overlap a border in common.
    Part,
}
