//! Geometry of a closed curve of nodes: normals, room on either side, laying one shape on another.

use flow::Similarity;
use glam::DVec2;
use search::along::Polygon;
use search::smooth::smoothed;

/// σ of the smoothing of normals along the curve. Nodes.
const CALM: f64 = 1.5;

/// Unit normals, outwards.
pub(crate) fn normals(curve: &[DVec2]) -> Vec<DVec2> {
    polygon(curve).normals(CALM)
}

pub(crate) fn polygon(curve: &[DVec2]) -> Polygon {
    Polygon {
        points: curve.to_vec(),
        closed: true,
    }
}

/// Mean of the enclosed area.
pub(crate) fn middle(curve: &[DVec2]) -> DVec2 {
    let n = curve.len();
    let origin = curve[0];
    let (mut sum, mut area) = (DVec2::ZERO, 0.0);
    for i in 0..n {
        let (a, b) = (curve[i] - origin, curve[(i + 1) % n] - origin);
        let cross = a.perp_dot(b);
        sum += cross * (a + b) / 3.0;
        area += cross;
    }
    if area.abs() > 1e-9 {
        origin + sum / area
    } else {
        curve.iter().sum::<DVec2>() / n as f64
    }
}

/// Radius of a disk of the same area.
pub(crate) fn radius(curve: &[DVec2]) -> f64 {
    (elastic::signed_area(curve).abs() / std::f64::consts::PI).sqrt()
}

/// How far each node may go along its normal, inwards and outwards, until it is as near to another part of the curve:
/// the radii of the largest disks that touch the curve there and hold no node.
pub(crate) fn room(curve: &[DVec2], normals: &[DVec2]) -> Vec<[f64; 2]> {
    let n = curve.len();
    (0..n)
        .map(|i| {
            let mut room = [f64::INFINITY; 2];
            for j in 0..n {
                let apart = i.abs_diff(j);
                if apart.min(n - apart) < 3 {
                    continue;
                }
                let way = curve[j] - curve[i];
                let out = way.dot(normals[i]);
                let side = usize::from(out > 0.0);
                room[side] = room[side].min(0.5 * way.length_squared() / out.abs().max(1e-12));
            }
            room
        })
        .collect()
}

/// The similarity that lays one shape's nodes on another's, with weights.
pub(crate) fn laid(shape: &[DVec2], on: &[DVec2], weights: &[f64]) -> Similarity {
    let total: f64 = weights.iter().sum();
    if total <= 0.0 {
        return Similarity::STILL;
    }
    let mean = |list: &[DVec2]| {
        list.iter()
            .zip(weights)
            .map(|(p, w)| *w * *p)
            .sum::<DVec2>()
            / total
    };
    let (center, end) = (mean(shape), mean(on));
    let (mut turn, mut spread) = (DVec2::ZERO, 0.0);
    for ((a, b), w) in shape.iter().zip(on).zip(weights) {
        let (a, b) = (*a - center, *b - end);
        turn += *w * DVec2::new(a.dot(b), a.perp_dot(b));
        spread += *w * a.length_squared();
    }
    let turn = if spread > 0.0 {
        turn / spread
    } else {
        DVec2::X
    };
    Similarity {
        turn,
        shift: end - center,
        center,
    }
}

/// The slow waves of values along a curve: `modes` of them each way and the mean.
pub(crate) fn lowpass(values: &[DVec2], modes: usize) -> Vec<DVec2> {
    let n = values.len();
    let mean = values.iter().sum::<DVec2>() / n as f64;
    let mut out = vec![mean; n];
    for k in 1..=modes.min(n / 2) {
        let angle = |i: usize| std::f64::consts::TAU * (k * i % n) as f64 / n as f64;
        let (mut cos, mut sin) = (DVec2::ZERO, DVec2::ZERO);
        for (i, value) in values.iter().enumerate() {
            let (s, c) = angle(i).sin_cos();
            cos += c * *value;
            sin += s * *value;
        }
        let scale = 2.0 / n as f64;
        for (i, out) in out.iter_mut().enumerate() {
            let (s, c) = angle(i).sin_cos();
            *out += scale * (c * cos + s * sin);
        }
    }
    out
}

/// A curve without its shortest waves: each wave by (1 + stiff · w⁴)⁻¹, w = 2 sin(π k / N), to first order of
/// `stiff`.
pub(crate) fn calmed(curve: &[DVec2], stiff: f64) -> Vec<DVec2> {
    let n = curve.len();
    let mut out = curve.to_vec();
    // Jacobi rounds of (1 + stiff · D⁴) x = curve, which converge since 16 stiff is small against 1 + 6 stiff
    for _ in 0..6 {
        let now = out.clone();
        for i in 0..n {
            let at = |d: usize| now[(i + d) % n];
            let beside = at(n - 2) + at(2) - 4.0 * (at(n - 1) + at(1));
            out[i] = (curve[i] - stiff * beside) / (1.0 + 6.0 * stiff);
        }
    }
    out
}

