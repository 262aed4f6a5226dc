//! Distances along normals, and whether the errors that were stated cover them.

use crate::mask::edges;
use glam::DVec2;

/// How far the true outline is from a point along the line of a unit normal, positive along it; None if it does not
/// meet the line within `reach` of the point.
///
/// Of several crossings the nearest counts. O(edges).
///
/// ```
/// use glam::DVec2;
///
/// let square = [DVec2::ZERO, DVec2::new(10.0, 0.0), DVec2::splat(10.0), DVec2::new(0.0, 10.0)];
/// let distance = score::along_normal(DVec2::new(8.5, 4.0), DVec2::X, &[square], 5.0);
/// assert_eq!(distance, Some(1.5));
/// ```
#[must_use]
pub fn along_normal<R: AsRef<[DVec2]>>(
    point: DVec2,
    normal: DVec2,
    truth: &[R],
    reach: f64,
) -> Option<f64> {
    let mut nearest: Option<f64> = None;
    for (a, b) in truth.iter().flat_map(|ring| edges(ring.as_ref())) {
        // in a frame in which the normal is the first axis
        let (a, b) = (a - point, b - point);
        let (side_a, side_b) = (normal.perp_dot(a), normal.perp_dot(b));
        if (side_a > 0.0) == (side_b > 0.0) {
            continue;
        }
        let share = side_a / (side_a - side_b);
        let at = normal.dot(a + (b - a) * share);
        if at.abs() <= reach && nearest.is_none_or(|known| at.abs() < known.abs()) {
            nearest = Some(at);
        }
    }
    nearest
}

/// The share of the errors that lie within `k` of their standard errors; None without a pair of numbers.
///
/// Of errors that are normal and honestly stated, 68.3 % lie within one, 95 % within 1.96. A pair of which one is not
/// finite does not count.
///
/// ```
/// assert_eq!(score::calibration(&[0.1, -0.3, 0.5, -0.1], &[0.2, 0.2, 0.2, 0.1], 1.96), Some(0.75));
/// ```
#[must_use]
pub fn calibration(errors: &[f64], standard_errors: &[f64], k: f64) -> Option<f64> {
    let (mut within, mut all) = (0_usize, 0_usize);
    for (error, standard) in errors.iter().zip(standard_errors) {
        if error.is_finite() && standard.is_finite() {
            within += usize::from(error.abs() <= k * standard);
            all += 1;
        }
    }
    (all > 0).then(|| within as f64 / all as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn from_within_a_circle_the_distance_is_that_of_the_formula() {
        let turn = |i: i32| DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / 3000.0);
        let circle: Vec<DVec2> = (0..3000).map(|i| 20.0 * turn(i)).collect();
        for angle in [0.0, 0.4, 1.9, 3.0, 5.5] {
            let (point, normal) = (DVec2::new(3.0, -4.0), DVec2::from_angle(angle));
            // |p + t n| = 20
            let along = point.dot(normal);
            let root = (along * along + 400.0 - 25.0).sqrt();
            let (front, behind) = (root - along, -root - along);
            let exact = if front < -behind { front } else { behind };
            let got = along_normal(point, normal, &[&circle], 100.0).unwrap();
            assert!((got - exact).abs() < 1e-4, "{got} {exact}");
            assert_eq!(along_normal(point, normal, &[&circle], 10.0), None);
        }
    }

    #[test]
    fn what_is_not_a_number_does_not_count() {
        assert_eq!(calibration(&[], &[], 2.0), None);
        assert_eq!(calibration(&[f64::NAN], &[1.0], 2.0), None);
        assert_eq!(calibration(&[f64::NAN, 1.0], &[1.0, 1.0], 1.0), Some(1.0));
    }
}
