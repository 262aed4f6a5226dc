//! A curve as points: what a fit starts from, and what it finds.

use std::f64::consts::TAU;

use glam::DVec2;

/// A curve as points in pixels: x to the right, y down, the first pixel's center at (0, 0).
#[derive(Debug, Clone, PartialEq)]
pub struct Contour {
    /// The points in their order. A closed curve may repeat the first at the end or not.
    pub points: Vec<DVec2>,
    /// Whether the last point is joined to the first.
    pub closed: bool,
}

/// Points of a circle: a spline through so many is round to 1e-5 of the radius.
const ROUND: u32 = 64;

impl Contour {
    /// A closed curve through these points.
    #[must_use]
    pub const fn closed(points: Vec<DVec2>) -> Self {
        let closed = true;
        Self { points, closed }
    }

    /// An open curve through these points.
    #[must_use]
    pub const fn open(points: Vec<DVec2>) -> Self {
        let closed = false;
        Self { points, closed }
    }

    /// A circle.
    #[must_use]
    pub fn circle(center: DVec2, radius: f64) -> Self {
        Self::ellipse(center, DVec2::splat(radius))
    }

    /// An ellipse with its axes along x and y, by its half axes.
    #[must_use]
    pub fn ellipse(center: DVec2, half: DVec2) -> Self {
        let turn = |i| DVec2::from_angle(f64::from(i) * TAU / f64::from(ROUND));
        Self::closed((0..ROUND).map(|i| center + half * turn(i)).collect())
    }

    /// A rectangle by two opposite corners, with points along its sides so that a spline through
    /// them keeps to the sides.
    #[must_use]
    pub fn rectangle(one: DVec2, other: DVec2) -> Self {
        let (low, high) = (one.min(other), one.max(other));
        let corners = [
            low,
            DVec2::new(high.x, low.y),
            high,
            DVec2::new(low.x, high.y),
        ];
        let mut points = Vec::new();
        for (i, &from) in corners.iter().enumerate() {
            let to = corners[(i + 1) % 4];
            points.extend((0..8).map(|k| from.lerp(to, f64::from(k) / 8.0)));
        }
        Self::closed(points)
    }

    /// The points without a last one that repeats the first of a closed curve.
    pub(crate) fn clicks(&self) -> Vec<DVec2> {
        let mut clicks = self.points.clone();
        if self.closed && clicks.len() > 1 && clicks.first() == clicks.last() {
            clicks.pop();
        }
        clicks
    }
}
