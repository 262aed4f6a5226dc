//! All tests of tracking in one program, which is linked once.

mod crowd;
mod doubts;
mod drawn;
mod many;
mod mended;
