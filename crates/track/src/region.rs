//! Connected regions of cells: found, outlined, measured.

use glam::DVec2;
use search::smooth::smoothed;

use crate::ring;

/// Smoothing of traced outlines, and the distance of their nodes. Cells.
const SMOOTH: f64 = 1.0;
const SPACING: f64 = 1.5;

/// A rectangle of cells: the first column and row, and those behind the last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Rectangle {
    pub left: usize,
    pub top: usize,
    pub right: usize,
    pub bottom: usize,
}

impl Rectangle {
    /// The cells within `margin` of a curve, as far as a grid of that size goes.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the grid"
    )]
    pub(crate) fn about(curve: &[DVec2], margin: f64, (width, height): (usize, usize)) -> Self {
        let (low, high) = ring::bounds(curve);
        let clamped = |v: f64, most: usize| v.clamp(0.0, most as f64) as usize;
        Self {
            left: clamped((low.x - margin).floor(), width),
            top: clamped((low.y - margin).floor(), height),
            right: clamped((high.x + margin).ceil() + 1.0, width),
            bottom: clamped((high.y + margin).ceil() + 1.0, height),
        }
    }
}

/// Cells that hang together by their sides.
#[derive(Debug, Clone)]
pub(crate) struct Region {
    /// Their numbers in the grid.
    pub cells: Vec<usize>,
    /// How many columns the grid has.
    width: usize,
    /// Whether one of them lies at the border of the grid.
    pub at_border: bool,
}

/// The regions of those cells of a rectangle that are `in_it`, by their first cells.
pub(crate) fn regions(
    (width, height): (usize, usize),
    within: Rectangle,
    in_it: impl Fn(usize) -> bool,
) -> Vec<Region> {
    let (columns, rows) = (
        within.right.saturating_sub(within.left),
        within.bottom.saturating_sub(within.top),
    );
    let mut done = vec![false; columns * rows];
    let at = |x: usize, y: usize| (within.top + y) * width + within.left + x;
    let mut found = Vec::new();
    for first in 0..columns * rows {
        if done[first] || !in_it(at(first % columns, first / columns)) {
            continue;
        }
        done[first] = true;
        let (mut cells, mut at_border) = (Vec::new(), false);
        let mut waiting = vec![first];
        while let Some(one) = waiting.pop() {
            let (x, y) = (one % columns, one / columns);
            let (u, v) = (within.left + x, within.top + y);
            cells.push(at(x, y));
            at_border |= u == 0 || v == 0 || u + 1 == width || v + 1 == height;
            let beside = [
                (x > 0).then(|| one - 1),
                (x + 1 < columns).then_some(one + 1),
                (y > 0).then(|| one - columns),
                (y + 1 < rows).then_some(one + columns),
            ];
            for next in beside.into_iter().flatten() {
                if !done[next] && in_it(at(next % columns, next / columns)) {
                    done[next] = true;
                    waiting.push(next);
                }
            }
        }
        cells.sort_unstable();
        found.push(Region {
            cells,
            width,
            at_border,
        });
    }
    found
}

/// A region alone in a rectangle with an empty margin of one cell.
struct Patch {
    left: isize,
    top: isize,
    columns: usize,
    rows: usize,
    full: Vec<bool>,
}

impl Patch {
    fn of(region: &Region) -> Self {
        let places = || {
            region
                .cells
                .iter()
                .map(|at| (at % region.width, at / region.width))
        };
        let (mut left, mut right, mut top, mut bottom) = (usize::MAX, 0, usize::MAX, 0);
        for (x, y) in places() {
            (left, right) = (left.min(x), right.max(x));
            (top, bottom) = (top.min(y), bottom.max(y));
        }
        let (columns, rows) = (right + 3 - left, bottom + 3 - top);
        let mut full = vec![false; columns * rows];
        for (x, y) in places() {
            full[(y + 1 - top) * columns + x + 1 - left] = true;
        }
        Self {
            left: left.cast_signed() - 1,
            top: top.cast_signed() - 1,
            columns,
            rows,
            full,
        }
    }
}

impl Region {
    /// Its two parts on either side of a line.
    pub(crate) fn split(&self, from: DVec2, to: DVec2) -> [Self; 2] {
        let way = to - from;
        let (left, right) = self.cells.iter().partition(|at| {
            let p = DVec2::new((*at % self.width) as f64, (*at / self.width) as f64);
            way.perp_dot(p - from) < 0.0
        });
        [left, right].map(|cells| Self { cells, ..*self })
    }

