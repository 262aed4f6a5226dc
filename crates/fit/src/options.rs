//! How to fit: every choice with its unit, and a default for each.

use std::fmt;
use std::sync::Arc;

use elastic::ElasticError;
use field::Polarity;
use glam::DVec2;
use snake::Acting;

use crate::force::{Computing, ImageForceKind, PULL, Sight};
use crate::limits::{MOST_NODES, MOST_STEPS};
use crate::{FitError, OptionKey, Problem};

/// How to fit a contour to an image. The default suits objects of some ten to thousands of pixels, drawn
/// roughly around, along or inside their outline.
///
/// L is a pixel, T a unit of time, M a unit of mass; strengths are relative to the image's
/// contrast.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// How the outline is found. What follows after `search` is of a motion only.
    pub method: Method,
    /// How the searches go.
    pub search: search::Rules,
    /// How many nodes the curve has.
    pub nodes: Nodes,
    /// ω₀: how hard each node is held to its place in the start's shape. M T⁻².
    pub tether: f64,
    /// ω₁: how hard the curve resists stretching out of the start's shape. M L² T⁻².
    pub tension: f64,
    /// ω₂: how hard the curve resists bending out of the start's shape. M L⁴ T⁻².
    pub rigidity: f64,
    /// γ, the damping; μ, the mass, is 1. M T⁻¹. Places of rest do not depend on it; which of them
    /// is found may, and without any damping none is.
    pub damping: f64,
    /// σ of the Gaussian that smooths the image for the edge force. L. The force reaches about
    /// three times that.
    pub sigma: f64,
    /// Pull of an edge as high as the image's contrast, relative to that of an edge of 120 grey
    /// levels under the report's rules.
    pub strength: f64,
    /// Forces to pull with instead of that edge force; none for it alone.
    pub forces: Vec<FitForce>,
    /// Which edges attract, going outwards: of that edge force, and of every chosen one that does
    /// not say.
    pub polarity: Polarity,
    /// Pressure inside the curve, in pulls of that edge force at strength 1: above 0 it grows,
    /// below 0 it shrinks; 0.1 is much.
    pub balloon: f64,
    /// Whether the edge force is computed where the curve goes, or as a whole.
    pub computing: Computing,
    /// How long the steps are.
    pub step: Step,
    /// Steps at most.
    pub steps: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            method: Method::Search,
            search: search::Rules::default(),
            nodes: Nodes::Auto,
            tether: 0.0,
            tension: 20.0,
            rigidity: 100.0,
            damping: 2.0,
            sigma: 10.0_f64.sqrt(),
            strength: 1.0,
            forces: Vec::new(),
            polarity: Polarity::Either,
            balloon: 0.0,
            computing: Computing::Auto,
            step: Step::Chosen,
            steps: 40_000,
        }
    }
}

impl Options {
    /// Refuse numbers that make no sense whatever the image and the start.
    pub(crate) fn check(&self) -> Result<(), FitError> {
        for (key, value) in [
            (OptionKey::Tether, self.tether),
            (OptionKey::Tension, self.tension),
            (OptionKey::Rigidity, self.rigidity),
            (OptionKey::Damping, self.damping),
        ] {
            Problem::at_least_zero(value).map_err(|problem| FitError::new(key, problem))?;
        }
        for (key, value) in [
            (OptionKey::Strength, self.strength),
            (OptionKey::Sigma, self.sigma),
        ] {
            Problem::above_zero(value).map_err(|problem| FitError::new(key, problem))?;
        }
        self.check_search()?;
        if let Nodes::Every(spacing) = self.nodes {
            let checked = Problem::above_zero(spacing);
            checked.map_err(|problem| FitError::new(OptionKey::Nodes, problem))?;
        }
        if !(PULL * self.balloon).is_finite() {
            let (needed, got) = ("finite", self.balloon);
            return Err(FitError::new(
                OptionKey::Balloon,
                Problem::Number { needed, got },
            ));
        }
        if let Step::Equal(dt) = self.step {
            Problem::above_zero(dt).map_err(|problem| FitError::new(OptionKey::Step, problem))?;
        }
        if self.steps > MOST_STEPS {
            let problem = Problem::Count {
                least: 0,
                most: MOST_STEPS,
                got: self.steps,
            };
            return Err(FitError::new(OptionKey::Steps, problem));
        }
        Ok(())
    }
}

impl Options {
    /// The options of a motion from the start, all others as usual.
    #[must_use]
    pub fn motion() -> Self {
        let method = Method::Motion;
        Self {
            method,
            ..Self::default()
        }
    }

