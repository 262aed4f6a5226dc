//! The way of a snake, step by step, to where it rests.

use glam::DVec2;

use crate::energy::Picture;
use crate::matrix::Elastic;
use crate::rest::{BACK, Past};
use crate::spline::Spline;
use crate::{Border, ClassicError, Ends, Rules};

/// How a snake's way has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// No point has moved farther than [`Rules::convergence`], nor does it go on slowly.
    Settled,
    /// After [`Rules::max_num_iter`] steps.
    Limit,
    /// As it was asked for from outside.
    Asked,
}

/// Where a snake has come to.
#[derive(Debug, Clone, PartialEq)]
pub struct Settled {
    /// Its points, in the order of the start.
    pub points: Vec<DVec2>,
    /// How it ended.
    pub stop: Stop,
    /// Steps made.
    pub steps: u64,
    /// Points that were put between each two of a closed snake, since it collapsed without.
    pub between: usize,
    /// Whether it has collapsed all the same: its area is less than a thousandth of that of the start.
    pub collapsed: bool,
}

/// A closed snake of less than this share of its area at the start has collapsed.
const LEAST_AREA: f64 = 1e-3;

/// Pixels that a window has around a snake.
const ROOM: f64 = 6.0;

/// Between two points that are nearer than this no more are put. Pixels.
const DENSE: f64 = 1.0;

/// Times that the number of points is doubled at most.
const DOUBLED: u32 = 4;

/// Let a snake go from `start` to where it rests. `asked` is asked after every step whether to stop.
///
/// # Errors
///
/// A rule out of its range, a picture of fewer than three pixels across or with a level that is not finite, a start of
/// fewer than 5 points (4 if open) or with one that is not finite, rules for which no step is stable.
pub fn settle<F: Fn(usize, usize, usize) -> f64>(
    picture: &Picture<F>,
    start: &[DVec2],
    rules: &Rules,
    asked: &dyn Fn() -> bool,
) -> Result<Settled, ClassicError> {
    rules.check()?;
    picture.check()?;
    let closed = rules.ends == Ends::Periodic;
    let needed = if closed { 5 } else { 4 };
    if start.len() < needed {
        let got = start.len();
        return Err(ClassicError::Few { needed, got });
    }
    if let Some(index) = start.iter().position(|p| !p.is_finite()) {
        let [x, y] = start[index].to_array();
        return Err(ClassicError::Point { index, x, y });
    }
    let first = Walk::new(picture, start, rules)?.finish(asked)?;
    if !(closed && first.collapsed && first.stop != Stop::Asked) {
        return Ok(first);
    }
    let mut dense = start.to_vec();
    for doubled in 1..=DOUBLED {
        let longest = ring(&dense).map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
        if longest <= DENSE {
            break;
        }
        dense = ring(&dense).flat_map(|(a, b)| [a, a.midpoint(b)]).collect();
        let mut found = Walk::new(picture, &dense, rules)?.finish(asked)?;
        if !found.collapsed || found.stop == Stop::Asked {
            found.between = (1 << doubled) - 1;
            found.points = found.points.into_iter().step_by(1 << doubled).collect();
            return Ok(found);
        }
    }
    Ok(first)
}

/// Each point with the next, the last with the first.
fn ring(points: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> {
    let next = points.iter().skip(1).chain(points.first());
    points.iter().copied().zip(next.copied())
}

fn area(points: &[DVec2]) -> f64 {
    let origin = points.first().copied().unwrap_or_default();
    let twice = ring(points).map(|(a, b)| (a - origin).perp_dot(b - origin));
    (0.5 * twice.sum::<f64>()).abs()
}

/// A snake on its way.
struct Walk<'a, F> {
    picture: &'a Picture<F>,
    rules: &'a Rules,
    elastic: Elastic,
    spline: Spline,
    points: Vec<DVec2>,
    force: Vec<DVec2>,
    area: f64,
}

impl<'a, F: Fn(usize, usize, usize) -> f64> Walk<'a, F> {
    fn new(
        picture: &'a Picture<F>,
        start: &[DVec2],
        rules: &'a Rules,
    ) -> Result<Self, ClassicError> {
        Ok(Self {
            picture,
            rules,
            elastic: Elastic::new(rules, start.len())?,
            spline: window(picture, start, rules)?,
            points: start.to_vec(),
            force: vec![DVec2::ZERO; start.len()],
            area: area(start),
        })
    }

