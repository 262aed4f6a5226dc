//! What one file of outlines may ask for: points, outlines, pixels of masks.

use glam::DVec2;

use crate::IoError;
use crate::limits::{FARTHEST, MOST_NODES, MOST_POINTS, MOST_SHAPES, MOST_TRACED};

/// What a reader has taken of what it may.
#[derive(Debug, Default)]
pub(crate) struct Budget {
    points: usize,
    shapes: usize,
    pixels: u64,
}

impl Budget {
    /// Take in so many points more.
    pub(super) fn points(&mut self, count: usize) -> Result<(), String> {
        self.points = self.points.saturating_add(count);
        if self.points > MOST_POINTS {
            return Err(format!(
                "holds more than {MOST_POINTS} points, which are the most"
            ));
        }
        Ok(())
    }

    /// Take in a ring of so many points.
    pub(super) fn ring(&mut self, count: usize) -> Result<(), String> {
        if count > MOST_NODES {
            return Err(format!(
                "a ring of {count} points; it must have at most {MOST_NODES}"
            ));
        }
        self.shape()?;
        self.points(count)
    }

    /// Take in an outline, or a ring of one.
    pub(super) fn shape(&mut self) -> Result<(), String> {
        self.shapes += 1;
        if self.shapes > MOST_SHAPES {
            return Err(format!(
                "holds more than {MOST_SHAPES} outlines, which are the most"
            ));
        }
        Ok(())
    }

    /// Take in a mask of so many pixels.
    pub(super) fn pixels(&mut self, count: u64) -> Result<(), String> {
        self.pixels = self.pixels.saturating_add(count);
        if self.pixels > MOST_TRACED {
            return Err(format!(
                "its masks have more than {MOST_TRACED} pixels together, which are the most"
            ));
        }
        Ok(())
    }
}

/// A point of two numbers that are finite and not too far.
pub(super) fn point(x: f64, y: f64) -> Result<DVec2, String> {
    if x.abs() <= FARTHEST && y.abs() <= FARTHEST {
        return Ok(DVec2::new(x, y));
    }
    Err(format!(
        "numbers must be from -{FARTHEST:e} to {FARTHEST:e}"
    ))
}

/// What a format cannot hold.
pub(super) fn cannot(format: &'static str, message: impl ToString) -> IoError {
    IoError::Format {
        format,
        message: message.to_string(),
    }
}

/// A ring whose last point is its first again, without that point.
pub(super) fn unrepeated(mut ring: Vec<DVec2>) -> Vec<DVec2> {
    while ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
    ring
}
