//! What an experiment is.

use crate::draw::{Animation, Figure};
use crate::{Record, SandboxError};

/// What a claim turned out to be.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// The numbers it was judged by, in words.
    pub measured: String,
    /// Whether it holds.
    pub holds: bool,
}

impl Finding {
    /// A finding.
    pub fn new(holds: bool, measured: impl Into<String>) -> Self {
        Self {
            measured: measured.into(),
            holds,
        }
    }
}

/// Something that must be seen in the figure.
#[derive(Debug, Clone, Copy)]
pub struct Claim {
    /// In words.
    pub says: &'static str,
    /// Who says so: a place in the report, or a slip by its number.
    pub source: &'static str,
    /// Reads the record and judges.
    pub judge: fn(&Record) -> Result<Finding, SandboxError>,
}

/// A drawing before it is bytes.
#[derive(Debug, Clone)]
pub enum Body {
    /// Becomes an SVG file.
    Figure(Figure),
    /// Becomes a GIF file.
    Animation(Animation),
}

/// A drawing, its place among those of the same experiment, and what it shows.
#[derive(Debug, Clone)]
pub struct Artefact {
    /// Follows the experiment's id in the file name; empty for the main figure.
    pub suffix: &'static str,
    /// One line under it.
    pub caption: &'static str,
    /// The drawing.
    pub body: Body,
}

impl Artefact {
    /// The main figure.
    #[must_use]
    pub fn figure(caption: &'static str, figure: Figure) -> Self {
        Self {
            suffix: "",
            caption,
            body: Body::Figure(figure),
        }
    }

    /// A further drawing.
    #[must_use]
    pub fn further(suffix: &'static str, caption: &'static str, body: Body) -> Self {
        Self {
            suffix,
            caption,
            body,
        }
    }
}

/// A question with a picture.
#[derive(Debug, Clone, Copy)]
pub struct Experiment {
    /// Names its files and its flag: `fig-4-1`.
    pub id: &'static str,
    /// A few words.
    pub title: &'static str,
    /// Where it stands in the report: `Figure 4.1`, `§3.4.2`.
    pub place: &'static str,
    /// What is asked, in a sentence or two.
    pub question: &'static str,
    /// What must be seen.
    pub claims: &'static [Claim],
    /// Computes; draws nothing.
    pub run: fn() -> Result<Record, SandboxError>,
    /// Draws; computes nothing.
    pub draw: fn(&Record) -> Result<Vec<Artefact>, SandboxError>,
}
