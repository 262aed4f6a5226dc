//! What the objects of two images of labels have in common.

use std::collections::BTreeMap;

use ndarray::Array2;

use crate::ScoreError;
use crate::mask::same_size;

/// Pixels of each object, and of each pair of a true object and one that was found.
#[derive(Debug, Default)]
pub(super) struct Overlaps {
    pub(super) found: BTreeMap<u32, u64>,
    pub(super) truth: BTreeMap<u32, u64>,
    both: BTreeMap<(u32, u32), u64>,
}

impl Overlaps {
    /// Count them; 0 is no object. O(pixels + changes log objects).
    pub(super) fn of(found: &Array2<u32>, truth: &Array2<u32>) -> Result<Self, ScoreError> {
        same_size(found.dim(), truth.dim())?;
        let mut counts: BTreeMap<(u32, u32), u64> = BTreeMap::new();
        let (mut pair, mut run) = ((0, 0), 0);
        for (&a, &b) in truth.iter().zip(found) {
            if (a, b) != pair {
                *counts.entry(pair).or_default() += run;
                (pair, run) = ((a, b), 0);
            }
            run += 1;
        }
        *counts.entry(pair).or_default() += run;
        let mut overlaps = Self::default();
        for (&(a, b), &count) in counts.iter().filter(|(_, count)| **count > 0) {
            if a > 0 {
                *overlaps.truth.entry(a).or_default() += count;
            }
            if b > 0 {
                *overlaps.found.entry(b).or_default() += count;
            }
            if a > 0 && b > 0 {
                overlaps.both.insert((a, b), count);
            }
        }
        Ok(overlaps)
    }

    /// For each true object the one found that covers more than half of it, if any, and their intersection over union.
    pub(super) fn covering(&self) -> BTreeMap<u32, (u32, f64)> {
        let covers = |&(&(a, _), &both): &(&(u32, u32), &u64)| 2 * both > self.truth[&a];
        let pair = |(&(a, b), &both): (&(u32, u32), &u64)| (a, (b, self.iou(a, b, both)));
        self.both.iter().filter(covers).map(pair).collect()
    }

    /// Pairs with an intersection over union above one half: none shares an object with another.
    pub(super) fn matches(&self) -> Vec<(u32, u32)> {
        let union = |(a, b): (u32, u32), both: u64| self.truth[&a] + self.found[&b] - both;
        let half = |&(&pair, &both): &(&(u32, u32), &u64)| 2 * both > union(pair, both);
        self.both
            .iter()
            .filter(half)
            .map(|(pair, _)| *pair)
            .collect()
    }

    fn iou(&self, truth: u32, found: u32, both: u64) -> f64 {
        both as f64 / (self.truth[&truth] + self.found[&found] - both) as f64
    }
}
