//! Tracks as a table `frame,id,x,y` with a line for each point.

use std::fmt::Write as _;

use super::Tracked;

/// The first line.
pub(super) const HEADING: &str = "frame,id,x,y\n";

/// The rows of a frame.
pub(super) fn rows(frame: usize, tracked: &[&Tracked]) -> String {
    let mut text = String::new();
    for one in tracked {
        for p in &one.points {
            // writing to a String cannot fail
            let _ = writeln!(text, "{frame},{},{},{}", one.id, p.x, p.y);
        }
    }
    text
}
