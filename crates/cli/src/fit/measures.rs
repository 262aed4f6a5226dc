//! A table with a row for each outline: its measures, and how sure it is.

use std::fmt::Write as _;
use std::path::Path;

use io::Picture;
use score::{GreyMeans, Measures, curvature_extremes};

use super::one::Found;

/// σ over which curvature is smoothed, and width of the ring around an outline whose grey is measured. Pixels.
const CURVATURE: f64 = 3.0;
const RING: f64 = 5.0;

/// Digits of a number: more than any measure has that are right, and fewer than those in which machines differ.
const DIGITS: usize = 9;

/// Which column says how an outline ended, and the word for one that is not sure.
pub(super) const OUTCOME: usize = 3;
pub(super) const UNSURE: &str = "unsure";

/// Headings of the table of measures; lengths in pixels but for the last two, which are in units of the picture.
pub(super) const HEADINGS: &str = "picture,outline,label,outcome,area_px2,perimeter_px,centroid_x_px,centroid_y_px,\
    major_axis_px,minor_axis_px,angle_deg,circularity,solidity,equivalent_diameter_px,left_px,top_px,right_px,bottom_px,\
    least_curvature_per_px,largest_curvature_per_px,mean_inside,mean_outside,held,closed_edge,standard_error_px,firm,\
    pixel_width,pixel_height,unit,area_unit2,perimeter_unit";

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
    let measures = Measures::of(rings).ok().filter(|_| closed);
    let bends = rings
        .first()
        .and_then(|ring| curvature_extremes(ring, CURVATURE).ok())
        .filter(|_| closed);
    let grey = GreyMeans::of(rings, picture.levels(), RING)
        .ok()
        .filter(|_| closed);
    let number_of = |value: Option<f64>| {
        value
            .filter(|value| value.is_finite())
            .map_or_else(String::new, plain)
    };
    let of = |value: fn(&Measures) -> f64| number_of(measures.as_ref().map(value));
    let label = shape
        .and_then(|shape| shape.label.as_deref())
        .unwrap_or_default();
    let pixel = picture.pixel_size();
    let perimeter = |scale: (f64, f64)| {
        let length = |ring: &Vec<glam::DVec2>| {
            let next = ring.iter().cycle().skip(1);
            let edges =
                ring.iter()
                    .zip(next)
                    .take(if closed { ring.len() } else { ring.len() - 1 });
            edges
                .map(|(a, b)| (scale.0 * (b.x - a.x)).hypot(scale.1 * (b.y - a.y)))
                .sum::<f64>()
        };
        rings
            .iter()
            .filter(|ring| !ring.is_empty())
            .map(length)
            .sum::<f64>()
    };
    vec![
        quoted(&called(name)),
        shape
            .and_then(|shape| shape.id.as_deref())
            .map_or_else(|| number.to_string(), quoted),
        quoted(label),
        (if found.unsure.is_some() {
            UNSURE
        } else {
            "found"
        })
        .to_owned(),
        of(|m| m.area),
        number_of(shape.map(|_| perimeter((1.0, 1.0)))),
        of(|m| m.centroid.x),
        of(|m| m.centroid.y),
        of(|m| m.major_axis),
        of(|m| m.minor_axis),
        of(|m| m.angle.to_degrees()),
        of(|m| m.circularity),
        of(|m| m.solidity),
        of(|m| m.equivalent_diameter),
        of(|m| m.low.x),
        of(|m| m.low.y),
        of(|m| m.high.x),
        of(|m| m.high.y),
        number_of(bends.map(|bends| bends[0])),
        number_of(bends.map(|bends| bends[1])),
        number_of(grey.as_ref().and_then(|grey| grey.inside)),
        number_of(grey.as_ref().and_then(|grey| grey.outside)),
        number_of(found.measured.held),
        number_of(found.measured.closed),
        number_of(found.measured.error),
        number_of(found.plucked.as_ref().map(|plucked| plucked.firm())),
        number_of(pixel.map(|pixel| pixel.x)),
        number_of(pixel.map(|pixel| pixel.y)),
        pixel.map_or_else(String::new, |pixel| quoted(&pixel.unit)),
        number_of(pixel.and_then(|pixel| measures.as_ref().map(|m| m.area * pixel.x * pixel.y))),
        number_of(
            pixel
                .filter(|_| shape.is_some())
                .map(|pixel| perimeter((pixel.x, pixel.y))),
        ),
    ]
}

/// A number of so many digits, without zeros behind the last.
pub(crate) fn plain(value: f64) -> String {
    let round = format!("{value:.*e}", DIGITS - 1).parse::<f64>();
    // no zero has a sign
    format!("{}", round.unwrap_or(value) + 0.0)
}

/// What a picture is called in the table.
pub(super) fn called(name: &Path) -> String {
    name.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

/// A text as a field of a table.
pub(crate) fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_nine_digits_whatever_their_size() {
        let known = [
            (2.5e-5, "0.000025"),
            (6.25e-10, "0.000000000625"),
            (1.0 / 3.0, "0.333333333"),
            (12_345.678_912_345, "12345.6789"),
            (200.0, "200"),
            (-0.0, "0"),
            (1.5e12, "1500000000000"),
        ];
        for (value, text) in known {
            assert_eq!(plain(value), text);
        }
    }

    #[test]
    fn the_columns_are_where_they_are_looked_for() {
        assert_eq!(HEADINGS.split(',').nth(OUTCOME), Some("outcome"));
    }
}
