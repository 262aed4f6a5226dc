//! Outlines as files, in every format that can be written.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use io::paint;
use io::shapes::{self, Context, Format, NodeColumn, Shape, Value};
use score::table::{SHAPE_HEADINGS, UNIT_HEADINGS, number, quoted, shape_columns, unit_columns};

use super::{One, Pictures};
use crate::LiveError;

/// Formats of outlines: name, ending, and for people.
pub(crate) const FORMATS: [(&str, &str, &str); 12] = [
    (
        "csv",
        ".csv",
        "CSV: x and y of each node, with error and edge; 0,0 is the middle of the first pixel",
    ),
    ("geojson", ".geojson", "GeoJSON: QuPath, QGIS"),
    ("imagej", ".zip", "ImageJ: ROIs in a ZIP"),
    ("svg", ".svg", "SVG: drawing programs"),
    ("coco", "_coco.json", "COCO: training of networks"),
    ("labelme", "_labelme.json", "labelme"),
    ("mask", "_mask.png", "Mask: white inside"),
    ("labels", "_labels.png", "Labels: a number for each outline"),
    ("deep-labels", "_labels.tif", "Labels of 32 bits, TIFF"),
    (
        "measures",
        "_measures.csv",
        "Measures: area, perimeter, center, ...",
    ),
    ("overlay", "_overlay.png", "The picture with the outlines"),
    (
        "tracks",
        "_tracks.csv",
        "All frames: frame from 0, id, x, y",
    ),
];

impl Pictures {
    /// Outlines as a file of that format: its name and bytes.
    pub(crate) fn export(&self, format: &str) -> Result<(String, Vec<u8>), LiveError> {
        let found = FORMATS.iter().find(|(name, _, _)| *name == format);
        let Some((_, ending, _)) = found else {
            let names: Vec<&str> = FORMATS.iter().map(|(name, _, _)| *name).collect();
            return Err(LiveError::new(format!(
                "a format must be one of {}, got {format}",
                names.join(", ")
            )));
        };
        let stem = stem_of(&self.frames[self.now].name);
        let bytes = match format {
            "measures" => self.measures().into_bytes(),
            "overlay" => self.overlay()?,
            "tracks" => self.tracks().into_bytes(),
            "csv" => self.table().into_bytes(),
            _ => {
                let Some(format) = Format::named(format) else {
                    return Err(LiveError::new(format!("{format} cannot be written")));
                };
                shapes::write(&self.shapes(), format, &self.context()).map_err(LiveError::of)?
            }
        };
        Ok((format!("{stem}{ending}"), bytes))
    }

    /// What the first frame is called, without the ending.
    pub(crate) fn name_of_first(&self) -> &str {
        stem_of(&self.frames[0].name)
    }

    /// What formats may say of the picture.
    pub(crate) fn context(&self) -> Context {
        let (width, height) = self.picture.size();
        Context {
            picture: Some(self.frames[self.now].name.to_string()),
            width,
            height,
            pixel: self.picture.pixel_size().cloned(),
        }
    }

    /// The outlines of this frame.
    pub(crate) fn shapes(&self) -> Vec<Shape> {
        let shapes = self.outlines.iter().map(|(id, one)| {
            let mut shape = Shape::curve(one.points.clone(), Some(one.closed));
            shape.id = Some(id.to_string());
            // what programs sort by is the class, where there is one
            shape.label = Some(if one.class.is_empty() {
                one.label.clone()
            } else {
                one.class.clone()
            });
            let mut note = |name: &str, value| shape.properties.insert(name.to_owned(), value);
            note("name", Value::Text(one.label.clone()));
            note("class", Value::Text(one.class.clone()));
            note("sure", Value::Bool(one.sure));
            note("outcome", Value::Text(one.words.clone()));
            if let Some(error) = one.mean_error() {
                note("error", Value::Number(error));
            }
            shape
        });
        shapes.collect()
    }

    /// Nodes with what was measured of each.
    fn table(&self) -> String {
        let full = |values: Vec<Option<f64>>, one: &One| {
            if values.len() == one.points.len() {
                values
            } else {
                vec![None; one.points.len()]
            }
        };
        let errors: Vec<_> = self
            .outlines
            .values()
            .map(|one| full(one.error.clone(), one))
            .collect();
        let edges: Vec<_> = self
            .outlines
            .values()
            .map(|one| full(one.strength.iter().map(|s| Some(*s)).collect(), one))
            .collect();
        let columns = [
            NodeColumn {
                name: "error",
                values: &errors,
            },
            NodeColumn {
                name: "edge",
                values: &edges,
            },
        ];
        shapes::to_text_with(&self.shapes(), &columns)
    }

    /// A table of measures, in the columns of `snake fit --measure` as far as they are known here.
    fn measures(&self) -> String {
        let mut out = format!(
            "picture,outline,label,class,outcome,{SHAPE_HEADINGS},standard_error_px,{UNIT_HEADINGS}\n"
        );
        let pixel = self.picture.pixel_size();
        let pixel = pixel.map(|pixel| (pixel.x, pixel.y, &*pixel.unit));
        for (id, one) in &self.outlines {
            let rings = [one.points.clone()];
            let ended = if one.sure { "found" } else { "unsure" };
            let mut row = vec![
                quoted(&self.frames[self.now].name),
                id.to_string(),
                quoted(&one.label),
                quoted(&one.class),
                ended.to_owned(),
            ];
            row.extend(shape_columns(&rings, one.closed, self.picture.levels()));
            row.push(number(one.mean_error()));
            row.extend(unit_columns(&rings, one.closed, pixel));
            out.push_str(&row.join(","));
            out.push('\n');
        }
        out
    }

    /// The picture with all outlines over it.
    fn overlay(&self) -> Result<Vec<u8>, LiveError> {
        let curves: Vec<_> = self
            .outlines
            .iter()
            .map(|(id, one)| (&one.points[..], one.closed, paint::color_of(*id)))
            .collect();
        paint::png(&paint::overlay(&self.picture, &curves)).map_err(LiveError::of)
    }

    /// All frames that have outlines, as a table.
    fn tracks(&self) -> String {
        let mut out = "frame,id,x,y\n".to_owned();
        let mut frames: Vec<(usize, &BTreeMap<u32, Arc<One>>)> = self
            .others
            .iter()
            .map(|(frame, outlines)| (*frame, &**outlines))
            .collect();
        frames.push((self.now, &self.outlines));
        frames.sort_by_key(|(frame, _)| *frame);
        for (frame, outlines) in frames {
            for (id, one) in outlines {
                for p in &one.points {
                    out.push_str(&format!("{frame},{id},{:.4},{:.4}\n", p.x, p.y));
                }
            }
        }
        out
    }
}

/// A name without its ending.
fn stem_of(name: &str) -> &str {
    let stem = Path::new(name).file_stem().and_then(|stem| stem.to_str());
    stem.unwrap_or("picture")
}
