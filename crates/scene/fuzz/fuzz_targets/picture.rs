//! Any bytes are a picture of finite levels, or are refused; never a panic.
#![no_main]

use libfuzzer_sys::fuzz_target;
use scene::Picture;

fuzz_target!(|bytes: &[u8]| {
    // few pixels, so that memory stays small however much a head claims
    match Picture::decode_small(bytes, 1 << 16) {
        Ok(picture) => {
            let (width, height) = picture.size();
            assert!(width >= 1 && height >= 1 && width * height <= 1 << 16);
            assert!(picture.levels().iter().all(|level| level.is_finite()));
        }
        Err(said) => assert!(!said.is_empty() && said.len() < 400, "{said}"),
    }
});
