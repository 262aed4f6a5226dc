//! Distance to the nearest of many points that lie anywhere between pixels.
//!
//! Not here yet: distance to the lines between them.

use crate::distance::Envelope;
use crate::edge::gradient_force;
use crate::error::{FieldError, positive};
use crate::force_field::ForceField;
use crate::grid::Grid;
use glam::DVec2;
use ndarray::Array2;

/// No point.
const NONE: usize = usize::MAX;

/// Distance of every pixel of a grid of `(rows, columns)` to the nearest point; infinite if there is none.
///
/// ```
/// use field::distance_to_points;
/// use glam::DVec2;
/// let distance = distance_to_points(&[DVec2::new(0.25, 0.0)], (1, 3));
/// assert_eq!(distance, ndarray::array![[0.25, 0.75, 1.75]]);
/// ```
///
/// The nearest pixel that has a point is found exactly and in linear time; then the points of it and of the pixels around it are
/// compared, and those that pixels hear of from their neighbors. So the distance is that to one of the points, at most √2 px beyond the least,
/// and for chains of edge points within 0.1 px of it (both tested). Of several points in a pixel one counts; points off the
/// grid or that are no places do not. O(pixels).
///
/// \[felzenszwalb12\]
#[must_use]
pub fn distance_to_points(points: &[DVec2], (height, width): (usize, usize)) -> Grid {
    let mut at = Array2::from_elem((height, width), NONE);
    for (i, p) in points.iter().enumerate() {
        if let Some(pixel) = pixel_of(*p, (height, width)) {
            at[pixel] = i;
        }
    }
    let nearest = nearest_pixel(&at);
    let mut best = Array2::from_shape_fn((height, width), |(y, x)| {
        let p = DVec2::new(x as f64, y as f64);
        let mut best = (f64::INFINITY, NONE);
        // those of the nearest pixel that has one, and of the pixels around that
        if let Some((v, u)) = nearest[[y, x]] {
            for row in v.saturating_sub(1)..(v + 2).min(height) {
                for column in u.saturating_sub(1)..(u + 2).min(width) {
                    take(&mut best, p, points, at[[row, column]]);
                }
            }
        }
        best
    });
    // what is nearest to a neighbor may be nearest here: to and fro, so that it is handed on
    let mut hear = |y: usize, x: usize| {
        let p = DVec2::new(x as f64, y as f64);
        let mut own = best[[y, x]];
        for row in y.saturating_sub(1)..(y + 2).min(height) {
            for column in x.saturating_sub(1)..(x + 2).min(width) {
                take(&mut own, p, points, best[[row, column]].1);
            }
        }
        best[[y, x]] = own;
    };
    (0..height).for_each(|y| (0..width).for_each(|x| hear(y, x)));
    (0..height)
        .rev()
        .for_each(|y| (0..width).rev().for_each(|x| hear(y, x)));
    best.mapv(|(distance, _)| distance)
}

/// A force towards the nearest point from anywhere: `gain` times minus the gradient of the distance.
///
/// ```text
/// E = gain · min(d, reach)        F = −∇E
/// ```
///
/// As [`distance_force`](crate::distance_force) for points between pixels, such as those of [`edge_points`](crate::edge_points): along an edge of
/// such points it turns round where they are.
///
/// \[cohen93\]
///
/// # Errors
/// No pixels; a `gain` or `reach` that is not above 0.
pub fn point_distance_force(
    points: &[DVec2],
    dim: (usize, usize),
    gain: f64,
    reach: f64,
) -> Result<ForceField, FieldError> {
    positive("gain", gain)?;
    if reach.is_nan() || reach <= 0.0 {
        return Err(FieldError::NotPositive {
            name: "reach",
            value: reach,
        });
    }
    // farther than any pixel: stands for "no point at all", and is flat
    let most = reach.min((dim.0 + dim.1) as f64);
    gradient_force(
        &distance_to_points(points, dim).mapv(|d| d.min(most)),
        -gain,
    )
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "inside the grid"
)]
fn pixel_of(p: DVec2, (height, width): (usize, usize)) -> Option<[usize; 2]> {
    let (x, y) = (p.x.round(), p.y.round());
    let inside = x >= 0.0 && y >= 0.0 && x < width as f64 && y < height as f64;
    inside.then_some([y as usize, x as usize])
}

fn take(best: &mut (f64, usize), p: DVec2, points: &[DVec2], i: usize) {
    if let Some(point) = points.get(i) {
        let distance = p.distance(*point);
        if distance < best.0 {
            *best = (distance, i);
        }
    }
}

