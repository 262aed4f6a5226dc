//! Tracks as boxes, as the MOT challenge has them: `frame,id,left,top,width,height,confidence,-1,-1,-1`.
//!
//! Frames, and the corner of the first pixel, are counted from 1.

use std::fmt::Write as _;

use super::Tracked;

/// The rows of a frame.
pub(super) fn rows(frame: usize, tracked: &[&Tracked]) -> String {
    let mut text = String::new();
    for one in tracked {
        let Some((low, high)) = one.bounds() else {
            continue;
        };
        // from the center of the first pixel to its corner at 1, 1
        let (corner, size) = (low + 1.5, high - low);
        let sure = one.confidence.unwrap_or(1.0);
        let [x, y, width, height] = [corner.x, corner.y, size.x, size.y];
        // writing to a String cannot fail
        let _ = writeln!(
            text,
            "{},{},{x},{y},{width},{height},{sure},-1,-1,-1",
            frame + 1,
            one.id
        );
    }
    text
}
