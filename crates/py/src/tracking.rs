//! Outlines followed through frames.

use std::sync::{Arc, Mutex, PoisonError};

use numpy::{IntoPyArray, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use snakes::Contour;
use snakes::track::{self, Happening, Start, State, Tracked};

use crate::errors::value;
use crate::images::Image;
use crate::options::options;
use crate::points::{array, points};
use crate::waiting::attended;

/// Objects that are followed.
#[pyclass(frozen, module = "pysnakes._core")]
pub(crate) struct Tracker(Arc<Mutex<track::Tracker>>);

#[pymethods]
impl Tracker {
    /// `start`: "chosen", "exact" or "rough"; a start of one point is a click.
    #[new]
    fn new(
        py: Python<'_>,
        frame: &Image,
        starts: Vec<PyReadonlyArray2<'_, f64>>,
        start: &str,
        rules: (u32, usize, bool),
        keywords: &Bound<'_, PyDict>,
    ) -> PyResult<Self> {
        let start = match start {
            "chosen" => Start::Chosen,
            "exact" => Start::Exact,
            "rough" => Start::Rough,
            other => {
                return Err(value(format!(
                    "start_as must be 'chosen', 'exact' or 'rough', got {other:?}"
                )));
            }
        };
        let (patience, threads, births) = rules;
        let rules = track::Options {
            start,
            fit: options(keywords)?,
            patience,
            threads,
            births,
        };
        let starts: PyResult<Vec<Contour>> = starts
            .iter()
            .map(|one| Ok(Contour::closed(points(one)?)))
            .collect();
        let (starts, frame) = (starts?, frame.image.clone());
        let tracker = attended(py, move |_| track::Tracker::new(&frame, &starts, &rules))?;
        Ok(Self(Arc::new(Mutex::new(tracker.map_err(value)?))))
    }

    /// The first frame, as it was taken.
    fn first<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        told(
            py,
            self.0
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .first(),
        )
    }

    /// All objects in the next frame.
    fn next<'py>(&self, py: Python<'py>, frame: &Image) -> PyResult<Bound<'py, PyDict>> {
        let (tracker, frame) = (Arc::clone(&self.0), frame.image.clone());
        let next = move |_: &_| {
            tracker
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .next(&frame)
        };
        told(py, &attended(py, next)?.map_err(value)?)
    }
}

fn told<'py>(py: Python<'py>, tracked: &Tracked) -> PyResult<Bound<'py, PyDict>> {
    let outlines = PyList::empty(py);
    for outline in &tracked.outlines {
        let one = PyDict::new(py);
        one.set_item("id", outline.id)?;
        one.set_item("parent", outline.parent)?;
        one.set_item("points", array(py, &outline.points))?;
        one.set_item("error", outline.errors.clone().into_pyarray(py))?;
        let state = match outline.state {
            State::Seen => "seen",
            State::Partly => "partly",
            State::Coasting => "coasting",
            State::Left => "left",
        };
        one.set_item("state", state)?;
        one.set_item("confidence", outline.confidence)?;
        one.set_item("velocity", (outline.velocity.x, outline.velocity.y))?;
        one.set_item("rotation", outline.rotation)?;
        outlines.append(one)?;
    }
    let events = PyList::empty(py);
    for event in &tracked.events {
        let (what, others) = match &event.what {
            Happening::Begun => ("begun", vec![]),
            Happening::Hidden => ("hidden", vec![]),
            Happening::Found => ("found", vec![]),
            Happening::Left => ("left", vec![]),
            Happening::Lost => ("lost", vec![]),
            Happening::Divided(children) => ("divided", children.to_vec()),
            Happening::Born => ("born", vec![]),
            Happening::Merged(other) => ("merged", vec![*other]),
            Happening::Skipped => ("skipped", vec![]),
            Happening::Remeshed => ("remeshed", vec![]),
            Happening::Mended => ("mended", vec![]),
            _ => ("changed", vec![]),
        };
        events.append((event.id, what, others, event.confidence))?;
    }
    let out = PyDict::new(py);
    out.set_item("frame", tracked.frame)?;
    out.set_item("outlines", outlines)?;
    out.set_item("events", events)?;
    Ok(out)
}
