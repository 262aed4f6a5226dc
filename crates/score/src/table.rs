//! The columns of a table of measures: those of a shape, and the same in units of the picture.

use field::Grid;
use glam::DVec2;

use crate::{GreyMeans, Measures, curvature_extremes};

/// σ over which curvature is smoothed, and width of the ring around an outline whose grey is measured. Pixels.
const CURVATURE: f64 = 3.0;
const RING: f64 = 5.0;

/// Digits of a number: more than any measure has that are right, and fewer than those in which machines differ.
const DIGITS: usize = 9;

/// Headings of what [`shape_columns`] gives.
pub const SHAPE_HEADINGS: &str = "area_px2,perimeter_px,centroid_x_px,centroid_y_px,major_axis_px,minor_axis_px,\
    angle_deg,circularity,solidity,equivalent_diameter_px,left_px,top_px,right_px,bottom_px,\
    least_curvature_per_px,largest_curvature_per_px,mean_inside,mean_outside";

/// Headings of what [`unit_columns`] gives.
pub const UNIT_HEADINGS: &str = "pixel_width,pixel_height,unit,area_unit2,perimeter_unit";

/// Measures of an outline and of the grey about it, as fields of a table: lengths in pixels, angles in degrees.
///
/// `rings` are its polygons, `levels` those of the picture, indexed `[y, x]`. What cannot be measured is empty: all but
/// the perimeter where the curve is open or encloses nothing.
#[must_use]
pub fn shape_columns(rings: &[Vec<DVec2>], closed: bool, levels: &Grid) -> Vec<String> {
    let measures = Measures::of(rings).ok().filter(|_| closed);
    let bends = rings
        .first()
        .and_then(|ring| curvature_extremes(ring, CURVATURE).ok())
        .filter(|_| closed);
    let grey = GreyMeans::of(rings, levels, RING).ok().filter(|_| closed);
    let of = |value: fn(&Measures) -> f64| number(measures.as_ref().map(value));
    let any = rings.iter().any(|ring| !ring.is_empty());
    vec![
        of(|m| m.area),
        number(any.then(|| perimeter(rings, closed, (1.0, 1.0)))),
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
        number(bends.map(|bends| bends[0])),
        number(bends.map(|bends| bends[1])),
        number(grey.as_ref().and_then(|grey| grey.inside)),
        number(grey.as_ref().and_then(|grey| grey.outside)),
    ]
}

/// Size of a pixel with its unit, and area and perimeter of an outline in it, as fields of a table; empty where the
/// size is not known.
#[must_use]
pub fn unit_columns(
    rings: &[Vec<DVec2>],
    closed: bool,
    pixel: Option<(f64, f64, &str)>,
) -> Vec<String> {
    let measures = Measures::of(rings).ok().filter(|_| closed);
    let any = rings.iter().any(|ring| !ring.is_empty());
    let length = pixel.filter(|_| any);
    vec![
        number(pixel.map(|(x, _, _)| x)),
        number(pixel.map(|(_, y, _)| y)),
        pixel.map_or_else(String::new, |(_, _, unit)| quoted(unit)),
        number(pixel.and_then(|(x, y, _)| measures.as_ref().map(|m| m.area * x * y))),
        number(length.map(|(x, y, _)| perimeter(rings, closed, (x, y)))),
    ]
}

/// Length of all polygons, in units of so much along each axis.
fn perimeter(rings: &[Vec<DVec2>], closed: bool, scale: (f64, f64)) -> f64 {
    let length = |ring: &Vec<DVec2>| {
        let next = ring.iter().cycle().skip(1);
        let edges = ring
            .iter()
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
        .sum()
}

/// A number as a field of a table; empty where there is none, or it is not finite.
#[must_use]
pub fn number(value: Option<f64>) -> String {
    value
        .filter(|value| value.is_finite())
        .map_or_else(String::new, plain)
}

/// A number of nine digits, without zeros behind the last.
#[must_use]
pub fn plain(value: f64) -> String {
    let round = format!("{value:.*e}", DIGITS - 1).parse::<f64>();
    // no zero has a sign
    format!("{}", round.unwrap_or(value) + 0.0)
}

/// A text as a field of a table.
#[must_use]
pub fn quoted(text: &str) -> String {
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
    fn there_are_as_many_fields_as_headings() {
        let levels = Grid::from_elem((8, 8), 1.0);
        let square = [
            DVec2::new(1.0, 1.0),
            DVec2::new(5.0, 1.0),
            DVec2::new(5.0, 4.0),
            DVec2::new(1.0, 4.0),
        ]
        .to_vec();
        for (rings, closed) in [
            (vec![square.clone()], true),
            (vec![square], false),
            (Vec::new(), true),
        ] {
            let fields = shape_columns(&rings, closed, &levels);
            assert_eq!(fields.len(), SHAPE_HEADINGS.split(',').count());
            let units = unit_columns(&rings, closed, Some((0.5, 2.0, "µm")));
            assert_eq!(units.len(), UNIT_HEADINGS.split(',').count());
            if closed && !rings.is_empty() {
                assert_eq!((fields[0].as_str(), fields[1].as_str()), ("12", "14"));
                assert_eq!((units[3].as_str(), units[4].as_str()), ("12", "16"));
            }
        }
    }
}
