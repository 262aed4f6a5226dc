//! The shape that an object usually has: remembered, followed slowly, and used where the object is not seen.
//!
//! How far nodes go from it in a frame is learnt. The outline lies between what was measured and the shape, weighted by
//! the variances of both, as in a Kalman filter of one step; nodes that stray much farther than nodes of this object do
//! are taken for hidden, or for those of something else.

use flow::{Similarity, similarity};
use glam::DVec2;

use crate::correct::calmed;
use crate::ring;

/// Standard error of a node that is seen well, and least quality. Cells.
const NOISE: f64 = 0.3;
const LEAST_QUALITY: f64 = 0.15;

/// How fast the shape follows nodes that are seen, and without the shortest waves.
const FOLLOW: f64 = 0.3;
const STIFF: f64 = 0.015;

/// Deviation of nodes from the shape to begin with and at least, in radii; how fast it is learnt; which share of nodes
/// lies nearer (a standard deviation), and how much more than before it may be.
const FIRST: f64 = 0.06;
const LEAST: f64 = 0.01;
const LEARN: f64 = 0.1;
const NEARER: (usize, usize) = (2, 3);
const MORE: f64 = 2.0;

/// A node strays beyond so many times its usual deviation and the noise of a reading; twice as far after so many
/// frames.
const STRAY: f64 = 4.0;
const READING: f64 = 0.5;
const PATIENCE: f64 = 10.0;

/// Share of straying nodes from which on the size is remembered, since the rest does not tell it.
const FEW: f64 = 0.08;

/// So many nodes on either side of one that strays do too: they were drawn along.
const ALONG: usize = 3;

/// The most nodes a curve may slide along itself in a frame, and how much a turn must matter to be seen, in squared
/// distances of nodes.
const SLID: usize = 8;
const CLEAR: f64 = 0.3;

/// Weight of nodes that are not seen.
const UNSEEN: f64 = 0.02;

/// A remembered shape.
#[derive(Debug, Clone)]
pub(crate) struct Shape {
    nodes: Vec<DVec2>,
    /// Standard deviation of a node from it within a frame, in radii.
    pub deviation: f64,
    /// For how many frames each node has strayed.
    astray: Vec<u32>,
}

/// A curve between what was measured and the shape.
#[derive(Debug, Clone)]
pub(crate) struct Kept {
    pub curve: Vec<DVec2>,
    /// Which nodes stray.
    pub strays: Vec<bool>,
    /// How far most nodes were from the shape, in radii.
    pub off: f64,
}

impl Shape {
    pub(crate) fn new(curve: &[DVec2]) -> Self {
        Self {
            nodes: curve.to_vec(),
            deviation: FIRST,
            astray: vec![0; curve.len()],
        }
    }

    /// Whether too much is hidden for the rest to tell the size.
    fn is_hidden(&self, quality: &[f64]) -> bool {
        let hidden = (0..quality.len())
            .filter(|&i| quality[i] <= 0.0 || self.astray[i] > 0)
            .count();
        hidden as f64 > FEW * quality.len() as f64
    }

    /// The shape laid on most of a curve; `quality` of nodes now, and `before`, 0 … 1.
    fn laid(&self, curve: &[DVec2], quality: &[f64], before: &[f64]) -> Vec<DVec2> {
        let weights: Vec<f64> = quality
            .iter()
            .zip(before)
            .map(|(now, before)| now * before + UNSEEN)
            .collect();
        let mut motion = similarity(&self.nodes, curve, &weights).unwrap_or(Similarity::STILL);
        if self.is_hidden(quality) {
            motion.turn = motion.turn.normalize_or(DVec2::X);
        }
        self.nodes.iter().map(|p| motion.at(*p)).collect()
    }

    /// Nodes farther from the shape than this object's go.
    fn strays(&self, curve: &[DVec2], shape: &[DVec2]) -> Vec<bool> {
        let normals = ring::normals(curve);
        let usual = self.deviation * ring::radius(curve) + READING;
        let n = curve.len();
        let own: Vec<bool> = (0..n)
            .map(|i| {
                let waited = f64::from(self.astray[i]) / PATIENCE;
                let off = (shape[i] - curve[i]).dot(normals[i]).abs();
                off > STRAY * usual * (1.0 + waited * waited)
            })
            .collect();
        (0..n)
            .map(|i| (0..=2 * ALONG).any(|k| own[(i + n + k - ALONG) % n]))
            .collect()
    }

