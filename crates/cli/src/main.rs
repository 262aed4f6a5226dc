//! The command `snake`.
fn main() {}
