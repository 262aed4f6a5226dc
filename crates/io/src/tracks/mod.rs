//! Outlines through a sequence as files: tables, `GeoJSON`, COCO, the Cell Tracking Challenge, `ImageJ`, MOT.
//!
//! A [`TrackWriter`] is given the outlines frame by frame and keeps no more of them than its format asks for. Frames
//! count from 0 in tables, `GeoJSON`, COCO and the Cell Tracking Challenge, and from 1 in `ImageJ` and MOT.
//!
//! | format | written | of the rest is kept |
//! | --- | --- | --- |
//! | [`Csv`](TrackFormat::Csv) | `frame,id,x,y` a point | nothing |
//! | [`GeoJson`](TrackFormat::GeoJson) | a feature for each outline of each frame | all, as properties |
//! | [`Coco`](TrackFormat::Coco) | a video of `YouTube-VIS`: runs of pixels, a list an object | parent, confidence |
//! | [`Ctc`](TrackFormat::Ctc) | a folder of `mask000.tif` and `res_track.txt` | parent |
//! | [`ImageJ`](TrackFormat::ImageJ) | a ZIP of ROIs, each at its position in the stack | all, as text |
//! | [`Mot`](TrackFormat::Mot) | a box a line | confidence |
//!
//! Read are tables ([`TableFrames`]) and folders of the Cell Tracking Challenge ([`CtcFolder`]).

mod boxes;
mod coco;
mod ctc;
mod ctc_folder;
mod features;
mod growing;
mod points;
mod rois;
mod table;
mod writer;

use std::collections::BTreeMap;
use std::path::Path;

use glam::DVec2;

use crate::shapes::{Shape, Value};

pub use ctc_folder::{CtcFolder, CtcTrack, LabelImage};
pub use table::TableFrames;
pub use writer::TrackWriter;

/// How an outline of a frame came about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TrackState {
    /// It was found in the frame.
    #[default]
    Tracked,
    /// Part of it was found.
    Partly,
    /// It was not seen in the frame and is where it was expected.
    Coasting,
    /// It was given: a start, or an outline mended by hand.
    Given,
}

impl TrackState {
    /// Its name: `tracked`, `partly`, `coasting` or `given`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Tracked => "tracked",
            Self::Partly => "partly",
            Self::Coasting => "coasting",
            Self::Given => "given",
        }
    }
}

/// An outline of a frame.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tracked {
    /// The frame, from 0.
    pub frame: usize,
    /// The object, from 1; the same in every frame.
    pub id: u32,
    /// The closed outline, in pixels, the first pixel's center at (0, 0); empty where the object has none.
    pub points: Vec<DVec2>,
    /// The object that it parted from, if it did.
    pub parent: Option<u32>,
    /// How sure it is, from 0 to 1, if that is known.
    pub confidence: Option<f64>,
    /// How it came about.
    pub state: TrackState,
    /// Whatever else was measured, by name with its unit, as `area_px2`.
    pub measures: BTreeMap<String, f64>,
}

impl Tracked {
    /// As an outline of one picture, with what is known of it as properties.
    #[must_use]
    pub fn shape(&self) -> Shape {
        let mut shape = Shape::curve(self.points.clone(), Some(true));
        shape.id = Some(self.id.to_string());
        let mut note = |name: &str, value| shape.properties.insert(name.to_owned(), value);
        for (name, &value) in &self.measures {
            note(name, Value::Number(value));
        }
        note("frame", Value::Number(self.frame as f64));
        note("track", Value::Number(f64::from(self.id)));
        note("state", Value::Text(self.state.name().to_owned()));
        if let Some(parent) = self.parent {
            note("parent", Value::Number(f64::from(parent)));
        }
        if let Some(confidence) = self.confidence {
            note("confidence", Value::Number(confidence));
        }
        shape
    }

    /// The least and the largest x and y; None of an outline without points.
    #[must_use]
    pub fn bounds(&self) -> Option<(DVec2, DVec2)> {
        let first = *self.points.first()?;
        let both = |(low, high): (DVec2, DVec2), &p: &DVec2| (low.min(p), high.max(p));
        Some(self.points.iter().fold((first, first), both))
    }
}

/// A format of tracks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum TrackFormat {
    /// A table `frame,id,x,y` with a line for each point.
    Csv,
    /// `GeoJSON`: a feature for each outline of each frame; from the corner of the first pixel.
    GeoJson,
    /// COCO for videos, as `YouTube-VIS` has it.
    Coco,
    /// A folder of labels, as the Cell Tracking Challenge has its results.
    Ctc,
    /// A ZIP of `ImageJ` ROIs.
    ImageJ,
    /// Boxes as the MOT challenge has them; the corner of the first pixel is at 1, 1.
    Mot,
}

/// Names of formats, and endings of their files; `.json` is several.
const NAMES: [(&str, &str, TrackFormat); 6] = [
    ("csv", "csv", TrackFormat::Csv),
    ("geojson", "geojson", TrackFormat::GeoJson),
    ("coco", "json", TrackFormat::Coco),
    ("ctc", "", TrackFormat::Ctc),
    ("imagej", "zip", TrackFormat::ImageJ),
    ("mot", "txt", TrackFormat::Mot),
];

impl TrackFormat {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Csv,
        Self::GeoJson,
        Self::Coco,
        Self::Ctc,
        Self::ImageJ,
        Self::Mot,
    ];

    /// The format of that name: `csv`, `geojson`, `coco`, `ctc`, `imagej` or `mot`.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        NAMES
            .iter()
            .find(|(known, ..)| *known == name)
            .map(|(.., format)| *format)
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        NAMES
            .iter()
            .find(|(.., format)| *format == self)
            .map_or("csv", |(name, ..)| name)
    }

    /// Whether what was written of it stays when the program is ended, and can be gone on with.
    #[must_use]
    pub const fn grows(self) -> bool {
        !matches!(self, Self::Coco | Self::ImageJ)
    }

    /// The format that a file of this name is written in; a folder, or a name without an ending, is one of the Cell
    /// Tracking Challenge. None for an ending that no format has.
    #[must_use]
    pub fn by_ending(path: &Path) -> Option<Self> {
        let ending = path.extension().map_or(String::new(), |ending| {
            ending.to_string_lossy().to_lowercase()
        });
        if ending.is_empty() && crate::is_standard(path) {
            return Some(Self::Csv);
        }
        if path.is_dir() {
            return Some(Self::Ctc);
        }
        NAMES
            .iter()
            .find(|(_, known, _)| *known == ending)
            .map(|(.., format)| *format)
    }
}

/// What a format may say of the sequence.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TrackContext {
    /// Width and height of the frames.
    pub size: (usize, usize),
    /// How many frames there will be, if that is known.
    pub frames: Option<usize>,
    /// What the sequence is called.
    pub name: String,
    /// What the objects are, for formats with categories; `object` if not given.
    pub label: Option<String>,
}

#[cfg(test)]
mod ctc_tests;
#[cfg(test)]
mod growing_tests;
#[cfg(test)]
mod tests;
