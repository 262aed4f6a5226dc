//! What was found in the frames: by the tracker, or as files say.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use glam::DVec2;
use io::tracks::{CtcFolder, TableFrames};
use ndarray::Array2;
use scene::SceneError;
use scene::fit::{Contour, Image};
use score::sequences::Event;
use score::tracking::{Lineage, labelled};
use track::{Happening, Options, State, Tracker};

use super::clips::Clip;
use super::source::{Lives, labels, lines};
use crate::commands::key;

/// What was found in a frame.
#[derive(Debug, Default)]
pub(super) struct FoundFrame {
    pub(super) outlines: Outlines,
    /// Their labels, where they were given as such.
    pub(super) labels: Option<Array2<u32>>,
    /// Whether all were said to be seen.
    pub(super) sure: bool,
}

/// Files of what was found: one for each sequence.
#[derive(Debug)]
pub(super) struct Given(BTreeMap<String, PathBuf>);

impl Given {
    /// A table or a folder of labels for the only sequence; or a folder that holds `NAME.csv`, `NAME` or `NAME_RES` for
    /// each.
    pub(super) fn of(path: &Path, clips: &[Clip]) -> Result<Self, SceneError> {
        let refuse = |message: String| key("--found", message);
        if !path.exists() {
            return Err(refuse(format!("{} is not there", path.display())));
        }
        let mut files = BTreeMap::new();
        for clip in clips {
            let ways = [
                path.join(format!("{}.csv", clip.name)),
                path.join(format!("{}_RES", clip.name)),
                path.join(&clip.name),
            ];
            let own = ways.into_iter().find(|way| way.exists());
            if let Some(own) = own.filter(|_| path.is_dir()) {
                files.insert(clip.name.clone(), own);
            } else if clips.len() == 1 {
                files.insert(clip.name.clone(), path.to_owned());
            }
        }
        if files.is_empty() {
            let names: Vec<&str> = clips.iter().map(|clip| clip.name.as_str()).collect();
            let names = io::text::clip(&names.join(", "));
            return Err(refuse(format!(
                "{} must hold a NAME.csv of frame,id,x,y, or a folder NAME_RES of mask000.tif and res_track.txt, for a \
                 sequence of {names}",
                path.display()
            )));
        }
        Ok(Self(files))
    }
}

/// Objects and their outlines.
type Outlines = Vec<(u32, Vec<DVec2>)>;

/// What follows the objects.
pub(super) enum Follower {
    /// The tracker, or why it refused.
    Tracker {
        tracker: Result<Box<Tracker>, String>,
        parents: BTreeMap<u32, u32>,
        lives: Lives,
        events: Vec<(usize, Event)>,
    },
    /// A table of outlines, and the frame it has come to.
    Table {
        rows: Box<TableFrames>,
        waiting: Option<(usize, Outlines)>,
        lives: Lives,
    },
    /// A folder of labels.
    Labels(CtcFolder),
}

impl Follower {
    /// The tracker on a first frame.
    pub(super) fn tracker(first: &Image, starts: Vec<Vec<DVec2>>, options: &Options) -> Self {
        let starts: Vec<Contour> = starts.into_iter().map(Contour::closed).collect();
        let tracker = Tracker::new(first, &starts, options);
        Self::Tracker {
            tracker: tracker.map(Box::new).map_err(|error| error.to_string()),
            parents: BTreeMap::new(),
            lives: Lives::default(),
            events: Vec::new(),
        }
    }

    /// What it said that happened.
    pub(super) fn events(&self) -> &[(usize, Event)] {
        match self {
            Self::Tracker { events, .. } => events,
            _ => &[],
        }
    }

    /// What the files say of a sequence.
    pub(super) fn given(given: &Given, name: &str) -> Result<Self, String> {
        let Some(path) = given.0.get(name) else {
            return Err(format!("{name}: nothing was found of it"));
        };
        let told = |error: io::IoError| error.to_string();
        if path.is_dir() {
            return CtcFolder::open(path).map(Self::Labels).map_err(told);
        }
        let mut rows = Box::new(TableFrames::open(path).map_err(told)?);
        let waiting = next(&mut rows)?;
        Ok(Self::Table {
            rows,
            waiting,
            lives: Lives::default(),
        })
    }

