//! A picture as forces look at it, with its pixels as they are.

use field::{EdgeForce, FieldError, ForceField, Grid, Pixels};
use ndarray::Array2;

use super::Picture;

impl Pixels for Picture {
    fn size(&self) -> (usize, usize) {
        Self::size(self)
    }

    fn levels(&self) -> &Grid {
        Self::levels(self)
    }

    fn level(&self, x: usize, y: usize) -> f64 {
        self.level_at(x, y)
    }

    fn color(&self, x: usize, y: usize) -> [f64; 3] {
        self.color_at(x, y)
    }

    fn channels(&self) -> Vec<Grid> {
        Self::channels(self)
    }

    fn is_color(&self) -> bool {
        Self::is_color(self)
    }

    fn valid(&self) -> Option<&Array2<bool>> {
        Self::valid(self)
    }

    fn is_checked(&self) -> bool {
        self.is_tame()
    }

    fn limits(&self) -> [f64; 4] {
        self.grey_limits()
    }

    fn largest(&self) -> f64 {
        self.largest_level()
    }

    fn lazy_edge_force(&self, rule: &EdgeForce) -> Result<Option<ForceField>, FieldError> {
        Self::lazy_edge_force(self, rule)
    }
}
