//! Tracks as `GeoJSON`: a feature for each outline of each frame, written as they come.

use std::path::Path;

use serde_json::json;

use super::growing::Growing;
use super::{TrackContext, Tracked};
use crate::IoError;
use crate::shapes::feature;

const HEAD: &str = "{\"type\":\"FeatureCollection\",\"features\":[";

#[derive(Debug)]
pub(super) struct Features {
    file: Growing,
    count: usize,
}

impl Features {
    pub(super) fn begin(
        path: &Path,
        context: &TrackContext,
        resume: bool,
    ) -> Result<Self, IoError> {
        let (width, height) = context.size;
        let sequence = json!({"name": context.name, "width": width, "height": height});
        let tail = format!("\n],\"sequence\":{sequence}}}\n");
        let file = if resume {
            Growing::resume(path, HEAD, &tail)?
        } else {
            Growing::begin(path, HEAD, &tail)?
        };
        Ok(Self { file, count: 0 })
    }

    pub(super) const fn is_behind(&self) -> bool {
        self.file.is_behind()
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
            self.file.put(&format!("{before}{text}"))?;
            self.count += 1;
        }
        Ok(())
    }

    pub(super) fn end(self) -> Result<(), IoError> {
        self.file.end()
    }

    pub(super) fn discard(self) -> Result<(), IoError> {
        self.file.discard()
    }
}
