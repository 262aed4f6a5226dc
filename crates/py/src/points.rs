//! Points as arrays of two columns.

use ndarray::Array2;
use numpy::{IntoPyArray, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use snakes::Point;

/// Points of an array of two columns, x and y.
pub(crate) fn points(array: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<Point>> {
    let view = array.as_array();
    if view.ncols() != 2 {
        let message = format!("points must have 2 columns, x and y, got {}", view.ncols());
        return Err(crate::errors::value(message));
    }
    Ok(view
        .rows()
        .into_iter()
        .map(|row| Point::new(row[0], row[1]))
        .collect())
}

/// An array of two columns, x and y.
pub(crate) fn array<'py>(py: Python<'py>, points: &[Point]) -> Bound<'py, PyArray2<f64>> {
    Array2::from_shape_fn((points.len(), 2), |(i, k)| points[i][k]).into_pyarray(py)
}

/// Numbers, NaN where there is none.
pub(crate) fn or_nan(values: impl IntoIterator<Item = Option<f64>>) -> Vec<f64> {
    values
        .into_iter()
        .map(|value| value.unwrap_or(f64::NAN))
        .collect()
}
