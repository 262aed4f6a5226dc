//! Forces from what lies inside a closed curve and what outside, without looking at the area.
//!
//! Sums over the inside of a polygon are differences of row sums at its border (Green's theorem), so a step costs
//! the length of the curve in rows, not its area.

use crate::error::{FieldError, positive};
use crate::grid::{Grid, admit};
use glam::DVec2;

/// Two regions of constant grey each, the curve between them.
///
/// ```text
/// E = gain · (∫_in (I − a)² + ∫_out (I − b)²)        a, b: means of I inside and outside
/// f = gain · ((I − b)² − (I − a)²)                   along the outward normal
/// ```
///
/// f is minus the derivative of E by the normal motion of the curve (a and b are optimal, so their own
/// change costs nothing). No edge is needed, and the reach is the whole picture.
///
/// \[chanvese01\]
#[derive(Debug, Clone, PartialEq)]
pub struct TwoRegions {
    image: Grid,
    /// `sums[[y, x]]`: sum of the pixels of row y before column x; one column more than the image.
    sums: Grid,
    gain: f64,
}

/// Mean grey levels inside and outside of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Means {
    /// Mean inside.
    pub inside: f64,
    /// Mean outside.
    pub outside: f64,
    /// Pixels inside, cut ones by their share.
    pub area: f64,
}

impl TwoRegions {
    /// Prepares a picture. `gain` is a force per squared grey level. O(pixels), once.
    ///
    /// # Errors
    /// A picture without pixels or with one that is not finite or too large; a `gain` that is not above 0.
    pub fn new(image: &Grid, gain: f64) -> Result<Self, FieldError> {
        positive("gain", gain)?;
        let image = admit(image, 1.0)?;
        let mut sums = Grid::zeros((image.nrows(), image.ncols() + 1));
        for ((y, x), &value) in image.indexed_iter() {
            sums[[y, x + 1]] = sums[[y, x]] + value;
        }
        Ok(Self { image, sums, gain })
    }

    /// Mean grey levels on both sides of a closed polygon, of either orientation, that does not cross itself.
    ///
    /// A pixel covers the unit square around its center, and counts by its share; in each row the border is taken
    /// as steep as it is at the row's middle, so areas are exact inside the picture. What lies outside does not
    /// count. Where a side has no pixels, it gets the mean of the whole picture. O(rows crossed), whatever the area.
    #[must_use]
    pub fn means(&self, polygon: &[DVec2]) -> Means {
        let (height, width) = self.image.dim();
        let (mut area, mut sum) = (0.0, 0.0);
        let Some(&last) = polygon.last() else {
            return self.split(0.0, 0.0);
        };
        let mut from = last;
        for &to in polygon {
            // in the rows' own count, where row k is the band from k to k + 1
            let (a, b) = (from + 0.5, to + 0.5);
            let (top, bottom) = (a.y.min(b.y).max(0.0), a.y.max(b.y).min(height as f64));
            let sign = if b.y > a.y { 1.0 } else { -1.0 };
            let slope = (b.x - a.x) / (b.y - a.y);
            let mut y = top;
            while y < bottom {
                let next = (y.floor() + 1.0).min(bottom);
                let middle = 0.5 * (y + next);
                let x = (a.x + (middle - a.y) * slope).clamp(0.0, width as f64);
                area += sign * (next - y) * x;
                sum += sign * (next - y) * self.before(middle.floor(), x);
                y = next;
            }
            from = to;
        }
        if area < 0.0 {
            self.split(-area, -sum)
        } else {
            self.split(area, sum)
        }
    }

