//! Work against precision: every scheme on the same problems.
//!
//! Times depend on the machine, so nothing of this is compared with numbers; docs/integrators.md
//! has the tables of one run. The same claims are judged on a short form, in which forces are counted
//! and nothing is timed.

use sandbox::Experiment;

mod chart;
mod drift;
mod edge;
mod effort;
mod judge;
mod problems;
mod rest;
mod trial;

pub use effort::{Effort, Stopwatch, coarsest, effort, least_steps, scan};
pub use trial::{Care, NODES, Trial, apple, edge, ring, wall};

/// The trials, in order.
pub const TRIALS: &[&Experiment] = &[
    &problems::RING_2,
    &problems::RING_4,
    &problems::RING_6,
    &problems::EDGE_4,
    &problems::EDGE_6,
    &problems::WALL,
    &problems::APPLE,
    &drift::DRIFT,
    &rest::REST,
];

/// The same claims on runs that are counted and not timed: what the gate can afford.
pub const TRIALS_IN_SHORT: &[&Experiment] = &[
    &problems::RING_2_COUNTED,
    &problems::RING_4_COUNTED,
    &problems::RING_6_COUNTED,
    &problems::EDGE_4_COUNTED,
    &problems::EDGE_6_COUNTED,
    &problems::WALL_COUNTED,
    &problems::APPLE_COUNTED,
    &drift::DRIFT_SHORT,
    &rest::REST_SHORT,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_short_form_judges_the_same_claims_of_every_trial() {
        assert_eq!(TRIALS.len(), TRIALS_IN_SHORT.len());
        for (long, short) in TRIALS.iter().zip(TRIALS_IN_SHORT) {
            assert_eq!(long.id, short.id);
            let says = |one: &Experiment| one.claims.iter().map(|c| c.says()).collect::<Vec<_>>();
            assert_eq!(says(long), says(short));
            assert!(!long.claims.is_empty());
        }
    }
}