/// As [`evenly`], the first at a place between nodes.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "places between nodes"
)]
pub(crate) fn evenly_from(curve: &[DVec2], count: usize, first: f64) -> (Vec<DVec2>, Vec<f64>) {
    let n = curve.len();
    let turned = first.rem_euclid(n as f64);
    let (whole, share) = (turned.floor() as usize % n, turned.fract());
    let mut from: Vec<DVec2> = (0..n).map(|i| curve[(i + whole) % n]).collect();
    if share > 1e-9 {
        let start = bent(&from, 0, share);
        from.rotate_left(1);
        from.insert(0, start);
    }
    let (points, places) = evenly(&from, count);
    let back = |at: f64| -> f64 {
        let at = if share > 1e-9 {
            // the first of these lies between two of the curve's nodes, and the last gap is what was cut off
            if at < 1.0 {
                share + at * (1.0 - share)
            } else if at >= n as f64 {
                n as f64 + (at - n as f64) * share
            } else {
                at
            }
        } else {
            at
        };
        (at + whole as f64).rem_euclid(n as f64)
    };
    (points, places.into_iter().map(back).collect())
}

/// Nodes at equal distances, and where between the old nodes each lies. The first stays where it is.
pub(crate) fn evenly(curve: &[DVec2], count: usize) -> (Vec<DVec2>, Vec<f64>) {
    let n = curve.len();
    let mut lengths = Vec::with_capacity(n + 1);
    lengths.push(0.0);
    for i in 0..n {
        lengths.push(lengths[i] + curve[i].distance(curve[(i + 1) % n]));
    }
    let total = lengths[n];
    let mut at = 0;
    let mut points = Vec::with_capacity(count);
    let mut places = Vec::with_capacity(count);
    for i in 0..count {
        let wanted = total * i as f64 / count as f64;
        while at + 1 < n && lengths[at + 1] < wanted {
            at += 1;
        }
        let gap = lengths[at + 1] - lengths[at];
        let share = if gap > 0.0 {
            ((wanted - lengths[at]) / gap).clamp(0.0, 1.0)
        } else {
            0.0
        };
        points.push(bent(curve, at, share));
        places.push(at as f64 + share);
    }
    (points, places)
}

/// A place between two nodes on the cubic through four (Catmull and Rom's).
fn bent(curve: &[DVec2], at: usize, share: f64) -> DVec2 {
    let n = curve.len();
    let node = |k: usize| curve[(at + n + k - 1) % n];
    let (a, b, c, d) = (node(0), node(1), node(2), node(3));
    let t = share;
    0.5 * (2.0 * b
        + t * ((c - a) + t * ((2.0 * a - 5.0 * b + 4.0 * c - d) + t * (3.0 * (b - c) + d - a))))
}

/// Values of nodes at places between them.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "places between nodes"
)]
pub(crate) fn between<T>(values: &[T], places: &[f64]) -> Vec<T>
where
    T: Copy + std::ops::Add<Output = T> + std::ops::Mul<f64, Output = T>,
{
    let n = values.len();
    let one = |place: &f64| {
        let at = place.floor();
        let share = place - at;
        let at = at as usize % n;
        values[at] * (1.0 - share) + values[(at + 1) % n] * share
    };
    places.iter().map(one).collect()
}

/// Values smoothed along the curve.
pub(crate) fn along(values: &[f64], sigma: f64) -> Vec<f64> {
    smoothed(values, sigma, true)
}

/// Where a line across lies inside a curve.
pub(crate) fn spans(curve: &[DVec2], y: f64) -> Vec<[f64; 2]> {
    let n = curve.len();
    let mut crossings: Vec<f64> = Vec::new();
    for i in 0..n {
        let (a, b) = (curve[i], curve[(i + 1) % n]);
        if (a.y <= y) != (b.y <= y) {
            crossings.push(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
        }
    }
    crossings.sort_by(f64::total_cmp);
    crossings
        .chunks_exact(2)
        .map(|pair| [pair[0], pair[1]])
        .collect()
}

/// The least and the largest coordinates.
pub(crate) fn bounds(points: &[DVec2]) -> (DVec2, DVec2) {
    let start = (DVec2::splat(f64::INFINITY), DVec2::splat(f64::NEG_INFINITY));
    points
        .iter()
        .fold(start, |(low, high), p| (low.min(*p), high.max(*p)))
}

/// Lines across a curve by which its share in a rectangle is measured.
const LINES: usize = 64;

/// Share of a curve's area that lies in a rectangle.
pub(crate) fn share_within(curve: &[DVec2], low: DVec2, high: DVec2) -> f64 {
    let (least, most) = bounds(curve);
    if least.cmpge(low).all() && most.cmple(high).all() {
        return 1.0;
    }
    let (mut within, mut all) = (0.0, 0.0);
    for k in 0..LINES {
        let y = least.y + (k as f64 + 0.5) / LINES as f64 * (most.y - least.y);
        for [from, to] in spans(curve, y) {
            all += to - from;
            if y > low.y && y < high.y {
                within += (to.min(high.x) - from.max(low.x)).max(0.0);
            }
        }
    }
    if all > 0.0 { within / all } else { 0.0 }
}

/// Places on a ring of length 1, one for each node in order, at places between nodes.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "places between nodes"
)]
pub(crate) fn turned(places: &[f64], between: &[f64]) -> Vec<f64> {
    let n = places.len();
    let one = |at: &f64| {
        let share = at - at.floor();
        let at = at.floor() as usize % n;
        let (a, b) = (places[at], places[(at + 1) % n]);
        let way = (b - a + 0.5).rem_euclid(1.0) - 0.5;
        (a + share * way).rem_euclid(1.0)
    };
    between.iter().map(one).collect()
}
