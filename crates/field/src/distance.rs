//! Distance to the nearest edge, exact and in linear time, and the force that falls with it.

use crate::edge::{EdgeForce, edge_stages, gradient_force};
use crate::error::{FieldError, positive};
use crate::force_field::ForceField;
use crate::grid::Grid;
use crate::smooth::Smoothing;
use ndarray::Array2;

/// Squared Euclidean distance of every pixel to the nearest pixel that is `true`; infinite if there is none.
///
/// ```
/// use field::squared_distance;
/// let edges = ndarray::array![[true, false, false], [false, false, false]];
/// assert_eq!(squared_distance(&edges), ndarray::array![[0.0, 1.0, 4.0], [1.0, 2.0, 5.0]]);
/// ```
///
/// Exact: whole numbers. O(pixels): the lower envelope of parabolas along columns, then along rows.
///
/// \[felzenszwalb12\]
#[must_use]
pub fn squared_distance(edges: &Array2<bool>) -> Grid {
    let mut distance = edges.mapv(|edge| if edge { 0.0 } else { f64::INFINITY });
    let mut envelope = Envelope::default();
    for mut column in distance.columns_mut() {
        let line = column.to_vec();
        envelope.transform(&line, |i, d, _| column[i] = d);
    }
    for mut row in distance.rows_mut() {
        let line = row.to_vec();
        envelope.transform(&line, |i, d, _| row[i] = d);
    }
    distance
}

/// The parabolas that are lowest somewhere, and where each begins to be.
#[derive(Debug, Default)]
pub(crate) struct Envelope {
    vertex: Vec<usize>,
    from: Vec<f64>,
}

impl Envelope {
    /// `put(x, min over q of line[q] + (x − q)², the q)` for every x.
    pub(crate) fn transform(
        &mut self,
        line: &[f64],
        mut put: impl FnMut(usize, f64, Option<usize>),
    ) {
        let (vertex, from) = (&mut self.vertex, &mut self.from);
        vertex.clear();
        from.clear();
        for (q, &height) in line.iter().enumerate() {
            if height.is_infinite() {
                continue;
            }
            let mut start = f64::NEG_INFINITY;
            while let (Some(&v), Some(&began)) = (vertex.last(), from.last()) {
                // where the new parabola meets the last one: v < q, and all numbers are whole
                let (a, b) = (q as f64, v as f64);
                start = (height - line[v] + a * a - b * b) / (2.0 * (a - b));
                if start > began {
                    break;
                }
                vertex.pop();
                from.pop();
                start = f64::NEG_INFINITY;
            }
            vertex.push(q);
            from.push(start);
        }
        let mut k = 0;
        for x in 0..line.len() {
            while from.get(k + 1).is_some_and(|&next| next < x as f64) {
                k += 1;
            }
            let vertex = vertex.get(k).copied();
            let distance = vertex.map_or(f64::INFINITY, |v| {
                let d = x as f64 - v as f64;
                line[v] + d * d
            });
            put(x, distance, vertex);
        }
    }
}

/// The pixels on edges: where |∇(G ∗ I)| is at least `threshold` and largest across the edge.
///
/// Each pixel is compared with its two neighbours along the axis its gradient is closer to. Thin, to the pixel.
///
/// \[canny86\], without the hysteresis.
///
/// # Errors
/// A `threshold` that is not above 0, what [`edge_force`](crate::edge_force) refuses.
pub fn edge_pixels(
    image: &Grid,
    smoothing: Smoothing,
    threshold: f64,
) -> Result<Array2<bool>, FieldError> {
    positive("threshold", threshold)?;
    let stages = edge_stages(
        image,
        &EdgeForce {
            smoothing,
            gain: 1.0,
        },
    )?;
    let (height, width) = stages.strength.dim();
    Ok(Array2::from_shape_fn((height, width), |(y, x)| {
        let here = stages.strength[[y, x]];
        let (before, after) = if stages.gradient_x[[y, x]].abs() >= stages.gradient_y[[y, x]].abs()
        {
            ([y, x.saturating_sub(1)], [y, (x + 1).min(width - 1)])
        } else {
            ([y.saturating_sub(1), x], [(y + 1).min(height - 1), x])
        };
        // two equal pixels: the first counts
        here >= threshold && here > stages.strength[before] && here >= stages.strength[after]
    }))
}

