//! Outlines as an image of labels.

use glam::DVec2;
use ndarray::Array2;

use crate::{Measures, filled};

/// Each object's pixels with its number, 0 elsewhere. A pixel of two objects belongs to the one with the nearer
/// centroid; of two as near, to the first. An outline without area has none.
///
/// ```
/// use glam::DVec2;
///
/// let square = |x: f64| [(0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (0.0, 3.0)]
///     .map(|corner| DVec2::from(corner) + DVec2::new(x - 0.5, -0.5)).to_vec();
/// let labels = score::tracking::labelled(&[(7, square(0.0)), (9, square(2.0))], (3, 6));
/// assert_eq!(labels.row(1).to_vec(), [7, 7, 7, 9, 9, 0]);
/// ```
#[must_use]
pub fn labelled(outlines: &[(u32, Vec<DVec2>)], size: (usize, usize)) -> Array2<u32> {
    let mut labels = Array2::zeros(size);
    let mut near = Array2::from_elem(size, f64::INFINITY);
    for (id, ring) in outlines {
        let Ok(measures) = Measures::of(&[ring]) else {
            continue;
        };
        // only as much as it takes
        let corner = measures.low.floor().max(DVec2::ZERO);
        let [rows, columns] = [
            within(corner.y, measures.high.y, size.0),
            within(corner.x, measures.high.x, size.1),
        ];
        let moved: Vec<DVec2> = ring.iter().map(|p| *p - corner).collect();
        let mask = filled(&[moved], (rows.len(), columns.len()));
        for ((y, x), _) in mask.indexed_iter().filter(|(_, inside)| **inside) {
            let (y, x) = (y + rows.start, x + columns.start);
            let far = measures.centroid.distance(DVec2::new(x as f64, y as f64));
            if far < near[[y, x]] {
                near[[y, x]] = far;
                labels[[y, x]] = *id;
            }
        }
    }
    labels
}

/// The rows or columns from one place to another that there are.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "cut to the picture before"
)]
fn within(low: f64, high: f64, count: usize) -> std::ops::Range<usize> {
    let cut = |at: f64| at.clamp(0.0, count as f64) as usize;
    let (low, high) = (cut(low), cut(high.ceil() + 1.0));
    low..high.max(low)
}
