//! Numbers of a run over time.

use crate::draw::{Axis, Color, Line, Panel};
use crate::experiments::motion::range;
use crate::{Record, SandboxError};

/// Lines of one table over time.
pub(crate) fn over_time(
    record: &Record,
    table: &str,
    columns: &[(&str, &str, Color)],
    title: &str,
    label: &str,
) -> Result<Panel, SandboxError> {
    let mut lines = Vec::new();
    let mut values = Vec::new();
    for (column, name, color) in columns {
        let points = record.points(table, "t", column)?;
        values.extend(points.iter().map(|p| p.1));
        lines.push(Line::new(points, *color).named(*name).weighing(0.9));
    }
    let end = record.column(table, "t")?.last().copied().unwrap_or(1.0);
    let (low, mut high) = range(values, 0.06);
    if columns.iter().any(|(_, name, _)| !name.is_empty()) {
        high += 0.3 * (high - low); // room for the legend
    }
    let panel = Panel::new(title, Axis::new("t", 0.0, end), Axis::new(label, low, high));
    Ok(lines.into_iter().fold(panel, Panel::with))
}
