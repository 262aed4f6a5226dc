//! Any text is a contour that is written and read back the same, or is refused; never a panic.
#![no_main]

use libfuzzer_sys::fuzz_target;
use scene::{Contour, Fit, Picture, field};

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    match Contour::parse(text) {
        Ok(contour) => {
            assert_eq!(Contour::parse(&contour.to_text()).as_ref(), Ok(&contour));
            let levels = field::Grid::from_shape_fn((8, 8), |(y, x)| (x * y) as f64);
            let fit = Fit {
                nodes: Some(12),
                steps: 3,
                ..Fit::default()
            };
            // some lie in this picture; most are refused
            let _ = fit.scene(Picture::from_levels(levels), &contour);
        }
        Err(said) => assert!(!said.is_empty() && said.len() < 400, "{said}"),
    }
});