    /// Why it refused, if it did.
    pub(super) fn refused(&self) -> Option<&str> {
        match self {
            Self::Tracker {
                tracker: Err(why), ..
            } => Some(why),
            _ => None,
        }
    }

    /// Whether it looks at pictures.
    pub(super) const fn looks(&self) -> bool {
        matches!(self, Self::Tracker { .. })
    }

    /// The next frame; with its picture if it [`looks`](Self::looks), but for the first. Frames come in order.
    pub(super) fn frame(&mut self, t: usize, image: Option<&Image>) -> Result<FoundFrame, String> {
        match self {
            Self::Tracker {
                tracker,
                parents,
                events,
                ..
            } => {
                let Ok(running) = tracker else {
                    return Ok(FoundFrame::default());
                };
                let tracked = match image {
                    None => Ok(running.first().clone()),
                    Some(image) => running.next(image),
                };
                let tracked = match tracked {
                    Ok(tracked) => tracked,
                    Err(error) => {
                        *tracker = Err(error.to_string());
                        return Ok(FoundFrame::default());
                    }
                };
                let seen = |one: &track::Outline| one.state == State::Seen;
                let sure = tracked.outlines.iter().all(seen);
                for one in &tracked.outlines {
                    parents.extend(one.parent.map(|parent| (one.id, parent)));
                }
                let told = |event: &track::Event| Some((t, happened(&event.what)?));
                events.extend(tracked.events.iter().filter_map(told));
                let outlines = tracked.outlines.into_iter().map(|one| (one.id, one.points));
                Ok(FoundFrame {
                    outlines: outlines.collect(),
                    labels: None,
                    sure,
                })
            }
            Self::Table { rows, waiting, .. } => {
                let mut found = FoundFrame {
                    sure: true,
                    ..FoundFrame::default()
                };
                if let Some((_, outlines)) = waiting.take_if(|(frame, _)| *frame == t) {
                    found.outlines = outlines;
                    *waiting = next(rows)?;
                }
                Ok(found)
            }
            Self::Labels(folder) => {
                let labels = labels(folder, t)?;
                Ok(FoundFrame {
                    outlines: Vec::new(),
                    labels: Some(labels),
                    sure: true,
                })
            }
        }
    }

    /// Refuse frames of a table that the sequence does not have.
    pub(super) fn check_end(&self, frames: usize) -> Result<(), String> {
        match self {
            Self::Table {
                waiting: Some((frame, _)),
                ..
            } => Err(format!(
                "what was found has a frame {frame}, but frames must be 0 to {}, one after the other",
                frames.saturating_sub(1)
            )),
            _ => Ok(()),
        }
    }

    /// A frame as labels.
    pub(super) fn labels(
        &mut self,
        t: usize,
        found: FoundFrame,
        size: (usize, usize),
    ) -> Array2<u32> {
        if let Some(labels) = found.labels {
            return labels;
        }
        let labels = labelled(&found.outlines, size);
        if let Self::Tracker { lives, .. } | Self::Table { lives, .. } = self {
            lives.add(t, &labels);
        }
        labels
    }

    /// The lives of the objects found.
    pub(super) fn lineages(&self) -> Vec<Lineage> {
        match self {
            Self::Tracker { lives, parents, .. } => lives.lineages(|id| parents.get(&id).copied()),
            Self::Table { lives, .. } => lives.lineages(|_| None),
            Self::Labels(folder) => lines(folder),
        }
    }
}

/// What the tracker says, in the words of the truth; None of what truth does not speak of.
const fn happened(what: &Happening) -> Option<Event> {
    match what {
        Happening::Hidden => Some(Event::Vanished),
        Happening::Found => Some(Event::Returned),
        Happening::Left => Some(Event::Left),
        Happening::Lost => Some(Event::Lost),
        Happening::Divided(_) => Some(Event::Divided),
        Happening::Born => Some(Event::Born),
        _ => None,
    }
}

/// The outlines of the next frame of a table that has any.
fn next(rows: &mut TableFrames) -> Result<Option<(usize, Outlines)>, String> {
    let frame = rows.next().transpose().map_err(|error| error.to_string())?;
    Ok(frame.map(|(t, all)| (t, all.into_iter().map(|one| (one.id, one.points)).collect())))
}
