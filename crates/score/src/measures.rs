//! What one outline measures: its size, its place, its axes, how round it is.

use std::f64::consts::PI;

use crate::ScoreError;
use crate::mask::edges;
use glam::DVec2;
use outline::{Place, place};

/// Measures of one outline, exact for its polygons. Lengths in pixels, angles in radians.
///
/// Polygons must neither cross themselves nor each other: one in another is a hole, one in a hole a part again. The
/// names and definitions are those of `regionprops` of scikit-image and of `ImageJ`'s shape descriptors, but of the
/// polygon instead of pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Measures {
    /// Area less the holes, by the shoelace formula.
    pub area: f64,
    /// Length of all polygons, those of holes too.
    pub perimeter: f64,
    /// Center of the area.
    pub centroid: DVec2,
    /// Length of the longer axis of the ellipse that has the same second moments.
    pub major_axis: f64,
    /// Length of its shorter axis.
    pub minor_axis: f64,
    /// Direction of the longer axis, from +x towards +y, above −π/2 and up to π/2; 0 where no direction is longer.
    pub angle: f64,
    /// `4π A / P²` with the area A and the perimeter P: 1 of a circle, less of all else.
    pub circularity: f64,
    /// Area over that of the convex hull: 1 if convex.
    pub solidity: f64,
    /// Diameter of a circle of the same area.
    pub equivalent_diameter: f64,
    /// Least x and least y of the nodes.
    pub low: DVec2,
    /// Greatest x and greatest y of the nodes.
    pub high: DVec2,
}

/// Integrals over an area about some origin: 1; x, y; x², y², xy.
#[derive(Debug, Clone, Copy, Default)]
struct Moments {
    area: f64,
    first: DVec2,
    squares: DVec2,
    product: f64,
}

impl Moments {
    /// Of a closed polygon, signed by its sense.
    fn of(ring: &[DVec2], origin: DVec2) -> Self {
        let mut sum = Self::default();
        for (a, b) in edges(ring) {
            let (a, b) = (a - origin, b - origin);
            let cross = a.perp_dot(b);
            sum.area += cross / 2.0;
            sum.first += cross * (a + b) / 6.0;
            sum.squares += cross * (a * a + a * b + b * b) / 12.0;
            let mixed = a.x * b.y + 2.0 * (a.x * a.y + b.x * b.y) + b.x * a.y;
            sum.product += cross * mixed / 24.0;
        }
        sum
    }

    fn add(&mut self, weight: f64, other: Self) {
        self.area += weight * other.area;
        self.first += weight * other.first;
        self.squares += weight * other.squares;
        self.product += weight * other.product;
    }
}

impl Measures {
    /// Measure an outline. O(n log n), times the number of polygons for the holes.
    ///
    /// # Errors
    ///
    /// An outline without area, or with nodes that are not finite.
    pub fn of<R: AsRef<[DVec2]>>(rings: &[R]) -> Result<Self, ScoreError> {
        let rings: Vec<&[DVec2]> = rings.iter().map(AsRef::as_ref).collect();
        let nodes: Vec<DVec2> = rings.iter().flat_map(|ring| ring.iter().copied()).collect();
        let Some(&origin) = nodes.first() else {
            return Err(ScoreError::Flat);
        };
        let mut whole = Moments::default();
        for (index, ring) in rings.iter().enumerate() {
            let own = Moments::of(ring, origin);
            let Some(&node) = ring.first() else { continue };
            let around = rings
                .iter()
                .enumerate()
                .filter(|(other, ring)| *other != index && place(ring, node) == Place::Inside);
            let hole = around.count() % 2 == 1;
            // whichever way round it runs
            let weight = if hole == (own.area < 0.0) { 1.0 } else { -1.0 };
            whole.add(weight, own);
        }
        let area = whole.area;
        let perimeter: f64 = rings
            .iter()
            .flat_map(|ring| edges(ring))
            .map(|(a, b)| a.distance(b))
            .sum();
        let hull = Moments::of(&hull(&nodes), origin).area.abs();
        let (low, high) = nodes.iter().fold((origin, origin), |(low, high), p| {
            (low.min(*p), high.max(*p))
        });
        // less than what the rounding of its nodes may make of a line
        let least = 1e-14 * (high - low).length_squared();
        let usable = area.is_finite() && area > least && perimeter.is_finite();
        if !usable {
            return Err(ScoreError::Flat);
        }
        let center = whole.first / area;
        let squares = whole.squares / area - center * center;
        let product = whole.product / area - center.x * center.y;
        let (mean, half) = ((squares.x + squares.y) / 2.0, (squares.x - squares.y) / 2.0);
        let apart = half.hypot(product);
        let axis = |moment: f64| 4.0 * moment.max(0.0).sqrt();
        Ok(Self {
            area,
            perimeter,
            centroid: origin + center,
            major_axis: axis(mean + apart),
            minor_axis: axis(mean - apart),
            angle: if apart > 1e-12 * mean {
                0.5 * product.atan2(half)
            } else {
                0.0
            },
            circularity: 4.0 * PI * area / (perimeter * perimeter),
            solidity: (area / hull).min(1.0),
            equivalent_diameter: (4.0 * area / PI).sqrt(),
            low,
            high,
        })
    }
}

