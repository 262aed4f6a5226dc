//! The quadratic spline through the pixels of a window, and its slope between them.

use glam::DVec2;

/// What lies this far beyond a window changes the spline in it by less than a rounding: each pixel on the way leaves
/// 3 − √8 of it.
const REACH: usize = 24;

/// A stretch of a line of pixels, and whether the picture ends where it does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stretch {
    /// The first pixel that is asked for, and the last.
    pub(crate) asked: (usize, usize),
    /// The first pixel of the stretch: as many more than asked for as matter.
    pub(crate) low: usize,
    /// Pixels of the stretch.
    pub(crate) len: usize,
    first: bool,
    last: bool,
}

impl Stretch {
    /// The pixels from `low` to `high` of a line of `whole`.
    pub(crate) fn around(low: usize, high: usize, whole: usize) -> Self {
        let from = low.saturating_sub(REACH);
        let to = (high + REACH).min(whole - 1);
        Self {
            asked: (low, high),
            low: from,
            len: to + 1 - from,
            first: from == 0,
            last: to + 1 == whole,
        }
    }

    /// Turn values at the pixels into the weights of B-splines. `values`: for each pixel of the stretch as many
    /// numbers as there are lines.
    ///
    /// `c[k−1] + 6 c[k] + c[k+1] = 8 f[k]` inside. At an end of the picture the second difference of c is the same at
    /// both of the last two knots, which are none: `c[0] − c[1] = f[0] − f[1]`.
    fn solve(self, values: &mut [f64], lines: usize) {
        let (len, from) = (self.len, usize::from(self.first));
        let to = len - usize::from(self.last);
        // the ends first, while what is beside them is as it was
        if self.first {
            add(values, (0, 1), -1.0, lines);
        }
        if self.last {
            add(values, (len - 1, len - 2), -1.0, lines);
        }
        for value in &mut values[from * lines..to * lines] {
            *value *= 8.0;
        }
        if self.first {
            add(values, (1, 0), -1.0, lines);
        }
        if self.last {
            add(values, (len - 2, len - 1), -1.0, lines);
        }
        let mut shares = vec![0.0; len];
        for k in from..to {
            let ends = usize::from(self.first && k == from) + usize::from(self.last && k + 1 == to);
            let before = if k > from { shares[k - 1] } else { 0.0 };
            shares[k] = (6.0 + ends as f64 - before).recip();
            let (done, here) = values.split_at_mut(k * lines);
            let here = &mut here[..lines];
            if k > from {
                let before = &done[(k - 1) * lines..];
                for (one, before) in here.iter_mut().zip(before) {
                    *one = (*one - before) * shares[k];
                }
            } else {
                for one in here {
                    *one *= shares[k];
                }
            }
        }
        for k in (from..to - 1).rev() {
            let (here, after) = values.split_at_mut((k + 1) * lines);
            let here = &mut here[k * lines..];
            for (one, after) in here.iter_mut().zip(&after[..lines]) {
                *one -= shares[k] * after;
            }
        }
        if self.first {
            add(values, (0, 1), 1.0, lines);
        }
        if self.last {
            add(values, (len - 1, len - 2), 1.0, lines);
        }
    }

    /// The weights from one before the first pixel that is asked for to one after the last, written by `put(k, from)`
    /// with `from` the lines of pixels that make it and their factors.
    fn asked_weights(self, mut put: impl FnMut(usize, [(f64, usize); 3])) {
        let (low, high) = self.asked;
        for k in 0..high - low + 3 {
            // pixel low + k − 1 of the picture
            let place = low + k;
            let from = if place == 0 {
                [(3.0, 0), (-3.0, 1), (1.0, 2)]
            } else if place - 1 < self.low + self.len {
                [(1.0, place - 1 - self.low), (0.0, 0), (0.0, 0)]
            } else {
                let n = self.len;
                [(3.0, n - 1), (-3.0, n - 2), (1.0, n - 3)]
            };
            put(k, from);
        }
    }
}

/// `line[to] += factor line[from]`.
fn add(values: &mut [f64], (to, from): (usize, usize), factor: f64, lines: usize) {
    for i in 0..lines {
        values[to * lines + i] += factor * values[from * lines + i];
    }
}

/// The spline over a window, as weights of B-splines of degree two at its pixels and one around it.
///
/// At the border of the picture the outermost knots are left out, so that the last parabola reaches over one and a half
/// pixels, as FITPACK has it.
#[derive(Debug, Clone)]
pub(crate) struct Spline {
    low: DVec2,
    high: DVec2,
    /// The center of the last pixel of the picture.
    last: DVec2,
    /// Rows of the window, and two.
    rows: usize,
    /// Column by column.
    weights: Vec<f64>,
}

