//! The shapes of an SVG as outlines, and outlines as an SVG.
//!
//! Units are those of the outermost element, with every transform on the way: (0, 0) is the corner
//! of the first pixel of a picture that is drawn at its own size. Curves become edges. Parts of a
//! path that are closed make one outline, each open one its own. What is not drawn is passed over:
//! definitions, clips, patterns, `display="none"`. Properties are not written.

mod path;

use std::fmt::Write as _;

use glam::{DAffine2, DVec2};
use roxmltree::Node;
use svgtypes::{NumberListParser, TransformListParser, TransformListToken};

use super::budget::{Budget, cannot, point, unrepeated};
use super::format::{Context, Origin, Reading};
use super::geojson::shift;
use super::xml::{escaped, parse, refuse};
use super::{Shape, Shapes, flatten};
use crate::IoError;

/// Elements that hold what is not drawn where it stands.
const HIDDEN: [&str; 13] = [
    "defs",
    "clipPath",
    "mask",
    "pattern",
    "marker",
    "symbol",
    "filter",
    "linearGradient",
    "radialGradient",
    "style",
    "script",
    "metadata",
    "foreignObject",
];

/// A part of an outline and whether it is closed.
struct Ring {
    points: Vec<DVec2>,
    closed: bool,
}

pub(super) fn read(text: &str, reading: &Reading) -> Result<Shapes, IoError> {
    let document = parse(text)?;
    let root = document.root_element();
    if root.tag_name().name() != "svg" {
        return Err(refuse(root, "an svg is needed"));
    }
    let mut budget = Budget::default();
    let mut shapes = Shapes::new();
    let mut stack = vec![(root, DAffine2::IDENTITY)];
    let corner = shift(reading.origin.unwrap_or(Origin::Corner));
    while let Some((node, outer)) = stack.pop() {
        let name = node.tag_name().name();
        let hidden =
            node.attribute("display") == Some("none") || style(node, "display") == Some("none");
        if !node.is_element() || hidden || HIDDEN.contains(&name) {
            continue;
        }
        let place = outer * transform(node)?;
        if matches!(name, "svg" | "g" | "a" | "switch") {
            let nested = name == "svg" && node != root;
            if nested {
                return Err(refuse(
                    node,
                    "a drawing in a drawing; one drawing is needed",
                ));
            }
            // the first is on top, so that the order stays
            let children: Vec<Node<'_, '_>> = node.children().collect();
            stack.extend(children.into_iter().rev().map(|child| (child, place)));
            continue;
        }
        let scale = frobenius(&place);
        if !(scale.is_finite() && scale > 0.0) {
            return Err(refuse(
                node,
                "its transform leaves nothing; one that can be undone is needed",
            ));
        }
        let rings = rings(node, reading.flat() / scale, &mut budget)?;
        let mut closed = Vec::new();
        let mut add = |rings: Vec<Vec<DVec2>>, closed: Option<bool>| {
            let named = named(node);
            budget
                .shape()
                .and_then(|()| budget.points(named.weight() / 16))
                .map_err(|what| refuse(node, what))?;
            shapes.push(Shape {
                closed,
                rings,
                ..named
            });
            Ok::<(), IoError>(())
        };
        let mut open = Vec::new();
        for ring in rings {
            let points = ring.points.into_iter().map(|p| {
                let p = place.transform_point2(p);
                point(p.x, p.y).map(|p| p + corner)
            });
            let points: Result<Vec<DVec2>, String> = points.collect();
            let points = points.map_err(|what| refuse(node, what))?;
            let ends = points.first() == points.last() && points.len() > 3;
            if ring.closed || ends {
                closed.push(unrepeated(points));
            } else {
                open.push(points);
            }
        }
        closed.retain(|ring| ring.len() > 2);
        if !closed.is_empty() {
            add(closed, Some(true))?;
        }
        for points in open {
            let line = (points.len() > 1).then_some(false);
            add(vec![points], line)?;
        }
    }
    if shapes.is_empty() {
        return Err(IoError::text(
            None,
            "no outline; a path, polygon or another shape is needed",
        ));
    }
    Ok(shapes)
}

/// How much a transform can enlarge, or a little more.
fn frobenius(place: &DAffine2) -> f64 {
    let m = place.matrix2;
    (m.x_axis.length_squared() + m.y_axis.length_squared()).sqrt()
}

/// A value of the attribute `style`.
fn style<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    let all = node.attribute("style")?.split(';');
    let pairs = all.filter_map(|one| one.split_once(':'));
    let mut found = pairs.filter(|(key, _)| key.trim() == name);
    found.next().map(|(_, value)| value.trim())
}

fn named(node: Node<'_, '_>) -> Shape {
    let title = node
        .children()
        .find(|child| child.tag_name().name() == "title");
    let label = node
        .attribute("data-label")
        .or_else(|| title.and_then(|title| title.text()));
    let id = node.attribute("data-id").or_else(|| node.attribute("id"));
    Shape {
        id: id.map(str::to_owned),
        label: label.map(str::to_owned),
        ..Shape::default()
    }
}

