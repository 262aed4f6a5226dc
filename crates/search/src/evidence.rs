//! What a picture says for a curve, whatever search it came from.

use glam::DVec2;

use crate::along::Polygon;
use crate::edges::{Across, dot, percentile, size};
use crate::smooth::smoothed;
use crate::view::View;

/// Points that a curve is judged at.
const POINTS: usize = 120;

/// An edge may lie so far from the curve, in pixels of the window.
const REACH: f64 = 1.5;

/// Places on either side at which it is looked for.
const LOOKS: i32 = 3;

/// How far inside and outside the curve the picture must be less steep, in radii of the start.
const BESIDE: f64 = 0.15;

/// Fewer points in the picture say nothing.
const LEAST: usize = POINTS / 4;

/// What a picture says for a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support {
    /// Strength of the edge that four fifths of the curve have at least: how closed it is. 0 … 1.
    pub closed: f64,
    /// Strength of the edge that all but a twentieth of the curve have at least. 0 … 1.
    pub weakest: f64,
    /// Mean strength of the edge. 0 … 1.
    pub edge: f64,
    /// How steep the picture is a little inside and outside, along the same direction of color, against the edge
    /// itself:
    /// 1 in the middle of a ramp, about 0 beside a step.
    pub beside: f64,
    /// Length of the mean of the edge's color directions: how much it is of one polarity. 0 … `edge`.
    pub polar: f64,
}

/// Share of the edge that must be of one polarity for the edge to count in full.
const PURE: f64 = 0.7;

/// An edge must be steeper than what is beside it: that at most so much of it.
pub const SLOPE: f64 = 0.8;

impl Support {
    /// Whether the curve lies on a slope, and on no edge.
    #[must_use]
    pub fn is_slope(&self) -> bool {
        self.beside > SLOPE
    }

    /// How closed the edge is, less where it is of both polarities: the edges of one object are of one, as a rule.
    pub(crate) fn whole(&self) -> f64 {
        self.closed * self.purity()
    }

    /// The same, with the weakest part of the edge: a curve around several objects has none between them.
    pub(crate) fn throughout(&self) -> f64 {
        0.5 * (self.closed + self.weakest) * self.purity()
    }

    /// How much of one polarity the edge is. 0 … 1.
    fn purity(&self) -> f64 {
        if self.edge > 0.0 {
            (self.polar / self.edge / PURE).min(1.0).sqrt()
        } else {
            0.0
        }
    }
}

/// What the picture says for a curve. With `cut` a curve needs no edge where it goes along the border of the picture:
/// so is an object judged that is found, but not which of two curves is taken.
pub(crate) fn support(view: &View, curve: &[DVec2], closed: bool, cut: bool) -> Support {
    let points = smoothed(curve, 1.0, closed);
    let curve = Polygon { points, closed }.evenly(POINTS);
    let mut strengths = Vec::with_capacity(POINTS);
    let mut sum = [0.0; 3];
    let best = best(view, &curve, cut);
    for across in best.iter().flatten() {
        let slope = size(*across);
        strengths.push(view.edges.strength(slope));
        let whole = slope + view.edges.half();
        if whole > 0.0 {
            for (sum, one) in sum.iter_mut().zip(across) {
                *sum += *one / whole;
            }
        }
    }
    if strengths.len() < LEAST {
        return Support {
            closed: 0.0,
            weakest: 0.0,
            edge: 0.0,
            beside: 1.0,
            polar: 0.0,
        };
    }
    let count = strengths.len() as f64;
    let edge = strengths.iter().sum::<f64>() / count;
    Support {
        closed: percentile(&mut strengths, 0.2),
        weakest: percentile(&mut strengths, 0.05),
        edge,
        beside: beside(view, &curve, &best),
        polar: size(sum) / count,
    }
}

/// Mean strength of the edge on a curve itself, not a little beside it.
pub(crate) fn on_edge(view: &View, curve: &[DVec2]) -> f64 {
    let points = smoothed(curve, 1.0, true);
    let curve = Polygon {
        points,
        closed: true,
    }
    .evenly(POINTS);
    let normals = curve.normals(1.0);
    let known = curve
        .points
        .iter()
        .zip(&normals)
        .filter(|(p, _)| view.is_known(**p));
    let strengths = known.map(|(p, n)| {
        let across = view.edges.across(*p, *n);
        let slope = if view.is_forced() {
            view.signed(across)
        } else {
            size(across)
        };
        view.edges.strength(slope)
    });
    let (sum, count) = strengths.fold((0.0, 0.0), |(sum, count), one| (sum + one, count + 1.0));
    if count > 0.0 { sum / count } else { 0.0 }
}

/// The slopes beside a curve along the directions of its edge, against these.
fn beside(view: &View, curve: &Polygon, edge: &[Option<Across>]) -> f64 {
    let normals = curve.normals(1.0);
    let way = (BESIDE * view.radius).max(2.0 * REACH);
    let (mut there, mut here) = (0.0, 0.0);
    for ((p, normal), across) in curve.points.iter().zip(&normals).zip(edge) {
        let places = [*p - way * *normal, *p + way * *normal];
        let Some(across) = across.filter(|_| places.iter().all(|p| view.is_known(*p))) else {
            continue;
        };
        let slope = size(across);
        if slope > 0.0 {
            let along = |p| dot(view.edges.across(p, *normal), across) / slope;
            there += 0.5 * places.map(along).iter().sum::<f64>();
            here += slope;
        }
    }
    if here > 0.0 {
        (there / here).max(0.0)
    } else {
        0.0
    }
}

/// The strength of the edge at each point of a curve.
pub(crate) fn strengths(view: &View, curve: &Polygon) -> Vec<Option<f64>> {
    let best = best(view, curve, true).into_iter();
    best.map(|across| across.map(|across| view.edges.strength(size(across))))
        .collect()
}

/// The steepest slope across a curve near each of its points; None where the picture is not known.
fn best(view: &View, curve: &Polygon, cut: bool) -> Vec<Option<Across>> {
    let normals = curve.normals(1.0);
    let both = curve.points.iter().zip(&normals);
    let one = |(p, normal): (&DVec2, &DVec2)| {
        let near = (-LOOKS..=LOOKS).map(|k| {
            let way = f64::from(k) * REACH / f64::from(LOOKS);
            let across = view.edges.across(*p + way * *normal, *normal);
            if view.is_forced() && view.signed(across) <= 0.0 {
                [0.0; 3]
            } else {
                across
            }
        });
        let steepest = near.max_by(|a, b| size(*a).total_cmp(&size(*b)));
        // what goes along the border of the picture has nothing on its other side
        let beyond = *p + (REACH + 1.0) * *normal;
        steepest.filter(|_| view.is_known(*p) && (!cut || view.is_known(beyond)))
    };
    both.map(one).collect()
}
