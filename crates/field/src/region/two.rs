//! Two regions of constant grey each, over the whole picture.

use super::rows::{Inside, RowSums};
use super::{Region, RegionScratch};
use crate::error::{FieldError, positive};
use crate::grid::Grid;
use crate::masked::MaskedImage;
use glam::DVec2;
use std::sync::Arc;

/// Two regions of constant grey each, the curve between them.
///
/// ```text
/// E = gain · (∫_in (I − a)² + ∫_out (I − b)²)        a, b: means of I inside and outside
/// f = gain · ((I − b)² − (I − a)²)                   along the outward normal
/// ```
///
/// f is minus the derivative of E by the normal motion of the curve (a and b are optimal, so their own
/// change costs nothing). No edge is needed, and the reach is the whole picture. For several channels, add one of these
/// for each: their energies add up. Copies share the picture.
///
/// \[chanvese01\]
#[derive(Debug, Clone, PartialEq)]
pub struct TwoRegions {
    rows: Arc<RowSums>,
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
    /// Prepares a picture. `gain` is a force per squared grey level. O(pixels), once; 16 bytes a pixel.
    ///
    /// # Errors
    /// A picture without pixels or with one that is not finite or too large; a `gain` that is not above 0.
    pub fn new(image: &Grid, gain: f64) -> Result<Self, FieldError> {
        Self::masked(&MaskedImage::whole(image)?, gain)
    }

    /// Prepares a picture of which some pixels do not count: they are in no sum, and exert no force.
    ///
    /// # Errors
    /// A `gain` that is not above 0.
    pub fn masked(picture: &MaskedImage, gain: f64) -> Result<Self, FieldError> {
        positive("gain", gain)?;
        let rows = Arc::new(RowSums::new(picture));
        Ok(Self { rows, gain })
    }

    /// Mean grey levels on both sides of a closed polygon, of either orientation, that does not cross itself.
    ///
    /// A pixel covers the unit square around its center, and counts by its share, exactly. What lies outside the picture does
    /// not count. Where a side has no pixels, it gets the mean of the whole picture. O(pixels crossed), whatever the area.
    #[must_use]
    pub fn means(&self, polygon: &[DVec2]) -> Means {
        let inside = self.rows.inside(polygon);
        let (a, b) = self.both(inside);
        Means {
            inside: a + self.rows.offset,
            outside: b + self.rows.offset,
            area: inside.area,
        }
    }

    /// Both means, less the offset.
    fn both(&self, inside: Inside) -> (f64, f64) {
        let whole = self.rows.total;
        let mean = whole.mean_or(0.0);
        (inside.mean_or(mean), inside.rest_of(whole).mean_or(mean))
    }

    /// The force along the outward normal at a point of the curve: positive lets the curve grow.
    #[must_use]
    pub fn normal_force(&self, p: DVec2, means: &Means) -> f64 {
        let offset = self.rows.offset;
        self.push(p, means.inside - offset, means.outside - offset)
    }

    pub(super) fn push(&self, p: DVec2, inside: f64, outside: f64) -> f64 {
        let place = self.rows.at(p);
        let (out, inside) = (place.grey - outside, place.grey - inside);
        self.gain * place.share * (out * out - inside * inside)
    }

    pub(super) fn rows(&self) -> &RowSums {
        &self.rows
    }
}

impl Region for TwoRegions {
    fn push_at(
        &self,
        polygon: &[DVec2],
        points: &[DVec2],
        _: &mut RegionScratch,
        push: &mut [f64],
    ) {
        let (inside, outside) = self.both(self.rows.inside(polygon));
        for (push, &p) in push.iter_mut().zip(points) {
            *push = self.push(p, inside, outside);
        }
    }

    fn energy(&self, polygon: &[DVec2]) -> Option<f64> {
        let inside = self.rows.inside(polygon);
        let outside = inside.rest_of(self.rows.total);
        let (a, b) = self.both(inside);
        // ∫ (I − a)² = ∫ I² − a ∫ I on either side
        Some(self.gain * (self.rows.squares - a * inside.sum - b * outside.sum))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::region::tests::{circle, encloses, slope_agrees};
    use proptest::prelude::*;

    fn texture(height: usize, width: usize) -> Grid {
        Grid::from_shape_fn((height, width), |(y, x)| {
            ((x * 37 + y * 91 + x * y * 3) % 101) as f64
        })
    }

    /// The means by asking many points of every pixel, as slowly as it gets.
    fn slow_means(image: &Grid, polygon: &[DVec2]) -> Means {
        let (mut area, mut sum) = (0.0, 0.0);
        let parts = 24;
        let inside = |at: DVec2| encloses(polygon, at);
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
        #![proptest_config(ProptestConfig::with_cases(32))]
        #[test]
        fn the_force_is_minus_the_derivative_of_the_energy(
            radius in 10.0..25.0_f64, (x, y) in (36.0..44.0_f64, 36.0..44.0_f64), gain in 0.1..3.0_f64,
        ) {
            let regions = TwoRegions::new(&texture(81, 81), gain).unwrap();
            let polygon = circle(DVec2::new(x, y), radius, 60);
            let means = regions.means(&polygon);
            prop_assert!(slope_agrees(&regions, &polygon, 4e-3, |p| regions.normal_force(p, &means)));
        }
    }

    #[test]
    fn the_energy_is_what_the_means_leave_over() {
        let image = texture(30, 34);
        let regions = TwoRegions::new(&image, 2.0).unwrap();
        let square = [(3.5, 2.5), (9.5, 2.5), (9.5, 7.5), (3.5, 7.5)].map(DVec2::from);
        let means = regions.means(&square);
        let inside = |(y, x): (usize, usize)| (4..10).contains(&x) && (3..8).contains(&y);
        let slow: f64 = image
            .indexed_iter()
            .map(|(at, v)| {
                let mean = if inside(at) {
                    means.inside
                } else {
                    means.outside
                };
                2.0 * (v - mean) * (v - mean)
            })
            .sum();
        let energy = regions.energy(&square).unwrap();
        // sums of a thousand squares of a hundred
        assert!((energy - slow).abs() < 1e-6, "{energy} {slow}");
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
