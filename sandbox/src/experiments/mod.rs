//! The experiments, one file a family.

pub(crate) mod angle;
pub(crate) mod damping;
pub(crate) mod disc;
pub(crate) mod force_field;
pub(crate) mod matrix;
mod pixels;
pub(crate) mod signal;
pub(crate) mod smoothing;
pub(crate) mod time_step;
