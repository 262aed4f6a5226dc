//! The region search: what is like the inside and joined to it, whatever its shape.
//!
//! Rays and bands cannot follow a slot or a spike that is deeper than they are wide. The likelihood of the inside can:
//! the pixels where it is above that of the outside, joined to most of what is inside now, have an outline of any
//! shape. It is no search for the least energy, so it counts only with better evidence than the others.

use field::Grid;
use glam::DVec2;

use crate::edges::blurred;
use crate::rules::Rules;
use crate::smooth::smoothed;
use crate::view::View;
use crate::within::{WIDTH, free};

/// σ of the blur of the likelihood, in pixels of the window, and of the outline along itself.
const SIGMA: f64 = 1.2;
const ALONG: f64 = 1.5;

/// Rounds of learning what the inside looks like.
const ROUNDS: usize = 2;

/// The region may differ from what was inside before by this share of both together.
const ALIKE: f64 = 0.4;

/// The smooth outline tells as many pixels apart as its region, or less by this.
const LOSS: f64 = 0.02;

/// The outline of the region that a curve lies in; None where that is another thing.
pub(crate) fn flood(view: &View, rules: &Rules, curve: &[DVec2]) -> Option<Vec<DVec2>> {
    if rules.region <= 0.0 {
        return None;
    }
    let first = view.inside(curve);
    let mut inside = first.clone();
    for _ in 0..ROUNDS {
        let likelihood = blurred(&view.likelihood(&inside), SIGMA);
        inside = joined(&likelihood, &inside)?;
    }
    let both = first.iter().zip(&inside);
    let common = both.clone().filter(|(a, b)| **a && **b).count() as f64;
    let either = both.filter(|(a, b)| **a || **b).count() as f64;
    if common < ALIKE * either {
        return None;
    }
    if purity(view, &inside) < rules.pure - LOSS {
        return None; // the bands below would be for nothing
    }
    let mut outline = border(&inside, view.frame.dim())?;
    // from where the start begins, so that it turns with it
    let begin = *view.start.points.first()?;
    let away = |&a: &usize| outline[a].distance_squared(begin);
    let first = (0..outline.len()).min_by(|a, b| away(a).total_cmp(&away(b)))?;
    outline.rotate_left(first);
    let outline = smoothed(&outline, ALONG, true);
    Some(free(view, rules, outline, WIDTH))
}

/// The pixels above 0 that are joined, in the part that holds most of what is inside; its holes filled.
fn joined(likelihood: &Grid, inside: &[bool]) -> Option<Vec<bool>> {
    let (height, width) = likelihood.dim();
    let above: Vec<bool> = likelihood.iter().map(|value| *value > 0.0).collect();
    let parts = parts(&above, width);
    let mut common = vec![0_usize; parts.count];
    for (part, inside) in parts.of.iter().zip(inside) {
        if let Some(part) = part
            && *inside
        {
            common[*part] += 1;
        }
    }
    let most = (0..parts.count).max_by_key(|&part| common[part])?;
    let part: Vec<bool> = parts.of.iter().map(|of| *of == Some(most)).collect();
    // what cannot be reached from the window's border is a hole
    let outer = reached(&part, width, height);
    Some(outer.iter().map(|outer| !outer).collect())
}

/// Pixels by the part that they belong to, joined by their sides.
struct Parts {
    of: Vec<Option<usize>>,
    count: usize,
}

fn parts(cells: &[bool], width: usize) -> Parts {
    let mut of = vec![None; cells.len()];
    let mut count = 0;
    for begin in 0..cells.len() {
        if !cells[begin] || of[begin].is_some() {
            continue;
        }
        spread(begin, cells, true, width, |at| {
            let new = of[at].is_none();
            of[at] = Some(count);
            new
        });
        count += 1;
    }
    Parts { of, count }
}

/// The pixels outside of a part that can be reached from the border of the window.
fn reached(part: &[bool], width: usize, height: usize) -> Vec<bool> {
    let mut outer = vec![false; part.len()];
    let rim = (0..part.len()).filter(|at| {
        let (x, y) = (at % width, at / width);
        x == 0 || y == 0 || x + 1 == width || y + 1 == height
    });
    for begin in rim.filter(|&at| !part[at]) {
        if !outer[begin] {
            spread(begin, part, false, width, |at| {
                !std::mem::replace(&mut outer[at], true)
            });
        }
    }
    outer
}

