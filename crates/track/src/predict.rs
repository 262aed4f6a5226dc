//! Where an object may be in the next frame: flown on, left where it was, or carried by the flow of the picture.

use flow::{Pyramid, Rules, Similarity, carry, similarity};
use glam::DVec2;

use crate::correct::MODES;
use crate::ring;
use crate::window::{to_cells, to_pixels};

/// Interior points that are followed: their distance in radii, at least so many cells, and the most of them.
const GRID: f64 = 1.0 / 6.0;
const LEAST_GRID: f64 = 2.0;

/// How far inside its nodes the object is followed. Cells.
const INSIDE: f64 = 2.0;

/// The most nodes that are followed.
const NODES: usize = 80;

/// Share of the motion of before, what is left of the way and of the turn, and of waves, in a frame.
const OLD: f64 = 0.3;
const AIR: f64 = 0.98;
const TURN: f64 = 0.8;
const WAVE: f64 = 0.5;

/// Weight of points beside nodes that are not seen.
const LEAST_WEIGHT: f64 = 0.05;

/// The most a node may move otherwise than the object, in radii; σ of the smoothing in nodes of all.
const STRAY: f64 = 0.3;
const SMOOTH: f64 = 1.0 / 32.0;

/// Which prediction a curve comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Prediction {
    /// Its own motion goes on.
    Flown,
    /// Where it was.
    Still,
    /// By one translation, rotation and scale that the picture's flow shows.
    Carried,
    /// By that, and each node by what flow is left beside it.
    Bent,
    /// Found by its appearance, elsewhere.
    Searched,
    /// Carried from frame to frame by flow alone, never corrected.
    Plain,
}

/// How the motion of the object goes on: in the frame of the body, `z ↦ center + shift + turn · (z − center)`,
/// and slow waves of deformation. Cells a frame.
#[derive(Debug, Clone)]
pub(crate) struct Motion {
    pub turn: DVec2,
    pub shift: DVec2,
    pub waves: Vec<DVec2>,
}

impl Motion {
    pub(crate) fn still(nodes: usize) -> Self {
        Self {
            turn: DVec2::X,
            shift: DVec2::ZERO,
            waves: vec![DVec2::ZERO; nodes],
        }
    }

    /// It follows the way from one curve to the next, node by node.
    pub(crate) fn learn(&mut self, before: &[DVec2], now: &[DVec2], quality: &[f64]) {
        let weights: Vec<f64> = quality.iter().map(|q| q + LEAST_WEIGHT).collect();
        let motion = ring::laid(before, now, &weights).about(ring::middle(before));
        // what is left to see of an object that is mostly hidden does not tell how it moves
        let seen = quality.iter().sum::<f64>() / quality.len() as f64;
        let new = (1.0 - OLD) * seen * seen;
        self.shift += new * (motion.shift - self.shift);
        let turn = self.turn + new * (motion.turn - self.turn);
        self.turn = DVec2::X.lerp(turn, TURN);
        let waves: Vec<DVec2> = before
            .iter()
            .zip(now)
            .map(|(a, b)| *b - motion.at(*a))
            .collect();
        let slow = ring::lowpass(&waves, MODES);
        let waves = self.waves.iter_mut().zip(slow);
        waves.for_each(|(wave, slow)| *wave = WAVE * *wave + 0.5 * WAVE * slow);
    }

    /// It goes on without being seen: its size stays, its waves die away.
    pub(crate) fn coast(&mut self, fade: f64) {
        self.shift *= AIR * fade;
        self.turn = DVec2::X.lerp(self.turn.normalize_or(DVec2::X), fade);
        self.waves.iter_mut().for_each(|wave| *wave *= WAVE);
    }

    /// The curve a frame later.
    pub(crate) fn flown(&self, curve: &[DVec2]) -> Vec<DVec2> {
        let center = ring::middle(curve);
        let motion = Similarity {
            turn: self.turn,
            shift: self.shift,
            center,
        };
        curve
            .iter()
            .zip(&self.waves)
            .map(|(p, wave)| motion.at(*p) + *wave)
            .collect()
    }
}

