//! Outlines as files: several in one file, each of one or more rings, with a name and whatever else
//! a program notes beside it.
//! Long because it is the door of all formats: what other crates call, each with its errors.
//!
//! [`load`] tells the [`Format`] of a file by its first bytes, [`Reading`] says what a file leaves
//! open, and [`write()`] makes the bytes of any format but those that are read only. Inside, pixels
//! are counted as in the rest of this program: x to the right, y down, the center of the first pixel
//! at (0, 0); what counts from that pixel's corner is moved by half a pixel.
//!
//! | format | read | written | of ids, labels, properties are kept |
//! | --- | --- | --- | --- |
//! | [`Csv`](Format::Csv) | x,y by heading, number or name | as read | ids |
//! | [`GeoJson`](Format::GeoJson) | every geometry | Polygon, `LineString`, Point, Multi… | all |
//! | [`Coco`](Format::Coco) | polygons, runs, boxes | polygons; with holes, runs of pixels | all |
//! | [`ImageJ`](Format::ImageJ) | areas, lines, points; `.roi`, `.zip` | 32-bit floats | all, as text |
//! | [`Svg`](Format::Svg) | every shape, transforms, curves as edges | a path each | ids, labels |
//! | [`Labelme`](Format::Labelme) | every shape, masks | all without holes | all |
//! | [`Cvat`](Format::Cvat) | every shape of images | | labels, properties |
//! | [`Mask`](Format::Mask) | any picture | PNG of 0 and 255 | none |
//! | [`Labels`](Format::Labels) | any picture of whole numbers | PNG of 16 bits | ids that are numbers |
//! | [`DeepLabels`](Format::DeepLabels) | the same | TIFF of 32 bits | ids that are numbers |
//! | [`Soft`](Format::Soft) | floats, or grey; the line of one half | | |
//!
//! Of a picture without a word on its format, 0 and 1 or black and white are a mask, other whole
//! numbers labels (those of colors their hexadecimal `#rrggbb`), and other numbers a soft mask; so are
//! black, white and grey of 8 or 16 bits where all grey lies along the borders of black and white.
//!
//! A table is a line `x,y` for each point.
//!
//! ```text
//! # contour 1, closed
//! x,y
//! 12.5,40
//! ```
//!
//! The comment and the heading may be left out; a heading names the columns, x and y among them in
//! any place; separators may be commas, semicolons, tabs or spaces. Several outlines have a column
//! `curve`, or blank lines between them; several rings of one outline have a column `ring`. Numbers
//! may have a decimal comma where commas are no separators. Labels and properties are not kept in a
//! table.

mod budget;
mod coco;
mod cvat;
mod flatten;
mod format;
mod geojson;
mod heading;
mod imagej;
mod json;
mod labelme;
mod line;
mod raster;
mod rings;
mod runs;
mod soft;
mod svg;
mod table;
mod trace;
mod xml;

use std::collections::BTreeMap;
use std::path::Path;

use glam::DVec2;

use crate::IoError;
use crate::limits::{MOST_CONTOUR_BYTES, MOST_STREAM};
use crate::read::{called, read_bytes};
use crate::write::write_whole;

pub(crate) use budget::Budget;
pub(crate) use geojson::feature;
pub(crate) use imagej::roi;
pub(crate) use line::Separator;
pub(crate) use raster::{boxed, labels};
pub(crate) use runs::of_columns;
pub(crate) use trace::Labels;

pub use format::{Column, Context, Format, Origin, Reading};
pub use soft::load_soft;

