//! Where outlines go as they come: the file of tracks, the film, the tables, the kymograph.

use std::fmt;
use std::path::PathBuf;

use ::track::Outline;
use io::frames::Frames;
use io::tracks::{TrackContext, TrackFormat, TrackWriter, Tracked};
use io::{Picture, is_standard};
use scene::SceneError;

use super::film::Seen as FilmSeen;
use super::flags::Flags;
use super::plan::Plan;
use super::tables::{EVENTS, MEASURES, event_row, measures, row};
use super::values::Values;
use super::ways::Ways;
use crate::output::{goes_nowhere, put_bytes};

/// An outline as it is written, and as it was found.
#[derive(Debug, Clone)]
pub(super) struct Seen {
    pub(super) tracked: Tracked,
    pub(super) outline: Outline,
}

/// Something that happened to an object.
#[derive(Debug, Clone)]
pub(super) struct Happened {
    pub(super) frame: usize,
    pub(super) id: u32,
    pub(super) word: &'static str,
    pub(super) others: Vec<u32>,
    pub(super) confidence: f64,
}

impl fmt::Display for Happened {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "frame {}: object {} {}", self.frame, self.id, self.word)?;
        match (self.word, &self.others[..]) {
            ("divided", [a, b]) => write!(f, " into {a} and {b}"),
            ("begun", _) => write!(
                f,
                " where nothing is seen of one: unsure (confidence {:.2})",
                self.confidence
            ),
            ("merged", [other]) => write!(f, " with {other}"),
            ("uncertain", [other]) => write!(
                f,
                ": it has covered {other} and looks like it; their numbers may be exchanged from here on"
            ),
            _ => Ok(()),
        }
    }
}

/// All that is written.
#[derive(Debug)]
pub(super) struct Sinks<'a> {
    flags: &'a Flags,
    writer: TrackWriter,
    film: Option<FilmSeen>,
    measures: String,
    events: String,
    /// Whether anything has room for what is measured.
    measured: bool,
    values: Option<(u32, Values)>,
    ways: Option<Ways>,
    limits: Option<(f64, f64)>,
}

impl<'a> Sinks<'a> {
    /// Begin all files.
    pub(super) fn begin(
        flags: &'a Flags,
        plan: &Plan,
        frames: &Frames,
        picture: &Picture,
    ) -> Result<Self, SceneError> {
        let name = frames
            .files()
            .first()
            .map_or_else(String::new, |file| crate::fit::stem(file));
        let context = TrackContext {
            size: picture.size(),
            frames: frames.total(),
            name,
            label: None,
        };
        // what may be refused comes before what grows and stays
        let film = match (plan.film, &flags.overlay) {
            (Some(format), Some(path)) => Some(FilmSeen::begin(path, format, picture, flags.rate)?),
            _ => None,
        };
        let writer = if flags.resume {
            TrackWriter::resume(plan.out(), plan.format, &context)?
        } else {
            TrackWriter::begin(plan.out(), plan.format, &context)?
        };
        if is_standard(plan.out()) && goes_nowhere() {
            crate::output::complain(
                "note: standard output is closed or /dev/null: the outlines are kept nowhere",
            );
        }
        Ok(Self {
            flags,
            writer,
            film,
            measures: format!("{MEASURES}\n"),
            events: format!("{EVENTS}\n"),
            measured: flags.measure.is_some()
                || matches!(plan.format, TrackFormat::GeoJson | TrackFormat::ImageJ),
            values: None,
            ways: None,
            limits: picture.shown_limits(),
        })
    }

    /// Whether a former run has gone farther.
    pub(super) const fn is_behind(&self) -> bool {
        self.writer.is_behind()
    }

    /// Begin what is drawn in the end; the kymograph is of this object if no other is asked for.
    pub(super) fn charts(&mut self, id: u32, first: usize) {
        let id = self.flags.object.unwrap_or(id);
        self.values = self
            .flags
            .kymograph
            .as_ref()
            .map(|_| (id, Values::new(self.flags.of, id, first)));
        self.ways = self.flags.trajectories.as_ref().map(|_| Ways::default());
    }

    fn draw(
        &mut self,
        frame: usize,
        picture: Option<&Picture>,
        list: &[Tracked],
    ) -> Result<(), SceneError> {
        if let Some(film) = &mut self.film {
            film.show(frame, picture, list)?;
        }
        if let Some(ways) = &mut self.ways {
            ways.take(frame, picture, self.limits, list);
        }
        Ok(())
    }

    /// Take a frame.
    pub(super) fn frame(
        &mut self,
        frame: usize,
        name: &str,
        picture: Option<&Picture>,
        seen: &[Seen],
        happened: &[Happened],
    ) -> Result<(), SceneError> {
        let mut list: Vec<Tracked> = seen.iter().map(|one| one.tracked.clone()).collect();
        for (one, seen) in list.iter_mut().zip(seen) {
            if self.measured {
                one.measures = measures(seen);
            }
        }
        self.writer.frame(frame, name, &list)?;
        if self.flags.measure.is_some() {
            for one in &list {
                self.measures.push_str(&row(name, one));
            }
        }
        for one in happened {
            self.events.push_str(&event_row(one));
        }
        if let Some((id, values)) = &mut self.values {
            let own = seen.iter().find(|one| one.tracked.id == *id);
            values.take(own.map(|one| &one.outline), picture);
        }
        self.draw(frame, picture, &list)
    }

    /// Whether pictures of frames are drawn or measured.
    pub(super) const fn needs_pictures(&self) -> bool {
        self.film.is_some() || self.values.is_some() || self.ways.is_some()
    }

    /// Leave all files as they were.
    pub(super) fn discard(self) -> Result<(), SceneError> {
        Ok(self.writer.discard()?)
    }

    /// Finish all, each as far as it can be; what people should know of it, or the first thing that went wrong.
    pub(super) fn end(self) -> Result<Vec<String>, SceneError> {
        if self.is_behind() {
            // a refusal, and tables of a former run have more rows
            return Ok(self.writer.end()?);
        }
        let flags = self.flags;
        let notes = self.writer.end().map_err(SceneError::from);
        let table = |path: &Option<PathBuf>, text: &str| match path {
            Some(path) if is_standard(path) => put_bytes(text.as_bytes()),
            Some(path) => Ok(io::write_whole(path, text.as_bytes())?),
            None => Ok(()),
        };
        let mut all = vec![
            table(&flags.measure, &self.measures),
            table(&flags.events, &self.events),
        ];
        if let (Some((_, values)), Some(path)) = (self.values, &flags.kymograph) {
            all.push(values.write(path));
        }
        if let (Some(ways), Some(path)) = (self.ways, &flags.trajectories) {
            all.push(ways.write(path));
        }
        if let Some(film) = self.film {
            all.push(film.end());
        }
        let notes = notes?;
        all.into_iter().collect::<Result<(), SceneError>>()?;
        Ok(notes)
    }
}
