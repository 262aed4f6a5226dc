//! Outlines as files: several in one file, each of one or more rings, with a name and whatever else
//! a program notes beside it.
//!
//! The one format so far is a table: a line `x,y` for each point.
//!
//! ```text
//! # contour 1, closed
//! x,y
//! 12.5,40
//! ```
//!
//! The comment and the heading may be left out; a heading names the columns, x and y among them in
//! any place; separators may be commas, semicolons, tabs or spaces. Several outlines have a column
//! `curve`, or blank lines between them; several rings of one outline have a column `ring`. Labels
//! and properties are not kept in a table.

mod heading;
mod line;
mod table;

use std::collections::BTreeMap;
use std::path::Path;

use glam::DVec2;

use crate::IoError;
use crate::limits::MOST_CONTOUR_BYTES;
use crate::read::{called, read_text};
use crate::write::write_whole;

/// The outlines of a file.
pub type Shapes = Vec<Shape>;

/// One outline: a curve, or the border of an area that may have holes and several parts.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Shape {
    /// What its file tells it from others by.
    pub id: Option<String>,
    /// What it is a picture of.
    pub label: Option<String>,
    /// Whether the last point of each ring joins its first, if the file says so.
    pub closed: Option<bool>,
    /// The points, in order, in pixels. Of an area, a place is inside that an odd number of rings
    /// goes around: a ring in another is a hole, one beside it another part.
    pub rings: Vec<Vec<DVec2>>,
    /// Whatever else is noted of it, by name.
    pub properties: BTreeMap<String, Value>,
}

/// A value noted beside an outline.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Value {
    /// A name without a value.
    #[default]
    Nothing,
    /// Yes or no.
    Bool(bool),
    /// A number.
    Number(f64),
    /// Words.
    Text(String),
    /// Several values.
    List(Vec<Self>),
    /// Values with names of their own.
    Table(BTreeMap<String, Self>),
}

impl Shape {
    /// A curve without a name.
    #[must_use]
    pub fn curve(points: Vec<DVec2>, closed: Option<bool>) -> Self {
        Self {
            closed,
            rings: vec![points],
            ..Self::default()
        }
    }

    /// Its first ring.
    #[must_use]
    pub fn first(&self) -> &[DVec2] {
        self.rings.first().map_or(&[], |ring| ring)
    }
}

/// Read the outlines of a file, or of standard input for `-`.
///
/// # Errors
///
/// A file that cannot be read, or whatever [`parse`] refuses, by the file's name.
pub fn load(path: &Path) -> Result<Shapes, IoError> {
    let text = read_text(path, "a CSV of x,y", MOST_CONTOUR_BYTES)?;
    parse(&text).map_err(|error| error.within(&called(path)))
}

/// [`load`] for a file of one outline.
///
/// # Errors
///
/// As [`load`]; a file of more than one.
pub fn load_one(path: &Path) -> Result<Shape, IoError> {
    let text = read_text(path, "a CSV of x,y", MOST_CONTOUR_BYTES)?;
    parse_one(&text).map_err(|error| error.within(&called(path)))
}

/// Read the outlines of a text: told apart by a column `curve` (or `id`, `label`, …) whose values
/// repeat, by blank lines or by headings between them.
///
/// # Errors
///
/// A message that names the line, and shows nothing of it: no two finite numbers, more entries than
/// the heading has names, a heading without x or y.
pub fn parse(text: &str) -> Result<Shapes, IoError> {
    table::parse(text)
}

/// [`parse`] for a text of one outline.
///
/// # Errors
///
/// As [`parse`]; a text of more than one.
pub fn parse_one(text: &str) -> Result<Shape, IoError> {
    let mut shapes = parse(text)?;
    match shapes.pop() {
        Some(shape) if shapes.is_empty() => Ok(shape),
        _ => Err(IoError::text(
            None,
            format!("holds {} curves; a file of one is needed", shapes.len() + 1),
        )),
    }
}

/// Outlines as text, which [`parse`] reads back exactly, but for labels and properties. Of more
/// than one, a column `curve` has the name of each, or where some have none, its number from 1 on;
/// where not all are closed or open, a column `closed` has 1 or 0; where one has several rings, a
/// column `ring` has their numbers from 0 on.
#[must_use]
pub fn to_text(shapes: &[Shape]) -> String {
    table::to_text(shapes)
}

/// Write outlines into one file, whole or not at all.
///
/// # Errors
///
/// A folder that is not there or cannot be written.
pub fn save(shapes: &[Shape], path: &Path) -> Result<(), IoError> {
    write_whole(path, to_text(shapes).as_bytes())
}

#[cfg(test)]
mod tests;
