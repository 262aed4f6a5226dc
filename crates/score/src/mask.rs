//! Outlines as masks of pixels, and how well two masks agree.

use crate::ScoreError;
use glam::DVec2;
use ndarray::Array2;

/// The pixels whose centers are inside, as rows and columns.
///
/// A center on an edge belongs to the side to the right of it or, if the edge is level, below it: polygons that share
/// edges share no pixel and leave none out. An edge with an end that is not finite is left out. O(rows crossed +
/// pixels).
///
/// ```
/// use glam::DVec2;
///
/// let triangle = [DVec2::new(0.5, 0.5), DVec2::new(4.5, 0.5), DVec2::new(0.5, 4.5)];
/// let mask = score::filled(&[triangle], (6, 6));
/// assert_eq!(mask.iter().filter(|inside| **inside).count(), 6);
/// ```
#[must_use]
pub fn filled<R: AsRef<[DVec2]>>(rings: &[R], (height, width): (usize, usize)) -> Array2<bool> {
    // true where the inside begins or ends; walking along the row makes it the inside
    let mut turns = Array2::from_elem((height, width), false);
    for (a, b) in rings.iter().flat_map(|ring| edges(ring.as_ref())) {
        if !(a.is_finite() && b.is_finite()) {
            continue;
        }
        // always downwards, so that both polygons at a common edge cut a row at the same place
        let (upper, lower) = if a.y <= b.y { (a, b) } else { (b, a) };
        let first = upper.y.ceil().max(0.0);
        let slope = (lower.x - upper.x) / (lower.y - upper.y);
        let mut y = first;
        while y < lower.y && y < height as f64 {
            let x = upper.x + (y - upper.y) * slope;
            let column = x.ceil().max(0.0);
            if column < width as f64 {
                let at = [index(y), index(column)];
                turns[at] = !turns[at];
            }
            y += 1.0;
        }
    }
    for mut row in turns.rows_mut() {
        let mut inside = false;
        for pixel in &mut row {
            inside ^= *pixel;
            *pixel = inside;
        }
    }
    turns
}

/// The edges of a closed polygon.
pub(crate) fn edges(ring: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(a, b)| (*a, *b))
}

/// A number of rows or columns; what is not in a picture has been left out before.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a whole number between 0 and a number of rows or columns"
)]
const fn index(x: f64) -> usize {
    x as usize
}

/// Intersection over union: the share of the pixels of either mask that are in both; 1 if both are empty.
///
/// Also called the Jaccard index `[jaccard12]`.
///
/// # Errors
///
/// Masks of different sizes.
pub fn iou(a: &Array2<bool>, b: &Array2<bool>) -> Result<f64, ScoreError> {
    same_size(a.dim(), b.dim())?;
    let (mut both, mut either) = (0_usize, 0_usize);
    for (a, b) in a.iter().zip(b) {
        both += usize::from(*a && *b);
        either += usize::from(*a || *b);
    }
    Ok(if either == 0 {
        1.0
    } else {
        both as f64 / either as f64
    })
}

/// Refuse two sizes that differ.
pub(crate) fn same_size(first: (usize, usize), second: (usize, usize)) -> Result<(), ScoreError> {
    if first == second {
        return Ok(());
    }
    Err(ScoreError::Sizes { first, second })
}

#[cfg(test)]
mod tests {
    use super::*;
    use outline::winding;
    use proptest::prelude::*;

    fn rectangle(x: f64, y: f64, width: f64, height: f64) -> Vec<DVec2> {
        let corner = |i: f64, j: f64| DVec2::new(x + i * width, y + j * height);
        vec![
            corner(0.0, 0.0),
            corner(1.0, 0.0),
            corner(1.0, 1.0),
            corner(0.0, 1.0),
        ]
    }

    fn count(mask: &Array2<bool>) -> usize {
        mask.iter().filter(|inside| **inside).count()
    }

    #[test]
    fn whole_pixels_are_counted_and_a_hole_is_left_out() {
        let outer = rectangle(1.5, 2.5, 5.0, 4.0);
        let mut hole = rectangle(2.5, 3.5, 2.0, 1.0);
        assert_eq!(count(&filled(&[&outer], (10, 10))), 20);
        assert_eq!(count(&filled(&[&outer, &hole], (10, 10))), 18);
        hole.reverse();
        let mask = filled(&[&outer, &hole], (10, 10));
        assert_eq!(count(&mask), 18, "whichever way it runs");
        assert!(mask[[3, 2]] && !mask[[4, 3]] && !mask[[4, 4]] && mask[[4, 5]]);
    }

