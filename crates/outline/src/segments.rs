//! Curves as one list of segments, each knowing who comes before and after it.
//!
//! Edges of no length are left out, so that what remains has a direction.

use crate::orient::orientation;
use glam::DVec2;

/// No segment there: the end of an open curve.
pub(crate) const NONE: u32 = u32::MAX;

/// One edge of a curve that has a length.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Segment {
    pub(crate) a: DVec2,
    pub(crate) b: DVec2,
    /// Which curve.
    pub(crate) curve: u32,
    /// Which edge of it: from node `edge` to the next.
    pub(crate) edge: u32,
    /// The segment that ends where this one starts, or [`NONE`].
    pub(crate) before: u32,
    /// The segment that starts where this one ends, or [`NONE`].
    pub(crate) after: u32,
}

/// The nearest point of a segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Nearest {
    pub(crate) along: f64,
    pub(crate) at: DVec2,
    pub(crate) squared: f64,
}

impl Segment {
    pub(crate) fn length(&self) -> f64 {
        (self.b - self.a).length()
    }

    /// The point of the segment nearest to `p`.
    pub(crate) fn nearest(&self, p: DVec2) -> Nearest {
        let d = self.b - self.a;
        let t = (p - self.a).dot(d) / d.length_squared();
        // a length whose square underflows gives no fraction
        let along = if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) };
        let at = if along < 1.0 {
            self.a + along * d
        } else {
            self.b
        };
        Nearest {
            along,
            at,
            squared: (p - at).length_squared(),
        }
    }

    /// Unit vector along the segment.
    pub(crate) fn tangent(&self) -> DVec2 {
        let d = self.b - self.a;
        d / d.length()
    }

    /// Unit vector square to the segment: outwards on a closed curve of positive area.
    pub(crate) fn normal(&self) -> DVec2 {
        let t = self.tangent();
        DVec2::new(t.y, -t.x)
    }
}

/// Appends the segments of one curve.
#[allow(clippy::cast_possible_truncation, reason = "the door counts the nodes")]
pub(crate) fn push_curve(out: &mut Vec<Segment>, curve: usize, nodes: &[DVec2], closed: bool) {
    let (n, start) = (nodes.len(), out.len());
    let edges = if closed { n } else { n.saturating_sub(1) };
    for i in 0..edges {
        let (a, b) = (nodes[i], nodes[if i + 1 == n { 0 } else { i + 1 }]);
        if a != b {
            let k = out.len() as u32;
            let before = if out.len() == start { NONE } else { k - 1 };
            out.push(Segment {
                a,
                b,
                curve: curve as u32,
                edge: i as u32,
                before,
                after: k + 1,
            });
        }
    }
    let end = out.len();
    if end > start {
        out[end - 1].after = if closed { start as u32 } else { NONE };
        out[start].before = if closed { end as u32 - 1 } else { NONE };
    }
}

/// On which side of its curve a point lies, judged at the nearest point: +1 where the normal points, −1
/// where the inside of a curve of positive area is, 0 on it.
///
/// Exact, if `nearest` is the nearest of the whole curve up to rounding: beside an edge the edge decides; beyond a node
/// the turn there does, since past a node that bulges out one is outside, past one that caves in inside.
/// At a fold of no width the point is outside. Beyond a free end the line of the last edge decides.
pub(crate) fn side(segments: &[Segment], k: u32, nearest: &Nearest, p: DVec2) -> f64 {
    if p == nearest.at {
        return 0.0;
    }
    let segment = &segments[k as usize];
    let beside = || -sign(orientation(segment.a, segment.b, p));
    let (before, after) = if nearest.along <= 0.0 {
        (segment.before, k)
    } else if nearest.along >= 1.0 {
        (k, segment.after)
    } else {
        return beside();
    };
    if before == NONE || after == NONE {
        return beside();
    }
    let (before, after) = (&segments[before as usize], &segments[after as usize]);
    // on the same side of both lines the turn has no say: at a node that is nearly straight its sign is chance, and so is
    // whether the nearest point is that node
    let of = |segment: &Segment| -sign(orientation(segment.a, segment.b, p));
    let (one, two) = (of(before), of(after));
    if one * two > 0.0 {
        return one;
    }
    let turn = sign(orientation(before.a, before.b, after.b));
    if turn.abs() > 0.0 {
        turn
    } else if (before.b - before.a).dot(after.b - after.a) > 0.0 {
        beside()
    } else {
        1.0
    }
}

/// −1, 0 or 1.
pub(crate) fn sign(value: f64) -> f64 {
    if value > 0.0 {
        1.0
    } else if value < 0.0 {
        -1.0
    } else {
        0.0
    }
}
