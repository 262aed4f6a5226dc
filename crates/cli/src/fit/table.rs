//! `--as parquet`: outlines as rows of the table that pysnakes has too.

use std::path::Path;

use scene::SceneError;
use store::{Results, Row, StoreError};

use super::flags::Flags;
use super::one::Found;
use crate::commands::key;

/// The name of the format.
pub(super) const FORMAT: &str = "parquet";

/// The table in a folder, if it is asked for.
pub(super) fn of(flags: &Flags, folder: &Path) -> Result<Option<Results>, SceneError> {
    let wanted = flags.formats.iter().any(|name| name == FORMAT);
    let open = || Results::open(folder).map_err(|error| refused(&error));
    wanted.then(open).transpose()
}

pub(super) fn refused(error: &StoreError) -> SceneError {
    key("--as parquet", error)
}

/// What a picture gave, as a file of the table.
pub(super) fn part(name: &Path, found: &[Found]) -> Result<Vec<u8>, SceneError> {
    let owned: Vec<Known<'_>> = found.iter().filter_map(Known::of).collect();
    let rows: Vec<Row<'_>> = owned.iter().map(Known::row).collect();
    let bytes = store::written(&store::name_of(name), &rows);
    bytes.map_err(|error| key("--as parquet", error))
}

/// What is known of an outline, as its row needs it.
struct Known<'a> {
    found: &'a Found,
    reason: String,
    errors: Vec<f64>,
    strengths: Vec<f64>,
}

impl<'a> Known<'a> {
    /// None where there is no outline to write.
    fn of(found: &'a Found) -> Option<Self> {
        let shape = found.shape.as_ref()?;
        let nodes = found.fit.as_ref().map_or(&[][..], |fit| &fit.nodes[..]);
        // a border in common with a neighbor has nodes of its own, of which nothing is known
        let moved = found
            .fit
            .as_ref()
            .is_some_and(|fit| fit.contour.points != shape.first());
        let nodes = if moved { &[] } else { nodes };
        let settled = || {
            let fit = found.fit.as_ref();
            let objection = fit.and_then(|fit| fit.quality.as_ref()?.objection());
            objection.or_else(|| fit.map(|fit| fit.outcome.to_string()))
        };
        let reason = found.unsure.clone().or_else(settled);
        Some(Self {
            found,
            reason: reason.unwrap_or_else(|| "found among many".to_owned()),
            errors: nodes
                .iter()
                .map(|node| node.error.unwrap_or(f64::NAN))
                .collect(),
            strengths: nodes.iter().map(|node| node.strength).collect(),
        })
    }

    fn row(&self) -> Row<'_> {
        let shape = self.found.shape.as_ref();
        Row {
            points: shape.map_or(&[], |shape| shape.first()),
            closed: shape.is_some_and(|shape| shape.closed == Some(true)),
            is_outline: self.found.unsure.is_none(),
            outcome: self
                .found
                .fit
                .as_ref()
                .map_or("found", |fit| fit.outcome.name()),
            reason: &self.reason,
            errors: &self.errors,
            strengths: &self.strengths,
        }
    }
}
