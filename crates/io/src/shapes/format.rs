//! Which format a file of outlines is of, and what is asked of its reader and its writer.

use std::path::Path;

use super::json::Json;
use super::table::TableRule;
use super::{Shape, Shapes, coco, cvat, geojson, imagej, labelme, raster, svg, table};
use crate::{IoError, PixelSize};

/// A format of outlines. Of each, the first line says where its origin is: at the center of the
/// first pixel, as inside this program, or at that pixel's outer corner, half a pixel before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// A table of x,y; center. Separated by commas, semicolons, tabs or spaces.
    Csv,
    /// GeoJSON, as `QuPath` and others use it for pixels; corner. Outer rings turn from x to y.
    GeoJson,
    /// COCO JSON; corner. Polygons, or runs of pixels, whose outline goes along their sides.
    Coco,
    /// A ZIP of `ImageJ` ROIs, or one by itself on reading; areas from the corner, lines and points from the center.
    ImageJ,
    /// One `ImageJ` ROI by itself.
    Roi,
    /// The shapes of an SVG in its user units; corner.
    Svg,
    /// labelme JSON; corner.
    Labelme,
    /// CVAT XML for images; corner. Read only.
    Cvat,
    /// A picture of which what is not black is an object: an outline for each connected part.
    Mask,
    /// A picture of whole numbers, one for each object and 0 for none; PNG, up to 65535.
    Labels,
    /// [`Format::Labels`] as a TIFF of 32 bits.
    DeepLabels,
    /// A picture of shares from 0 to 1, or of grey from black to white: the outline is at a half.
    /// Read only.
    Soft,
}

/// Where (0, 0) is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Origin {
    /// The center of the first pixel.
    Center,
    /// The outer corner of the first pixel.
    Corner,
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Column {
    /// By its heading.
    Name(String),
    /// By its number, from 1.
    Number(usize),
}

/// How to read outlines. The default suits a file that says all about itself.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Reading {
    /// The format, if it is not to be told by the file's first bytes.
    pub format: Option<Format>,
    /// Where the origin is, if it is not where the format has it. Pictures have it at the center.
    pub origin: Option<Origin>,
    /// Of a file about several pictures: the one that is meant, by its file name or its id.
    pub picture: Option<String>,
    /// The file name of the picture that outlines are read for: of a file about several pictures, it is taken where
    /// `picture` names none, by its name or else by its name without the ending.
    pub beside: Option<String>,
    /// Width and height of the picture that outlines are read for: a mask, labels and runs of pixels must have them.
    pub size: Option<(usize, usize)>,
    /// The columns of x and of y of a table, if its heading does not say so.
    pub columns: Option<(Column, Column)>,
    /// Whether each point of a table is an outline of its own: a click or a seed.
    pub points: bool,
    /// How far, in pixels, an edge may be from the curve that it stands for; if not given, 0.01.
    pub flatness: Option<f64>,
}

/// What a format may say of the picture that outlines belong to.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Context {
    /// The picture's file name.
    pub picture: Option<String>,
    /// How many pixels it has in a row; needed for COCO, SVG, labelme, masks and labels.
    pub width: usize,
    /// How many rows it has.
    pub height: usize,
    /// How large a pixel is.
    pub pixel: Option<PixelSize>,
}

/// Names of formats, as they are asked for.
const NAMES: [(&str, Format); 12] = [
    ("csv", Format::Csv),
    ("geojson", Format::GeoJson),
    ("coco", Format::Coco),
    ("imagej", Format::ImageJ),
    ("roi", Format::Roi),
    ("svg", Format::Svg),
    ("labelme", Format::Labelme),
    ("cvat", Format::Cvat),
    ("mask", Format::Mask),
    ("labels", Format::Labels),
    ("deep-labels", Format::DeepLabels),
    ("soft", Format::Soft),
];

/// What formats the endings of file names stand for; `.json` may be several.
const ENDINGS: [(&str, Format); 11] = [
    ("csv", Format::Csv),
    ("tsv", Format::Csv),
    ("txt", Format::Csv),
    ("geojson", Format::GeoJson),
    ("roi", Format::Roi),
    ("zip", Format::ImageJ),
    ("svg", Format::Svg),
    ("xml", Format::Cvat),
    ("png", Format::Mask),
    ("tif", Format::DeepLabels),
    ("tiff", Format::DeepLabels),
];

