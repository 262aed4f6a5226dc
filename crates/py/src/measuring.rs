//! What an outline measures, as a mask, as a file of other programs.

use std::path::PathBuf;

use numpy::{IntoPyArray, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList};
use score::Measures;
use snakes::io::shapes::{self, Context, Format, Shape};
use snakes::{Contour, Point};

use crate::errors::value;
use crate::points::{array, points};

/// Area, axes and so on.
#[pyfunction]
pub(crate) fn measures<'py>(
    py: Python<'py>,
    outline: PyReadonlyArray2<'py, f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let outline = points(&outline)?;
    let measures = py.detach(|| Measures::of(&[&outline])).map_err(value)?;
    let out = PyDict::new(py);
    for (name, number) in [
        ("area", measures.area),
        ("perimeter", measures.perimeter),
        ("major_axis", measures.major_axis),
        ("minor_axis", measures.minor_axis),
        ("angle", measures.angle),
        ("circularity", measures.circularity),
        ("solidity", measures.solidity),
        ("equivalent_diameter", measures.equivalent_diameter),
    ] {
        out.set_item(name, number)?;
    }
    for (name, place) in [
        ("centroid", measures.centroid),
        ("low", measures.low),
        ("high", measures.high),
    ] {
        out.set_item(name, (place.x, place.y))?;
    }
    Ok(out)
}

/// The pixels whose centers are inside.
#[pyfunction]
pub(crate) fn filled<'py>(
    py: Python<'py>,
    outlines: Vec<PyReadonlyArray2<'py, f64>>,
    shape: (usize, usize),
) -> PyResult<Bound<'py, PyArray2<bool>>> {
    let rings: PyResult<Vec<Vec<Point>>> = outlines.iter().map(points).collect();
    let rings = rings?;
    Ok(py.detach(|| score::filled(&rings, shape)).into_pyarray(py))
}

/// The outlines of a mask along the borders of its pixels.
#[pyfunction]
pub(crate) fn border<'py>(
    py: Python<'py>,
    mask: PyReadonlyArray2<'py, bool>,
) -> PyResult<Bound<'py, PyList>> {
    let mask = mask.as_array().to_owned();
    let rings = py.detach(|| score::border(&mask));
    PyList::new(py, rings.iter().map(|ring| array(py, ring)))
}

/// The bytes of a file of outlines. `size`: width and height of the picture.
#[pyfunction]
pub(crate) fn written<'py>(
    py: Python<'py>,
    outlines: Vec<(PyReadonlyArray2<'py, f64>, bool, Option<String>)>,
    format: &str,
    size: (usize, usize),
) -> PyResult<Bound<'py, PyBytes>> {
    let format = Format::named(format)
        .ok_or_else(|| value(format!("no format of outlines is called {format:?}")))?;
    let mut all = Vec::new();
    for (outline, closed, id) in &outlines {
        let mut shape = Shape::curve(points(outline)?, Some(*closed));
        shape.id.clone_from(id);
        all.push(shape);
    }
    let (width, height) = size;
    let context = Context {
        width,
        height,
        ..Context::default()
    };
    let bytes = py
        .detach(|| shapes::write(&all, format, &context))
        .map_err(value)?;
    Ok(PyBytes::new(py, &bytes))
}

/// The outlines of a file: points, whether closed, id.
#[pyfunction]
pub(crate) fn load_outlines(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyList>> {
    let shapes = py.detach(|| shapes::load(&path)).map_err(value)?;
    let list = PyList::empty(py);
    for shape in &shapes {
        for ring in &shape.rings {
            list.append((
                array(py, ring),
                shape.closed.unwrap_or(true),
                shape.id.clone(),
            ))?;
        }
    }
    Ok(list)
}

/// Points of an ellipse about (x, y), or of a rectangle between two corners.
#[pyfunction]
pub(crate) fn curve<'py>(
    py: Python<'py>,
    kind: &str,
    one: (f64, f64),
    other: (f64, f64),
) -> Bound<'py, PyArray2<f64>> {
    let (one, other) = (Point::from(one), Point::from(other));
    let made = match kind {
        "ellipse" => Contour::ellipse(one, other),
        _ => Contour::rectangle(one, other),
    };
    array(py, &made.points)
}
