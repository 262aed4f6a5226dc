//! How bright a picture is inside an outline, and in a ring around it.

use crate::ScoreError;
use crate::mask::filled;
use field::{Grid, squared_distance};
use glam::DVec2;

/// Mean grey levels on both sides of an outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GreyMeans {
    /// Over the pixels whose centers are inside; None if there are none.
    pub inside: Option<f64>,
    /// Over the pixels outside that are no farther than the width from one inside; None if there are none.
    pub outside: Option<f64>,
}

impl GreyMeans {
    /// Of an outline in a picture, with a ring of this width around it, in pixels from center to center.
    ///
    /// Levels that are not finite make a mean that is not.
    ///
    /// # Errors
    ///
    /// A width below 0.
    pub fn of<R: AsRef<[DVec2]>>(
        rings: &[R],
        levels: &Grid,
        width: f64,
    ) -> Result<Self, ScoreError> {
        if width.is_nan() || width < 0.0 {
            let (what, got) = ("the width of the ring", width);
            return Err(ScoreError::Negative { what, got });
        }
        let mask = filled(rings, levels.dim());
        let near = squared_distance(&mask);
        let (mut inside, mut outside) = (Mean::default(), Mean::default());
        for (at, &level) in levels.indexed_iter() {
            if mask[at] {
                inside.add(level);
            } else if near[at] <= width * width {
                outside.add(level);
            }
        }
        Ok(Self {
            inside: inside.value(),
            outside: outside.value(),
        })
    }
}

/// A sum, and of how many.
#[derive(Debug, Default)]
struct Mean {
    sum: f64,
    count: f64,
}

impl Mean {
    fn add(&mut self, level: f64) {
        self.sum += level;
        self.count += 1.0;
    }

    fn value(&self) -> Option<f64> {
        (self.count > 0.0).then(|| self.sum / self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_two_sides_of_a_square_are_told_apart() {
        let corner = |x: f64, y: f64| DVec2::new(4.5 + 5.0 * x, 3.5 + 5.0 * y);
        let square = [
            corner(0.0, 0.0),
            corner(1.0, 0.0),
            corner(1.0, 1.0),
            corner(0.0, 1.0),
        ];
        let levels = Grid::from_shape_fn((14, 16), |(y, x)| {
            match ((4..9).contains(&y), (5..10).contains(&x)) {
                (true, true) => 200.0,
                (true, false) if x == 4 || x == 10 => 70.0,
                (false, true) if y == 3 || y == 9 => 30.0,
                _ => 1e6,
            }
        });
        // no farther than one pixel: four sides of five pixels, no corner
        let means = GreyMeans::of(&[square], &levels, 1.0).unwrap();
        assert_eq!((means.inside, means.outside), (Some(200.0), Some(50.0)));
        let none = GreyMeans::of(&[square], &levels, 0.0).unwrap();
        assert_eq!(none.outside, None);
        let nowhere = GreyMeans::of(&[[DVec2::ZERO]], &levels, 3.0).unwrap();
        assert_eq!((nowhere.inside, nowhere.outside), (None, None));
        assert!(GreyMeans::of(&[square], &levels, f64::NAN).is_err());
    }
}
