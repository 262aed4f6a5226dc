//! Tracks as a video of `YouTube-VIS`, COCO's format with a list of runs of pixels for each object.
//!
//! Where an object has no pixel, its entry is `null`. The lists of an object stand together in the file, so what is
//! written of all objects is kept as text until the end.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use serde_json::json;

use super::{TrackContext, Tracked};
use crate::IoError;
use crate::shapes::{Budget, boxed, of_columns};
use crate::write::{Whole, unwritable};

#[derive(Debug)]
pub(super) struct Video {
    path: PathBuf,
    file: Whole,
    context: TrackContext,
    names: Vec<String>,
    objects: BTreeMap<u32, Object>,
}

/// The lists of an object, as text.
#[derive(Debug, Default)]
struct Object {
    frames: usize,
    runs: String,
    boxes: String,
    areas: String,
    parent: Option<u32>,
    /// Sum and number of what is known of its confidence.
    sure: (f64, f64),
}

impl Object {
    /// Entries up to that frame for where it has no pixel.
    fn skip(&mut self, frame: usize) {
        while self.frames < frame {
            self.add("null", "null", "null");
        }
    }

    fn add(&mut self, runs: &str, corner: &str, area: &str) {
        let comma = if self.frames == 0 { "" } else { "," };
        for (list, entry) in [
            (&mut self.runs, runs),
            (&mut self.boxes, corner),
            (&mut self.areas, area),
        ] {
            list.push_str(comma);
            list.push_str(entry);
        }
        self.frames += 1;
    }
}

impl Video {
    pub(super) fn begin(path: &Path, context: &TrackContext) -> Result<Self, IoError> {
        Ok(Self {
            path: path.to_owned(),
            file: Whole::begin(path)?,
            context: context.clone(),
            names: Vec::new(),
            objects: BTreeMap::new(),
        })
    }

    pub(super) fn frame(
        &mut self,
        frame: usize,
        name: &str,
        tracked: &[&Tracked],
    ) -> Result<(), IoError> {
        // frames that nothing was said of
        self.names.resize(frame, String::new());
        self.names.push(name.to_owned());
        let (width, height) = self.context.size;
        let mut budget = Budget::default();
        for one in tracked {
            let refuse = |what: String| {
                IoError::file(
                    &self.path,
                    format!("frame {frame}, object {} {what}", one.id),
                )
            };
            let part = boxed(&one.shape(), [width, height], &mut budget).map_err(refuse)?;
            let Some(part) = part else { continue };
            let object = self.objects.entry(one.id).or_default();
            object.parent = object.parent.or(one.parent);
            if let Some(sure) = one.confidence {
                object.sure = (object.sure.0 + sure, object.sure.1 + 1.0);
            }
            object.skip(frame);
            let runs = of_columns(&part, [width, height]);
            let inside: usize = runs.iter().skip(1).step_by(2).sum();
            let rows = part.mask.len() / part.width.max(1);
            let mut text = format!("{{\"size\":[{height},{width}],\"counts\":[");
            for (at, run) in runs.iter().enumerate() {
                // writing to a String cannot fail
                let _ = write!(text, "{}{run}", if at == 0 { "" } else { "," });
            }
            text.push_str("]}");
            let corner = format!("[{},{},{},{rows}]", part.left, part.top, part.width);
            object.add(&text, &corner, &inside.to_string());
        }
        Ok(())
    }

    pub(super) fn end(mut self) -> Result<(), IoError> {
        let (width, height) = self.context.size;
        let frames = self.names.len();
        let video = json!({
            "id": 1, "name": self.context.name, "width": width, "height": height, "length": frames,
            "file_names": self.names,
        });
        let category = json!({"id": 1, "name": self.context.label.as_deref().unwrap_or("object")});
        let head = format!("{{\"videos\":[{video}],\"categories\":[{category}],\"annotations\":[");
        let mut put = |text: &str| {
            let written = self.file.write_all(text.as_bytes());
            written.map_err(|error| unwritable(&self.path, error))
        };
        put(&head)?;
        let mut before = "\n";
        for (id, mut object) in self.objects {
            object.skip(frames);
            let parent = object
                .parent
                .map_or_else(|| "null".to_owned(), |parent| parent.to_string());
            let (sum, count) = object.sure;
            let score = if count > 0.0 {
                format!(",\"score\":{}", sum / count)
            } else {
                String::new()
            };
            put(&format!(
                "{before}{{\"id\":{id},\"video_id\":1,\"category_id\":1,\"iscrowd\":0,\"width\":{width},\
                 \"height\":{height},\"length\":{frames},\"parent\":{parent}{score},"
            ))?;
            for (name, list) in [
                ("segmentations", &object.runs),
                ("bboxes", &object.boxes),
                ("areas", &object.areas),
            ] {
                put(&format!("\"{name}\":["))?;
                put(list)?;
                put(if name == "areas" { "]}" } else { "]," })?;
            }
            before = ",\n";
        }
        put("\n]}\n")?;
        self.file.end()
    }
}
