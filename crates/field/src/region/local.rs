//! Two regions that need to be constant only near the curve.

use super::rows::{Inside, index};
use super::two::TwoRegions;
use super::{Region, RegionScratch};
use crate::error::{FieldError, positive};
use glam::DVec2;

/// Two regions of constant grey near each node: means inside and outside within a disk about it.
///
/// ```text
/// f[i] = gain · ((I − b_i)² − (I − a_i)²)            along the outward normal
/// a_i, b_i: means of I inside and outside, over the pixels within `radius` of node i
/// ```
///
/// For uneven light, and for objects that differ from their surroundings here in one way and there in another. It does
/// not reach farther than the disk: a node whose disk lies on one side of everything feels nothing.
///
/// **No energy.** The means of a node change as its disk moves along with it, which this force leaves out (as the authors'
/// own program does); within a disk that stays, it is that of [`TwoRegions`]. The disk is made of strips, one a row, as wide as
/// the disk is at the row's middle; a radius that reaches over the whole picture gives [`TwoRegions`] to rounding.
///
/// O(nodes · rows of the disk · pieces of the curve in a row), whatever the area.
///
/// \[lankton08\]
#[derive(Debug, Clone, PartialEq)]
pub struct LocalRegions {
    whole: TwoRegions,
    radius: f64,
}

impl LocalRegions {
    /// Looks at a prepared picture, its mask and its gain, through disks of this radius in pixels.
    ///
    /// # Errors
    /// A `radius` that is not finite and above 0.
    pub fn new(whole: &TwoRegions, radius: f64) -> Result<Self, FieldError> {
        positive("radius", radius)?;
        let whole = whole.clone();
        Ok(Self { whole, radius })
    }

    /// What lies in the disk about `center`, and what of it inside the curve (negative for the other orientation).
    fn disk(&self, center: DVec2, scratch: &RegionScratch) -> (Inside, Inside) {
        let rows = self.whole.rows();
        let (height, width) = rows.image.dim();
        let c = center + 0.5;
        let (first, last) = (
            index((c.y - self.radius).max(0.0)).min(height - 1),
            index((c.y + self.radius).max(0.0)).min(height - 1),
        );
        let (mut disk, mut inside) = (Inside::default(), Inside::default());
        for row in first..=last {
            let up = row as f64 + 0.5 - c.y;
            let half = (self.radius * self.radius - up * up).max(0.0).sqrt();
            let (left, right) = (
                (c.x - half).clamp(0.0, width as f64),
                (c.x + half).clamp(0.0, width as f64),
            );
            if left >= right {
                continue;
            }
            let (from, to) = (rows.before(row, left), rows.before(row, right));
            disk.add(1.0, to);
            disk.add(-1.0, from);
            for &(x, weight) in scratch.crossings.row(row) {
                // the pieces of a row go down as much as up, so what is left of the disk cancels
                inside.add(
                    weight,
                    if x <= left {
                        from
                    } else if x >= right {
                        to
                    } else {
                        rows.before(row, x)
                    },
                );
            }
        }
        (disk, inside)
    }
}

impl Region for LocalRegions {
    fn push_at(
        &self,
        polygon: &[DVec2],
        points: &[DVec2],
        scratch: &mut RegionScratch,
        push: &mut [f64],
    ) {
        scratch
            .crossings
            .fill(polygon, self.whole.rows().image.dim());
        let sign = if super::signed_area(polygon) < 0.0 {
            -1.0
        } else {
            1.0
        };
        for (push, &p) in push.iter_mut().zip(points) {
            let (disk, signed) = self.disk(p, scratch);
            let mut inside = Inside::default();
            inside.add(sign, signed);
            let mean = disk.mean_or(0.0);
            let (a, b) = (inside.mean_or(mean), inside.rest_of(disk).mean_or(mean));
            *push = self.whole.push(p, a, b);
        }
    }

    fn energy(&self, _: &[DVec2]) -> Option<f64> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;
    use crate::region::tests::{circle, encloses, pushes};
    use ndarray::Array2;
    use proptest::prelude::*;

    fn texture(height: usize, width: usize) -> Grid {
        Grid::from_shape_fn((height, width), |(y, x)| {
            ((x * 37 + y * 91 + x * y * 3) % 101) as f64
        })
    }

