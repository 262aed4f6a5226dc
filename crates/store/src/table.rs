//! The table of one picture as the bytes of a Parquet file.

use std::sync::Arc;

use glam::DVec2;
use parquet::basic::{Compression, Encoding};
use parquet::data_type::{
    BoolType, ByteArray, ByteArrayType, DataType, DoubleType, FloatType, Int32Type,
};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;
use parquet::schema::types::ColumnPath;
use score::Measures;

/// The columns; the lists are those of Parquet's three levels, as every writer has them.
const SCHEMA: &str = "message schema {
    optional binary image (STRING);
    optional int32 object;
    optional boolean is_outline;
    optional binary outcome (STRING);
    optional binary reason (STRING);
    optional boolean closed;
    optional int32 nodes;
    optional double area;
    optional double perimeter;
    optional double major_axis;
    optional double minor_axis;
    optional double angle;
    optional double circularity;
    optional double solidity;
    optional double centroid_x;
    optional double centroid_y;
    optional group x (LIST) { repeated group list { optional double element; } }
    optional group y (LIST) { repeated group list { optional double element; } }
    optional group error (LIST) { repeated group list { optional float element; } }
    optional group strength (LIST) { repeated group list { optional float element; } }
    optional binary geometry;
}";

/// Which column holds the geometry, by `GeoParquet` 1.1; no system of coordinates, since pixels lie nowhere on Earth.
const GEO: &str = r#"{"version": "1.1.0", "primary_column": "geometry", "columns": {"geometry": {"encoding": "WKB", "geometry_types": ["Polygon", "LineString"], "crs": null}}}"#;

/// Columns of few different texts.
const TEXTS: [&str; 3] = ["image", "outcome", "reason"];

/// Columns of floats by nodes: their bytes are stored place by place, which makes them smaller than any packing of
/// whole numbers.
const BY_NODES: [&str; 4] = ["x", "y", "error", "strength"];

/// An outline as a row of the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row<'a> {
    /// Its nodes. Pixels, the first pixel's center at (0, 0).
    pub points: &'a [DVec2],
    /// Whether the last node is joined to the first.
    pub closed: bool,
    /// Whether nothing speaks against it.
    pub is_outline: bool,
    /// How it ended, in a word.
    pub outcome: &'a str,
    /// The same in words; what speaks against it where it is no outline.
    pub reason: &'a str,
    /// Standard error of each node, NaN where there is none. Pixels; empty if none is known.
    pub errors: &'a [f64],
    /// Strength of the edge at each node, NaN where there is none; empty if none is known.
    pub strengths: &'a [f64],
}

impl<'a> Row<'a> {
    /// An outline of which nothing is known but its nodes.
    #[must_use]
    pub const fn of(points: &'a [DVec2], closed: bool) -> Self {
        Self {
            points,
            closed,
            is_outline: true,
            outcome: "read",
            reason: "read from a file",
            errors: &[],
            strengths: &[],
        }
    }

    /// As well-known binary: a polygon or a line.
    fn geometry(&self) -> Vec<u8> {
        let (count, last) = if self.closed {
            (self.points.len() + 1, self.points.first())
        } else {
            (self.points.len(), None)
        };
        let kind: &[u32] = if self.closed { &[3, 1] } else { &[2] };
        let mut bytes = Vec::with_capacity(13 + 16 * count);
        bytes.push(1); // the least byte comes first
        for word in kind {
            bytes.extend(word.to_le_bytes());
        }
        bytes.extend(u32::try_from(count).unwrap_or(u32::MAX).to_le_bytes());
        for p in self.points.iter().chain(last) {
            bytes.extend(p.x.to_le_bytes());
            bytes.extend(p.y.to_le_bytes());
        }
        bytes
    }

    /// What it measures, where it encloses something.
    fn measures(&self) -> Option<Measures> {
        let measures = Measures::of(&[self.points]).ok().filter(|_| self.closed)?;
        (measures.area > 0.0).then_some(measures)
    }
}

