//! Fits: one, or many on several threads.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use fit::{Evidence, in_order};
use numpy::{IntoPyArray, PyReadonlyArray2};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use snakes::{Contour, Fit, FitError};

use crate::errors::value;
use crate::images::Image;
use crate::options::options;
use crate::points::{array, or_nan, points};
use crate::waiting::{attended, guarded};

/// An image made ready for fits.
#[pyclass(frozen, module = "pysnakes._core")]
pub(crate) struct Prepared(snakes::Prepared);

#[pymethods]
impl Prepared {
    #[new]
    fn new(py: Python<'_>, image: &Image, keywords: &Bound<'_, PyDict>) -> PyResult<Self> {
        let (options, image) = (options(keywords)?, image.image.clone());
        let made = attended(py, move |_| snakes::Prepared::of(&image, &options))?;
        made.map(Self).map_err(value)
    }

    /// What was found from this start, as a dictionary.
    fn fit<'py>(
        &self,
        py: Python<'py>,
        start: PyReadonlyArray2<'py, f64>,
        closed: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        let start = Contour {
            points: points(&start)?,
            closed,
        };
        let prepared = self.0.clone();
        let found = attended(py, move |stop| fit(&prepared, &start, stop))?;
        // it ends early only where the user has asked for it
        let found = found.map_err(value)?;
        told(py, &found.ok_or_else(|| PyKeyboardInterrupt::new_err(()))?)
    }
}

/// A fit that ends early once it is asked to; None then.
fn fit(
    prepared: &snakes::Prepared,
    start: &Contour,
    stop: &AtomicBool,
) -> Result<Option<Fit>, FitError> {
    prepared.fit_unless(start, &|| stop.load(Ordering::Relaxed))
}

/// What a fit has found.
fn told<'py>(py: Python<'py>, fit: &Fit) -> PyResult<Bound<'py, PyDict>> {
    let out = PyDict::new(py);
    let quality = fit.quality.as_ref();
    out.set_item("points", array(py, &fit.contour.points))?;
    out.set_item("closed", fit.contour.closed)?;
    let nodes = &fit.nodes;
    let numbers = |values: Vec<f64>| values.into_pyarray(py);
    out.set_item(
        "strength",
        numbers(nodes.iter().map(|node| node.strength).collect()),
    )?;
    out.set_item(
        "slope",
        numbers(nodes.iter().map(|node| node.slope).collect()),
    )?;
    out.set_item(
        "error",
        numbers(or_nan(nodes.iter().map(|node| node.error))),
    )?;
    out.set_item(
        "offset",
        numbers(or_nan(nodes.iter().map(|node| node.offset))),
    )?;
    let normals: Vec<_> = nodes.iter().map(|node| node.normal).collect();
    out.set_item("normal", array(py, &normals))?;
    let held: Vec<bool> = nodes.iter().map(|node| node.held).collect();
    out.set_item("held", held.into_pyarray(py))?;
    out.set_item("outcome", fit.outcome.name())?;
    let objection = quality.and_then(Evidence::objection);
    let reason = objection.unwrap_or_else(|| fit.outcome.to_string());
    out.set_item("reason", reason)?;
    out.set_item("note", quality.and_then(Evidence::note))?;
    out.set_item("is_outline", fit.is_outline())?;
    out.set_item("held_share", quality.map(|quality| quality.held))?;
    out.set_item("crossings", quality.map(|quality| quality.crossings))?;
    out.set_item("steps", fit.steps)?;
    out.set_item("explanation", fit.chosen.to_string())?;
    Ok(out)
}

/// What was found, or the words of a refusal.
type Told<'py> = (Option<Bound<'py, PyDict>>, Option<String>);

type Answer = PyResult<Option<Result<Fit, FitError>>>;

/// Many fits on several threads; answers come in the order of the starts, as soon as they are there.
#[pyclass(frozen, module = "pysnakes._core")]
pub(crate) struct Batch {
    answers: Mutex<Receiver<Answer>>,
    stop: Arc<AtomicBool>,
}

impl Drop for Batch {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

#[pymethods]
impl Batch {
    /// `which`: the image of each start.
    #[new]
    fn new(
        images: Vec<Py<Image>>,
        which: Vec<usize>,
        starts: Vec<PyReadonlyArray2<'_, f64>>,
        closed: bool,
        keywords: &Bound<'_, PyDict>,
        threads: usize,
    ) -> PyResult<Self> {
        let options = options(keywords)?;
        let images: Vec<snakes::Image> = images
            .iter()
            .map(|image| image.get().image.clone())
            .collect();
        let mut jobs = Vec::with_capacity(starts.len());
        for (start, image) in starts.iter().zip(which) {
            jobs.push((
                image,
                Contour {
                    points: points(start)?,
                    closed,
                },
            ));
        }
        // an image that has one start is made ready by the thread that fits it, one with several once for all
        let mut uses = vec![0_usize; images.len()];
        jobs.iter().for_each(|(image, _)| uses[*image] += 1);
        let stop = Arc::new(AtomicBool::new(false));
        let (send, answers) = mpsc::channel();
        let told = Arc::clone(&stop);
        let work = move || {
            let prepare = |(image, uses): (&snakes::Image, &usize)| {
                (*uses > 1).then(|| guarded(|| snakes::Prepared::of(image, &options)))
            };
            let shared: Vec<_> = images.iter().zip(&uses).map(prepare).collect();
            let work = |(image, start): &(usize, Contour)| -> Answer {
                if told.load(Ordering::Relaxed) {
                    return Ok(None);
                }
                let prepared = match &shared[*image] {
                    Some(Ok(prepared)) => prepared.clone(),
                    Some(Err(panic)) => return Err(Python::attach(|py| panic.clone_ref(py))),
                    None => guarded(|| snakes::Prepared::of(&images[*image], &options))?,
                };
                let fit = |prepared: snakes::Prepared| fit(&prepared, start, &told);
                guarded(|| prepared.and_then(fit).transpose())
            };
            in_order(&jobs, threads, work, |_, answer| {
                let _ = send.send(answer); // nobody may want it any more
            });
        };
        std::thread::Builder::new()
            .name("pysnakes".to_owned())
            .spawn(work)?;
        let answers = Mutex::new(answers);
        Ok(Self { answers, stop })
    }

    const fn __iter__(this: PyRef<'_, Self>) -> PyRef<'_, Self> {
        this
    }

    /// The next answer: what was found, or the words of a refusal.
    fn __next__<'py>(&self, py: Python<'py>) -> PyResult<Option<Told<'py>>> {
        let answer = loop {
            let waited = py.detach(|| {
                let answers = self.answers.lock().unwrap_or_else(PoisonError::into_inner);
                answers.recv_timeout(Duration::from_millis(20))
            });
            match waited {
                Ok(answer) => break answer?,
                Err(RecvTimeoutError::Disconnected) => return Ok(None),
                Err(RecvTimeoutError::Timeout) => {
                    if let Err(asked) = py.check_signals() {
                        self.stop.store(true, Ordering::Relaxed);
                        return Err(asked);
                    }
                }
            }
        };
        match answer {
            None => Ok(None),
            Some(Ok(fit)) => Ok(Some((Some(told(py, &fit)?), None))),
            Some(Err(error)) => Ok(Some((None, Some(error.to_string())))),
        }
    }
}