    proptest! {
        #[test]
        fn a_disk_over_the_whole_picture_is_two_regions(
            (x, y) in (5.0..25.0_f64, 5.0..25.0_f64), radius in 2.0..12.0_f64,
        ) {
            let whole = TwoRegions::new(&texture(30, 34), 1.0).unwrap();
            let local = LocalRegions::new(&whole, 1e5).unwrap();
            let polygon = circle(DVec2::new(x, y), radius, 30);
            for (a, b) in pushes(&whole, &polygon).iter().zip(pushes(&local, &polygon)) {
                // pushes of some thousands
                prop_assert!((a - b).abs() < 1e-6, "{} {}", a, b);
            }
        }

        #[test]
        fn the_means_in_a_disk_are_the_slow_twins(
            (x, y) in (9.0..21.0_f64, 9.0..21.0_f64), radius in 4.0..8.0_f64, reach in 3.0..9.0_f64,
        ) {
            // every pixel is asked at 16 × 16 points; a row counts as in the disk by its middle
            let image = texture(30, 30);
            let local = LocalRegions::new(&TwoRegions::new(&image, 1.0).unwrap(), reach).unwrap();
            let polygon = circle(DVec2::new(x, y), radius, 20);
            let mut scratch = RegionScratch::default();
            scratch.crossings.fill(&polygon, (30, 30));
            let (disk, inside) = local.disk(polygon[3], &scratch);
            let (mut slow_disk, mut slow_inside) = (Inside::default(), Inside::default());
            for ((v, u), value) in image.indexed_iter() {
                for k in 0..256 {
                    let part = |k: i32| (f64::from(k) + 0.5) / 16.0 - 0.5;
                    let at = DVec2::new(u as f64 + part(k % 16), v as f64 + part(k / 16));
                    let d = DVec2::new(at.x, v as f64) - polygon[3];
                    let point = Inside { area: 1.0, sum: value - image[[0, 0]] };
                    if d.length() < reach {
                        slow_disk.add(1.0 / 256.0, point);
                        if encloses(&polygon, at) {
                            slow_inside.add(1.0 / 256.0, point);
                        }
                    }
                }
            }
            // the twin's points, and the pixels cut by curve and disk at once
            prop_assert!((disk.area - slow_disk.area).abs() < 0.03 * disk.area + 0.3);
            prop_assert!((inside.area - slow_inside.area).abs() < 0.03 * inside.area + 0.5);
            prop_assert!((disk.sum - slow_disk.sum).abs() < 60.0 * (0.02 * disk.area + 0.5));
            prop_assert!((inside.sum - slow_inside.sum).abs() < 60.0 * (0.02 * inside.area + 0.5));
        }
    }

    #[test]
    fn an_object_in_uneven_light_is_found_where_one_grey_for_all_misleads() {
        // contrast 40, light that changes by 200 over the picture
        let center = DVec2::splat(50.0);
        let image = Grid::from_shape_fn((101, 101), |(y, x)| {
            let p = DVec2::new(x as f64, y as f64);
            2.0 * p.x + if p.distance(center) < 25.0 { 40.0 } else { 0.0 }
        });
        let whole = TwoRegions::new(&image, 1.0).unwrap();
        let local = LocalRegions::new(&whole, 8.0).unwrap();
        let right_way = |region: &dyn Region| {
            let (small, large) = (circle(center, 22.0, 80), circle(center, 28.0, 80));
            let grows = pushes(region, &small).iter().filter(|f| **f > 0.0).count();
            let shrinks = pushes(region, &large).iter().filter(|f| **f < 0.0).count();
            grows + shrinks
        };
        assert_eq!(right_way(&local), 160);
        assert!(right_way(&whole) < 110, "{}", right_way(&whole));
    }

    #[test]
    fn beyond_its_disk_a_node_feels_nothing() {
        let image = Grid::from_shape_fn((60, 60), |(_, x)| if x > 40 { 9.0 } else { 1.0 });
        let whole = TwoRegions::new(&image, 1.0).unwrap();
        let local = LocalRegions::new(&whole, 7.0).unwrap();
        let push = pushes(&local, &circle(DVec2::new(20.0, 30.0), 10.0, 30));
        assert!(push.iter().all(|f| f.abs() < 1e-12));
        for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(LocalRegions::new(&whole, radius).is_err());
        }
        let none = Array2::from_elem((60, 60), false);
        assert!(crate::MaskedImage::new(&image, &none).is_err());
    }
}
