//! The outline of one `ImageJ` ROI.

use std::collections::BTreeMap;

use glam::DVec2;

use super::{
    ANGLE, COORDINATES, FREEHAND, FREELINE, LINE, OVAL, POINT, POLYGON, POLYLINE, RECTANGLE,
    SUBPIXEL, TRACED,
};
use crate::shapes::budget::{Budget, point, unrepeated};
use crate::shapes::flatten;
use crate::shapes::format::{Origin, Reading};
use crate::shapes::{FRAME, Shape, Shapes, Value};

/// Numbers of whole coordinates below which they are taken to be without a sign.
const LEAST: i32 = -5000;
/// The least versions that have floats behind their whole numbers, and in their rectangles.
const FLOATS: u16 = 222;
const FLOAT_RECTANGLES: u16 = 223;
/// Subtypes that are no outlines.
const NO_OUTLINES: [(u16, &str); 2] = [(1, "a text"), (4, "a picture")];
/// Where the head has the place in its stack.
const POSITION: usize = 56;
/// Letters of a name or of properties.
const MOST_LETTERS: usize = 10_000;

/// The bytes of a file, of which none is taken that is not there.
struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn four(&self, at: usize) -> Result<[u8; 4], String> {
        let found = self.0.get(at..).and_then(|rest| rest.first_chunk::<4>());
        found.copied().ok_or_else(|| {
            format!(
                "ends after {} bytes, before its outline does; a whole ROI is needed",
                self.0.len()
            )
        })
    }

    fn short(&self, at: usize) -> Result<u16, String> {
        let found = self.0.get(at..).and_then(|rest| rest.first_chunk::<2>());
        found.map(|two| u16::from_be_bytes(*two)).ok_or_else(|| {
            format!(
                "ends after {} bytes, before its outline does; a whole ROI is needed",
                self.0.len()
            )
        })
    }

    /// A place on an axis, which may be below zero.
    fn place(&self, at: usize) -> Result<f64, String> {
        let short = self.short(at)?;
        let signed = i32::from(short.cast_signed());
        Ok(f64::from(if signed < LEAST {
            i32::from(short)
        } else {
            signed
        }))
    }

    fn long(&self, at: usize) -> Result<usize, String> {
        let number = u32::from_be_bytes(self.four(at)?);
        usize::try_from(number).map_err(|error| error.to_string())
    }

    fn float(&self, at: usize) -> Result<f64, String> {
        Ok(f64::from(f32::from_be_bytes(self.four(at)?)))
    }

    /// Letters of two bytes.
    fn text(&self, at: usize, count: usize) -> Option<String> {
        let bytes = self
            .0
            .get(at..)?
            .get(..count.min(MOST_LETTERS).checked_mul(2)?)?;
        let letters = bytes
            .chunks_exact(2)
            .map(|two| u16::from_be_bytes([two[0], two[1]]));
        let text: Vec<u16> = letters.collect();
        (!text.is_empty()).then(|| String::from_utf16_lossy(&text))
    }
}