    /// Sum of row y left of `x`, counted from the left border of the first pixel.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the picture before"
    )]
    fn before(&self, y: f64, x: f64) -> f64 {
        let (row, column) = (y as usize, (x.floor() as usize).min(self.image.ncols() - 1));
        self.sums[[row, column]] + (x - column as f64) * self.image[[row, column]]
    }

    fn split(&self, area: f64, sum: f64) -> Means {
        let (pixels, width) = (self.image.len() as f64, self.image.ncols());
        let total = self.sums.column(width).sum();
        let mean = |sum: f64, area: f64| {
            if area > 1e-9 {
                sum / area
            } else {
                total / pixels
            }
        };
        Means {
            inside: mean(sum, area),
            outside: mean(total - sum, pixels - area),
            area,
        }
    }

    /// The force along the outward normal at a point of the curve: positive lets the curve grow.
    #[must_use]
    pub fn normal_force(&self, p: DVec2, means: &Means) -> f64 {
        let grey = self.grey(p);
        let (out, inside) = (grey - means.outside, grey - means.inside);
        self.gain * (out * out - inside * inside)
    }

    /// The picture at a point, bilinear, the nearest point's outside.
    fn grey(&self, p: DVec2) -> f64 {
        let (height, width) = self.image.dim();
        let (x, tx, _) = crate::sample::cell(p.x, width);
        let (y, ty, _) = crate::sample::cell(p.y, height);
        let (right, down) = ((x + 1).min(width - 1), (y + 1).min(height - 1));
        let row = |y: usize| self.image[[y, x]] * (1.0 - tx) + self.image[[y, right]] * tx;
        row(y) * (1.0 - ty) + row(down) * ty
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    fn circle(center: DVec2, radius: f64, n: usize) -> Vec<DVec2> {
        (0..n)
            .map(|i| center + radius * DVec2::from_angle(TAU * i as f64 / n as f64))
            .collect()
    }

    fn texture(height: usize, width: usize) -> Grid {
        Grid::from_shape_fn((height, width), |(y, x)| {
            ((x * 37 + y * 91 + x * y * 3) % 101) as f64
        })
    }

    /// The means by asking many points of every pixel, as slowly as it gets.
    fn slow_means(image: &Grid, polygon: &[DVec2]) -> Means {
        let (mut area, mut sum) = (0.0, 0.0);
        let parts = 24;
        let inside = |at: DVec2| {
            let crossings = (0..polygon.len()).filter(|&i| {
                let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
                (a.y <= at.y) != (b.y <= at.y)
                    && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x)
            });
            crossings.count() % 2 == 1
        };
        let part = |k: u32| (f64::from(k) + 0.5) / f64::from(parts) - 0.5;
        for ((y, x), &value) in image.indexed_iter() {
            let corner = DVec2::new(x as f64, y as f64);
            let at = |k: u32| corner + DVec2::new(part(k % parts), part(k / parts));
            let hits = (0..parts * parts).filter(|&k| inside(at(k))).count();
            let share = hits as f64 / f64::from(parts * parts);
            (area, sum) = (area + share, sum + share * value);
        }
        let total = image.sum();
        let pixels = image.len() as f64;
        Means {
            inside: sum / area,
            outside: (total - sum) / (pixels - area),
            area,
        }
    }

    #[test]
    fn the_border_sums_are_the_sums_over_the_area() {
        let image = texture(30, 34);
        let regions = TwoRegions::new(&image, 1.0).unwrap();
        for (center, radius) in [((15.3, 14.8), 9.0), ((3.0, 4.0), 8.0), ((33.0, 29.0), 12.0)] {
            let polygon = circle(DVec2::from(center), radius, 60);
            let (fast, slow) = (regions.means(&polygon), slow_means(&image, &polygon));
            // the slow one counts 24 × 24 points a pixel, some 60 pixels are cut
            assert!((fast.area - slow.area).abs() < 0.2, "{fast:?} {slow:?}");
            assert!(
                (fast.inside - slow.inside).abs() < 0.1
                    && (fast.outside - slow.outside).abs() < 0.1
            );
        }
    }

    #[test]
    fn orientation_does_not_matter_and_a_shift_by_whole_pixels_is_exact() {
        let regions = TwoRegions::new(&texture(30, 30), 1.0).unwrap();
        let mut polygon = circle(DVec2::new(14.0, 15.0), 8.0, 40);
        let forwards = regions.means(&polygon);
        polygon.reverse();
        let backwards = regions.means(&polygon);
        assert!((forwards.area - backwards.area).abs() < 1e-9);
        assert!((forwards.inside - backwards.inside).abs() < 1e-9);
        let square = [(3.5, 2.5), (9.5, 2.5), (9.5, 7.5), (3.5, 7.5)].map(DVec2::from);
        assert!((regions.means(&square).area - 30.0).abs() < 1e-12);
    }

    #[test]
    fn a_disk_is_grown_to_from_inside_and_shrunk_to_from_outside() {
        let center = DVec2::new(40.0, 40.0);
        let image = Grid::from_shape_fn((81, 81), |(y, x)| {
            if DVec2::new(x as f64, y as f64).distance(center) < 20.0 {
                200.0
            } else {
                60.0
            }
        });
        let regions = TwoRegions::new(&image, 1e-3).unwrap();
        let push = |radius: f64| {
            let polygon = circle(center, radius, 100);
            let means = regions.means(&polygon);
            polygon
                .iter()
                .map(|&p| regions.normal_force(p, &means))
                .sum::<f64>()
                / 100.0
        };
        assert!(push(5.0) > 1.0 && push(18.0) > 1.0);
        assert!(push(22.0) < -1.0 && push(39.0) < -1.0);
    }

    proptest! {
        #[test]
        fn the_force_is_minus_the_derivative_of_the_energy(
            radius in 10.0..25.0_f64, (x, y) in (36.0..44.0_f64, 36.0..44.0_f64),
        ) {
            // a smooth picture, so that rows are as good as an integral
            let image = Grid::from_shape_fn((81, 81), |(v, u)| {
                let (u, v) = (u as f64, v as f64);
                100.0 + 40.0 * (u / 9.0).sin() * (v / 7.0).cos() + 0.5 * u
            });
            let regions = TwoRegions::new(&image, 1.0).unwrap();
            let squares = TwoRegions::new(&image.mapv(|i| i * i), 1.0).unwrap();
            let center = DVec2::new(x, y);
            let energy = |radius: f64| {
                let polygon = circle(center, radius, 400);
                let (m, s) = (regions.means(&polygon), squares.means(&polygon));
                let rest = image.len() as f64 - m.area;
                m.area * (s.inside - m.inside * m.inside) + rest * (s.outside - m.outside * m.outside)
            };
            let step = 0.5;
            let slope = (energy(radius + step) - energy(radius - step)) / (2.0 * step);
            let polygon = circle(center, radius, 400);
            let means = regions.means(&polygon);
            // two regions of the same grey: nothing but the steps of pixels is left to compare
            prop_assume!((means.inside - means.outside).abs() > 2.0);
            let arc = TAU * radius / 400.0;
            let force: f64 = polygon.iter().map(|&p| arc * regions.normal_force(p, &means)).sum();
            let size: f64 = polygon.iter().map(|&p| arc * regions.normal_force(p, &means).abs()).sum();
            // pixels are steps of what the force reads in between, and the step is half a pixel
            prop_assert!((slope + force).abs() < 0.08 * size, "{} and {} of {}", slope, force, size);
        }
    }

    #[test]
    fn curves_outside_or_without_area_push_nowhere() {
        let regions = TwoRegions::new(&texture(10, 10), 1.0).unwrap();
        for polygon in [
            vec![],
            circle(DVec2::splat(500.0), 3.0, 20),
            vec![DVec2::splat(4.2); 5],
        ] {
            let means = regions.means(&polygon);
            assert!(
                means.area.abs() < 1e-9 && (means.inside - means.outside).abs() < 1e-9,
                "{means:?}"
            );
            assert!(regions.normal_force(DVec2::splat(5.0), &means).abs() < 1e-6);
        }
        assert!(TwoRegions::new(&Grid::zeros((0, 0)), 1.0).is_err());
        assert!(TwoRegions::new(&Grid::zeros((2, 2)), -1.0).is_err());
    }
}
