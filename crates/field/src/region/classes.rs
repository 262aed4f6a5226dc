//! A picture in few classes, and how many pixels of each class lie inside a curve.

use super::rows::{corners, index, walk};
use crate::error::FieldError;
use crate::grid::Grid;
use crate::masked::MaskedImage;
use glam::DVec2;
use ndarray::Array2;
use std::sync::Arc;

/// The most classes a picture may be sorted into.
pub const MOST_CLASSES: usize = 64;

/// The most memory the counts of a picture may take, in bytes.
pub const MOST_CLASS_BYTES: f64 = 8.0 * 1024.0 * 1024.0 * 1024.0;

/// The class of a pixel that does not count.
const NONE: u8 = u8::MAX;

/// Counts stand every so many columns; in between, pixels are counted anew.
const STRIDE: usize = 16;

/// A picture sorted into few classes, by grey level, color or texture.
///
/// What regions by their distributions are made of: a pixel is only its class, and a class its center. Takes
/// `1 + classes / 4` bytes a pixel, shared by all copies.
#[derive(Debug, Clone, PartialEq)]
pub struct Classes {
    pub(super) data: Arc<Counted>,
}

#[derive(Debug, PartialEq)]
pub(super) struct Counted {
    of: Array2<u8>,
    /// One center a class, channels side by side.
    centers: Grid,
    /// Variance of each channel within a class, above 0.
    within: Vec<f64>,
    /// Pixels of each class in row y before column `STRIDE` · block.
    counts: Vec<u32>,
    total: Vec<f64>,
}

impl Classes {
    /// By grey level: `bins` bins of equal width from the darkest to the brightest pixel that counts.
    ///
    /// A constant picture has one class. O(pixels).
    ///
    /// # Errors
    /// No bins or more than [`MOST_CLASSES`]; counts of more than [`MOST_CLASS_BYTES`].
    pub fn grey(picture: &MaskedImage, bins: usize) -> Result<Self, FieldError> {
        reasonable("bins", bins)?;
        let counts = |at| picture.valid().is_none_or(|valid: &Array2<bool>| valid[at]);
        let image = picture.image();
        let (low, high) = image.indexed_iter().filter(|(at, _)| counts(*at)).fold(
            (f64::INFINITY, f64::NEG_INFINITY),
            |(low, high), (_, &v)| (low.min(v), high.max(v)),
        );
        let bins = if high > low { bins } else { 1 };
        let width = (high - low) / bins as f64;
        let of = Array2::from_shape_fn(image.dim(), |at| {
            if !counts(at) {
                return NONE;
            }
            // 0 / 0 where there is one bin: index 0
            byte(index((image[at] - low) / width).min(bins - 1))
        });
        let centers = Grid::from_shape_fn((bins, 1), |(c, _)| low + (c as f64 + 0.5) * width);
        Self::new(of, centers, vec![width * width / 12.0])
    }

    /// By color, or any other channels: `count` clusters by k-means.
    ///
    /// Starts are spread with chances in proportion to the squared distance from those there are (k-means++), from a fixed seed, so
    /// the same channels always give the same classes. Learns from at most 16384 pixels, evenly taken. Channels weigh by
    /// their own spread: scale them first if they should weigh alike. O(pixels · classes · channels).
    ///
    /// \[lloyd82\], \[arthur07\]
    ///
    /// # Errors
    /// No channels, channels of different shapes, none or too many classes, no pixel that counts in all channels.
    pub fn clusters(channels: &[MaskedImage], count: usize) -> Result<Self, FieldError> {
        reasonable("classes", count)?;
        let first = channels.first().ok_or(FieldError::Empty {
            width: 0,
            height: 0,
        })?;
        let dim = first.image().dim();
        for channel in channels {
            let second = channel.image().dim();
            if second != dim {
                return Err(FieldError::ShapesDiffer { first: dim, second });
            }
        }
        let counts = |at: (usize, usize)| {
            channels
                .iter()
                .all(|channel| channel.valid().is_none_or(|valid| valid[at]))
        };
        let pixels: Vec<(usize, usize)> = first
            .image()
            .indexed_iter()
            .map(|(at, _)| at)
            .filter(|&at| counts(at))
            .collect();
        if pixels.is_empty() {
            let (height, width) = dim;
            return Err(FieldError::NothingValid { width, height });
        }
        let every = pixels.len().div_ceil(16_384);
        let sample: Vec<Vec<f64>> = pixels
            .iter()
            .step_by(every)
            .map(|&at| channels.iter().map(|c| c.image()[at]).collect())
            .collect();
        let (centers, within) = super::cluster::k_means(&sample, count);
        let mut of = Array2::from_elem(dim, NONE);
        let mut point = vec![0.0; channels.len()];
        for at in pixels {
            for (v, channel) in point.iter_mut().zip(channels) {
                *v = channel.image()[at];
            }
            of[at] = byte(super::cluster::nearest(&centers, &point).0);
        }
        Self::new(of, centers, within)
    }

