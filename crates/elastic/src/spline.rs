//! From a few points to a curve of nodes.
//!
//! The report draws a cubic spline through the clicked points and takes nodes at even steps of the point's
//! index. Their distances then follow the clicks, while the stiffness assumes one distance for all (D61).
//! The corrected way is the same curve with nodes at even arc length.

use crate::arc::ArcTable;
use crate::cubic::Cubic;
use crate::spacing::check_points;
use crate::{ElasticError, End, Topology};
use glam::DVec2;

/// What is even from node to node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Parameter {
    /// The index of the points: the report's program.
    PointIndex,
    /// The length along the curve.
    ArcLength,
}

/// `n` nodes on a cubic spline through `points`.
///
/// Open: not-a-knot, so two points make a line and three one parabola (D62); the first node is the first
/// point and the last node the last one, which the report's right mouse button adds before it ends the
/// drawing (D64). Closed: periodic; node 0 is the first point, and the curve returns to it. Both over the
/// index of the points.
///
/// By [`Parameter::PointIndex`] node `i` of an open curve stands at index `1 + i (n₁ − 1)/(n − 1)` of n₁
/// points, computed exactly so (D63). By [`Parameter::ArcLength`] neighbours are one length apart along the
/// curve, to about 1e-12 of it, except within about 1e-9 of a cusp.
///
/// ```
/// use elastic::{Parameter, spline};
/// use glam::DVec2;
///
/// let line = spline(&[DVec2::ZERO, DVec2::new(4.0, 8.0)], 5, Parameter::PointIndex, false)?;
/// assert_eq!(line[1], DVec2::new(1.0, 2.0));
/// # Ok::<(), elastic::ElasticError>(())
/// ```
///
/// # Errors
///
/// Fewer than 2 points (3 closed), fewer than 3 nodes (5 closed), points that are not finite or all in
/// one place.
pub fn spline(
    points: &[DVec2],
    n: usize,
    parameter: Parameter,
    closed: bool,
) -> Result<Vec<DVec2>, ElasticError> {
    let needed = if closed { 3 } else { 2 };
    if points.len() < needed {
        return Err(ElasticError::TooFewPoints {
            needed,
            got: points.len(),
        });
    }
    check_points("point", points)?;
    let topology = if closed {
        Topology::Closed
    } else {
        Topology::open(End::Free)
    };
    topology.check_count(n)?;
    let curve = if closed {
        Cubic::periodic(points)
    } else {
        Cubic::not_a_knot(points)
    };
    let steps = if closed { n } else { n - 1 } as f64;
    Ok(match parameter {
        Parameter::PointIndex => {
            // one added and taken off again: the report counts from one, and rounds there
            let step = curve.pieces() as f64 / steps;
            (0..n)
                .map(|i| curve.at((1.0 + i as f64 * step) - 1.0))
                .collect()
        }
        Parameter::ArcLength => {
            let table = ArcTable::new(&curve);
            let mut nodes: Vec<_> = (0..n)
                .map(|i| curve.at(table.place(table.total() * (i as f64 / steps))))
                .collect();
            if !closed {
                nodes[n - 1] = points[points.len() - 1];
            }
            nodes
        }
    })
}

/// The same curve with `n` nodes at even arc length: [`spline`] through the old nodes.
///
/// # Errors
///
/// As [`spline`].
pub fn resample(curve: &[DVec2], n: usize, closed: bool) -> Result<Vec<DVec2>, ElasticError> {
    spline(curve, n, Parameter::ArcLength, closed)
}