/// What the picture's flow says of a curve.
#[derive(Debug, Clone)]
pub(crate) struct Flowed {
    pub carried: Vec<DVec2>,
    pub bent: Vec<DVec2>,
    /// Share of the points that could be followed.
    pub share: f64,
}

/// Follow a curve and what it encloses from one frame to the next.
pub(crate) fn flowed(
    from: &Pyramid,
    to: &Pyramid,
    curve: &[DVec2],
    quality: &[f64],
    block: f64,
) -> Option<Flowed> {
    let n = curve.len();
    let radius = ring::radius(curve);
    let normals = ring::normals(curve);
    let nodes: Vec<usize> = (0..n).step_by(n.div_ceil(NODES)).collect();
    let mut points: Vec<DVec2> = nodes
        .iter()
        .map(|&i| curve[i] - INSIDE * normals[i])
        .collect();
    points.extend(interior(curve, (GRID * radius).max(LEAST_GRID)));
    let places: Vec<DVec2> = points.iter().map(|p| to_pixels(*p, block)).collect();
    let moved = carry(from, to, &places, &Rules::default());
    let followed: Vec<usize> = (0..points.len()).filter(|&i| moved[i].is_some()).collect();
    let ends: Vec<Option<DVec2>> = moved
        .iter()
        .map(|moved| moved.map(|moved| to_cells(moved.to, block)))
        .collect();
    let begun: Vec<DVec2> = followed.iter().map(|&i| points[i]).collect();
    let ended: Vec<DVec2> = followed.iter().filter_map(|&i| ends[i]).collect();
    // what lies beside hidden nodes may be what hides them
    let nearest = |p: DVec2| {
        let far = |i: usize| curve[i].distance_squared(p);
        (0..n)
            .min_by(|&a, &b| far(a).total_cmp(&far(b)))
            .map_or(1.0, |i| quality[i])
    };
    let weights: Vec<f64> = begun.iter().map(|p| LEAST_WEIGHT + nearest(*p)).collect();
    let rigid = similarity(&begun, &ended, &weights)?;
    let share = followed.len() as f64 / points.len().max(1) as f64;
    let carried: Vec<DVec2> = curve.iter().map(|p| rigid.at(*p)).collect();
    // what is left beside the nodes, smoothed along the curve where it is known
    let mut left = vec![DVec2::ZERO; n];
    let mut known = vec![0.0; n];
    for (k, &i) in nodes.iter().enumerate() {
        if let Some(end) = ends[k] {
            left[i] = (end - rigid.at(points[k])).clamp_length_max(STRAY * radius);
            known[i] = 1.0;
        }
    }
    let sigma = (SMOOTH * n as f64).max(1.0);
    let sums = search::smooth::smoothed(&left, sigma, true);
    let weights = ring::along(&known, sigma);
    let bent = carried.iter().zip(sums.iter().zip(&weights));
    let bent = bent
        .map(|(p, (sum, weight))| *p + *sum / weight.max(0.02))
        .collect();
    Some(Flowed {
        carried,
        bent,
        share,
    })
}

/// Points of a square lattice that lie well inside a curve.
fn interior(curve: &[DVec2], step: f64) -> Vec<DVec2> {
    let low = curve.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = curve.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    let mut points = Vec::new();
    let mut y = low.y + 0.5 * step;
    while y < high.y {
        let mut crossings: Vec<f64> = Vec::new();
        for i in 0..curve.len() {
            let (a, b) = (curve[i], curve[(i + 1) % curve.len()]);
            if (a.y <= y) != (b.y <= y) {
                crossings.push(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
            }
        }
        crossings.sort_by(f64::total_cmp);
        for pair in crossings.chunks_exact(2) {
            let mut x = pair[0] + 0.5 * step;
            while x < pair[1] - 0.25 * step {
                points.push(DVec2::new(x, y));
                x += step;
            }
        }
        y += step;
    }
    points
}