impl Spline {
    /// Of the values of a window and what is around it, row by row.
    pub(crate) fn new(
        mut values: Vec<f64>,
        (across, down): (Stretch, Stretch),
        (width, height): (usize, usize),
    ) -> Self {
        let lines = across.len;
        down.solve(&mut values, lines);
        let rows = down.asked.1 - down.asked.0 + 3;
        // turned over, so that the rows lie side by side
        let mut turned = vec![0.0; rows * lines];
        down.asked_weights(|k, from| {
            let [(a, i), (b, j), (c, l)] = from.map(|(factor, line)| (factor, line * lines));
            for x in 0..lines {
                turned[x * rows + k] = if b.abs() > 0.0 {
                    a * values[i + x] + b * values[j + x] + c * values[l + x]
                } else {
                    values[i + x]
                };
            }
        });
        across.solve(&mut turned, rows);
        let columns = across.asked.1 - across.asked.0 + 3;
        let mut weights = vec![0.0; rows * columns];
        across.asked_weights(|k, from| {
            let [(a, i), (b, j), (c, l)] = from.map(|(factor, line)| (factor, line * rows));
            let out = &mut weights[k * rows..][..rows];
            if b.abs() > 0.0 {
                for (y, out) in out.iter_mut().enumerate() {
                    *out = a * turned[i + y] + b * turned[j + y] + c * turned[l + y];
                }
            } else {
                out.copy_from_slice(&turned[i..i + rows]);
            }
        });
        let at = |(x, y): (usize, usize)| DVec2::new(x as f64, y as f64);
        Self {
            low: at((across.asked.0, down.asked.0)),
            high: at((across.asked.1, down.asked.1)),
            last: at((width - 1, height - 1)),
            rows,
            weights,
        }
    }

    /// The slope at a point, of one outside the picture that at its border; None outside the window.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "inside the window"
    )]
    pub(crate) fn slope(&self, p: DVec2) -> Option<DVec2> {
        let p = p.clamp(DVec2::ZERO, self.last);
        let pixel = (p + 0.5).floor().min(self.last);
        if !(pixel.cmpge(self.low).all() && pixel.cmple(self.high).all()) {
            return None;
        }
        let [x, y] = (p - pixel).to_array();
        let corner = pixel - self.low;
        let at = corner.x as usize * self.rows + corner.y as usize;
        let values = [
            0.5 * (0.5 - y) * (0.5 - y),
            0.75 - y * y,
            0.5 * (0.5 + y) * (0.5 + y),
        ];
        let slopes = [y - 0.5, -2.0 * y, y + 0.5];
        let column = |at: usize| {
            let c = &self.weights[at..at + 3];
            let value = values[0] * c[0] + values[1] * c[1] + values[2] * c[2];
            let slope = slopes[0] * c[0] + slopes[1] * c[1] + slopes[2] * c[2];
            (value, slope)
        };
        let [a, b, c] = [at, at + self.rows, at + 2 * self.rows].map(column);
        let along = (x - 0.5) * a.0 - 2.0 * x * b.0 + (x + 0.5) * c.0;
        let down = 0.5 * (0.5 - x) * (0.5 - x) * a.1
            + (0.75 - x * x) * b.1
            + 0.5 * (0.5 + x) * (0.5 + x) * c.1;
        Some(DVec2::new(along, down))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spline(f: impl Fn(f64, f64) -> f64, window: [usize; 4], whole: (usize, usize)) -> Spline {
        let across = Stretch::around(window[0], window[1], whole.0);
        let down = Stretch::around(window[2], window[3], whole.1);
        let mut values = Vec::new();
        for y in down.low..down.low + down.len {
            values.extend((across.low..across.low + across.len).map(|x| f(x as f64, y as f64)));
        }
        Spline::new(values, (across, down), whole)
    }

    #[test]
    fn parabolas_have_their_own_slope_up_to_the_border() {
        let f = |x: f64, y: f64| 1.0 + x - 2.0 * y + 0.3 * x * x - 0.2 * y * y + 0.1 * x * y;
        for whole in [(3, 3), (4, 7), (90, 70)] {
            let spline = spline(f, [0, whole.0 - 1, 0, whole.1 - 1], whole);
            for i in 0..=40 {
                let p = spline.last * DVec2::new(f64::from(i) / 40.0, f64::from(40 - i) / 40.0);
                let slope = spline.slope(p).unwrap();
                let true_slope =
                    DVec2::new(1.0 + 0.6 * p.x + 0.1 * p.y, -2.0 - 0.4 * p.y + 0.1 * p.x);
                // of sums of numbers up to 3000
                assert!(
                    slope.distance(true_slope) < 1e-9,
                    "{whole:?} {p}: {slope} {true_slope}"
                );
            }
        }
    }

    #[test]
    fn a_window_has_the_spline_of_the_whole_picture() {
        let rough = |x: f64, y: f64| (12.9898 * x + 78.233 * y).sin() * 100.0;
        let whole = (120, 110);
        let all = spline(rough, [0, 119, 0, 109], whole);
        for window in [[40, 60, 50, 70], [0, 20, 90, 109], [99, 119, 3, 30]] {
            let part = spline(rough, window, whole);
            for i in 0..50 {
                let share = DVec2::new(f64::from(i) / 49.0, f64::from(i * 7 % 50) / 49.0);
                let p = part.low + share * (part.high - part.low);
                let (a, b) = (all.slope(p).unwrap(), part.slope(p).unwrap());
                assert!(a.distance(b) < 1e-11, "{window:?} {p}: {a} {b}");
            }
            assert!(part.slope(DVec2::new(80.0, 80.0)).is_none());
        }
    }
}
