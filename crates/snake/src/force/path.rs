//! Where a hand is.

use glam::DVec2;

use crate::SnakeError;

/// A point in space that stays or moves: straight lines between given points, at rest before and after.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    points: Vec<(f64, DVec2)>,
}

impl Path {
    /// Through `(time, place)` points, times ascending.
    ///
    /// # Errors
    ///
    /// Refused: no point, a time that does not ascend, a number that is not finite.
    pub fn new(points: Vec<(f64, DVec2)>) -> Result<Self, SnakeError> {
        if points.is_empty() {
            let (index, time) = (0, f64::NAN);
            return Err(SnakeError::BadSchedule { index, time });
        }
        for (index, &(time, place)) in points.iter().enumerate() {
            let ascends = index == 0 || time > points[index - 1].0;
            if !time.is_finite() || !ascends {
                return Err(SnakeError::BadSchedule { index, time });
            }
            crate::error::place("a point of a path", place)?;
        }
        Ok(Self { points })
    }

    /// Whether it never moves.
    #[must_use]
    pub fn is_still(&self) -> bool {
        self.points.windows(2).all(|pair| pair[0].1 == pair[1].1)
    }

    /// Where it is at time `t`, and how fast it moves there. L, L T⁻¹.
    #[must_use]
    pub fn at(&self, t: f64) -> (DVec2, DVec2) {
        let after = self.points.partition_point(|&(time, _)| time <= t);
        let before = after.checked_sub(1).map(|i| self.points[i]);
        match (before, self.points.get(after)) {
            (Some((t0, p0)), Some(&(t1, p1))) => {
                let speed = (p1 - p0) / (t1 - t0);
                (p0 + speed * (t - t0), speed)
            }
            (Some((_, p)), None) | (None, Some(&(_, p))) => (p, DVec2::ZERO),
            (None, None) => (DVec2::ZERO, DVec2::ZERO),
        }
    }

    /// Check what [`Path::new`] checks: a point given as it is may be none.
    pub(crate) fn validate(&self, name: &'static str) -> Result<(), SnakeError> {
        let mut places = self.points.iter();
        places.try_for_each(|&(_, p)| crate::error::place(name, p))
    }
}

impl From<DVec2> for Path {
    /// A point that stays.
    fn from(place: DVec2) -> Self {
        Self {
            points: vec![(0.0, place)],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_goes_straight_from_point_to_point_and_rests_beyond() {
        let path = Path::new(vec![(1.0, DVec2::ZERO), (3.0, DVec2::new(4.0, -2.0))]).unwrap();
        let speed = DVec2::new(2.0, -1.0);
        for (t, place, fast) in [
            (0.0, DVec2::ZERO, DVec2::ZERO),
            (1.0, DVec2::ZERO, speed),
            (2.0, speed, speed),
            (3.0, 2.0 * speed, DVec2::ZERO),
            (9.0, 2.0 * speed, DVec2::ZERO),
        ] {
            assert_eq!(path.at(t), (place, fast), "at {t}");
        }
        assert!(!path.is_still() && Path::from(speed).is_still());
    }

    #[test]
    fn a_path_without_points_or_through_no_place_is_refused() {
        assert!(Path::new(vec![]).is_err());
        assert!(Path::new(vec![(1.0, DVec2::ZERO), (1.0, DVec2::X)]).is_err());
        assert!(Path::new(vec![(0.0, DVec2::NAN)]).is_err());
        assert!(Path::from(DVec2::NAN).validate("target").is_err());
    }
}
