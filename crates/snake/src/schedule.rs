//! Parameters that change with time: report §3.4.1 wishes for them, "allow these parameters to
//! change values through time" being left undone there.

use crate::parameter::PerParameter;
use crate::{Parameter, SnakeError};

/// A factor as a function of time: straight lines between given points, constant beyond them.
///
/// Times and factors are numbers without further meaning; a schedule multiplies the profile it
/// belongs to, so that a parameter is `profile(s) · factor(t)`.
#[derive(Debug, Clone, PartialEq)]
pub struct Schedule {
    points: Vec<(f64, f64)>,
}

impl Schedule {
    /// A schedule through `(time, factor)` points, times ascending.
    ///
    /// # Errors
    ///
    /// Refused: no point, a time that does not ascend, a number that is not finite, a negative factor.
    pub fn new(points: Vec<(f64, f64)>) -> Result<Self, SnakeError> {
        if points.is_empty() {
            return Err(SnakeError::BadSchedule {
                index: 0,
                time: f64::NAN,
            });
        }
        for (index, &(time, factor)) in points.iter().enumerate() {
            let ascends = index == 0 || time > points[index - 1].0;
            if !time.is_finite() || !ascends {
                return Err(SnakeError::BadSchedule { index, time });
            }
            crate::error::finite_at_least("a schedule's factor", 0.0, "at least 0", factor)?;
        }
        Ok(Self { points })
    }

    /// The factor at time `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        let after = self.points.partition_point(|&(time, _)| time <= t);
        match (
            after.checked_sub(1).map(|i| self.points[i]),
            self.points.get(after),
        ) {
            (Some((t0, f0)), Some(&(t1, f1))) => f0 + (f1 - f0) * ((t - t0) / (t1 - t0)),
            (Some((_, factor)), None) | (None, Some(&(_, factor))) => factor,
            (None, None) => 1.0,
        }
    }

    /// The largest factor at any time: what a step limit must be ready for.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.points
            .iter()
            .map(|&(_, factor)| factor)
            .fold(0.0, f64::max)
    }

    /// When the factor has changed for the last time; minus infinity if it never does.
    #[must_use]
    pub fn end(&self) -> f64 {
        let changes = |w: &&[(f64, f64)]| (w[0].1 - w[1].1).abs() > 0.0;
        let last = self.points.windows(2).rfind(changes);
        last.map_or(f64::NEG_INFINITY, |w| w[1].0)
    }

    /// Whether the factor is the same at all times.
    #[must_use]
    pub fn is_constant(&self) -> bool {
        self.points
            .windows(2)
            .all(|w| (w[0].1 - w[1].1).abs() == 0.0)
    }
}

/// One optional schedule for each parameter of the motion.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Schedules {
    /// Factor of ω₀.
    pub tether: Option<Schedule>,
    /// Factor of ω₁.
    pub tension: Option<Schedule>,
    /// Factor of ω₂.
    pub rigidity: Option<Schedule>,
    /// Factor of μ.
    pub mass: Option<Schedule>,
    /// Factor of γ.
    pub damping: Option<Schedule>,
    /// Factor of ω₃ and all above it.
    pub higher: Option<Schedule>,
}

/// Times at which step limits are asked for, one by one.
const MOST_POINTS: usize = 32;

/// A factor for each parameter; that of internal damping is 1.
pub(crate) type Factors = PerParameter<f64>;

impl Schedules {
    /// Whether nothing changes with time.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// The factor of a parameter at time `t`.
    #[must_use]
    pub fn at(&self, parameter: Parameter, t: f64) -> f64 {
        self.of(parameter).map_or(1.0, |schedule| schedule.at(t))
    }

    /// All of them.
    pub(crate) fn all_at(&self, t: f64) -> Factors {
        PerParameter::of(|parameter| self.at(parameter, t))
    }

