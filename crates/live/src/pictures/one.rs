//! An outline, and what is known of it.

use std::collections::BTreeSet;

use glam::DVec2;
use instances::Object;
use scene::fit::{Choices, Evidence, Fit};

/// An outline in a picture.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct One {
    pub label: String,
    pub class: String,
    /// Its nodes. Pixels.
    pub points: Vec<DVec2>,
    pub closed: bool,
    /// Edge at each node against the strongest; as long as `points`, or empty where nothing was measured.
    pub strength: Vec<f64>,
    /// Standard error of each node along its normal, where it was measured. Pixels.
    pub error: Vec<Option<f64>>,
    /// Nodes that stay where they are.
    pub pins: BTreeSet<usize>,
    /// Whether the picture speaks for it as a whole.
    pub sure: bool,
    /// How it ended, in a sentence.
    pub words: String,
    /// What was measured and chosen, line by line.
    pub explained: String,
    /// Where it began. Pixels.
    pub start: Vec<DVec2>,
    /// Curves that were found and not taken. Pixels.
    pub candidates: Vec<Vec<DVec2>>,
}

impl One {
    /// What a search has found.
    pub(super) fn found(fit: &Fit, start: &[DVec2]) -> Self {
        let objection = fit.quality.as_ref().and_then(Evidence::objection);
        let held = fit.quality.as_ref().map_or(0.0, |quality| quality.held);
        let words = match &objection {
            Some(objection) => objection.to_string(),
            None => format!(
                "found: {:.0} % of the outline lies on an edge",
                100.0 * held
            ),
        };
        let candidates = match &fit.chosen {
            Choices::Search(searched) => {
                let curves = searched.curves.iter().enumerate();
                let left = curves.filter(|(index, _)| searched.taken != Some(*index));
                left.map(|(_, curve)| curve.clone()).collect()
            }
            _ => Vec::new(),
        };
        Self {
            points: fit.contour.points.clone(),
            closed: fit.contour.closed,
            strength: fit.nodes.iter().map(|node| node.strength).collect(),
            error: fit.nodes.iter().map(|node| node.error).collect(),
            sure: fit.is_outline(),
            words,
            explained: fit.chosen.to_string(),
            start: start.to_vec(),
            candidates,
            ..Self::default()
        }
    }

    /// One of all objects of a picture; `unsure` is the edge that it needs.
    pub(super) fn among(object: Object, middle: DVec2, unsure: f64) -> Self {
        let closed = object.support.closed;
        let sure = closed >= unsure;
        let words = if sure {
            format!(
                "found: four fifths of the outline have an edge of {closed:.2} of the strongest"
            )
        } else {
            format!(
                "four fifths of the outline have an edge of {closed:.2} of the strongest, needed: {unsure:.2}"
            )
        };
        Self {
            points: object.outline,
            closed: true,
            sure,
            words,
            start: vec![middle],
            ..Self::default()
        }
    }

    /// A curve that is taken as it is.
    pub(super) fn as_given(points: Vec<DVec2>, closed: bool) -> Self {
        Self {
            start: points.clone(),
            points,
            closed,
            sure: true,
            words: "taken as it was given".to_owned(),
            ..Self::default()
        }
    }

    /// The mean standard error of its nodes, where any was measured. Pixels.
    pub(super) fn mean_error(&self) -> Option<f64> {
        let known: Vec<f64> = self.error.iter().flatten().copied().collect();
        (!known.is_empty()).then(|| known.iter().sum::<f64>() / known.len() as f64)
    }

    /// What was measured of a node, taken from those of another curve where it was nearest.
    pub(super) fn measured_as(&mut self, other: &Self) {
        let n = other.points.len();
        if other.strength.len() != n || n == 0 {
            return;
        }
        let near = |p: &DVec2| {
            let away = |i: &usize| other.points[*i].distance_squared(*p);
            (0..n)
                .min_by(|a, b| away(a).total_cmp(&away(b)))
                .unwrap_or(0)
        };
        let nearest: Vec<usize> = self.points.iter().map(near).collect();
        self.strength = nearest.iter().map(|i| other.strength[*i]).collect();
        self.error = nearest
            .iter()
            .map(|i| other.error.get(*i).copied().flatten())
            .collect();
    }
}
