//! From old nodes to new ones: where each new node comes from, as a few weights.
//!
//! Two sets of weights, since two things are asked. What is *drawn* (positions, velocities, the rest shape)
//! follows a curve between the nodes, with weights that add up to one. What is *poured* (densities, stiffness,
//! anything that must stay between its bounds) takes convex weights, and stays between its neighbours.

use crate::OutlineError;
use crate::cut::{Origin, Source};
use crate::error::{check_length, check_points};
use glam::DVec2;

/// A few old nodes and their weights, for every new node.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Weights {
    ends: Vec<u32>,
    terms: Vec<(u32, f64)>,
}

impl Weights {
    #[allow(
        clippy::cast_possible_truncation,
        reason = "four terms a node, counted at the door"
    )]
    pub(crate) fn push(&mut self, terms: &[(u32, f64)]) {
        let used = terms.iter().filter(|(_, weight)| weight.abs() > 0.0);
        self.terms.extend(used);
        self.ends.push(self.terms.len() as u32);
    }

    fn of(&self, i: usize) -> &[(u32, f64)] {
        let start = if i == 0 { 0 } else { self.ends[i - 1] as usize };
        &self.terms[start..self.ends[i] as usize]
    }
}

/// How values are handed from old nodes to new ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    pub(crate) old: usize,
    pub(crate) drawn: Weights,
    pub(crate) poured: Weights,
    pub(crate) inserted: usize,
    pub(crate) removed: usize,
}

impl Plan {
    pub(crate) fn new(old: usize) -> Self {
        let (drawn, poured) = (Weights::default(), Weights::default());
        Self {
            old,
            drawn,
            poured,
            inserted: 0,
            removed: 0,
        }
    }

    /// Weights of the origins of a piece.
    pub(crate) fn from_origins(origins: &[Origin], counts: &[usize]) -> Result<Self, OutlineError> {
        let mut plan = Self::new(counts.iter().sum());
        let first = |curve: usize| counts[..curve].iter().sum::<usize>();
        let ends = |source: Source| {
            let Source { curve, spot } = source;
            let needed = counts.get(curve).copied().unwrap_or(0);
            if spot.edge >= needed {
                return Err(OutlineError::WrongLength {
                    name: "the old curve",
                    needed: spot.edge + 1,
                    got: needed,
                });
            }
            let [from, to] = [spot.edge, (spot.edge + 1) % needed].map(|i| place(first(curve) + i));
            Ok([(from, 1.0 - spot.along), (to, spot.along)])
        };
        for origin in origins {
            if origin.is_cut() {
                let ([a, b], [c, d]) = (ends(origin.arrives)?, ends(origin.leaves)?);
                plan.push_both(&[a, b, c, d].map(|(i, weight)| (i, 0.5 * weight)));
            } else {
                plan.push_both(&ends(origin.arrives)?);
            }
        }
        Ok(plan)
    }

    pub(crate) fn push_both(&mut self, terms: &[(u32, f64)]) {
        self.drawn.push(terms);
        self.poured.push(terms);
    }

    /// How many new nodes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.drawn.ends.len()
    }

    /// Whether there is no new node.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.drawn.ends.is_empty()
    }

    /// How many old nodes.
    #[must_use]
    pub fn old_len(&self) -> usize {
        self.old
    }

    /// How many new nodes stand where no old one did.
    #[must_use]
    pub fn inserted(&self) -> usize {
        self.inserted
    }

    /// How many old nodes are gone.
    #[must_use]
    pub fn removed(&self) -> usize {
        self.removed
    }

    /// Whether everything stays as it is.
    #[must_use]
    pub fn is_identity(&self) -> bool {
        let same = |i: usize| matches!(self.drawn.of(i), [(k, _)] if *k as usize == i);
        self.len() == self.old && (0..self.old).all(same)
    }

    /// The old nodes a new one takes its poured values from, with convex weights: positive, adding up to 1.
    #[must_use]
    pub fn convex(&self, node: usize) -> &[(u32, f64)] {
        self.poured.of(node)
    }

    /// The old nodes a new one is drawn from: at most four, with weights that add up to 1.
    ///
    /// Some are negative if a cubic was asked for; the sum of their sizes is at most 1.5.
    #[must_use]
    pub fn stencil(&self, node: usize) -> &[(u32, f64)] {
        self.drawn.of(node)
    }

    /// New positions, velocities or rest shape: what is drawn.
    ///
    /// A shift of all points shifts the result, whatever the rounding of the weights.
    ///
    /// # Errors
    /// Not one point an old node; points that are not finite.
    pub fn draw(&self, points: &[DVec2]) -> Result<Vec<DVec2>, OutlineError> {
        check_length("the points", self.old, points.len())?;
        check_points("point", points)?;
        let node = |i: usize| match self.drawn.of(i) {
            [] => DVec2::ZERO,
            [(first, _), rest @ ..] => {
                let base = points[*first as usize];
                rest.iter()
                    .fold(base, |sum, &(k, w)| sum + w * (points[k as usize] - base))
            }
        };
        Ok((0..self.len()).map(node).collect())
    }

    /// New values of a profile: what is poured. Each lies between the old ones it is made of.
    ///
    /// # Errors
    /// Not one value an old node; values that are not finite.
    pub fn pour(&self, values: &[f64]) -> Result<Vec<f64>, OutlineError> {
        check_length("the values", self.old, values.len())?;
        if let Some(&value) = values.iter().find(|value| !value.is_finite()) {
            return Err(OutlineError::BadNumber {
                name: "a value",
                bound: "finite",
                value,
            });
        }
        let node = |i: usize| match self.poured.of(i) {
            [] => 0.0,
            [(first, _), rest @ ..] => {
                let base = values[*first as usize];
                rest.iter()
                    .fold(base, |sum, &(k, w)| sum + w * (values[k as usize] - base))
            }
        };
        Ok((0..self.len()).map(node).collect())
    }
}

/// A node's index as it is kept.
#[allow(clippy::cast_possible_truncation, reason = "the door counts the nodes")]
pub(crate) fn place(node: usize) -> u32 {
    node as u32
}
