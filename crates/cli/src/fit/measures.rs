//! A table with a row for each outline: its measures, and how sure it is.

use std::fmt::Write as _;
use std::path::Path;

use io::Picture;
use score::table::{self, SHAPE_HEADINGS, UNIT_HEADINGS, quoted, shape_columns, unit_columns};

use super::one::Found;

/// Which column says how an outline ended, and the word for one that is not sure.
pub(super) const OUTCOME: usize = 3;
pub(super) const UNSURE: &str = "unsure";

/// Headings of the table of measures; lengths in pixels but for the last two, which are in units of the picture.
pub(super) fn headings() -> String {
    format!(
        "picture,outline,label,outcome,{SHAPE_HEADINGS},held,closed_edge,standard_error_px,firm,{UNIT_HEADINGS}"
    )
}

/// The rows of a picture in the table of measures.
pub(super) fn rows(picture: &Picture, name: &Path, found: &[Found]) -> String {
    let mut text = String::new();
    for (index, found) in found.iter().enumerate() {
        let _ = writeln!(text, "{}", row(picture, name, index + 1, found).join(","));
    }
    text
}

fn row(picture: &Picture, name: &Path, number: usize, found: &Found) -> Vec<String> {
    let shape = found.shape.as_ref();
    let rings = shape.map_or(&[][..], |shape| &shape.rings[..]);
    let closed = shape.is_some_and(|shape| shape.closed == Some(true));
    let label = shape
        .and_then(|shape| shape.label.as_deref())
        .unwrap_or_default();
    let pixel = picture.pixel_size();
    let pixel = pixel.map(|pixel| (pixel.x, pixel.y, &*pixel.unit));
    let ended = if found.unsure.is_some() {
        UNSURE
    } else {
        "found"
    };
    let mut row = vec![
        quoted(&called(name)),
        shape
            .and_then(|shape| shape.id.as_deref())
            .map_or_else(|| number.to_string(), quoted),
        quoted(label),
        ended.to_owned(),
    ];
    row.extend(shape_columns(rings, closed, picture.levels()));
    row.extend([
        table::number(found.measured.held),
        table::number(found.measured.closed),
        table::number(found.measured.error),
        table::number(found.plucked.as_ref().map(|plucked| plucked.firm())),
    ]);
    row.extend(unit_columns(rings, closed, pixel));
    row
}

/// What a picture is called in the table.
pub(super) fn called(name: &Path) -> String {
    name.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_columns_are_where_they_are_looked_for() {
        assert_eq!(headings().split(',').nth(OUTCOME), Some("outcome"));
    }
}
