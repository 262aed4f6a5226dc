//! The way from an outline that may be several pixels off to within reach of the edge.

use glam::DVec2;
use search::along::Polygon;
use search::path::{Costs, Steps};
use search::smooth::smoothed;

use crate::blocks::Blocks;
use crate::patch::Patch;
use crate::profile::{Beside, Profiles, SAMPLE};

/// Width of the two boxes whose difference is a slope, in samples; and how far the samples go on beyond the band.
const BOX: usize = 4;
const BEYOND: usize = 6;

/// Price of the way from where the outline was found to the end of the band, in whole edges.
const TETHER: f64 = 0.3;

/// Price of a step along the path, at equal distances of nodes and samples.
const BEND: f64 = 0.05;

/// The best path within `reach` of an outline through slopes of one polarity a stretch.
pub(crate) fn nearer(
    pixels: Blocks<'_>,
    patch: &Patch<'_>,
    curve: &Polygon,
    reach: f64,
    spacing: f64,
) -> Option<Vec<DVec2>> {
    let (points, closed) = (&curve.points, curve.closed);
    let n = points.len();
    let stretch = 0.08 * n as f64;
    let normals = curve.normals(0.5 * reach / spacing);
    let beside = Beside {
        near: reach,
        far: reach + 3.0,
        along: stretch,
        closed,
    };
    let window = reach + BEYOND as f64 * SAMPLE;
    let profiles = Profiles::of(pixels, patch, points, &normals, window, &beside);
    let states = profiles.count() - 2 * BEYOND;
    let mut slopes = vec![vec![0.0; n]; states];
    for i in 0..n {
        let row = profiles.row(i);
        for (s, slope) in slopes.iter_mut().enumerate() {
            let k = s + BEYOND;
            let inner: f64 = row[k - BOX..k].iter().sum();
            let outer: f64 = row[k + 1..=k + BOX].iter().sum();
            slope[i] = (inner - outer) / BOX as f64;
        }
    }
    for slope in &mut slopes {
        *slope = smoothed(slope, 1.5 / spacing, closed);
    }
    // the polarity of a stretch is that of its mean slope
    let mean: Vec<f64> = (0..n)
        .map(|i| slopes.iter().map(|slope| slope[i]).sum())
        .collect();
    let mean = smoothed(&mean, stretch, closed);
    let mut sizes: Vec<f64> = slopes.iter().flatten().map(|slope| slope.abs()).collect();
    let at = sizes.len() * 3 / 4;
    let half = sizes
        .select_nth_unstable_by(at, f64::total_cmp)
        .1
        .max(f64::MIN_POSITIVE);
    let mut list = Vec::with_capacity(n * states);
    for i in 0..n {
        for (s, slope) in slopes.iter().enumerate() {
            let slope = (slope[i] * mean[i].signum()).max(0.0);
            let away = profiles.offset(s + BEYOND) / reach;
            list.push(TETHER * away * away - slope / (slope + half));
        }
    }
    let steps = Steps {
        bend: BEND * (SAMPLE / spacing).powi(2),
        reach: 2,
    };
    let costs = Costs::new(states, list);
    let path = if closed {
        costs.closed_path(steps)
    } else {
        costs.open_path(steps, None)
    }?;
    let offsets: Vec<f64> = path
        .states
        .iter()
        .map(|&s| profiles.offset(s + BEYOND))
        .collect();
    let offsets = smoothed(&offsets, 2.0 / spacing, closed);
    let moved = points.iter().zip(&normals).zip(&offsets);
    Some(
        moved
            .map(|((p, normal), way)| *p + *way * *normal)
            .collect(),
    )
}
