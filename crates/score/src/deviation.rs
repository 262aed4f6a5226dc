//! On which side of the truth an outline lies, and by how much.

use crate::ScoreError;
use crate::agreement::{Nearest, walk};
use glam::DVec2;
use outline::{Place, place};

/// Signed distances of an outline that was found from the true one, positive where it lies outside. Pixels.
///
/// The outline found is walked along in pieces of at most half a pixel, counted by their length; the distance is that
/// to the nearest edge, so normal to the true curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation {
    /// The mean: a bias, above 0 if what was found is too large.
    pub mean: f64,
    /// The root of the mean square.
    pub rms: f64,
}

impl Deviation {
    /// Compare a closed polygon with the true one.
    ///
    /// O(length × (edges nearby + true nodes)).
    ///
    /// # Errors
    ///
    /// A polygon without points, with points that are not finite, or beyond a length of 2²³ pixels.
    ///
    /// ```
    /// use glam::DVec2;
    ///
    /// let circle = |radius: f64| -> Vec<DVec2> {
    ///     (0..720).map(|i| radius * DVec2::from_angle(f64::from(i) * 0.5_f64.to_radians())).collect()
    /// };
    /// let deviation = score::Deviation::of(&circle(19.75), &circle(20.0))?;
    /// assert!((deviation.mean + 0.25).abs() < 1e-3 && (deviation.rms - 0.25).abs() < 1e-3);
    /// # Ok::<(), score::ScoreError>(())
    /// ```
    pub fn of(found: &[DVec2], truth: &[DVec2]) -> Result<Self, ScoreError> {
        let to = [truth];
        let mut nearest = Nearest::new("true", &to)?;
        // so that what is found is known to be finite
        let from = [found];
        Nearest::new("found", &from)?;
        let (mut sum, mut squares) = (0.0, 0.0);
        let length = walk("found", &from, |p, weight| {
            let distance = nearest.distance(p);
            if weight > 0.0 {
                let signed = match place(truth, p) {
                    Place::Inside => -distance,
                    _ => distance,
                };
                sum += weight * signed;
                squares += weight * distance * distance;
            }
        })?;
        Ok(Self {
            mean: sum / length,
            rms: (squares / length).sqrt(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_with_waves_deviates_by_their_size() {
        let circle = |waves: f64, n: i32| -> Vec<DVec2> {
            let turn = |i: i32| f64::from(i) * std::f64::consts::TAU / f64::from(n);
            let on = |t: f64| (40.0 + 0.5 + waves * (6.0 * t).cos()) * DVec2::from_angle(t);
            (0..n).map(|i| on(turn(i))).collect()
        };
        let truth: Vec<DVec2> = circle(0.0, 5000)
            .iter()
            .map(|p| *p * (40.0 / 40.5))
            .collect();
        let got = Deviation::of(&circle(0.2, 3000), &truth).unwrap();
        // along the wavy curve the length element weighs crests and troughs by ±0.2 / 40.5
        assert!((got.mean - 0.5).abs() < 1e-3, "{got:?}");
        assert!((got.rms - (0.25_f64 + 0.02).sqrt()).abs() < 1e-3, "{got:?}");
    }

    #[test]
    fn what_is_no_place_is_refused() {
        let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        assert!(Deviation::of(&[], &square).is_err());
        assert!(Deviation::of(&square, &[]).is_err());
        assert!(Deviation::of(&[DVec2::NAN], &square).is_err());
        let itself = Deviation::of(&square, &square).unwrap();
        assert_eq!((itself.mean, itself.rms), (0.0, 0.0));
    }
}
