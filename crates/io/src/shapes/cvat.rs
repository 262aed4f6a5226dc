//! CVAT's XML for images: polygons, boxes, lines, ellipses and points from the corner of the first
//! pixel, and masks of whole pixels.

use std::collections::BTreeMap;

use glam::DVec2;
use roxmltree::Node;

use super::budget::{Budget, point, unrepeated};
use super::coco::several;
use super::format::{Origin, Reading};
use super::geojson::shift;
use super::xml::{number, parse, refuse};
use super::{Shape, Shapes, Value, flatten, runs};
use crate::IoError;
use crate::text::clip_to;

/// Elements that are shapes.
const SHAPES: [&str; 6] = ["polygon", "box", "polyline", "points", "ellipse", "mask"];

/// Attributes that are no properties.
const OWN: [&str; 19] = [
    "label", "points", "xtl", "ytl", "xbr", "ybr", "cx", "cy", "rx", "ry", "rotation", "rle",
    "left", "top", "width", "height", "id", "occluded", "z_order",
];

pub(super) fn read(text: &str, reading: &Reading) -> Result<Shapes, IoError> {
    let document = parse(text)?;
    let root = document.root_element();
    if root.tag_name().name() != "annotations" {
        return Err(refuse(
            root,
            "an XML of no known kind; an SVG or CVAT's annotations are needed",
        ));
    }
    let each = |name: &'static str| root.children().filter(move |node| node.has_tag_name(name));
    if let Some(track) = each("track").next() {
        return Err(refuse(
            track,
            "is of a film; CVAT's annotations for images are needed",
        ));
    }
    let is_shape = |node: &Node<'_, '_>| SHAPES.contains(&node.tag_name().name());
    let wanted = |node: &Node<'_, '_>| match &reading.picture {
        None => node.children().any(|child| is_shape(&child)),
        Some(wanted) => {
            let name = node.attribute("name").unwrap_or_default();
            let end = name.rsplit(['/', '\\']).next();
            name == wanted || end == Some(wanted) || node.attribute("id") == Some(wanted)
        }
    };
    let mut images: Vec<Node<'_, '_>> = each("image").filter(wanted).collect();
    let all: Vec<Node<'_, '_>> = each("image").collect();
    let own = reading.own(all.iter().filter_map(|node| node.attribute("name")));
    if reading.picture.is_none() && all.len() > 1 && own.is_some() {
        images = all;
        images.retain(|node| node.attribute("name") == own);
    }
    let image = match &images[..] {
        [image] => image,
        [] => {
            let name = reading.picture.as_ref().map_or_else(String::new, |name| {
                format!(" that is called {}", clip_to(name, 60))
            });
            let all = each("image").count();
            return Err(refuse(
                root,
                format!("no image with outlines{name} among {all}; one is needed"),
            ));
        }
        _ => {
            return Err(refuse(
                root,
                match &reading.beside {
                    Some(own) => format!(
                        "outlines of several images, and none is called {}; needed: the name of one of {}",
                        clip_to(own, 60),
                        several(images.iter().filter_map(|node| node.attribute("name")))
                    ),
                    None => format!(
                        "outlines of {} images; one is needed, by file name or id",
                        images.len()
                    ),
                },
            ));
        }
    };
    let corner = shift(reading.origin.unwrap_or(Origin::Corner));
    let mut budget = Budget::default();
    let mut shapes = Shapes::new();
    for node in image.children().filter(is_shape) {
        let (rings, closed) = rings(node, reading.flat(), corner, &mut budget)?;
        let like = Shape {
            id: node.attribute("id").map(str::to_owned),
            label: node.attribute("label").map(str::to_owned),
            closed,
            properties: properties(node),
            ..Shape::default()
        };
        let each: Vec<Vec<Vec<DVec2>>> = match closed {
            None => rings.into_iter().map(|ring| vec![ring]).collect(),
            Some(_) => vec![rings],
        };
        for rings in each {
            let room = budget
                .shape()
                .and_then(|()| budget.points(like.weight() / 16));
            room.map_err(|what| refuse(node, what))?;
            shapes.push(Shape {
                rings,
                ..like.clone()
            });
        }
    }
    if shapes.is_empty() {
        return Err(refuse(*image, "no outline; one at least is needed"));
    }
    Ok(shapes)
}

fn properties(node: Node<'_, '_>) -> BTreeMap<String, Value> {
    let given = node.attributes().filter(|one| !OWN.contains(&one.name()));
    let given = given.map(|one| (one.name().to_owned(), Value::Text(one.value().to_owned())));
    let inner = node
        .children()
        .filter(|child| child.has_tag_name("attribute"));
    let inner = inner.filter_map(|child| {
        let text = child.text().unwrap_or_default();
        Some((
            child.attribute("name")?.to_owned(),
            Value::Text(text.to_owned()),
        ))
    });
    given.chain(inner).collect()
}

