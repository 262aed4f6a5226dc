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
/// Fewer than 2 points (3 closed), fewer than 3 nodes (5 closed), points that are not finite, farther out
/// than 1e150 or all in one place.
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
    ends(closed).check_count(n)?;
    let curve = if closed {
        Cubic::periodic(points)
    } else {
        Cubic::not_a_knot(points)
    };
    Ok(match parameter {
        Parameter::PointIndex => {
            let steps = if closed { n } else { n - 1 } as f64;
            // one added and taken off again: the report counts from one, and rounds there
            let step = curve.pieces() as f64 / steps;
            (0..n)
                .map(|i| curve.at((1.0 + i as f64 * step) - 1.0))
                .collect()
        }
        Parameter::ArcLength => even_nodes(&curve, points, n, closed),
    })
}

/// At which places of its parameter a spline meets its points, when it is drawn anew.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Knots {
    /// At the whole numbers, however far the points are apart: right for even points, and what [`spline`] does.
    ///
    /// Where a long edge follows a short one the curve runs past its points and may loop.
    Index,
    /// At the sums of the square roots of the distances: between the other two. `[lee89]`.
    Centripetal,
    /// At the sums of the distances: the parameter is nearly arc length, and its speed nearly 1.
    Chord,
}

/// The same curve with `n` nodes at even arc length, over the knots of [`Knots::Chord`]: right for uneven nodes too.
///
/// ```
/// use elastic::resample;
/// use glam::DVec2;
///
/// // a bent rod with most of its nodes at one end
/// let rod = [0.0, 0.1, 0.2, 0.4, 8.0].map(|x| DVec2::new(x, 0.0));
/// let even = resample(&rod, 5, false)?;
/// assert!((even[1] - DVec2::new(2.0, 0.0)).length() < 1e-12);
/// # Ok::<(), elastic::ElasticError>(())
/// ```
///
/// # Errors
///
/// As [`resample_over`].
pub fn resample(curve: &[DVec2], n: usize, closed: bool) -> Result<Vec<DVec2>, ElasticError> {
    resample_over(curve, n, Knots::Chord, closed)
}

/// The curve through the nodes of another, with `n` nodes at even arc length, over knots of one's choice.
///
/// The old nodes are joined by a cubic spline with continuous curvature, fourth order in their distance on smooth curves.
/// Open ends are not-a-knot where the last edge is no longer than the one before it; where it is longer, the
/// second derivative goes on as if it were as long, for a short edge says nothing about a long one beside it. The
/// first node stays; of an open curve the last one too. Neighbours that coincide count once.
///
/// # Errors
///
/// As [`spline`]: fewer than 2 points (3 closed) that differ from their neighbours, fewer than 3 nodes (5 closed),
/// points that are not finite, too far out, or all in one place.
pub fn resample_over(
    curve: &[DVec2],
    n: usize,
    knots: Knots,
    closed: bool,
) -> Result<Vec<DVec2>, ElasticError> {
    if knots == Knots::Index {
        return spline(curve, n, Parameter::ArcLength, closed);
    }
    check_points("point", curve)?;
    let mut points = curve.to_vec();
    points.dedup();
    if closed && points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    let needed = if closed { 3 } else { 2 };
    if points.len() < needed {
        let got = points.len();
        return Err(ElasticError::TooFewPoints { needed, got });
    }
    ends(closed).check_count(n)?;
    let width = |a: DVec2, b: DVec2| match knots {
        Knots::Centripetal => (b - a).length().sqrt(),
        Knots::Index | Knots::Chord => (b - a).length(),
    };
    let cubic = if closed {
        crate::knots::periodic(&points, width)
    } else {
        crate::knots::open(&points, width)
    };
    Ok(even_nodes(&cubic, &points, n, closed))
}

const fn ends(closed: bool) -> Topology {
    if closed {
        Topology::Closed
    } else {
        Topology::open(End::Free)
    }
}

/// Nodes at even arc length; an open curve ends at its last point.
fn even_nodes(curve: &Cubic, points: &[DVec2], n: usize, closed: bool) -> Vec<DVec2> {
    let steps = if closed { n } else { n - 1 } as f64;
    let table = ArcTable::new(curve);
    let mut nodes: Vec<_> = (0..n)
        .map(|i| curve.at(table.place(table.total() * (i as f64 / steps))))
        .collect();
    if !closed {
        nodes[n - 1] = points[points.len() - 1];
    }
    nodes
}
