//! What can be wrong with an image or with the numbers that turn it into a field.

use glam::DVec2;

/// What can be wrong on the way from an image to a force field.
///
/// Each variant carries what was given; its message says what is needed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FieldError {
    /// The image (or signal) has no pixel at all.
    #[error("an image needs at least one row and one column, got {width} × {height}")]
    Empty {
        /// Columns given.
        width: usize,
        /// Rows given.
        height: usize,
    },
    /// A mask leaves no pixel.
    #[error("the mask leaves none of {width} × {height} pixels; at least one must count")]
    NothingValid {
        /// Columns given.
        width: usize,
        /// Rows given.
        height: usize,
    },
    /// A pixel is NaN or infinite; the first one in reading order is named.
    #[error("pixel ({column}, {row}) is {value}; every pixel must be a finite number")]
    NotFinite {
        /// x of the first bad pixel, from 0.
        column: usize,
        /// y of the first bad pixel, from 0.
        row: usize,
        /// What it holds.
        value: f64,
    },
    /// A pixel is so large that its gradient would overflow.
    #[error(
        "pixel ({column}, {row}) is {value:e}; magnitudes up to {most:e} can be handled, scale the image down"
    )]
    TooLarge {
        /// x of the first bad pixel, from 0.
        column: usize,
        /// y of the first bad pixel, from 0.
        row: usize,
        /// What it holds.
        value: f64,
        /// The largest magnitude accepted.
        most: f64,
    },
    /// A parameter that must be positive is not.
    #[error("{name} must be finite and above 0, got {value}")]
    NotPositive {
        /// The parameter's name.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// A parameter lies outside the range that makes sense.
    #[error("{name} must be at most {most}, got {value}")]
    TooMuch {
        /// The parameter's name.
        name: &'static str,
        /// What was given.
        value: f64,
        /// The largest value accepted.
        most: f64,
    },
    /// The machine does not give the memory a result needs.
    #[error(
        "the field of {width} × {height} pixels needs {bytes} bytes, more than there is; take a part of the image or a lazy field"
    )]
    NoMemory {
        /// Columns given.
        width: usize,
        /// Rows given.
        height: usize,
        /// What the forces alone take.
        bytes: usize,
    },
    /// Two grids that belong together differ in shape.
    #[error("both grids must have the same shape, got {} × {} and {} × {}", first.1, first.0, second.1, second.0)]
    ShapesDiffer {
        /// (rows, columns) of the first.
        first: (usize, usize),
        /// (rows, columns) of the second.
        second: (usize, usize),
    },
}

/// The report's program would stop here with an index error: the position has no force.
///
/// Report §4.2.2 and Appendix A; D54, D56. `axis` is the component that was read first and failed.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("no {axis} force at ({}, {}): the position lies outside the field", at.x, at.y)]
pub struct OutsideField {
    /// Where the force was asked for.
    pub at: DVec2,
    /// `'x'` or `'y'`: the component whose look-up failed.
    pub axis: char,
}

/// Refuses a parameter that is not finite and above 0.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<(), FieldError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(FieldError::NotPositive { name, value })
    }
}
