//! Changes of a picture before a fit, and of curves with it and back.

use std::sync::Arc;

use glam::DVec2;
use io::Picture;
use scene::SceneError;
use scene::field::Grid;
use scene::fit::Image;

use super::flags::Eval;
use crate::commands::key;

/// What is done to a picture: it is turned, then enlarged; its levels are inverted, then darkened.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Change {
    quarters: u32,
    double: bool,
    invert: bool,
    darken: f64,
}

impl Change {
    /// What the flags ask for; None if nothing.
    pub(super) fn of(flags: &Eval) -> Result<Option<Self>, SceneError> {
        let darken = flags.darken.unwrap_or(1.0);
        if !(darken > 0.0 && darken <= 1.0) {
            return Err(key(
                "--darken",
                format!("must be above 0 and at most 1, got {darken}"),
            ));
        }
        let quarters = match flags.turn {
            None => 0,
            Some(degrees) if [90, 180, 270].contains(&degrees) => degrees / 90,
            Some(degrees) => {
                return Err(key(
                    "--turn",
                    format!("must be 90, 180 or 270, got {degrees}"),
                ));
            }
        };
        let change = Self {
            quarters,
            double: flags.double,
            invert: flags.invert,
            darken,
        };
        let any = quarters > 0 || change.double || change.invert || flags.darken.is_some();
        Ok(any.then_some(change))
    }

    /// A picture changed, rounded to whole levels as a file of 8 bits would be.
    pub(super) fn image(self, picture: &Arc<Picture>) -> Result<Image, String> {
        if !picture.is_color() {
            let bytes = self.grid(picture.levels()).mapv(byte);
            return Ok(Image::bytes(bytes.into_shared()));
        }
        let channels = picture.channels();
        let [red, green, blue] = &channels[..] else {
            return Err(format!("three channels are needed, got {}", channels.len()));
        };
        let channels = [red, green, blue].map(|channel| self.grid(channel));
        Image::color(channels).map_err(|error| error.to_string())
    }

    /// Levels changed.
    fn grid(self, levels: &Grid) -> Grid {
        let level = |level: f64| {
            let level = if self.invert { 255.0 - level } else { level };
            (level * self.darken).clamp(0.0, 255.0).round()
        };
        let mut grid = levels.clone();
        for _ in 0..self.quarters {
            let (height, width) = grid.dim();
            grid = Grid::from_shape_fn((width, height), |(y, x)| grid[[height - 1 - x, y]]);
        }
        if self.double {
            grid = doubled(&grid);
        }
        grid.mapv(level)
    }

    /// A curve of a picture of that size, changed with it.
    pub(super) fn there(self, points: &[DVec2], size: (usize, usize)) -> Vec<DVec2> {
        let mut points = points.to_vec();
        let (mut width, mut height) = size;
        for _ in 0..self.quarters {
            let last = height as f64 - 1.0;
            points
                .iter_mut()
                .for_each(|p| *p = DVec2::new(last - p.y, p.x));
            (width, height) = (height, width);
        }
        if self.double {
            // a pixel becomes two by two about its center
            points.iter_mut().for_each(|p| *p = 2.0 * *p + 0.5);
        }
        points
    }

    /// The same back.
    pub(super) fn back(self, points: &[DVec2], size: (usize, usize)) -> Vec<DVec2> {
        let mut points = points.to_vec();
        if self.double {
            points.iter_mut().for_each(|p| *p = 0.5 * (*p - 0.5));
        }
        let (mut width, mut height) = size;
        if self.quarters % 2 == 1 {
            (width, height) = (height, width);
        }
        for _ in 0..self.quarters {
            // the height before the turn is the width after it
            let last = width as f64 - 1.0;
            points
                .iter_mut()
                .for_each(|p| *p = DVec2::new(p.y, last - p.x));
            (width, height) = (height, width);
        }
        points
    }
}

/// Twice as large by bilinear interpolation about the centers of pixels; at the border they go on as they are.
fn doubled(grid: &Grid) -> Grid {
    let (height, width) = grid.dim();
    let near = |i: usize, most: usize| {
        let own = i / 2;
        let beside = if i.is_multiple_of(2) {
            own.saturating_sub(1)
        } else {
            (own + 1).min(most - 1)
        };
        (own, beside)
    };
    Grid::from_shape_fn((2 * height, 2 * width), |(y, x)| {
        let ((y, v), (x, u)) = (near(y, height), near(x, width));
        let along = |row: usize| 0.75 * grid[[row, x]] + 0.25 * grid[[row, u]];
        0.75 * along(y) + 0.25 * along(v)
    })
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "rounded and clamped to the range of a byte before"
)]
pub(super) const fn byte(level: f64) -> u8 {
    level as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_goes_where_its_curve_goes_and_the_curve_comes_back() {
        let grid =
            Grid::from_shape_fn((4, 6), |(y, x)| if (y, x) == (1, 4) { 200.0 } else { 10.0 });
        let at = [DVec2::new(4.0, 1.0)];
        for quarters in 0..4 {
            for double in [false, true] {
                let change = Change {
                    quarters,
                    double,
                    invert: false,
                    darken: 0.5,
                };
                let there = change.there(&at, (6, 4));
                assert_eq!(change.back(&there, (6, 4)), at);
                let changed = change.grid(&grid);
                let bright = changed.indexed_iter().filter(|(_, v)| **v > 50.0);
                let bright: Vec<DVec2> = bright
                    .map(|((y, x), _)| DVec2::new(x as f64, y as f64))
                    .collect();
                let center = bright.iter().sum::<DVec2>() / bright.len() as f64;
                assert_eq!(center, there[0], "{quarters} {double}");
            }
        }
    }

    #[test]
    fn levels_are_inverted_then_darkened_then_rounded() {
        let change = Change {
            quarters: 0,
            double: false,
            invert: true,
            darken: 0.3,
        };
        // 46.5, halves upwards
        assert_eq!(
            change.grid(&Grid::from_elem((1, 1), 100.0)),
            Grid::from_elem((1, 1), 47.0)
        );
    }
}
