//! Soft bodies: scenes that a physics user would build, each beside the same run without what it shows.

mod cells;
mod dent;
mod fates;
mod funnel;
mod gas;
mod growth;
mod ledger;
mod pile;
mod respacing;
mod rope;
mod slope;

pub(crate) use cells::CELLS;
pub(crate) use dent::DENT;
pub(crate) use fates::FATES;
pub(crate) use funnel::FUNNEL;
pub(crate) use gas::GAS;
pub(crate) use growth::GROWTH;
pub(crate) use ledger::LEDGER;
pub(crate) use pile::PILE;
pub(crate) use respacing::RESPACING;
pub(crate) use rope::ROPE;
pub(crate) use slope::SLOPE;
