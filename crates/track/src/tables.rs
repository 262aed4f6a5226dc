//! Appearance beside the curve: how often each class lies inside and outside, near each node and along all of it.

use glam::DVec2;

use crate::palette::Palette;
use crate::window::Window;

/// Depth of the strips on either side, in radii and between these. Cells.
const DEPTH: f64 = 0.25;
const DEPTHS: [f64; 2] = [6.0, 25.0];

/// σ along the curve of the tables of nodes: of the depth, and at least. Nodes.
const WIDE: f64 = 0.35;
const LEAST_WIDE: f64 = 2.0;

/// Samples outside end where the curve is as near elsewhere, times this.
const BEYOND: f64 = 1.8;

/// The most a class may speak for a side: a logarithm.
const MOST: f32 = 2.0;

/// Share of classes never seen, over the number of classes.
const UNSEEN: f32 = 0.3;

/// Depth of the strips.
pub(crate) fn depth(radius: f64) -> f64 {
    (DEPTH * radius).clamp(DEPTHS[0], DEPTHS[1])
}

/// A curve with what its strips need.
#[derive(Debug, Clone)]
pub(crate) struct Strips<'a> {
    pub curve: &'a [DVec2],
    pub normals: Vec<DVec2>,
    pub room: Vec<[f64; 2]>,
    pub depth: f64,
}

impl<'a> Strips<'a> {
    pub(crate) fn of(curve: &'a [DVec2], radius: f64) -> Self {
        let normals = crate::ring::normals(curve);
        let room = crate::ring::room(curve, &normals);
        Self {
            curve,
            normals,
            room,
            depth: depth(radius),
        }
    }
}

/// Shares of classes on both sides: rows of nodes, and all nodes together. Inside first.
#[derive(Debug, Clone)]
pub(crate) struct Tables {
    pub local: [Vec<f32>; 2],
    pub pooled: [Vec<f32>; 2],
}

