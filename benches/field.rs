//! Placeholder until the crate has something to time.
fn main() {}
