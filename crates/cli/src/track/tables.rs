//! Tables of a track: a row for each object in each frame, a row for each thing that happened.

use std::collections::BTreeMap;

use io::tracks::Tracked;
use score::{Measures, curvature_extremes};

use super::sinks::{Happened, Seen};
use crate::fit::{plain, quoted};

/// σ over which curvature is smoothed. Pixels.
const CURVATURE: f64 = 3.0;

/// What is measured of an outline, in the order of the columns.
const NAMES: [&str; 16] = [
    "area_px2",
    "perimeter_px",
    "centroid_x_px",
    "centroid_y_px",
    "velocity_x_px_per_frame",
    "velocity_y_px_per_frame",
    "rotation_deg_per_frame",
    "major_axis_px",
    "minor_axis_px",
    "angle_deg",
    "circularity",
    "solidity",
    "least_curvature_per_px",
    "largest_curvature_per_px",
    "standard_error_px",
    "equivalent_diameter_px",
];

/// Headings of the table of measures.
pub(super) const MEASURES: &str = "frame,frame_name,id,parent,state,confidence,area_px2,perimeter_px,centroid_x_px,\
    centroid_y_px,velocity_x_px_per_frame,velocity_y_px_per_frame,rotation_deg_per_frame,major_axis_px,minor_axis_px,\
    angle_deg,circularity,solidity,least_curvature_per_px,largest_curvature_per_px,standard_error_px,\
    equivalent_diameter_px";

/// Headings of the table of events.
pub(super) const EVENTS: &str = "frame,id,event,others,confidence";

/// What is measured of an outline, by name.
pub(super) fn measures(seen: &Seen) -> BTreeMap<String, f64> {
    let ring = &seen.tracked.points;
    let outline = &seen.outline;
    let mut found = BTreeMap::new();
    let mut note = |name: &str, value: Option<f64>| {
        if let Some(value) = value.filter(|value| value.is_finite()) {
            found.insert(name.to_owned(), value);
        }
    };
    if let Ok(m) = Measures::of(std::slice::from_ref(ring)) {
        for (name, value) in [
            ("area_px2", m.area),
            ("perimeter_px", m.perimeter),
            ("centroid_x_px", m.centroid.x),
            ("centroid_y_px", m.centroid.y),
            ("major_axis_px", m.major_axis),
            ("minor_axis_px", m.minor_axis),
            ("angle_deg", m.angle.to_degrees()),
            ("circularity", m.circularity),
            ("solidity", m.solidity),
            ("equivalent_diameter_px", m.equivalent_diameter),
        ] {
            note(name, Some(value));
        }
    }
    if let Ok([least, largest]) = curvature_extremes(ring, CURVATURE) {
        note("least_curvature_per_px", Some(least));
        note("largest_curvature_per_px", Some(largest));
    }
    note("velocity_x_px_per_frame", Some(outline.velocity.x));
    note("velocity_y_px_per_frame", Some(outline.velocity.y));
    note(
        "rotation_deg_per_frame",
        Some(outline.rotation.to_degrees()),
    );
    let errors: Vec<f64> = outline
        .errors
        .iter()
        .copied()
        .filter(|error| error.is_finite())
        .collect();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    note("standard_error_px", (!errors.is_empty()).then_some(mean));
    found
}

/// The row of an outline.
pub(super) fn row(name: &str, one: &Tracked) -> String {
    let number = |value: Option<f64>| value.map_or_else(String::new, plain);
    let mut fields = vec![
        one.frame.to_string(),
        quoted(name),
        one.id.to_string(),
        one.parent
            .map_or_else(String::new, |parent| parent.to_string()),
        one.state.name().to_owned(),
        number(one.confidence),
    ];
    fields.extend(
        NAMES
            .iter()
            .map(|name| number(one.measures.get(*name).copied())),
    );
    fields.join(",") + "\n"
}

/// The row of something that happened.
pub(super) fn event_row(one: &Happened) -> String {
    let others: Vec<String> = one.others.iter().map(u32::to_string).collect();
    format!(
        "{},{},{},{},{}\n",
        one.frame,
        one.id,
        one.word,
        others.join(" "),
        plain(one.confidence)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_columns_are_those_of_the_heading() {
        let own: Vec<&str> = MEASURES.split(',').skip(6).map(str::trim).collect();
        assert_eq!(own, NAMES);
        let fields = row("a,b.png", &Tracked::default());
        assert!(fields.starts_with("0,\"a,b.png\",0,,tracked,,"), "{fields}");
        assert_eq!(
            fields.matches(',').count(),
            MEASURES.matches(',').count() + 1
        );
    }
}
