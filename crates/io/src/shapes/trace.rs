//! The outlines of pixels: along the cracks between them, or where a map passes a level.
//!
//! Pixels that share a side are connected, those that share a corner are not. A crack is half a
//! pixel off the centers on its sides, so the area of an outline is the number of its pixels.

use std::collections::BTreeMap;

use glam::DVec2;

use super::budget::Budget;

/// Numbers of pixels, row by row; 0 is the background.
#[derive(Debug)]
pub(crate) struct Labels {
    pub list: Vec<u32>,
    pub width: usize,
    pub height: usize,
}

/// The rings around the pixels of each number; with y down, those around pixels turn clockwise.
pub(crate) type Rings = BTreeMap<u32, Vec<Vec<DVec2>>>;

/// Right, down, left, up.
const AHEAD: [(isize, isize); 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

impl Labels {
    fn at(&self, x: isize, y: isize) -> u32 {
        match (usize::try_from(x), usize::try_from(y)) {
            (Ok(x), Ok(y)) if x < self.width && y < self.height => self.list[y * self.width + x],
            _ => 0,
        }
    }

    /// The outline of the pixels of each number.
    pub(crate) fn outlines(&self, budget: &mut Budget) -> Result<Rings, String> {
        self.rings(
            budget,
            |_, _| false,
            |crack| {
                let (x, y) = crack.end;
                (crack.turns).then(|| DVec2::new(x as f64 - 0.5, y as f64 - 0.5))
            },
        )
    }

    /// The rings along cracks, of the points that `point` makes of each; `joins` says of a corner
    /// whether pixels of one number that meet there alone are connected.
    fn rings(
        &self,
        budget: &mut Budget,
        joins: impl Fn(isize, isize) -> bool,
        point: impl Fn(&Crack) -> Option<DVec2>,
    ) -> Result<Rings, String> {
        let mut rings = Rings::new();
        let mut seen = vec![false; self.list.len()];
        for y in 0..self.height {
            for x in 0..self.width {
                let at = y * self.width + x;
                let own = self.list[at];
                let above = if y > 0 { self.list[at - self.width] } else { 0 };
                if own == 0 || own == above || seen[at] {
                    continue;
                }
                let mut ring = Vec::new();
                let start = (x.cast_signed(), y.cast_signed(), 0);
                let mut now = start;
                loop {
                    let (x, y, heading) = now;
                    if heading == 0 {
                        seen[y.cast_unsigned() * self.width + x.cast_unsigned()] = true;
                    }
                    let end = (x + AHEAD[heading].0, y + AHEAD[heading].1);
                    let (right, left) = beside(end.0, end.1, heading);
                    let (right, left) = (
                        self.at(right.0, right.1) == own,
                        self.at(left.0, left.1) == own,
                    );
                    let turn = match (right, left) {
                        (true, true) => 3,
                        (true, false) => 0,
                        (false, true) if joins(end.0, end.1) => 3,
                        (false, _) => 1,
                    };
                    let (inner, outer) = beside(x, y, heading);
                    let crack = Crack {
                        end,
                        inner,
                        outer,
                        turns: turn != 0,
                    };
                    if let Some(p) = point(&crack)
                        && ring.last() != Some(&p)
                    {
                        budget.points(1)?;
                        ring.push(p);
                    }
                    now = (end.0, end.1, (heading + turn) % 4);
                    if now == start {
                        break;
                    }
                }
                let ring = super::budget::unrepeated(ring);
                if ring.len() > 2 {
                    budget.ring(ring.len())?;
                    rings.entry(own).or_default().push(ring);
                }
            }
        }
        Ok(rings)
    }
}

/// A side of a pixel of the number that is followed, on its way around these pixels.
struct Crack {
    /// The corner that it leads to; the pixel of the same numbers is right below it.
    end: (isize, isize),
    /// The pixels on its right, which is of the number, and on its left.
    inner: (isize, isize),
    outer: (isize, isize),
    /// Whether the next crack leads elsewhere.
    turns: bool,
}

/// The pixels ahead of a corner, on the right and on the left of a heading.
const fn beside(x: isize, y: isize, heading: usize) -> ((isize, isize), (isize, isize)) {
    match heading {
        0 => ((x, y), (x, y - 1)),
        1 => ((x - 1, y), (x, y)),
        2 => ((x - 1, y - 1), (x - 1, y)),
        _ => ((x, y - 1), (x - 1, y - 1)),
    }
}

/// The connected parts of the pixels that are inside, numbered from 1 on as they come; `joins` says
/// of a corner whether pixels that meet there alone are connected.
pub(super) fn parts(inside: &[bool], width: usize, joins: impl Fn(isize, isize) -> bool) -> Labels {
    let mut parent: Vec<u32> = vec![0];
    let mut list = vec![0_u32; inside.len()];
    for at in 0..inside.len() {
        if !inside[at] {
            continue;
        }
        let (x, y) = (at % width, at / width);
        let mut own = 0;
        let mut near = |other: usize| {
            if inside[other] {
                own = union(&mut parent, own, list[other]);
            }
        };
        if x > 0 {
            near(at - 1);
        }
        if y > 0 {
            near(at - width);
            let (left, right) = (x.cast_signed(), x.cast_signed() + 1);
            if x > 0 && joins(left, y.cast_signed()) {
                near(at - width - 1);
            }
            if x + 1 < width && joins(right, y.cast_signed()) {
                near(at - width + 1);
            }
        }
        if own == 0 {
            own = u32::try_from(parent.len()).unwrap_or(u32::MAX);
            parent.push(own);
        }
        list[at] = own;
    }
    let mut numbers = vec![0; parent.len()];
    let mut count = 0;
    for own in &mut list {
        if *own > 0 {
            let root = root(&mut parent, *own) as usize;
            if numbers[root] == 0 {
                count += 1;
                numbers[root] = count;
            }
            *own = numbers[root];
        }
    }
    Labels {
        height: list.len().checked_div(width).unwrap_or(0),
        list,
        width,
    }
}

fn root(parent: &mut [u32], mut own: u32) -> u32 {
    while parent[own as usize] != own {
        parent[own as usize] = parent[parent[own as usize] as usize];
        own = parent[own as usize];
    }
    own
}

/// Join two parts; 0 is none.
fn union(parent: &mut [u32], one: u32, other: u32) -> u32 {
    let other = root(parent, other);
    if one == 0 {
        return other;
    }
    let one = root(parent, one);
    let (least, most) = (one.min(other), one.max(other));
    parent[most as usize] = least;
    least
}

/// Where a map passes a level, by straight lines between the crossings of its grid; beyond its
/// border it is taken to be 0. Each connected part has a number of its own.
pub(super) fn level_lines(
    map: &[f64],
    width: usize,
    level: f64,
    budget: &mut Budget,
) -> Result<Rings, String> {
    let height = map.len().checked_div(width).unwrap_or(0);
    let at = |(x, y): (isize, isize)| match (usize::try_from(x), usize::try_from(y)) {
        (Ok(x), Ok(y)) if x < width && y < height => map[y * width + x],
        _ => 0.0,
    };
    // pixels that meet at a corner are connected if the middle between the four is inside
    let joins = |x: isize, y: isize| {
        let four = [(x - 1, y - 1), (x, y - 1), (x - 1, y), (x, y)].map(at);
        four.iter().sum::<f64>() / 4.0 >= level
    };
    let inside: Vec<bool> = map.iter().map(|&v| v >= level).collect();
    parts(&inside, width, joins).rings(budget, joins, |crack| {
        let (high, low) = (at(crack.inner), at(crack.outer));
        let place = |(x, y): (isize, isize)| DVec2::new(x as f64, y as f64);
        let (from, to) = (place(crack.inner), place(crack.outer));
        Some(from + (to - from) * ((high - level) / (high - low)))
    })
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "areas of whole pixels are exact")]
mod tests {
    use super::*;
    use crate::shapes::rings::{area, even_odd_area};
    use proptest::prelude::*;