/// What stands in one row.
enum Line<'a> {
    /// An outline.
    Outline(&'a Row<'a>, Option<Measures>),
    /// No outline, and why: outcome and reason.
    Without(&'a str, &'a str),
}

impl<'a> Line<'a> {
    const fn row(&self) -> Option<&'a Row<'a>> {
        match self {
            Self::Outline(row, _) => Some(row),
            Self::Without(..) => None,
        }
    }

    fn measure(&self, of: impl Fn(&Measures) -> f64) -> Option<f64> {
        match self {
            Self::Outline(_, measures) => measures.as_ref().map(of),
            Self::Without(..) => None,
        }
    }
}

/// The file of a picture with these outlines. The same outlines are the same bytes.
///
/// # Errors
///
/// What the format cannot hold: more than 2³¹ bytes in a column.
pub fn written(image: &str, rows: &[Row<'_>]) -> Result<Vec<u8>, ParquetError> {
    if rows.is_empty() {
        return empty(image, "no start in this image");
    }
    let lines: Vec<Line<'_>> = rows
        .iter()
        .map(|row| Line::Outline(row, row.measures()))
        .collect();
    file(image, &lines)
}

/// The file of a picture in which there was nothing to find.
///
/// # Errors
///
/// As [`written`].
pub fn empty(image: &str, reason: &str) -> Result<Vec<u8>, ParquetError> {
    file(image, &[Line::Without("empty", reason)])
}

/// The file of a picture that was refused, so that it is not tried again.
///
/// # Errors
///
/// As [`written`].
pub fn refused(image: &str, reason: &str) -> Result<Vec<u8>, ParquetError> {
    file(image, &[Line::Without("refused", reason)])
}

fn properties() -> WriterProperties {
    let mut properties = WriterProperties::builder()
        .set_created_by("snakes".to_owned())
        .set_compression(Compression::SNAPPY)
        .set_dictionary_enabled(false)
        .set_statistics_enabled(EnabledStatistics::None)
        .set_offset_index_disabled(true)
        .set_key_value_metadata(Some(vec![KeyValue::new("geo".to_owned(), GEO.to_owned())]));
    for name in TEXTS {
        properties = properties.set_column_dictionary_enabled(ColumnPath::from(name), true);
    }
    for name in ["image", "area"] {
        let chunk = EnabledStatistics::Chunk;
        properties = properties.set_column_statistics_enabled(ColumnPath::from(name), chunk);
    }
    for name in BY_NODES {
        let path = [name, "list", "element"].map(str::to_owned).to_vec();
        let split = Encoding::BYTE_STREAM_SPLIT;
        properties = properties.set_column_encoding(ColumnPath::new(path), split);
    }
    properties.build()
}

fn file(image: &str, lines: &[Line<'_>]) -> Result<Vec<u8>, ParquetError> {
    let schema = Arc::new(parse_message_type(SCHEMA)?);
    let mut file = SerializedFileWriter::new(Vec::new(), schema, Arc::new(properties()))?;
    let mut group = file.next_row_group()?;
    let text = |text: &str| Some(ByteArray::from(text));
    let rows = || lines.iter().map(Line::row);
    let number = |number: usize| i32::try_from(number).ok();
    let with = |index: usize, line: &Line<'_>| line.row().and_then(|_| number(index));
    column::<ByteArrayType>(&mut group, lines.iter().map(|_| text(image)))?;
    let objects = lines.iter().enumerate().map(|(i, line)| with(i, line));
    column::<Int32Type>(&mut group, objects)?;
    let good = rows().map(|row| Some(row.is_some_and(|row| row.is_outline)));
    column::<BoolType>(&mut group, good)?;
    let (mut outcomes, mut reasons) = (Vec::new(), Vec::new());
    for line in lines {
        let (outcome, reason) = match line {
            Line::Outline(row, _) => (row.outcome, row.reason),
            Line::Without(outcome, reason) => (*outcome, *reason),
        };
        outcomes.push(text(outcome));
        reasons.push(text(reason));
    }
    column::<ByteArrayType>(&mut group, outcomes)?;
    column::<ByteArrayType>(&mut group, reasons)?;
    column::<BoolType>(&mut group, rows().map(|row| row.map(|row| row.closed)))?;
    let counts = rows().map(|row| row.and_then(|row| number(row.points.len())));
    column::<Int32Type>(&mut group, counts)?;
    let measures: [fn(&Measures) -> f64; 9] = [
        |m| m.area,
        |m| m.perimeter,
        |m| m.major_axis,
        |m| m.minor_axis,
        |m| m.angle,
        |m| m.circularity,
        |m| m.solidity,
        |m| m.centroid.x,
        |m| m.centroid.y,
    ];
    for of in measures {
        column::<DoubleType>(&mut group, lines.iter().map(|line| line.measure(of)))?;
    }
    for axis in 0..2 {
        let of = |row: &Row<'_>| row.points.iter().map(|p| Some(p[axis])).collect();
        lists::<DoubleType>(&mut group, rows().map(|row| row.map(of)))?;
    }
    for of in [
        |row: &Row<'_>| values(row, row.errors),
        |row: &Row<'_>| values(row, row.strengths),
    ] {
        lists::<FloatType>(&mut group, rows().map(|row| row.map(of)))?;
    }
    let shapes = rows().map(|row| row.map(|row| ByteArray::from(row.geometry())));
    column::<ByteArrayType>(&mut group, shapes)?;
    group.close()?;
    file.into_inner()
}

/// A value for each node, where there is one.
#[allow(
    clippy::cast_possible_truncation,
    reason = "the table has these in float32"
)]
fn values(row: &Row<'_>, values: &[f64]) -> Vec<Option<f32>> {
    let at = |i: usize| values.get(i).copied().filter(|value| !value.is_nan());
    (0..row.points.len())
        .map(|i| at(i).map(|value| value as f32))
        .collect()
}

