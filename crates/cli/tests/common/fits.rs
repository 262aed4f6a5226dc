//! A drawn disc, one whose edge has faded on one side, a blank picture; what a fit of them has written.

use serde_json::Value;

use super::{Folder, disc};

pub(crate) const SIZE: usize = 96;
pub(crate) const CENTER: [f64; 2] = [47.3, 45.6];
pub(crate) const RADIUS: f64 = 26.0;
pub(crate) const START: &str = "circle:48,46,28";

pub(crate) fn blank() -> Vec<u8> {
    [
        format!("P5 {SIZE} {SIZE} 255\n").as_bytes(),
        &[60; SIZE * SIZE],
    ]
    .concat()
}

/// The disc, its ground as bright as itself left of its middle.
pub(crate) fn faded() -> Vec<u8> {
    let mut bytes = disc(SIZE, CENTER, RADIUS);
    let head = bytes.len() - SIZE * SIZE;
    for (at, level) in bytes[head..].iter_mut().enumerate() {
        if at % SIZE < 47 {
            *level = 200;
        }
    }
    bytes
}

pub(crate) fn text(folder: &Folder, name: &str) -> String {
    std::fs::read_to_string(folder.path(name)).unwrap()
}

pub(crate) fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

/// Whether a number of a JSON, which is read to a part in 1e15 or so, is that one.
pub(crate) fn near(value: &Value, number: f64) -> bool {
    value
        .as_f64()
        .is_some_and(|value| (value - number).abs() < 1e-9)
}

/// The disc, its border softened over so many pixels.
pub(crate) fn soft(pixels: f64) -> Vec<u8> {
    let mut bytes = format!("P5 {SIZE} {SIZE} 255\n").into_bytes();
    for at in 0..SIZE * SIZE {
        let (dx, dy) = (
            (at % SIZE) as f64 - CENTER[0],
            (at / SIZE) as f64 - CENTER[1],
        );
        let share = ((RADIUS - dx.hypot(dy)) / pixels + 0.5).clamp(0.0, 1.0);
        bytes.push((60.0 + 140.0 * share).round() as u8);
    }
    bytes
}

/// A level as a byte.
pub(crate) fn byte(level: f64) -> u8 {
    level.round().clamp(0.0, 255.0) as u8
}

/// A bright disc in a grey picture, as PGM; without contrast nothing is found.
pub(crate) fn small_disc(contrast: f64) -> Vec<u8> {
    let mut text = b"P5\n64 48\n255\n".to_vec();
    for y in 0..48 {
        for x in 0..64 {
            let inside = 12.5 - (f64::from(x) - 30.0).hypot(f64::from(y) - 24.0);
            let level = 60.0 + contrast * inside.clamp(0.0, 1.0);
            text.push(byte(level));
        }
    }
    text
}