impl Format {
    /// The format of that name: `csv`, `geojson`, `coco`, `imagej`, `roi`, `svg`, `labelme`, `cvat`,
    /// `mask`, `labels`, `deep-labels` or `soft`.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let found = NAMES.iter().find(|(known, _)| *known == name);
        found.map(|(_, format)| *format)
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        let found = NAMES.iter().find(|(_, format)| *format == self);
        found.map_or("csv", |(name, _)| name)
    }

    /// The format that a file of this name is written in; None for an ending that says too little,
    /// as `.json` does.
    #[must_use]
    pub fn by_ending(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_lowercase();
        let found = ENDINGS.iter().find(|(known, _)| *known == ending);
        found.map(|(_, format)| *format)
    }
}

impl Reading {
    /// How far edges may be from curves.
    pub(super) fn flat(&self) -> f64 {
        self.flatness.unwrap_or(0.01).clamp(1e-6, 1e3)
    }

    /// Refuse pixels of another size than the picture's.
    pub(super) fn check_size(&self, width: usize, height: usize) -> Result<(), String> {
        match self.size {
            Some(size) if size != (width, height) => Err(format!(
                "has {width}×{height} pixels and the picture has {}×{}; one of the picture's own size is needed",
                size.0, size.1
            )),
            _ => Ok(()),
        }
    }

    /// Of names of pictures, the one that outlines are read for: the first that is alike but for the folder, or else
    /// the only one that is alike but for the ending too.
    pub(super) fn own<'a>(&self, names: impl Iterator<Item = &'a str> + Clone) -> Option<&'a str> {
        let base = |name: &'a str| name.rsplit(['/', '\\']).next().unwrap_or(name);
        let stem = |name: &'a str| name.rsplit_once('.').map_or(name, |(stem, _)| stem);
        let wanted = self.beside.as_deref()?;
        let found = names.clone().find(|name| base(name) == wanted);
        let wanted = wanted.rsplit_once('.').map_or(wanted, |(stem, _)| stem);
        let mut alike = names.filter(|name| stem(base(name)) == wanted);
        found.or_else(|| alike.next().filter(|_| alike.next().is_none()))
    }
}

/// The kind of a file by its first bytes.
pub(super) enum Kind {
    Picture,
    ImageJ,
    Text,
}

pub(super) fn kind(bytes: &[u8]) -> Kind {
    let pictures: [&[u8]; 12] = [
        b"\x89PNG",
        b"II*\0",
        b"MM\0*",
        b"II+\0",
        b"MM\0+",
        b"\xff\xd8\xff",
        b"P4",
        b"P7\n",
        b"Pf\n",
        b"P5",
        b"P6",
        b"RIFF",
    ];
    if bytes.starts_with(b"Iout")
        || bytes.starts_with(b"PK\x03\x04")
        || bytes.starts_with(b"PK\x05\x06")
    {
        Kind::ImageJ
    } else if pictures.iter().any(|head| bytes.starts_with(head)) {
        Kind::Picture
    } else {
        Kind::Text
    }
}

/// Read outlines from the bytes of a file.
pub(super) fn read(bytes: &[u8], reading: &Reading) -> Result<Shapes, IoError> {
    let Some(format) = reading.format else {
        return told(bytes, reading);
    };
    let text =
        || crate::read::text_of(bytes, wanted(format)).map_err(|what| IoError::text(None, what));
    match format {
        Format::Csv => table::parse_with(text()?, &TableRule::of(reading)?),
        Format::GeoJson => geojson::read(&Json::parse(text()?)?, reading),
        Format::Coco => coco::read(&Json::parse(text()?)?, reading),
        Format::Labelme => labelme::read(&Json::parse(text()?)?, reading),
        Format::Svg => svg::read(text()?, reading),
        Format::Cvat => cvat::read(text()?, reading),
        Format::ImageJ | Format::Roi => imagej::read(bytes, reading),
        Format::Mask | Format::Labels | Format::DeepLabels | Format::Soft => {
            raster::read(bytes, reading).map(|(shapes, _)| shapes)
        }
    }
}

