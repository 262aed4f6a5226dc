//! Folders of the Cell Tracking Challenge, read: results (`mask000.tif`, `res_track.txt`), the truth of tracks
//! (`man_track000.tif`, `man_track.txt`), and that of segmentations (`man_seg000.tif`).

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::{TrackState, Tracked};
use crate::IoError;
use crate::picture::numbers_of;
use crate::shapes::{Budget, Labels};

/// What labels of frames are called, and the table beside them.
const KINDS: [(&str, Option<&str>); 3] = [
    ("mask", Some("res_track.txt")),
    ("man_track", Some("man_track.txt")),
    ("man_seg", None),
];

/// Bytes of a table of tracks, and of a picture of labels.
const MOST_TABLE: u64 = 64 << 20;
const MOST_LABELS: u64 = 1 << 30;

/// A line of a table of tracks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CtcTrack {
    /// The label, from 1.
    pub label: u32,
    /// The first frame.
    pub begin: usize,
    /// The last.
    pub end: usize,
    /// The label that it parted from, if any.
    pub parent: Option<u32>,
}

/// A folder of labels.
#[derive(Debug, Clone)]
pub struct CtcFolder {
    frames: BTreeMap<usize, PathBuf>,
    tracks: Vec<CtcTrack>,
}

/// The labels of the pixels of a frame, row by row; 0 for none.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LabelImage {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The labels.
    pub list: Vec<u32>,
}

impl CtcFolder {
    /// What is in a folder. Labels are read when they are asked for.
    ///
    /// # Errors
    ///
    /// A folder that cannot be read, without labels of frames, or with two of one frame; a table with a line that is
    /// not four whole numbers, whose end is before its beginning, or whose label or parent is wrong.
    pub fn open(path: &Path) -> Result<Self, IoError> {
        let refuse = |message: String| IoError::file(path, message);
        let needed = "a folder of mask000.tif, man_track000.tif or man_seg000.tif is needed";
        let unread = |error: std::io::Error| refuse(format!("cannot be read: {error}; {needed}"));
        let mut found: [BTreeMap<usize, PathBuf>; 3] = Default::default();
        let mut files = Vec::new();
        for entry in std::fs::read_dir(path).map_err(unread)? {
            files.push(entry.map_err(unread)?.path());
        }
        files.sort();
        for file in files {
            let name = file
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned();
            for ((prefix, _), frames) in KINDS.iter().zip(&mut found) {
                let Some(number) = numbered(&name, prefix) else {
                    continue;
                };
                if let Some(other) = frames.insert(number, file.clone()) {
                    let other = other
                        .file_name()
                        .unwrap_or_default()
                        .to_string_lossy()
                        .into_owned();
                    return Err(refuse(format!(
                        "{other} and {name} are both of frame {number}; one is needed"
                    )));
                }
            }
        }
        let own = KINDS
            .iter()
            .zip(found)
            .find(|(_, frames)| !frames.is_empty());
        let Some(((_, table), frames)) = own else {
            return Err(refuse(format!("holds no labels of frames; {needed}")));
        };
        let table = table
            .map(|name| path.join(name))
            .filter(|table| table.exists());
        let tracks = table.map_or_else(|| Ok(Vec::new()), |table| table_of(&table))?;
        Ok(Self { frames, tracks })
    }