/// The property in which an outline of a sequence has its frame, from 0.
const FRAME: &str = "frame";

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

    /// Bytes of what it has besides points, roughly.
    fn weight(&self) -> usize {
        let own = |text: &Option<String>| text.as_ref().map_or(0, String::len);
        let properties = self
            .properties
            .iter()
            .map(|(name, value)| 64 + name.len() + value.weight());
        own(&self.id) + own(&self.label) + properties.sum::<usize>()
    }

    /// Its parts, each an outline of its own: of an area the outer ring of each and behind it the holes in it, of lines
    /// and points each ring. Of several parts that have an id, each has its number from 1 behind it: `7.1`, `7.2`.
    ///
    /// # Errors
    ///
    /// So many rings in rings that they would not be told apart in a sensible time.
    pub fn parts(&self) -> Result<Shapes, IoError> {
        if self.rings.len() < 2 {
            return Ok(vec![self.clone()]);
        }
        let parts = if self.closed == Some(false) {
            (0..self.rings.len()).map(|i| (i, Vec::new())).collect()
        } else {
            rings::parts(&self.rings).map_err(|what| IoError::text(None, what))?
        };
        let several = parts.len() > 1;
        let own = |(number, (outer, holes)): (usize, rings::Part)| Self {
            id: self.id.as_ref().map(|id| {
                if several {
                    format!("{id}.{number}")
                } else {
                    id.clone()
                }
            }),
            rings: std::iter::once(outer)
                .chain(holes)
                .map(|ring| self.rings[ring].clone())
                .collect(),
            label: self.label.clone(),
            closed: self.closed,
            properties: self.properties.clone(),
        };
        Ok((1..).zip(parts).map(own).collect())
    }

    /// The frame of the sequence that it is of, from 0, if its file says so: by a column, or by a property `frame`.
    #[must_use]
    pub fn frame(&self) -> Option<usize> {
        match self.properties.get(FRAME)? {
            Value::Number(number) if number.fract() == 0.0 && (0.0..1e9).contains(number) => {
                // exact: a whole number below 2^53
                format!("{number}").parse().ok()
            }
            Value::Text(text) => text.parse().ok(),
            _ => None,
        }
    }

    /// Its first ring.
    #[must_use]
    pub fn first(&self) -> &[DVec2] {
        self.rings.first().map_or(&[], |ring| ring)
    }
}

impl Value {
    /// Its bytes, roughly.
    fn weight(&self) -> usize {
        match self {
            Self::Text(text) => 32 + text.len(),
            Self::List(list) => 32 + list.iter().map(Self::weight).sum::<usize>(),
            Self::Table(table) => {
                64 + table
                    .iter()
                    .map(|(name, value)| 64 + name.len() + value.weight())
                    .sum::<usize>()
            }
            _ => 32,
        }
    }
}

/// Read the outlines of a file, or of standard input for `-`, of the format that its first bytes tell.
///
/// # Errors
///
/// A file that cannot be read, that is too large, or whatever [`parse_with`] refuses, by the file's name.
pub fn load(path: &Path) -> Result<Shapes, IoError> {
    load_with(path, &Reading::default())
}

/// [`load`] with a word on how.
///
/// # Errors
///
/// As [`load`].
pub fn load_with(path: &Path, reading: &Reading) -> Result<Shapes, IoError> {
    load_noted(path, reading).map(|(shapes, _)| shapes)
}

/// [`load_with`], and what people should know of how the file was read, if there is something.
///
/// # Errors
///
/// As [`load`].
pub fn load_noted(path: &Path, reading: &Reading) -> Result<(Shapes, Option<String>), IoError> {
    let most = |head: &[u8]| match format::kind(head) {
        format::Kind::Picture => MOST_STREAM,
        _ => MOST_CONTOUR_BYTES,
    };
    let bytes = read_bytes(path, "a CSV of x,y or another file of outlines", most)?;
    parse_named(&bytes, &called(path), reading)
}

/// [`load_noted`] from the bytes of a file of that name: its ending counts, and messages have it.
///
/// # Errors
///
/// Whatever [`parse_with`] refuses, by the file's name.
pub fn parse_named(
    bytes: &[u8],
    name: &Path,
    reading: &Reading,
) -> Result<(Shapes, Option<String>), IoError> {
    let ending = name.extension().and_then(|ending| ending.to_str());
    let roi = ending.is_some_and(|ending| ending.eq_ignore_ascii_case("roi"));
    let mut reading = reading.clone();
    if roi && reading.format.is_none() {
        // whatever else it is by its bytes would be a surprise
        reading.format = Some(Format::ImageJ);
    }
    let found = match format::kind(bytes) {
        format::Kind::Picture if reading.format.is_none() => raster::read(bytes, &reading),
        _ => parse_with(bytes, &reading).map(|shapes| (shapes, None)),
    };
    found.map_err(|error| error.within(name))
}

