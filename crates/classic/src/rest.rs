//! When a snake is at rest: it goes nowhere, whether it trembles or not.

use std::collections::VecDeque;

use glam::DVec2;

/// So many steps are looked back.
pub(crate) const BACK: usize = 10;

/// A way that shrinks by less than this from one half of the past to the other may as well go on for ever.
const EVEN: f64 = 0.8;

/// Of the way asked about, so much may be left: what shrinks fast at first may creep on.
const LEFT: f64 = 0.1;

/// Who has moved by less than this share of the way asked about is still.
const STILL: f64 = 1e-3;

/// The last places of a snake.
#[derive(Debug, Default)]
pub(crate) struct Past(VecDeque<Vec<DVec2>>);

impl Past {
    /// Remember where it is.
    pub(crate) fn push(&mut self, points: &[DVec2]) {
        let mut kept = if self.0.len() == BACK {
            self.0.pop_front().unwrap_or_default()
        } else {
            Vec::new()
        };
        kept.clear();
        kept.extend_from_slice(points);
        self.0.push_back(kept);
    }

    /// Begin to remember anew.
    pub(crate) fn forget(&mut self) {
        self.0.clear();
    }

    /// The least distance from any of the last places: the largest of all points, along both axes together. Pixels.
    pub(crate) fn nearest(&self, points: &[DVec2]) -> f64 {
        let far = |past: &Vec<DVec2>| {
            let both = past.iter().zip(points);
            both.map(|(a, b)| (*a - *b).abs().element_sum())
                .fold(0.0, f64::max)
        };
        self.0.iter().map(far).fold(f64::INFINITY, f64::min)
    }

    /// Whether it still goes one way, and will go on for more than a tenth of so many pixels if it slows down as it
    /// has.
    pub(crate) fn drifts(&self, points: &[DVec2], way: f64) -> bool {
        let (Some(first), Some(middle)) = (self.0.front(), self.0.get(self.0.len() / 2)) else {
            return false;
        };
        let (mut before, mut both, mut most) = (0.0, 0.0, 0.0_f64);
        for ((a, b), c) in first.iter().zip(middle).zip(points) {
            let (earlier, later) = (*b - *a, *c - *b);
            before += earlier.length_squared();
            both += earlier.dot(later);
            most = most.max(later.length());
        }
        if !(both > 0.0 && before > 0.0 && most > STILL * way) {
            return false; // it turns back, or does not move
        }
        // the way shrinks by this from one half of the past to the next, and so on
        let ratio = both / before;
        ratio >= EVEN || most * ratio / (1.0 - ratio) > LEFT * way
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn along(place: impl Fn(f64) -> f64) -> (Past, Vec<DVec2>) {
        let mut past = Past::default();
        for i in 0..15 {
            past.push(&[DVec2::new(place(f64::from(i)), 3.0)]);
        }
        (past, vec![DVec2::new(place(15.0), 3.0)])
    }

    #[test]
    fn what_creeps_evenly_drifts_and_what_slows_down_or_trembles_does_not() {
        let (past, here) = along(|i| 0.001 * i);
        assert!(past.drifts(&here, 0.1) && (past.nearest(&here) - 0.001).abs() < 1e-12);
        let (past, here) = along(|i| 0.5_f64.powf(i));
        assert!(!past.drifts(&here, 0.1));
        let (past, here) = along(|i| 0.3 * (i * 2.0).sin());
        assert!(!past.drifts(&here, 0.1));
        let (past, here) = along(|_| 7.0);
        assert!(!past.drifts(&here, 0.1) && past.nearest(&here) == 0.0);
    }
}
