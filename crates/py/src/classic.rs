//! `active_contour`, as others have it.

use std::sync::atomic::Ordering;

use classic::{Ends, Picture, Rules, Settled, Stop, settle};
use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

use crate::errors::value;
use crate::images::{Sample, with_samples};
use crate::points::{array, points};
use crate::waiting::attended;

type Found<'py> = (Bound<'py, PyArray2<f64>>, &'static str, u64, usize, bool);

/// Points (x, y), how it ended, steps, points between, whether it has collapsed. `numbers`: α, β, weights of levels and
/// edges, γ, the longest way, the most steps, the convergence; `unit`: the level of a pixel of 1.
#[pyfunction]
pub(crate) fn active_contour<'py>(
    image: &Bound<'py, PyAny>,
    snake: PyReadonlyArray2<'py, f64>,
    numbers: [f64; 7],
    max_num_iter: u64,
    ends: &str,
    unit: f64,
) -> PyResult<Found<'py>> {
    let py = image.py();
    let start = points(&snake)?;
    let [alpha, beta, w_line, w_edge, gamma, max_px_move, convergence] = numbers;
    let rules = Rules {
        alpha,
        beta,
        w_line,
        w_edge,
        gamma,
        max_px_move,
        max_num_iter,
        convergence,
        ends: Ends::named(ends)
            .ok_or_else(|| value(format!("boundary_condition: unknown, got {ends:?}")))?,
    };
    with_samples!(image, |view, owner| {
        let settled = attended(py, move |stop| {
            let (height, width, channels) = view.dim();
            let level = |row: usize, column: usize, channel: usize| {
                unit * view[[row, column, channel]].number()
            };
            let picture = Picture {
                height,
                width,
                channels,
                level,
            };
            let settled = settle(&picture, &start, &rules, &|| stop.load(Ordering::Relaxed));
            drop(owner);
            settled
        })?;
        settled.map_err(value).map(|settled| told(py, &settled))
    });
    Err(PyTypeError::new_err(
        "image must be an array of uint8, uint16, float32 or float64 with 2 or 3 axes",
    ))
}

fn told<'py>(py: Python<'py>, settled: &Settled) -> Found<'py> {
    let stop = match settled.stop {
        Stop::Settled => "settled",
        Stop::Limit => "limit",
        Stop::Asked => "stopped",
    };
    (
        array(py, &settled.points),
        stop,
        settled.steps,
        settled.between,
        settled.collapsed,
    )
}
