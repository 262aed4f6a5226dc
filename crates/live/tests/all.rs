//! All tests of the engine in one program, which is linked once.

mod chance;
mod files;
mod replay;
