//! Points followed from one frame to the next, and back.

use glam::DVec2;

use crate::Pyramid;
use crate::patch::sampled;

/// How points are followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rules {
    /// Side of the square of pixels about a point. Odd, in pixels.
    pub side: usize,
    /// Rounds of Newton's method at each size of the picture.
    pub rounds: usize,
    /// Least sum of squared slopes a pixel, along the direction in which it is least, that a square must have to be
    /// followed. Squared levels a squared pixel.
    pub least: f64,
    /// Most distance from its beginning at which a point may end that is followed there and back. Pixels.
    pub back: f64,
}

impl Default for Rules {
    fn default() -> Self {
        Self {
            side: 13,
            rounds: 10,
            least: 0.05,
            back: 1.0,
        }
    }
}

/// Where a point has gone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moved {
    /// Its place in the next frame.
    pub to: DVec2,
    /// How far from its beginning it ends, followed there and back. Pixels.
    pub error: f64,
    /// Sum of squared slopes a pixel about it, along the direction in which it is least: how firmly it is held.
    pub held: f64,
}

/// A step this small is the last. Pixels.
const SMALL: f32 = 0.02;

/// Follow points; None for one whose square is too flat, that leaves the picture, or that does not come back.
#[must_use]
pub fn carry(from: &Pyramid, to: &Pyramid, points: &[DVec2], rules: &Rules) -> Vec<Option<Moved>> {
    let mut room = Room::new(rules.side.max(3) | 1);
    points
        .iter()
        .map(|&p| {
            let (there, held) = room.follow(from, to, p, rules)?;
            let (back, _) = room.follow(to, from, there, rules)?;
            let error = back.distance(p);
            (error <= rules.back).then_some(Moved {
                to: there,
                error,
                held,
            })
        })
        .collect()
}

/// Memory of one point.
struct Room {
    side: usize,
    wide: Vec<f32>,
    template: Vec<f32>,
    slopes: [Vec<f32>; 2],
    moved: Vec<f32>,
}

impl Room {
    fn new(side: usize) -> Self {
        let area = side * side;
        Self {
            side,
            wide: vec![0.0; (side + 2) * (side + 2)],
            template: vec![0.0; area],
            slopes: [vec![0.0; area], vec![0.0; area]],
            moved: vec![0.0; area],
        }
    }

    /// Where a point goes, and how firmly it is held.
    #[allow(
        clippy::cast_possible_truncation,
        reason = "places within a picture to less than a thousandth of a pixel"
    )]
    fn follow(
        &mut self,
        from: &Pyramid,
        to: &Pyramid,
        p: DVec2,
        rules: &Rules,
    ) -> Option<(DVec2, f64)> {
        let count = from.levels().len().min(to.levels().len());
        let mut shift = [0.0_f32; 2];
        let mut held = None;
        for level in (0..count).rev() {
            let (before, after) = (&from.levels()[level], &to.levels()[level]);
            let size = (1_u32 << level) as f32;
            let (x, y) = (p.x as f32 / size, p.y as f32 / size);
            if level + 1 < count {
                shift = shift.map(|way| 2.0 * way);
            }
            let [xx, xy, yy] = self.template(before, x, y);
            let area = (self.side * self.side) as f32;
            let (half, apart) = (0.5 * (xx + yy), 0.5 * (xx - yy));
            let least = (half - apart.hypot(xy)) / area;
            held = (f64::from(least) >= rules.least).then_some(f64::from(least));
            if held.is_none() {
                continue;
            }
            let det = xx * yy - xy * xy;
            for _ in 0..rules.rounds {
                sampled(
                    after,
                    x + shift[0],
                    y + shift[1],
                    self.side,
                    &mut self.moved,
                );
                let [bx, by] = self.pull();
                let step = [(yy * bx - xy * by) / det, (xx * by - xy * bx) / det];
                if !(step[0].is_finite() && step[1].is_finite()) {
                    return None;
                }
                shift[0] += step[0];
                shift[1] += step[1];
                if step[0].hypot(step[1]) < SMALL {
                    break;
                }
            }
            let (height, width) = after.dim();
            let (u, v) = (x + shift[0], y + shift[1]);
            let margin = 0.5 * self.side as f32;
            if u < -margin || v < -margin || u > width as f32 + margin || v > height as f32 + margin
            {
                return None;
            }
        }
        let to = p + DVec2::new(f64::from(shift[0]), f64::from(shift[1]));
        let (height, width) = from.levels()[0].dim();
        let inside =
            to.cmpge(DVec2::splat(-0.5)).all() && to.x < width as f64 && to.y < height as f64;
        held.filter(|_| inside).map(|held| (to, held))
    }

    /// Samples about a place and their slopes; returns the sums of the slopes' products.
    fn template(&mut self, image: &ndarray::Array2<f32>, x: f32, y: f32) -> [f32; 3] {
        let (side, wide) = (self.side, self.side + 2);
        sampled(image, x, y, wide, &mut self.wide);
        let [mut xx, mut xy, mut yy] = [0.0_f32; 3];
        for k in 0..side {
            let rows = |d: usize| &self.wide[(k + d) * wide..(k + d + 1) * wide];
            let (above, here, below) = (rows(0), rows(1), rows(2));
            for m in 0..side {
                let at = k * side + m;
                let sx = 0.5 * (here[m + 2] - here[m]);
                let sy = 0.5 * (below[m + 1] - above[m + 1]);
                self.template[at] = here[m + 1];
                self.slopes[0][at] = sx;
                self.slopes[1][at] = sy;
                xx += sx * sx;
                xy += sx * sy;
                yy += sy * sy;
            }
        }
        [xx, xy, yy]
    }

    /// Sums of what is left of the difference times the slopes.
    fn pull(&self) -> [f32; 2] {
        let mut sums = [0.0_f32; 2];
        let slopes = self.slopes[0].iter().zip(&self.slopes[1]);
        for ((template, moved), (sx, sy)) in self.template.iter().zip(&self.moved).zip(slopes) {
            let left = template - moved;
            sums[0] += left * sx;
            sums[1] += left * sy;
        }
        sums
    }
}