fn transform(node: Node<'_, '_>) -> Result<DAffine2, IoError> {
    let mut all = DAffine2::IDENTITY;
    for token in TransformListParser::from(node.attribute("transform").unwrap_or_default()) {
        let token = token.map_err(|_| refuse(node, "its transform cannot be read"))?;
        let one = match token {
            TransformListToken::Matrix { a, b, c, d, e, f } => {
                DAffine2::from_cols_array(&[a, b, c, d, e, f])
            }
            TransformListToken::Translate { tx, ty } => {
                DAffine2::from_translation(DVec2::new(tx, ty))
            }
            TransformListToken::Scale { sx, sy } => DAffine2::from_scale(DVec2::new(sx, sy)),
            TransformListToken::Rotate { angle } => DAffine2::from_angle(angle.to_radians()),
            TransformListToken::SkewX { angle } => {
                DAffine2::from_cols_array(&[1.0, 0.0, angle.to_radians().tan(), 1.0, 0.0, 0.0])
            }
            TransformListToken::SkewY { angle } => {
                DAffine2::from_cols_array(&[1.0, angle.to_radians().tan(), 0.0, 1.0, 0.0, 0.0])
            }
        };
        all *= one;
    }
    Ok(all)
}

/// A length in user units; the default if it is not given.
fn length(node: Node<'_, '_>, name: &str, default: f64) -> Result<f64, IoError> {
    let Some(given) = node.attribute(name) else {
        return Ok(default);
    };
    let given = given.trim();
    let number = given
        .strip_suffix("px")
        .unwrap_or(given)
        .trim()
        .parse::<f64>();
    let number = number.ok().filter(|v| v.is_finite());
    number.ok_or_else(|| refuse(node, format!("{name} must be a number of pixels")))
}

/// The outline of an element in its own units; none of what is no shape.
fn rings(node: Node<'_, '_>, flat: f64, budget: &mut Budget) -> Result<Vec<Ring>, IoError> {
    let of = |name: &str| length(node, name, 0.0);
    let (points, closed) = match node.tag_name().name() {
        "path" => {
            let data = node.attribute("d").unwrap_or_default();
            return path::rings(data, flat, budget).map_err(|what| refuse(node, what));
        }
        "polygon" | "polyline" => {
            let numbers = NumberListParser::from(node.attribute("points").unwrap_or_default());
            let numbers: Result<Vec<f64>, _> = numbers.collect();
            let numbers = numbers.map_err(|_| refuse(node, "points must be pairs of numbers"))?;
            if !numbers.len().is_multiple_of(2) {
                return Err(refuse(node, "points must be pairs of numbers"));
            }
            let pairs = numbers.chunks_exact(2);
            let points = pairs.map(|pair| DVec2::new(pair[0], pair[1])).collect();
            (points, node.tag_name().name() == "polygon")
        }
        "line" => {
            let ends = vec![
                DVec2::new(of("x1")?, of("y1")?),
                DVec2::new(of("x2")?, of("y2")?),
            ];
            (ends, false)
        }
        "rect" => {
            let (rx, ry) = (node.attribute("rx"), node.attribute("ry"));
            let radii = match (rx.is_some(), ry.is_some()) {
                (true, false) => DVec2::splat(of("rx")?),
                (false, true) => DVec2::splat(of("ry")?),
                _ => DVec2::new(of("rx")?, of("ry")?),
            };
            let size = DVec2::new(of("width")?, of("height")?);
            let corner = DVec2::new(of("x")?, of("y")?);
            if size.min_element() <= 0.0 {
                (Vec::new(), true)
            } else {
                (
                    flatten::rectangle(corner, size, radii.max(DVec2::ZERO), flat),
                    true,
                )
            }
        }
        name @ ("circle" | "ellipse") => {
            let radii = if name == "circle" {
                DVec2::splat(of("r")?)
            } else {
                DVec2::new(of("rx")?, of("ry")?)
            };
            let center = DVec2::new(of("cx")?, of("cy")?);
            if radii.min_element() <= 0.0 {
                (Vec::new(), true)
            } else {
                (flatten::ellipse(center, radii, flat), true)
            }
        }
        "use" => {
            return Err(refuse(
                node,
                "stands for another element; that element itself is needed",
            ));
        }
        _ => (Vec::new(), true),
    };
    budget
        .ring(points.len())
        .map_err(|what| refuse(node, what))?;
    if points.is_empty() {
        return Ok(Vec::new());
    }
    Ok(vec![Ring { points, closed }])
}

pub(super) fn write(shapes: &[Shape], context: &Context) -> Result<Vec<u8>, IoError> {
    let (width, height) = (context.width, context.height);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
         width=\"{width}\" height=\"{height}\">\n"
    );
    // writing to a String cannot fail
    if let Some(picture) = &context.picture {
        let name = escaped(picture);
        let _ = writeln!(
            text,
            "<image href=\"{name}\" width=\"{width}\" height=\"{height}\"/>"
        );
    }
    text.push_str("<g fill=\"none\" fill-rule=\"evenodd\" stroke=\"#f00\">\n");
    for (number, shape) in (1..).zip(shapes) {
        text.push_str("<path");
        for (name, value) in [("data-id", &shape.id), ("data-label", &shape.label)] {
            if let Some(value) = value {
                let _ = write!(text, " {name}=\"{}\"", escaped(value));
            }
        }
        text.push_str(" d=\"");
        for ring in &shape.rings {
            for (index, p) in ring.iter().enumerate() {
                let letter = match index {
                    0 => "M",
                    1 => "L",
                    _ => " ",
                };
                let _ = write!(text, "{letter}{},{}", p.x + 0.5, p.y + 0.5);
            }
            if shape.closed != Some(false) && ring.len() > 1 {
                if ring.len() < 3 {
                    let message =
                        format!("outline {number} is closed and has 2 points; 3 are needed");
                    return Err(cannot("svg", message));
                }
                text.push('Z');
            }
        }
        text.push_str("\"/>\n");
    }
    text.push_str("</g>\n</svg>\n");
    Ok(text.into_bytes())
}
