//! Regions of a grid that may be objects: components above a level, and parts of them.

use ndarray::Array2;

use crate::judge::{Verdict, judge};
use crate::region::Region;
use crate::relief::Relief;
use crate::tree::{Branch, Stage, Terrain, Tree, beside};

/// Objects are looked for in a grid up to this radius in its pixels; in the coarsest, of any size. A component may be
/// so many times as large.
const RADIUS: f64 = 40.0;
const CLUSTER: f64 = 6.0;

/// The least area, in pixels of the finest grid and of others.
const SMALLEST: usize = 20;
const SMALL: usize = 1250;

/// Peaks count that rise above the level where they meet others by so many standard deviations of noise, and by this
/// share of their height above the ground.
const NOISE: f64 = 4.0;
const RISE: f64 = 0.03;

/// A component whose border is longer than this, squared and against its area, is none. 20 for a disk.
const WINDING: f64 = 200.0;

/// A component of more peaks than this is looked at where it is so many times as large as those in it.
const MANY: u32 = 16;
const GROWN: f64 = 1.2;

/// So many components around one are looked at.
const NESTED: usize = 32;

/// Depths within a region count as two where they exceed the neck between them by this share and so many pixels.
const NECK: f64 = 0.1;
const DEEPER: f64 = 0.7;

/// What is thinner than this share of the greatest depth may be no part of an object.
const OPENED: f64 = 0.4;

/// One part in so many of a region must be taken by others before its rest is looked at.
const LEFT: usize = 8;

/// A region that is as convex as this is not divided by its depths.
const CONVEX: f64 = 0.97;

/// Depths are stored in this share of a pixel.
const FRACTION: f64 = 64.0;

/// A region that may be an object.
#[derive(Debug, Clone)]
pub(crate) struct Proposal {
    pub region: Region,
    pub verdict: Verdict,
}

/// What looks for regions in one grid.
struct Search<'a> {
    relief: &'a Relief,
    values: Vec<u16>,
    width: usize,
    least: usize,
    most: f64,
    /// In which round each pixel was reached last.
    reached: Vec<u32>,
    round: u32,
    out: Vec<Proposal>,
}

/// Regions of one grid that may be objects. `first` for the finest, `last` for the coarsest.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the range of the levels"
)]
pub(crate) fn propose(relief: &Relief, first: bool, last: bool) -> Vec<Proposal> {
    let width = relief.dim().1;
    let (values, step, ground) = relief.steps();
    let least = least(first);
    let rise = NOISE * relief.noise / step;
    let counts = |peak: u16, level: u16, _: usize| {
        f64::from(peak - level) >= rise.max(RISE * f64::from(peak.saturating_sub(ground)))
    };
    let terrain = Terrain {
        values: &values,
        width,
        floor: relief.floor(step),
    };
    let tree = Tree::of(terrain, least, counts);
    let mut search = Search::new(relief, least, last, values);
    // a fall along the border that noise alone may give
    let fall = 0.5 * NOISE * relief.noise / step;
    let most = CLUSTER * search.most;
    // the largest component that was looked at in each branch
    let mut looked = vec![0_usize; tree.branches.len()];
    for (at, branch) in tree.branches.iter().enumerate() {
        let fits = |stage: &&Stage| {
            stage.fall >= fall
                && stage.area as f64 <= most
                && (stage.sides * stage.sides) as f64 <= WINDING * stage.area as f64
        };
        let stages: Vec<Stage> = branch.stages.iter().filter(fits).copied().collect();
        let mut inner: Option<Region> = None;
        let many = branch.leaves.1 - branch.leaves.0 > MANY;
        for stage in &stages {
            // one more in a large cluster is nothing new
            if many && (stage.area as f64) < GROWN * looked[at] as f64 {
                continue;
            }
            looked[at] = looked[at].max(stage.area);
            let Some(region) = search.above(branch, stage.level, |_| true) else {
                continue;
            };
            // what surrounds a lighter one, or lies beside it
            if let Some(inner) = &inner {
                let near = |x: usize, y: usize| {
                    (x.saturating_sub(1)..=x + 1)
                        .any(|i| (y.saturating_sub(1)..=y + 1).any(|j| inner.holds(i, j)))
                };
                let rest = region.part(|x, y| !near(x, y), width);
                rest.into_iter().for_each(|rest| search.add(rest));
            }
            inner = Some(region.clone());
            search.divide(&region);
            search.add(region);
        }
        if let Some(parent) = branch.parent {
            looked[parent] = looked[parent].max(looked[at]);
        }
        // the level of a component around this one at which both have the steepest border
        let own = stages.iter().fold(0.0, |most: f64, one| most.max(one.fall));
        let mut best: Option<(f64, u16)> = None;
        let mut next = branch.parent;
        for _ in 0..NESTED {
            let Some(parent) = next else { break };
            let branch: &Branch = &tree.branches[parent];
            for stage in branch.stages.iter().filter(fits) {
                if stage.fall > best.map_or(own, |(fall, _)| fall) {
                    best = Some((stage.fall, stage.level));
                }
            }
            next = branch.parent;
        }
        if let Some((_, level)) = best
            && let Some(region) = search.above(branch, level, |q| tree.holds(at, q))
        {
            search.divide(&region);
            if let Some(region) = region.smoothed(width) {
                search.add(region);
            }
        }
    }
    search.out
}

