//! Places along an outline by where they have come from, and what is measured there.

use ::track::Outline;
use glam::DVec2;
use io::Picture;

/// σ over which places are smoothed for curvature. Pixels.
const SMOOTH: f64 = 3.0;

/// A place between two nodes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spot {
    from: usize,
    to: usize,
    part: f64,
}

impl Spot {
    pub(super) fn at(&self, list: &[DVec2]) -> DVec2 {
        list[self.from].lerp(list[self.to], self.part)
    }

    pub(super) fn of(&self, list: &[f64]) -> f64 {
        list[self.from] + (list[self.to] - list[self.from]) * self.part
    }
}

/// Where on an outline the places are that have come from the middles of `count` equal stretches of the first outline;
/// None where it has none.
pub(super) fn spots(outline: &Outline, count: usize) -> Vec<Option<Spot>> {
    let shares = &outline.material;
    let n = shares.len();
    let mut list = vec![None; count];
    for from in 0..n {
        let to = (from + 1) % n;
        let mut step = shares[to] - shares[from];
        step -= step.round();
        // a stretch that runs back has nothing of its own
        if !(step > 0.0 && step.is_finite()) {
            continue;
        }
        let scale = count as f64;
        let (begin, end) = (
            shares[from] * scale - 0.5,
            (shares[from] + step) * scale - 0.5,
        );
        let mut place = begin.ceil();
        while place < end {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a place in the list"
            )]
            let at = place.rem_euclid(scale) as usize;
            let part = (place - begin) / (end - begin);
            if let Some(spot) = list.get_mut(at) {
                *spot = Some(Spot { from, to, part });
            }
            place += 1.0;
        }
    }
    list
}

fn edges(points: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| (*a, *b))
}

pub(super) fn length(points: &[DVec2]) -> f64 {
    edges(points).map(|(a, b)| a.distance(b)).sum()
}

/// The middle of the area.
pub(super) fn middle(points: &[DVec2]) -> DVec2 {
    let Some(&origin) = points.first() else {
        return DVec2::NAN;
    };
    let (mut area, mut sum) = (0.0, DVec2::ZERO);
    for (a, b) in edges(points) {
        let (a, b) = (a - origin, b - origin);
        area += a.perp_dot(b);
        sum += (a + b) * a.perp_dot(b);
    }
    if area.abs() > 1e-9 {
        origin + sum / (3.0 * area)
    } else {
        origin
    }
}

/// Outward normals at the nodes, whichever way they run.
pub(super) fn outward(points: &[DVec2]) -> Vec<DVec2> {
    let n = points.len();
    let area: f64 = edges(points).map(|(a, b)| a.perp_dot(b)).sum();
    let normal = |i: usize| {
        let along = points[(i + 1) % n] - points[(i + n - 1) % n];
        let right = DVec2::new(along.y, -along.x).normalize_or_zero();
        if area > 0.0 { right } else { -right }
    };
    (0..n).map(normal).collect()
}

/// Curvature at the nodes, above 0 where the outline bulges: of the circle through a node and places beside it, after
/// smoothing.
pub(super) fn curvature(points: &[DVec2]) -> Vec<f64> {
    let n = points.len();
    let spacing = (length(points) / n as f64).max(1e-9);
    let sigma = SMOOTH / spacing;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "less than the nodes there are"
    )]
    let reach = ((3.0 * sigma).ceil().min((n / 2) as f64) as usize).min(n / 2);
    let weight = |d: usize| (-0.5 * (d as f64 / sigma.max(1e-9)).powi(2)).exp();
    let smooth = |i: usize| {
        let (mut sum, mut all) = (points[i], 1.0);
        for d in 1..=reach {
            let w = weight(d);
            sum += w * (points[(i + d) % n] + points[(i + n - d) % n]);
            all += 2.0 * w;
        }
        sum / all
    };
    let soft: Vec<DVec2> = (0..n).map(smooth).collect();
    let area: f64 = edges(points).map(|(a, b)| a.perp_dot(b)).sum();
    let bend = |i: usize| {
        let (a, b, c) = (soft[(i + n - 1) % n], soft[i], soft[(i + 1) % n]);
        let product = a.distance(b) * b.distance(c) * c.distance(a);
        // Menger: four times the area of the triangle over the product of its sides
        let value = 2.0 * (b - a).perp_dot(c - b) / product;
        if product > 0.0 {
            value * area.signum()
        } else {
            f64::NAN
        }
    };
    (0..n).map(bend).collect()
}

/// The grey level at a place, between pixels; no number outside.
pub(super) fn grey(picture: &Picture, p: DVec2) -> f64 {
    let (width, height) = picture.size();
    let last = DVec2::new(width as f64 - 1.0, height as f64 - 1.0);
    if !(p.cmpge(DVec2::ZERO).all() && p.cmple(last).all()) {
        return f64::NAN;
    }
    let corner = p.floor().min((last - 1.0).max(DVec2::ZERO));
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a pixel of the picture"
    )]
    let (x, y) = (corner.x as usize, corner.y as usize);
    let part = p - corner;
    let (right, below) = ((x + 1).min(width - 1), (y + 1).min(height - 1));
    let row = |y: usize| {
        picture.level_at(x, y) + (picture.level_at(right, y) - picture.level_at(x, y)) * part.x
    };
    row(y) + (row(below) - row(y)) * part.y
}