    fn finish(mut self, asked: &dyn Fn() -> bool) -> Result<Settled, ClassicError> {
        let (mut past, mut stop) = (Past::default(), Stop::Limit);
        let mut steps = 0;
        while steps < self.rules.max_num_iter {
            self.step()?;
            steps += 1;
            // ten places are kept, and the eleventh is compared with them
            if steps.is_multiple_of(BACK as u64 + 1) {
                let least = self.rules.convergence;
                if past.nearest(&self.points) < least && !past.drifts(&self.points, least) {
                    stop = Stop::Settled;
                    break;
                }
                past.forget();
            } else {
                past.push(&self.points);
            }
            if asked() {
                stop = Stop::Asked;
                break;
            }
        }
        let closed = self.rules.ends == Ends::Periodic;
        let collapsed = closed && area(&self.points) < LEAST_AREA * self.area;
        Ok(Settled {
            points: self.points,
            stop,
            steps,
            between: 0,
            collapsed,
        })
    }

    fn step(&mut self) -> Result<(), ClassicError> {
        for i in 0..self.points.len() {
            let p = self.points[i];
            self.force[i] = match self.spline.slope(p) {
                Some(slope) => slope,
                None => {
                    self.spline = window(self.picture, &self.points, self.rules)?;
                    self.spline.slope(p).unwrap_or_default()
                }
            };
        }
        let (gamma, most) = (self.rules.gamma, self.rules.max_px_move);
        let ends = match self.rules.ends {
            Ends::Periodic => None,
            Ends::Open(head, tail) => Some([(0, head), (self.points.len() - 1, tail)]),
        };
        for (end, border) in ends.into_iter().flatten() {
            // a free end stands for twice the others
            self.force[end] *= if border == Border::Free { 2.0 } else { 0.0 };
        }
        for (force, p) in self.force.iter_mut().zip(&self.points) {
            *force += gamma * *p;
        }
        self.elastic.solve(&mut self.force);
        for (end, border) in ends.into_iter().flatten() {
            if border == Border::Fixed {
                self.force[end] = self.points[end];
            }
        }
        for (p, to) in self.points.iter_mut().zip(&self.force) {
            let way = *to - *p;
            *p += most * DVec2::new(tanh(way.x), tanh(way.y));
        }
        Ok(())
    }
}

/// The hyperbolic tangent: its series where that is shorter, to a rounding.
fn tanh(x: f64) -> f64 {
    let s = x * x;
    if s > 0.01 {
        return x.tanh();
    }
    // the next term is 9e-3 s^7, below 1e-16 here
    let series = 21844.0 / 6_081_075.0;
    let series = -1382.0 / 155_925.0 + s * series;
    let series = 62.0 / 2835.0 + s * series;
    let series = -17.0 / 315.0 + s * series;
    let series = 2.0 / 15.0 + s * series;
    let series = -1.0 / 3.0 + s * series;
    x + x * s * series
}

/// The spline of the picture about a snake.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the picture"
)]
fn window<F: Fn(usize, usize, usize) -> f64>(
    picture: &Picture<F>,
    points: &[DVec2],
    rules: &Rules,
) -> Result<Spline, ClassicError> {
    let last = DVec2::new((picture.width - 1) as f64, (picture.height - 1) as f64);
    let inside = points.iter().map(|p| p.clamp(DVec2::ZERO, last));
    let (low, high) = inside.fold((last, DVec2::ZERO), |(low, high), p| {
        (low.min(p), high.max(p))
    });
    let low = (low - ROOM).floor().max(DVec2::ZERO);
    let high = (high + ROOM).ceil().min(last);
    let at = |p: DVec2| [p.x as usize, p.y as usize];
    picture.spline(rules, at(low), at(high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_of_tanh_is_tanh() {
        for i in -200..=200 {
            let x = f64::from(i) * 1e-3;
            assert!(
                (tanh(x) - x.tanh()).abs() <= 2.0 * f64::EPSILON * x.abs(),
                "{x}"
            );
        }
    }
}