/// What is left of regions without what others have taken: regions too that may be objects.
pub(crate) fn rests(
    relief: &Relief,
    last: bool,
    regions: &[&Region],
    taken: impl Fn(usize, usize) -> bool,
) -> Vec<Proposal> {
    let mut search = Search::new(relief, least(relief.times == 1), last, Vec::new());
    let width = search.width;
    let near = |x: usize, y: usize| {
        (x.saturating_sub(1)..=x + 1).any(|i| (y.saturating_sub(1)..=y + 1).any(|j| taken(i, j)))
    };
    for region in regions {
        let count = region.pixels().filter(|&(y, x)| taken(x, y)).count();
        if count * LEFT < region.area || region.area < count + search.least {
            continue;
        }
        let rest = region.part(|x, y| !near(x, y), width);
        if let Some(rest) = rest.and_then(|rest| rest.smoothed(width)) {
            search.divide(&rest);
            search.add_beside(rest, &taken);
        }
    }
    search.out
}

/// The least area of objects in a grid, the finest or another.
const fn least(first: bool) -> usize {
    if first { SMALLEST } else { SMALL }
}

impl<'a> Search<'a> {
    fn new(relief: &'a Relief, least: usize, last: bool, values: Vec<u16>) -> Self {
        let (height, width) = relief.dim();
        let half = 0.4 * width.min(height) as f64;
        let radius = if last { half } else { RADIUS.min(half) };
        Self {
            relief,
            reached: vec![0; values.len()],
            round: 0,
            values,
            width,
            least,
            most: std::f64::consts::PI * radius * radius,
            out: Vec::new(),
        }
    }

    /// The pixels around a branch's peak that are not below a level and meet a condition.
    fn above(
        &mut self,
        branch: &Branch,
        level: u16,
        keep: impl Fn(usize) -> bool,
    ) -> Option<Region> {
        let count = self.values.len();
        self.round += 1;
        let mut found = vec![branch.peak];
        self.reached[branch.peak] = self.round;
        let mut next = 0;
        while let Some(&at) = found.get(next) {
            next += 1;
            for q in beside(at, self.width, count) {
                if self.values[q] >= level && self.reached[q] != self.round && keep(q) {
                    self.reached[q] = self.round;
                    found.push(q);
                }
            }
        }
        Region::of(&found, self.width)
    }

    fn add(&mut self, region: Region) {
        self.add_beside(region, |_, _| false);
    }

    /// Add a region if it may be an object beside what is taken by others.
    fn add_beside(&mut self, region: Region, taken: impl Fn(usize, usize) -> bool) {
        if region.area < self.least || region.area as f64 > self.most {
            return;
        }
        if let Some(verdict) = judge(self.relief, &region, taken) {
            self.out.push(Proposal { region, verdict });
        }
    }

    /// The parts of a region whose middles are deeper in it than the necks between them; with its holes filled, and as
    /// it is.
    fn divide(&mut self, region: &Region) {
        if region.area < 2 * self.least || region.solidity() > CONVEX && region.bare.is_none() {
            return;
        }
        self.divided(region, &region.bits);
        if let Some(bare) = &region.bare {
            self.divided(region, bare);
        }
    }

    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "depths are those of a region of few pixels"
    )]
    fn divided(&mut self, region: &Region, bits: &Array2<bool>) {
        let (height, width) = region.bits.dim();
        // a rim of one pixel around it, but none beyond the border of the picture
        let (rows, columns) = self.relief.dim();
        let (top, left) = (region.top.min(1), region.left.min(1));
        let bottom = usize::from(region.top + height < rows);
        let right = usize::from(region.left + width < columns);
        let dim = (height + top + bottom, width + left + right);
        let mut outside = Array2::from_elem(dim, true);
        for ((y, x), _) in bits.indexed_iter().filter(|(_, bit)| **bit) {
            outside[[y + top, x + left]] = false;
        }
        let depth = field::squared_distance(&outside);
        let values: Vec<u16> = depth
            .iter()
            .map(|d| (FRACTION * d.sqrt()).round().min(65_000.0) as u16)
            .collect();
        let terrain = Terrain {
            values: &values,
            width: dim.1,
            floor: 1,
        };
        let counts = |peak: u16, level: u16, _: usize| {
            let (peak, level) = (f64::from(peak), f64::from(level));
            peak - level >= (NECK * peak).max(DEEPER * FRACTION)
        };
        let tree = Tree::of(terrain, self.least / 2, counts);
        // without what is thin
        let most = depth.iter().fold(0.0, |most: f64, d| most.max(*d)).sqrt();
        let thin = OPENED * most;
        let core = depth.mapv(|d| d > thin * thin);
        let near = field::squared_distance(&core);
        let keep = |x: usize, y: usize| {
            near[[y + top - region.top, x + left - region.left]] < (thin + 0.5) * (thin + 0.5)
        };
        let part = region.part(keep, self.width);
        let part = part.filter(|part| part.area < region.area);
        part.into_iter().for_each(|part| self.add(part));
        if tree.branches.len() < 2 {
            return;
        }
        // each part from its deepest place, so that what a part costs is its own size
        let mut reached = vec![usize::MAX; values.len()];
        for (number, branch) in tree.branches.iter().enumerate() {
            if branch.parent.is_none() {
                continue;
            }
            let mut found = vec![branch.peak];
            reached[branch.peak] = number;
            let mut next = 0;
            while let Some(&at) = found.get(next) {
                next += 1;
                for q in beside(at, dim.1, values.len()) {
                    if reached[q] != number && tree.holds(number, q) {
                        reached[q] = number;
                        found.push(q);
                    }
                }
            }
            if found.len() as f64 > self.most {
                continue;
            }
            for at in &mut found {
                let (y, x) = (*at / dim.1, *at % dim.1);
                *at = (y + region.top - top) * self.width + x + region.left - left;
            }
            let part = Region::of(&found, self.width);
            let part = part.and_then(|part| part.smoothed(self.width));
            part.into_iter().for_each(|part| self.add(part));
        }
    }
}
