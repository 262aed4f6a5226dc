//! Arc length along a cubic spline, and the way back from a length to a place.
//!
//! The speed of a cubic is the square root of a quartic: no closed form. Each piece is halved until one
//! five-point Gauss rule and its two halves agree, which puts the small intervals where the curve turns
//! sharply; the ends of all intervals make a table of (length, place). Inside an interval the place is found by
//! Newton's method, guarded by bisection.

use crate::cubic::Cubic;

/// Interval by interval, where it begins and how long the curve is up to there.
pub(crate) struct ArcTable<'a> {
    curve: &'a Cubic,
    /// (piece, left end, right end, length before).
    spans: Vec<(usize, f64, f64, f64)>,
    total: f64,
}

/// How often a piece may be halved. A cusp, where the speed is |t|, gains two bits a level.
const DEEPEST: u32 = 30;

/// Agreement asked of a rule and its halves, relative to a rough length of the curve.
const AGREEMENT: f64 = 1e-14;

/// Nodes and weights of the five-point Gauss rule on −1…1: exact up to degree nine.
const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

impl<'a> ArcTable<'a> {
    pub(crate) fn new(curve: &'a Cubic) -> Self {
        let rough: f64 = (0..curve.pieces()).map(|i| gauss(curve, i, 0.0, 1.0)).sum();
        let mut table = Self {
            curve,
            spans: Vec::new(),
            total: 0.0,
        };
        for i in 0..curve.pieces() {
            table.add(
                i,
                0.0,
                1.0,
                gauss(curve, i, 0.0, 1.0),
                AGREEMENT * rough,
                DEEPEST,
            );
        }
        table
    }

    /// Length of the whole curve.
    pub(crate) const fn total(&self) -> f64 {
        self.total
    }

    /// The parameter at which the curve is `length` long.
    pub(crate) fn place(&self, length: f64) -> f64 {
        let after = self.spans.partition_point(|span| span.3 <= length);
        let Some(&(piece, left, right, before)) = self.spans.get(after.saturating_sub(1)) else {
            return 0.0;
        };
        let wanted = length - before;
        let (mut low, mut high) = (left, right);
        let mut t = left;
        // bisection alone would need 53 rounds to the last bit
        for _ in 0..60 {
            let miss = gauss(self.curve, piece, left, t) - wanted;
            if miss > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let step = miss / self.curve.speed(piece, t);
            let newton = t - step;
            let next = if newton >= low && newton <= high {
                newton
            } else {
                0.5 * (low + high)
            };
            if (next - t).abs() <= f64::EPSILON {
                t = next;
                break;
            }
            t = next;
        }
        piece as f64 + t
    }

    /// Halves until the rule agrees with itself, then notes the interval.
    fn add(&mut self, i: usize, left: f64, right: f64, whole: f64, tolerance: f64, depth: u32) {
        let middle = 0.5 * (left + right);
        let halves = (
            gauss(self.curve, i, left, middle),
            gauss(self.curve, i, middle, right),
        );
        let sum = halves.0 + halves.1;
        if depth == 0 || (sum - whole).abs() <= tolerance {
            self.spans.push((i, left, right, self.total));
            self.total += sum;
        } else {
            self.add(i, left, middle, halves.0, tolerance, depth - 1);
            self.add(i, middle, right, halves.1, tolerance, depth - 1);
        }
    }
}

/// Length of piece `i` from `left` to `right` by one Gauss rule.
fn gauss(curve: &Cubic, i: usize, left: f64, right: f64) -> f64 {
    let (middle, half) = (0.5 * (left + right), 0.5 * (right - left));
    half * GAUSS
        .iter()
        .map(|&(x, w)| w * curve.speed(i, middle + half * x))
        .sum::<f64>()
}