impl Tables {
    /// What the strips hold, `margin` cells off the curve and farther.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "lengths of a few cells"
    )]
    pub(crate) fn learnt(
        window: &Window,
        palette: &Palette,
        strips: &Strips<'_>,
        quality: &[f64],
        margin: f64,
    ) -> Self {
        let (n, k) = (strips.curve.len(), palette.len());
        let sides = [-1.0, 1.0];
        let both = sides.map(|side| {
            let mut counts = vec![0.0_f32; n * k];
            for i in 0..n {
                let room = if side < 0.0 {
                    strips.room[i][0]
                } else {
                    BEYOND * strips.room[i][1]
                };
                let mut d = margin;
                while d <= strips.depth && (d <= room || d < margin + 1.0) {
                    if let Some(class) =
                        window.class(strips.curve[i] + side * d * strips.normals[i], palette)
                    {
                        counts[i * k + usize::from(class)] += quality[i] as f32;
                    }
                    d += 1.0;
                }
            }
            let sigma = (WIDE * strips.depth).max(LEAST_WIDE);
            let reach = (2.5 * sigma).ceil() as usize;
            let weights: Vec<f32> = (0..=reach)
                .map(|j| (-0.5 * (j as f64 / sigma).powi(2)).exp() as f32)
                .collect();
            let mut local = vec![0.0_f32; n * k];
            let mut sum = vec![0.0_f32; k];
            for i in 0..n {
                sum.fill(0.0);
                for j in -(reach.cast_signed())..=reach.cast_signed() {
                    let from = (i.cast_signed() + j)
                        .rem_euclid(n.cast_signed())
                        .unsigned_abs();
                    let weight = weights[j.unsigned_abs()];
                    let row = &counts[from * k..(from + 1) * k];
                    sum.iter_mut()
                        .zip(row)
                        .for_each(|(sum, v)| *sum += weight * v);
                }
                let row = &mut local[i * k..(i + 1) * k];
                palette.shared(&sum, row);
                normalise(row);
            }
            let mut pooled = vec![0.0_f32; k];
            for row in counts.chunks_exact(k) {
                pooled.iter_mut().zip(row).for_each(|(sum, v)| *sum += v);
            }
            let mut shared = vec![0.0_f32; k];
            palette.shared(&pooled, &mut shared);
            normalise(&mut shared);
            (local, shared)
        });
        let [(inner, inner_pooled), (outer, outer_pooled)] = both;
        Self {
            local: [inner, outer],
            pooled: [inner_pooled, outer_pooled],
        }
    }

    /// A weighted mean of two.
    pub(crate) fn mixed(&self, other: &Self, share: f32) -> Self {
        let mix =
            |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| a + share * (b - a)).collect();
        Self {
            local: [
                mix(&self.local[0], &other.local[0]),
                mix(&self.local[1], &other.local[1]),
            ],
            pooled: [
                mix(&self.pooled[0], &other.pooled[0]),
                mix(&self.pooled[1], &other.pooled[1]),
            ],
        }
    }

    /// Move towards others, each node by its own share and all together by another.
    pub(crate) fn learn(&mut self, other: &Self, shares: &[f32], all: f32) {
        let k = self.pooled[0].len();
        for side in 0..2 {
            let rows = self.local[side]
                .chunks_exact_mut(k)
                .zip(other.local[side].chunks_exact(k));
            for ((row, from), share) in rows.zip(shares) {
                row.iter_mut()
                    .zip(from)
                    .for_each(|(a, b)| *a += share * (b - *a));
            }
            let pooled = self.pooled[side].iter_mut().zip(&other.pooled[side]);
            pooled.for_each(|(a, b)| *a += all * (b - *a));
        }
    }

    /// How much likelier each class is inside than outside: rows of nodes.
    pub(crate) fn ratios(&self) -> Ratios {
        let k = self.pooled[0].len();
        let unseen = UNSEEN / k as f32;
        let rows = self.local[0]
            .chunks_exact(k)
            .zip(self.local[1].chunks_exact(k));
        let mut ratios = Vec::with_capacity(self.local[0].len());
        for (inner, outer) in rows {
            for c in 0..k {
                let a = 0.5 * (inner[c] + self.pooled[0][c]) + unseen;
                let b = 0.5 * (outer[c] + self.pooled[1][c]) + unseen;
                ratios.push((a / b).ln().clamp(-MOST, MOST));
            }
        }
        Ratios { k, ratios }
    }

    /// The same by the tables of all nodes together.
    pub(crate) fn pooled_ratios(&self) -> Vec<f64> {
        let unseen = UNSEEN / self.pooled[0].len() as f32;
        let both = self.pooled[0].iter().zip(&self.pooled[1]);
        both.map(|(a, b)| f64::from(((a + unseen) / (b + unseen)).ln().clamp(-MOST, MOST)))
            .collect()
    }

    /// The same for other nodes, at places between these.
    pub(crate) fn respaced(&self, places: &[f64]) -> Self {
        let k = self.pooled[0].len();
        let local = [0, 1].map(|side| respaced(&self.local[side], k, places));
        Self {
            local,
            pooled: self.pooled.clone(),
        }
    }
}

/// Rows of `k` numbers at places between rows.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "places between nodes"
)]
pub(crate) fn respaced(rows: &[f32], k: usize, places: &[f64]) -> Vec<f32> {
    let n = rows.len() / k;
    let mut out = Vec::with_capacity(places.len() * k);
    for place in places {
        let at = place.floor();
        let share = (place - at) as f32;
        let (a, b) = (at as usize % n, (at as usize + 1) % n);
        out.extend((0..k).map(|c| rows[a * k + c] + share * (rows[b * k + c] - rows[a * k + c])));
    }
    out
}

/// Logarithms of shares inside against outside, for each node and class.
#[derive(Debug, Clone)]
pub(crate) struct Ratios {
    k: usize,
    ratios: Vec<f32>,
}

impl Ratios {
    pub(crate) fn at(&self, node: usize, class: u8) -> f64 {
        f64::from(self.ratios[node * self.k + usize::from(class)])
    }
}

fn normalise(row: &mut [f32]) {
    let total: f32 = row.iter().sum();
    if total > 0.0 {
        row.iter_mut().for_each(|v| *v /= total);
    } else {
        let even = (row.len() as f32).recip();
        row.fill(even);
    }
}
