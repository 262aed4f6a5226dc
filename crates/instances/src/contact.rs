//! Where objects touch: one border between them, no gap and no overlap; and labels that agree with the outlines.

use glam::DVec2;
use ndarray::Array2;

use crate::seeds::Circle;
use crate::spans::Spans;

/// Outlines at most so far apart touch. Pixels.
const GAP: f64 = 1.5;

/// Objects whose bounding boxes meet, as pairs in order.
pub(crate) fn pairs(outlines: &[Vec<DVec2>]) -> Vec<(usize, usize)> {
    let bounds: Vec<(DVec2, DVec2)> = outlines
        .iter()
        .map(|points| {
            let start = (DVec2::splat(f64::INFINITY), DVec2::splat(f64::NEG_INFINITY));
            let all = points.iter();
            all.fold(start, |(low, high), p| (low.min(*p), high.max(*p)))
        })
        .collect();
    let mut order: Vec<usize> = (0..outlines.len()).collect();
    order.sort_by(|&a, &b| bounds[a].0.x.total_cmp(&bounds[b].0.x).then(a.cmp(&b)));
    let mut out = Vec::new();
    for (place, &i) in order.iter().enumerate() {
        let near = |j: &&usize| bounds[**j].0.x <= bounds[i].1.x + GAP;
        for &j in order[place + 1..].iter().take_while(near) {
            let (a, b) = (bounds[i], bounds[j]);
            if a.0.y <= b.1.y + GAP && b.0.y <= a.1.y + GAP {
                out.push((i.min(j), i.max(j)));
            }
        }
    }
    out.sort_unstable();
    out
}

/// How far a place is from a seed, in its radii.
fn far(circle: &Circle, p: DVec2) -> f64 {
    p.distance(circle.center) / circle.radius
}

/// Give each pair of outlines that overlap or nearly touch one common border; returns who touches whom, as pairs.
///
/// An overlap is divided where both seeds are equally far in units of their radii. A gap narrower than 1.5 pixels is
/// closed along its middle.
pub(crate) fn joined(outlines: &mut [Vec<DVec2>], circles: &[Circle]) -> Vec<(usize, usize)> {
    let mut touching = Vec::new();
    for (i, j) in pairs(outlines) {
        let before = (outlines[i].clone(), outlines[j].clone());
        let a = cut(&mut outlines[i], &before.1, (&circles[i], &circles[j]));
        let b = cut(&mut outlines[j], &before.0, (&circles[j], &circles[i]));
        let before = (outlines[i].clone(), outlines[j].clone());
        let c = closed(&mut outlines[i], &before.1);
        let d = closed(&mut outlines[j], &before.0);
        if a || b || c || d {
            touching.push((i, j));
        }
    }
    touching
}

/// Take back what of an outline lies in another and nearer to the other's seed; returns whether anything did.
fn cut(own: &mut [DVec2], other: &[DVec2], (seed, rival): (&Circle, &Circle)) -> bool {
    let mut any = false;
    for p in own.iter_mut() {
        let taken =
            |q: DVec2| far(rival, q) < far(seed, q) && outline::winding(other, q) != Some(0);
        if !taken(*p) {
            continue;
        }
        any = true;
        // from the seed outwards: the first half belongs to it
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..20 {
            let middle = f64::midpoint(low, high);
            if taken(seed.center.lerp(*p, middle)) {
                high = middle;
            } else {
                low = middle;
            }
        }
        *p = seed.center.lerp(*p, low);
    }
    any
}

/// Move an outline half of the way over a narrow gap to another; returns whether there is one.
fn closed(own: &mut [DVec2], other: &[DVec2]) -> bool {
    let mut any = false;
    for p in own.iter_mut() {
        if let Some(nearest) = nearest(other, *p) {
            any = true;
            *p = p.midpoint(nearest);
        }
    }
    any
}

/// The nearest place on a closed polygon that is near enough to touch.
fn nearest(points: &[DVec2], p: DVec2) -> Option<DVec2> {
    let mut best = (GAP * GAP, None);
    let mut a = *points.last()?;
    for &b in points {
        let edge = b - a;
        let share =
            ((p - a).dot(edge) / edge.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let q = a + share * edge;
        let apart = p.distance_squared(q);
        if apart <= best.0 {
            best = (apart, Some(q));
        }
        a = b;
    }
    best.1
}

/// Outlines as labels 1, 2, … in their order; a pixel in several is that of the nearest seed.
pub(crate) fn labelled(
    outlines: &[Vec<DVec2>],
    circles: &[Circle],
    dim: (usize, usize),
) -> Array2<u32> {
    let mut labels = Array2::<u32>::zeros(dim);
    for (at, (outline, circle)) in outlines.iter().zip(circles).enumerate() {
        for (y, x) in Spans::of(outline, dim).pixels() {
            let p = DVec2::new(x as f64, y as f64);
            let holder = labels[[y, x]] as usize;
            if holder == 0 || far(circle, p) < far(&circles[holder - 1], p) {
                labels[[y, x]] = u32::try_from(at + 1).unwrap_or(u32::MAX);
            }
        }
    }
    labels
}
