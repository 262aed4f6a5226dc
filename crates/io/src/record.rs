//! What a run leaves behind, and how it is written: JSON Lines and CSV, 17 digits.
//!
//! `docs/formats.md` shows both by example.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::path::Path;

use glam::DVec2;
use serde::ser::SerializeMap as _;
use serde::{Serialize, Serializer};

use crate::IoError;
use crate::write::write_whole;

/// A run as it is written: what was run, the moments kept, how it ended.
///
/// The curves of a moment may be those of the run itself, so that nothing is copied to be written.
#[derive(Debug, Clone, PartialEq)]
pub struct Record<'a> {
    /// The scene's name.
    pub scene: String,
    /// The scene's title.
    pub title: String,
    /// The scheme, with its parameter if it has one.
    pub scheme: String,
    /// The step.
    pub dt: f64,
    /// Whether the first curve is closed.
    pub closed: bool,
    /// What the energies of a moment are called, in their order.
    pub terms: Vec<String>,
    /// The moments kept: the start, those asked for, the end.
    pub frames: Vec<Frame<'a>>,
    /// What happened to curves on the way, in words.
    pub events: Vec<String>,
    /// How it ended.
    pub ending: Ending,
}

/// One moment of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame<'a> {
    /// Steps made.
    pub step: u64,
    /// Time.
    pub t: f64,
    /// Every curve there is, in the order of their numbers.
    pub curves: Cow<'a, [Curve]>,
    /// The energies, if kept.
    pub energies: Option<Energies>,
}

/// One curve at one moment.
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

/// The energies of a moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Energies {
    /// One value for each of [`Record::terms`].
    pub values: Vec<f64>,
    /// Their sum, as the run found it.
    pub total: f64,
}

/// How a run ended.
#[derive(Debug, Clone, PartialEq)]
pub struct Ending {
    /// One word.
    pub word: String,
    /// The same in a sentence.
    pub sentence: String,
    /// Steps made.
    pub step: u64,
    /// The node that ended it, if one did.
    pub node: Option<usize>,
    /// Where that node was, if anywhere.
    pub at: Option<DVec2>,
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

/// One of the curves after the first.
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
        for (name, value) in self.names.iter().zip(&self.energies.values) {
            map.serialize_entry(name, value)?;
        }
        map.serialize_entry("total", &self.energies.total)?;
        map.end()
    }
}

#[derive(Serialize)]
struct Footer<'a> {
    outcome: &'a str,
    step: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    node: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    at: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "<[String]>::is_empty")]
    events: &'a [String],
}

/// What else than energies a line has a name for, in either format.
pub const COLUMNS: [&str; 16] = [
    "step", "t", "node", "x", "y", "vx", "vy", "v", "energy", "others", "total", "curve", "image",
    "outcome", "events", "at",
];

/// The version of both formats.
const VERSION: u32 = 1;

fn pairs(list: &[DVec2]) -> Vec<[f64; 2]> {
    list.iter().map(|p| p.to_array()).collect()
}

fn velocities(curve: &Curve) -> Option<Vec<[f64; 2]>> {
    curve.velocities.as_deref().map(pairs)
}

impl Record<'_> {
    /// The record as JSON Lines: a header, one line a kept moment, the outcome.
    ///
    /// # Errors
    ///
    /// None in practice: a number that is not finite is written as null.
    pub fn to_json_lines(&self) -> Result<String, IoError> {
        let mut text = String::new();
        let mut push = |line: Result<String, serde_json::Error>| match line {
            Ok(line) => {
                text.push_str(&line);
                text.push('\n');
                Ok(())
            }
            Err(error) => Err(IoError::Format {
                format: "record",
                message: error.to_string(),
            }),
        };
        let first = self.frames.first().and_then(|frame| frame.curves.first());
        push(serde_json::to_string(&Header {
            snake_record: VERSION,
            scene: &self.scene,
            title: &self.title,
            scheme: &self.scheme,
            dt: self.dt,
            closed: self.closed,
            nodes: first.map_or(0, |curve| curve.nodes.len()),
        }))?;
        for frame in &self.frames {
            let mut curves = frame.curves.iter();
            let first = curves.next();
            push(serde_json::to_string(&Line {
                step: frame.step,
                t: frame.t,
                x: first.map_or_else(Vec::new, |curve| pairs(&curve.nodes)),
                v: first.and_then(velocities),
                energy: frame.energies.as_ref().map(|energies| EnergyLine {
                    names: &self.terms,
                    energies,
                }),
                others: curves
                    .map(|curve| CurveLine {
                        id: curve.id,
                        closed: curve.closed,
                        x: pairs(&curve.nodes),
                        v: velocities(curve),
                    })
                    .collect(),
            }))?;
        }
        push(serde_json::to_string(&Footer {
            outcome: &self.ending.word,
            step: self.ending.step,
            node: self.ending.node,
            at: self.ending.at.map(|at| at.to_array()),
            events: &self.events,
        }))?;
        Ok(text)
    }

    /// The record as CSV: one line a node and kept moment, energies (and their sum, `total`)
    /// repeated on each of its lines.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let mut frames = self.frames.iter();
        let moving = |frame: &Frame<'_>| {
            let first = frame.curves.first();
            first.is_some_and(|curve| curve.velocities.is_some())
        };
        let velocities = frames.clone().any(moving);
        let energies = frames.clone().any(|frame| frame.energies.is_some());
        let several = frames.any(|frame| frame.curves.len() > 1);
        let closed = if self.closed { "closed" } else { "open" };
        let mut text = format!(
            "# record {VERSION}, {closed}, {}, dt {:?}, {}\nstep,t,node,x,y",
            self.scheme, self.dt, self.ending.sentence
        );
        if velocities {
            text.push_str(",vx,vy");
        }
        if energies {
            for name in &self.terms {
                // writing to a String cannot fail
                let _ = write!(text, ",{name}");
            }
            text.push_str(",total");
        }
        text.push_str(if several { ",curve\n" } else { "\n" });
        for frame in &self.frames {
            for curve in frame.curves.iter() {
                for (i, p) in curve.nodes.iter().enumerate() {
                    let _ = write!(text, "{},{:?},{i},{:?},{:?}", frame.step, frame.t, p.x, p.y);
                    if let Some(v) = &curve.velocities {
                        let _ = write!(text, ",{:?},{:?}", v[i].x, v[i].y);
                    }
                    if let Some(e) = &frame.energies {
                        for value in e.values.iter().chain([&e.total]) {
                            let _ = write!(text, ",{value:?}");
                        }
                    }
                    if several {
                        let _ = write!(text, ",{}", curve.id);
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
    pub fn save(&self, path: &Path) -> Result<(), IoError> {
        let csv = path
            .extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
        if csv {
            write_whole(path, self.to_csv().as_bytes())
        } else {
            write_whole(path, self.to_json_lines()?.as_bytes())
        }
    }
}
