//! The doors that numbers pass, each with a message that says what is needed.

use glam::DVec2;

use crate::SceneError;
use crate::limits::FARTHEST;

fn refuse(key: &str, wanted: &str, got: f64) -> SceneError {
    SceneError::key(key, format!("must be {wanted}, got {got}"))
}

pub(crate) fn finite(key: &str, value: f64) -> Result<f64, SceneError> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(refuse(key, "finite", value))
    }
}

pub(crate) fn above_zero(key: &str, value: f64) -> Result<f64, SceneError> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(refuse(key, "finite and above 0", value))
    }
}

/// A length or a place on an axis above zero, small enough to compute with.
pub(crate) fn length(key: &str, value: f64) -> Result<f64, SceneError> {
    if value > 0.0 && value <= FARTHEST {
        Ok(value)
    } else {
        Err(refuse(
            key,
            &format!("above 0 and at most {FARTHEST:e}"),
            value,
        ))
    }
}

pub(crate) fn coordinate(key: &str, value: f64) -> Result<f64, SceneError> {
    if value.abs() <= FARTHEST {
        Ok(value)
    } else {
        Err(refuse(
            key,
            &format!("from -{FARTHEST:e} to {FARTHEST:e}"),
            value,
        ))
    }
}

pub(crate) fn place(key: &str, [x, y]: [f64; 2]) -> Result<DVec2, SceneError> {
    Ok(DVec2::new(coordinate(key, x)?, coordinate(key, y)?))
}

/// Every one of a list of places, an error naming the first that is none.
pub(crate) fn places(key: &str, list: &[DVec2]) -> Result<(), SceneError> {
    match list
        .iter()
        .position(|p| !(p.abs().max_element() <= FARTHEST && p.is_finite()))
    {
        None => Ok(()),
        Some(i) => {
            let p = list[i];
            let message = format!(
                "point {i} is ({}, {}); needed: coordinates from -{FARTHEST:e} to {FARTHEST:e}",
                p.x, p.y
            );
            Err(SceneError::key(key, message))
        }
    }
}