    /// Factors that between them ask for the shortest steps that are needed from the time `from` to the time `to`.
    ///
    /// Between two points all factors are straight lines, and "a step is stable" is a matrix that is linear in them and
    /// positive definite. So the points, and both ends, stand for all times. Beyond [`MOST_POINTS`] of them it is
    /// the largest stiffness with the least mass, once with the largest damping and once with the least.
    pub(crate) fn hardest(&self, span: (f64, f64)) -> Vec<Factors> {
        let (from, to) = if span.0 <= span.1 {
            span
        } else {
            (f64::NEG_INFINITY, f64::INFINITY)
        };
        let points = |schedule: &Schedule| -> Vec<f64> {
            let times = schedule.points.iter().map(|&(time, _)| time);
            times.collect()
        };
        let mut times: Vec<f64> = self.all().flat_map(points).collect();
        times.iter_mut().for_each(|t| *t = t.clamp(from, to));
        times.sort_by(f64::total_cmp);
        times.dedup();
        let mut each: Vec<Factors> = times.iter().map(|&t| self.all_at(t)).collect();
        each.dedup();
        if each.len() <= MOST_POINTS {
            return each;
        }
        let most = |k: Parameter| each.iter().map(|f| f[k]).fold(0.0, f64::max);
        let least = |k: Parameter| each.iter().map(|f| f[k]).fold(f64::INFINITY, f64::min);
        let rest = |damping| {
            PerParameter::of(|parameter| match parameter {
                Parameter::Mass => least(parameter),
                Parameter::Damping => damping,
                _ => most(parameter),
            })
        };
        let damping = Parameter::Damping;
        vec![rest(most(damping)), rest(least(damping))]
    }

    /// When the last of the factors has changed for the last time; minus infinity if none does.
    #[must_use]
    pub fn end(&self) -> f64 {
        let ends = self.all().map(Schedule::end);
        ends.fold(f64::NEG_INFINITY, f64::max)
    }

    fn all(&self) -> impl Iterator<Item = &Schedule> {
        Parameter::ALL
            .into_iter()
            .filter_map(|parameter| self.of(parameter))
    }

    const fn of(&self, parameter: Parameter) -> Option<&Schedule> {
        match parameter {
            Parameter::Tether => self.tether.as_ref(),
            Parameter::Tension => self.tension.as_ref(),
            Parameter::Rigidity => self.rigidity.as_ref(),
            Parameter::Higher => self.higher.as_ref(),
            Parameter::Mass => self.mass.as_ref(),
            Parameter::Damping => self.damping.as_ref(),
            Parameter::Internal => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_schedule_is_straight_between_its_points_and_constant_beyond() {
        let schedule = Schedule::new(vec![(1.0, 2.0), (3.0, 6.0)]).unwrap();
        for (t, factor) in [(0.0, 2.0), (1.0, 2.0), (2.0, 4.0), (3.0, 6.0), (9.0, 6.0)] {
            assert!((schedule.at(t) - factor).abs() < 1e-15, "at {t}");
        }
        assert!((schedule.largest() - 6.0).abs() < 1e-15);
        assert_eq!(schedule.end().to_bits(), 3.0_f64.to_bits());
        let level = Schedule::new(vec![(0.0, 1.0), (2.0, 0.5), (9.0, 0.5)]).unwrap();
        assert_eq!(level.end().to_bits(), 2.0_f64.to_bits());
        assert!(Schedule::new(vec![(1.0, 2.0), (3.0, 2.0)]).unwrap().end() < -1e300);
    }

    #[test]
    fn times_that_do_not_ascend_are_refused_with_their_place() {
        let error = Schedule::new(vec![(0.0, 1.0), (0.0, 2.0)]).unwrap_err();
        assert_eq!(
            error,
            SnakeError::BadSchedule {
                index: 1,
                time: 0.0
            }
        );
        assert!(Schedule::new(vec![(0.0, -1.0)]).is_err());
        assert!(Schedule::new(vec![(f64::NAN, 1.0)]).is_err());
        assert!(Schedule::new(vec![]).is_err());
    }
}
