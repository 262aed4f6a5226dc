//! All tests of schemes and solvers in one program, which is linked once.

mod oracle;