    fn new(of: Array2<u8>, centers: Grid, within: Vec<f64>) -> Result<Self, FieldError> {
        let classes = centers.nrows();
        fits(of.len(), classes)?;
        let blocks = of.ncols().div_ceil(STRIDE);
        let mut counts = Vec::with_capacity(of.nrows() * blocks * classes);
        let mut total = vec![0.0; classes];
        for row in of.rows() {
            let mut seen = vec![0_u32; classes];
            for (x, &class) in row.iter().enumerate() {
                if x % STRIDE == 0 {
                    counts.extend_from_slice(&seen);
                }
                if class != NONE {
                    seen[usize::from(class)] += 1;
                }
            }
            for (total, &seen) in total.iter_mut().zip(&seen) {
                *total += f64::from(seen);
            }
        }
        // nothing may be infinitely likely, not even where a class is one value
        let scale = centers.iter().fold(1e-100, |s: f64, c| s.max(c.abs()));
        let within = within
            .iter()
            .map(|v| v.max(1e-12 * scale * scale))
            .collect();
        Ok(Self {
            data: Arc::new(Counted {
                of,
                centers,
                within,
                counts,
                total,
            }),
        })
    }

    /// How many classes there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.data.centers.nrows()
    }

    /// Never: there is always a class.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The center of each class: one row a class, one column a channel.
    #[must_use]
    pub fn centers(&self) -> &Grid {
        &self.data.centers
    }

    /// The class of a pixel; `None` if it does not count or lies outside.
    #[must_use]
    pub fn of(&self, column: usize, row: usize) -> Option<usize> {
        let class = *self.data.of.get([row, column])?;
        (class != NONE).then_some(usize::from(class))
    }
}

impl Counted {
    pub(super) fn centers(&self) -> &Grid {
        &self.centers
    }

    pub(super) fn within(&self) -> &[f64] {
        &self.within
    }

    pub(super) fn total(&self) -> &[f64] {
        &self.total
    }

    /// Pixels of each class inside a closed polygon of either orientation, cut ones by their share.
    ///
    /// O(pixels crossed · classes).
    pub(super) fn inside(&self, polygon: &[DVec2], inside: &mut [f64]) {
        inside.fill(0.0);
        let (height, width) = self.of.dim();
        let (classes, blocks) = (self.centers.nrows(), width.div_ceil(STRIDE));
        walk(polygon, (height, width), |row, x, weight| {
            let column = index(x).min(width - 1);
            let block = column / STRIDE;
            let from = (row * blocks + block) * classes;
            for (inside, &count) in inside.iter_mut().zip(&self.counts[from..from + classes]) {
                *inside += weight * f64::from(count);
            }
            for k in block * STRIDE..=column {
                let class = self.of[[row, k]];
                if class != NONE {
                    inside[usize::from(class)] += weight * (x - k as f64).min(1.0);
                }
            }
        });
        let sign = if inside.iter().sum::<f64>() < 0.0 {
            -1.0
        } else {
            1.0
        };
        // shares are good to some 1e-12 of a row
        for (inside, total) in inside.iter_mut().zip(&self.total) {
            *inside = (sign * *inside).clamp(0.0, *total);
        }
    }

    /// A number of each class, bilinear between the pixels around a point; 0 where none counts.
    pub(super) fn at(&self, p: DVec2, table: &[f64]) -> f64 {
        corners(p, self.of.dim())
            .iter()
            .map(|&(at, weight)| {
                table
                    .get(usize::from(self.of[at]))
                    .map_or(0.0, |v| weight * v)
            })
            .sum()
    }
}

/// Refuses counts that would take too much memory.
fn fits(pixels: usize, classes: usize) -> Result<(), FieldError> {
    let value = pixels as f64 * (1.0 + 4.0 * classes as f64 / STRIDE as f64);
    if value > MOST_CLASS_BYTES {
        return Err(FieldError::TooMuch {
            name: "bytes for the counts of classes",
            value,
            most: MOST_CLASS_BYTES,
        });
    }
    Ok(())
}

