//! Where objects are looked for: circles, points, labels, or wherever there are any.

use field::Pixels;
use glam::DVec2;
use ndarray::Array2;

/// A circle inside an object, of about half its size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    /// Its center, in the picture.
    pub center: DVec2,
    /// Its radius in pixels: half that of a disk of the object's area.
    pub radius: f64,
}

/// Where objects are looked for.
#[derive(Debug, Clone, PartialEq)]
pub enum Seeds {
    /// A circle inside each.
    Circles(Vec<Circle>),
    /// A place in each, of unknown size.
    Points(Vec<DVec2>),
    /// An image of labels that covers each roughly; 0 is the background.
    Labels(Array2<u32>),
    /// Wherever there are any.
    Auto,
}

/// What is wrong with seeds or a picture.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SeedError {
    /// A center outside the picture, or a radius that is not above 0.
    #[error(
        "seed {number} has center ({x}, {y}) and radius {radius}; needed: a center in the picture, a radius above 0"
    )]
    Circle {
        /// Which one, from 1.
        number: usize,
        /// Its center.
        x: f64,
        /// Its center.
        y: f64,
        /// Its radius.
        radius: f64,
    },
    /// Labels of another size.
    #[error("labels must have {wanted:?} rows and columns as their picture, got {got:?}")]
    Size {
        /// Rows and columns of the picture.
        wanted: (usize, usize),
        /// Rows and columns of the labels.
        got: (usize, usize),
    },
}

impl Seeds {
    /// Refuse what cannot be looked at.
    pub(crate) fn check(&self, pixels: &dyn Pixels) -> Result<(), SeedError> {
        let (width, height) = pixels.size();
        let size = DVec2::new(width as f64, height as f64);
        let circle = |(at, center, radius): (usize, DVec2, f64)| {
            let within =
                (center + 0.5).cmpge(DVec2::ZERO).all() && (center + 0.5).cmple(size).all();
            if within && radius > 0.0 && radius.is_finite() {
                return Ok(());
            }
            Err(SeedError::Circle {
                number: at + 1,
                x: center.x,
                y: center.y,
                radius,
            })
        };
        match self {
            Self::Circles(list) => {
                let mut all = list.iter().enumerate();
                all.try_for_each(|(at, one)| circle((at, one.center, one.radius)))
            }
            Self::Points(list) => {
                let mut all = list.iter().enumerate();
                all.try_for_each(|(at, &center)| circle((at, center, 1.0)))
            }
            Self::Labels(labels) if labels.dim() != (height, width) => Err(SeedError::Size {
                wanted: (height, width),
                got: labels.dim(),
            }),
            Self::Labels(_) | Self::Auto => Ok(()),
        }
    }
}

/// A circle a label with half the size of its area, in the order of the labels; its center is the pixel of the label
/// that is nearest to the middle of all.
pub(crate) fn circles(labels: &Array2<u32>) -> Vec<Circle> {
    let mut sums = std::collections::BTreeMap::new();
    for ((y, x), &label) in labels.indexed_iter().filter(|(_, label)| **label > 0) {
        let (sum, count) = sums.entry(label).or_insert((DVec2::ZERO, 0.0));
        *sum += DVec2::new(x as f64, y as f64);
        *count += 1.0;
    }
    let mut nearest: std::collections::BTreeMap<u32, (f64, DVec2)> =
        std::collections::BTreeMap::new();
    for ((y, x), label) in labels.indexed_iter() {
        if let Some((sum, count)) = sums.get(label) {
            let p = DVec2::new(x as f64, y as f64);
            let far = p.distance_squared(*sum / *count);
            let best = nearest.entry(*label).or_insert((f64::INFINITY, p));
            if far < best.0 {
                *best = (far, p);
            }
        }
    }
    let both = sums.values().zip(nearest.values());
    both.map(|(&(sum, count), &(far, p))| Circle {
        center: if far < 1.0 { sum / count } else { p },
        radius: 0.5 * (count / std::f64::consts::PI).sqrt(),
    })
    .collect()
}
