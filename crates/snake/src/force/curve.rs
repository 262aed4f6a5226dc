//! What a force sees of a snake.

use glam::DVec2;

/// A curve at one moment, as a force meets it.
#[derive(Debug, Clone, Copy)]
pub struct Curve<'a> {
    /// Time. T.
    pub t: f64,
    /// The nodes. L.
    pub x: &'a [DVec2],
    /// Their velocities. L T⁻¹.
    pub v: &'a [DVec2],
    /// μ of each node. M.
    pub mass: &'a [f64],
    /// Whether the last node is joined to the first.
    pub closed: bool,
    /// Spacing at rest: the length of curve that each node stands for. L.
    pub spacing: f64,
}

impl Curve<'_> {
    /// Nodes before and after node `i`; at an open end the node itself stands in for the missing one.
    #[must_use]
    pub fn neighbors(&self, i: usize) -> (usize, usize) {
        let n = self.x.len();
        if self.closed {
            ((i + n - 1) % n, (i + 1) % n)
        } else {
            (i.saturating_sub(1), (i + 1).min(n - 1))
        }
    }

    /// The normal `(t_y, −t_x)` of the curve at node `i`, as long as the piece of it that the node stands for. L.
    ///
    /// ```text
    /// ½ (x[i+1] − x[i−1]) turned = ∂A/∂x[i]
    /// ```
    ///
    /// Outwards where [`Curve::turn`] is 1. At an open end, of half the last edge.
    #[must_use]
    pub fn normal(&self, i: usize) -> DVec2 {
        let (before, after) = self.neighbors(i);
        let chord = self.x[after] - self.x[before];
        0.5 * DVec2::new(chord.y, -chord.x)
    }

    /// 1 where a closed curve runs with positive signed area, or is open; −1 the other way round (D78).
    #[must_use]
    pub fn turn(&self) -> f64 {
        if self.closed && elastic::signed_area(self.x) < 0.0 {
            -1.0
        } else {
            1.0
        }
    }

    /// Velocity of node `i`; zero where nobody said.
    #[must_use]
    pub fn velocity(&self, i: usize) -> DVec2 {
        self.v.get(i).copied().unwrap_or(DVec2::ZERO)
    }
}
