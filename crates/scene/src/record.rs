//! What a run leaves behind, and how it is written: JSON Lines and CSV, 17 digits.
//!
//! `docs/formats.md` shows both by example.

use std::fmt::Write as _;
use std::path::Path;

use glam::DVec2;
use serde::ser::SerializeMap as _;
use serde::{Serialize, Serializer};
use snake::{Energies, Outcome};

use crate::scene::Scene;
use crate::write::write_whole;
use crate::{Contour, Evidence, SceneError};

/// One moment of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Steps made.
    pub step: u64,
    /// Time.
    pub t: f64,
    /// The nodes.
    pub nodes: Vec<DVec2>,
    /// Their velocities, if kept.
    pub velocities: Option<Vec<DVec2>>,
    /// The energies, if kept.
    pub energies: Option<Energies>,
    /// Whose nodes `nodes` are: the number of the first snake that is there.
    pub first: usize,
    /// The other curves of a crowd.
    pub others: Vec<Curve>,
}

/// One of several curves at one moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// The snake's number.
    pub id: usize,
    /// Whether it is closed.
    pub closed: bool,
    /// The nodes.
    pub nodes: Vec<DVec2>,
    /// Their velocities, if kept.
    pub velocities: Option<Vec<DVec2>>,
}

/// A snake's number, its nodes, and their velocities if kept.
type Drawn<'a> = (usize, &'a [DVec2], Option<&'a [DVec2]>);

impl Frame {
    /// Every curve there is.
    pub fn curves(&self) -> impl Iterator<Item = Drawn<'_>> {
        let first = (self.first, &self.nodes[..], self.velocities.as_deref());
        let others = self.others.iter();
        let others = others.map(|curve| (curve.id, &curve.nodes[..], curve.velocities.as_deref()));
        std::iter::once(first).chain(others)
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

/// The first line of a record in JSON Lines.
#[derive(Serialize)]
struct Header<'a> {
    snake_record: u32,
    scene: &'a str,
    title: &'a str,
    scheme: &'a str,
    dt: f64,
    closed: bool,
    nodes: usize,
}

#[derive(Serialize)]
struct Line<'a> {
    step: u64,
    t: f64,
    x: Vec<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    v: Option<Vec<[f64; 2]>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    energy: Option<EnergyLine<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    others: Vec<CurveLine>,
}

/// One of the other curves of a crowd.
#[derive(Serialize)]
struct CurveLine {
    id: usize,
    closed: bool,
    x: Vec<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    v: Option<Vec<[f64; 2]>>,
}

/// Energies under their names, and their sum.
struct EnergyLine<'a> {
    names: &'a [String],
    energies: &'a Energies,
}

impl Serialize for EnergyLine<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        for (name, value) in self.names.iter().zip(self.energies.values()) {
            map.serialize_entry(name, &value)?;
        }
        map.serialize_entry("total", &self.energies.total())?;
        map.end()
    }
}

#[derive(Serialize)]
struct Footer<'a> {
    outcome: &'static str,
    step: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    node: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    at: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "<[String]>::is_empty")]
    events: &'a [String],
}

/// What else than energies a line has a name for, in either format.
pub(crate) const COLUMNS: [&str; 16] = [
    "step", "t", "node", "x", "y", "vx", "vy", "v", "energy", "others", "total", "curve", "image",
    "outcome", "events", "at",
];

/// The version of both formats.
const VERSION: u32 = 1;