/// The rings of a shape and whether they are closed, which points are not.
fn rings(
    node: Node<'_, '_>,
    flat: f64,
    shift: DVec2,
    budget: &mut Budget,
) -> Result<(Vec<Vec<DVec2>>, Option<bool>), IoError> {
    let of = |name: &str| number(node, name);
    let pair = |x: &str, y: &str| Ok::<_, IoError>(DVec2::new(of(x)?, of(y)?));
    let mut checked = |points: Vec<DVec2>| -> Result<Vec<DVec2>, IoError> {
        budget
            .ring(points.len())
            .map_err(|what| refuse(node, what))?;
        let points = points
            .into_iter()
            .map(|p| point(p.x, p.y).map(|p| p + shift));
        points
            .collect::<Result<_, String>>()
            .map_err(|what| refuse(node, what))
    };
    // around a center, clockwise on the screen
    let turned = |points: Vec<DVec2>, center: DVec2| {
        let angle = node
            .attribute("rotation")
            .map_or(Ok(0.0), |_| of("rotation"))?;
        let axis = DVec2::from_angle(angle.to_radians());
        Ok::<_, IoError>(
            points
                .into_iter()
                .map(|p| center + axis.rotate(p - center))
                .collect::<Vec<_>>(),
        )
    };
    match node.tag_name().name() {
        "box" => {
            let (low, high) = (pair("xtl", "ytl")?, pair("xbr", "ybr")?);
            if !(high.x > low.x && high.y > low.y) {
                return Err(refuse(node, "has no width or no height; an area is needed"));
            }
            let corners = flatten::rectangle(low, high - low, DVec2::ZERO, flat);
            Ok((
                vec![checked(turned(corners, (low + high) / 2.0)?)?],
                Some(true),
            ))
        }
        "ellipse" => {
            let (center, radii) = (pair("cx", "cy")?, pair("rx", "ry")?);
            if radii.min_element() <= 0.0 {
                return Err(refuse(node, "has no width or no height; an area is needed"));
            }
            let points = flatten::ellipse(center, radii, flat);
            Ok((vec![checked(turned(points, center)?)?], Some(true)))
        }
        "mask" => {
            let runs = node.attribute("rle").unwrap_or_default().split(',');
            let runs: Result<Vec<f64>, _> = runs.map(|run| run.trim().parse::<f64>()).collect();
            let runs =
                runs.map_err(|_| refuse(node, "rle must be whole numbers between commas"))?;
            let whole = |name: &str| {
                let count = runs::count(of(name)?);
                count
                    .ok_or_else(|| refuse(node, format!("{name} must be a whole number of pixels")))
            };
            let size = [whole("width")?, whole("height")?];
            let corner = pair("left", "top")?;
            point(corner.x, corner.y).map_err(|what| refuse(node, what))?;
            let rings = runs::rings(&runs, size, false, budget);
            let mut rings = rings.map_err(|what| refuse(node, what))?;
            rings.iter_mut().flatten().for_each(|p| *p += corner);
            if rings.is_empty() {
                return Err(refuse(node, "has no pixel; one at least is needed"));
            }
            Ok((rings, Some(true)))
        }
        kind => {
            let points = checked(pairs(node)?)?;
            match kind {
                "points" => Ok((points.into_iter().map(|p| vec![p]).collect(), None)),
                "polyline" if points.len() > 1 => Ok((vec![points], Some(false))),
                "polygon" if unrepeated(points.clone()).len() > 2 => {
                    Ok((vec![unrepeated(points)], Some(true)))
                }
                _ => {
                    let least = if kind == "polygon" { 3 } else { 2 };
                    Err(refuse(
                        node,
                        format!("{} points; at least {least} are needed", points.len()),
                    ))
                }
            }
        }
    }
}

/// The attribute `points`: pairs `x,y` between semicolons.
fn pairs(node: Node<'_, '_>) -> Result<Vec<DVec2>, IoError> {
    let given = node.attribute("points").unwrap_or_default();
    let pair = |pair: &str| {
        let (x, y) = pair.split_once(',')?;
        Some(DVec2::new(x.trim().parse().ok()?, y.trim().parse().ok()?))
    };
    let each = (1..).zip(given.split(';').filter(|pair| !pair.trim().is_empty()));
    let points = each.map(|(number, text)| {
        pair(text).ok_or_else(|| refuse(node, format!("point {number} must be two numbers x,y")))
    });
    points.collect()
}
