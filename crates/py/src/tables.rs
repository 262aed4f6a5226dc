//! Outlines as rows of a table that other programs read.

use std::path::{Path, PathBuf};

use numpy::PyReadonlyArray2;
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use store::{Results, Row, StoreError};

use crate::points::points;

/// A folder of results.
#[pyclass(frozen, module = "pysnakes._core")]
pub(crate) struct Store(Results);

/// An outline: points, whether it is closed and an outline, outcome, reason, errors and strengths.
type Given<'py> = (
    PyReadonlyArray2<'py, f64>,
    bool,
    bool,
    String,
    String,
    Vec<f64>,
    Vec<f64>,
);

#[pymethods]
impl Store {
    #[new]
    fn new(py: Python<'_>, folder: PathBuf) -> PyResult<Self> {
        let opened = py.detach(|| Results::open(&folder));
        opened.map(Self).map_err(raised)
    }

    /// Whether what an image gave is there.
    fn is_finished(&self, image: &str) -> bool {
        self.0.is_finished(image)
    }

    /// Where what an image gave is written.
    fn part(&self, image: &str) -> PathBuf {
        self.0.part(image)
    }

    /// Write what an image gave; returns where.
    fn write(&self, py: Python<'_>, image: &str, outlines: Vec<Given<'_>>) -> PyResult<PathBuf> {
        let mut nodes = Vec::with_capacity(outlines.len());
        for outline in &outlines {
            nodes.push(points(&outline.0)?);
        }
        let rows: Vec<Row<'_>> = outlines
            .iter()
            .zip(&nodes)
            .map(
                |((_, closed, is_outline, outcome, reason, errors, strengths), points)| Row {
                    points,
                    closed: *closed,
                    is_outline: *is_outline,
                    outcome,
                    reason,
                    errors,
                    strengths,
                },
            )
            .collect();
        py.detach(|| self.0.write(image, &rows)).map_err(raised)
    }

    /// Write that an image was refused, and why; returns where.
    fn refuse(&self, py: Python<'_>, image: &str, reason: &str) -> PyResult<PathBuf> {
        py.detach(|| self.0.refuse(image, reason)).map_err(raised)
    }
}

/// A file that cannot be written is an `OSError`, one that is no table a `ValueError`.
#[allow(
    clippy::needless_pass_by_value,
    reason = "errors are mapped as they come"
)]
fn raised(error: StoreError) -> PyErr {
    match error {
        StoreError::Io(error) => PyOSError::new_err(error.to_string()),
        other => PyValueError::new_err(other.to_string()),
    }
}

/// The name that a file has in the table.
#[pyfunction]
pub(crate) fn image_name(path: PathBuf) -> String {
    store::name_of(Path::new(&path))
}