/// Visit all pixels of the same kind that are joined to one; `visit` says whether a pixel is new.
fn spread(
    begin: usize,
    cells: &[bool],
    kind: bool,
    width: usize,
    mut visit: impl FnMut(usize) -> bool,
) {
    let mut front = vec![begin];
    while let Some(at) = front.pop() {
        if cells[at] != kind || !visit(at) {
            continue;
        }
        let x = at % width;
        if x > 0 {
            front.push(at - 1);
        }
        if x + 1 < width {
            front.push(at + 1);
        }
        if at >= width {
            front.push(at - width);
        }
        if at + width < cells.len() {
            front.push(at + width);
        }
    }
}

/// The outline of a part without holes: around its pixels, corner by corner, with the part on the right.
fn border(part: &[bool], (height, width): (usize, usize)) -> Option<Vec<DVec2>> {
    let first = part.iter().position(|inside| *inside)?;
    let inside = |x: isize, y: isize| {
        let within = x >= 0 && y >= 0 && x < width.cast_signed() && y < height.cast_signed();
        within && part[y.unsigned_abs() * width + x.unsigned_abs()]
    };
    // corner (x, y) is the upper left one of pixel (x, y); go right along the top of the first pixel
    let begin = ((first % width).cast_signed(), (first / width).cast_signed());
    let (mut at, mut way) = (begin, (1, 0));
    let mut points = Vec::new();
    loop {
        points.push(DVec2::new(at.0 as f64 - 0.5, at.1 as f64 - 0.5));
        at = (at.0 + way.0, at.1 + way.1);
        // the pixels ahead on either side of the way
        let right = |(dx, dy): (isize, isize)| (-dy, dx);
        let left = |(dx, dy): (isize, isize)| (dy, -dx);
        let ahead = |side: (isize, isize)| {
            let x = at.0 + (way.0 + side.0 - 1).div_euclid(2);
            let y = at.1 + (way.1 + side.1 - 1).div_euclid(2);
            inside(x, y)
        };
        way = if !ahead(right(way)) {
            right(way)
        } else if ahead(left(way)) {
            left(way)
        } else {
            way
        };
        if at == begin || points.len() > 4 * part.len() {
            break;
        }
    }
    Some(points)
}

/// The share of pixels that are told apart by what they look like: inside or outside, whichever is less.
pub(crate) fn purity(view: &View, inside: &[bool]) -> f64 {
    let likelihood = view.likelihood(inside);
    let (mut right, mut all) = ([0.0_f64; 2], [0.0_f64; 2]);
    for (at, (value, inside)) in likelihood.iter().zip(inside).enumerate() {
        if view.is_near(at) {
            let side = usize::from(*inside);
            all[side] += 1.0;
            right[side] += f64::from(u8::from((*value > 0.0) == *inside));
        }
    }
    (right[0] / all[0].max(1.0)).min(right[1] / all[1].max(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_border_goes_around_its_pixels_clockwise() {
        // an L of three pixels
        let part = [
            false, false, false, false, //
            false, true, false, false, //
            false, true, true, false, //
        ];
        let points = border(&part, (3, 4)).unwrap();
        assert_eq!(points.len(), 8);
        assert!((elastic::signed_area(&points) - 3.0).abs() < 1e-12);
    }

    #[test]
    fn the_part_that_holds_most_is_taken_and_its_holes_are_filled() {
        let rows = ["......#", ".###...", ".#.#..#", ".###..#"];
        let value = |c: char| if c == '#' { 1.0 } else { -1.0 };
        let list: Vec<f64> = rows.iter().flat_map(|row| row.chars().map(value)).collect();
        let likelihood = Grid::from_shape_vec((4, 7), list).unwrap();
        let inside: Vec<bool> = (0..28).map(|at| at % 7 < 3).collect();
        let part = joined(&likelihood, &inside).unwrap();
        assert_eq!(part.iter().filter(|inside| **inside).count(), 9);
    }
}