impl Record {
    pub(crate) fn of(scene: &Scene) -> Self {
        Self {
            scene: scene.name.clone(),
            title: scene.title.clone(),
            scheme: scene.plan.scheme.to_string(),
            dt: scene.plan.dt,
            closed: matches!(scene.snake.body().topology, elastic::Topology::Closed),
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

    /// Every curve of a moment as a contour, in the order of their numbers.
    #[must_use]
    pub fn contours(&self, frame: &Frame) -> Vec<Contour> {
        let first = Contour {
            closed: Some(self.closed),
            points: frame.nodes.clone(),
        };
        let others = frame.others.iter().map(|curve| Contour {
            closed: Some(curve.closed),
            points: curve.nodes.clone(),
        });
        // a crowd of which none is left has no curve
        let all = std::iter::once(first).chain(others);
        all.filter(|curve| !curve.points.is_empty()).collect()
    }

    /// The record as JSON Lines: a header, one line a kept moment, the outcome.
    ///
    /// # Errors
    ///
    /// None in practice: a number that is not finite is written as null.
    pub fn to_json_lines(&self) -> Result<String, SceneError> {
        let pairs = |list: &[DVec2]| list.iter().map(|p| p.to_array()).collect();
        let mut text = String::new();
        let mut push = |line: Result<String, serde_json::Error>| match line {
            Ok(line) => {
                text.push_str(&line);
                text.push('\n');
                Ok(())
            }
            Err(error) => Err(SceneError::key("record", error)),
        };
        push(serde_json::to_string(&Header {
            snake_record: VERSION,
            scene: &self.scene,
            title: &self.title,
            scheme: &self.scheme,
            dt: self.dt,
            closed: self.closed,
            nodes: self.frames.first().map_or(0, |f| f.nodes.len()),
        }))?;
        for frame in &self.frames {
            push(serde_json::to_string(&Line {
                step: frame.step,
                t: frame.t,
                x: pairs(&frame.nodes),
                v: frame.velocities.as_deref().map(pairs),
                energy: frame.energies.as_ref().map(|energies| EnergyLine {
                    names: &self.terms,
                    energies,
                }),
                others: frame
                    .others
                    .iter()
                    .map(|curve| CurveLine {
                        id: curve.id,
                        closed: curve.closed,
                        x: pairs(&curve.nodes),
                        v: curve.velocities.as_deref().map(pairs),
                    })
                    .collect(),
            }))?;
        }
        let (node, at) = match self.outcome {
            Outcome::Diverged { node, .. } => (Some(node), None),
            Outcome::LeftField { node, at, .. } => (Some(node), Some(at.to_array())),
            _ => (None, None),
        };
        push(serde_json::to_string(&Footer {
            outcome: self.outcome.name(),
            step: self.outcome.step(),
            node,
            at,
            events: &self.events,
        }))?;
        Ok(text)
    }

    /// The record as CSV: one line a node and kept moment, energies (and their sum, `total`) repeated
    /// on each of its lines.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let velocities = self.frames.iter().any(|f| f.velocities.is_some());
        let energies = self.frames.iter().any(|f| f.energies.is_some());
        let closed = if self.closed { "closed" } else { "open" };
        let mut text = format!(
            "# record {VERSION}, {closed}, {}, dt {:?}, {}\nstep,t,node,x,y",
            self.scheme, self.dt, self.outcome
        );
        if velocities {
            text.push_str(",vx,vy");
        }
        if energies {
            for name in &self.terms {
                let _ = write!(text, ",{name}");
            }
            text.push_str(",total");
        }
        let crowd = self.frames.iter().any(|frame| !frame.others.is_empty());
        text.push_str(if crowd { ",curve\n" } else { "\n" });
        for frame in &self.frames {
            for (id, nodes, velocities) in frame.curves() {
                for (i, p) in nodes.iter().enumerate() {
                    let _ = write!(text, "{},{:?},{i},{:?},{:?}", frame.step, frame.t, p.x, p.y);
                    if let Some(v) = velocities {
                        let _ = write!(text, ",{:?},{:?}", v[i].x, v[i].y);
                    }
                    if let Some(e) = &frame.energies {
                        for value in e.values().into_iter().chain([e.total()]) {
                            let _ = write!(text, ",{value:?}");
                        }
                    }
                    if crowd {
                        let _ = write!(text, ",{id}");
                    }
                    text.push('\n');
                }
            }
        }
        text
    }

    /// Write the record, whole or not at all: CSV if the name ends in `.csv`, else JSON Lines.
    ///
    /// # Errors
    ///
    /// A folder that is not there or cannot be written.
    pub fn save(&self, path: &Path) -> Result<(), SceneError> {
        if path
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("csv"))
        {
            write_whole(path, self.to_csv().as_bytes())
        } else {
            write_whole(path, self.to_json_lines()?.as_bytes())
        }
    }
}
