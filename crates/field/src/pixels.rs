//! An image in memory, whatever keeps it.

use std::fmt;

use ndarray::Array2;

use crate::{EdgeForce, FieldError, ForceField, Grid, Recipe, lazy_force, level_limits};

/// Pixels as someone keeps them. Levels are grey values of any range; 0 to 255 where the report's
/// parameters are to mean what they meant. Grids are indexed `[[y, x]]`.
///
/// Implemented by whatever keeps an image in memory, so that its pixels need not be copied.
pub trait Pixels: fmt::Debug + Send + Sync {
    /// Width and height.
    fn size(&self) -> (usize, usize);

    /// Grey levels as doubles.
    fn levels(&self) -> &Grid;

    /// The level of one pixel in the image.
    fn level(&self, x: usize, y: usize) -> f64 {
        self.levels()[[y, x]]
    }

    /// Red, green and blue of one pixel, 0 to 255 where the image is of a screen; its level three times where it is
    /// grey.
    fn color(&self, x: usize, y: usize) -> [f64; 3] {
        [self.level(x, y); 3]
    }

    /// The channels that color forces look at.
    fn channels(&self) -> Vec<Grid> {
        vec![self.levels().clone()]
    }

    /// Whether the channels hold more than grey.
    fn is_color(&self) -> bool {
        false
    }

    /// Which pixels count; None if all do.
    fn valid(&self) -> Option<&Array2<bool>> {
        None
    }

    /// What is known of each pixel before it is looked at: the logarithm of the odds that it is one of the object, as
    /// of a network. None if nothing is.
    fn prior(&self) -> Option<&Grid> {
        None
    }

    /// Whether all levels are known to be finite and within the bounds of this crate.
    fn is_checked(&self) -> bool {
        false
    }

    /// The least level, the 2nd and the 98th percentile, and the largest, of the pixels that count.
    fn limits(&self) -> [f64; 4] {
        counted_limits(self.levels(), self.valid())
    }

    /// The largest level either way.
    fn largest(&self) -> f64 {
        let levels = self.levels().iter();
        levels.fold(0.0, |most: f64, level| most.max(level.abs()))
    }

    /// The edge force of the levels, computed where it is asked for and in `f32`; None where pixels
    /// that do not count stand in the way.
    ///
    /// # Errors
    ///
    /// A smoothing too wide for tiles, a gain that is not finite and above 0.
    fn lazy_edge_force(&self, rule: &EdgeForce) -> Result<Option<ForceField>, FieldError> {
        if self.valid().is_some() {
            return Ok(None);
        }
        #[expect(
            clippy::cast_possible_truncation,
            reason = "rounding to f32 is the point"
        )]
        let narrow = self.levels().mapv(|level| level as f32);
        lazy_force(narrow, &Recipe::Edge(*rule)).map(Some)
    }
}

/// Grey levels by themselves: all count.
impl Pixels for Grid {
    fn size(&self) -> (usize, usize) {
        let (height, width) = self.dim();
        (width, height)
    }

    fn levels(&self) -> &Grid {
        self
    }
}

/// [`Pixels::limits`] of a grid, over the pixels that count.
#[must_use]
pub fn counted_limits(grid: &Grid, valid: Option<&Array2<bool>>) -> [f64; 4] {
    match valid {
        None => level_limits(|| grid.iter().copied()),
        Some(valid) => level_limits(|| {
            let both = grid.iter().zip(valid);
            both.filter(|(_, counts)| **counts).map(|(&v, _)| v)
        }),
    }
}