    #[test]
    fn what_leaves_the_picture_is_cut_and_what_is_no_place_is_left_out() {
        assert_eq!(
            count(&filled(&[rectangle(-9.0, -9.0, 99.0, 12.0)], (5, 4))),
            12
        );
        assert_eq!(count(&filled(&[rectangle(7.0, 7.0, 9.0, 9.0)], (5, 5))), 0);
        let nodes = [DVec2::NAN, DVec2::splat(2.0), DVec2::splat(f64::INFINITY)];
        assert_eq!(count(&filled(&[nodes], (5, 5))), 0);
        assert_eq!(count(&filled::<Vec<DVec2>>(&[], (5, 5))), 0);
        assert_eq!(
            filled(&[rectangle(0.0, 0.0, 1.0, 1.0)], (0, 3)).dim(),
            (0, 3)
        );
    }

    #[test]
    fn a_disc_has_the_pixels_that_its_equation_says() {
        let (center, radius) = (DVec2::new(15.3, 14.6), 11.7);
        let turn = |i: i32| DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / 4000.0);
        let ring: Vec<DVec2> = (0..4000).map(|i| center + radius * turn(i)).collect();
        let mask = filled(&[ring], (30, 31));
        for ((y, x), inside) in mask.indexed_iter() {
            let distance = DVec2::new(x as f64, y as f64).distance(center);
            // a polygon of so many nodes is within 4e-6 of its circle
            assert_eq!(*inside, distance < radius, "{x} {y} {distance}");
        }
    }

    #[test]
    fn the_iou_of_two_rectangles_is_that_of_their_areas() {
        let a = filled(&[rectangle(1.5, 1.5, 6.0, 6.0)], (12, 12));
        let b = filled(&[rectangle(4.5, 1.5, 6.0, 3.0)], (12, 12));
        assert_eq!(iou(&a, &b), Ok(9.0 / (36.0 + 18.0 - 9.0)));
        assert_eq!(iou(&a, &a), Ok(1.0));
        let empty = filled::<Vec<DVec2>>(&[], (12, 12));
        assert_eq!(iou(&a, &empty), Ok(0.0));
        assert_eq!(iou(&empty, &empty), Ok(1.0));
        let small = filled::<Vec<DVec2>>(&[], (12, 3));
        let error = iou(&a, &small).unwrap_err().to_string();
        assert_eq!(error, "sizes must be equal, got 12 × 12 and 3 × 12 pixels");
    }

    proptest! {
        #[test]
        fn a_pixel_is_inside_if_the_polygons_wind_around_it_an_odd_number_of_times(
            rings in prop::collection::vec(
                prop::collection::vec((-3.0..14.0_f64, -3.0..12.0_f64), 1..12), 1..4),
        ) {
            let rings: Vec<Vec<DVec2>> =
                rings.iter().map(|ring| ring.iter().map(|p| DVec2::from(*p)).collect()).collect();
            let mask = filled(&rings, (9, 11));
            for ((y, x), inside) in mask.indexed_iter() {
                let p = DVec2::new(x as f64, y as f64);
                let turns: Option<i32> = rings.iter().map(|ring| winding(ring, p)).sum();
                // nothing is said of what is on an edge, or on it but for rounding
                let near = rings.iter().any(|ring| outline::distance(ring, true, p) < 1e-9);
                if let (Some(turns), false) = (turns, near) {
                    prop_assert_eq!(*inside, turns.rem_euclid(2) == 1, "{} of {:?}", p, &rings);
                }
            }
        }

        #[test]
        fn two_halves_share_no_pixel_and_leave_none_out(
            ring in prop::collection::vec((0i32..24, 0i32..20), 3..9),
            cut in (0usize..3, 4usize..9),
        ) {
            // on a lattice of half pixels many centers lie on edges
            let ring: Vec<DVec2> = ring.iter()
                .map(|&(x, y)| 0.5 * DVec2::new(f64::from(x), f64::from(y))).collect();
            let (i, j) = (cut.0, cut.1.min(ring.len() - 1));
            let one = ring[i..=j].to_vec();
            let other: Vec<DVec2> = ring[j..].iter().chain(&ring[..=i]).copied().collect();
            let (one, other) = (filled(&[one], (12, 13)), filled(&[other], (12, 13)));
            let mut sum = one;
            sum.zip_mut_with(&other, |a, b| *a ^= *b);
            prop_assert_eq!(sum, filled(&[ring], (12, 13)));
        }
    }
}
