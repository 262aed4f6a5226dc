//! A disc that moves.

use super::Folder;

/// A bright disc of radius 9 that moves two pixels a frame, as PGM.
pub(crate) fn disc(frame: usize) -> Vec<u8> {
    let center = (20.0 + 2.0 * frame as f64, 24.0);
    let mut bytes = b"P5\n80 48\n255\n".to_vec();
    for y in 0..48 {
        for x in 0..80 {
            let inside = 9.5 - (f64::from(x) - center.0).hypot(f64::from(y) - center.1);
            bytes.push(super::fits::byte(60.0 + 120.0 * inside.clamp(0.0, 1.0)));
        }
    }
    bytes
}

/// Where it begins.
pub(crate) const START: [&str; 4] = ["--from", "circle:20,24,9", "--start", "exact"];

/// A folder `in` with so many frames, and masks beside them.
pub(crate) fn frames(count: usize) -> Folder {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("in")).unwrap();
    for frame in 0..count {
        folder.write(&format!("in/f{frame}.pgm"), disc(frame));
        folder.write(&format!("in/f{frame}_mask.pgm"), b"P5\n1 1\n255\n\xff");
    }
    folder
}
