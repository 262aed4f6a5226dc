//! All tests of banded matrices in one program, which is linked once.

mod oracle;
