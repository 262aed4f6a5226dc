//! What a fit has found, how sure it is, and what was chosen on the way.

use std::fmt;

use glam::DVec2;
use snake::Outcome;

use crate::{Contour, Evidence, Searched};

/// An outline that has been found, and what there is to know of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// The nodes, in the order of the start.
    pub contour: Contour,
    /// What the image says at each node; empty where the curve has blown up.
    pub nodes: Vec<NodeEvidence>,
    /// What speaks for the outline as a whole; None unless it came to rest.
    pub quality: Option<Evidence>,
    /// How it ended: a curve that does not come to rest, or blows up, is an outcome and no error.
    pub outcome: Outcome,
    /// Steps made, or rounds of the last stage of a search.
    pub steps: u64,
    /// What was chosen, and why.
    pub chosen: Choices,
}

impl Fit {
    /// Whether it came to rest as an outline to which nothing objects.
    #[must_use]
    pub fn is_outline(&self) -> bool {
        let objection = self.quality.as_ref().and_then(Evidence::objection);
        matches!(self.outcome, Outcome::Settled { .. }) && objection.is_none()
    }
}

/// What the image says at a node.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct NodeEvidence {
    /// Unit normal of the curve; of a closed one it points outwards.
    pub normal: DVec2,
    /// Slope of the smoothed image along the normal, at the node: above 0 where it is brighter
    /// outside. Levels per pixel.
    pub slope: f64,
    /// The size of that slope against the steepest of an edge as high as the image's contrast.
    pub strength: f64,
    /// How far along the normal the forces of the image balance: where the edge is, to a fraction
    /// of a pixel; None if nowhere near. Pixels.
    pub offset: Option<f64>,
    /// Whether the image pulls the node back when it is moved along the normal.
    pub held: bool,
    /// Standard error of the node along the normal, from the image's noise; None where no edge could be measured, and
    /// of a motion. Pixels.
    pub error: Option<f64>,
}

/// What was chosen for a fit, and why: in plain words when it is displayed.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Choices {
    /// Of a search.
    Search(Searched),
    /// Of a motion.
    Motion(Moved),
}

impl fmt::Display for Choices {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Search(search) => search.fmt(f),
            Self::Motion(motion) => motion.fmt(f),
        }
    }
}

/// What was chosen for a motion, and why.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Moved {
    /// Spread of the image's levels from the 2nd to the 98th percentile.
    pub contrast: f64,
    /// Number of nodes.
    pub nodes: usize,
    /// Their distance at the start. Pixels.
    pub spacing: f64,
    /// Gain of the edge force; None where other forces were chosen.
    pub gain: Option<f64>,
    /// The scheme that moves the curve.
    pub scheme: &'static str,
    /// The first step. T.
    pub step: f64,
    /// Why it is as long as it is.
    pub why: StepReason,
}

/// Why a step is as long as it is.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum StepReason {
    /// It grows on the way to rest: no node moves farther in a step than so many pixels.
    Grows {
        /// The longest way of a node in a step. Pixels.
        reach: f64,
    },
    /// It was asked for.
    Asked,
    /// Half of the largest that is stable. T.
    HalfOf {
        /// The largest stable step. T.
        limit: f64,
    },
    /// The longest that is taken where a force may jump.
    MayJump,
}

impl fmt::Display for Moved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "contrast: {:.1} levels, from the 2nd to the 98th percentile",
            self.contrast
        )?;
        writeln!(
            f,
            "nodes: {}, every {:.2} pixels of the start",
            self.nodes, self.spacing
        )?;
        match self.gain {
            Some(gain) => writeln!(
                f,
                "edge force: gain {gain:.4}, so that an edge as high as the contrast pulls with the strength asked for"
            )?,
            None => writeln!(f, "forces: those that were chosen")?,
        }
        write!(f, "scheme: {}, ", self.scheme)?;
        match self.why {
            StepReason::Grows { reach } => write!(
                f,
                "in steps that grow, none of which moves a node farther than {reach:.2} pixels"
            ),
            StepReason::Asked => write!(f, "in steps of {}, as asked for", self.step),
            StepReason::HalfOf { limit } => write!(
                f,
                "in steps of {:.4}, half of the largest stable one, {limit:.4}",
                self.step
            ),
            StepReason::MayJump => write!(
                f,
                "in steps of {}, the longest that is taken where forces may jump",
                self.step
            ),
        }
    }
}
