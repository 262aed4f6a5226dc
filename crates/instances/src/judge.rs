//! What a grid says for a region: its border is an edge all along, and its shape is that of one object.

use crate::region::Region;
use crate::relief::Relief;

/// How far beside the border levels are compared, in pixels of the grid.
const BESIDE: usize = 3;

/// The share of the border that is steeper than its contrast tells.
const CONTRAST: f64 = 0.75;

/// A fall of this share of the contrast is half an edge.
const HALF: f64 = 0.25;

/// A rise where a fall should be is worth this: another object may touch there.
const RISE: f64 = 0.6;

/// What a side beside another object is worth; one side in so many must lie beside none.
const CONTACT: f64 = 0.6;
const FREE: usize = 5;

/// Where the picture falls on as much as this share of the fall at the border, on the far sides of it, it is a slope
/// and no edge.
const SLOPE: f64 = 0.8;

/// The fall that noise alone gives between the extremes beside a border, and that below which nothing is an edge, in
/// its standard deviations.
const BIAS: f64 = 2.0;
const LEAST: f64 = 6.0;

/// A region that fills so much of its convex hull is as good as convex, and one that fills so little is worth nothing.
const CONVEX: f64 = 0.96;
const HOLLOW: f64 = 0.87;

/// A pixel that is above the ground beside a region by less than this share of its contrast is none of an object.
const VOID: f64 = 0.3;

/// What a grid says for a region.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Verdict {
    /// How much of an edge its border is, in the mean. 0 … 1.
    pub edge: f64,
    /// Sides of pixels along its border, that of the picture left out.
    pub sides: usize,
    /// How much lighter it is than what lies beside it.
    pub contrast: f64,
    /// How convex it is, and how much of it is not like the ground. 0 … 1.
    pub shape: f64,
}

/// What a grid says for a region; None for one that noise explains, or that is mostly cut off by the picture's border.
///
/// Beside what is `taken` by others the border needs no edge.
pub(crate) fn judge(
    relief: &Relief,
    region: &Region,
    taken: impl Fn(usize, usize) -> bool,
) -> Option<Verdict> {
    let (height, width) = relief.dim();
    let (mut contact, mut beyond) = (0_usize, 0.0);
    let mut falls: Vec<(f64, f64)> = Vec::new();
    let mut lows: Vec<f64> = Vec::new();
    let mut sides = 0_usize;
    for (y, x) in region.pixels() {
        for (dx, dy) in [(1_isize, 0_isize), (-1, 0), (0, 1), (0, -1)] {
            let step = |k: isize| {
                let (x, y) = (x.checked_add_signed(k * dx)?, y.checked_add_signed(k * dy)?);
                (x < width && y < height).then_some((x, y))
            };
            let Some((i, j)) = step(1) else {
                sides += 1;
                continue;
            };
            if region.holds(i, j) {
                continue;
            }
            sides += 1;
            let (mut high, mut low_in) = (f64::NEG_INFINITY, f64::INFINITY);
            let (mut low, mut high_out) = (f64::INFINITY, f64::NEG_INFINITY);
            for k in 0..BESIDE as isize {
                if let Some((i, j)) = step(-k).filter(|&(i, j)| region.holds(i, j)) {
                    let value = relief.value(i, j);
                    high = high.max(value);
                    low_in = low_in.min(value);
                } else {
                    break;
                }
            }
            for k in 1..=BESIDE as isize {
                if let Some((i, j)) = step(k).filter(|&(i, j)| !region.holds(i, j)) {
                    let value = relief.value(i, j);
                    low = low.min(value);
                    high_out = high_out.max(value);
                } else {
                    break;
                }
            }
            let deep = 2 * BESIDE as isize;
            let within = step(1 - deep).filter(|&(i, j)| region.holds(i, j));
            beyond += within.map_or(0.0, |(i, j)| (relief.value(i, j) - high).max(0.0));
            let outside = step(deep).filter(|&(i, j)| !region.holds(i, j));
            beyond += outside.map_or(0.0, |(i, j)| (low - relief.value(i, j)).max(0.0));
            if (1..=BESIDE as isize)
                .filter_map(step)
                .any(|(i, j)| taken(i, j))
            {
                contact += 1;
                continue;
            }
            falls.push((high - low, high_out - low_in));
            lows.push(low);
        }
    }
    let count = falls.len() + contact;
    if falls.is_empty() || 2 * count < sides || falls.len() * FREE < count {
        return None;
    }
    if beyond > SLOPE * falls.iter().map(|(fall, _)| fall).sum::<f64>() {
        return None;
    }
    let mut all: Vec<f64> = falls.iter().map(|(fall, _)| *fall).collect();
    let contrast = search::whole::quantile(&mut all, CONTRAST) - BIAS * relief.noise;
    if contrast <= LEAST * relief.noise {
        return None;
    }
    let half = HALF * contrast;
    let strength = |fall: f64| {
        let fall = fall - BIAS * relief.noise;
        if fall > 0.0 {
            ((1.0 + HALF) * fall / (fall + half)).min(1.0)
        } else {
            0.0
        }
    };
    let own = |(fall, rise): &(f64, f64)| {
        let (fall, rise) = (strength(*fall), strength(*rise));
        if fall > 0.3 {
            fall
        } else {
            fall.max(RISE * rise)
        }
    };
    let edge = (falls.iter().map(own).sum::<f64>() + CONTACT * contact as f64) / count as f64;
    let ground = search::whole::quantile(&mut lows, 0.5) + VOID * contrast;
    let is_void = |(y, x): &(usize, usize)| relief.value(*x, *y) < ground;
    let void = region.pixels().filter(is_void).count() as f64 / region.area as f64;
    let full = (1.0 - void) * (1.0 - void);
    let shape = full * ((region.solidity() - HOLLOW) / (CONVEX - HOLLOW)).clamp(0.0, 1.0);
    Some(Verdict {
        edge,
        sides: count,
        contrast,
        shape,
    })
}
