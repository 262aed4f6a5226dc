//! Tracks written frame by frame, in any format.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::coco::Video;
use super::ctc::Folder;
use super::features::Features;
use super::growing::Growing;
use super::rois::Rois;
use super::{TrackContext, TrackFormat, Tracked, boxes, points};
use crate::IoError;
use crate::limits::{FARTHEST, MOST_NODES, MOST_WHOLE};

/// A file, or a folder, of tracks that grows frame by frame.
///
/// What it writes has its name when it is whole. Tables, `GeoJSON` and MOT grow as `NAME.part`, which stays when the
/// program is ended, and so do the labels of a folder; [`TrackWriter::resume`] goes on with them. A ZIP or a video
/// stands beside its name until [`TrackWriter::end`], and one that is dropped before leaves nothing.
///
/// ```
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("tracks.csv");
/// use io::tracks::{TrackContext, TrackFormat, TrackWriter, Tracked};
///
/// let context = TrackContext { size: (64, 48), ..TrackContext::default() };
/// let mut writer = TrackWriter::begin(&path, TrackFormat::Csv, &context)?;
/// let points = [(10.0, 10.0), (20.0, 10.5), (15.0, 20.0)].map(glam::DVec2::from).to_vec();
/// writer.frame(0, "f1.png", &[Tracked { id: 1, points, ..Tracked::default() }])?;
/// writer.end()?;
/// assert_eq!(std::fs::read_to_string(&path)?, "frame,id,x,y\n0,1,10,10\n0,1,20,10.5\n0,1,15,20\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct TrackWriter {
    path: PathBuf,
    /// The least number that the next frame may have.
    next: usize,
    kind: Kind,
}

#[derive(Debug)]
enum Kind {
    /// Rows of points or of boxes.
    Rows(Growing, Rows),
    Features(Features),
    Video(Box<Video>),
    Folder(Folder),
    Rois(Box<Rois>),
}

/// What makes the rows of a frame.
type Rows = fn(usize, &[&Tracked]) -> String;

impl TrackWriter {
    /// Begin a file of that format, or a folder.
    ///
    /// # Errors
    ///
    /// A place that cannot be written; a `NAME.part` that a former run has left; for labels, a folder that has some
    /// already, or frames without a size; a ZIP or a video to standard output.
    pub fn begin(
        path: &Path,
        format: TrackFormat,
        context: &TrackContext,
    ) -> Result<Self, IoError> {
        Self::open(path, format, context, false)
    }

    /// Go on with what a former run has left: `NAME.part` or else the file itself, or the labels of a folder; begin
    /// where nothing is there. All frames are given again, from the first: what is there already is compared and not
    /// written, and what comes behind it is. A last line of `NAME.part` that is not whole is written anew. Until then,
    /// nothing is changed.
    ///
    /// # Errors
    ///
    /// As [`TrackWriter::begin`]; a heading that is another; a format that is only written as a whole, as a ZIP or a
    /// video is.
    pub fn resume(
        path: &Path,
        format: TrackFormat,
        context: &TrackContext,
    ) -> Result<Self, IoError> {
        Self::open(path, format, context, true)
    }

    fn open(
        path: &Path,
        format: TrackFormat,
        context: &TrackContext,
        resume: bool,
    ) -> Result<Self, IoError> {
        if resume && !format.grows() {
            let message = format!(
                "{} is only written as a whole, and nothing of it is there before; needed: csv, geojson, mot or ctc",
                format.name()
            );
            return Err(IoError::file(path, message));
        }
        let sized = matches!(format, TrackFormat::Coco | TrackFormat::Ctc);
        let pixels = (context.size.0 as u64).saturating_mul(context.size.1 as u64);
        if sized && (pixels == 0 || pixels > MOST_WHOLE) {
            let (width, height) = context.size;
            return Err(IoError::file(
                path,
                format!(
                    "frames of {width}×{height} pixels; for {} they must have 1 to {MOST_WHOLE}",
                    format.name()
                ),
            ));
        }
        let rows = |head: &str| {
            if resume {
                Growing::resume(path, head, "")
            } else {
                Growing::begin(path, head, "")
            }
        };
        let kind = match format {
            TrackFormat::Csv => Kind::Rows(rows(points::HEADING)?, points::rows),
            TrackFormat::Mot => Kind::Rows(rows("")?, boxes::rows),
            TrackFormat::GeoJson => Kind::Features(Features::begin(path, context, resume)?),
            TrackFormat::Coco => Kind::Video(Box::new(Video::begin(path, context)?)),
            TrackFormat::Ctc => Kind::Folder(Folder::begin(path, context, resume)?),
            TrackFormat::ImageJ => Kind::Rois(Box::new(Rois::begin(path)?)),
        };
        Ok(Self {
            path: path.to_owned(),
            next: 0,
            kind,
        })
    }

