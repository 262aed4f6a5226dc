//! How far two outlines are apart, and how much of each lies at the other.

use crate::ScoreError;
use crate::mask::edges;
use glam::DVec2;
use outline::Neighbours;

/// The longest piece that a sample stands for. Pixels.
const PIECE: f64 = 0.5;

/// The longest outline. Pixels.
const LONGEST: f64 = 8_388_608.0;

/// The largest distance that is looked up in the grid of edges; beyond, all edges are asked. Pixels.
const REACH: f64 = 32.0;

/// How well an outline that was found agrees with the true one. Lengths in pixels.
///
/// Both are walked along in pieces of at most half a pixel, and the distance of each piece's middle to the nearest
/// edge of the other outline is taken, pieces counted by their length.
///
/// - `mean`: the mean of the two mean distances, from the one to the other and back (the mean absolute distance of
///   segmentation challenges `[gerig01]`).
/// - `hausdorff`: the largest of all distances, nodes included `[hausdorff14]`; between samples it may be larger by
///   a quarter of a pixel at most.
/// - `precision`, `recall`: the share of what was found that lies within the tolerance of the truth, and of the truth
///   that lies within the tolerance of what was found; [`f`](Self::f) is their harmonic mean, the boundary F
///   `[martin04]`, here without matching of one point to one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Agreement {
    /// Mean distance of the two outlines.
    pub mean: f64,
    /// Their largest distance.
    pub hausdorff: f64,
    /// Share of the outline found that is near the truth.
    pub precision: f64,
    /// Share of the truth that is near the outline found.
    pub recall: f64,
}

impl Agreement {
    /// Compare the outline found with the true one; what is within `tolerance` is near.
    ///
    /// O(length × edges nearby); where the two are more than 32 pixels apart, O(length × edges). The same
    /// whichever way
    /// round the polygons run.
    ///
    /// # Errors
    ///
    /// An outline without points, with points that are not finite, or beyond a length of 2²³ pixels; a tolerance
    /// below 0.
    pub fn of<F: AsRef<[DVec2]>, T: AsRef<[DVec2]>>(
        found: &[F],
        truth: &[T],
        tolerance: f64,
    ) -> Result<Self, ScoreError> {
        if tolerance.is_nan() || tolerance < 0.0 {
            let (what, got) = ("the tolerance", tolerance);
            return Err(ScoreError::Negative { what, got });
        }
        let found: Vec<&[DVec2]> = found.iter().map(AsRef::as_ref).collect();
        let truth: Vec<&[DVec2]> = truth.iter().map(AsRef::as_ref).collect();
        let there = one_way("found", &found, "true", &truth, tolerance)?;
        let back = one_way("true", &truth, "found", &found, tolerance)?;
        Ok(Self {
            mean: 0.5 * (there.mean + back.mean),
            hausdorff: there.largest.max(back.largest),
            precision: there.near,
            recall: back.near,
        })
    }

    /// The harmonic mean of precision and recall; 0 if both are 0.
    #[must_use]
    pub fn f(&self) -> f64 {
        let sum = self.precision + self.recall;
        if sum > 0.0 {
            2.0 * self.precision * self.recall / sum
        } else {
            0.0
        }
    }
}

/// Distances of one outline from the other.
struct OneWay {
    mean: f64,
    largest: f64,
    near: f64,
}

fn one_way(
    name: &'static str,
    from: &[&[DVec2]],
    other: &'static str,
    to: &[&[DVec2]],
    tolerance: f64,
) -> Result<OneWay, ScoreError> {
    let mut nearest = Nearest::new(other, to)?;
    let (mut sum, mut near, mut largest) = (0.0, 0.0, 0.0_f64);
    let length = walk(name, from, |p, weight| {
        let distance = nearest.distance(p);
        largest = largest.max(distance);
        sum += weight * distance;
        if distance <= tolerance {
            near += weight;
        }
    })?;
    Ok(OneWay {
        mean: sum / length,
        largest,
        near: (near / length).min(1.0),
    })
}

/// Walk along an outline in pieces of at most half a pixel: each node with the weight 0, then the middle of each piece
/// with its length. Of an outline that has no length the nodes count 1 each. Gives the sum of the weights.
pub(crate) fn walk(
    name: &'static str,
    rings: &[&[DVec2]],
    mut visit: impl FnMut(DVec2, f64),
) -> Result<f64, ScoreError> {
    let all = || rings.iter().flat_map(|ring| edges(ring));
    let length: f64 = all().map(|(a, b)| a.distance(b)).sum();
    if length > LONGEST {
        return Err(ScoreError::Long(name, LONGEST, length));
    }
    if length <= 0.0 {
        let nodes: Vec<DVec2> = all().map(|(a, _)| a).collect();
        nodes.iter().for_each(|p| visit(*p, 1.0));
        return if nodes.is_empty() {
            Err(ScoreError::Empty(name))
        } else {
            Ok(nodes.len() as f64)
        };
    }
    for (a, b) in all() {
        visit(a, 0.0);
        let long = a.distance(b);
        let pieces = (long / PIECE).ceil();
        let mut k = 0.5;
        while k < pieces {
            visit(a.lerp(b, k / pieces), long / pieces);
            k += 1.0;
        }
    }
    Ok(length)
}

