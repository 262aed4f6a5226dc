//! Cubic splines over the index of their points. Over other knots: `knots`.
//!
//! Knots stand at the whole numbers, so the equations for the second derivatives have the constant row
//! 1, 4, 1 and a division-free right-hand side. Open splines are *not-a-knot*: the third derivative does not
//! jump at the second and the second-last point, so the first two pieces are one cubic, and so are the last
//! two. That is what MATLAB's `spline` does, and hence the report's program. Closed ones are periodic.
//!
//! Reference: `[deboor78]`, chapter 4.

use glam::DVec2;

/// A piecewise cubic curve through points at u = 0, 1, 2, …
#[derive(Debug, Clone)]
pub(crate) struct Cubic {
    /// One a piece: value, first derivative, half the second, a sixth of the third, at its left end.
    pieces: Vec<[DVec2; 4]>,
}

impl Cubic {
    /// Not-a-knot through at least two points: two make a line, three a parabola.
    pub(crate) fn not_a_knot(points: &[DVec2]) -> Self {
        let n = points.len();
        let mut second = vec![DVec2::ZERO; n];
        for i in 1..n.saturating_sub(1) {
            second[i] = second_difference(points[i - 1], points[i], points[i + 1]);
        }
        match n {
            0..=2 => {}
            3 => second = vec![second[1]; 3],
            _ => {
                // with no jump of the third derivative, 1 4 1 at node 1 becomes 6 M₁ = 6 δ₁
                solve_141(&mut second[1..n - 1]);
                second[0] = 2.0 * second[1] - second[2];
                second[n - 1] = 2.0 * second[n - 2] - second[n - 3];
            }
        }
        Self {
            pieces: (0..n - 1)
                .map(|i| piece(points, &second, i, i + 1))
                .collect(),
        }
    }

    /// Periodic through at least three points; the last piece leads back to the first point.
    pub(crate) fn periodic(points: &[DVec2]) -> Self {
        let n = points.len();
        let rhs: Vec<_> = (0..n)
            .map(|i| {
                6.0 * second_difference(points[(i + n - 1) % n], points[i], points[(i + 1) % n])
            })
            .collect();
        let second = solve_cyclic_141(rhs);
        Self {
            pieces: (0..n)
                .map(|i| piece(points, &second, i, (i + 1) % n))
                .collect(),
        }
    }

    /// From pieces that are known, each over 0 to 1.
    pub(crate) const fn from_pieces(pieces: Vec<[DVec2; 4]>) -> Self {
        Self { pieces }
    }

    /// Number of pieces: u runs from 0 to this.
    pub(crate) const fn pieces(&self) -> usize {
        self.pieces.len()
    }

    /// The point at `u`; beyond the ends the outermost piece goes on.
    pub(crate) fn at(&self, u: f64) -> DVec2 {
        let (i, t) = self.locate(u);
        let [a, b, c, d] = self.pieces[i];
        a + t * (b + t * (c + t * d))
    }

    /// |dv/du| at the offset `t` into piece `i`.
    pub(crate) fn speed(&self, i: usize, t: f64) -> f64 {
        let [_, b, c, d] = self.pieces[i];
        (b + t * (2.0 * c + t * (3.0 * d))).length()
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the floor of a number from 0 to the number of pieces"
    )]
    fn locate(&self, u: f64) -> (usize, f64) {
        let i = (u.max(0.0).floor() as usize).min(self.pieces.len() - 1);
        (i, u - i as f64)
    }
}

fn second_difference(before: DVec2, here: DVec2, after: DVec2) -> DVec2 {
    (after - here) - (here - before)
}

/// The cubic from point `i` to point `j` with the given second derivatives.
fn piece(points: &[DVec2], second: &[DVec2], i: usize, j: usize) -> [DVec2; 4] {
    let slope = (points[j] - points[i]) - (2.0 * second[i] + second[j]) / 6.0;
    [
        points[i],
        slope,
        second[i] / 2.0,
        (second[j] - second[i]) / 6.0,
    ]
}

/// Solves `m[i−1] + 4 m[i] + m[i+1] = 6 d[i]` inside, with `m = d` at the two ends, in place.
fn solve_141(d: &mut [DVec2]) {
    let n = d.len();
    if n < 3 {
        return;
    }
    let mut ratio = vec![0.0; n];
    for i in 1..n - 1 {
        let pivot = 4.0 - ratio[i - 1];
        ratio[i] = 1.0 / pivot;
        d[i] = (6.0 * d[i] - d[i - 1]) / pivot;
    }
    for i in (1..n - 1).rev() {
        let next = d[i + 1];
        d[i] -= ratio[i] * next;
    }
}

/// Solves `m[i−1] + 4 m[i] + m[i+1] = b[i]` round a ring of at least three.
///
/// The open chain of rows 0 to n−2 is solved twice, once for `b` and once for what the last unknown
/// feeds into it; the last row then gives that unknown.
fn solve_cyclic_141(mut b: Vec<DVec2>) -> Vec<DVec2> {
    let n = b.len();
    let last = n - 1;
    let mut border = vec![0.0; last];
    border[0] = 1.0;
    border[last - 1] = 1.0;
    let mut ratio = vec![0.0; last];
    for i in 0..last {
        let before = if i == 0 { 0.0 } else { ratio[i - 1] };
        let pivot = 4.0 - before;
        ratio[i] = 1.0 / pivot;
        if i > 0 {
            let (carried, fed) = (b[i - 1], border[i - 1]);
            b[i] -= carried;
            border[i] -= fed;
        }
        b[i] /= pivot;
        border[i] /= pivot;
    }
    for i in (0..last - 1).rev() {
        let (next, fed) = (b[i + 1], border[i + 1]);
        b[i] -= ratio[i] * next;
        border[i] -= ratio[i] * fed;
    }
    let known = b[last] - b[0] - b[last - 1];
    let end = known / (4.0 - border[0] - border[last - 1]);
    b[last] = end;
    for i in 0..last {
        b[i] -= border[i] * end;
    }
    b
}
