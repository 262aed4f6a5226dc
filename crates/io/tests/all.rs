//! All tests of files in one program, which is linked once.

mod in_memory;
mod pictures;
mod readings;
mod starts;
