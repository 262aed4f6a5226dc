//! The geometry of outlines: where they cross, what pieces that leaves, how they are spaced, who is near.
//!
//! An outline is a closed row of nodes of positive area that does not meet itself. What moves does not keep
//! to that by itself: it folds over, runs into others, stretches and bunches up. This crate finds that out
//! and puts it right, and says for every new node where it came from, so that whoever knows what the nodes
//! carry can carry it over. It does not know that anything moves.
//!
//! ```
//! use glam::DVec2;
//! use outline::{Event, resolve};
//!
//! // a bow tie: one half has turned over
//! let tie = [(0.0, 4.0), (4.0, 0.0), (4.0, 4.0), (0.0, 0.0)].map(DVec2::from);
//! let resolved = resolve(&tie, 0.1)?;
//! assert_eq!(resolved.pieces.len(), 1);
//! assert_eq!(resolved.pieces[0].area, 4.0);
//! assert!(matches!(resolved.events[..], [Event::LoopRemoved { area: -4.0, .. }]));
//! # Ok::<(), outline::OutlineError>(())
//! ```
//!
//! - **Valid outlines.** [`crossings`] and [`Crossings`] find where a curve meets itself; [`resolve`] cuts it
//!   into simple pieces of positive area; [`merge`] makes one outline of two.
//! - **Spacing.** [`respace`] inserts and removes nodes, [`slide`] evens them out; both make a [`Plan`], which
//!   draws positions and rest shapes, pours profiles, and carries mass and motion without loss ([`Plan::carry`]).
//! - **Contact.** [`Neighbours`] tells each node which edges are near and on which side it is; [`overlap_depth`]
//!   and [`shared_length`] look at two outlines; [`place`], [`winding`], [`distance`] and [`signed_distance`]
//!   at a point and an outline; [`Rail`] is a polyline to slide along.
//!
//! **Exactness.** Which side of a line a point is on is decided exactly, so no answer contradicts another. Where
//! two edges cross is rounded. Cases without width (a node on an edge, edges on each other) are defined, not
//! undefined: see [`Meeting`] and [`Event::Nudged`].
//!
//! **Order.** Everything comes out in an order that depends on the input alone. Searches keep their memory.
//!
//! Not here yet: outlines with holes, motion within a step, bounds of spacing that differ along the curve.

#![cfg_attr(
    test,
    allow(
        clippy::float_cmp,
        clippy::cast_possible_truncation,
        reason = "a test that says equal means equal"
    )
)]

mod carry;
mod crossings;
mod cut;
mod error;
mod grid;
mod neighbours;
mod orient;
mod overlap;
mod place;
mod plan;
mod rail;
mod resolve;
mod respace;
mod segments;
mod stretch;

pub use carry::{Body, Carried, Lengths, Motion, Totals};
pub use crossings::{Crossing, Crossings, Spot, crossings};
pub use cut::{Origin, Source};
pub use error::OutlineError;
pub use neighbours::{Near, Neighbours, keep_nearest};
pub use orient::Meeting;
pub use overlap::{overlap_depth, shared_length};
pub use place::{Place, distance, place, signed_distance, winding};
pub use plan::Plan;
pub use rail::{Foot, OnRail, Rail};
pub use resolve::{Event, Piece, Removal, Resolved, merge, resolve};
pub use respace::{Between, Bounds, respace, slide};
pub use stretch::nearest_of;