    /// Whether there are frames of a former run that have not been given again.
    #[must_use]
    pub const fn is_behind(&self) -> bool {
        match &self.kind {
            Kind::Rows(growing, _) => growing.is_behind(),
            Kind::Features(features) => features.is_behind(),
            Kind::Folder(folder) => folder.is_behind(),
            _ => false,
        }
    }

    /// Write the outlines of a frame of that name; those without points are left out.
    ///
    /// # Errors
    ///
    /// - A frame number that is not above the last one.
    /// - An object that is given twice, or has the number 0.
    /// - An outline of one or two points, of too many, or with a point that is not finite or too far away.
    /// - A confidence that is not from 0 to 1.
    /// - A full disk. What was written of frames before is kept, but of a ZIP or a video.
    /// - In what is continued: a frame that differs from what is there.
    pub fn frame(&mut self, frame: usize, name: &str, tracked: &[Tracked]) -> Result<(), IoError> {
        let refuse = |what: String| IoError::file(&self.path, format!("frame {frame}: {what}"));
        if frame < self.next {
            return Err(refuse(format!(
                "frames must rise, and {} came before",
                self.next - 1
            )));
        }
        let mut ids = BTreeSet::new();
        for one in tracked {
            check(one).map_err(|what| refuse(format!("object {}: {what}", one.id)))?;
            if !ids.insert(one.id) {
                return Err(refuse(format!(
                    "object {} is there twice; once is needed",
                    one.id
                )));
            }
        }
        self.next = frame + 1;
        let seen: Vec<&Tracked> = tracked
            .iter()
            .filter(|one| !one.points.is_empty())
            .collect();
        match &mut self.kind {
            Kind::Rows(growing, rows) => growing.put(&rows(frame, &seen)),
            Kind::Features(features) => features.frame(frame, name, &seen),
            Kind::Video(video) => video.frame(frame, name, &seen),
            Kind::Folder(folder) => folder.frame(frame, &seen),
            Kind::Rois(rois) => rois.frame(frame, &seen),
        }
    }

    /// Finish the file; what people should know of it.
    ///
    /// # Errors
    ///
    /// A full disk, or a place that can no longer be written; a former run that went on farther.
    pub fn end(self) -> Result<Vec<String>, IoError> {
        match self.kind {
            Kind::Rows(growing, _) => growing.end().map(|()| Vec::new()),
            Kind::Features(features) => features.end().map(|()| Vec::new()),
            Kind::Video(video) => video.end().map(|()| Vec::new()),
            Kind::Folder(folder) => folder.end(),
            Kind::Rois(rois) => rois.end().map(|()| Vec::new()),
        }
    }

    /// Leave nothing of what was begun; what a former run has left stays.
    ///
    /// # Errors
    ///
    /// A part of a file that cannot be removed.
    pub fn discard(self) -> Result<(), IoError> {
        match self.kind {
            Kind::Rows(growing, _) => growing.discard(),
            Kind::Features(features) => features.discard(),
            // those stand beside their names until their ends
            _ => Ok(()),
        }
    }
}

fn check(one: &Tracked) -> Result<(), String> {
    if one.id == 0 {
        return Err("objects are numbered from 1".to_owned());
    }
    let count = one.points.len();
    if (1..3).contains(&count) || count > MOST_NODES {
        return Err(format!(
            "{count} points; an outline must have 3 to {MOST_NODES}"
        ));
    }
    let far = |p: &&glam::DVec2| !(p.x.abs() <= FARTHEST && p.y.abs() <= FARTHEST);
    if let Some(p) = one.points.iter().find(far) {
        return Err(format!(
            "a point at {p}; coordinates must be from -{FARTHEST:e} to {FARTHEST:e}"
        ));
    }
    match one.confidence {
        Some(value) if !(0.0..=1.0).contains(&value) => {
            Err(format!("the confidence must be from 0 to 1, got {value}"))
        }
        _ => Ok(()),
    }
}
