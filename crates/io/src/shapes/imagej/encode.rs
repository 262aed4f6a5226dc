//! An outline as an `ImageJ` ROI.

use glam::DVec2;

use super::{COORDINATES, POINT, POLYGON, POLYLINE, RECTANGLE, SUBPIXEL};
use crate::shapes::rings::bounds;
use crate::shapes::{Shape, Value};

/// The version that is written.
const VERSION: u16 = 227;
/// Points that the head can count.
const MOST_POINTS: usize = 65535;

/// The file of an outline.
pub(crate) fn roi(shape: &Shape) -> Result<Vec<u8>, String> {
    let open = shape.closed == Some(false);
    let (kind, shift) = match &shape.rings[..] {
        [ring] if ring.len() == 1 => (POINT, 0.0),
        [_] if open => (POLYLINE, 0.0),
        [_] => (POLYGON, 0.5),
        _ if open => return Err("has several lines; one is needed".to_owned()),
        _ => (RECTANGLE, 0.5),
    };
    let least = if open { 2 } else { 3 };
    if kind != POINT && shape.rings.iter().any(|ring| ring.len() < least) {
        return Err(format!(
            "has a ring of fewer than {least} points, which are needed"
        ));
    }
    let rings: Vec<Vec<DVec2>> = shape
        .rings
        .iter()
        .map(|ring| ring.iter().map(|&p| p + shift).collect())
        .collect();
    let count: usize = rings.iter().map(Vec::len).sum();
    // what the head cannot count goes as a path
    let path = kind == RECTANGLE || count > MOST_POINTS;
    if path && open {
        return Err(format!(
            "is a line of {count} points; at most {MOST_POINTS} are needed"
        ));
    }
    let (low, high) =
        bounds(rings.iter().flatten()).ok_or("has no point; one at least is needed")?;
    let (low, high) = (low.floor(), high.ceil());
    let mut file = vec![0_u8; COORDINATES];
    file[..4].copy_from_slice(b"Iout");
    put(&mut file, 4, &VERSION.to_be_bytes());
    file[6] = if path { RECTANGLE } else { kind };
    for (at, v) in [(8, low.y), (10, low.x), (12, high.y), (14, high.x)] {
        put(&mut file, at, &short(v));
    }
    if path {
        let numbers = path_of(&rings);
        let many = u32::try_from(numbers.len()).map_err(|_| "has too many points".to_owned())?;
        put(&mut file, 36, &many.to_be_bytes());
        file.extend(numbers.into_iter().flat_map(f32::to_be_bytes));
    } else {
        let many = u16::try_from(count).map_err(|error| error.to_string())?;
        put(&mut file, 16, &many.to_be_bytes());
        put(&mut file, 50, &SUBPIXEL.to_be_bytes());
        let each = || rings.iter().flatten();
        file.extend(each().flat_map(|p| short((p.x - low.x).round())));
        file.extend(each().flat_map(|p| short((p.y - low.y).round())));
        file.extend(each().flat_map(|p| narrow(p.x).to_be_bytes()));
        file.extend(each().flat_map(|p| narrow(p.y).to_be_bytes()));
    }
    head(&mut file, shape)?;
    Ok(file)
}

/// The second head, with the name and the properties behind it.
fn head(file: &mut Vec<u8>, shape: &Shape) -> Result<(), String> {
    let begin = file.len();
    let letters =
        |text: &str| -> Vec<u8> { text.encode_utf16().flat_map(u16::to_be_bytes).collect() };
    let name = letters(shape.id.as_deref().unwrap_or_default());
    let mut lines = String::new();
    let mut line = |name: &str, value: &str| {
        let one_line = |text: &str| !text.contains(['\n', '\r']) && !text.contains(": ");
        if one_line(name) && !value.contains(['\n', '\r']) {
            lines.push_str(&format!("{name}: {value}\n"));
        }
    };
    if let Some(label) = &shape.label {
        line("label", label);
    }
    for (name, value) in &shape.properties {
        match value {
            Value::Text(text) => line(name, text),
            Value::Number(number) => line(name, &number.to_string()),
            Value::Bool(yes) => line(name, &yes.to_string()),
            _ => {}
        }
    }
    let properties = letters(&lines);
    let mut second = vec![0_u8; 64];
    let first = begin + second.len();
    for (at, offset, bytes) in [(16, first, &name), (40, first + name.len(), &properties)] {
        let long =
            |v: usize| u32::try_from(v).map_err(|_| "is too large for this format".to_owned());
        if !bytes.is_empty() {
            put(&mut second, at, &long(offset)?.to_be_bytes());
            put(&mut second, at + 4, &long(bytes.len() / 2)?.to_be_bytes());
        }
    }
    let begin = u32::try_from(begin).map_err(|_| "is too large for this format".to_owned())?;
    put(file, 60, &begin.to_be_bytes());
    file.extend(second);
    file.extend(name);
    file.extend(properties);
    Ok(())
}

/// Steps of a path: to the first point, lines, back.
fn path_of(rings: &[Vec<DVec2>]) -> Vec<f32> {
    let mut numbers = Vec::new();
    for ring in rings {
        for (index, p) in ring.iter().enumerate() {
            numbers.extend([if index == 0 { 0.0 } else { 1.0 }, narrow(p.x), narrow(p.y)]);
        }
        numbers.push(4.0);
    }
    numbers
}

fn put(file: &mut [u8], at: usize, bytes: &[u8]) {
    file[at..at + bytes.len()].copy_from_slice(bytes);
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to f32 is the point"
)]
const fn narrow(v: f64) -> f32 {
    v as f32
}

/// A whole number of sixteen bits; those beyond are held at the ends, the floats say more.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to sixteen bits, of which the upper half stands for negative ones too"
)]
const fn short(v: f64) -> [u8; 2] {
    (v.clamp(-5000.0, 60535.0) as i32 as u16).to_be_bytes()
}
