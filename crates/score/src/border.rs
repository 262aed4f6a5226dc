//! The outlines of a mask: the level line halfway between its pixels.

use std::collections::BTreeMap;

use glam::DVec2;
use ndarray::Array2;

/// The border of a mask as closed polygons: the level line 1/2 of the mask as an image of 0 and 1, by marching squares
/// `[lorensen87]`.
///
/// Its nodes lie halfway between a pixel inside and a neighbour outside; beyond the picture all is outside, so what
/// reaches the border of the picture is closed along it, at −1/2. Pixels of the object that touch at a
/// corner only are
/// not joined: the convention of `find_contours` of scikit-image where the object is the higher level. Around objects
/// the area is positive (clockwise on the screen), around holes negative. A straight edge lies where the pixels end;
/// a corner of a right angle is cut off by 1/8 of a pixel.
///
/// In the order of their first node, by row and column. O(pixels + nodes log nodes).
///
/// ```
/// let mut mask = ndarray::Array2::from_elem((5, 5), false);
/// mask[[2, 3]] = true;
/// let around: Vec<(f64, f64)> = score::border(&mask)[0].iter().map(|&p| p.into()).collect();
/// assert_eq!(around, [(3.0, 1.5), (3.5, 2.0), (3.0, 2.5), (2.5, 2.0)]);
/// ```
#[must_use]
pub fn border(mask: &Array2<bool>) -> Vec<Vec<DVec2>> {
    let (height, width) = mask.dim();
    // row, column of a pixel counted from one outside the picture
    let inside = |row: usize, column: usize| {
        let within = (1..=height).contains(&row) && (1..=width).contains(&column);
        within && mask[[row - 1, column - 1]]
    };
    // nodes by row and column, in halves of a pixel
    let mut next: BTreeMap<(usize, usize), (usize, usize)> = BTreeMap::new();
    for row in 0..=height {
        for column in 0..=width {
            // clockwise around the cell between four pixels; edge k joins corners k and k + 1
            let corners = [
                inside(row, column),
                inside(row, column + 1),
                inside(row + 1, column + 1),
                inside(row + 1, column),
            ];
            let middles = [
                (2 * row, 2 * column + 1),
                (2 * row + 1, 2 * column + 2),
                (2 * row + 2, 2 * column + 1),
                (2 * row + 1, 2 * column),
            ];
            for begin in 0..4 {
                if corners[begin] || !corners[(begin + 1) % 4] {
                    continue;
                }
                // the run of corners inside after edge `begin` is cut off by a piece of the border
                let run = (1..4).take_while(|k| corners[(begin + k) % 4]).count();
                next.insert(middles[(begin + run) % 4], middles[begin]);
            }
        }
    }
    let mut rings = Vec::new();
    while let Some((first, mut at)) = next.pop_first() {
        let mut ring = vec![place(first)];
        while at != first {
            ring.push(place(at));
            let Some(after) = next.remove(&at) else { break };
            at = after;
        }
        rings.push(ring);
    }
    rings
}

/// Where a node is, in pixels.
fn place((row, column): (usize, usize)) -> DVec2 {
    0.5 * DVec2::new(column as f64, row as f64) - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Measures, filled};
    use proptest::prelude::*;

    #[test]
    fn the_border_of_a_rectangle_runs_where_its_pixels_end() {
        let mask =
            Array2::from_shape_fn((9, 8), |(y, x)| (2..6).contains(&y) && (1..4).contains(&x));
        let [ring] = &border(&mask)[..] else {
            panic!("one ring")
        };
        let measures = Measures::of(&[ring]).unwrap();
        // 3 × 4 pixels less four corners of 1/8
        assert_eq!(measures.area, 12.0 - 0.5);
        assert_eq!(
            (measures.low, measures.high),
            (DVec2::new(0.5, 1.5), DVec2::new(3.5, 5.5))
        );
        let around = 2.0 * (2.0 + 3.0) + 4.0 * 0.5_f64.sqrt();
        assert!(
            (measures.perimeter - around).abs() < 1e-14,
            "a sum of twelve edges"
        );
    }

    #[test]
    fn pixels_that_touch_at_a_corner_are_two_and_holes_that_do_are_one() {
        let mut mask = Array2::from_elem((4, 4), false);
        (mask[[1, 1]], mask[[2, 2]]) = (true, true);
        assert_eq!(border(&mask).len(), 2);
        let rings = border(&mask.mapv(|inside| !inside));
        assert_eq!(rings.len(), 2, "the picture's own border, and one hole");
        assert_eq!(rings[1].len(), 8);
    }

    #[test]
    fn nothing_has_no_border_and_all_has_that_of_the_picture() {
        assert!(border(&Array2::from_elem((3, 5), false)).is_empty());
        assert!(border(&Array2::from_elem((0, 0), true)).is_empty());
        let rings = border(&Array2::from_elem((3, 5), true));
        let measures = Measures::of(&rings).unwrap();
        assert_eq!(
            (measures.low, measures.high),
            (DVec2::splat(-0.5), DVec2::new(4.5, 2.5))
        );
    }

    proptest! {
        #[test]
        fn filling_the_border_gives_the_mask_back(pixels in prop::collection::vec(any::<bool>(), 42)) {
            let mask = Array2::from_shape_vec((6, 7), pixels).unwrap();
            let rings = border(&mask);
            prop_assert_eq!(&filled(&rings, (6, 7)), &mask);
            // one node for every pair of neighbours of which one is inside
            let inside = |y: i32, x: i32| {
                (0..6).contains(&y) && (0..7).contains(&x) && mask[[y as usize, x as usize]]
            };
            let pairs = (-1..6).flat_map(|y| (-1..7).map(move |x| (y, x)));
            let changes: usize = pairs.map(|(y, x)| {
                let here = inside(y, x);
                usize::from(here != inside(y, x + 1)) + usize::from(here != inside(y + 1, x))
            }).sum();
            prop_assert_eq!(rings.iter().map(Vec::len).sum::<usize>(), changes);
        }
    }
}
