//! The compiled part of `pysnakes`: arrays in, arrays out, the lock of Python released in between.
//!
//! Nothing is computed here. What users see, with its documentation, is the Python package beside it; this module is
//! private to that package.

mod classic;
mod errors;
mod fitting;
mod forces;
mod images;
mod measuring;
mod motion;
mod options;
mod points;
mod scenes;
mod tables;
mod tracking;
mod waiting;

use pyo3::prelude::*;

/// What the package `pysnakes` is made of.
#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    waiting::watch_panics();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("PanicError", module.py().get_type::<errors::PanicError>())?;
    module.add_class::<images::Image>()?;
    module.add_class::<fitting::Prepared>()?;
    module.add_class::<fitting::Batch>()?;
    module.add_class::<tables::Store>()?;
    module.add_class::<tracking::Tracker>()?;
    module.add_class::<scenes::Scene>()?;
    module.add_class::<motion::Simulation>()?;
    for function in [
        wrap_pyfunction!(classic::active_contour, module)?,
        wrap_pyfunction!(forces::force_field, module)?,
        wrap_pyfunction!(measuring::measures, module)?,
        wrap_pyfunction!(measuring::filled, module)?,
        wrap_pyfunction!(measuring::border, module)?,
        wrap_pyfunction!(measuring::written, module)?,
        wrap_pyfunction!(measuring::load_outlines, module)?,
        wrap_pyfunction!(measuring::curve, module)?,
        wrap_pyfunction!(motion::ring, module)?,
        wrap_pyfunction!(motion::certificate, module)?,
        wrap_pyfunction!(scenes::scene_names, module)?,
        wrap_pyfunction!(scenes::picture, module)?,
        wrap_pyfunction!(scenes::contour, module)?,
        wrap_pyfunction!(scenes::load_picture, module)?,
        wrap_pyfunction!(tables::image_name, module)?,
        wrap_pyfunction!(waiting::fail_on_purpose, module)?,
        wrap_pyfunction!(waiting::sleep, module)?,
    ] {
        module.add_function(function)?;
    }
    Ok(())
}
