//! A scene as files: its curves now, and its text.

use io::shapes::{self, Context, Format, Shape};

use super::Sandbox;
use crate::LiveError;

/// Formats of a scene: name, ending, and for people.
pub(crate) const FORMATS: [(&str, &str, &str); 3] = [
    ("csv", ".csv", "CSV: the nodes of all snakes now"),
    ("geojson", ".geojson", "GeoJSON: the same"),
    ("scene", ".toml", "Scene: its text as it was opened"),
];

impl Sandbox {
    /// What files of it are called.
    pub(crate) fn name(&self) -> &str {
        if self.scene.name.is_empty() {
            "scene"
        } else {
            &self.scene.name
        }
    }

    /// The scene as a file of that format: its name and bytes.
    pub(crate) fn export(&self, format: &str) -> Result<(String, Vec<u8>), LiveError> {
        let Some((name, ending, _)) = FORMATS.iter().find(|(name, _, _)| *name == format) else {
            let names = FORMATS.map(|(name, _, _)| name).join(", ");
            return Err(LiveError::new(format!(
                "a format must be one of {names}, session, got {format}"
            )));
        };
        let bytes = match Format::named(name) {
            Some(format) => {
                let written = shapes::write(&self.shapes(), format, &Context::default());
                written.map_err(LiveError::of)?
            }
            None => self.source().as_bytes().to_vec(),
        };
        let stem = self.name();
        Ok((format!("{stem}{ending}"), bytes))
    }

    /// The curves of all snakes now.
    pub(crate) fn shapes(&self) -> Vec<Shape> {
        let members = self.simulation().members().iter();
        let shapes = members.map(|member| {
            let mut shape = Shape::curve(member.state().x.clone(), Some(member.is_closed()));
            shape.id = Some(member.id().to_string());
            shape
        });
        shapes.collect()
    }
}