/// [`load`] for a file of one outline.
///
/// # Errors
///
/// As [`load`]; a file of more than one.
pub fn load_one(path: &Path) -> Result<Shape, IoError> {
    one(load(path)?).map_err(|error| error.within(&called(path)))
}

/// [`load_one`] from the bytes of a file of that name.
///
/// # Errors
///
/// As [`load_one`].
pub fn parse_one_named(bytes: &[u8], name: &Path) -> Result<Shape, IoError> {
    let (shapes, _) = parse_named(bytes, name, &Reading::default())?;
    one(shapes).map_err(|error| error.within(name))
}

/// Read outlines from bytes of that format.
///
/// # Errors
///
/// As [`parse_with`].
pub fn parse_as(bytes: &[u8], format: Format) -> Result<Shapes, IoError> {
    let format = Some(format);
    parse_with(
        bytes,
        &Reading {
            format,
            ..Reading::default()
        },
    )
}

/// Read outlines from the bytes of a file.
///
/// # Errors
///
/// Bytes of another format, cut or broken, or more than is sensible; numbers that are not finite or
/// too large; outlines of several pictures where [`Reading::picture`] names none. The message has
/// the line, the place in a JSON or the name in a ZIP, and at most a few words of the file.
pub fn parse_with(bytes: &[u8], reading: &Reading) -> Result<Shapes, IoError> {
    format::read(bytes, reading)
}

/// Read the outlines of a table: told apart by a column `curve` (or `id`, `label`, …) whose values
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
    one(parse(text)?)
}

fn one(mut shapes: Shapes) -> Result<Shape, IoError> {
    match shapes.pop() {
        Some(shape) if shapes.is_empty() => Ok(shape),
        _ => Err(IoError::text(
            None,
            format!("holds {} curves; a file of one is needed", shapes.len() + 1),
        )),
    }
}

/// Outlines as the bytes of a file.
///
/// # Errors
///
/// What the format cannot hold, by the number of the outline from 1: open lines where areas are needed, holes for
/// labelme, labels beyond 16 bits; a ring without points or with ones that are not finite; a picture without
/// pixels where its size is needed; a format that is read only.
pub fn write(shapes: &[Shape], format: Format, context: &Context) -> Result<Vec<u8>, IoError> {
    format::write(shapes, format, context)
}

/// Write outlines into one file of that format, whole or not at all.
///
/// # Errors
///
/// As [`write()`]; a folder that is not there or cannot be written.
pub fn save_as(
    shapes: &[Shape],
    path: &Path,
    format: Format,
    context: &Context,
) -> Result<(), IoError> {
    write_whole(path, &write(shapes, format, context)?)
}

/// Outlines as a table, which [`parse`] reads back exactly, but for labels and properties. Of more
/// than one, a column `curve` has the name of each, or where some have none, its number from 1 on;
/// where not all are closed or open, a column `closed` has 1 or 0; where one has several rings, a
/// column `ring` has their numbers from 0 on.
#[must_use]
pub fn to_text(shapes: &[Shape]) -> String {
    table::to_text(shapes, &[])
}

/// A number for each point of the first ring of each outline, for a column of its own.
#[derive(Debug, Clone, Copy)]
pub struct NodeColumn<'a> {
    /// Its heading.
    pub name: &'a str,
    /// The numbers of each outline; an entry is empty where there is none.
    pub values: &'a [Vec<Option<f64>>],
}

/// [`to_text`] with more columns behind the others; who reads outlines passes over them.
#[must_use]
pub fn to_text_with(shapes: &[Shape], columns: &[NodeColumn<'_>]) -> String {
    table::to_text(shapes, columns)
}

/// Write outlines into one table, whole or not at all.
///
/// # Errors
///
/// A folder that is not there or cannot be written.
pub fn save(shapes: &[Shape], path: &Path) -> Result<(), IoError> {
    write_whole(path, to_text(shapes).as_bytes())
}

#[cfg(test)]
mod refusals;
#[cfg(test)]
mod round_trips;
#[cfg(test)]
mod tests;
