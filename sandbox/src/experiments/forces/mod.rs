//! The forces of a picture side by side: how far each reaches, what it does to what it finds, what noise does
//! to it, and how each looks.

mod bars;
mod capture;
mod fitted;
mod kinds;
mod noise;
mod reach;
mod rotation;
mod synthetic;

pub(crate) use bars::BARS;
pub(crate) use capture::CAPTURE;
pub(crate) use fitted::FITTED;
pub(crate) use kinds::FIELDS;
pub(crate) use noise::NOISE;
pub(crate) use rotation::ROTATION;