/// The next column, of one value a row.
fn column<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, Vec<u8>>,
    values: impl IntoIterator<Item = Option<T::T>>,
) -> Result<(), ParquetError> {
    let (mut known, mut levels) = (Vec::new(), Vec::new());
    for value in values {
        levels.push(i16::from(value.is_some()));
        known.extend(value);
    }
    put::<T>(group, &known, &levels, None)
}

/// The next column, of a list a row. Levels as in Parquet: 0 no list, 1 an empty one, 2 no value in it, 3 a value.
fn lists<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, Vec<u8>>,
    rows: impl Iterator<Item = Option<Vec<Option<T::T>>>>,
) -> Result<(), ParquetError> {
    let (mut known, mut levels, mut repeats) = (Vec::new(), Vec::new(), Vec::new());
    for list in rows {
        let list = list.map(|list| (list.is_empty(), list));
        match list {
            None | Some((true, _)) => {
                levels.push(i16::from(list.is_some()));
                repeats.push(0);
            }
            Some((false, list)) => {
                for (index, value) in list.into_iter().enumerate() {
                    levels.push(2 + i16::from(value.is_some()));
                    repeats.push(i16::from(index > 0));
                    known.extend(value);
                }
            }
        }
    }
    put::<T>(group, &known, &levels, Some(&repeats))
}

fn put<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, Vec<u8>>,
    known: &[T::T],
    levels: &[i16],
    repeats: Option<&[i16]>,
) -> Result<(), ParquetError> {
    let next = group.next_column()?;
    let mut column = next.ok_or_else(|| ParquetError::General("has no such column".to_owned()))?;
    column
        .typed::<T>()
        .write_batch(known, Some(levels), repeats)?;
    column.close()
}
