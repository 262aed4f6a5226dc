//! All tests of a snake and its runs in one program, which is linked once.

mod accounts;
mod adhesion;
mod balloon;
mod common;
mod contact_mechanics;
mod crowd;
mod damping;
mod friction;
mod hand;
mod laws;
mod ledger;
mod maps;
mod maps_ledger;
mod orders;
mod outcomes;
mod regions;
mod rest;
mod rotation;
mod simulation;
mod spin;
mod strays;
mod turning;
mod upkeep;
mod walls;
