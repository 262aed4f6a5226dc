//! A picture along the normals of a curve: one row of levels a node, from the inside out.

use glam::DVec2;
use search::smooth::smoothed;

use crate::blocks::Blocks;
use crate::patch::{Part, Patch, clamped};

/// Pixels from one sample of a profile to the next.
pub(crate) const SAMPLE: f64 = 0.5;

/// What cubic convolution leaves of the standard deviation of a pixel's noise: the root mean square of
/// `Σ w²` over all places between pixels, in two dimensions.
pub(crate) const NOISE_LEFT: f64 = 0.81;

/// Levels along the normals of a curve's nodes.
#[derive(Debug)]
pub(crate) struct Profiles {
    /// Level of each node and sample, in rows.
    levels: Vec<f64>,
    count: usize,
    /// Whether all pixels of a row count.
    whole: Vec<bool>,
}

impl Profiles {
    /// Sample the normals of a curve from −`reach` to `reach`. A color picture is seen along the direction from the
    /// mean color outside to that inside, node by node.
    pub(crate) fn of(
        pixels: Blocks<'_>,
        patch: &Patch<'_>,
        points: &[DVec2],
        normals: &[DVec2],
        reach: f64,
        beside: &Beside,
    ) -> Self {
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "some dozens of samples"
        )]
        let half = (reach / SAMPLE).ceil().max(1.0) as usize;
        let count = 2 * half + 1;
        let mut levels = Vec::with_capacity(points.len() * count);
        let offset = |k: usize| (k as f64 - half as f64) * SAMPLE;
        match patch {
            Patch::Color(patch) => {
                let directions = beside.directions(patch, points, normals);
                for ((p, normal), direction) in points.iter().zip(normals).zip(&directions) {
                    for k in 0..count {
                        let value = patch.sample(*p + offset(k) * *normal);
                        levels.push(value.iter().zip(direction).map(|(v, d)| v * d).sum());
                    }
                }
            }
            Patch::Grey(patch) => {
                for (p, normal) in points.iter().zip(normals) {
                    for k in 0..count {
                        let [level] = patch.sample(*p + offset(k) * *normal);
                        levels.push(level);
                    }
                }
            }
        }
        let finite: Vec<bool> = levels
            .chunks(count)
            .map(|row| row.iter().all(|level| level.is_finite()))
            .collect();
        for level in levels.iter_mut().filter(|level| !level.is_finite()) {
            *level = 0.0;
        }
        let all = pixels.all_count();
        let whole = (0..points.len()).map(|i| {
            let place = |k: usize| points[i] + offset(k) * normals[i];
            let counts = |k: usize| {
                let (x, y) = nearest(pixels.size(), place(k));
                pixels.counts(x, y)
            };
            finite[i] && (all || (0..count).all(counts))
        });
        Self {
            levels,
            count,
            whole: whole.collect(),
        }
    }

    pub(crate) const fn count(&self) -> usize {
        self.count
    }

    pub(crate) const fn nodes(&self) -> usize {
        self.whole.len()
    }

    pub(crate) fn row(&self, node: usize) -> &[f64] {
        &self.levels[node * self.count..(node + 1) * self.count]
    }

    /// The largest level either way.
    pub(crate) fn largest(&self) -> f64 {
        self.levels
            .iter()
            .fold(0.0, |most: f64, level| most.max(level.abs()))
    }

    /// Whether all pixels along a node's normal count.
    pub(crate) fn is_whole(&self, node: usize) -> bool {
        self.whole[node]
    }

    /// How far outside the curve a sample lies.
    pub(crate) fn offset(&self, k: usize) -> f64 {
        (k as f64 - (self.count / 2) as f64) * SAMPLE
    }
}

/// Where beside a curve colors are compared.
#[derive(Debug)]
pub(crate) struct Beside {
    /// From where to where on either side. Pixels.
    pub near: f64,
    pub far: f64,
    /// σ along the curve, in nodes.
    pub along: f64,
    pub closed: bool,
}

impl Beside {
    /// Unit vectors from the color outside to that inside, smoothed along the curve.
    fn directions(
        &self,
        patch: &Part<'_, 3>,
        points: &[DVec2],
        normals: &[DVec2],
    ) -> Vec<[f64; 3]> {
        let side = |p: DVec2, normal: DVec2, sign: f64| -> [f64; 3] {
            let mut sum = [0.0; 3];
            for share in [0.0, 0.5, 1.0] {
                let way = self.near + share * (self.far - self.near);
                let value = patch.sample(p + sign * way * normal);
                for (sum, value) in sum.iter_mut().zip(value) {
                    *sum += value / 3.0;
                }
            }
            sum
        };
        let mut smooth = vec![[0.0; 3]; points.len()];
        let differences: Vec<[f64; 3]> = points
            .iter()
            .zip(normals)
            .map(|(p, normal)| {
                let (inner, outer) = (side(*p, *normal, -1.0), side(*p, *normal, 1.0));
                std::array::from_fn(|c| inner[c] - outer[c])
            })
            .collect();
        for c in 0..3 {
            let list: Vec<f64> = differences.iter().map(|one| one[c]).collect();
            for (smooth, value) in smooth
                .iter_mut()
                .zip(smoothed(&list, self.along, self.closed))
            {
                smooth[c] = value;
            }
        }
        let unit = |one: [f64; 3]| {
            let length = one.iter().map(|v| v * v).sum::<f64>().sqrt();
            if length > 0.0 {
                one.map(|v| v / length)
            } else {
                [1.0 / 3.0_f64.sqrt(); 3]
            }
        };
        smooth.into_iter().map(unit).collect()
    }
}

fn nearest((width, height): (usize, usize), p: DVec2) -> (usize, usize) {
    (clamped(p.x.round(), width), clamped(p.y.round(), height))
}
