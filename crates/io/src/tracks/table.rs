//! Tracks from a table `frame,id,x,y`, read frame by frame.

use std::fs::File;
use std::io::{BufRead, BufReader, Read as _};
use std::path::{Path, PathBuf};

use glam::DVec2;

use super::Tracked;
use crate::IoError;
use crate::limits::{FARTHEST, MOST_POINTS};
use crate::shapes::Separator;

/// Bytes that a line may have.
const MOST_LINE: usize = 1 << 12;

/// The outlines of a table, frame by frame; no more than one frame is in memory.
///
/// Columns are told by a heading with `frame`, `id`, `x` and `y` (or `t`, `track`, `label`) in any order, or are these
/// four where there is none. Rows are by rising frames; those of an object in a frame are its outline, in order.
#[derive(Debug)]
pub struct TableFrames {
    path: PathBuf,
    reader: BufReader<File>,
    line: usize,
    columns: Option<[usize; 4]>,
    separator: Option<Separator>,
    /// The first row of the next frame.
    waiting: Option<(usize, u32, DVec2)>,
    /// The last frame that was begun.
    last: Option<usize>,
    over: bool,
}

/// Names of the columns.
const COLUMNS: [&[&str]; 4] = [
    &["frame", "t", "time", "frame_index"],
    &["id", "track", "track_id", "object", "label", "curve"],
    &["x"],
    &["y"],
];

impl TableFrames {
    /// Open a table.
    ///
    /// # Errors
    ///
    /// A file that cannot be read.
    pub fn open(path: &Path) -> Result<Self, IoError> {
        let file = File::open(path).map_err(|error| {
            IoError::file(
                path,
                format!("cannot be read: {error}; a CSV of frame,id,x,y is needed"),
            )
        })?;
        Ok(Self {
            path: path.to_owned(),
            reader: BufReader::new(file),
            line: 0,
            columns: None,
            separator: None,
            waiting: None,
            last: None,
            over: false,
        })
    }

    fn refuse(&self, message: impl ToString) -> IoError {
        IoError::File {
            path: self.path.clone(),
            line: Some(self.line),
            message: message.to_string(),
        }
    }

    /// The next row; None behind the last.
    fn row(&mut self) -> Result<Option<(usize, u32, DVec2)>, IoError> {
        loop {
            let mut bytes = Vec::new();
            let mut line = self.reader.by_ref().take(MOST_LINE as u64);
            let read = line.read_until(b'\n', &mut bytes);
            self.line += 1;
            read.map_err(|error| self.refuse(format!("cannot be read: {error}")))?;
            if bytes.is_empty() {
                return Ok(None);
            }
            if bytes.len() == MOST_LINE {
                return Err(self.refuse(format!("a line must be shorter than {MOST_LINE} bytes")));
            }
            let text =
                std::str::from_utf8(&bytes).map_err(|_| self.refuse("is no text in UTF-8"))?;
            let text = text.trim_start_matches('\u{feff}').trim();
            if text.is_empty() || text.starts_with('#') {
                continue;
            }
            let separator = *self.separator.get_or_insert_with(|| Separator::of(text));
            let words: Vec<&str> = separator.split(text).collect();
            let Some(columns) = self.columns else {
                let number = words.iter().any(|word| separator.number(word).is_some());
                self.columns = Some(if number {
                    [0, 1, 2, 3]
                } else {
                    self.heading(&words)?
                });
                if number {
                    return self.numbers(&words, [0, 1, 2, 3]).map(Some);
                }
                continue;
            };
            return self.numbers(&words, columns).map(Some);
        }
    }

    fn heading(&self, words: &[&str]) -> Result<[usize; 4], IoError> {
        let mut columns = [0; 4];
        for (column, names) in columns.iter_mut().zip(COLUMNS) {
            let own = |word: &&str| names.contains(&word.to_lowercase().trim_matches('"'));
            let found = words.iter().position(|word| own(&word.trim()));
            *column = found.ok_or_else(|| {
                self.refuse(format!(
                    "the heading has no column {}; frame, id, x and y are needed",
                    names[0]
                ))
            })?;
        }
        Ok(columns)
    }

    fn numbers(&self, words: &[&str], columns: [usize; 4]) -> Result<(usize, u32, DVec2), IoError> {
        let separator = self.separator.unwrap_or(Separator::Letter(','));
        let number = |column: usize| words.get(column).and_then(|word| separator.number(word));
        let needed = || self.refuse("four numbers frame, id, x, y are needed");
        let [frame, id, x, y] = columns.map(number);
        let (frame, id) = (frame.ok_or_else(needed)?, id.ok_or_else(needed)?);
        let p = DVec2::new(x.ok_or_else(needed)?, y.ok_or_else(needed)?);
        if !(p.x.abs() <= FARTHEST && p.y.abs() <= FARTHEST) {
            return Err(self.refuse(format!(
                "numbers must be from -{FARTHEST:e} to {FARTHEST:e}"
            )));
        }
        let whole = |value: f64, least: f64| {
            value.fract() == 0.0 && (least..=f64::from(u32::MAX)).contains(&value)
        };
        if !whole(frame, 0.0) || !whole(id, 1.0) {
            let message = "a frame must be a whole number from 0 and an id one from 1";
            return Err(self.refuse(format!("{message}, got {frame} and {id}")));
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "whole numbers of 32 bits"
        )]
        Ok((frame as usize, id as u32, p))
    }

    fn read(&mut self) -> Result<Option<(usize, Vec<Tracked>)>, IoError> {
        let first = match self.waiting.take() {
            Some(row) => Some(row),
            None => self.row()?,
        };
        let Some((frame, id, p)) = first else {
            return Ok(None);
        };
        if self.last.is_some_and(|last| frame <= last) {
            return Err(self.refuse(format!(
                "frame {frame} stands behind a later one; rising frames are needed"
            )));
        }
        self.last = Some(frame);
        let mut list: Vec<Tracked> = Vec::new();
        let mut places = std::collections::BTreeMap::new();
        let mut count = 0;
        let mut add = |id: u32, p: DVec2| {
            let at = *places.entry(id).or_insert_with(|| {
                list.push(Tracked {
                    frame,
                    id,
                    ..Tracked::default()
                });
                list.len() - 1
            });
            list[at].points.push(p);
            count += 1;
            count
        };
        add(id, p);
        while let Some(row) = self.row()? {
            if row.0 != frame {
                self.waiting = Some(row);
                break;
            }
            if add(row.1, row.2) > MOST_POINTS {
                return Err(self.refuse(format!(
                    "a frame of more than {MOST_POINTS} points, which are the most"
                )));
            }
        }
        Ok(Some((frame, list)))
    }
}

impl Iterator for TableFrames {
    type Item = Result<(usize, Vec<Tracked>), IoError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.over {
            return None;
        }
        let read = self.read().transpose();
        self.over = !matches!(read, Some(Ok(_)));
        read
    }
}
