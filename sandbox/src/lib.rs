//! The report's experiments: each a question, the claims that answer it, the numbers behind the
//! claims, and a picture.
//!
//! ```text
//! Experiment ── run ──▶ Record (numbers, tables, grids) ──┬── claims ──▶ findings
//!                                                         ├── expected/*.csv
//!                                                         └── draw ──▶ SVG, GIF
//! ```
//!
//! Running and drawing are two functions, and drawing sees the record only. The drawing itself is
//! never tested; claims and numbers always are.
//!
//! This crate computes nothing of its own: physics, fields and schemes come from the crates below.
//! It is the only place that draws.

mod catalogue;
pub mod draw;
mod error;
mod expected;
mod experiment;
mod experiments;
mod folder;
mod gallery;
mod page;
mod record;
mod work;

pub use catalogue::{EXPERIMENTS, find};
pub use error::SandboxError;
pub use expected::{Moved, accept, compare, expected_folder};
pub use experiment::{Artefact, Body, Claim, Experiment, Finding};
pub use experiments::atlas::ATLAS;
pub use experiments::integrators::{
    Effort, INTEGRATORS, NODES, Stopwatch, Trial, apple, coarsest, edge, effort, least_steps, ring,
    scan, wall,
};
pub use folder::Folder;
pub use gallery::gallery;
pub use page::page;
pub use record::{Column, Number, Record, Table, Tolerance};
pub use work::{Done, Drawn, committed_folder, perform, perform_all};

/// A count as a number. Exact: no count here comes near 2⁵³.
#[must_use]
pub fn real(count: usize) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "counts here are far below 2^53")]
    let value = count as f64;
    value
}