    /// A measured curve as far as it can be trusted; `quality` becomes 0 where it strays.
    pub(crate) fn kept(&self, curve: &[DVec2], quality: &mut [f64], before: &[f64]) -> Kept {
        let mut strays = Vec::new();
        let mut shape = self.laid(curve, quality, before);
        let off = off(curve, &shape);
        for _ in 0..2 {
            strays = self.strays(curve, &shape);
            for (quality, stray) in quality.iter_mut().zip(&strays) {
                if *stray {
                    *quality = 0.0;
                }
            }
            shape = self.laid(curve, quality, before);
        }
        let curve = calmed(curve, &shape);
        let usual = (self.deviation * ring::radius(&curve)).powi(2);
        let between = |i: usize| {
            let noise = (NOISE / (quality[i] + LEAST_QUALITY)).powi(2);
            curve[i].lerp(shape[i], noise / (noise + usual))
        };
        Kept {
            curve: (0..curve.len()).map(between).collect(),
            strays,
            off,
        }
    }

    /// By how many nodes a curve's nodes have slid along it, against the shape: the turn of its nodes by which it lies
    /// best on the shape. None where no turn is clearly better than another, as on a circle.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a few nodes"
    )]
    pub(crate) fn slid(&self, curve: &[DVec2], quality: &[f64]) -> Option<f64> {
        let n = curve.len();
        let most = SLID.min(n / 8).cast_signed();
        let weights: Vec<f64> = quality.iter().map(|q| q + UNSEEN).collect();
        let misfit = |slid: isize| -> f64 {
            let from = slid.rem_euclid(n.cast_signed()).unsigned_abs();
            let turned: Vec<DVec2> = (0..n).map(|i| curve[(i + from) % n]).collect();
            let motion = ring::laid(&self.nodes, &turned, &weights);
            let squares =
                (0..n).map(|i| weights[i] * motion.at(self.nodes[i]).distance_squared(turned[i]));
            squares.sum::<f64>() / weights.iter().sum::<f64>()
        };
        let all: Vec<f64> = (-most..=most).map(misfit).collect();
        let best = (0..all.len()).min_by(|&a, &b| all[a].total_cmp(&all[b]))?;
        if best == 0 || best + 1 == all.len() {
            return None;
        }
        let (a, b, c) = (all[best - 1], all[best], all[best + 1]);
        let spacing = elastic::length(curve, true) / n as f64;
        let bent = a - 2.0 * b + c;
        // a turn by one node must matter by a good part of the way of the nodes
        (bent > CLEAR * spacing * spacing).then(|| {
            let share = (0.5 * (a - c) / bent).clamp(-0.5, 0.5);
            best as f64 - most as f64 + share
        })
    }

    /// How far a curve is from the shape, in its usual deviations.
    pub(crate) fn distance(&self, curve: &[DVec2]) -> f64 {
        let motion = ring::laid(&self.nodes, curve, &vec![1.0; curve.len()]);
        let squares = self
            .nodes
            .iter()
            .zip(curve)
            .map(|(a, b)| motion.at(*a).distance_squared(*b));
        let rms = (squares.sum::<f64>() / curve.len() as f64).sqrt();
        rms / ring::radius(curve).max(1.0) / self.deviation
    }

    /// The shape follows a curve where it was seen.
    pub(crate) fn follow(&mut self, curve: &[DVec2], quality: &[f64], strays: &[bool], off: f64) {
        let weights: Vec<f64> = quality.iter().map(|q| q + UNSEEN).collect();
        let mut laid = ring::laid(&self.nodes, curve, &weights);
        if self.is_hidden(quality) {
            laid.turn = laid.turn.normalize_or(DVec2::X);
        }
        for ((node, p), q) in self.nodes.iter_mut().zip(curve).zip(quality) {
            *node = laid.at(*node).lerp(*p, FOLLOW * q);
        }
        self.nodes = ring::calmed(&self.nodes, STIFF);
        let off = off.min(MORE * self.deviation);
        self.deviation = (self.deviation + LEARN * (off - self.deviation)).max(LEAST);
        for (astray, stray) in self.astray.iter_mut().zip(strays) {
            *astray = if *stray { *astray + 1 } else { 0 };
        }
    }

    /// The same for other nodes, at places between these.
    pub(crate) fn respaced(&self, places: &[f64]) -> Self {
        Self {
            nodes: ring::between(&self.nodes, places),
            deviation: self.deviation,
            astray: vec![0; places.len()],
        }
    }
}

/// How far most nodes of a curve are from a shape along their normals, in radii: a standard deviation.
fn off(curve: &[DVec2], shape: &[DVec2]) -> f64 {
    let normals = ring::normals(curve);
    let mut off: Vec<f64> = (0..curve.len())
        .map(|i| (curve[i] - shape[i]).dot(normals[i]).abs())
        .collect();
    let at = off.len() * NEARER.0 / NEARER.1;
    *off.select_nth_unstable_by(at, f64::total_cmp).1 / ring::radius(curve).max(1.0)
}
