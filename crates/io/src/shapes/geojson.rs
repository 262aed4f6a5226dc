//! `GeoJSON` in pixels, as `QuPath` writes it: the origin is the corner of the first pixel.
//!
//! A label is `properties.classification.name`, or `properties.label`. Written rings are closed by
//! their first point again, outer ones turn from x to y and holes the other way.

use glam::DVec2;
use serde_json::{Value as Out, json};

use super::budget::{Budget, cannot, point, unrepeated};
use super::format::{Context, Origin, Reading};
use super::json::{At, Json, number_of, table_of};
use super::rings::{area, parts};
use super::{Shape, Shapes, Value};
use crate::IoError;

/// What the member `type` may be.
pub(super) const TYPES: [&str; 9] = [
    "Feature",
    "FeatureCollection",
    "GeometryCollection",
    "Polygon",
    "MultiPolygon",
    "LineString",
    "MultiLineString",
    "Point",
    "MultiPoint",
];

struct Reader {
    shapes: Shapes,
    budget: Budget,
    shift: DVec2,
}

pub(super) fn read(json: &Json, reading: &Reading) -> Result<Shapes, IoError> {
    let mut reader = Reader {
        shapes: Shapes::new(),
        budget: Budget::default(),
        shift: shift(reading.origin.unwrap_or(Origin::Corner)),
    };
    let at = At::ROOT;
    match json.list() {
        Some(list) => reader.each(list, &at)?,
        None => reader.object(json, &at)?,
    }
    if reader.shapes.is_empty() {
        return Err(IoError::text(
            None,
            "no outline; a Feature with a geometry is needed",
        ));
    }
    Ok(reader.shapes)
}

/// What to add to coordinates of that origin.
pub(super) fn shift(origin: Origin) -> DVec2 {
    match origin {
        Origin::Center => DVec2::ZERO,
        Origin::Corner => DVec2::splat(-0.5),
    }
}

impl Reader {
    fn each(&mut self, list: &[Json], at: &At<'_>) -> Result<(), IoError> {
        for (index, one) in list.iter().enumerate() {
            self.object(one, &at.index(index))?;
        }
        Ok(())
    }

    fn object(&mut self, json: &Json, at: &At<'_>) -> Result<(), IoError> {
        match json.get("type").and_then(Json::text) {
            Some("FeatureCollection") => {
                let at = at.key("features");
                let list = json.get("features").and_then(Json::list);
                self.each(list.ok_or_else(|| at.refuse("a list is needed"))?, &at)
            }
            Some("Feature") => self.feature(json, at),
            _ => self.geometry(json, at, &Shape::default()),
        }
    }

    fn feature(&mut self, json: &Json, at: &At<'_>) -> Result<(), IoError> {
        let Some(geometry) = json.get("geometry") else {
            return Ok(()); // a feature may be without one
        };
        let mut like = Shape {
            id: json.get("id").and_then(Json::name),
            ..Shape::default()
        };
        if let Some(properties) = json.get("properties") {
            let class = properties.get("classification");
            let name = class
                .and_then(|class| class.get("name"))
                .and_then(Json::text);
            let label = properties.get("label").and_then(Json::text);
            like.label = name.or(label).map(str::to_owned);
            let without: &[&str] = match (name, label) {
                (None, Some(_)) => &["label"],
                _ => &[],
            };
            like.properties = properties.values(without);
            if let (Some(_), Some(class)) = (name, class) {
                let rest = class.values(&["name", "names"]);
                like.properties.remove("classification");
                if !rest.is_empty() {
                    like.properties
                        .insert("classification".to_owned(), Value::Table(rest));
                }
            }
        }
        self.geometry(geometry, &at.key("geometry"), &like)
    }

    fn geometry(&mut self, json: &Json, at: &At<'_>, like: &Shape) -> Result<(), IoError> {
        let kind = json.get("type").and_then(Json::text).unwrap_or_default();
        if kind == "GeometryCollection" {
            let at = at.key("geometries");
            let list = json.get("geometries").and_then(Json::list);
            let list = list.ok_or_else(|| at.refuse("a list is needed"))?;
            for (index, one) in list.iter().enumerate() {
                self.geometry(one, &at.index(index), like)?;
            }
            return Ok(());
        }
        if !TYPES[3..].contains(&kind) {
            return Err(at
                .key("type")
                .refuse("Polygon, LineString or another geometry is needed"));
        }
        let at = at.key("coordinates");
        let given = json
            .get("coordinates")
            .ok_or_else(|| at.refuse("is missing"))?;
        let entries = || {
            given
                .list()
                .ok_or_else(|| at.refuse("a list of positions is needed"))
        };
        let closed = kind.ends_with("Polygon");
        let mut rings = Vec::new();
        match kind {
            "Point" => rings.push(vec![self.position(given, &at)?]),
            "MultiPoint" => {
                for (index, one) in entries()?.iter().enumerate() {
                    rings.push(vec![self.position(one, &at.index(index))?]);
                }
            }
            "LineString" => rings.push(self.ring(given, &at, false)?),
            "MultiLineString" | "Polygon" => {
                for (index, one) in entries()?.iter().enumerate() {
                    rings.push(self.ring(one, &at.index(index), closed)?);
                }
            }
            _ => {
                for (index, part) in entries()?.iter().enumerate() {
                    let at = at.index(index);
                    let list = part
                        .list()
                        .ok_or_else(|| at.refuse("a list of rings is needed"))?;
                    for (index, one) in list.iter().enumerate() {
                        rings.push(self.ring(one, &at.index(index), true)?);
                    }
                }
            }
        }
        let points = kind.ends_with("Point");
        let weight = like.weight() / 16;
        let mut add = |rings: Vec<Vec<DVec2>>| {
            // what several outlines have in common is kept for each
            let room = self
                .budget
                .shape()
                .and_then(|()| self.budget.points(weight));
            room.map_err(|what| at.refuse(what))?;
            self.shapes.push(Shape {
                closed: (!points).then_some(closed),
                rings,
                ..like.clone()
            });
            Ok(())
        };
        if points {
            return rings.into_iter().try_for_each(|ring| add(vec![ring]));
        }
        if rings.is_empty() {
            return Ok(());
        }
        add(rings)
    }

