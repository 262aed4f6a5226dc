//! The atlas of regimes: where a snake rings, creeps, zigzags and blows up.
//!
//! Three planes, each predicted by the roots of one mode's step and measured by runs of a whole
//! snake, and the family of damped motions that report §3.4.2 shows one member of.

mod family;
mod plane;
mod planes;
mod regime;

pub(crate) use family::FAMILY;
pub(crate) use planes::{MASS, STEP, STIFFNESS};

/// The experiments of the atlas, for the subcommand of that name.
pub const ATLAS: &[&crate::Experiment] = &[&FAMILY, &MASS, &STIFFNESS, &STEP];
