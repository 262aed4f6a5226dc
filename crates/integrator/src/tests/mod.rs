//! Every scheme against exact motions: orders, borders of stability, energies, refusals.

mod adaptive;
mod constant;
mod contact;
mod edge;
mod exact;
mod order;
mod recurrence;
mod refusal;
mod relaxation;
mod stability;
