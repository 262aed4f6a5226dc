//! A file that grows frame by frame: begun, or gone on with where what is there is the same.

use std::fs::{File, OpenOptions};
use std::io::{BufReader, Read, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

use crate::write::{Whole, followed, is_stream, unwritable};
use crate::{IoError, is_standard};

/// Bytes that are looked through at a time for the end of the last line.
const BLOCK: u64 = 1 << 16;

/// A file that grows.
#[derive(Debug)]
pub(super) struct Growing {
    path: PathBuf,
    /// What it ends with.
    tail: String,
    place: Place,
}

#[derive(Debug)]
enum Place {
    /// To standard output, a pipe or a device.
    Stream(Box<Whole>),
    /// Into a file that has its name at the end.
    Part(Part),
    /// What a former run has left comes first, and is compared.
    Former(Former),
}

/// What is there of it by now.
#[derive(Debug)]
struct Part {
    file: File,
    path: PathBuf,
    /// Bytes of the frames that are whole in it.
    length: u64,
}

/// What a former run has left.
#[derive(Debug)]
struct Former {
    reader: BufReader<File>,
    path: PathBuf,
    /// What the file is called as long as it grows.
    part: PathBuf,
    /// Bytes up to the end of the last whole line, and how many of them have been compared.
    length: u64,
    same: u64,
    /// Lines that have been compared.
    lines: usize,
}

/// What a file is called as long as it grows.
fn part_of(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    path.with_file_name(name)
}

impl Growing {
    /// Begin a file with these bytes, and end it with those.
    pub(super) fn begin(path: &Path, head: &str, tail: &str) -> Result<Self, IoError> {
        let (path, refuse) = (path.to_owned(), |error| unwritable(path, error));
        let place = if is_standard(&path) || is_stream(&path) {
            Place::Stream(Box::new(Whole::begin(&path)?))
        } else {
            crate::ready_file(&path)?;
            let part = part_of(&followed(&path).map_err(refuse)?);
            if part.symlink_metadata().is_ok() {
                let message = format!(
                    "a former run has left {}; needed: go on with it (--resume), or remove it",
                    part.display()
                );
                return Err(IoError::file(&path, message));
            }
            let mut new = OpenOptions::new();
            let file = new
                .create_new(true)
                .write(true)
                .open(&part)
                .map_err(refuse)?;
            Place::Part(Part {
                file,
                path: part,
                length: 0,
            })
        };
        let tail = tail.to_owned();
        let mut growing = Self { path, tail, place };
        growing.put(head)?;
        Ok(growing)
    }

    /// Go on with what a former run has left: with the part of a file, or else the file. It stays as it is until all
    /// of it has been given again.
    pub(super) fn resume(path: &Path, head: &str, tail: &str) -> Result<Self, IoError> {
        if is_standard(path) || is_stream(path) {
            let message = "only a file can be gone on with; the name of one is needed";
            return Err(IoError::file(path, message));
        }
        let refuse = |error| unwritable(path, error);
        let target = followed(path).map_err(refuse)?;
        let part = part_of(&target);
        let cut = part.is_file();
        let old = if cut { part.clone() } else { target };
        if !old.is_file() {
            return Self::begin(path, head, tail);
        }
        crate::ready_file(path)?;
        let unread = |error| IoError::file(&old, format!("cannot be read: {error}"));
        let mut file = File::open(&old).map_err(unread)?;
        let length = if cut {
            // the last line of a run that was killed may be half a one, or no text at all
            whole_lines(&mut file).map_err(unread)?
        } else {
            without(&mut file, tail.as_bytes()).map_err(unread)?
        };
        let mut growing = Self {
            path: path.to_owned(),
            tail: tail.to_owned(),
            place: Place::Former(Former {
                reader: BufReader::new(file),
                path: old,
                part,
                length,
                same: 0,
                lines: 0,
            }),
        };
        growing.put(head)?;
        Ok(growing)
    }

    /// Whether what is given is there already.
    pub(super) const fn is_behind(&self) -> bool {
        match &self.place {
            Place::Former(former) => former.same < former.length,
            _ => false,
        }
    }

    /// Write what comes next.
    pub(super) fn put(&mut self, text: &str) -> Result<(), IoError> {
        let mut bytes = text.as_bytes();
        if let Place::Former(former) = &mut self.place {
            let count = former.compare(bytes)?;
            if count == bytes.len() {
                return Ok(());
            }
            bytes = &bytes[count..];
            let part = former.go_on();
            self.place = Place::Part(part.map_err(|error| unwritable(&self.path, error))?);
        }
        let written = match &mut self.place {
            Place::Stream(stream) => match stream.write_all(bytes).and_then(|()| stream.flush()) {
                // a reader that has gone away has what it wanted
                Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
                other => other,
            },
            Place::Part(part) => part.put(bytes),
            Place::Former(_) => Ok(()),
        };
        written.map_err(|error| unwritable(&self.path, error))
    }

    pub(super) fn end(self) -> Result<(), IoError> {
        let refuse = |error| unwritable(&self.path, error);
        let part = match self.place {
            Place::Stream(mut stream) => {
                return match stream.write_all(self.tail.as_bytes()) {
                    Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
                        Err(refuse(error))
                    }
                    _ => stream.end(),
                };
            }
            Place::Part(part) => part,
            Place::Former(former) if former.same < former.length => {
                let message = format!(
                    "has rows behind those of the last frame, from line {} on; nothing is changed",
                    former.lines + 1
                );
                return Err(IoError::file(&former.path, message));
            }
            Place::Former(mut former) => former.go_on().map_err(refuse)?,
        };
        let Part { file, path, .. } = part;
        drop(file);
        // as any other result: what is there keeps its permissions, and links are followed
        let mut whole = Whole::begin(&self.path)?;
        let mut rows = File::open(&path).map_err(refuse)?;
        std::io::copy(&mut rows, &mut whole).map_err(refuse)?;
        whole.write_all(self.tail.as_bytes()).map_err(refuse)?;
        whole.end()?;
        std::fs::remove_file(&path).map_err(refuse)
    }

    /// Leave nothing of a file that was begun; what a former run has left stays.
    pub(super) fn discard(self) -> Result<(), IoError> {
        match self.place {
            Place::Part(part) => {
                drop(part.file);
                std::fs::remove_file(&part.path).map_err(|error| unwritable(&self.path, error))
            }
            Place::Stream(_) | Place::Former(_) => Ok(()),
        }
    }
}

