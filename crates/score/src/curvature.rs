//! The least and the greatest curvature of a polygon that stands for a smooth curve.

use crate::ScoreError;
use crate::mask::edges;
use glam::DVec2;

/// The kernel reaches so many times its width; what is beyond is below 1e-8 of its height.
const REACH: f64 = 6.0;

/// The least and the greatest curvature of a closed polygon, smoothed along it by a Gaussian of this
/// width. Pixels⁻¹,
/// the width in pixels.
///
/// A polygon turns at its nodes only, by the angle from one edge to the next. Spread along the arc by the Gaussian the
/// angles become a smooth curvature,
///
/// ```text
/// κ(s) = Σ Δθ[i] G(s − s[i]),
/// ```
///
/// periodic in the length, whose integral is the whole turn, 2π of a polygon that does not cross itself. It does not
/// shrink what it smooths: of a circle it is 1 / R for any width well above the distance of the nodes. Positive where
/// the polygon bulges, whichever way round it runs. Looked at on nodes and halfway between. O(n + n ·
/// width / spacing).
///
/// ```
/// let circle: Vec<_> = (0..90).map(|i| 30.0 * glam::DVec2::from_angle(f64::from(i) * 4_f64.to_radians())).collect();
/// let [least, greatest] = score::curvature_extremes(&circle, 4.0)?;
/// assert!((least - 1.0 / 30.0).abs() < 1e-4 && (greatest - 1.0 / 30.0).abs() < 1e-4);
/// # Ok::<(), score::ScoreError>(())
/// ```
///
/// # Errors
///
/// A polygon without length or with nodes that are not finite; a width that is not above 0.
pub fn curvature_extremes(ring: &[DVec2], width: f64) -> Result<[f64; 2], ScoreError> {
    if width.is_nan() || width <= 0.0 {
        let (what, got) = ("the width of the smoothing", width);
        return Err(ScoreError::Negative { what, got });
    }
    let sides: Vec<DVec2> = edges(ring)
        .map(|(a, b)| b - a)
        .filter(|side| side.length_squared() > 0.0)
        .collect();
    let length: f64 = sides.iter().map(|side| side.length()).sum();
    if sides.len() < 3 || !length.is_finite() {
        return Err(ScoreError::Flat);
    }
    // where each side begins, and by how much the polygon turns there
    let (mut turns, mut arc) = (Vec::with_capacity(sides.len()), 0.0);
    let mut before = sides[sides.len() - 1];
    for &side in &sides {
        turns.push((arc, before.perp_dot(side).atan2(before.dot(side))));
        arc += side.length();
        before = side;
    }
    let whole: f64 = turns.iter().map(|turn| turn.1).sum();
    let sense = if whole < 0.0 { -1.0 } else { 1.0 };
    // once around, or more if the kernel is wider than the curve is long
    let around = (REACH * width / length).ceil();
    let smoothed = |s: f64| {
        let mut sum = 0.0;
        let mut add = |(at, angle): (f64, f64), lap: f64| {
            let u = (s - at - lap * length) / width;
            if u.abs() <= REACH {
                sum += angle * (-0.5 * u * u).exp();
            }
        };
        let mut lap = -around;
        while lap <= around {
            let (low, high) = (
                s - lap * length - REACH * width,
                s - lap * length + REACH * width,
            );
            let first = turns.partition_point(|turn| turn.0 < low);
            let near = turns[first..].iter().take_while(|turn| turn.0 <= high);
            near.for_each(|&turn| add(turn, lap));
            lap += 1.0;
        }
        sense * sum / (width * std::f64::consts::TAU.sqrt())
    };
    let mut extremes = [f64::INFINITY, f64::NEG_INFINITY];
    for (&(at, _), side) in turns.iter().zip(&sides) {
        for s in [at, at + 0.5 * side.length()] {
            let curvature = smoothed(s);
            extremes = [extremes[0].min(curvature), extremes[1].max(curvature)];
        }
    }
    Ok(extremes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    /// An ellipse about the origin.
    fn ellipse(a: f64, b: f64, n: u32) -> Vec<DVec2> {
        (0..n)
            .map(|i| DVec2::new(a, b) * DVec2::from_angle(f64::from(i) * TAU / f64::from(n)))
            .collect()
    }

    #[test]
    fn of_an_ellipse_they_are_those_at_the_ends_of_its_axes() {
        let (a, b) = (90.0, 40.0);
        let mut ring = ellipse(a, b, 2000);
        let [least, greatest] = curvature_extremes(&ring, 1.0).unwrap();
        let (flat, sharp) = (b / (a * a), a / (b * b));
        // smoothing changes it by σ² κ'' / 2, which at the sharp end is 3 e² κ³ σ² / 2 = 2e-4
        assert!((least - flat).abs() < 1e-5, "{least} {flat}");
        assert!((greatest - sharp).abs() < 3e-4, "{greatest} {sharp}");
        ring.reverse();
        let [back_least, back_greatest] = curvature_extremes(&ring, 1.0).unwrap();
        assert!((back_least - least).abs() < 1e-12 && (back_greatest - greatest).abs() < 1e-12);
    }

    #[test]
    fn a_corner_is_as_sharp_as_the_gaussian_makes_it() {
        let square = [
            DVec2::ZERO,
            DVec2::new(80.0, 0.0),
            DVec2::splat(80.0),
            DVec2::new(0.0, 80.0),
        ];
        let [least, greatest] = curvature_extremes(&square, 2.0).unwrap();
        let peak = PI / 2.0 / (2.0 * TAU.sqrt());
        assert!((greatest - peak).abs() < 1e-12, "{greatest} {peak}");
        assert!((0.0..1e-12).contains(&least), "{least}");
    }

    #[test]
    fn a_dent_curves_the_other_way() {
        // r = 30 (1 + 0.2 cos 4t): κ = (r² + 2 r'² − r r'') / (r² + r'²)^(3/2)
        let ring: Vec<DVec2> = (0..4000)
            .map(|i| {
                let t = f64::from(i) * TAU / 4000.0;
                30.0 * (1.0 + 0.2 * (4.0 * t).cos()) * DVec2::from_angle(t)
            })
            .collect();
        let [least, greatest] = curvature_extremes(&ring, 0.25).unwrap();
        let at = |r: f64, second: f64| (r * r - r * second) / r.powi(3);
        let (bump, dent) = (at(36.0, -96.0), at(24.0, 96.0));
        assert!(
            (greatest - bump).abs() < 0.01 * bump && (least - dent).abs() < 0.01 * dent.abs(),
            "{least} {greatest}"
        );
    }

    #[test]
    fn wider_than_the_curve_is_long_it_is_the_mean() {
        let ring = ellipse(9.0, 4.0, 200);
        let length: f64 = edges(&ring).map(|(a, b)| a.distance(b)).sum();
        let [least, greatest] = curvature_extremes(&ring, 100.0).unwrap();
        assert!((least - TAU / length).abs() < 1e-6 && (greatest - TAU / length).abs() < 1e-6);
    }

    #[test]
    fn what_does_not_turn_is_refused() {
        assert_eq!(
            curvature_extremes(&[DVec2::ZERO, DVec2::X], 1.0),
            Err(ScoreError::Flat)
        );
        assert_eq!(curvature_extremes(&[], 1.0), Err(ScoreError::Flat));
        assert_eq!(
            curvature_extremes(&[DVec2::ZERO, DVec2::NAN, DVec2::X], 1.0),
            Err(ScoreError::Flat)
        );
        assert!(curvature_extremes(&ellipse(3.0, 2.0, 20), 0.0).is_err());
    }
}
