//! A curve brought onto its evidence: an offset along each normal, all together the least of a closed chain.

use glam::DVec2;
use search::path::{Costs, Steps};

use crate::edges::strength;
use crate::evidence::Look;
use crate::palette::Feature;
use crate::profile::{HALF, SAMPLES};
use crate::ring;
use crate::tables::Strips;

/// Weight of the region and of the profile, and the most that a profile may speak against a place.
const REGION: f64 = 0.5;
/// Weight of an edge.
const EDGE: f64 = 6.0;
const PROFILE: f64 = 1.0;
const WORST: f64 = 3.0;

/// Degrees of freedom of the tether: how soon it lets go.
const TAIL: f64 = 2.0;

/// Nodes two cells apart differ in their offsets by so many cells (σ).
const SLANT: f64 = 0.6;
const APART: f64 = 2.0;

/// The most that neighbours may differ. Cells.
const REACH: usize = 4;

/// Price of a place beyond the middle of the object.
const BEYOND: f64 = 1e3;

/// How far nodes may go.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Band {
    /// σ of the tether to the prediction. Cells.
    pub tether: f64,
    /// Half width. Cells.
    pub half: usize,
}

/// How much the region, the profile and the edge speak.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Weights {
    region: f64,
    profile: f64,
    edge: f64,
    /// Whether the steepest slope is meant, not any.
    sharp: bool,
}

/// To find where the curve has gone.
pub(crate) const ALL: Weights = Weights {
    region: REGION,
    profile: PROFILE,
    edge: EDGE,
    sharp: false,
};

/// To place it, once it is found: the region would push it off the middle of a strong edge.
pub(crate) const EDGES: Weights = Weights {
    region: 0.0,
    profile: 0.0,
    edge: EDGE,
    sharp: true,
};

/// An offset of each node, and how firmly it is known: the curvature of its cost.
#[derive(Debug, Clone)]
pub(crate) struct Offsets {
    pub offsets: Vec<f64>,
    pub held: Vec<f64>,
}

/// The best offsets; None where there is no path.
pub(crate) fn offsets(
    look: Look<'_>,
    strips: &Strips<'_>,
    band: Band,
    weights: Weights,
) -> Option<Offsets> {
    let n = strips.curve.len();
    let half = band.half.cast_signed();
    let states = 2 * band.half + 1;
    let mut cost = vec![0.0; n * states];
    let wide = band.half + HALF;
    let mut line: Vec<Option<Feature>> = vec![None; 2 * wide + 1];
    let spacing = elastic::length(strips.curve, true) / n as f64;
    for i in 0..n {
        let at = |d: isize| strips.curve[i] + d as f64 * strips.normals[i];
        for (k, sample) in line.iter_mut().enumerate() {
            let d = k.cast_signed() - wide.cast_signed();
            *sample = look.profiles.and_then(|_| look.window.feature(at(d)));
        }
        let row = &mut cost[i * states..(i + 1) * states];
        let ratio = |d: isize| {
            // the cell between two places: half a cell beyond the nearer
            let place = strips.curve[i] + d as f64 * strips.normals[i];
            look.ratio(i, place).unwrap_or(0.0)
        };
        // what the curve takes in when it goes out by d, and loses when it goes in
        let here = ratio(0);
        let mut sums = vec![0.0; states];
        for sign in [1_isize, -1] {
            let (mut sum, mut last) = (0.0, here);
            for k in 1..=half {
                let next = ratio(sign * k);
                sum += sign as f64 * 0.5 * (last + next);
                last = next;
                sums[(half + sign * k).unsigned_abs()] = sum;
            }
        }
        if let Some((edges, steep)) = look.edges {
            let slopes: Vec<f32> = (-half..=half)
                .map(|d| edges.slope(look.window, strips, i, d as f64 + edges.offsets[i]))
                .collect();
            let steepest = slopes.iter().copied().fold(0.0, f32::max);
            for (cost, slope) in row.iter_mut().zip(&slopes) {
                let edge = if weights.sharp && steepest > 0.0 {
                    strength(steepest, steep) * f64::from((slope / steepest).max(0.0))
                } else {
                    strength(*slope, steep)
                };
                *cost -= weights.edge * edge;
            }
        }
        for (k, cost) in row.iter_mut().enumerate() {
            let d = k as f64 - band.half as f64;
            *cost += -weights.region * sums[k] + tail(d / band.tether);
            if let Some(profiles) = look.profiles {
                let samples: Option<Vec<Feature>> = line[k..k + SAMPLES].iter().copied().collect();
                let misfit = samples.map_or(WORST, |samples| {
                    (0.5 * profiles.misfit(i, &samples)).min(WORST)
                });
                *cost += weights.profile * misfit;
            }
            let [inner, outer] = strips.room[i];
            if -d > inner || d > 2.0 * outer {
                *cost += BEYOND;
            }
        }
    }
    let bend = 0.5 / (SLANT * SLANT) * APART / spacing.max(0.25);
    let costs = Costs::new(states, cost);
    let path = costs.closed_path(Steps { bend, reach: REACH })?;
    let mut offsets = Vec::with_capacity(n);
    let mut held = Vec::with_capacity(n);
    for (i, &state) in path.states.iter().enumerate() {
        let row = costs.row(i);
        let near = |k: usize| {
            let beside = [path.states[(i + n - 1) % n], path.states[(i + 1) % n]];
            row[k]
                + beside
                    .iter()
                    .map(|&b| bend * (b as f64 - k as f64).powi(2))
                    .sum::<f64>()
        };
        let mut offset = state as f64 - band.half as f64;
        let mut firm = 0.05;
        if state > 0 && state + 1 < states {
            let (a, b, c) = (near(state - 1), near(state), near(state + 1));
            let bent = a - 2.0 * b + c;
            if bent > 1e-9 {
                offset += (0.5 * (a - c) / bent).clamp(-0.5, 0.5);
            }
            let own = row[state - 1] - 2.0 * row[state] + row[state + 1];
            firm = own.clamp(0.05, 20.0);
        }
        offsets.push(offset);
        held.push(firm);
    }
    Some(Offsets { offsets, held })
}

