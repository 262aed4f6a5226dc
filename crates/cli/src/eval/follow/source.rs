//! The frames of a sequence and their truth, one at a time.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec2;
use io::tracks::{CtcFolder, LabelImage};
use io::{IoError, Picture};
use ndarray::Array2;
use scene::fit::Image;
use score::sequences::{Event, Sequence};
use score::tracking::Lineage;
use score::{border, filled};

use crate::eval::change::byte;

/// Where frames come from.
#[derive(Debug)]
pub(super) enum Source {
    /// Pictures and masks of one object.
    Files(Vec<(PathBuf, PathBuf)>),
    /// Drawn.
    Drawn(Sequence),
    /// Pictures and labels of the Cell Tracking Challenge.
    Challenge(Challenge),
}

/// A sequence of the Cell Tracking Challenge.
#[derive(Debug)]
pub(super) struct Challenge {
    /// Empty where there are none: then only what was found can be scored.
    pub(super) pictures: Vec<PathBuf>,
    tracks: CtcFolder,
    segments: Option<CtcFolder>,
    frames: usize,
}

/// What is true of a frame.
#[derive(Debug)]
pub(super) enum Truth {
    /// Of one object.
    One {
        rings: Vec<Vec<DVec2>>,
        mask: Array2<bool>,
    },
    /// Of many: their labels, and those that SEG is taken of if they are others; None where a frame has none.
    Many {
        labels: Array2<u32>,
        segments: Option<Option<Array2<u32>>>,
    },
}

impl Challenge {
    /// From the folder of pictures and the two of truth.
    pub(super) fn new(
        pictures: PathBuf,
        tracks: CtcFolder,
        segments: Option<CtcFolder>,
    ) -> Result<Self, IoError> {
        let mut files = Vec::new();
        if pictures.is_dir() {
            let frames = io::frames::Frames::open(
                std::slice::from_ref(&pictures),
                &io::PictureReading::default(),
            )?;
            files = frames.files().to_vec();
        }
        let frames = tracks.frames().last().map_or(0, |last| last + 1);
        if !files.is_empty() && files.len() != frames {
            let message = format!(
                "has {} pictures, but the truth has frames 0 to {}; as many are needed",
                files.len(),
                frames.saturating_sub(1)
            );
            return Err(IoError::file(&pictures, message));
        }
        Ok(Self {
            pictures: files,
            tracks,
            segments,
            frames,
        })
    }
}

impl Source {
    pub(super) fn frames(&self) -> usize {
        match self {
            Self::Files(frames) => frames.len(),
            Self::Drawn(sequence) => sequence.frames(),
            Self::Challenge(challenge) => challenge.frames,
        }
    }

    /// Whether objects may divide and be born.
    pub(super) fn births(&self) -> bool {
        match self {
            Self::Files(_) => false,
            Self::Drawn(sequence) => sequence.events.iter().any(|event| event.2 == Event::Born),
            Self::Challenge(_) => true,
        }
    }

    /// Whether there is more than one object.
    pub(super) fn many(&self) -> bool {
        match self {
            Self::Files(_) => false,
            Self::Drawn(sequence) => self.births() || sequence.start().len() > 1,
            Self::Challenge(_) => true,
        }
    }

    /// The picture of a frame.
    pub(super) fn image(&self, t: usize) -> Result<Image, String> {
        match self {
            Self::Files(frames) => picture(&frames[t].0),
            Self::Drawn(sequence) => Ok(Image::bytes(sequence.frame(t).mapv(byte).into_shared())),
            Self::Challenge(challenge) => match challenge.pictures.get(t) {
                Some(path) => picture(path),
                None => Err("there are no pictures; --found is needed".to_owned()),
            },
        }
    }

    /// The truth of a frame.
    pub(super) fn truth(&self, t: usize) -> Result<Truth, String> {
        match self {
            Self::Files(frames) => {
                let path = &frames[t].1;
                let mask = Picture::load(path).map_err(|error| error.to_string())?;
                let mask = mask.levels().mapv(|level| level > 127.5);
                let rings = border(&mask);
                Ok(Truth::One { rings, mask })
            }
            Self::Drawn(sequence) if self.many() => Ok(Truth::Many {
                labels: sequence.labels(t),
                segments: None,
            }),
            Self::Drawn(sequence) => {
                // what vanishes for a while goes on
                let hides = sequence
                    .events
                    .iter()
                    .any(|event| event.2 == Event::Vanished);
                let outlines = if hides {
                    sequence.bodies(t)
                } else {
                    sequence.truth(t)
                };
                let rings: Vec<Vec<DVec2>> = outlines.into_iter().map(|one| one.1).collect();
                let [width, height] = sequence.size;
                let mask = filled(&rings, (height, width));
                Ok(Truth::One { rings, mask })
            }
            Self::Challenge(challenge) => {
                let labels = labels(&challenge.tracks, t)?;
                let segments = match &challenge.segments {
                    None => None,
                    Some(folder) if folder.frames().any(|frame| frame == t) => {
                        Some(Some(self::labels(folder, t)?))
                    }
                    Some(_) => Some(None),
                };
                Ok(Truth::Many { labels, segments })
            }
        }
    }

