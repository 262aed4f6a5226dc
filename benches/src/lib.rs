//! What is tried beside this project: schemes on problems with a known end, and soft bodies by
//! other methods.
//!
//! `cargo run --release -p benches --example trials` runs it, with the records, claims and drawings
//! of the sandbox.

mod soft;
mod trials;

pub use soft::PEERS;
pub use trials::{
    Care, Effort, NODES, Stopwatch, TRIALS, TRIALS_IN_SHORT, Trial, apple, coarsest, edge, effort,
    least_steps, ring, scan, wall,
};
