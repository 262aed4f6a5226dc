//! labelme JSON: polygons, rectangles, circles, lines and points from the corner of the first
//! pixel, and masks of whole pixels. Outlines of several parts are written as several of one
//! group; holes cannot be written.

use glam::DVec2;
use serde_json::{Value as Out, json};

use super::budget::{Budget, cannot, point, unrepeated};
use super::format::{Context, Origin, Reading};
use super::geojson::shift;
use super::json::{At, Json, number_of, table_of};
use super::rings::parts;
use super::{Shape, Shapes, Value, flatten, trace};
use crate::IoError;
use crate::picture::numbers_of;

/// Members of a shape that are no properties.
const OWN: [&str; 5] = ["label", "points", "shape_type", "mask", "id"];

pub(super) fn read(json: &Json, reading: &Reading) -> Result<Shapes, IoError> {
    let at = At::ROOT.key("shapes");
    let list = json.get("shapes").and_then(Json::list);
    let list = list.ok_or_else(|| at.refuse("a list is needed"))?;
    let shift = shift(reading.origin.unwrap_or(Origin::Corner));
    let mut budget = Budget::default();
    let mut shapes = Shapes::new();
    for (index, one) in list.iter().enumerate() {
        let at = at.index(index);
        let (rings, closed) = rings(one, &at, reading.flat(), shift, &mut budget)?;
        let mut properties = one.values(&OWN);
        properties.retain(|_, value| !is_blank(value));
        let like = Shape {
            id: one.get("id").and_then(Json::name),
            label: one.get("label").and_then(Json::name),
            closed,
            properties,
            ..Shape::default()
        };
        // points are outlines of their own
        let each: Vec<Vec<Vec<DVec2>>> = match closed {
            None => rings.into_iter().map(|ring| vec![ring]).collect(),
            Some(_) => vec![rings],
        };
        for rings in each {
            let room = budget
                .shape()
                .and_then(|()| budget.points(like.weight() / 16));
            room.map_err(|what| at.refuse(what))?;
            shapes.push(Shape {
                rings,
                ..like.clone()
            });
        }
    }
    if shapes.is_empty() {
        return Err(at.refuse("no outline; one at least is needed"));
    }
    Ok(shapes)
}

/// Whether a member says nothing: as the program itself writes those that are not set.
fn is_blank(value: &Value) -> bool {
    match value {
        Value::Nothing => true,
        Value::Text(text) => text.is_empty(),
        Value::Table(table) => table.is_empty(),
        _ => false,
    }
}

/// The rings of a shape and whether they are closed, which points are not.
fn rings(
    one: &Json,
    at: &At<'_>,
    flat: f64,
    shift: DVec2,
    budget: &mut Budget,
) -> Result<(Vec<Vec<DVec2>>, Option<bool>), IoError> {
    let kind = one
        .get("shape_type")
        .and_then(Json::text)
        .unwrap_or("polygon");
    let here = at.key("points");
    let list = one.get("points").and_then(Json::list);
    let list = list.ok_or_else(|| here.refuse("a list of pairs of numbers is needed"))?;
    budget.ring(list.len()).map_err(|what| here.refuse(what))?;
    let mut points = Vec::new();
    for (index, pair) in list.iter().enumerate() {
        let at = here.index(index);
        match pair.numbers() {
            Some(&[x, y]) => points.push(point(x, y).map_err(|what| at.refuse(what))?),
            _ => return Err(at.refuse("two numbers are needed")),
        }
    }
    let count = points.len();
    let few = |least: &str| here.refuse(format!("{count} points; {least} are needed for a {kind}"));
    let moved = |points: Vec<DVec2>| points.into_iter().map(|p| p + shift).collect::<Vec<_>>();
    match (kind, &points[..]) {
        ("polygon", _) => {
            let points = unrepeated(points);
            if points.len() < 3 {
                return Err(few("3 different ones"));
            }
            Ok((vec![moved(points)], Some(true)))
        }
        ("rectangle", &[a, b]) if a.cmpne(b).all() => {
            let corners = flatten::rectangle(a.min(b), (a - b).abs(), DVec2::ZERO, flat);
            Ok((vec![moved(corners)], Some(true)))
        }
        ("rectangle" | "oriented_rectangle", &[_, _, _, _]) => {
            Ok((vec![moved(points)], Some(true)))
        }
        ("rectangle" | "oriented_rectangle", _) => Err(few("2 opposite ones or 4")),
        ("circle", &[center, rim]) if center != rim => {
            let radius = DVec2::splat(center.distance(rim));
            Ok((
                vec![moved(flatten::ellipse(center, radius, flat))],
                Some(true),
            ))
        }
        ("circle", _) => Err(few("2 different ones")),
        ("line" | "linestrip", _) if count > 1 => Ok((vec![moved(points)], Some(false))),
        ("line" | "linestrip", _) => Err(few("2")),
        ("point" | "points", _) => Ok((moved(points).into_iter().map(|p| vec![p]).collect(), None)),
        ("mask", &[corner, ..]) => Ok((mask(one, at, corner, budget)?, Some(true))),
        ("mask", _) => Err(few("2")),
        _ => Err(at.key("shape_type").refuse(
            "polygon, rectangle, circle, line, linestrip, point, points or mask is needed",
        )),
    }
}

