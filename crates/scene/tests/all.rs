//! All tests of scenes in one program, which is linked once.

mod apple_fit;
mod bodies;
mod company;
mod computing;
mod crowd_of_one;
mod drawn;
mod errata;
mod forces;
mod formats;
mod hand;
mod ledger;
mod maps;
mod oracle;
mod runs;
mod seeds;
mod text;
mod told;
mod walls;
mod wild;