    fn outlines(rows: &[&str]) -> Rings {
        let inside: Vec<bool> = rows
            .iter()
            .flat_map(|r| r.bytes().map(|b| b == b'#'))
            .collect();
        let labels = parts(&inside, rows[0].len(), |_, _| false);
        labels.outlines(&mut Budget::default()).unwrap()
    }

    #[test]
    fn a_pixel_is_a_square_around_its_center_and_corners_do_not_connect() {
        let rings = outlines(&["#.", ".#"]);
        let square = |x: f64, y: f64| {
            [(0.5, -0.5), (0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5)]
                .map(|(a, b)| DVec2::new(x + a, y + b))
                .to_vec()
        };
        assert_eq!(rings[&1], [square(0.0, 0.0)]);
        assert_eq!(rings[&2], [square(1.0, 1.0)]);
    }

    #[test]
    fn holes_are_rings_of_their_part_that_turn_the_other_way() {
        let rings = outlines(&["#####", "#.#.#", "##.##", "#####"]);
        let areas: Vec<f64> = rings[&1].iter().map(|ring| area(ring)).collect();
        assert_eq!(areas.iter().sum::<f64>(), 17.0);
        assert_eq!((rings.len(), areas[0]), (1, 20.0));
    }

    #[test]
    fn a_level_line_between_two_levels_stands_at_its_share() {
        let mut map = vec![0.0; 25];
        map[12] = 0.8;
        let rings = level_lines(&map, 5, 0.5, &mut Budget::default()).unwrap();
        let ring = &rings[&1][0];
        assert_eq!(ring.len(), 4);
        for p in ring {
            let off = (*p - DVec2::splat(2.0)).length();
            assert!((off - 0.375).abs() < 1e-12, "{p}");
        }
    }

    proptest! {
        #[test]
        fn outlines_have_the_area_of_their_pixels(
            inside in prop::collection::vec(any::<bool>(), 1..120),
            width in 1_usize..12,
        ) {
            let whole = inside.len() / width * width;
            prop_assume!(whole > 0);
            let inside = &inside[..whole];
            let rings = parts(inside, width, |_, _| false).outlines(&mut Budget::default()).unwrap();
            let signed: f64 = rings.values().flatten().map(|ring| area(ring)).sum();
            let count = inside.iter().filter(|&&yes| yes).count() as f64;
            prop_assert_eq!(signed, count);
            let nested: f64 = rings.values().map(|rings| even_odd_area(rings).unwrap()).sum();
            prop_assert_eq!(nested, count);
        }

        #[test]
        fn level_lines_go_around_the_pixels_above_the_level(
            map in prop::collection::vec(0.0..1.0_f64, 1..100),
            width in 1_usize..12,
        ) {
            let whole = map.len() / width * width;
            prop_assume!(whole > 0);
            let map = &map[..whole];
            let rings = level_lines(map, width, 0.5, &mut Budget::default()).unwrap();
            let rings: Vec<Vec<DVec2>> = rings.into_values().flatten().collect();
            for (at, &value) in map.iter().enumerate() {
                let p = DVec2::new((at % width) as f64, (at / width) as f64);
                let around = rings.iter().filter(|ring| crate::shapes::rings::inside(ring, p)).count();
                prop_assert!((value - 0.5).abs() < 1e-9 || (around % 2 == 1) == (value >= 0.5));
            }
        }
    }
}
