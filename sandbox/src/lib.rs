//! The report's experiments: each a question, the claims that answer it, the numbers behind the
//! claims, and a picture.
//!
//! ```text
//! Experiment ── run ──▶ Record (numbers, tables, grids, runs) ──┬── claims ──▶ findings
//!                                                               ├── expected/*.csv
//!                                                               └── draw ──▶ SVG, GIF
//! ```
//!
//! Running and drawing are two functions, and drawing sees the record only. `figures --check` holds
//! claims, numbers, tolerances, drawings and the gallery against what is committed, and moves every
//! number that a claim reads until its verdict changes.
//!
//! This crate computes nothing of its own: physics, fields and schemes come from the crates below.
//! It is the only place that draws.

mod catalogue;
mod check;
mod course;
mod demand;
pub mod draw;
mod error;
mod expected;
mod experiment;
mod experiments;
mod folder;
mod gallery;
mod numbers;
mod page;
pub mod prelude;
mod record;
mod run;
mod shown;
mod table;
mod tolerance;
mod verdict;
mod work;

pub use catalogue::{EXPERIMENTS, find};
pub use check::{Committed, claims, faults};
pub use error::SandboxError;
pub use expected::{Moved, accept, compare, expected_folder};
pub use experiment::{Artefact, Body, Claim, Experiment, Finding, claim};
pub use experiments::atlas::ATLAS;
pub use folder::Folder;
pub use gallery::gallery;
pub use page::page;
pub use record::{Number, Read, Record};
pub use table::{Column, Table};
pub use tolerance::Tolerance;
pub use work::{Done, Drawn, committed_folder, perform, perform_all};

/// A count as a number. Exact: no count here comes near 2⁵³.
#[must_use]
pub fn real(count: usize) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "counts here are far below 2^53")]
    let value = count as f64;
    value
}
