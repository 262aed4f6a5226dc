//! Tracks as the Cell Tracking Challenge has its results: `mask000.tif` of 16 bits for each frame, and `res_track.txt`
//! with a line `label begin end parent` for each track.
//!
//! A track of the challenge has a pixel in every frame from its beginning to its end. An object that is away for some
//! frames becomes several tracks: the first has its number, each later one a label from 65535 down, and the one before
//! as its parent. A parent has ended before its children begin; where it has not, none is named.
//! (Format: <https://public.celltrackingchallenge.net/documents/Naming%20and%20file%20content%20conventions.pdf>.)

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use tiff::encoder::{Compression, DeflateLevel, TiffEncoder, colortype};

use super::{TrackContext, Tracked};
use crate::IoError;
use crate::shapes::labels;
use crate::write::{unwritable, write_whole};

/// The name of the table.
const TABLE: &str = "res_track.txt";

/// What to say of labels that differ from those of a former run.
const CHANGED: &str = "is not what comes out now: it is of other frames, another start, other flags or another version; \
    needed: those of the former run, or another folder";

#[derive(Debug)]
pub(super) struct Folder {
    path: PathBuf,
    size: (usize, usize),
    /// Digits of the numbers of frames.
    digits: usize,
    frames: usize,
    /// How many frames a former run has left, which are compared.
    former: usize,
    objects: BTreeMap<u32, Object>,
    /// Labels that are taken for later tracks of objects, the least of them last.
    taken: BTreeSet<u16>,
}

/// An object: its tracks one after the other, and what it parted from.
#[derive(Debug, Default)]
struct Object {
    tracks: Vec<Track>,
    parent: Option<u32>,
}

/// A label, and the first and the last frame that have a pixel of it.
#[derive(Debug, Clone, Copy)]
struct Track {
    label: u16,
    begin: usize,
    end: usize,
}

impl Folder {
    pub(super) fn begin(
        path: &Path,
        context: &TrackContext,
        resume: bool,
    ) -> Result<Self, IoError> {
        crate::ready_folder(path)?;
        let refuse = |error: std::io::Error| unwritable(path, error);
        let mut former = 0;
        for entry in std::fs::read_dir(path).map_err(refuse)? {
            let name = entry.map_err(refuse)?.file_name();
            let name = name.to_string_lossy();
            let mask = name
                .strip_prefix("mask")
                .and_then(|rest| rest.strip_suffix(".tif"));
            if resume {
                let number = mask.and_then(|digits| digits.parse::<usize>().ok());
                former = former.max(number.map_or(0, |number| number.saturating_add(1)));
            } else if name == TABLE || mask.is_some() {
                let message = format!(
                    "has results already, as {name}; needed: another folder, go on with them (--resume), or remove them"
                );
                return Err(IoError::file(path, message));
            }
        }
        let last = context.frames.unwrap_or(0).max(1) - 1;
        Ok(Self {
            path: path.to_owned(),
            size: context.size,
            digits: last.to_string().len().max(3),
            frames: 0,
            former,
            objects: BTreeMap::new(),
            taken: BTreeSet::new(),
        })
    }

    pub(super) const fn is_behind(&self) -> bool {
        self.frames < self.former
    }

    fn refuse(&self, frame: usize, what: impl std::fmt::Display) -> IoError {
        IoError::file(&self.path, format!("frame {frame}: {what}"))
    }

    pub(super) fn frame(&mut self, frame: usize, tracked: &[&Tracked]) -> Result<(), IoError> {
        while self.frames < frame {
            self.mask(self.frames, &vec![0; self.size.0 * self.size.1])?;
        }
        let shapes: Vec<_> = tracked.iter().map(|one| one.shape()).collect();
        let list = labels(&shapes, self.size.0, self.size.1)?;
        let seen: BTreeSet<u32> = list.iter().copied().filter(|&id| id > 0).collect();
        let mut names: BTreeMap<u32, u16> = BTreeMap::new();
        for one in tracked {
            if seen.contains(&one.id) {
                names.insert(one.id, self.label(frame, one)?);
            }
        }
        let named = |id: &u32| names.get(id).copied().unwrap_or(0);
        let list: Vec<u16> = list.iter().map(named).collect();
        self.mask(frame, &list)
    }

