//! A polyline to slide along: the nearest point on it, and the way on from there.
//!
//! For ends that run along the border of a picture or along another curve.

use crate::error::check_points;
use crate::segments::{Nearest, Segment, push_curve, side};
use crate::{OutlineError, Spot};
use glam::DVec2;

/// A polyline with its lengths summed up, open or closed.
#[derive(Debug, Clone)]
pub struct Rail {
    segments: Vec<Segment>,
    /// Arc length at the start of each segment, and the whole at last.
    starts: Vec<f64>,
    closed: bool,
}

/// A point of a rail.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OnRail {
    /// On which edge of the polyline, and where.
    pub spot: Spot,
    /// Where that is. L.
    pub at: DVec2,
    /// Arc length from node 0. L.
    pub arc: f64,
    /// Unit vector along the rail; at a node halfway between its two edges.
    pub tangent: DVec2,
}

/// The point of a rail that is nearest to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foot {
    /// The nearest point; of several the one of least arc length.
    pub on: OnRail,
    /// How far it is. L.
    pub distance: f64,
    /// +1 on the side the normal `(t_y, −t_x)` points to, which is outside of a closed rail of positive
    /// area; −1 on the other; 0 on the rail.
    pub side: f64,
}

impl Rail {
    /// Lays a rail through the nodes. Nodes that repeat count once.
    ///
    /// # Errors
    /// Coordinates that are not finite or beyond 1e75; fewer than two nodes, or all in one place.
    pub fn new(nodes: &[DVec2], closed: bool) -> Result<Self, OutlineError> {
        check_points("node", nodes)?;
        if nodes.len() < 2 {
            let got = nodes.len();
            return Err(OutlineError::TooFewNodes {
                what: "a rail",
                needed: 2,
                got,
            });
        }
        let mut segments = Vec::new();
        push_curve(&mut segments, 0, nodes, closed);
        let mut starts = vec![0.0];
        let mut total = 0.0;
        for segment in &segments {
            total += segment.length();
            starts.push(total);
        }
        if total > 0.0 {
            return Ok(Self {
                segments,
                starts,
                closed,
            });
        }
        Err(OutlineError::NoLength { at: nodes[0] })
    }

