//! Neighbours: outlines that were looked for one by one, and whose starts lie apart, end with borders in common.

use glam::DVec2;

use crate::contact::{joined, pairs};
use crate::seeds::Circle;

/// Starts that share more of the smaller one are not apart: one lies in the other, or they cross.
const APART: f64 = 0.02;

/// An outline that shares more of the smaller one with a neighbour, after both have a common border, has taken it in.
const TAKEN_IN: f64 = 0.2;

/// Radius of the disk well inside a start, as a share of that of a disk of its area.
const WELL_INSIDE: f64 = 0.5;

/// Give closed outlines whose starts lie apart, as those of labels do, one common border where they overlap or are
/// nearer than 1.5 pixels. Returns which ones had taken in a neighbour: these become their starts.
///
/// ```
/// use glam::DVec2;
///
/// let square = |x: f64| [(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)].map(|(a, b)| DVec2::new(x + a, b)).to_vec();
/// let starts = [square(0.0), square(10.0)];
/// // found a little too large: they overlap
/// let mut outlines = starts.clone().map(|one| one.iter().map(|p| *p * 1.1).collect::<Vec<_>>());
/// assert!(instances::in_contact(&mut outlines, &starts).is_empty());
/// ```
pub fn in_contact(outlines: &mut [Vec<DVec2>], starts: &[Vec<DVec2>]) -> Vec<usize> {
    let circles: Vec<Circle> = starts.iter().map(|start| inner(start)).collect();
    let is_apart = |&(i, j): &(usize, usize)| shared(&starts[i], &starts[j]) <= APART;
    if !pairs(starts).iter().all(is_apart) {
        return Vec::new();
    }
    let before = outlines.to_vec();
    joined(outlines, &circles);
    let mut back: Vec<usize> = Vec::new();
    for (i, j) in pairs(outlines) {
        if shared(&outlines[i], &outlines[j]) > TAKEN_IN {
            // the one that has grown more
            let grown = |at: usize| area(&before[at]) / area(&starts[at]).max(1e-9);
            back.push(if grown(i) > grown(j) { i } else { j });
        }
    }
    back.sort_unstable();
    back.dedup();
    if !back.is_empty() {
        outlines.clone_from_slice(&before);
        for &at in &back {
            outlines[at].clone_from(&starts[at]);
        }
        joined(outlines, &circles);
    }
    back
}

/// Twice the area that a closed outline encloses, above 0 whichever way it runs.
fn area(points: &[DVec2]) -> f64 {
    elastic::signed_area(points).abs()
}

/// A disk well inside an outline: about the middle of its area.
fn inner(points: &[DVec2]) -> Circle {
    let origin = points.first().copied().unwrap_or_default();
    let (mut twice, mut sum) = (0.0, DVec2::ZERO);
    for (k, a) in points.iter().enumerate() {
        let (a, b) = (*a - origin, points[(k + 1) % points.len()] - origin);
        let part = a.perp_dot(b);
        twice += part;
        sum += part * (a + b);
    }
    let center = if twice.abs() > 1e-9 {
        origin + sum / (3.0 * twice)
    } else {
        origin
    };
    let radius = WELL_INSIDE * (0.5 * twice.abs() / std::f64::consts::PI).sqrt();
    Circle {
        center,
        radius: radius.max(1e-3),
    }
}

/// The area that two closed outlines share, as a share of the smaller one.
fn shared(a: &[DVec2], b: &[DVec2]) -> f64 {
    let range = |points: &[DVec2]| {
        let each = points.iter().map(|p| p.y);
        each.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| {
            (low.min(y), high.max(y))
        })
    };
    let (of_a, of_b) = (range(a), range(b));
    let (low, high) = (of_a.0.max(of_b.0), of_a.1.min(of_b.1));
    let smaller = area(a).min(area(b));
    if high <= low || smaller <= 0.0 {
        return 0.0;
    }
    let rows = (4.0 * (high - low)).ceil().clamp(16.0, 4096.0);
    let step = (high - low) / rows;
    let (mut y, mut common) = (low + 0.5 * step, 0.0);
    while y < high {
        let other = spans(b, y);
        for [from, to] in spans(a, y) {
            for [start, end] in &other {
                common += (to.min(*end) - from.max(*start)).max(0.0) * step;
            }
        }
        y += step;
    }
    common / smaller
}

/// Where a row lies inside a closed outline.
fn spans(points: &[DVec2], y: f64) -> Vec<[f64; 2]> {
    let mut crossings: Vec<f64> = Vec::new();
    for (k, a) in points.iter().enumerate() {
        let b = points[(k + 1) % points.len()];
        if (a.y <= y) != (b.y <= y) {
            crossings.push(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
        }
    }
    crossings.sort_by(f64::total_cmp);
    crossings
        .chunks_exact(2)
        .map(|pair| [pair[0], pair[1]])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn disc(x: f64, radius: f64) -> Vec<DVec2> {
        let angle = |k: u32| f64::from(k) * std::f64::consts::TAU / 120.0;
        (0..120)
            .map(|k| DVec2::new(x, 30.0) + radius * DVec2::from_angle(angle(k)))
            .collect()
    }

    #[test]
    fn neighbours_that_overlap_or_nearly_touch_have_a_common_border() {
        let starts = [disc(20.0, 9.5), disc(40.0, 9.5), disc(61.0, 9.5)];
        let mut outlines = [disc(20.0, 11.0), disc(40.0, 10.0), disc(61.0, 10.5)];
        assert!(shared(&outlines[0], &outlines[1]) > 0.01);
        assert_eq!(in_contact(&mut outlines, &starts), []);
        for (a, b) in [(0, 1), (1, 2)] {
            let common = shared(&outlines[a], &outlines[b]);
            assert!(common < 0.002, "{a} {b}: {common}");
        }
        // nor is there a gap, on the line of the middles and beside it
        for y in [28.0, 29.3, 30.1, 31.0] {
            let (one, other) = (spans(&outlines[0], y), spans(&outlines[1], y));
            let gap = other[0][0] - one[0][1];
            assert!(gap.abs() < 0.2, "{y}: {gap}");
        }
    }

    #[test]
    fn one_that_has_taken_in_its_neighbour_becomes_its_start() {
        let starts = [disc(20.0, 9.5), disc(40.0, 9.5)];
        let wide: Vec<DVec2> = disc(30.0, 10.0)
            .iter()
            .map(|p| DVec2::new(30.0 + 2.3 * (p.x - 30.0), 30.0 + 1.3 * (p.y - 30.0)))
            .collect();
        let mut outlines = [wide, disc(40.0, 9.8)];
        assert_eq!(in_contact(&mut outlines, &starts), [0]);
        assert!(shared(&outlines[0], &outlines[1]) < 0.002);
    }

    #[test]
    fn starts_that_lie_in_each_other_are_left_alone() {
        let starts = [disc(30.0, 20.0), disc(30.0, 8.0)];
        let mut outlines = [disc(30.0, 19.0), disc(30.0, 8.2)];
        let before = outlines.clone();
        assert_eq!(in_contact(&mut outlines, &starts), []);
        assert_eq!(outlines, before);
    }
}
