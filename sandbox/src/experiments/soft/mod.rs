//! Soft bodies: scenes that a physics user would build, each beside the same run without what it shows.

mod course;
mod dent;
mod funnel;
mod ledger;
mod pile;
mod respacing;
mod rope;
mod slope;

pub(crate) use course::{keep_shots, picture, shots, times};
pub(crate) use dent::DENT;
pub(crate) use funnel::FUNNEL;
pub(crate) use ledger::LEDGER;
pub(crate) use pile::PILE;
pub(crate) use respacing::RESPACING;
pub(crate) use rope::ROPE;
pub(crate) use slope::SLOPE;
