//! Tracks as `GeoJSON`: a feature for each outline of each frame, written as they come.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use serde_json::json;

use super::{TrackContext, Tracked};
use crate::IoError;
use crate::shapes::feature;
use crate::write::{Whole, unwritable};

#[derive(Debug)]
pub(super) struct Features {
    path: PathBuf,
    file: Whole,
    sequence: serde_json::Value,
    count: usize,
}

impl Features {
    pub(super) fn begin(path: &Path, context: &TrackContext) -> Result<Self, IoError> {
        let (width, height) = context.size;
        let mut all = Self {
            path: path.to_owned(),
            file: Whole::begin(path)?,
            sequence: json!({"name": context.name, "width": width, "height": height}),
            count: 0,
        };
        all.put("{\"type\":\"FeatureCollection\",\"features\":[")?;
        Ok(all)
    }

    fn put(&mut self, text: &str) -> Result<(), IoError> {
        let written = self.file.write_all(text.as_bytes());
        written.map_err(|error| unwritable(&self.path, error))
    }

    pub(super) fn frame(
        &mut self,
        frame: usize,
        name: &str,
        tracked: &[&Tracked],
    ) -> Result<(), IoError> {
        for one in tracked {
            let mut shape = one.shape();
            shape.id = Some(format!("{frame}-{}", one.id));
            let name = crate::shapes::Value::Text(name.to_owned());
            shape.properties.insert("frame_name".to_owned(), name);
            let text = feature(self.count + 1, &shape)?.to_string();
            let before = if self.count == 0 { "\n" } else { ",\n" };
            self.put(before)?;
            self.put(&text)?;
            self.count += 1;
        }
        Ok(())
    }

    pub(super) fn end(mut self) -> Result<(), IoError> {
        let tail = format!("\n],\"sequence\":{}}}\n", self.sequence);
        self.put(&tail)?;
        self.file.end()
    }
}