impl Part {
    /// Write all of it or nothing.
    fn put(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        let written = self.file.write_all(bytes);
        if written.is_ok() {
            self.length += bytes.len() as u64;
        } else {
            // a full disk still makes a file shorter
            self.file.set_len(self.length)?;
            self.file.seek(SeekFrom::End(0))?;
        }
        written
    }
}

impl Former {
    /// How many of these bytes are there, in their place.
    fn compare(&mut self, bytes: &[u8]) -> Result<usize, IoError> {
        let left = usize::try_from(self.length - self.same).unwrap_or(usize::MAX);
        let own = &bytes[..left.min(bytes.len())];
        let mut old = vec![0; own.len()];
        let read = self.reader.read_exact(&mut old);
        read.map_err(|error| IoError::file(&self.path, format!("cannot be read: {error}")))?;
        let differs = own.iter().zip(&old).position(|(a, b)| a != b);
        let same = differs.unwrap_or(own.len());
        self.lines += own[..same].iter().filter(|byte| **byte == b'\n').count();
        if differs.is_some() {
            return Err(IoError::File {
                path: self.path.clone(),
                line: Some(self.lines + 1),
                message: "is not what comes out now: it is of other frames, another start, other flags or another \
                    version; needed: those of the former run, or another name"
                    .to_owned(),
            });
        }
        self.same += own.len() as u64;
        Ok(own.len())
    }

    /// The part of the file, with what has been compared in it.
    fn go_on(&mut self) -> std::io::Result<Part> {
        if self.path != self.part {
            // in a file of its own first, so that an end on the way loses nothing
            let mut kept = Whole::begin(&self.part).map_err(std::io::Error::other)?;
            let mut old = File::open(&self.path)?.take(self.same);
            std::io::copy(&mut old, &mut kept)?;
            kept.end().map_err(std::io::Error::other)?;
        }
        let mut file = OpenOptions::new().write(true).open(&self.part)?;
        file.set_len(self.same)?;
        file.seek(SeekFrom::End(0))?;
        Ok(Part {
            file,
            path: self.part.clone(),
            length: self.same,
        })
    }
}

/// Bytes of a file up to the end of its last whole line.
fn whole_lines(file: &mut File) -> std::io::Result<u64> {
    let mut end = file.metadata()?.len();
    let mut found = 0;
    while end > 0 && found == 0 {
        let begin = end.saturating_sub(BLOCK);
        file.seek(SeekFrom::Start(begin))?;
        let mut block = Vec::new();
        Read::take(&mut *file, end - begin).read_to_end(&mut block)?;
        let last = block.iter().rposition(|byte| *byte == b'\n');
        found = last.map_or(0, |last| begin + last as u64 + 1);
        end = begin;
    }
    file.seek(SeekFrom::Start(0))?;
    Ok(found)
}

/// Bytes of a file without its tail, if it has that.
fn without(file: &mut File, tail: &[u8]) -> std::io::Result<u64> {
    let length = file.metadata()?.len();
    let Some(begin) = length.checked_sub(tail.len() as u64) else {
        return Ok(length);
    };
    file.seek(SeekFrom::Start(begin))?;
    let mut end = Vec::new();
    Read::take(&mut *file, tail.len() as u64).read_to_end(&mut end)?;
    file.seek(SeekFrom::Start(0))?;
    Ok(if end == tail { begin } else { length })
}
