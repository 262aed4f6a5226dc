//! Places that may be in the middle of an object, over all sizes.

use field::Grid;
use glam::DVec2;
use search::whole::blurred;

/// A place in the middle of a blob, in the pixels of the grid it was found in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Blob {
    pub center: DVec2,
    /// Radius of the disk that would answer most.
    pub radius: f64,
    /// How much lighter it is than its surroundings; below 0 for a dark one.
    pub height: f64,
}

/// Radii of disks grow by this factor from one size to the next.
pub(crate) const GROWTH: f64 = 1.26;

/// A blob of one size counts if one of the next size at its place is not higher than it by more than this.
const CLOSE: f64 = 0.85;

/// A blob's height counts from this many standard deviations on that noise gives it.
const NOISE: f64 = 4.0;

/// And from this share of the highest hundredth on.
const LOW: f64 = 0.05;

/// Local extremes of the difference of two Gaussians (the Laplacian's normalised answer over scales, after Lindeberg,
/// 1998), for each of some radii, in rows.
pub(crate) fn blobs(grid: &Grid, radii: &[f64], noise: f64) -> Vec<Blob> {
    let (height, width) = grid.dim();
    let mut out = Vec::new();
    // one more on either side, so that each has neighbours
    let (Some(first), Some(last)) = (radii.first(), radii.last()) else {
        return out;
    };
    let ends = [first / GROWTH, last * GROWTH, last * GROWTH * GROWTH];
    let all = [&ends[..1], radii, &ends[1..]].concat();
    let smooth = all
        .iter()
        .map(|radius| blurred(grid, radius / std::f64::consts::SQRT_2));
    let smooth: Vec<Grid> = smooth.collect();
    let answers: Vec<Grid> = smooth.windows(2).map(|pair| &pair[0] - &pair[1]).collect();
    for (at, &radius) in radii.iter().enumerate() {
        let narrow = radius / std::f64::consts::SQRT_2;
        let (below, answer, above) = (&answers[at], &answers[at + 1], &answers[at + 2]);
        let spread = spread_of_noise(narrow, GROWTH * narrow) * noise;
        let mut extremes = Vec::new();
        for y in 0..height {
            for x in 0..width {
                let own = answer[[y, x]];
                let beside = (below[[y, x]] * own.signum()).max(above[[y, x]] * own.signum());
                if own.abs() <= NOISE * spread || own.abs() < CLOSE * beside {
                    continue;
                }
                let rows = y.saturating_sub(1)..(y + 2).min(height);
                let columns = x.saturating_sub(1)..(x + 2).min(width);
                let mut around = rows.flat_map(|j| columns.clone().map(move |i| (j, i)));
                // of equals the first
                let is_extreme = around.all(|(j, i)| {
                    let (a, b) = (own.abs(), answer[[j, i]] * own.signum());
                    if (j, i) < (y, x) { a > b } else { a >= b }
                });
                if is_extreme {
                    extremes.push(Blob {
                        center: DVec2::new(x as f64, y as f64),
                        radius,
                        height: own,
                    });
                }
            }
        }
        out.append(&mut extremes);
    }
    let mut heights: Vec<f64> = out.iter().map(|blob| blob.height.abs()).collect();
    let least = LOW * search::whole::quantile(&mut heights, 0.99);
    out.retain(|blob| blob.height.abs() > least);
    out
}

/// Standard deviation that white noise of 1 has in the difference of two Gaussians.
fn spread_of_noise(a: f64, b: f64) -> f64 {
    let both = |sum: f64| (std::f64::consts::TAU * sum).recip();
    (both(2.0 * a * a) + both(2.0 * b * b) - 2.0 * both(a * a + b * b))
        .max(0.0)
        .sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disk_answers_most_at_its_own_radius_and_in_its_middle() {
        let center = DVec2::new(40.0, 33.0);
        for (inside, outside) in [(200.0, 60.0), (60.0, 200.0)] {
            let disk = |p: DVec2| p.distance(center) <= 12.0;
            let grid = field::drawn::covered((70, 80), disk, (inside, outside));
            let found = blobs(&grid, &[6.0, 7.5, 9.5, 12.0, 15.0, 19.0], 0.0);
            let best = found
                .iter()
                .max_by(|a, b| a.height.abs().total_cmp(&b.height.abs()))
                .unwrap();
            assert!(
                (best.radius - 12.0).abs() < 3.5 && best.center.distance(center) < 1.0,
                "{best:?}"
            );
            assert_eq!(best.height > 0.0, inside > outside);
        }
    }

    #[test]
    fn noise_has_no_blobs_beyond_its_own_spread() {
        let flat = field::drawn::noisy(&Grid::from_elem((120, 120), 100.0), 5.0, 3);
        let none = blobs(&flat, &[8.0], 5.0);
        assert!(none.len() < 3, "{none:?}");
    }
}