/// The distance to the nearest edge of an outline, for points that follow one another.
pub(crate) struct Nearest<'a> {
    rings: &'a [&'a [DVec2]],
    edges: Neighbours,
    /// The point asked about before, and its distance.
    last: Option<(DVec2, f64)>,
    found: Vec<outline::Near>,
}

impl<'a> Nearest<'a> {
    pub(crate) fn new(name: &'static str, rings: &'a [&'a [DVec2]]) -> Result<Self, ScoreError> {
        if rings.iter().all(|ring| ring.is_empty()) {
            return Err(ScoreError::Empty(name));
        }
        let mut edges = Neighbours::default();
        edges.rebuild(rings.iter().map(|ring| (*ring, true)), 4.0)?;
        Ok(Self {
            rings,
            edges,
            last: None,
            found: Vec::new(),
        })
    }

    pub(crate) fn distance(&mut self, p: DVec2) -> f64 {
        // it grows by no more than the way from the point before
        let reach = self.last.map_or(f64::INFINITY, |(before, distance)| {
            (distance + p.distance(before)) * (1.0 + 1e-9) + 1e-9
        });
        let mut least = f64::INFINITY;
        if reach <= REACH {
            self.edges.near_point(p, reach, &mut self.found);
            least = self
                .found
                .iter()
                .map(|near| near.distance)
                .fold(least, f64::min);
        }
        // far away; or the outline is a point, which has no edge
        if least.is_infinite() {
            let all = self
                .rings
                .iter()
                .map(|ring| outline::distance(ring, true, p));
            least = all.fold(least, f64::min);
        }
        self.last = Some((p, least));
        least
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn circle(center: DVec2, radius: f64) -> Vec<DVec2> {
        let turn = |i: i32| DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / 2000.0);
        (0..2000).map(|i| center + radius * turn(i)).collect()
    }

    fn square(low: f64, side: f64) -> Vec<DVec2> {
        let at = |x: f64, y: f64| DVec2::new(low + side * x, low + side * y);
        vec![at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)]
    }

    #[test]
    fn circles_about_one_center_are_as_far_apart_as_their_radii() {
        let (small, large) = (circle(DVec2::ONE, 20.0), circle(DVec2::ONE, 23.0));
        let apart = Agreement::of(&[&small], &[&large], 2.0).unwrap();
        // polygons of 2000 nodes are within 3e-5 of their circles
        assert!(
            (apart.mean - 3.0).abs() < 1e-4 && (apart.hausdorff - 3.0).abs() < 1e-4,
            "{apart:?}"
        );
        assert_eq!((apart.precision, apart.recall, apart.f()), (0.0, 0.0, 0.0));
        let apart = Agreement::of(&[&small], &[&large], 3.001).unwrap();
        assert_eq!(apart.f(), 1.0);
    }

    #[test]
    fn of_shifted_circles_the_distance_is_that_of_the_formula() {
        // of a point at angle t of the circle at (d, 0): | |(d + R cos t, R sin t)| − R |
        let (radius, d) = (30.0, 4.0);
        let (a, b) = (
            circle(DVec2::ZERO, radius),
            circle(DVec2::new(d, 0.0), radius),
        );
        let got = Agreement::of(&[&a], &[&b], 2.0).unwrap();
        let steps = 100_000;
        let far = |i: i32| {
            let t = f64::from(i) * std::f64::consts::TAU / f64::from(steps);
            ((d + radius * t.cos()).hypot(radius * t.sin()) - radius).abs()
        };
        let mean = (0..steps).map(far).sum::<f64>() / f64::from(steps);
        let near = (0..steps).filter(|&i| far(i) <= 2.0).count() as f64 / f64::from(steps);
        assert!((got.mean - mean).abs() < 1e-4, "{got:?} {mean}");
        assert!((got.hausdorff - d).abs() < 1e-4);
        // one piece of the circle's 2000 is at the limit at each of its four crossings
        assert!(
            (got.precision - near).abs() < 4.0 / 2000.0 && (got.recall - near).abs() < 4.0 / 2000.0
        );
    }

