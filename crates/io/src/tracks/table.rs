//! Tracks as a table `frame,id,x,y`, written as it grows and read frame by frame.

use std::fmt::Write as _;
use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Read as _, Write as _};
use std::path::{Path, PathBuf};

use glam::DVec2;

use super::Tracked;
use crate::limits::{FARTHEST, MOST_POINTS};
use crate::shapes::Separator;
use crate::write::{Whole, is_stream, unwritable};
use crate::{IoError, is_standard};

/// The first line.
const HEADING: &str = "frame,id,x,y\n";

/// Bytes that a line may have.
const MOST_LINE: usize = 1 << 12;

/// A table that grows.
#[derive(Debug)]
pub(super) struct Table {
    path: PathBuf,
    place: Place,
}

#[derive(Debug)]
enum Place {
    /// To standard output, a pipe or a device.
    Stream(Box<Whole>),
    /// Into a file that has its name at the end.
    Part(File, PathBuf),
}

/// What a table is called as long as it grows.
fn part_of(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    path.with_file_name(name)
}

impl Table {
    pub(super) fn begin(path: &Path) -> Result<Self, IoError> {
        let mut table = Self::opened(path, false)?;
        table.put(HEADING.as_bytes())?;
        Ok(table)
    }

    /// The table with nothing in it.
    fn opened(path: &Path, again: bool) -> Result<Self, IoError> {
        let (path, refuse) = (path.to_owned(), |error| unwritable(path, error));
        if is_standard(&path) || is_stream(&path) {
            let place = Place::Stream(Box::new(Whole::begin(&path)?));
            return Ok(Self { path, place });
        }
        crate::ready_file(&path)?;
        let target = crate::write::followed(&path).map_err(refuse)?;
        let part = part_of(&target);
        if part.symlink_metadata().is_ok() && !again {
            let message = format!(
                "a former run has left {}; needed: go on with it (--resume), or remove it",
                part.display()
            );
            return Err(IoError::file(&path, message));
        }
        let file = OpenOptions::new()
            .create_new(true)
            .write(true)
            .open(&part)
            .map_err(refuse)?;
        Ok(Self {
            path,
            place: Place::Part(file, part),
        })
    }

    pub(super) fn resume(path: &Path, from: usize) -> Result<Self, IoError> {
        if is_standard(path) || is_stream(path) {
            return Err(IoError::file(
                path,
                "only a file can be gone on with; the name of one is needed",
            ));
        }
        let refuse = |error| unwritable(path, error);
        let target = crate::write::followed(path).map_err(refuse)?;
        let part = part_of(&target);
        let old = if part.is_file() {
            part.clone()
        } else {
            target.clone()
        };
        // the rows are kept in a file of their own first, so that an end on the way loses nothing
        let mut kept = Whole::begin(&part)?;
        kept.write_all(HEADING.as_bytes()).map_err(refuse)?;
        if old.is_file() && from > 0 {
            for rows in TableFrames::open(&old)? {
                let (frame, tracked) = rows?;
                if frame >= from {
                    break;
                }
                let all: Vec<&Tracked> = tracked.iter().collect();
                kept.write_all(rows_of(frame, &all).as_bytes())
                    .map_err(refuse)?;
            }
        }
        crate::ready_file(path)?;
        kept.end()?;
        let file = OpenOptions::new()
            .append(true)
            .open(&part)
            .map_err(refuse)?;
        Ok(Self {
            path: path.to_owned(),
            place: Place::Part(file, part),
        })
    }

    fn put(&mut self, bytes: &[u8]) -> Result<(), IoError> {
        let written = match &mut self.place {
            Place::Stream(stream) => match stream.write_all(bytes).and_then(|()| stream.flush()) {
                // a reader that has gone away has what it wanted
                Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
                other => other,
            },
            Place::Part(file, _) => file.write_all(bytes),
        };
        written.map_err(|error| unwritable(&self.path, error))
    }

    pub(super) fn frame(&mut self, frame: usize, tracked: &[&Tracked]) -> Result<(), IoError> {
        self.put(rows_of(frame, tracked).as_bytes())
    }

    pub(super) fn end(self) -> Result<(), IoError> {
        let (file, part) = match self.place {
            Place::Stream(stream) => return stream.end(),
            Place::Part(file, part) => (file, part),
        };
        let refuse = |error| unwritable(&self.path, error);
        drop(file);
        // as any other result: what is there keeps its permissions, and links are followed
        let mut whole = Whole::begin(&self.path)?;
        let mut rows = File::open(&part).map_err(refuse)?;
        std::io::copy(&mut rows, &mut whole).map_err(refuse)?;
        whole.end()?;
        std::fs::remove_file(&part).map_err(refuse)
    }
}

fn rows_of(frame: usize, tracked: &[&Tracked]) -> String {
    let mut text = String::new();
    for one in tracked {
        for p in &one.points {
            // writing to a String cannot fail
            let _ = writeln!(text, "{frame},{},{},{}", one.id, p.x, p.y);
        }
    }
    text
}

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

impl TableFrames {
    /// Open a table, or what there is of it as long as it grows.
    ///
    /// # Errors
    ///
    /// A file that cannot be read.
    pub fn growing(path: &Path) -> Result<Self, IoError> {
        let target = crate::write::followed(path).map_err(|error| unwritable(path, error))?;
        let part = part_of(&target);
        Self::open(if part.is_file() { &part } else { &target })
    }

    /// The frame to go on with: the last of the table `path`, or of what a run that was ended has left of it, and
    /// its outlines. Such a rest may lack some of its last frame, which then is not counted. None where nothing is
    /// there, or no whole frame.
    ///
    /// # Errors
    ///
    /// A table that cannot be read.
    pub fn last(path: &Path) -> Result<Option<(usize, Vec<Tracked>)>, IoError> {
        let target = crate::write::followed(path).map_err(|error| unwritable(path, error))?;
        let part = part_of(&target);
        let cut = part.is_file();
        let old = if cut { part } else { target };
        if !old.is_file() {
            return Ok(None);
        }
        let (mut before, mut last) = (None, None);
        for rows in Self::open(&old)? {
            match rows {
                Ok(rows) => before = last.replace(rows),
                // its last line may be half a one
                Err(_) if cut => break,
                Err(error) => return Err(error),
            }
        }
        Ok(if cut { before } else { last })
    }
}
