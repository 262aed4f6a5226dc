//! Every scheme against exact motions: orders, borders of stability, energies, refusals.

mod order;