/// The outlines of a file: one, but for one for each of several points.
pub(super) fn shapes(
    bytes: &[u8],
    reading: &Reading,
    budget: &mut Budget,
) -> Result<Shapes, String> {
    if !bytes.starts_with(b"Iout") {
        return Err("does not begin as an ImageJ ROI does, which is needed".to_owned());
    }
    let bytes = Bytes(bytes);
    let version = bytes.short(4)?;
    let kind = bytes.short(6)?.to_be_bytes()[0];
    let subtype = bytes.short(48)?;
    if let Some((_, what)) = NO_OUTLINES.iter().find(|(known, _)| *known == subtype) {
        return Err(format!("is {what}; an outline is needed"));
    }
    let composite = bytes.long(36)? > 0;
    let rings = if composite {
        path(&bytes, reading.flat(), budget)?
    } else {
        vec![ring(&bytes, kind, version, reading.flat(), budget)?]
    };
    let line = matches!(kind, LINE | FREELINE | POLYLINE | ANGLE | POINT) && !composite;
    let corner = reading
        .origin
        .map_or(!line, |origin| origin == Origin::Corner);
    let shift = if corner {
        DVec2::splat(-0.5)
    } else {
        DVec2::ZERO
    };
    let mut shape = Shape {
        closed: (kind != POINT).then_some(!line),
        ..named(&bytes)
    };
    placed(&mut shape, &bytes);
    let mut done: Vec<Vec<DVec2>> = Vec::new();
    for ring in rings {
        let points = ring.into_iter().map(|p| point(p.x, p.y).map(|p| p + shift));
        let mut points: Vec<DVec2> = points.collect::<Result<_, _>>()?;
        if !line {
            points = unrepeated(points);
        }
        let least = if kind == POINT && !composite {
            1
        } else if line {
            2
        } else {
            3
        };
        if points.len() < least {
            return Err(format!(
                "has {} different points; at least {least} are needed",
                points.len()
            ));
        }
        done.push(points);
    }
    if kind == POINT
        && !composite
        && let [points] = &done[..]
    {
        let mut shapes = Shapes::new();
        let weight = shape.weight() / 16;
        for p in points {
            budget.shape()?;
            budget.points(weight)?;
            shapes.push(Shape {
                rings: vec![vec![*p]],
                ..shape.clone()
            });
        }
        return Ok(shapes);
    }
    shape.rings = done;
    Ok(vec![shape])
}

/// The points as the file has them.
fn ring(
    bytes: &Bytes<'_>,
    kind: u8,
    version: u16,
    flat: f64,
    budget: &mut Budget,
) -> Result<Vec<DVec2>, String> {
    let [top, left, bottom, right] = [8, 10, 12, 14].map(|at| bytes.place(at));
    let (top, left, mut bottom, mut right) = (top?, left?, bottom?, right?);
    // those that are no more than the first are without a sign
    if bottom <= top && bottom < 0.0 {
        bottom += 65536.0;
    }
    if right <= left && right < 0.0 {
        right += 65536.0;
    }
    let subpixel = bytes.short(50)? & SUBPIXEL != 0;
    match kind {
        RECTANGLE | OVAL => {
            let (mut corner, mut size) = (
                DVec2::new(left, top),
                DVec2::new(right - left, bottom - top),
            );
            if subpixel && version >= FLOAT_RECTANGLES {
                corner = DVec2::new(bytes.float(18)?, bytes.float(22)?);
                size = DVec2::new(bytes.float(26)?, bytes.float(30)?);
            }
            point(corner.x, corner.y)?;
            point(size.x, size.y)?;
            if !(size.x > 0.0 && size.y > 0.0) {
                return Err("has no width or no height; an area is needed".to_owned());
            }
            budget.shape()?;
            if kind == OVAL {
                return Ok(flatten::ellipse(corner + size / 2.0, size / 2.0, flat));
            }
            let arc = f64::from(bytes.short(54)?) / 2.0;
            Ok(flatten::rectangle(corner, size, DVec2::splat(arc), flat))
        }
        LINE => {
            budget.ring(2)?;
            let ends = [18, 26].map(|at| Ok(DVec2::new(bytes.float(at)?, bytes.float(at + 4)?)));
            ends.into_iter().collect()
        }
        POLYGON | FREEHAND | TRACED | FREELINE | POLYLINE | ANGLE | POINT => {
            let mut count = usize::from(bytes.short(16)?);
            if count == 0 {
                count = bytes.long(18)?;
            }
            let each = if subpixel && version >= FLOATS { 12 } else { 4 };
            let there = bytes.0.len().saturating_sub(COORDINATES) / each;
            if count > there {
                return Err(format!(
                    "says it has {count} points, of which {there} are there; a whole ROI is needed"
                ));
            }
            budget.ring(count)?;
            let at = COORDINATES;
            let one = |i: usize| {
                if each == 12 {
                    let x = bytes.float(at + 4 * count + 4 * i)?;
                    return Ok(DVec2::new(x, bytes.float(at + 8 * count + 4 * i)?));
                }
                let x = f64::from(bytes.short(at + 2 * i)?);
                let y = f64::from(bytes.short(at + 2 * count + 2 * i)?);
                Ok(DVec2::new(left + x, top + y))
            };
            (0..count).map(one).collect()
        }
        other => Err(format!(
            "is of the type {other}, which is no outline; an area, a line or points are needed"
        )),
    }
}