    /// Its outer outline, clockwise on the screen, smoothed.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a count of nodes"
    )]
    pub(crate) fn outline(&self) -> Vec<DVec2> {
        let patch = Patch::of(self);
        let full = |x: usize, y: usize| patch.full[y * patch.columns + x];
        let Some(first) = patch.full.iter().position(|full| *full) else {
            return Vec::new();
        };
        // corners of cells, with the region on the right: east, south, west, north
        let start = (first % patch.columns, first / patch.columns);
        let (mut corner, mut way) = (start, 0_usize);
        let mut points = Vec::new();
        loop {
            let (x, y) = corner;
            let (next, ahead) = match way {
                0 => ((x + 1, y), [(x, y), (x, y - 1)]),
                1 => ((x, y + 1), [(x - 1, y), (x, y)]),
                2 => ((x - 1, y), [(x - 1, y - 1), (x - 1, y)]),
                _ => ((x, y - 1), [(x, y - 1), (x - 1, y - 1)]),
            };
            let [right, left] = ahead.map(|(x, y)| full(x, y));
            if !right {
                way = (way + 1) % 4;
            } else if left {
                way = (way + 3) % 4;
            } else {
                let middle = DVec2::new((x + next.0) as f64, (y + next.1) as f64) / 2.0;
                points.push(middle + DVec2::new(patch.left as f64, patch.top as f64) - 0.5);
                corner = next;
            }
            if corner == start && way == 0 && !points.is_empty() {
                break;
            }
        }
        let points = smoothed(&points, SMOOTH, true);
        let count = (points.len() as f64 / SPACING).max(8.0) as usize;
        ring::evenly(&points, count).0
    }

    /// The distance of its innermost cell from what is not in it, diagonal steps counted as 4/3. Cells.
    pub(crate) fn depth(&self) -> f64 {
        let patch = Patch::of(self);
        let (columns, rows) = (patch.columns, patch.rows);
        let mut far: Vec<u32> = patch
            .full
            .iter()
            .map(|full| if *full { u32::MAX / 2 } else { 0 })
            .collect();
        for y in 1..rows - 1 {
            for x in 1..columns - 1 {
                let at = y * columns + x;
                let straight = far[at - 1].min(far[at - columns]) + 3;
                let oblique = far[at - columns - 1].min(far[at - columns + 1]) + 4;
                far[at] = far[at].min(straight).min(oblique);
            }
        }
        for y in (1..rows - 1).rev() {
            for x in (1..columns - 1).rev() {
                let at = y * columns + x;
                let straight = far[at + 1].min(far[at + columns]) + 3;
                let oblique = far[at + columns + 1].min(far[at + columns - 1]) + 4;
                far[at] = far[at].min(straight).min(oblique);
            }
        }
        f64::from(far.into_iter().max().unwrap_or(0)) / 3.0
    }
}

/// A set of cells with those within so many steps of it.
pub(crate) fn grown((width, height): (usize, usize), set: &[bool], steps: usize) -> Vec<bool> {
    let mut now = set.to_vec();
    for _ in 0..steps {
        let before = now.clone();
        for y in 0..height {
            for x in 0..width {
                let at = y * width + x;
                now[at] |= (x > 0 && before[at - 1])
                    || (x + 1 < width && before[at + 1])
                    || (y > 0 && before[at - width])
                    || (y + 1 < height && before[at + width]);
            }
        }
    }
    now
}

/// Call `each` with the cells whose middle lies inside a curve.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the grid first"
)]
pub(crate) fn filled(
    (width, height): (usize, usize),
    curve: &[DVec2],
    mut each: impl FnMut(usize),
) {
    let rectangle = Rectangle::about(curve, 0.0, (width, height));
    for y in rectangle.top..rectangle.bottom {
        for [from, to] in ring::spans(curve, y as f64) {
            let from = from.ceil().clamp(0.0, width as f64) as usize;
            let to = (to.floor() + 1.0).clamp(0.0, width as f64) as usize;
            (from..to).for_each(|x| each(y * width + x));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn disc(width: usize, height: usize, center: DVec2, radius: f64) -> Vec<bool> {
        (0..width * height)
            .map(|at| {
                let p = DVec2::new((at % width) as f64, (at / width) as f64);
                p.distance(center) <= radius
            })
            .collect()
    }

    const ALL: Rectangle = Rectangle {
        left: 0,
        top: 0,
        right: 60,
        bottom: 50,
    };

    #[test]
    fn two_discs_are_two_regions_with_their_outlines() {
        let size = (60, 50);
        let a = disc(60, 50, DVec2::new(18.0, 20.0), 10.0);
        let b = disc(60, 50, DVec2::new(55.0, 30.0), 8.0);
        let found = regions(size, ALL, |at| a[at] || b[at]);
        assert_eq!(found.len(), 2);
        assert!(!found[0].at_border && found[1].at_border);
        let outline = found[0].outline();
        assert!(
            outline
                .iter()
                .all(|p| (p.distance(DVec2::new(18.0, 20.0)) - 10.2).abs() < 0.8)
        );
        // clockwise on the screen
        assert!(elastic::signed_area(&outline) > 0.0);
        assert!((elastic::signed_area(&outline) / found[0].cells.len() as f64 - 1.0).abs() < 0.05);
        assert!(
            (found[0].depth() - 10.5).abs() < 1.0,
            "{}",
            found[0].depth()
        );
    }

    #[test]
    fn cells_that_touch_at_a_corner_are_two_regions() {
        let set = |at: usize| at == 5 * 60 + 5 || at == 6 * 60 + 6;
        let found = regions((60, 50), ALL, set);
        assert_eq!(found.len(), 2);
        assert_eq!(found[0].cells, vec![5 * 60 + 5]);
    }

    #[test]
    fn filling_an_outline_gives_its_cells() {
        let size = (60, 50);
        let a = disc(60, 50, DVec2::new(18.0, 20.0), 10.0);
        let mut cells = Vec::new();
        let curve: Vec<DVec2> = (0..400)
            .map(|i| {
                let angle = std::f64::consts::TAU * f64::from(i) / 400.0;
                DVec2::new(18.0, 20.0) + 10.02 * DVec2::from_angle(angle)
            })
            .collect();
        filled(size, &curve, |at| cells.push(at));
        assert_eq!(cells.len(), a.iter().filter(|one| **one).count());
        assert!(cells.iter().all(|at| a[*at]));
    }
}
