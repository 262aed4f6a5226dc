//! Random bytes against `bodies::picture`.
#![no_main]
#![allow(dead_code, reason = "each target runs one of the bodies")]

mod bodies;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| bodies::picture(bytes));
