//! Cubic splines over knots that follow the distances of the points.
//!
//! With widths `hᵢ` between knots the second derivatives solve
//!
//! ```text
//! hᵢ₋₁ Mᵢ₋₁ + 2 (hᵢ₋₁ + hᵢ) Mᵢ + hᵢ Mᵢ₊₁ = 6 (δᵢ/hᵢ − δᵢ₋₁/hᵢ₋₁),   δᵢ = p[i+1] − p[i]
//! ```
//!
//! whose rows are dominated by their diagonals, however uneven the widths. Over chords the right-hand side is a difference
//! of unit vectors: nothing is large but where the curve turns. Pieces are handed on over 0 to 1 each.
//!
//! Reference: `[deboor78]`, chapter 4.

use crate::cubic::Cubic;
use glam::DVec2;

/// Through at least two points that differ from their neighbours; `width` is above 0 for such.
pub(crate) fn open(points: &[DVec2], width: impl Fn(DVec2, DVec2) -> f64) -> Cubic {
    let n = points.len();
    let h: Vec<f64> = points.windows(2).map(|p| width(p[0], p[1])).collect();
    let mut second = vec![DVec2::ZERO; n];
    if n == 3 {
        second = vec![right(points, &h, 0, 1, 2) / (3.0 * (h[0] + h[1])); 3];
    } else if n > 3 {
        let last = n - 2;
        // M₀ = M₁ + a (M₁ − M₂), and so at the tail
        let (a, b) = ((h[0] / h[1]).min(1.0), (h[last] / h[last - 1]).min(1.0));
        let mut rows: Vec<Row> = (1..=last)
            .map(|i| Row {
                before: h[i - 1],
                here: 2.0 * (h[i - 1] + h[i]),
                after: h[i],
                right: right(points, &h, i - 1, i, i + 1),
            })
            .collect();
        let inner = rows.len() - 1;
        rows[0].here += h[0] * (1.0 + a);
        rows[0].after -= h[0] * a;
        rows[inner].here += h[last] * (1.0 + b);
        rows[inner].before -= h[last] * b;
        second[1..=last].copy_from_slice(&solve(&rows));
        second[0] = second[1] + a * (second[1] - second[2]);
        second[n - 1] = second[last] + b * (second[last] - second[last - 1]);
    }
    Cubic::from_pieces(
        (0..n - 1)
            .map(|i| piece(points, &second, h[i], i, i + 1))
            .collect(),
    )
}

/// Round at least three points that differ from their neighbours.
pub(crate) fn periodic(points: &[DVec2], width: impl Fn(DVec2, DVec2) -> f64) -> Cubic {
    let n = points.len();
    let h: Vec<f64> = (0..n)
        .map(|i| width(points[i], points[(i + 1) % n]))
        .collect();
    let rows: Vec<Row> = (0..n)
        .map(|i| {
            let before = (i + n - 1) % n;
            Row {
                before: h[before],
                here: 2.0 * (h[before] + h[i]),
                after: h[i],
                right: right(points, &h, before, i, (i + 1) % n),
            }
        })
        .collect();
    let second = solve_ring(&rows);
    Cubic::from_pieces(
        (0..n)
            .map(|i| piece(points, &second, h[i], i, (i + 1) % n))
            .collect(),
    )
}

/// One equation for the second derivatives.
#[derive(Clone, Copy)]
struct Row {
    before: f64,
    here: f64,
    after: f64,
    right: DVec2,
}

/// `6 (δᵢ/hᵢ − δᵢ₋₁/hᵢ₋₁)`.
fn right(points: &[DVec2], h: &[f64], before: usize, here: usize, after: usize) -> DVec2 {
    6.0 * ((points[after] - points[here]) / h[here] - (points[here] - points[before]) / h[before])
}

/// The cubic over a width `h` from point `i` to point `j`, over 0 to 1.
fn piece(points: &[DVec2], second: &[DVec2], h: f64, i: usize, j: usize) -> [DVec2; 4] {
    let (left, right) = (h * h * second[i], h * h * second[j]);
    let slope = (points[j] - points[i]) - (2.0 * left + right) / 6.0;
    [points[i], slope, left / 2.0, (right - left) / 6.0]
}

/// An open chain of equations, by elimination in order.
fn solve(rows: &[Row]) -> Vec<DVec2> {
    let mut ratio = Vec::with_capacity(rows.len());
    let mut x: Vec<DVec2> = Vec::with_capacity(rows.len());
    for (i, row) in rows.iter().enumerate() {
        let (carried, known) = if i == 0 {
            (0.0, DVec2::ZERO)
        } else {
            (ratio[i - 1], x[i - 1])
        };
        let pivot = row.here - row.before * carried;
        ratio.push(row.after / pivot);
        x.push((row.right - row.before * known) / pivot);
    }
    for i in (0..rows.len() - 1).rev() {
        let next = x[i + 1];
        x[i] -= ratio[i] * next;
    }
    x
}

/// A ring of equations: the chain without the last, once for the right-hand side and once for what the last feeds in.
fn solve_ring(rows: &[Row]) -> Vec<DVec2> {
    let last = rows.len() - 1;
    let border: Vec<Row> = (0..last)
        .map(|i| {
            let first = if i == 0 { rows[0].before } else { 0.0 };
            let final_one = if i + 1 == last {
                rows[last - 1].after
            } else {
                0.0
            };
            Row {
                right: DVec2::new(first + final_one, 0.0),
                ..rows[i]
            }
        })
        .collect();
    let (mut x, fed) = (solve(&rows[..last]), solve(&border));
    let end = &rows[last];
    let known = end.right - end.after * x[0] - end.before * x[last - 1];
    let value = known / (end.here - end.after * fed[0].x - end.before * fed[last - 1].x);
    for (x, fed) in x.iter_mut().zip(&fed) {
        *x -= fed.x * value;
    }
    x.push(value);
    x
}
