//! What a run leaves behind.

use std::borrow::Cow;

use glam::DVec2;
pub(crate) use io::record::COLUMNS;
use io::record::{self as file, Curve, Ending};
use io::shapes::{Shape, Shapes};
use snake::{Energies, Outcome};

use crate::Evidence;
use crate::scene::Scene;

/// One moment of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Steps made.
    pub step: u64,
    /// Time.
    pub t: f64,
    /// Every curve there is, in the order of their numbers.
    pub curves: Vec<Curve>,
    /// The energies, if kept.
    pub energies: Option<Energies>,
}

impl Frame {
    /// The nodes of the first curve; none where no curve is left.
    #[must_use]
    pub fn nodes(&self) -> &[DVec2] {
        self.curves.first().map_or(&[], |curve| &curve.nodes)
    }

    /// The velocities of the first curve, if kept.
    #[must_use]
    pub fn velocities(&self) -> Option<&[DVec2]> {
        self.curves.first()?.velocities.as_deref()
    }

    /// Every curve as an outline, in the order of their numbers.
    #[must_use]
    pub fn shapes(&self) -> Shapes {
        let curves = self.curves.iter();
        curves
            .map(|curve| Shape::curve(curve.nodes.clone(), Some(curve.closed)))
            .collect()
    }
}

/// A run as it was: what was run, the moments kept, how it ended.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// The scene's name.
    pub scene: String,
    /// The scene's title.
    pub title: String,
    /// The scheme, with its parameter if it has one.
    pub scheme: String,
    /// The step.
    pub dt: f64,
    /// Whether the curve is closed.
    pub closed: bool,
    /// What the energies are called, in the order of [`Energies::values`].
    pub terms: Vec<String>,
    /// The moments kept: the start, those asked for, the end.
    pub frames: Vec<Frame>,
    /// What happened to curves on the way, in words.
    pub events: Vec<String>,
    /// How it ended.
    pub outcome: Outcome,
    /// What speaks for the curves that came to rest in a picture, one after the other; for people, in no file.
    pub evidence: Vec<Evidence>,
    /// What people should know of the run; for people, in no file.
    pub remarks: Vec<String>,
    /// What became of chosen sub-steps, and why they were no longer; for people, in no file.
    pub pace: Option<String>,
}

impl Record {
    pub(crate) fn of(scene: &Scene) -> Self {
        Self {
            scene: scene.name.clone(),
            title: scene.title.clone(),
            scheme: scene.plan.scheme.to_string(),
            dt: scene.plan.dt,
            closed: scene.snake.body().topology.is_closed(),
            terms: Energies::names(&scene.snake),
            frames: Vec::new(),
            events: Vec::new(),
            outcome: Outcome::Finished { step: 0 },
            evidence: Vec::new(),
            remarks: scene.remarks(),
            pace: None,
        }
    }

    /// The last moment kept; the start when nothing else was.
    #[must_use]
    pub fn last(&self) -> Option<&Frame> {
        self.frames.last()
    }

    /// The record as it is written.
    #[must_use]
    pub fn written(&self) -> file::Record<'_> {
        let (node, at) = match self.outcome {
            Outcome::Diverged { node, .. } => (Some(node), None),
            Outcome::LeftField { node, at, .. } => (Some(node), Some(at)),
            _ => (None, None),
        };
        let energies = |energies: &Energies| file::Energies {
            values: energies.values(),
            total: energies.total(),
        };
        let frames = self.frames.iter().map(|frame| file::Frame {
            step: frame.step,
            t: frame.t,
            curves: Cow::Borrowed(&frame.curves),
            energies: frame.energies.as_ref().map(energies),
        });
        file::Record {
            scene: self.scene.clone(),
            title: self.title.clone(),
            scheme: self.scheme.clone(),
            dt: self.dt,
            closed: self.closed,
            terms: self.terms.clone(),
            frames: frames.collect(),
            events: self.events.clone(),
            ending: Ending {
                word: self.outcome.name().to_owned(),
                sentence: self.outcome.to_string(),
                step: self.outcome.step(),
                node,
                at,
            },
        }
    }
}
