//! All tests of fits in one program, which is linked once.

mod common;
mod outlines;
mod pixels;
mod pluck;
mod refusals;
mod searches;
mod ways;
