//! How two outlines lie to each other: how deep they overlap, how long a border they share.

use crate::error::{check_not_negative, check_points};
use crate::orient::meet;
use crate::place::{Place, distance, edges, place};
use crate::segments::Segment;
use crate::{Meeting, OutlineError};
use glam::DVec2;

/// How deep two closed outlines overlap: the farthest a border reaches into the other. L.
///
/// The larger of both ways of: over all nodes of one inside the other, and over the middles of stretches
/// between two crossings of one edge, the greatest distance to the other's border. For edges short against
/// the overlap that is the depth up to half an edge; it is never more, and 0 exactly if no such point lies
/// inside. O(n m) where the boxes overlap.
///
/// # Errors
/// Coordinates that are not finite or beyond 1e75.
pub fn overlap_depth(a: &[DVec2], b: &[DVec2]) -> Result<f64, OutlineError> {
    check_points("node", a)?;
    check_points("node", b)?;
    Ok(reach_into(a, b).max(reach_into(b, a)))
}

/// How far the border of `a` reaches into `b`.
fn reach_into(a: &[DVec2], b: &[DVec2]) -> f64 {
    let (low, high) = bounds(b);
    let within = |p: DVec2| p.cmpge(low).all() && p.cmple(high).all();
    let depth = |p: DVec2| {
        if within(p) && place(b, p) == Place::Inside {
            distance(b, true, p)
        } else {
            0.0
        }
    };
    let mut deepest = a.iter().map(|&p| depth(p)).fold(0.0, f64::max);
    let mut stops = Vec::new();
    for edge in edges(a, true) {
        if edge.a.min(edge.b).cmpgt(high).any() || edge.a.max(edge.b).cmplt(low).any() {
            continue;
        }
        stops.clear();
        for other in edges(b, true) {
            let met = meet(edge.a, edge.b, other.a, other.b);
            stops.extend(met.filter(|met| met.0 != Meeting::Overlap).map(|met| met.1));
        }
        stops.sort_by(f64::total_cmp);
        for pair in stops.windows(2) {
            deepest = deepest.max(depth(edge.a.lerp(edge.b, 0.5 * (pair[0] + pair[1]))));
        }
    }
    deepest
}

fn bounds(nodes: &[DVec2]) -> (DVec2, DVec2) {
    let start = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    nodes
        .iter()
        .fold(start, |(low, high), &v| (low.min(v), high.max(v)))
}

/// How much of curve `a` lies within `gap` of curve `b`. L.
///
/// Exact for the polygons, up to rounding: each edge is cut where its distance to the other curve passes
/// the gap. Not quite the same from `b` to `a`, since the outer of two bent borders is longer.
/// O(n m) where the boxes come near.
///
/// # Errors
/// Coordinates that are not finite or beyond 1e75; a gap that is negative.
pub fn shared_length(
    (a, a_closed): (&[DVec2], bool),
    (b, b_closed): (&[DVec2], bool),
    gap: f64,
) -> Result<f64, OutlineError> {
    check_points("node", a)?;
    check_points("node", b)?;
    check_not_negative("the gap", gap)?;
    let (low, high) = bounds(b);
    let (low, high) = (low - gap, high + gap);
    let mut total = 0.0;
    let mut stretches: Vec<(f64, f64)> = Vec::new();
    for edge in edges(a, a_closed) {
        if edge.a.min(edge.b).cmpgt(high).any() || edge.a.max(edge.b).cmplt(low).any() {
            continue;
        }
        stretches.clear();
        stretches.extend(edges(b, b_closed).filter_map(|other| within(&edge, &other, gap)));
        stretches.sort_by(|s, t| s.0.total_cmp(&t.0));
        let (mut covered, mut end) = (0.0, 0.0_f64);
        for &(from, to) in &stretches {
            covered += (to - from.max(end)).max(0.0);
            end = end.max(to);
        }
        total += covered * edge.length();
    }
    Ok(total)
}

/// The stretch of a segment within a distance of another: one, since the distance is convex along it.
fn within(edge: &Segment, other: &Segment, gap: f64) -> Option<(f64, f64)> {
    let (d, w) = (edge.b - edge.a, other.b - other.a);
    let from = edge.a - other.a;
    // how far along the other the point t is, as u0 + t du
    let (u0, du) = (
        from.dot(w) / w.length_squared(),
        d.dot(w) / w.length_squared(),
    );
    let parts = [
        meet_of(disc(from, d, gap), below(u0, du)),
        meet_of(disc(edge.a - other.b, d, gap), below(1.0 - u0, -du)),
        meet_of(
            slab(
                from.perp_dot(w) / w.length(),
                d.perp_dot(w) / w.length(),
                gap,
            ),
            meet_of(below(-u0, -du), below(u0 - 1.0, du)),
        ),
    ];
    parts
        .into_iter()
        .flatten()
        .reduce(|s, t| (s.0.min(t.0), s.1.max(t.1)))
}

type Stretch = Option<(f64, f64)>;

fn meet_of(one: Stretch, other: Stretch) -> Stretch {
    let (one, other) = (one?, other?);
    let both = (one.0.max(other.0), one.1.min(other.1));
    (both.0 <= both.1).then_some(both)
}

/// Where in 0..1 the line `value + t slope` is at most 0.
fn below(value: f64, slope: f64) -> Stretch {
    let zero = -value / slope;
    if slope > 0.0 {
        meet_of(Some((0.0, 1.0)), Some((f64::NEG_INFINITY, zero)))
    } else if slope < 0.0 {
        meet_of(Some((0.0, 1.0)), Some((zero, f64::INFINITY)))
    } else {
        (value <= 0.0).then_some((0.0, 1.0))
    }
}

/// Where in 0..1 the line `value + t slope` is between −gap and gap.
fn slab(value: f64, slope: f64, gap: f64) -> Stretch {
    meet_of(below(value - gap, slope), below(-value - gap, -slope))
}

/// Where in 0..1 the point `from + t d` is within `radius` of the origin.
fn disc(from: DVec2, d: DVec2, radius: f64) -> Stretch {
    let (squared, along) = (d.length_squared(), from.dot(d));
    let beside = from.perp_dot(d);
    let half = radius * radius * squared - beside * beside;
    if half < 0.0 {
        return None;
    }
    let half = half.sqrt();
    meet_of(
        Some((0.0, 1.0)),
        Some(((-along - half) / squared, (half - along) / squared)),
    )
}

#[cfg(test)]
mod tests;
