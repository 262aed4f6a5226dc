//! Errors of the crates below as exceptions of Python.

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::{PyErr, create_exception};

create_exception!(
    pysnakes,
    PanicError,
    PyRuntimeError,
    "A fault inside pysnakes; the message says where."
);

/// A value that will not do.
pub(crate) fn value(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}
