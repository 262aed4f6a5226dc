//! Many objects followed through a sequence, as images of labels.

use std::collections::BTreeMap;

use ndarray::Array2;

use super::divisions::Divisions;
use super::graph::{Graph, GraphErrors};
use super::identities::Identities;
use super::overlaps::Overlaps;
use crate::ScoreError;

/// The life of an object, as a line of the tables of the Cell Tracking Challenge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Lineage {
    /// Its number in the images of labels.
    pub label: u32,
    /// The first frame in which it is.
    pub begin: usize,
    /// The last frame in which it is.
    pub end: usize,
    /// The number of its parent; 0 if it has none.
    pub parent: u32,
}

/// How well many objects were followed, fed frame by frame.
///
/// It keeps what it needs of each object and each pair that ever matched, nothing of single frames.
#[derive(Debug, Default)]
pub struct Tracks {
    frames: usize,
    overlap: f64,
    graph: Graph,
    identities: Identities,
    divisions: Divisions,
}

/// How well many objects were followed. None where there is nothing to take a mean of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackScores {
    /// How many frames there are.
    pub frames: usize,
    /// SEG: the mean over true objects and frames of the intersection over union with the object that covers more than
    /// half of it, 0 if none does `[maska14]`.
    pub seg: Option<f64>,
    /// DET ([`GraphErrors::det`]).
    pub det: Option<f64>,
    /// TRA ([`GraphErrors::tra`]).
    pub tra: Option<f64>,
    /// The edits that the two are made of.
    pub errors: GraphErrors,
    /// IDF1: twice the objects in frames that keep their identity over all, true and found, in the best one-to-one
    /// match of identities `[ristani16]`. An object matches in a frame if the intersection over union is above 1/2.
    pub idf1: Option<f64>,
    /// How often a true object is matched with another one than before `[bernardin08]`.
    pub switches: u64,
    /// Divisions found, found where there is none, and missed; within one frame.
    pub divisions: [u64; 3],
}

impl TrackScores {
    /// The F1 of divisions; None if there is none, true or found.
    #[must_use]
    pub fn division_f1(&self) -> Option<f64> {
        let [right, wrong, missed] = self.divisions;
        let all = 2 * right + wrong + missed;
        (all > 0).then(|| 2.0 * right as f64 / all as f64)
    }
}

impl Tracks {
    /// The next frame: labels found and true labels, 0 outside of objects. O(pixels + objects log objects).
    ///
    /// # Errors
    ///
    /// Images of different sizes.
    pub fn add(&mut self, found: &Array2<u32>, truth: &Array2<u32>) -> Result<(), ScoreError> {
        let overlaps = Overlaps::of(found, truth)?;
        self.overlap += overlaps.covering().values().map(|pair| pair.1).sum::<f64>();
        self.graph.add(self.frames, &overlaps);
        self.identities.add(&overlaps);
        self.divisions.add(self.frames, &overlaps);
        self.frames += 1;
        Ok(())
    }

    /// The scores, with the lives of all objects found and of all true objects. An empty table says that none has a
    /// parent. O(pairs that matched + objects³ of those that did).
    ///
    /// # Errors
    ///
    /// A table that does not fit the labels: an object twice or missing, other frames, a parent that is not there or
    /// does not end before its child begins.
    pub fn finish(self, found: &[Lineage], truth: &[Lineage]) -> Result<TrackScores, ScoreError> {
        let [found_lives, true_lives] = self.graph.lives();
        let found = parents("found", found, &found_lives)?;
        let truth = parents("true", truth, &true_lives)?;
        let divisions = self.divisions.finish(&found, &truth);
        let errors = self.graph.finish(&found, &truth);
        let kept = self.identities.kept()?;
        let all = self.identities.found + self.identities.truth;
        let nodes = errors.nodes;
        Ok(TrackScores {
            frames: self.frames,
            seg: (nodes > 0).then(|| self.overlap / nodes as f64),
            det: errors.det(),
            tra: errors.tra(),
            errors,
            idf1: (all > 0).then(|| 2.0 * kept as f64 / all as f64),
            switches: self.identities.switches,
            divisions,
        })
    }
}

/// The parents of those objects that have one, if a table fits what was seen.
fn parents(
    whose: &'static str,
    table: &[Lineage],
    lives: &BTreeMap<u32, (usize, usize)>,
) -> Result<BTreeMap<u32, u32>, ScoreError> {
    let refuse = |label: u32, message: String| ScoreError::Lineage {
        whose,
        label,
        message,
    };
    let mut parents = BTreeMap::new();
    let mut lines = BTreeMap::new();
    for line in table {
        let Lineage {
            label, begin, end, ..
        } = *line;
        match lives.get(&label) {
            Some(&life) if life == (begin, end) => {}
            Some((first, last)) => {
                let message = format!(
                    "is in the frames {first} to {last}, but the table has {begin} to {end}"
                );
                return Err(refuse(label, message));
            }
            None => {
                let message = "is in the table, but in no frame".to_owned();
                return Err(refuse(label, message));
            }
        }
        if lines.insert(label, *line).is_some() {
            return Err(refuse(label, "is in the table twice".to_owned()));
        }
    }
    if let Some(label) = lives.keys().find(|label| !lines.contains_key(label))
        && !table.is_empty()
    {
        return Err(refuse(
            *label,
            "is in a frame, but not in the table".to_owned(),
        ));
    }
    for line in table.iter().filter(|line| line.parent > 0) {
        let Lineage { label, parent, .. } = *line;
        let Some(before) = lines.get(&parent) else {
            let message = format!("has the parent {parent}, which is not in the table");
            return Err(refuse(label, message));
        };
        if before.end >= line.begin {
            let message = format!(
                "begins in frame {}; its parent {parent} must end before, got {}",
                line.begin, before.end
            );
            return Err(refuse(label, message));
        }
        parents.insert(label, parent);
    }
    Ok(parents)
}
