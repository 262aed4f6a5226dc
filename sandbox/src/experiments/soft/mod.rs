//! Soft bodies: scenes that a physics user would build, each beside the same run without what it shows.

mod cells;
mod course;
mod dent;
mod fates;
mod funnel;
mod gas;
mod growth;
mod ledger;
mod peers;
mod pile;
mod respacing;
mod rope;
mod slope;

pub(crate) use cells::CELLS;
pub(crate) use course::{advance, ended, group, keep_shots, picture, shots, times};
pub(crate) use dent::DENT;
pub(crate) use fates::FATES;
pub(crate) use funnel::FUNNEL;
pub(crate) use gas::GAS;
pub(crate) use growth::GROWTH;
pub(crate) use ledger::LEDGER;
pub(crate) use peers::PEERS;
pub(crate) use pile::PILE;
pub(crate) use respacing::RESPACING;
pub(crate) use rope::ROPE;
pub(crate) use slope::SLOPE;