    /// The label of an object that has a pixel in this frame.
    fn label(&mut self, frame: usize, one: &Tracked) -> Result<u16, IoError> {
        let known = self
            .objects
            .get(&one.id)
            .and_then(|object| object.tracks.last())
            .copied();
        if let Some(last) = known.filter(|last| last.end + 1 == frame) {
            if let Some(own) = self
                .objects
                .get_mut(&one.id)
                .and_then(|object| object.tracks.last_mut())
            {
                own.end = frame;
            }
            return Ok(last.label);
        }
        let label = match known {
            None => u16::try_from(one.id)
                .ok()
                .filter(|label| !self.taken.contains(label)),
            Some(_) => self.free(),
        };
        let label = label.ok_or_else(|| {
            self.refuse(
                frame,
                format!("object {}: its label must be at most {}", one.id, u16::MAX),
            )
        })?;
        let object = self.objects.entry(one.id).or_default();
        object.parent = object
            .parent
            .or(one.parent.filter(|&parent| parent != one.id));
        object.tracks.push(Track {
            label,
            begin: frame,
            end: frame,
        });
        Ok(label)
    }

    /// A label for a later track: the largest that nothing has.
    fn free(&mut self) -> Option<u16> {
        let next = self.taken.first().map_or(u16::MAX, |least| least - 1);
        let free = (1..=next)
            .rev()
            .find(|&label| !self.objects.contains_key(&u32::from(label)))?;
        self.taken.insert(free);
        Some(free)
    }

    fn mask(&mut self, frame: usize, list: &[u16]) -> Result<(), IoError> {
        let path = self
            .path
            .join(format!("mask{frame:0digits$}.tif", digits = self.digits));
        let side = |length: usize| u32::try_from(length).map_err(|error| self.refuse(frame, error));
        let (width, height) = (side(self.size.0)?, side(self.size.1)?);
        let mut bytes = Cursor::new(Vec::new());
        let written = TiffEncoder::new(&mut bytes).and_then(|encoder| {
            let mut encoder = encoder.with_compression(Compression::Deflate(DeflateLevel::Fast));
            encoder.write_image::<colortype::Gray16>(width, height, list)
        });
        written.map_err(|error| self.refuse(frame, error))?;
        let is_there = frame < self.former && path.exists();
        self.frames = frame + 1;
        if !is_there {
            return write_whole(&path, bytes.get_ref());
        }
        let old = std::fs::read(&path)
            .map_err(|error| IoError::file(&path, format!("cannot be read: {error}")))?;
        if old == *bytes.get_ref() {
            return Ok(());
        }
        Err(IoError::file(&path, CHANGED))
    }

    pub(super) fn end(self) -> Result<Vec<String>, IoError> {
        if self.is_behind() {
            let message = format!(
                "has labels of {} frames, and only {} were followed; the table is not changed",
                self.former, self.frames
            );
            return Err(IoError::file(&self.path, message));
        }
        let mut lines: BTreeMap<u16, String> = BTreeMap::new();
        let (mut cut, mut apart) = (0, 0);
        for object in self.objects.values() {
            let mut before = 0;
            for (place, track) in object.tracks.iter().enumerate() {
                let Track { label, begin, end } = *track;
                let parent = if place > 0 {
                    apart += 1;
                    before
                } else {
                    let parent = object.parent.and_then(|parent| self.objects.get(&parent));
                    let ended = parent.and_then(|parent| {
                        let whole = parent.tracks.last().is_some_and(|last| last.end < begin);
                        parent.tracks.last().filter(|_| whole)
                    });
                    cut += usize::from(object.parent.is_some() && ended.is_none());
                    ended.map_or(0, |track| track.label)
                };
                before = label;
                lines.insert(label, format!("{label} {begin} {end} {parent}"));
            }
        }
        let mut text = String::new();
        for line in lines.values() {
            // writing to a String cannot fail
            let _ = writeln!(text, "{line}");
        }
        write_whole(&self.path.join(TABLE), text.as_bytes())?;
        let mut notes = Vec::new();
        if apart > 0 {
            notes.push(format!(
                "{apart} tracks begin again after frames without a pixel: they have labels from 65535 down, and the \
                 track before as their parent"
            ));
        }
        if cut > 0 {
            notes.push(format!(
                "{cut} parents go on beside their children, and are not named in {TABLE}"
            ));
        }
        Ok(notes)
    }
}
