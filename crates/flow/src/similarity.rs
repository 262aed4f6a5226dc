//! One translation, rotation and scale for many points.

use glam::DVec2;

/// Rounds of weighing and solving.
const ROUNDS: usize = 6;

/// Points that lie off by so much, or so many times the median, count half. Pixels.
const LEAST_SCALE: f64 = 0.5;
const SCALE: f64 = 1.5;

/// `p ↦ center + shift + turn · (p − center)`, `turn` multiplied as a complex number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Similarity {
    /// Cosine and sine of the rotation, times the scale.
    pub turn: DVec2,
    /// The way of the center. Pixels.
    pub shift: DVec2,
    /// The place it is counted from. Pixels.
    pub center: DVec2,
}

impl Similarity {
    /// No motion.
    pub const STILL: Self = Self {
        turn: DVec2::X,
        shift: DVec2::ZERO,
        center: DVec2::ZERO,
    };

    /// Where a point goes.
    #[must_use]
    pub fn at(&self, p: DVec2) -> DVec2 {
        self.center + self.shift + self.turn.rotate(p - self.center)
    }

    /// The same motion counted from another place.
    #[must_use]
    pub fn about(&self, center: DVec2) -> Self {
        Self {
            turn: self.turn,
            shift: self.at(center) - center,
            center,
        }
    }
}

/// The similarity that takes most of the points there, each with a weight of at least 0. Two points or fewer, or
/// points all in one place, are moved without rotation and scale; None without a point of weight above 0.
#[must_use]
pub fn similarity(from: &[DVec2], to: &[DVec2], weights: &[f64]) -> Option<Similarity> {
    let mut robust = vec![1.0; from.len()];
    let mut found = None;
    for _ in 0..ROUNDS {
        let weight = |i: usize| weights[i] * robust[i];
        let total: f64 = (0..from.len()).map(weight).sum();
        if total.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) {
            return found;
        }
        let mean = |list: &[DVec2]| -> DVec2 {
            let sum = list
                .iter()
                .enumerate()
                .map(|(i, p)| weight(i) * *p)
                .sum::<DVec2>();
            sum / total
        };
        let (center, end) = (mean(from), mean(to));
        let (mut turn, mut spread) = (DVec2::ZERO, 0.0);
        for (i, (a, b)) in from.iter().zip(to).enumerate() {
            let (a, b) = (*a - center, *b - end);
            turn += weight(i) * DVec2::new(a.dot(b), a.perp_dot(b));
            spread += weight(i) * a.length_squared();
        }
        let counted = weights.iter().filter(|weight| **weight > 0.0).count();
        let turn = if counted > 2 && spread > 0.0 {
            turn / spread
        } else {
            DVec2::X
        };
        let motion = Similarity {
            turn,
            shift: end - center,
            center,
        };
        let off: Vec<f64> = from
            .iter()
            .zip(to)
            .map(|(a, b)| motion.at(*a).distance(*b))
            .collect();
        let mut counted: Vec<f64> = off
            .iter()
            .zip(weights)
            .filter(|(_, weight)| **weight > 0.0)
            .map(|(off, _)| *off)
            .collect();
        let middle = counted.len() / 2;
        let median = *counted.select_nth_unstable_by(middle, f64::total_cmp).1;
        let scale = (SCALE * median).max(LEAST_SCALE);
        for (robust, off) in robust.iter_mut().zip(&off) {
            *robust = (1.0 + (off / scale).powi(2)).recip();
        }
        found = Some(motion);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_third_of_strays_does_not_move_it() {
        let motion = Similarity {
            turn: 1.1 * DVec2::from_angle(0.3),
            shift: DVec2::new(7.0, -3.0),
            center: DVec2::splat(20.0),
        };
        let from: Vec<DVec2> = (0..60)
            .map(|i| DVec2::new(f64::from(i % 8) * 5.0, f64::from(i / 8) * 5.0))
            .collect();
        let stray = |i: usize, p: DVec2| {
            if i.is_multiple_of(3) {
                p + DVec2::new(30.0, 12.0)
            } else {
                motion.at(p)
            }
        };
        let to: Vec<DVec2> = from.iter().enumerate().map(|(i, p)| stray(i, *p)).collect();
        let found = similarity(&from, &to, &vec![1.0; from.len()]).unwrap();
        for p in &from {
            assert!(
                found.at(*p).distance(motion.at(*p)) < 0.25,
                "{} for {}",
                found.at(*p),
                motion.at(*p)
            );
        }
        let about = found.about(DVec2::new(3.0, 4.0));
        assert!(
            about
                .at(DVec2::splat(9.0))
                .distance(found.at(DVec2::splat(9.0)))
                < 1e-12
        );
    }

    #[test]
    fn few_points_are_shifted_and_none_is_nothing() {
        let found = similarity(&[DVec2::ZERO], &[DVec2::ONE], &[2.0]).unwrap();
        assert_eq!((found.turn, found.shift), (DVec2::X, DVec2::ONE));
        assert!(similarity(&[], &[], &[]).is_none());
        assert!(similarity(&[DVec2::ZERO], &[DVec2::ONE], &[0.0]).is_none());
    }
}
