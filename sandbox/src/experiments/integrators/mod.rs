//! Work against precision: every scheme on the same problems.
//!
//! Times depend on the machine, so none of this is in the catalogue; the subcommand `integrators`
//! runs it, and docs/integrators.md has the tables of one run.

mod chart;
mod drift;
mod edge;
mod effort;
mod judge;
mod rest;
mod trial;
mod trials;

pub use effort::{Effort, Stopwatch, coarsest, effort, least_steps, scan};
pub use trial::{NODES, Trial, apple, edge, ring, wall};

/// The experiments of the subcommand, in order.
pub const INTEGRATORS: &[&crate::Experiment] = &[
    &trials::RING_2,
    &trials::RING_4,
    &trials::RING_6,
    &trials::EDGE_4,
    &trials::EDGE_6,
    &trials::WALL,
    &trials::APPLE,
    &drift::DRIFT,
    &rest::REST,
];