fn reasonable(name: &'static str, count: usize) -> Result<(), FieldError> {
    let value = count as f64;
    if count == 0 {
        return Err(FieldError::NotPositive { name, value });
    }
    if count > MOST_CLASSES {
        let most = MOST_CLASSES as f64;
        return Err(FieldError::TooMuch { name, value, most });
    }
    Ok(())
}

#[expect(clippy::cast_possible_truncation, reason = "at most MOST_CLASSES")]
fn byte(class: usize) -> u8 {
    class as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::region::rows::RowSums;
    use crate::region::tests::circle;
    use proptest::prelude::*;

    fn texture(height: usize, width: usize) -> Grid {
        Grid::from_shape_fn((height, width), |(y, x)| {
            ((x * 37 + y * 91 + x * y * 3) % 101) as f64
        })
    }

    proptest! {
        #[test]
        fn each_class_is_counted_as_a_picture_of_its_own(
            (x, y) in (0.0..70.0_f64, 0.0..25.0_f64), radius in 1.0..20.0_f64, bins in 1_usize..9,
        ) {
            let image = texture(25, 70);
            let picture = MaskedImage::whole(&image).unwrap();
            let classes = Classes::grey(&picture, bins).unwrap();
            let polygon = circle(DVec2::new(x, y), radius, 17);
            let mut inside = vec![0.0; bins];
            classes.data.inside(&polygon, &mut inside);
            for c in 0..bins {
                // the corner pixel, class 0, is what a picture's sums are counted from
                let own = Grid::from_shape_fn((25, 70), |(v, u)| {
                    f64::from(u8::from(classes.of(u, v) == Some(c)))
                });
                let rows = RowSums::new(&MaskedImage::whole(&own).unwrap());
                let sums = rows.inside(&polygon);
                let slow = sums.sum + rows.offset * sums.area;
                prop_assert!((inside[c] - slow).abs() < 1e-9, "{} {}", inside[c], slow);
            }
        }
    }

    #[test]
    fn bins_have_equal_width_and_clusters_find_the_colors() {
        let ramp = Grid::from_shape_fn((1, 100), |(_, x)| x as f64);
        let classes = Classes::grey(&MaskedImage::whole(&ramp).unwrap(), 4).unwrap();
        let of: Vec<_> = [0, 24, 25, 50, 75, 99].map(|x| classes.of(x, 0)).into();
        assert_eq!(of, [0, 0, 1, 2, 3, 3].map(Some));
        assert!((classes.centers()[[1, 0]] - 37.125).abs() < 1e-12);
        let (red, green) = (
            Grid::from_shape_fn((20, 20), |(_, x)| if x < 10 { 200.0 } else { 20.0 }),
            Grid::from_shape_fn((20, 20), |(y, _)| if y < 5 { 150.0 } else { 30.0 }),
        );
        let channels = [red, green].map(|g| MaskedImage::whole(&g).unwrap());
        let classes = Classes::clusters(&channels, 4).unwrap();
        for ((y, x), red) in channels[0].image().indexed_iter() {
            let class = classes.of(x, y).unwrap();
            let center = classes.centers().row(class);
            assert!((center[0] - red).abs() < 1e-9);
            assert!((center[1] - channels[1].image()[[y, x]]).abs() < 1e-9);
        }
        // no more classes than there are colors
        assert_eq!(Classes::clusters(&channels, 20).unwrap().len(), 4);
        assert_eq!(classes, Classes::clusters(&channels, 4).unwrap());
    }

    #[test]
    fn too_many_too_few_and_what_does_not_fit_are_refused() {
        let picture = MaskedImage::whole(&texture(5, 5)).unwrap();
        assert!(Classes::grey(&picture, 0).is_err() && Classes::grey(&picture, 65).is_err());
        assert!(Classes::clusters(&[], 3).is_err());
        let other = MaskedImage::whole(&texture(5, 6)).unwrap();
        assert!(Classes::clusters(&[picture.clone(), other], 3).is_err());
        let [left, right] = [true, false].map(|left| {
            let valid = Array2::from_shape_fn((5, 5), |(_, x)| (x < 2) == left);
            MaskedImage::new(&texture(5, 5), &valid).unwrap()
        });
        assert!(matches!(
            Classes::clusters(&[left, right], 3),
            Err(FieldError::NothingValid { .. })
        ));
        let error = fits(1 << 32, 32).unwrap_err();
        assert_eq!(
            error.to_string(),
            "bytes for the counts of classes must be at most 8589934592, got 38654705664"
        );
    }
}