    fn check_search(&self) -> Result<(), FitError> {
        let rules = &self.search;
        for (name, value) in [
            ("tether", rules.tether),
            ("region", rules.region),
            ("inward", rules.inward),
            ("outward", rules.outward),
            ("outer", rules.outer),
            ("sure", rules.sure),
            ("unsure", rules.unsure),
            ("pure", rules.pure),
        ] {
            Problem::at_least_zero(value)
                .map_err(|problem| FitError::new(OptionKey::Search(name), problem))?;
        }
        let within = [
            ("inward", rules.inward, 0.9),
            ("outward", rules.outward, 2.0),
            ("around", rules.around, 8.0),
        ];
        for (name, got, most) in within {
            if !(0.0..=most).contains(&got) {
                let needed = if most < 1.0 {
                    "from 0 to 0.9"
                } else if most < 3.0 {
                    "from 0 to 2"
                } else {
                    "from 0 to 8"
                };
                return Err(FitError::new(
                    OptionKey::Search(name),
                    Problem::Number { needed, got },
                ));
            }
        }
        Ok(())
    }
}

/// How an outline is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// The best curve of all about the start, by searches; then the sub-pixel stage along its normals. Fast, and
    /// hardly depends on where the start is.
    #[default]
    Search,
    /// The curve moves from the start under the image's forces and its own until it comes to rest.
    Motion,
}

/// How many nodes a curve has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Nodes {
    /// One a pixel of an outline found by a search, one for each four pixels of the start of a motion; at least 24 and
    /// 16, at most 6000 and 4000.
    Auto,
    /// So many.
    Count(usize),
    /// One for each so many pixels of the start; 16 at least and 4000 at most. L.
    Every(f64),
}

impl Nodes {
    /// The number for a start of that length.
    #[must_use]
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to a small positive range first"
    )]
    pub fn along(self, length: f64) -> usize {
        match self {
            Self::Count(count) => count,
            Self::Auto => Self::Every(4.0).along(length),
            Self::Every(spacing) => (length / spacing).clamp(16.0, 4000.0).round() as usize,
        }
    }

    /// Refuse a number of nodes that no outline can have.
    pub(crate) fn check(self, closed: bool) -> Result<(), FitError> {
        let Self::Count(got) = self else {
            return Ok(());
        };
        let needed = if closed { 5 } else { 3 };
        if got < needed {
            let error = ElasticError::TooFewNodes { needed, got };
            return Err(FitError::new(OptionKey::Nodes, error));
        }
        if got > MOST_NODES {
            let (least, most, got) = (needed as u64, MOST_NODES as u64, got as u64);
            let problem = Problem::Count { least, most, got };
            return Err(FitError::new(OptionKey::Nodes, problem));
        }
        Ok(())
    }
}

/// How long the steps of a fit are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// As short as the image's detail asks for on the way, and longer and longer as the forces die:
    /// the shortest way to rest ([`integrator::Relaxation`]). With forces of one's own, half of the
    /// largest step of leapfrog, and at most 0.2 T.
    Chosen,
    /// All of this length, below the largest that is stable anywhere in the image: the motion in
    /// time. T.
    Equal(f64),
}

/// A force to pull with.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum FitForce {
    /// A force of the image.
    Image {
        /// Which.
        kind: ImageForceKind,
        /// What it is multiplied by; at least 0.
        weight: f64,
    },
    /// Any other, made for the curve.
    Made(Arc<dyn MakeForce>),
}

impl FitForce {
    /// A force of the image as it is.
    #[must_use]
    pub const fn of(kind: ImageForceKind) -> Self {
        let weight = 1.0;
        Self::Image { kind, weight }
    }
}

impl PartialEq for FitForce {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (
                Self::Image { kind, weight },
                Self::Image {
                    kind: other_kind,
                    weight: other_weight,
                },
            ) => kind == other_kind && weight.total_cmp(other_weight).is_eq(),
            (Self::Made(made), Self::Made(other)) => Arc::ptr_eq(made, other),
            _ => false,
        }
    }
}

/// Makes a force once the curve is known.
pub trait MakeForce: fmt::Debug + Send + Sync {
    /// The forces on a curve of these nodes, of an image seen like this.
    ///
    /// # Errors
    ///
    /// What is wrong with the force, in words.
    fn make(&self, sight: &Sight, nodes: &[DVec2], closed: bool) -> Result<Vec<Acting>, String>;
}
