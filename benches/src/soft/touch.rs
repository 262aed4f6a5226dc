//! Who touches whom: every particle against the nearest edge of every other curve whose box is near.

use super::model::Model;
use sandbox::prelude::*;

/// A particle and the edge it is near.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touch {
    pub node: usize,
    pub ends: [usize; 2],
    /// Share of the second end.
    pub along: f64,
    /// From the edge to where the particle should be.
    pub way: DVec2,
    /// Negative inside a closed curve.
    pub distance: f64,
    pub length: f64,
}

/// All particles nearer than `reach` to another curve, or inside it.
pub(super) fn touches(model: &Model, reach: f64) -> Vec<Touch> {
    let boxes: Vec<(DVec2, DVec2)> = (0..model.curves.len())
        .map(|k| {
            model
                .nodes(k)
                .iter()
                .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| {
                    (low.min(*p), high.max(*p))
                })
        })
        .collect();
    let mut found = Vec::new();
    for (a, curve) in model.curves.iter().enumerate() {
        for (b, other) in model.curves.iter().enumerate() {
            let (low, high) = (boxes[b].0 - reach, boxes[b].1 + reach);
            let apart = boxes[a].0.cmpgt(high).any() || boxes[a].1.cmplt(low).any();
            if a == b || apart {
                continue;
            }
            for node in curve.nodes.clone() {
                let p = model.x[node];
                if p.cmplt(low).any() || p.cmpgt(high).any() {
                    continue;
                }
                let near = nearest(model, node, b, other.closed);
                found.extend(near.filter(|near| near.distance < reach).map(|near| Touch {
                    length: curve.length,
                    ..near
                }));
            }
        }
    }
    found
}

/// The nearest edge of a curve to a particle.
fn nearest(model: &Model, node: usize, curve: usize, closed: bool) -> Option<Touch> {
    let (x, first) = (model.nodes(curve), model.curves[curve].nodes.start);
    let (p, n) = (model.x[node], x.len());
    let edges = if closed { n } else { n - 1 };
    let mut best: Option<(f64, usize, f64, DVec2)> = None;
    let mut inside = false;
    for i in 0..edges {
        let (a, b) = (x[i], x[(i + 1) % n]);
        let along = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        let away = p - (a + along * (b - a));
        let squared = away.length_squared();
        if best.is_none_or(|(least, ..)| squared < least) {
            best = Some((squared, i, along, away));
        }
        let crosses = (a.y > p.y) != (b.y > p.y);
        if crosses && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
            inside = !inside;
        }
    }
    let (squared, edge, along, away) = best?;
    let distance = squared.sqrt();
    let inside = inside && closed;
    let way = away.try_normalize()?;
    Some(Touch {
        node,
        ends: [first + edge, first + (edge + 1) % n],
        along,
        way: if inside { -way } else { way },
        distance: if inside { -distance } else { distance },
        length: 0.0,
    })
}

/// How deep the deepest particle is in another curve.
pub(super) fn deepest(model: &Model) -> f64 {
    let all = touches(model, 0.0);
    all.iter().map(|touch| -touch.distance).fold(0.0, f64::max)
}