/// The convex hull: from the sorted points, those at which it turns `[andrew79]`.
fn hull(points: &[DVec2]) -> Vec<DVec2> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    sorted.dedup();
    let mut hull: Vec<DVec2> = Vec::new();
    let mut half = |points: &mut dyn Iterator<Item = DVec2>| {
        let base = hull.len();
        for p in points {
            while let [.., a, b] = hull[base..]
                && (b - a).perp_dot(p - b) <= 0.0
            {
                hull.pop();
            }
            hull.push(p);
        }
        hull.pop();
    };
    half(&mut sorted.iter().copied());
    half(&mut sorted.iter().rev().copied());
    hull
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::{FRAC_PI_2, TAU};

    fn ellipse(center: DVec2, half: DVec2, angle: f64, n: u32) -> Vec<DVec2> {
        let turn = DVec2::from_angle(angle);
        let on = |i: u32| half * DVec2::from_angle(f64::from(i) * TAU / f64::from(n));
        (0..n).map(|i| center + turn.rotate(on(i))).collect()
    }

    fn rectangle(low: DVec2, size: DVec2) -> Vec<DVec2> {
        let corner = |x: f64, y: f64| low + size * DVec2::new(x, y);
        vec![
            corner(0.0, 0.0),
            corner(1.0, 0.0),
            corner(1.0, 1.0),
            corner(0.0, 1.0),
        ]
    }

    fn close(got: f64, exact: f64, relative: f64) {
        assert!(
            (got - exact).abs() <= relative * exact.abs(),
            "{got} {exact}"
        );
    }

    #[test]
    fn an_ellipse_measures_as_its_formulas_say() {
        let (center, half, angle) = (DVec2::new(128.0, -64.0), DVec2::new(90.0, 40.0), 0.5);
        let got = Measures::of(&[ellipse(center, half, angle, 20_000)]).unwrap();
        // a polygon of n nodes in an ellipse lacks (2π/n)² / 6 of its area
        close(got.area, PI * 90.0 * 40.0, 2e-8);
        close(got.major_axis, 180.0, 2e-8);
        close(got.minor_axis, 80.0, 2e-8);
        close(got.angle, angle, 1e-12);
        assert!(got.centroid.distance(center) < 1e-9, "{}", got.centroid);
        // Ramanujan's second formula, good to 1e-8 at this shape
        let h = (50.0 / 130.0_f64).powi(2);
        let around = PI * 130.0 * (1.0 + 3.0 * h / (10.0 + (4.0 - 3.0 * h).sqrt()));
        close(got.perimeter, around, 1e-7);
        close(
            got.circularity,
            4.0 * PI * PI * 3600.0 / (around * around),
            3e-7,
        );
        assert_eq!(got.solidity, 1.0);
        close(got.equivalent_diameter, 2.0 * 60.0, 2e-8);
    }

    #[test]
    fn a_circle_is_as_round_as_can_be_and_has_no_direction() {
        let got =
            Measures::of(&[ellipse(DVec2::splat(50.0), DVec2::splat(12.0), 0.0, 4096)]).unwrap();
        close(got.circularity, 1.0, 1e-6);
        close(got.major_axis, 24.0, 1e-6);
        assert_eq!(got.angle, 0.0);
    }

    #[test]
    fn a_rectangle_with_a_square_hole_is_its_sums() {
        let outer = rectangle(DVec2::new(10.0, 20.0), DVec2::new(12.0, 6.0));
        let mut hole = rectangle(DVec2::new(12.0, 22.0), DVec2::splat(2.0));
        for _ in 0..2 {
            hole.reverse();
            let got = Measures::of(&[&hole, &outer]).unwrap();
            assert_eq!((got.area, got.perimeter), (68.0, 36.0 + 8.0));
            let center = (72.0 * DVec2::new(16.0, 23.0) - 4.0 * DVec2::new(13.0, 23.0)) / 68.0;
            assert!(got.centroid.distance(center) < 1e-13);
            close(got.solidity, 68.0 / 72.0, 1e-15);
            assert_eq!((got.low, got.high), (outer[0], outer[2]));
            // b h³ / 12 of each, all about one level; the axes are 4 √(I / A)
            let level = (12.0 * 216.0 - 2.0 * 8.0) / 12.0;
            close(got.minor_axis, 4.0 * (level / 68.0_f64).sqrt(), 1e-13);
        }
        // a part in the hole counts again
        let island = rectangle(DVec2::splat(22.5) - DVec2::X * 10.0, DVec2::ONE);
        let got = Measures::of(&[outer, hole, island]).unwrap();
        assert_eq!(got.area, 69.0);
    }

    #[test]
    fn an_upright_rectangle_has_its_longer_axis_along_y() {
        let got = Measures::of(&[rectangle(DVec2::ZERO, DVec2::new(3.0, 9.0))]).unwrap();
        close(got.angle.abs(), FRAC_PI_2, 1e-14);
        // √12 of a side is that of the moment, 4 / √12 the axis
        close(got.major_axis, 9.0 * 4.0 / 12.0_f64.sqrt(), 1e-14);
        close(got.circularity, 4.0 * PI * 27.0 / 576.0, 1e-14);
    }

    #[test]
    fn a_plus_has_the_solidity_of_its_hull() {
        // five unit squares: the hull is the square of 3 less four corners of 1/2
        let nodes = [
            (1, 0),
            (2, 0),
            (2, 1),
            (3, 1),
            (3, 2),
            (2, 2),
            (2, 3),
            (1, 3),
            (1, 2),
            (0, 2),
            (0, 1),
            (1, 1),
        ];
        let plus: Vec<DVec2> = nodes
            .iter()
            .map(|&(x, y)| DVec2::new(f64::from(x), f64::from(y)))
            .collect();
        let got = Measures::of(&[plus]).unwrap();
        close(got.solidity, 5.0 / 7.0, 1e-15);
        assert_eq!((got.area, got.perimeter), (5.0, 12.0));
    }

    #[test]
    fn what_encloses_nothing_is_refused() {
        let line = [DVec2::ZERO, DVec2::ONE * 0.1, DVec2::ONE * 0.3];
        assert_eq!(Measures::of(&[line]), Err(ScoreError::Flat));
        assert_eq!(Measures::of::<Vec<DVec2>>(&[]), Err(ScoreError::Flat));
        assert_eq!(
            Measures::of(&[[DVec2::ZERO, DVec2::X, DVec2::NAN]]),
            Err(ScoreError::Flat)
        );
    }

    proptest! {
        #[test]
        fn the_hull_holds_all_and_turns_one_way(
            points in prop::collection::vec((-9i32..9, -9i32..9), 3..30),
        ) {
            let points: Vec<DVec2> =
                points.iter().map(|&(x, y)| DVec2::new(f64::from(x), f64::from(y))).collect();
            let hull = hull(&points);
            for (a, b) in edges(&hull) {
                for p in &points {
                    // whole numbers: exact
                    prop_assert!((b - a).perp_dot(*p - a) >= 0.0, "{:?} {:?}", hull, p);
                }
            }
            prop_assert!(hull.iter().all(|p| points.contains(p)));
        }

        #[test]
        fn moments_are_those_of_small_squares(
            nodes in prop::collection::vec((0.0..8.0_f64, 0.0..8.0_f64), 3..4),
        ) {
            let ring: Vec<DVec2> = nodes.iter().map(|&p| p.into()).collect();
            let Ok(got) = Measures::of(&[&ring]) else { return Ok(()) };
            prop_assume!(got.area > 4.0);
            // the middle of each of 400 x 400 squares
            let fine: Vec<DVec2> = ring.iter().map(|p| *p * 50.0 - 0.5).collect();
            let mask = crate::filled(&[fine], (400, 400));
            let inside = mask.indexed_iter().filter(|(_, inside)| **inside);
            let places: Vec<DVec2> =
                inside.map(|((y, x), _)| (DVec2::new(x as f64, y as f64) + 0.5) / 50.0).collect();
            let count = places.len() as f64;
            let center = places.iter().sum::<DVec2>() / count;
            let spread = places.iter().map(|p| (*p - center) * (*p - center)).sum::<DVec2>() / count;
            let turned = DVec2::from_angle(2.0 * got.angle);
            let (major, minor) = (got.major_axis.powi(2) / 16.0, got.minor_axis.powi(2) / 16.0);
            let half = 0.5 * (major - minor) * turned.x;
            prop_assert!((got.area - count / 2500.0).abs() < 0.03 * got.area);
            prop_assert!(got.centroid.distance(center) < 0.05);
            prop_assert!((0.5 * (major + minor) + half - spread.x).abs() < 0.03 * major);
            prop_assert!((0.5 * (major + minor) - half - spread.y).abs() < 0.03 * major);
        }
    }
}
