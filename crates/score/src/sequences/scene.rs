//! How one frame of a sequence is drawn: bodies in front of one another, each with a level and a texture of its own.

use field::Grid;
use field::drawn::{noisy, rounded, uniform};
use glam::DVec2;

use super::region::Region;
use crate::synthetic::blurred;

/// Numbers of a texture along one side; then it repeats.
const SIDE: usize = 64;

/// Pixels from one number of a texture to the next.
const SPACING: f64 = 5.0;

/// A smooth texture: independent numbers on a lattice of [`SPACING`] pixels, joined by cubic B-splines. A function of
/// the place alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Texture {
    /// Standard deviation, on average over all places. Levels.
    pub(super) size: f64,
    pub(super) seed: u64,
}

/// The numbers of a texture, by rows.
pub(super) struct Lattice(Vec<f64>);

impl Lattice {
    pub(super) fn of(texture: Texture) -> Self {
        // of even numbers the deviation is √(1/12); the splines leave 151/315 of it, ∫ of their square along each
        // axis
        let scale = texture.size * 12.0_f64.sqrt() * 315.0 / 151.0;
        let number = |n| scale * (uniform(texture.seed, n) - 0.5);
        Self((0..(SIDE * SIDE) as u64).map(number).collect())
    }

    pub(super) fn at(&self, p: DVec2) -> f64 {
        let p = p / SPACING;
        let (x, y) = (weights(p.x), weights(p.y));
        let row = |(row, weight): (usize, f64)| {
            let along = |(column, weight): (usize, f64)| weight * self.0[row * SIDE + column];
            weight * x.map(along).iter().sum::<f64>()
        };
        y.map(row).iter().sum()
    }
}

/// The four numbers about a place along one axis, and the weights of a cubic B-spline.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a whole number from 0 to the side of the lattice"
)]
fn weights(x: f64) -> [(usize, f64); 4] {
    let (low, t) = (x.floor(), x - x.floor());
    let side = SIDE as f64;
    let at = |k: f64| ((low + k).rem_euclid(side) as usize) % SIDE;
    let s = 1.0 - t;
    [
        (at(-1.0), s * s * s / 6.0),
        (at(0.0), (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0),
        (at(1.0), (4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0),
        (at(2.0), t * t * t / 6.0),
    ]
}

/// Something that is in a frame, or would be.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Body {
    /// Of an object; 0 of what is none.
    pub(super) id: u32,
    pub(super) region: Region,
    pub(super) level: f64,
    pub(super) texture: Option<Texture>,
    /// It is not drawn.
    pub(super) hidden: bool,
}

impl Body {
    pub(super) const fn new(id: u32, region: Region, level: f64) -> Self {
        Self {
            id,
            region,
            level,
            texture: None,
            hidden: false,
        }
    }
}

/// One frame.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scene {
    /// Level of the ground.
    pub(super) ground: f64,
    /// Texture of the ground.
    pub(super) texture: Option<Texture>,
    /// How far the ground has been shifted.
    pub(super) shift: DVec2,
    /// From the front to the back.
    pub(super) bodies: Vec<Body>,
}

impl Scene {
    /// Without texture.
    pub(super) const fn of(ground: f64, bodies: Vec<Body>) -> Self {
        Self {
            ground,
            texture: None,
            shift: DVec2::ZERO,
            bodies,
        }
    }

    /// Covered by shares of 8 × 8 points a pixel, blurred by one pixel, with noise of the deviation and seed, rounded.
    ///
    /// Of each point the first body that holds it counts. Textures are taken at the center of the pixel.
    pub(super) fn draw(&self, [width, height]: [usize; 2], noise: f64, seed: u64) -> Grid {
        let lattice = self.texture.map(Lattice::of);
        let ground = Grid::from_shape_fn((height, width), |(y, x)| {
            let p = DVec2::new(x as f64, y as f64) - self.shift;
            self.ground + lattice.as_ref().map_or(0.0, |lattice| lattice.at(p))
        });
        let mut picture = ground.clone();
        // a bit for each point that no body has covered yet
        let mut bare = ndarray::Array2::from_elem((height, width), u64::MAX);
        for body in self.bodies.iter().filter(|body| !body.hidden) {
            let lattice = body.texture.map(Lattice::of);
            let reach = DVec2::splat(body.region.reach() + 1.0);
            let (low, high) = (body.region.center - reach, body.region.center + reach);
            for y in within(low.y, high.y, height) {
                for x in within(low.x, high.x, width) {
                    let p = DVec2::new(x as f64, y as f64);
                    let covered = covered(&body.region, p) & bare[[y, x]];
                    if covered == 0 {
                        continue;
                    }
                    let texture = lattice.as_ref();
                    let texture = texture.map_or(0.0, |t| t.at(body.region.material(p)));
                    let level = body.level + texture;
                    let share = f64::from(covered.count_ones()) / 64.0;
                    picture[[y, x]] += (level - ground[[y, x]]) * share;
                    bare[[y, x]] &= !covered;
                }
            }
        }
        rounded(&noisy(&blurred(&picture, 1.0), noise, seed))
    }
}

/// The rows or columns between two places.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "cut to the picture before"
)]
fn within(low: f64, high: f64, count: usize) -> std::ops::Range<usize> {
    let cut = |at: f64| at.clamp(0.0, count as f64) as usize;
    cut(low.floor())..cut(high.ceil() + 1.0)
}

/// A bit for each of the points of a pixel that a region holds.
fn covered(region: &Region, p: DVec2) -> u64 {
    match region.whole(p) {
        Some(true) => u64::MAX,
        Some(false) => 0,
        None => {
            let part = |k: u32| (2.0 * f64::from(k) + 1.0) / 16.0 - 0.5;
            let at = |k: u32| p + DVec2::new(part(k % 8), part(k / 8));
            (0..64).fold(0, |bits, k| bits | (u64::from(region.holds(at(k))) << k))
        }
    }
}