    #[test]
    fn a_square_in_a_square_is_measured_to_the_corners() {
        let (inner, outer) = (square(0.0, 10.0), square(-3.0, 16.0));
        let got = Agreement::of(&[&inner], &[&outer], 3.5).unwrap();
        assert!((got.hausdorff - 18.0_f64.sqrt()).abs() < 1e-12, "{got:?}");
        assert_eq!(got.precision, 1.0);
        // outside, the middle 10 of each 16 are 3 away; toward the corners √(9 + s²) up to s = 3
        let integral = |s: f64| 0.5 * (s * s.hypot(3.0) + 9.0 * (s / 3.0).asinh());
        let back = (10.0 * 3.0 + 2.0 * integral(3.0)) / 16.0;
        // the middle of pieces of half a pixel, second derivative 1/3 at most
        assert!(
            (got.mean - 0.5 * (3.0 + back)).abs() < 1e-3,
            "{got:?} {back}"
        );
        let reach = (3.5_f64.powi(2) - 9.0).sqrt();
        assert!((got.recall - (10.0 + 2.0 * reach) / 16.0).abs() < 0.5 / 16.0 * 2.0);
    }

    #[test]
    fn what_has_no_points_or_no_places_is_refused() {
        let line = circle(DVec2::ZERO, 5.0);
        let none: [Vec<DVec2>; 0] = [];
        for (message, got) in [
            (
                "the found outline has no points",
                Agreement::of(&none, &[&line], 2.0),
            ),
            (
                "the true outline has no points",
                Agreement::of(&[&line], &[Vec::new()], 2.0),
            ),
            (
                "must lie within 1e75",
                Agreement::of(&[&line], &[[DVec2::NAN]], 2.0),
            ),
            (
                "at most 8388608 pixels",
                Agreement::of(&[[DVec2::ZERO, DVec2::splat(1e9)]], &[&line], 2.0),
            ),
            (
                "the tolerance must be",
                Agreement::of(&[&line], &[&line], -1.0),
            ),
        ] {
            let error = got.unwrap_err().to_string();
            assert!(error.contains(message), "{error}");
        }
    }

    #[test]
    fn a_point_is_an_outline_too() {
        let got = Agreement::of(&[[DVec2::ZERO]], &[[DVec2::new(3.0, 4.0)]], 2.0).unwrap();
        assert_eq!((got.mean, got.hausdorff, got.f()), (5.0, 5.0, 0.0));
    }

    /// The same with all edges asked, and samples made anew.
    fn slow(from: &[Vec<DVec2>], to: &[Vec<DVec2>], tolerance: f64) -> [f64; 3] {
        let (mut sum, mut length, mut near, mut largest) = (0.0, 0.0, 0.0, 0.0_f64);
        for ring in from {
            for i in 0..ring.len() {
                let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
                let far = |p: DVec2| {
                    to.iter()
                        .map(|ring| outline::distance(ring, true, p))
                        .fold(f64::INFINITY, f64::min)
                };
                let pieces = (a.distance(b) / 0.5).ceil() as usize;
                largest = largest.max(far(a));
                for k in 0..pieces {
                    let share = (k as f64 + 0.5) / pieces as f64;
                    let (d, weight) = (far(a + (b - a) * share), a.distance(b) / pieces as f64);
                    (sum, length, largest) = (sum + d * weight, length + weight, largest.max(d));
                    near += if d <= tolerance { weight } else { 0.0 };
                }
            }
        }
        [sum / length, near / length, largest]
    }

    proptest! {
        #[test]
        fn it_is_what_asking_every_edge_gives(
            found in prop::collection::vec(prop::collection::vec((0.0..60.0_f64, 0.0..60.0_f64), 2..8), 1..3),
            truth in prop::collection::vec(prop::collection::vec((0.0..60.0_f64, 0.0..200.0_f64), 2..8), 1..3),
            tolerance in 0.0..9.0_f64,
        ) {
            let points = |rings: Vec<Vec<(f64, f64)>>| -> Vec<Vec<DVec2>> {
                rings.iter().map(|ring| ring.iter().map(|&p| p.into()).collect()).collect()
            };
            let (found, truth) = (points(found), points(truth));
            let got = Agreement::of(&found, &truth, tolerance).unwrap();
            let (there, back) = (slow(&found, &truth, tolerance), slow(&truth, &found, tolerance));
            prop_assert!((got.mean - 0.5 * (there[0] + back[0])).abs() < 1e-9);
            prop_assert!((got.hausdorff - there[2].max(back[2])).abs() < 1e-9);
            // a sample at the tolerance but for rounding may fall to either side
            prop_assert!((got.precision - there[1]).abs() < 1e-2 && (got.recall - back[1]).abs() < 1e-2);
        }
    }
}
