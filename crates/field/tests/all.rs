//! All tests of fields in one program, which is linked once.

mod common;
mod energies;
mod errata;
mod laws;
mod oracle;
mod outside;
mod refusals;
