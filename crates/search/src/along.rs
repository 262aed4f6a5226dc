//! A curve as a row of points: its length, area, points at equal distances, pixels inside.

use field::Grid;
use glam::DVec2;

use crate::smooth::smoothed;

/// A polygon or, where it is not closed, a row of points.
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    /// Its points in their order; the first is not repeated.
    pub points: Vec<DVec2>,
    /// Whether the last point is joined to the first.
    pub closed: bool,
}

impl Polygon {
    /// Its area; that of an open curve closed by a straight line.
    #[must_use]
    pub fn area(&self) -> f64 {
        elastic::signed_area(&self.points).abs()
    }

    /// Its length.
    #[must_use]
    pub fn length(&self) -> f64 {
        elastic::length(&self.points, self.closed)
    }

    /// The least and the largest coordinates.
    pub(crate) fn bounds(&self) -> (DVec2, DVec2) {
        let start = (DVec2::splat(f64::INFINITY), DVec2::splat(f64::NEG_INFINITY));
        let points = self.points.iter();
        points.fold(start, |(low, high), p| (low.min(*p), high.max(*p)))
    }

    /// The same curve in another frame.
    pub(crate) fn map(&self, to: impl Fn(DVec2) -> DVec2) -> Self {
        let points = self.points.iter().map(|&p| to(p)).collect();
        Self {
            points,
            closed: self.closed,
        }
    }

    /// The same curve so that its normals point outwards: clockwise on the screen.
    #[must_use]
    pub fn outwards(mut self) -> Self {
        if self.closed && elastic::signed_area(&self.points) < 0.0 {
            self.points.reverse();
        }
        self
    }

    /// So many points at equal distances along it, straight between its points; of an open one both ends are kept.
    #[must_use]
    pub fn evenly(&self, count: usize) -> Self {
        let closed = self.closed;
        let mut ring = self.points.clone();
        if closed && let Some(&first) = ring.first() {
            ring.push(first);
        }
        let gaps = if closed { count } else { count.max(2) - 1 };
        let step = self.length() / gaps as f64;
        if ring.len() < 2 || step <= 0.0 {
            let first = ring.first().copied().unwrap_or_default();
            return Self {
                points: vec![first; count],
                closed,
            };
        }
        let mut points = Vec::with_capacity(count);
        let (mut edge, mut behind) = (0, 0.0);
        for i in 0..count {
            let wanted = i as f64 * step;
            let mut length = ring[edge].distance(ring[edge + 1]);
            while behind + length < wanted && edge + 2 < ring.len() {
                behind += length;
                edge += 1;
                length = ring[edge].distance(ring[edge + 1]);
            }
            let share = if length > 0.0 {
                (wanted - behind) / length
            } else {
                0.0
            };
            points.push(ring[edge].lerp(ring[edge + 1], share.clamp(0.0, 1.0)));
        }
        Self { points, closed }
    }

    /// Points at most half a pixel apart.
    pub(crate) fn dense(&self) -> Vec<DVec2> {
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a window of some hundred pixels"
        )]
        let count = (2.0 * self.length()).ceil().clamp(2.0, 1e6) as usize + 1;
        self.evenly(count).points
    }

    /// Unit normals, smoothed along the curve by a Gaussian of so many nodes.
    #[must_use]
    pub fn normals(&self, sigma: f64) -> Vec<DVec2> {
        let normals = elastic::normals(&self.points, self.closed);
        let smooth = smoothed(&normals, sigma, self.closed);
        let both = smooth.iter().zip(&normals);
        both.map(|(smooth, own)| {
            let unit = smooth.normalize_or_zero();
            if unit == DVec2::ZERO { *own } else { unit }
        })
        .collect()
    }

    /// Which pixels of a window have their middle inside.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the window first"
    )]
    pub(crate) fn inside(&self, (height, width): (usize, usize)) -> Vec<bool> {
        let mut inside = vec![false; height * width];
        let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); height];
        let n = self.points.len();
        for i in 0..n {
            let (a, b) = (self.points[i], self.points[(i + 1) % n]);
            let (top, bottom) = if a.y <= b.y { (a, b) } else { (b, a) };
            let from = top.y.ceil().max(0.0);
            let to = bottom.y.ceil().min(height as f64);
            let mut y = from;
            while y < to {
                let share = (y - top.y) / (bottom.y - top.y);
                crossings[y as usize].push(top.x + share * (bottom.x - top.x));
                y += 1.0;
            }
        }
        for (row, crossings) in inside.chunks_mut(width.max(1)).zip(&mut crossings) {
            crossings.sort_by(f64::total_cmp);
            for pair in crossings.chunks_exact(2) {
                let from = pair[0].ceil().max(0.0) as usize;
                let to = pair[1].ceil().clamp(0.0, width as f64) as usize;
                if from < to {
                    row[from..to].fill(true);
                }
            }
        }
        inside
    }
}

/// A place between four pixels of a grid; beyond its border the last pixel is repeated.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spot {
    /// The pixels' numbers: upper left, upper right, lower left, lower right.
    pub(crate) pixels: [usize; 4],
    /// How far it lies to the right and below of the first.
    right: f64,
    below: f64,
}

impl Spot {
    /// A place of a grid of that height and width.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the grid first"
    )]
    #[inline]
    pub(crate) fn of((height, width): (usize, usize), p: DVec2) -> Self {
        let x = p.x.clamp(0.0, (width - 1) as f64);
        let y = p.y.clamp(0.0, (height - 1) as f64);
        let (i, j) = (x as usize, y as usize);
        let (above, below) = (j * width, (j + 1).min(height - 1) * width);
        let next = (i + 1).min(width - 1);
        Self {
            pixels: [above + i, above + next, below + i, below + next],
            right: x - i as f64,
            below: y - j as f64,
        }
    }

    /// The value there between those of the four pixels, linear.
    #[inline]
    pub(crate) fn between(self, [a, b, c, d]: [f64; 4]) -> f64 {
        let top = (1.0 - self.right) * a + self.right * b;
        let bottom = (1.0 - self.right) * c + self.right * d;
        (1.0 - self.below) * top + self.below * bottom
    }
}

/// The value of a grid between its pixels, linear; beyond its border the last pixel is repeated.
pub(crate) fn sample(grid: &Grid, p: DVec2) -> f64 {
    let spot = Spot::of(grid.dim(), p);
    match grid.as_slice() {
        Some(values) => spot.between(spot.pixels.map(|at| values[at])),
        None => spot.between(
            spot.pixels
                .map(|at| grid[[at / grid.ncols(), at % grid.ncols()]]),
        ),
    }
}
