//! What a picture says for an outline.

use glam::DVec2;
use search::along::Polygon;
use search::whole::{at, quantile};

use crate::model::{Model, Seed, strength};

/// Points that an outline is judged at.
const POINTS: usize = 64;

/// An edge may lie so far from the outline, in pixels of the model.
const REACH: f64 = 1.5;

/// How far beside the outline pixels are compared, in radii of a disk of its area.
const BESIDE: f64 = 0.3;

/// Where another object touches, an outline counts as if it had an edge of this strength at least.
const CONTACT: f64 = 0.35;

/// What a picture says for an outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support {
    /// Strength of the edge that four fifths of the outline have at least: how closed it is. 0 … 1.
    pub closed: f64,
    /// Mean strength of the edge of the objects' polarity. 0 … 1.
    pub edge: f64,
    /// How much likelier the pixels just inside are to belong to an object than those just outside: the mean
    /// difference of logarithms, over the most that it can be. -1 … 1.
    pub region: f64,
    /// Share of its convex hull that the outline fills. 0 … 1.
    pub solidity: f64,
}

/// What a picture says for an outline, in the frame of the model; `half` is the slope of half an edge.
pub(crate) fn support(model: &Model<'_>, seed: &Seed, curve: &[DVec2], half: f64) -> Support {
    let polygon = Polygon {
        points: curve.to_vec(),
        closed: true,
    }
    .outwards();
    let area = polygon.area();
    let even = polygon.evenly(POINTS);
    let normals = even.normals(1.0);
    let wide = BESIDE * (area / std::f64::consts::PI).sqrt();
    let (height, width) = model.whole.dim();
    let size = DVec2::new(width as f64 - 1.5, height as f64 - 1.5);
    let (mut strengths, mut region) = (Vec::with_capacity(POINTS), 0.0);
    for (p, &normal) in even.points.iter().zip(&normals) {
        if p.cmplt(DVec2::splat(0.5)).any() || p.cmpgt(size).any() {
            continue; // along the border of the picture an outline needs no edge
        }
        let ways = (-3..=3).map(|k| f64::from(k) * REACH / 3.0);
        let slope = ways
            .map(|way| model.signed(*p + way * normal, normal))
            .fold(0.0, f64::max);
        let own = strength(slope, half);
        if model.is_of_rival(seed, *p + 0.5 * wide * normal) {
            strengths.push(own.max(CONTACT));
            continue;
        }
        strengths.push(own);
        if let Some(likelihood) = &model.likelihood {
            region += at(likelihood, *p - wide * normal) - at(likelihood, *p + wide * normal);
        }
    }
    if strengths.len() < POINTS / 4 {
        strengths.clear();
    }
    let count = strengths.len().max(1) as f64;
    Support {
        edge: strengths.iter().sum::<f64>() / count,
        closed: quantile(&mut strengths, 0.2),
        region: region / (4.0 * count),
        solidity: solidity(&polygon.points, area),
    }
}

/// The share of its convex hull that a polygon fills.
fn solidity(points: &[DVec2], area: f64) -> f64 {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let mut hull: Vec<DVec2> = Vec::new();
    for _ in 0..2 {
        let base = hull.len();
        for &p in &sorted {
            while let [.., a, b] = hull[base..] {
                if (b - a).perp_dot(p - a) > 0.0 {
                    break;
                }
                hull.pop();
            }
            hull.push(p);
        }
        hull.pop();
        sorted.reverse();
    }
    let whole = elastic::signed_area(&hull).abs();
    if whole > 0.0 {
        (area / whole).min(1.0)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_is_convex_and_an_l_is_not() {
        let polygon =
            |list: &[(f64, f64)]| list.iter().map(|&p| DVec2::from(p)).collect::<Vec<_>>();
        let square = polygon(&[(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]);
        assert!((solidity(&square, 4.0) - 1.0).abs() < 1e-12);
        let corner = [
            (0.0, 0.0),
            (2.0, 0.0),
            (2.0, 1.0),
            (1.0, 1.0),
            (1.0, 2.0),
            (0.0, 2.0),
        ];
        // 3 of 3.5
        assert!((solidity(&polygon(&corner), 3.0) - 3.0 / 3.5).abs() < 1e-12);
    }
}
