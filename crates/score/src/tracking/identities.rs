//! Whether objects keep their identities.

use std::collections::BTreeMap;

use ndarray::Array2;

use super::assignment::assignment;
use super::overlaps::Overlaps;
use crate::ScoreError;

/// In how many frames each true object is matched with each one found.
#[derive(Debug, Default)]
pub(super) struct Identities {
    frames: BTreeMap<(u32, u32), u64>,
    /// Objects times frames, found and true.
    pub(super) found: u64,
    pub(super) truth: u64,
    /// What each true object was matched with before.
    last: BTreeMap<u32, u32>,
    pub(super) switches: u64,
}

impl Identities {
    pub(super) fn add(&mut self, overlaps: &Overlaps) {
        self.found += overlaps.found.len() as u64;
        self.truth += overlaps.truth.len() as u64;
        for (truth, found) in overlaps.matches() {
            *self.frames.entry((truth, found)).or_default() += 1;
            let before = self.last.insert(truth, found);
            self.switches += u64::from(before.is_some_and(|before| before != found));
        }
    }

    /// Most frames that are matched if every true object is one object found, and no other is.
    pub(super) fn kept(&self) -> Result<u64, ScoreError> {
        let number = |of: &dyn Fn(&(u32, u32)) -> u32| {
            let mut all: Vec<u32> = self.frames.keys().map(of).collect();
            all.sort_unstable();
            all.dedup();
            all
        };
        let (rows, columns) = (number(&|pair| pair.0), number(&|pair| pair.1));
        let frames = |i: usize, j: usize| {
            self.frames
                .get(&(rows[i], columns[j]))
                .copied()
                .unwrap_or(0)
        };
        let costs =
            Array2::from_shape_fn((rows.len(), columns.len()), |(i, j)| -(frames(i, j) as f64));
        let best = assignment(&costs)?;
        let kept = best
            .iter()
            .enumerate()
            .filter_map(|(i, j)| j.map(|j| frames(i, j)));
        Ok(kept.sum())
    }
}
