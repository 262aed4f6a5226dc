//! Scenes: situations as text, run with someone watching.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use numpy::{IntoPyArray, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use scene::{Record, SceneText};
use snakes::io::Picture;

use crate::errors::value;
use crate::motion::{Simulation, certified};
use crate::points::array;
use crate::waiting::{attended, guarded};

/// A scene as text, and whether it has been changed.
#[pyclass(frozen, module = "pysnakes._core")]
pub(crate) struct Scene(SceneText, bool);

#[pymethods]
impl Scene {
    /// A scene that comes with the program by its name, one of a file, or one of a text whose files are in a folder.
    #[new]
    fn new(kind: &str, from: &str, folder: PathBuf, name: &str) -> PyResult<Self> {
        let text = match kind {
            "named" => SceneText::named(from),
            "file" => SceneText::load(&PathBuf::from(from)),
            _ => SceneText::parse(name, from, &folder),
        };
        let text = text.map_err(value)?;
        text.scene().map_err(value)?; // what it says must mean something
        Ok(Self(text, false))
    }

    /// The text: as it was read, or as it is with other values.
    #[getter]
    fn source(&self) -> String {
        if self.1 {
            self.0.to_string()
        } else {
            self.0.source().to_owned()
        }
    }

    /// Its name and its title.
    #[getter]
    fn titles(&self) -> PyResult<(String, String)> {
        let scene = self.0.scene().map_err(value)?;
        Ok((scene.name, scene.title))
    }

    /// The same scene with other values of some keys.
    fn with_values(&self, values: Vec<(String, String)>) -> PyResult<Self> {
        let mut text = self.0.clone();
        for (key, new) in &values {
            text.set(key, new).map_err(value)?;
        }
        text.scene().map_err(value)?;
        Ok(Self(text, true))
    }

    /// Everything that moves, at its start.
    fn simulation(&self, py: Python<'_>) -> PyResult<Simulation> {
        let text = self.0.clone();
        let made = attended(py, move |_| {
            text.scene().and_then(|scene| scene.simulation())
        })?;
        made.map(Simulation::of).map_err(value)
    }

    /// What its parameters say of its motion.
    fn certificate<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let text = self.0.clone();
        let made = attended(py, move |_| {
            let scene = text.scene()?;
            Ok::<_, scene::SceneError>(snakes::snake::Certificate::of(&scene.of_the_run(), None))
        })?;
        certified(py, &made.map_err(value)?)
    }

    /// Run it. After every so many steps `observer` is called with the time, the steps made and the nodes of the
    /// first curve; it ends the run by returning False.
    fn run<'py>(
        &self,
        py: Python<'py>,
        observer: Option<Py<PyAny>>,
        every: u64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let scene = self.0.scene().map_err(value)?;
        let (mut raised, mut asked) = (None, Instant::now());
        let record = py.detach(|| {
            guarded(|| {
                scene.run(&mut |state| {
                    let due = observer
                        .as_ref()
                        .filter(|_| state.step.is_multiple_of(every));
                    if due.is_none() && asked.elapsed() < Duration::from_millis(20) {
                        return ControlFlow::Continue(());
                    }
                    let shown = Python::attach(|py| {
                        py.check_signals()?;
                        asked = Instant::now();
                        let Some(observer) = due else { return Ok(true) };
                        let answer =
                            observer.call1(py, (state.t, state.step, array(py, &state.x)))?;
                        answer
                            .extract::<Option<bool>>(py)
                            .map(|go_on| go_on != Some(false))
                            .or(Ok(true))
                    });
                    match shown {
                        Ok(true) => ControlFlow::Continue(()),
                        Ok(false) => ControlFlow::Break(()),
                        Err(error) => {
                            raised = Some(error);
                            ControlFlow::Break(())
                        }
                    }
                })
            })
        })?;
        if let Some(error) = raised {
            return Err(error);
        }
        told(py, &record.map_err(value)?)
    }
}

/// What a run leaves behind.
fn told<'py>(py: Python<'py>, record: &Record) -> PyResult<Bound<'py, PyDict>> {
    let frames = PyList::empty(py);
    for frame in &record.frames {
        let curves = PyList::empty(py);
        for curve in &frame.curves {
            let velocities = curve
                .velocities
                .as_ref()
                .map(|velocities| array(py, velocities));
            curves.append((curve.id, curve.closed, array(py, &curve.nodes), velocities))?;
        }
        let energies = frame.energies.as_ref().map(|energies| energies.values());
        frames.append((frame.step, frame.t, curves, energies))?;
    }
    let out = PyDict::new(py);
    out.set_item("scene", &record.scene)?;
    out.set_item("title", &record.title)?;
    out.set_item("scheme", &record.scheme)?;
    out.set_item("dt", record.dt)?;
    out.set_item("terms", record.terms.clone())?;
    out.set_item("frames", frames)?;
    out.set_item("events", record.events.clone())?;
    out.set_item("outcome", record.outcome.name())?;
    out.set_item("reason", record.outcome.to_string())?;
    Ok(out)
}

/// The scenes that come with the program.
#[pyfunction]
pub(crate) fn scene_names() -> Vec<&'static str> {
    scene::SCENES.iter().map(|(name, _)| *name).collect()
}

/// A picture that comes with the program, as an array.
#[pyfunction]
pub(crate) fn picture<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    pixels(py, &scene::picture(name).map_err(value)?)
}

/// A picture of a file, as an array.
#[pyfunction]
pub(crate) fn load_picture(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyAny>> {
    let picture = attended(py, move |_| Picture::load(&path))?.map_err(value)?;
    pixels(py, &picture)
}

/// Grey levels in float64, or three bytes a pixel where it has colors.
fn pixels<'py>(py: Python<'py>, picture: &Picture) -> PyResult<Bound<'py, PyAny>> {
    if !picture.is_color() {
        let levels = picture.levels();
        let bytes = levels
            .iter()
            .all(|level| (level - level.round()).abs() <= 0.0 && (0.0..=255.0).contains(level));
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "whole numbers from 0 to 255"
        )]
        return Ok(if bytes {
            levels.mapv(|level| level as u8).into_pyarray(py).into_any()
        } else {
            levels.clone().into_pyarray(py).into_any()
        });
    }
    let shown = picture.display();
    let (width, height) = picture.size();
    let bytes = ndarray::Array3::from_shape_vec((height, width, 3), shown.as_raw().clone())
        .map_err(value)?;
    let array: Bound<'_, PyArrayDyn<u8>> = bytes.into_dyn().into_pyarray(py);
    Ok(array.into_any())
}

/// A contour that comes with the program.
#[pyfunction]
pub(crate) fn contour<'py>(
    py: Python<'py>,
    name: &str,
) -> PyResult<Bound<'py, numpy::PyArray2<f64>>> {
    Ok(array(py, scene::contour(name).map_err(value)?.first()))
}