/// A force towards the nearest edge from anywhere: `gain` times minus the gradient of the distance.
///
/// ```text
/// E = gain · min(d, reach)        F = −∇E
/// ```
///
/// A pull of constant strength `gain` that ends `reach` pixels away (infinite reach is fine), zero without edges.
/// Halfway between edges it turns round abruptly. O(pixels).
///
/// \[cohen93\]
///
/// # Errors
/// No pixels; a `gain` or `reach` that is not above 0.
pub fn distance_force(
    edges: &Array2<bool>,
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
    let (height, width) = edges.dim();
    // farther than any pixel: stands for "no edge at all", and is flat
    let most = reach.min((height + width) as f64);
    let distance = squared_distance(edges).mapv(|d| d.sqrt().min(most));
    gradient_force(&distance, -gain)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use proptest::prelude::*;

    fn slow(edges: &Array2<bool>) -> Grid {
        Grid::from_shape_fn(edges.dim(), |(y, x)| {
            let to = |(v, u): (usize, usize)| (v.abs_diff(y).pow(2) + u.abs_diff(x).pow(2)) as f64;
            edges
                .indexed_iter()
                .filter(|(_, edge)| **edge)
                .map(|(at, _)| to(at))
                .fold(f64::INFINITY, f64::min)
        })
    }

    proptest! {
        #[test]
        fn every_distance_is_the_slow_twins_exactly(
            (height, width) in (1_usize..14, 1_usize..14), seed in any::<u64>(), sparse in 1_u64..30,
        ) {
            let mut state = seed;
            let edges = Array2::from_shape_simple_fn((height, width), || {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (state >> 33) % sparse == 0
            });
            prop_assert_eq!(squared_distance(&edges), slow(&edges));
        }
    }

    #[test]
    fn no_edges_are_infinitely_far_and_pull_nothing() {
        let none = Array2::from_elem((4, 5), false);
        assert!(squared_distance(&none).iter().all(|d| d.is_infinite()));
        assert!(distance_force(&none, 1.0, f64::INFINITY).unwrap().largest() <= 0.0);
    }

    #[test]
    fn the_pull_is_even_and_ends_at_its_reach() {
        let edges = Array2::from_shape_fn((9, 80), |(_, x)| x == 20);
        let field = distance_force(&edges, 3.0, 30.0).unwrap();
        for x in [2.0, 10.0, 17.0] {
            assert!((field.at(DVec2::new(x, 4.0)) - DVec2::new(3.0, 0.0)).length() < 1e-12);
        }
        for x in [23.0, 40.0, 48.0] {
            assert!((field.at(DVec2::new(x, 4.0)) - DVec2::new(-3.0, 0.0)).length() < 1e-12);
        }
        assert!(field.at(DVec2::new(60.0, 4.0)).length() < 1e-12);
        assert!(
            distance_force(&edges, 3.0, 0.0).is_err()
                && distance_force(&edges, f64::NAN, 9.0).is_err()
        );
        assert!(distance_force(&Array2::from_elem((0, 0), true), 1.0, 9.0).is_err());
    }

    #[test]
    fn edges_are_one_pixel_thin() {
        let step = Grid::from_shape_fn((7, 20), |(_, x)| if x >= 10 { 80.0 } else { 0.0 });
        let edges = edge_pixels(&step, Smoothing::Binomial(4), 5.0).unwrap();
        for row in edges.rows() {
            assert_eq!(row.iter().filter(|edge| **edge).count(), 1);
            assert!(row[9]);
        }
        let turned = edge_pixels(&step.t().to_owned(), Smoothing::Binomial(4), 5.0).unwrap();
        assert_eq!(turned, edges.t());
        let flat = edge_pixels(&Grid::from_elem((5, 5), 3.0), Smoothing::Binomial(4), 1.0).unwrap();
        assert!(flat.iter().all(|edge| !edge));
        assert!(edge_pixels(&step, Smoothing::Binomial(4), 0.0).is_err());
    }
}