/// For each pixel the nearest one, row and column, that has a point.
fn nearest_pixel(at: &Array2<usize>) -> Array2<Option<(usize, usize)>> {
    let mut envelope = Envelope::default();
    let mut row_of = Array2::from_elem(at.dim(), NONE);
    let mut distance = Grid::from_elem(at.dim(), f64::INFINITY);
    for (x, column) in at.columns().into_iter().enumerate() {
        let line: Vec<f64> = column
            .iter()
            .map(|&i| if i == NONE { f64::INFINITY } else { 0.0 })
            .collect();
        envelope.transform(&line, |y, d, vertex| {
            distance[[y, x]] = d;
            row_of[[y, x]] = vertex.unwrap_or(NONE);
        });
    }
    let mut nearest = Array2::from_elem(at.dim(), None);
    for (y, row) in distance.rows().into_iter().enumerate() {
        envelope.transform(&row.to_vec(), |x, _, vertex| {
            nearest[[y, x]] = vertex.map(|u| (row_of[[y, u]], u));
        });
    }
    nearest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawn::drawn;
    use crate::{Canny, edge_points};
    use proptest::prelude::*;

    fn slow(points: &[DVec2], dim: (usize, usize)) -> Grid {
        Grid::from_shape_fn(dim, |(y, x)| {
            let p = DVec2::new(x as f64, y as f64);
            let all = points.iter().map(|q| p.distance(*q));
            all.fold(f64::INFINITY, f64::min)
        })
    }

    proptest! {
        #[test]
        fn no_distance_is_less_than_the_least_nor_two_half_diagonals_more(
            (height, width) in (1_usize..16, 1_usize..16),
            places in proptest::collection::vec((0.0..1.0_f64, 0.0..1.0_f64), 0..12),
        ) {
            let mut points: Vec<DVec2> = Vec::new();
            for (u, v) in places {
                let p = DVec2::new(u * (width - 1) as f64, v * (height - 1) as f64);
                // one a pixel, as edge points are
                if points.iter().all(|q| q.round() != p.round()) {
                    points.push(p);
                }
            }
            let (quick, slow) = (distance_to_points(&points, (height, width)), slow(&points, (height, width)));
            for (quick, slow) in quick.iter().zip(&slow) {
                prop_assert!(quick >= slow && (quick - slow < 1.4143 || quick.to_bits() == slow.to_bits()), "{} {}", quick, slow);
            }
        }
    }

    #[test]
    fn the_edge_of_a_disc_is_as_far_as_it_is_and_pulls_to_where_it_is() {
        let (center, radius) = (DVec2::new(40.3, 38.8), 21.4);
        let disc = drawn(
            (80, 84),
            |p| p.distance(center) < radius,
            (180.0, 40.0),
            1.0,
        );
        let rule = Canny {
            sigma: 2.0,
            high: 10.0,
            low: 5.0,
        };
        let points: Vec<DVec2> = edge_points(&disc, &rule)
            .unwrap()
            .iter()
            .map(|edge| edge.position)
            .collect();
        assert!(points.len() > 100);
        let distance = distance_to_points(&points, disc.dim());
        for (quick, slow) in distance.iter().zip(&slow(&points, disc.dim())) {
            assert!((quick - slow).abs() < 0.1, "{quick} {slow}");
        }
        let field = point_distance_force(&points, disc.dim(), 2.0, f64::INFINITY).unwrap();
        for i in 0..60 {
            let out = DVec2::from_angle(f64::from(i) * 0.105);
            let outwards = |r: f64| field.at(center + r * out).dot(out);
            assert!(outwards(radius - 4.0) > 1.8 && outwards(radius + 4.0) < -1.8);
            let (mut low, mut high) = (radius - 2.0, radius + 2.0);
            for _ in 0..30 {
                let middle = 0.5 * (low + high);
                if outwards(middle) > 0.0 {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            // smoothing with σ draws a circle's edge in by σ²/2R = 0.09; between points a pixel apart the distance is no
            // straight line, which is worth a tenth
            assert!((low - radius).abs() < 0.25, "{}", low - radius);
        }
    }

    #[test]
    fn no_points_and_points_elsewhere_are_infinitely_far() {
        for points in [
            &[][..],
            &[DVec2::NAN, DVec2::new(-3.0, 1.0), DVec2::new(9.0, 0.0)],
        ] {
            let distance = distance_to_points(points, (4, 5));
            assert!(distance.iter().all(|d| d.is_infinite()));
            let field = point_distance_force(points, (4, 5), 1.0, f64::INFINITY);
            assert!(field.unwrap().largest() <= 0.0);
        }
        assert!(point_distance_force(&[], (0, 0), 1.0, 9.0).is_err());
        assert!(point_distance_force(&[], (3, 3), 0.0, 9.0).is_err());
        assert!(point_distance_force(&[], (3, 3), 1.0, f64::NAN).is_err());
    }
}