/// Which part of the offsets is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pass {
    /// One similarity.
    Pose,
    /// Slow waves.
    Low,
    /// All.
    Full,
}

/// Slow waves of a deformation, each way round.
pub(crate) const MODES: usize = 8;

/// Smoothing of offsets in nodes, and stiffness against the shortest waves.
const OFFSETS: f64 = 0.8;
const STIFF: f64 = 0.15;

/// A curve without the shortest waves of its difference from a shape.
pub(crate) fn calmed(curve: &[DVec2], shape: &[DVec2]) -> Vec<DVec2> {
    let off: Vec<DVec2> = curve.iter().zip(shape).map(|(p, q)| *p - *q).collect();
    ring::calmed(&off, STIFF)
        .iter()
        .zip(shape)
        .map(|(off, q)| *off + *q)
        .collect()
}

/// The curve moved by its offsets.
pub(crate) fn moved(strips: &Strips<'_>, found: &Offsets, pass: Pass) -> Vec<DVec2> {
    let ways = |offsets: &[f64]| -> Vec<DVec2> {
        offsets
            .iter()
            .zip(&strips.normals)
            .map(|(d, normal)| *d * *normal)
            .collect()
    };
    match pass {
        Pass::Pose => {
            let to: Vec<DVec2> = strips
                .curve
                .iter()
                .zip(ways(&found.offsets))
                .map(|(p, way)| *p + way)
                .collect();
            let motion = ring::laid(strips.curve, &to, &found.held);
            strips.curve.iter().map(|p| motion.at(*p)).collect()
        }
        Pass::Low => {
            let slow = ring::lowpass(&ways(&found.offsets), MODES);
            strips
                .curve
                .iter()
                .zip(slow)
                .map(|(p, way)| *p + way)
                .collect()
        }
        Pass::Full => {
            let smooth = ring::along(&found.offsets, OFFSETS);
            let curve: Vec<DVec2> = strips
                .curve
                .iter()
                .zip(ways(&smooth))
                .map(|(p, way)| *p + way)
                .collect();
            curve
        }
    }
}

/// A curve without crossings, as many nodes at equal distances; the first at a place between nodes, or where there
/// were crossings the nearest to the first node.
pub(crate) fn simple(
    curve: &[DVec2],
    count: usize,
    first: f64,
) -> Option<(Vec<DVec2>, Option<Vec<f64>>)> {
    let crossed = outline::crossings(curve, true).map_or(true, |found| !found.is_empty());
    if !crossed {
        let (points, places) = ring::evenly_from(curve, count, first);
        return Some((points, Some(places)));
    }
    let resolved = outline::resolve(curve, 1.0).ok()?;
    let largest = resolved
        .pieces
        .into_iter()
        .max_by(|a, b| a.area.total_cmp(&b.area))?;
    let mut nodes = largest.nodes;
    let first = (0..nodes.len()).min_by(|&a, &b| {
        let far = |i: usize| nodes[i].distance_squared(curve[0]);
        far(a).total_cmp(&far(b))
    })?;
    nodes.rotate_left(first);
    (nodes.len() >= 3).then(|| (ring::evenly(&nodes, count).0, None))
}

/// Half the square of a deviation where it is small, and a logarithm of it where it is large (Student's distribution).
fn tail(z: f64) -> f64 {
    TAIL * (0.5 * z * z / TAIL).ln_1p()
}