    fn ring(&mut self, json: &Json, at: &At<'_>, closed: bool) -> Result<Vec<DVec2>, IoError> {
        let list = json
            .list()
            .ok_or_else(|| at.refuse("a list of positions is needed"))?;
        self.budget
            .ring(list.len())
            .map_err(|what| at.refuse(what))?;
        let each = list.iter().enumerate();
        let points = each.map(|(index, one)| self.position(one, &at.index(index)));
        let points: Vec<DVec2> = points.collect::<Result<_, _>>()?;
        let points = if closed { unrepeated(points) } else { points };
        let least = if closed { 3 } else { 2 };
        if points.len() < least {
            return Err(at.refuse(format!(
                "{} different points; at least {least} are needed",
                points.len()
            )));
        }
        Ok(points)
    }

    fn position(&self, json: &Json, at: &At<'_>) -> Result<DVec2, IoError> {
        match json.numbers() {
            Some([x, y, ..]) => {
                let p = point(*x, *y).map_err(|what| at.refuse(what))?;
                Ok(p + self.shift)
            }
            _ => Err(at.refuse("two numbers are needed")),
        }
    }
}

pub(super) fn write(shapes: &[Shape], context: &Context) -> Result<Vec<u8>, IoError> {
    let features: Result<Vec<Out>, IoError> =
        (1..).zip(shapes).map(|(n, s)| feature(n, s)).collect();
    let mut all = json!({"type": "FeatureCollection", "features": features?});
    let mut picture = serde_json::Map::new();
    if let Some(name) = &context.picture {
        picture.insert("name".into(), name.clone().into());
    }
    if context.width > 0 && context.height > 0 {
        picture.insert("width".into(), context.width.into());
        picture.insert("height".into(), context.height.into());
    }
    if let Some(pixel) = &context.pixel {
        picture.insert("pixel_width".into(), number_of(pixel.x));
        picture.insert("pixel_height".into(), number_of(pixel.y));
        picture.insert("unit".into(), pixel.unit.clone().into());
    }
    if !picture.is_empty() {
        all["picture"] = picture.into();
    }
    let mut text = all.to_string().into_bytes();
    text.push(b'\n');
    Ok(text)
}

pub(crate) fn feature(number: usize, shape: &Shape) -> Result<Out, IoError> {
    let mut properties = table_of(&shape.properties);
    if let Some(label) = &shape.label {
        let class = properties
            .entry("classification")
            .or_insert_with(|| json!({}));
        if !class.is_object() {
            return Err(cannot(
                "geojson",
                format!(
                    "outline {number} has a label and a property `classification`; a table is needed"
                ),
            ));
        }
        class["name"] = label.clone().into();
    }
    let mut feature = json!({
        "type": "Feature",
        "geometry": geometry(number, shape)?,
        "properties": properties,
    });
    if let Some(id) = &shape.id {
        feature["id"] = id.clone().into();
    }
    Ok(feature)
}

fn position(p: DVec2) -> Out {
    json!([number_of(p.x + 0.5), number_of(p.y + 0.5)])
}

fn geometry(number: usize, shape: &Shape) -> Result<Out, IoError> {
    let line = |ring: &Vec<DVec2>| -> Out { ring.iter().map(|&p| position(p)).collect() };
    if let [ring] = &shape.rings[..]
        && let [p] = ring[..]
    {
        return Ok(json!({"type": "Point", "coordinates": position(p)}));
    }
    if shape.closed == Some(false) {
        if shape.rings.iter().any(|ring| ring.len() < 2) {
            return Err(cannot(
                "geojson",
                format!("outline {number}: a line of one point; two are needed"),
            ));
        }
        return Ok(match &shape.rings[..] {
            [ring] => json!({"type": "LineString", "coordinates": line(ring)}),
            rings => {
                let lines: Vec<Out> = rings.iter().map(line).collect();
                json!({"type": "MultiLineString", "coordinates": lines})
            }
        });
    }
    if shape.rings.iter().any(|ring| ring.len() < 3) {
        return Err(cannot(
            "geojson",
            format!(
                "outline {number} is closed and has a ring of fewer than 3 points, which are needed"
            ),
        ));
    }
    let turned = |index: usize, outer: bool| {
        let ring = &shape.rings[index];
        let backward = (area(ring) > 0.0) != outer;
        let mut points = ring.clone();
        if backward {
            points.reverse();
        }
        let first = points[0];
        points.push(first);
        line(&points)
    };
    let each = parts(&shape.rings)
        .map_err(|what| cannot("geojson", format!("outline {number} {what}")))?;
    let polygons = each.into_iter().map(|(outer, holes)| {
        let mut rings = vec![turned(outer, true)];
        rings.extend(holes.into_iter().map(|hole| turned(hole, false)));
        Out::from(rings)
    });
    let mut polygons: Vec<Out> = polygons.collect();
    Ok(match polygons.len() {
        1 => json!({"type": "Polygon", "coordinates": polygons.remove(0)}),
        _ => json!({"type": "MultiPolygon", "coordinates": polygons}),
    })
}