/// The outline of a mask whose first pixel is that at `corner`.
fn mask(
    one: &Json,
    at: &At<'_>,
    corner: DVec2,
    budget: &mut Budget,
) -> Result<Vec<Vec<DVec2>>, IoError> {
    let at = at.key("mask");
    let bytes = one.get("mask").and_then(Json::text).and_then(from_base64);
    let bytes = bytes.ok_or_else(|| at.refuse("a picture in base64 is needed"))?;
    let numbers = numbers_of(&bytes).map_err(|what| at.refuse(what))?;
    let refuse = |what: String| at.refuse(what);
    budget.pixels(numbers.list.len() as u64).map_err(refuse)?;
    let labels = trace::Labels {
        width: numbers.width,
        height: numbers.list.len().checked_div(numbers.width).unwrap_or(0),
        list: numbers.list.iter().map(|&v| u32::from(v != 0.0)).collect(),
    };
    let mut rings = labels
        .outlines(budget)
        .map_err(refuse)?
        .remove(&1)
        .unwrap_or_default();
    rings
        .iter_mut()
        .flatten()
        .for_each(|p| *p += corner.round());
    Ok(rings)
}

fn from_base64(text: &str) -> Option<Vec<u8>> {
    let (mut bits, mut count) = (0_u32, 0);
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3);
    for letter in text.trim_end_matches('=').bytes() {
        let value = match letter {
            b'A'..=b'Z' => letter - b'A',
            b'a'..=b'z' => letter - b'a' + 26,
            b'0'..=b'9' => letter - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => return None,
        };
        bits = bits << 6 | u32::from(value);
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push(u8::try_from(bits >> count & 255).ok()?);
        }
    }
    Some(bytes)
}

pub(super) fn write(shapes: &[Shape], context: &Context) -> Result<Vec<u8>, IoError> {
    let mut list: Vec<Out> = Vec::new();
    for (number, shape) in (1..).zip(shapes) {
        let refuse = |what: &str| cannot("labelme", format!("outline {number} {what}"));
        let open = shape.closed == Some(false);
        if !open
            && parts(&shape.rings)
                .map_err(|what| refuse(&what))?
                .iter()
                .any(|(_, holes)| !holes.is_empty())
        {
            return Err(refuse(
                "has holes; another format or outlines without them are needed",
            ));
        }
        for ring in &shape.rings {
            let kind = match ring.len() {
                1 => "point",
                _ if open => "linestrip",
                2 => return Err(refuse("is closed and has 2 points; 3 are needed")),
                _ => "polygon",
            };
            let points: Vec<Out> = ring
                .iter()
                .map(|p| json!([number_of(p.x + 0.5), number_of(p.y + 0.5)]))
                .collect();
            let mut one = table_of(&shape.properties);
            let group = if shape.rings.len() > 1 {
                json!(number)
            } else {
                Out::Null
            };
            one.entry("group_id").or_insert(group);
            one.entry("description").or_insert_with(|| "".into());
            one.entry("flags").or_insert_with(|| json!({}));
            one.insert(
                "label".into(),
                shape.label.as_deref().unwrap_or("object").into(),
            );
            one.insert("shape_type".into(), kind.into());
            one.insert("points".into(), points.into());
            one.insert("mask".into(), Out::Null);
            match &shape.id {
                Some(id) => one.insert("id".into(), id.clone().into()),
                None => one.remove("id"),
            };
            list.push(one.into());
        }
    }
    let all = json!({
        "version": "5.5.0",
        "flags": {},
        "shapes": list,
        "imagePath": context.picture.clone().unwrap_or_default(),
        "imageData": null,
        "imageHeight": context.height,
        "imageWidth": context.width,
    });
    let mut text = all.to_string().into_bytes();
    text.push(b'\n');
    Ok(text)
}