    /// What happens by truth, where that is known: the frame, and what. A child's birth is part of its division.
    pub(super) fn events(&self) -> Option<Vec<(usize, Event)>> {
        let Self::Drawn(sequence) = self else {
            return None;
        };
        let child = |id: u32| sequence.parents.iter().any(|pair| pair.0 == id);
        let counts = |&&(_, id, event): &&(usize, u32, Event)| {
            event != Event::Kicked && !(event == Event::Born && child(id))
        };
        let events = sequence.events.iter().filter(counts);
        Some(events.map(|event| (event.0, event.2)).collect())
    }

    /// The lives of the true objects, where there are many.
    pub(super) fn lineages(&self) -> Vec<Lineage> {
        match self {
            Self::Files(_) => Vec::new(),
            Self::Drawn(sequence) => {
                let mut lives = Lives::default();
                for t in 0..sequence.frames() {
                    lives.add(t, &sequence.labels(t));
                }
                lives.lineages(|id| {
                    let parent = sequence.parents.iter().find(|pair| pair.0 == id);
                    parent.map(|pair| pair.1)
                })
            }
            Self::Challenge(challenge) => lines(&challenge.tracks),
        }
    }

    /// The true outlines of the first frame.
    pub(super) fn start(&self) -> Result<Vec<Vec<DVec2>>, String> {
        if let Self::Drawn(sequence) = self {
            return Ok(sequence.start().into_iter().map(|one| one.1).collect());
        }
        Ok(match self.truth(0)? {
            Truth::One { rings, .. } => largest(rings).into_iter().collect(),
            Truth::Many { labels, .. } => {
                let mut numbers: Vec<u32> =
                    labels.iter().copied().filter(|label| *label > 0).collect();
                numbers.sort_unstable();
                numbers.dedup();
                let ring = |label: &u32| largest(border(&labels.mapv(|own| own == *label)));
                numbers.iter().filter_map(ring).collect()
            }
        })
    }
}

fn picture(path: &Path) -> Result<Image, String> {
    let picture = Picture::load(path).map_err(|error| error.to_string())?;
    Ok(Image::of(Arc::new(picture)))
}

/// The labels of a frame of a folder.
pub(super) fn labels(folder: &CtcFolder, t: usize) -> Result<Array2<u32>, String> {
    let LabelImage {
        width,
        height,
        list,
    } = folder.labels(t).map_err(|error| error.to_string())?;
    Array2::from_shape_vec((height, width), list).map_err(|error| error.to_string())
}

/// The table of a folder.
pub(super) fn lines(folder: &CtcFolder) -> Vec<Lineage> {
    let line = |track: &io::tracks::CtcTrack| Lineage {
        label: track.label,
        begin: track.begin,
        end: track.end,
        parent: track.parent.unwrap_or(0),
    };
    folder.tracks().iter().map(line).collect()
}

/// The ring that encloses most.
fn largest(rings: Vec<Vec<DVec2>>) -> Option<Vec<DVec2>> {
    let area = |ring: &Vec<DVec2>| score::Measures::of(&[ring]).map_or(0.0, |m| m.area);
    rings.into_iter().max_by(|a, b| area(a).total_cmp(&area(b)))
}

/// First and last frames of objects, from labels.
#[derive(Debug, Default)]
pub(super) struct Lives(std::collections::BTreeMap<u32, (usize, usize)>);

impl Lives {
    pub(super) fn add(&mut self, t: usize, labels: &Array2<u32>) {
        let mut last = 0;
        for &label in labels {
            if label > 0 && label != last {
                self.0.entry(label).or_insert((t, t)).1 = t;
            }
            last = label;
        }
    }

    /// As a table; a parent that is not there or does not end before is none.
    pub(super) fn lineages(&self, parent: impl Fn(u32) -> Option<u32>) -> Vec<Lineage> {
        let line = |(&label, &(begin, end)): (&u32, &(usize, usize))| {
            let parent = parent(label).filter(|parent| {
                let life = self.0.get(parent);
                life.is_some_and(|life| life.1 < begin)
            });
            Lineage {
                label,
                begin,
                end,
                parent: parent.unwrap_or(0),
            }
        };
        self.0.iter().map(line).collect()
    }
}