/// The rings of a path of several.
fn path(bytes: &Bytes<'_>, flat: f64, budget: &mut Budget) -> Result<Vec<Vec<DVec2>>, String> {
    let count = bytes.long(36)?;
    let there = bytes.0.len().saturating_sub(COORDINATES) / 4;
    if count > there {
        return Err(format!(
            "says its path has {count} numbers, of which {there} are there; a whole ROI is needed"
        ));
    }
    let mut rings: Vec<Vec<DVec2>> = Vec::new();
    let mut at = 0;
    let mut next = |what: &str| {
        if at >= count {
            return Err(format!(
                "its path ends within {what}; a whole one is needed"
            ));
        }
        at += 1;
        bytes
            .float(COORDINATES + 4 * (at - 1))
            .map(|v| (v, at == count))
    };
    loop {
        let (step, mut last) = next("a step")?;
        let mut corners = [DVec2::ZERO; 3];
        let many = [1, 1, 2, 3, 0];
        let kind = (0..5_u8).find(|&kind| (step - f64::from(kind)).abs() < 1e-6);
        let kind = usize::from(kind.ok_or("a step of its path must be of a kind from 0 to 4")?);
        for corner in corners.iter_mut().take(many[kind]) {
            let x = next("a step")?.0;
            let y;
            (y, last) = next("a step")?;
            *corner = point(x, y)?;
        }
        if kind == 0 {
            budget.ring(1)?;
            rings.push(vec![corners[0]]);
        } else if kind < 4 {
            let ring = rings
                .last_mut()
                .ok_or("its path does not begin with a place")?;
            let from = *ring.last().ok_or("its path does not begin with a place")?;
            let points = match kind {
                1 => vec![corners[0]],
                2 => flatten::quadratic([from, corners[0], corners[1]], flat),
                _ => flatten::cubic([from, corners[0], corners[1], corners[2]], flat),
            };
            budget.points(points.len())?;
            ring.extend(points);
        }
        if last {
            break;
        }
    }
    // a place without a line from it is no ring
    rings.retain(|ring| ring.len() > 1);
    if rings.is_empty() {
        return Err("its path has no line; an outline is needed".to_owned());
    }
    Ok(rings)
}

/// What the second head says: the name, and properties, each on a line of its own.
fn named(bytes: &Bytes<'_>) -> Shape {
    let mut shape = Shape::default();
    let long = |at: usize| bytes.long(at).unwrap_or(0);
    let head = long(60);
    if head == 0 || head.checked_add(52).is_none_or(|end| end > bytes.0.len()) {
        return shape;
    }
    shape.id = bytes.text(long(head + 16), long(head + 20));
    let lines = bytes
        .text(long(head + 40), long(head + 44))
        .unwrap_or_default();
    let pairs = lines.lines().filter_map(|line| line.split_once(": "));
    let mut properties: BTreeMap<String, Value> = pairs
        .map(|(name, value)| (name.to_owned(), Value::Text(value.to_owned())))
        .collect();
    if let Some(Value::Text(label)) = properties.remove("label") {
        shape.label = Some(label);
    }
    shape.properties = properties;
    shape
}

/// Note the place in its stack, from 1, as a frame, from 0, where nothing else says of which frame it is.
fn placed(shape: &mut Shape, bytes: &Bytes<'_>) {
    if let Some(frame) = bytes.long(POSITION).unwrap_or(0).checked_sub(1)
        && shape.frame().is_none()
        && let Ok(frame) = u32::try_from(frame)
    {
        let frame = Value::Number(f64::from(frame));
        shape.properties.insert(FRAME.to_owned(), frame);
    }
}