    /// The numbers of the frames that have labels.
    pub fn frames(&self) -> impl Iterator<Item = usize> + '_ {
        self.frames.keys().copied()
    }

    /// The tracks of the table, by their labels; none where there is no table.
    #[must_use]
    pub fn tracks(&self) -> &[CtcTrack] {
        &self.tracks
    }

    /// The labels of a frame.
    ///
    /// # Errors
    ///
    /// A frame without labels; a picture that cannot be read, or has other than whole numbers.
    pub fn labels(&self, frame: usize) -> Result<LabelImage, IoError> {
        let path = self.frames.get(&frame);
        let path = path
            .ok_or_else(|| IoError::text(None, format!("there are no labels of frame {frame}")))?;
        let bytes = crate::read::read_bytes(path, "a picture of labels", |_| MOST_LABELS)?;
        let refuse = |message: String| IoError::file(path, message);
        let numbers = numbers_of(&bytes).map_err(refuse)?;
        if !numbers.whole || numbers.colors {
            return Err(refuse(
                "labels must be whole numbers from 0, and no colors".to_owned(),
            ));
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "whole numbers of 32 bits"
        )]
        let list: Vec<u32> = numbers.list.iter().map(|&v| v as u32).collect();
        let width = numbers.width;
        Ok(LabelImage {
            width,
            height: list.len().checked_div(width).unwrap_or(0),
            list,
        })
    }

    /// The outlines of a frame, along the sides of the pixels of each label; of one in several parts, the largest.
    ///
    /// # Errors
    ///
    /// As [`CtcFolder::labels`]; more outlines than a file may have.
    pub fn outlines(&self, frame: usize) -> Result<Vec<Tracked>, IoError> {
        let LabelImage {
            width,
            height,
            list,
        } = self.labels(frame)?;
        let refuse = |message: String| IoError::text(None, format!("frame {frame}: {message}"));
        let rings = Labels {
            list,
            width,
            height,
        }
        .outlines(&mut Budget::default())
        .map_err(refuse)?;
        let largest = |rings: Vec<Vec<glam::DVec2>>| {
            let area = |ring: &Vec<glam::DVec2>| {
                let next = ring.iter().cycle().skip(1);
                ring.iter()
                    .zip(next)
                    .map(|(a, b)| a.perp_dot(*b))
                    .sum::<f64>()
                    .abs()
            };
            rings
                .into_iter()
                .max_by(|a, b| area(a).total_cmp(&area(b)))
                .unwrap_or_default()
        };
        let outline = |(id, rings)| {
            let track = self.tracks.iter().find(|track| track.label == id);
            let parent = track.and_then(|track| track.parent);
            let state = TrackState::Given;
            Tracked {
                frame,
                id,
                points: largest(rings),
                parent,
                state,
                ..Tracked::default()
            }
        };
        Ok(rings.into_iter().map(outline).collect())
    }
}

/// The number of the frame whose labels are called so.
fn numbered(name: &str, prefix: &str) -> Option<usize> {
    let rest = name.strip_prefix(prefix)?;
    let digits = rest
        .strip_suffix(".tif")
        .or_else(|| rest.strip_suffix(".tiff"))?;
    let plain = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
    digits.parse().ok().filter(|_| plain)
}

fn table_of(path: &Path) -> Result<Vec<CtcTrack>, IoError> {
    let text = crate::read_text(path, "a table of label, begin, end and parent", MOST_TABLE)?;
    let mut tracks: BTreeMap<u32, (usize, CtcTrack)> = BTreeMap::new();
    let refuse = |line: usize, message: String| IoError::File {
        path: path.to_owned(),
        line: Some(line),
        message,
    };
    for (line, words) in (1..).zip(text.lines().map(str::split_whitespace)) {
        let words: Vec<&str> = words.collect();
        if words.is_empty() {
            continue;
        }
        let numbers: Option<Vec<u32>> = words.iter().map(|word| word.parse().ok()).collect();
        let Some(&[label, begin, end, parent]) = numbers.as_deref() else {
            return Err(refuse(
                line,
                "four whole numbers label, begin, end, parent are needed".to_owned(),
            ));
        };
        if label == 0 || begin > end || parent == label {
            let message = format!("label {label} from {begin} to {end} with parent {parent}");
            return Err(refuse(
                line,
                format!(
                    "{message}; a label from 1, and an end not before its beginning, are needed"
                ),
            ));
        }
        let track = CtcTrack {
            label,
            begin: begin as usize,
            end: end as usize,
            parent: (parent > 0).then_some(parent),
        };
        if tracks.insert(label, (line, track)).is_some() {
            return Err(refuse(
                line,
                format!("label {label} is there twice; once is needed"),
            ));
        }
    }
    for (line, track) in tracks.values() {
        if let Some(parent) = track.parent.filter(|parent| !tracks.contains_key(parent)) {
            return Err(refuse(
                *line,
                format!("parent {parent} is no label of this table; one is needed, or 0"),
            ));
        }
    }
    Ok(tracks.into_values().map(|(_, track)| track).collect())
}
