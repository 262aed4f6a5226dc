//! k-means, the same every time.

use crate::grid::Grid;

/// The most rounds of moving the centers: they hardly change after a dozen.
const ROUNDS: usize = 30;

/// Centers (one a row, none of them without points) and the variance of each channel within a cluster.
pub(super) fn k_means(points: &[Vec<f64>], count: usize) -> (Grid, Vec<f64>) {
    let channels = points.first().map_or(0, Vec::len);
    let mut centers = starts(points, count);
    for _ in 0..ROUNDS {
        let mut sums = Grid::zeros(centers.dim());
        let mut sizes = vec![0.0; centers.nrows()];
        for point in points {
            let (c, _) = nearest(&centers, point);
            sizes[c] += 1.0;
            for (sum, v) in sums.row_mut(c).iter_mut().zip(point) {
                *sum += v;
            }
        }
        let full: Vec<usize> = (0..sizes.len()).filter(|&c| sizes[c] > 0.0).collect();
        let moved = Grid::from_shape_fn((full.len(), channels), |(k, j)| {
            sums[[full[k], j]] / sizes[full[k]]
        });
        if moved == centers {
            break;
        }
        centers = moved;
    }
    let mut within = vec![0.0; channels];
    for point in points {
        let (c, _) = nearest(&centers, point);
        for ((sum, v), center) in within.iter_mut().zip(point).zip(centers.row(c)) {
            *sum += (v - center) * (v - center);
        }
    }
    let within = within.iter().map(|v| v / points.len() as f64).collect();
    (centers, within)
}

/// The nearest center and its squared distance; the first of equals.
pub(super) fn nearest(centers: &Grid, point: &[f64]) -> (usize, f64) {
    let mut best = (0, f64::INFINITY);
    for (c, center) in centers.rows().into_iter().enumerate() {
        let distance: f64 = center
            .iter()
            .zip(point)
            .map(|(a, b)| (a - b) * (a - b))
            .sum();
        if distance < best.1 {
            best = (c, distance);
        }
    }
    best
}

/// k-means++: each start is a point drawn with a chance in proportion to its squared distance from those before.
fn starts(points: &[Vec<f64>], count: usize) -> Grid {
    let channels = points.first().map_or(0, Vec::len);
    let mut chosen = vec![0];
    let mut away = vec![f64::INFINITY; points.len()];
    while let Some(&last) = chosen.last() {
        for (away, point) in away.iter_mut().zip(points) {
            let distance = point.iter().zip(&points[last]);
            *away = away.min(distance.map(|(a, b)| (a - b) * (a - b)).sum());
        }
        let total: f64 = away.iter().sum();
        if chosen.len() == count || total <= 0.0 {
            break;
        }
        let mut left = chance(chosen.len() as u64) * total;
        let next = away.iter().position(|d| {
            left -= d;
            left < 0.0
        });
        // rounding may leave a rest behind the last
        chosen.push(next.unwrap_or(points.len() - 1));
    }
    Grid::from_shape_fn((chosen.len(), channels), |(c, j)| points[chosen[c]][j])
}

/// The n-th number of splitmix64 from 0, in [0, 1).
fn chance(n: u64) -> f64 {
    let mut z = n.wrapping_mul(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 / 2.0_f64.powi(53)
}