    /// Length of the whole rail. L.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.starts[self.segments.len()]
    }

    /// The nearest point of the rail; none to a point that is not finite.
    ///
    /// O(n), allocates nothing. The side is exact for a rail that does not cross itself.
    #[must_use]
    pub fn nearest(&self, p: DVec2) -> Option<Foot> {
        if !p.is_finite() {
            return None;
        }
        let mut best: Option<(usize, Nearest)> = None;
        for (k, segment) in self.segments.iter().enumerate() {
            let nearest = segment.nearest(p);
            if best.is_none_or(|(_, best)| nearest.squared < best.squared) {
                best = Some((k, nearest));
            }
        }
        let (k, nearest) = best?;
        let index = u32::try_from(k).ok()?;
        Some(Foot {
            on: self.on(k, nearest.along),
            distance: nearest.squared.sqrt(),
            side: side(&self.segments, index, &nearest, p),
        })
    }

    /// The point at an arc length: round and round a closed rail, no farther than the ends of an open one.
    ///
    /// O(log n), allocates nothing. An arc length that is not a number is taken as 0.
    #[must_use]
    pub fn at_arc(&self, arc: f64) -> OnRail {
        let whole = self.length();
        let arc = if !arc.is_finite() {
            0.0
        } else if self.closed {
            arc.rem_euclid(whole)
        } else {
            arc.clamp(0.0, whole)
        };
        let last = self.segments.len() - 1;
        let k = self
            .starts
            .partition_point(|&start| start <= arc)
            .clamp(1, last + 1)
            - 1;
        let along = (arc - self.starts[k]) / self.segments[k].length();
        self.on(k, along.clamp(0.0, 1.0))
    }

    fn on(&self, k: usize, along: f64) -> OnRail {
        let segment = &self.segments[k];
        let neighbour = if along <= 0.0 {
            segment.before
        } else if along >= 1.0 {
            segment.after
        } else {
            crate::segments::NONE
        };
        let mut tangent = segment.tangent();
        if let Some(other) = self.segments.get(neighbour as usize) {
            // at a fold, where the two cancel, the edge's own
            let both = tangent + other.tangent();
            tangent = both.try_normalize().unwrap_or(tangent);
        }
        let at = if along < 1.0 {
            segment.a + along * (segment.b - segment.a)
        } else {
            segment.b
        };
        let (start, end) = (self.starts[k], self.starts[k + 1]);
        let arc = if along < 1.0 {
            start + along * (end - start)
        } else {
            end
        };
        OnRail {
            spot: Spot {
                edge: segment.edge as usize,
                along,
            },
            at,
            arc,
            tangent,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{distance, signed_distance};
    use proptest::prelude::*;

    fn square() -> Rail {
        let corners = [
            DVec2::ZERO,
            DVec2::new(4.0, 0.0),
            DVec2::new(4.0, 4.0),
            DVec2::new(0.0, 4.0),
        ];
        Rail::new(&corners, true).unwrap()
    }

    #[test]
    fn a_point_beside_a_square_finds_its_edge_and_one_past_a_corner_the_corner() {
        let foot = square().nearest(DVec2::new(3.0, -2.0)).unwrap();
        assert_eq!(
            (foot.on.at, foot.on.arc, foot.distance),
            (DVec2::new(3.0, 0.0), 3.0, 2.0)
        );
        assert_eq!((foot.on.tangent, foot.side), (DVec2::X, 1.0));
        let corner = square().nearest(DVec2::new(7.0, -4.0)).unwrap();
        assert_eq!(
            (corner.on.at, corner.distance, corner.side),
            (DVec2::new(4.0, 0.0), 5.0, 1.0)
        );
        // halfway between along x and along y, up to the rounding of a square root
        assert!((corner.on.tangent - DVec2::splat(0.5_f64.sqrt())).length() < 1e-15);
        assert_eq!(square().nearest(DVec2::new(1.0, 2.0)).unwrap().side, -1.0);
        assert_eq!(square().nearest(DVec2::NAN), None);
    }

    #[test]
    fn a_closed_rail_goes_round_and_an_open_one_ends() {
        assert_eq!(square().at_arc(18.0).at, DVec2::new(2.0, 0.0));
        assert_eq!(square().at_arc(-1.0).at, DVec2::new(0.0, 1.0));
        let open = Rail::new(&[DVec2::ZERO, DVec2::X, DVec2::X, DVec2::ONE], false).unwrap();
        assert_eq!(open.length(), 2.0);
        assert_eq!(open.at_arc(-5.0).at, DVec2::ZERO);
        assert_eq!(open.at_arc(5.0).at, DVec2::ONE);
        assert_eq!(
            open.at_arc(1.5).spot,
            Spot {
                edge: 2,
                along: 0.5
            }
        );
        assert_eq!(open.at_arc(f64::NAN).at, DVec2::ZERO);
    }

    #[test]
    fn a_rail_of_one_point_is_refused() {
        assert!(Rail::new(&[DVec2::ONE], false).is_err());
        let error = Rail::new(&[DVec2::ONE, DVec2::ONE], true).unwrap_err();
        assert_eq!(error, OutlineError::NoLength { at: DVec2::ONE });
    }

    proptest! {
        /// A star never crosses itself, so inside and outside are what winding says.
        #[test]
        fn side_and_distance_are_those_of_the_outline(
            radii in prop::collection::vec(1.0..9.0_f64, 3..30),
            x in -10.0..10.0_f64,
            y in -10.0..10.0_f64,
        ) {
            let n = radii.len() as f64;
            let nodes: Vec<DVec2> = radii
                .iter()
                .enumerate()
                .map(|(i, &r)| r * DVec2::from_angle(std::f64::consts::TAU * i as f64 / n))
                .collect();
            let p = DVec2::new(x, y);
            let foot = Rail::new(&nodes, true).unwrap().nearest(p).unwrap();
            prop_assert_eq!(foot.distance, distance(&nodes, true, p));
            prop_assert_eq!(foot.side * foot.distance, signed_distance(&nodes, p));
        }
    }
}