/// Read outlines of a format that the bytes tell.
fn told(bytes: &[u8], reading: &Reading) -> Result<Shapes, IoError> {
    let of = |format: Format| {
        let format = Some(format);
        read(
            bytes,
            &Reading {
                format,
                ..reading.clone()
            },
        )
    };
    match kind(bytes) {
        Kind::Picture => return raster::read(bytes, reading).map(|(shapes, _)| shapes),
        Kind::ImageJ => return of(Format::ImageJ),
        Kind::Text => {}
    }
    let text = crate::read::text_of(bytes, wanted(Format::Csv))
        .map_err(|what| IoError::text(None, what))?;
    match text.trim_start().chars().next() {
        Some('<') if is_svg(text) => of(Format::Svg),
        Some('<') => of(Format::Cvat),
        Some('{' | '[') => {
            let json = Json::parse(text)?;
            match json_format(&json) {
                Some(Format::GeoJson) => geojson::read(&json, reading),
                Some(Format::Labelme) => labelme::read(&json, reading),
                Some(_) => coco::read(&json, reading),
                None => Err(IoError::text(
                    None,
                    "a JSON of no known kind; GeoJSON, COCO or labelme is needed",
                )),
            }
        }
        _ => of(Format::Csv),
    }
}

/// Whether the first element of an XML is that of an SVG.
fn is_svg(text: &str) -> bool {
    // behind a declaration, comments and a document type
    let begin = text.char_indices().filter(|(_, c)| *c == '<').take(100);
    for (at, _) in begin {
        let name = &text[at + 1..];
        if name.starts_with(['?', '!']) {
            continue;
        }
        let word = name
            .split(|c: char| c.is_whitespace() || c == '>' || c == '/')
            .next();
        return word.is_some_and(|word| word == "svg" || word.ends_with(":svg"));
    }
    false
}

fn json_format(json: &Json) -> Option<Format> {
    let has = |json: &Json, key: &str| json.get(key).is_some();
    let kind = |json: &Json| {
        let name = json.get("type").and_then(Json::text);
        name.is_some_and(|name| geojson::TYPES.contains(&name))
    };
    if let Some(first) = json.list().and_then(<[Json]>::first) {
        return if kind(first) {
            Some(Format::GeoJson)
        } else if has(first, "image_id") || has(first, "segmentation") {
            Some(Format::Coco)
        } else {
            None
        };
    }
    if kind(json) {
        Some(Format::GeoJson)
    } else if has(json, "shapes") {
        Some(Format::Labelme)
    } else if has(json, "annotations") || has(json, "images") {
        Some(Format::Coco)
    } else {
        None
    }
}

/// What to say is needed.
const fn wanted(format: Format) -> &'static str {
    match format {
        Format::Csv => "a CSV of x,y",
        Format::GeoJson => "a GeoJSON",
        Format::Coco => "a COCO JSON",
        Format::Labelme => "a labelme JSON",
        Format::Svg => "an SVG",
        Format::Cvat => "an XML of CVAT",
        Format::ImageJ | Format::Roi => "an ImageJ ROI",
        Format::Mask | Format::Labels | Format::DeepLabels | Format::Soft => "a picture",
    }
}

/// Outlines as the bytes of a file.
pub(super) fn write(
    shapes: &[Shape],
    format: Format,
    context: &Context,
) -> Result<Vec<u8>, IoError> {
    let refuse = |message: String| super::budget::cannot(format.name(), message);
    for (number, shape) in (1..).zip(shapes) {
        let points = shape.rings.iter().flatten();
        if shape.rings.iter().any(Vec::is_empty) || shape.rings.is_empty() {
            return Err(refuse(format!(
                "outline {number} has a ring without points; one at least is needed"
            )));
        }
        for p in points {
            super::budget::point(p.x, p.y)
                .map_err(|what| refuse(format!("outline {number}: {what}")))?;
        }
    }
    let sized = matches!(
        format,
        Format::Coco
            | Format::Svg
            | Format::Labelme
            | Format::Mask
            | Format::Labels
            | Format::DeepLabels
    );
    if sized {
        let pixels = (context.width as u64).saturating_mul(context.height as u64);
        if pixels == 0 || pixels > crate::limits::MOST_WHOLE {
            return Err(refuse(format!(
                "the picture has {}×{} pixels; its size is needed, of 1 to {} pixels",
                context.width,
                context.height,
                crate::limits::MOST_WHOLE
            )));
        }
    }
    match format {
        Format::Csv => Ok(table::to_text(shapes, &[]).into_bytes()),
        Format::GeoJson => geojson::write(shapes, context),
        Format::Coco => coco::write(shapes, context),
        Format::ImageJ => imagej::write(shapes),
        Format::Roi => imagej::write_one(shapes),
        Format::Svg => svg::write(shapes, context),
        Format::Labelme => labelme::write(shapes, context),
        Format::Mask | Format::Labels | Format::DeepLabels => {
            raster::write(shapes, format, context)
        }
        Format::Cvat | Format::Soft => {
            Err(refuse("is read only; another format is needed".to_owned()))
        }
    }
}
