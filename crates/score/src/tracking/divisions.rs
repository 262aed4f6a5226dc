//! Whether divisions are found, and when.

use std::collections::BTreeMap;

use super::overlaps::Overlaps;

/// A division may be found so many frames too early or too late.
pub(super) const TOLERANCE: usize = 1;

/// With what a true object was matched in a frame, if that matched no other.
type Seen = (usize, Option<u32>);

/// What is known of a true object at its ends.
#[derive(Debug, Default)]
struct Ends {
    first: Vec<Seen>,
    last: Vec<Seen>,
}

/// What is needed of all objects.
#[derive(Debug, Default)]
pub(super) struct Divisions {
    truth: BTreeMap<u32, Ends>,
    found: BTreeMap<u32, (usize, usize)>,
}

/// One division: the parent's last frame, and the children with their first frames.
struct Division {
    parent: u32,
    end: usize,
    children: Vec<(u32, usize)>,
}

impl Divisions {
    pub(super) fn add(&mut self, frame: usize, overlaps: &Overlaps) {
        let covering = overlaps.covering();
        for &object in overlaps.truth.keys() {
            let found = covering.get(&object).map(|pair| pair.0);
            let alone =
                |found: &u32| covering.values().filter(|pair| pair.0 == *found).count() == 1;
            let seen = (frame, found.filter(alone));
            let ends = self.truth.entry(object).or_default();
            if ends.first.len() <= TOLERANCE {
                ends.first.push(seen);
            }
            if ends.last.len() > TOLERANCE {
                ends.last.remove(0);
            }
            ends.last.push(seen);
        }
        for &object in overlaps.found.keys() {
            self.found.entry(object).or_insert((frame, frame)).1 = frame;
        }
    }

    /// Divisions that were found, that were found where there is none, and that were missed.
    ///
    /// A division is an object of several children. It is found by one of as many children, if the two parents end,
    /// and the children begin, within one frame of each other, and match: the parents in the last frame in which both
    /// are, each child with one of the true children in the first frame in which both are (the branching correctness of
    /// `[ulman17]` with a tolerance of 1).
    pub(super) fn finish(
        &self,
        found_parents: &BTreeMap<u32, u32>,
        true_parents: &BTreeMap<u32, u32>,
    ) -> [u64; 3] {
        let life = |ends: &Ends| Some((ends.first.first()?.0, ends.last.last()?.0));
        let truth = self
            .truth
            .iter()
            .filter_map(|(id, ends)| Some((*id, life(ends)?)));
        let truth = divisions(true_parents, &truth.collect());
        let found = divisions(found_parents, &self.found);
        let mut right = 0;
        let mut taken = vec![false; found.len()];
        for division in &truth {
            let same = |at: &usize| !taken[*at] && self.same(division, &found[*at]);
            if let Some(at) = (0..found.len()).find(same) {
                taken[at] = true;
                right += 1;
            }
        }
        let (all, known) = (found.len() as u64, truth.len() as u64);
        [right, all - right, known - right]
    }

    fn same(&self, truth: &Division, found: &Division) -> bool {
        let near = |a: usize, b: usize| a.abs_diff(b) <= TOLERANCE;
        if truth.children.len() != found.children.len() || !near(truth.end, found.end) {
            return false;
        }
        let at = |seen: &[Seen], frame: usize, object: u32| seen.contains(&(frame, Some(object)));
        let Some(parent) = self.truth.get(&truth.parent) else {
            return false;
        };
        if !at(&parent.last, truth.end.min(found.end), found.parent) {
            return false;
        }
        let mut taken = Vec::new();
        for (child, begin) in &truth.children {
            let matched = found.children.iter().find(|(other, start)| {
                let ends = self.truth.get(child);
                let frame = *begin.max(start);
                near(*begin, *start) && ends.is_some_and(|ends| at(&ends.first, frame, *other))
            });
            match matched {
                Some((other, _)) if !taken.contains(other) => taken.push(*other),
                _ => return false,
            }
        }
        true
    }
}

/// Objects with more than one child.
fn divisions(parents: &BTreeMap<u32, u32>, lives: &BTreeMap<u32, (usize, usize)>) -> Vec<Division> {
    let mut children: BTreeMap<u32, Vec<(u32, usize)>> = BTreeMap::new();
    for (child, parent) in parents {
        if let Some((begin, _)) = lives.get(child) {
            children.entry(*parent).or_default().push((*child, *begin));
        }
    }
    let several = children
        .into_iter()
        .filter(|(_, children)| children.len() > 1);
    let division = |(parent, children): (u32, Vec<(u32, usize)>)| {
        let end = lives.get(&parent)?.1;
        Some(Division {
            parent,
            end,
            children,
        })
    };
    several.filter_map(division).collect()
}
