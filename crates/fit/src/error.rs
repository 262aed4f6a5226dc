//! What can be wrong with an image, a start or an option: which one, what is needed, what was
//! given.

use std::fmt;

use elastic::ElasticError;
use field::FieldError;
use integrator::SchemeError;
use snake::SnakeError;

/// Why there is no fit: the option or input concerned, and what is wrong with it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{key}: {problem}")]
pub struct FitError {
    /// What it is about.
    pub key: OptionKey,
    /// What is needed, and what was given.
    pub problem: Problem,
}

impl FitError {
    pub(crate) fn new(key: OptionKey, problem: impl Into<Problem>) -> Self {
        let problem = problem.into();
        Self { key, problem }
    }
}

/// An input or an option of a fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum OptionKey {
    /// The image.
    Image,
    /// The contour to start from.
    Start,
    /// [`Options::nodes`](crate::Options::nodes).
    Nodes,
    /// [`Options::tether`](crate::Options::tether).
    Tether,
    /// [`Options::tension`](crate::Options::tension).
    Tension,
    /// [`Options::rigidity`](crate::Options::rigidity).
    Rigidity,
    /// [`Options::damping`](crate::Options::damping).
    Damping,
    /// [`Options::sigma`](crate::Options::sigma).
    Sigma,
    /// [`Options::strength`](crate::Options::strength).
    Strength,
    /// [`Options::computing`](crate::Options::computing).
    Computing,
    /// [`Options::balloon`](crate::Options::balloon).
    Balloon,
    /// [`Options::step`](crate::Options::step).
    Step,
    /// [`Options::steps`](crate::Options::steps).
    Steps,
    /// A rule of [`Options::search`](crate::Options::search), by its name.
    Search(&'static str),
    /// The spring of [`Edit::Pull`](crate::Edit::Pull).
    Pull,
    /// [`Pluck::kick`](crate::Pluck::kick).
    Kick,
    /// A force of [`Options::forces`](crate::Options::forces), by its index, and which value of it.
    Force(usize, ForceKey),
}

impl fmt::Display for OptionKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let word = match self {
            Self::Image => "image",
            Self::Start => "start",
            Self::Nodes => "nodes",
            Self::Tether => "tether",
            Self::Tension => "tension",
            Self::Rigidity => "rigidity",
            Self::Damping => "damping",
            Self::Sigma => "sigma",
            Self::Strength => "strength",
            Self::Computing => "computing",
            Self::Balloon => "balloon",
            Self::Step => "step",
            Self::Steps => "steps",
            Self::Search(name) => name,
            Self::Pull => "pull",
            Self::Kick => "kick",
            Self::Force(index, ForceKey::All) => return write!(f, "force {index}"),
            Self::Force(index, key) => return write!(f, "force {index}, {}", key.word()),
        };
        f.write_str(word)
    }
}

/// A value of a force of the image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ForceKey {
    /// The force as a whole.
    All,
    /// Which kind it is.
    Kind,
    /// Its weight.
    Weight,
    /// `sigma` of the kinds that have one.
    Sigma,
    /// `sigmas` of the kinds with several scales.
    Sigmas,
    /// `strength`.
    Strength,
    /// `hold` of a schedule from coarse to fine.
    Hold,
    /// `blur` of the same.
    Blur,
    /// `floor` of terminations.
    Floor,
    /// `threshold` of an edge map.
    Threshold,
    /// `reach`.
    Reach,
    /// μ of a plain vector flow.
    Smoothness,
    /// κ of a generalized vector flow.
    Spread,
    /// `knee` of flows and convolutions.
    Knee,
    /// The exponent of a convolution.
    Exponent,
    /// The width of a Gaussian convolution.
    Width,
    /// `radius` of local regions.
    Radius,
    /// `classes` of likelihoods and textures.
    Classes,
    /// `bandwidth` of histograms.
    Bandwidth,
    /// `components` of mixtures.
    Components,
}

impl ForceKey {
    /// The word for it.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::All => "force",
            Self::Kind => "kind",
            Self::Weight => "weight",
            Self::Sigma => "sigma",
            Self::Sigmas => "sigmas",
            Self::Strength => "strength",
            Self::Hold => "hold",
            Self::Blur => "blur",
            Self::Floor => "floor",
            Self::Threshold => "threshold",
            Self::Reach => "reach",
            Self::Smoothness => "smoothness",
            Self::Spread => "spread",
            Self::Knee => "knee",
            Self::Exponent => "exponent",
            Self::Width => "width",
            Self::Radius => "radius",
            Self::Classes => "classes",
            Self::Bandwidth => "bandwidth",
            Self::Components => "components",
        }
    }
}

/// What is wrong with a force of the image.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}: {problem}", key.word())]
pub struct ForceError {
    /// Which value of it.
    pub key: ForceKey,
    /// What is needed, and what was given.
    pub problem: Problem,
}

impl ForceError {
    pub(crate) fn new(key: ForceKey, problem: impl Into<Problem>) -> Self {
        let problem = problem.into();
        Self { key, problem }
    }
}

/// What is needed, and what was given.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    /// A number out of its range, or no number.
    #[error("must be {needed}, got {got}")]
    Number {
        /// The range, in words.
        needed: &'static str,
        /// The number given.
        got: f64,
    },
    /// Too many of something, or too few.
    #[error("must be {}, got {got}", bound(*least, *most, *got))]
    Count {
        /// The least that is possible.
        least: u64,
        /// The most that is possible.
        most: u64,
        /// What was given.
        got: u64,
    },
    /// A point of the start that is not in the image.
    #[error(
        "point {index} at ({x:.2}, {y:.2}) is outside the picture of {width}×{height} pixels; \
         a point must have x from 0 to {} and y from 0 to {}", width - 1, height - 1
    )]
    Outside {
        /// The first such point.
        index: usize,
        /// Where it is.
        x: f64,
        /// Where it is.
        y: f64,
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// A step that is too long.
    #[error(
        "a step of {got} is too large: must be at most {most}, the largest stable step in this picture"
    )]
    Unstable {
        /// The largest stable step.
        most: f64,
        /// The step given.
        got: f64,
    },
    /// Something that only a closed contour has.
    #[error("asks what is inside; a closed contour is needed")]
    Open,
    /// Whatever `field` refuses.
    #[error("{0}")]
    Field(#[from] FieldError),
    /// Whatever `elastic` refuses.
    #[error("{0}")]
    Elastic(#[from] ElasticError),
    /// Whatever `snake` refuses.
    #[error("{0}")]
    Snake(#[from] SnakeError),
    /// Whatever `integrator` refuses.
    #[error("{0}")]
    Scheme(#[from] SchemeError),
    /// Anything else, in words.
    #[error("{0}")]
    Other(String),
}

/// The bound that was passed from below with the other one, or the one passed from above, in words.
fn bound(least: u64, most: u64, got: u64) -> String {
    if got > most {
        format!("at most {most}")
    } else if most == u64::MAX {
        format!("at least {least}")
    } else {
        format!("{least} to {most}")
    }
}

impl Problem {
    pub(crate) fn above_zero(value: f64) -> Result<f64, Self> {
        if value.is_finite() && value > 0.0 {
            return Ok(value);
        }
        let needed = "finite and above 0";
        Err(Self::Number { needed, got: value })
    }

    pub(crate) fn at_least_zero(value: f64) -> Result<f64, Self> {
        if value.is_finite() && value >= 0.0 {
            return Ok(value);
        }
        let needed = "finite and at least 0";
        Err(Self::Number { needed, got: value })
    }
}
