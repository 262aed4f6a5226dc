//! Frames of a sequence, one after the other: files, a folder of them, the pages of a TIFF, a video.
//!
//! One frame is in memory at a time. What cannot be read, or is of another size than the first frame, is
//! [`Frame::Broken`] and not the end: a tracker can go on without it.
//!
//! - Files are taken as they are named, but where they stand in the order of a shell (`f1 f10 f2`), by number.
//! - A folder is one sequence, by number. Masks and the like beside frames (`f1_mask.png`), hidden files and what is
//!   no picture are no frames; two sequences in one folder are refused.
//! - A TIFF that is named alone, or is the first of several that all have several pages, is its pages.
//! - A video (by the ending of its name; a GIF too) is read by the program ffmpeg, where it is installed, in 8 bits.
//! - `-` is standard input: PGM or PPM pictures one behind the other.
//!
//! The first frame says whether the sequence is in color: a grey frame in one in color has three channels that are
//! alike, and a frame in color in a grey one is taken by its grey levels.

mod listing;
mod mixed;
mod names;
mod order;
mod pages;
mod seek;
mod video;

use std::path::{Path, PathBuf};

use pages::Pages;
use video::Stream;

use crate::picture::PictureReading;
use crate::{IoError, Picture};

pub use listing::{ENDINGS, is_picture};
pub use names::Gap;
pub use order::natural_order;
pub use video::is_video;

/// A frame, or why there is none.
#[derive(Debug, Clone)]
pub enum Frame {
    /// Its picture.
    Picture(Box<Picture>),
    /// Why it cannot be used.
    Broken(String),
}

/// A frame of a sequence.
#[derive(Debug, Clone)]
pub struct Numbered {
    /// Its place in the sequence, from 0.
    pub index: usize,
    /// What it is called: its file, its page, its place in a video.
    pub name: String,
    /// How many frames are missing right before it, by the numbers of the files.
    pub missing: u64,
    /// What it shows.
    pub frame: Frame,
}

/// Where frames come from.
#[derive(Debug)]
enum Source {
    File(PathBuf),
    /// Pages, and the next of them.
    Pages(Pages, usize),
    /// A video that is not read yet.
    Video(PathBuf),
    /// A stream, and how many frames of it have been read.
    Stream(Stream, usize),
}

/// The frames of a sequence, read as they are asked for.
///
/// ```
/// # let folder = tempfile::tempdir()?;
/// # for k in [1, 2, 10] { std::fs::write(folder.path().join(format!("f{k}.pgm")), b"P5 2 1 255 ab")?; }
/// use io::frames::{Frame, Frames};
///
/// let mut frames = Frames::open(&[folder.path().to_owned()], &io::PictureReading::default())?;
/// assert_eq!((frames.total(), frames.gaps().len()), (Some(3), 1));
/// let last = frames.by_ref().last().unwrap();
/// assert_eq!((last.index, last.name.as_str(), last.missing), (2, "f10.pgm", 7));
/// assert!(matches!(last.frame, Frame::Picture(_)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Frames {
    reading: PictureReading,
    sources: Vec<Source>,
    /// The source that is read.
    current: usize,
    files: Vec<PathBuf>,
    total: Option<usize>,
    next: usize,
    gaps: Vec<Gap>,
    notes: Vec<String>,
    /// Size of the first frame, and whether it is in color.
    first: Option<((usize, usize), bool)>,
    /// Whether it has been said that frames in color become grey.
    greyed: bool,
}

impl Frames {
    /// The frames that these names stand for.
    ///
    /// # Errors
    ///
    /// A file or folder that is not there or cannot be read; a folder without pictures, or with those of several
    /// sequences; a TIFF of several channels of which none is chosen, or of slices at several moments; a video
    /// without a frame, or without the program that reads it. A picture that is broken is none of these.
    pub fn open(inputs: &[PathBuf], reading: &PictureReading) -> Result<Self, IoError> {
        let listing = listing::listing(inputs)?;
        let mut all = Self {
            reading: reading.clone(),
            sources: Vec::new(),
            current: 0,
            files: listing.files,
            total: Some(0),
            next: 0,
            gaps: listing.gaps,
            notes: listing.notes,
            first: None,
            greyed: false,
        };
        let mut paged = true;
        let files = all.files.clone();
        let alone = files.len() == 1;
        for path in files {
            if path.as_os_str() == "-" {
                all.add(Source::Stream(Stream::standard(), 0), None);
                continue;
            }
            if is_video(&path) {
                let source = if alone {
                    Source::Stream(Stream::video(&path)?, 0)
                } else {
                    Source::Video(path)
                };
                all.add(source, None);
                continue;
            }
            if !path.exists() {
                return Err(IoError::file(
                    &path,
                    "cannot be read: there is no such file; a picture, a folder of them \
                    or a video is needed",
                ));
            }
            // of many files, those behind one of a single page are pages themselves
            let pages = if paged {
                open_pages(&path, all.reading.channel.as_deref(), alone)?
            } else {
                None
            };
            match pages {
                Some(pages) => {
                    let count = pages.count();
                    all.gaps.clear();
                    all.add(Source::Pages(pages, 0), Some(count));
                }
                None => {
                    paged = false;
                    all.add(Source::File(path), Some(1));
                }
            }
        }
        if all.reading.page.is_some() {
            return Err(IoError::text(
                None,
                "a page is asked for; a sequence has all of them",
            ));
        }
        if all.total == Some(1) {
            all.notes.push("the sequence has a single frame".to_owned());
        }
        for gap in &all.gaps {
            all.notes.push(format!("missing in the sequence: {gap}"));
        }
        Ok(all)
    }

    fn add(&mut self, source: Source, count: Option<usize>) {
        self.sources.push(source);
        self.total = self.total.zip(count).map(|(a, b)| a + b);
    }

    /// How many frames there are; None of a video or a stream.
    #[must_use]
    pub const fn total(&self) -> Option<usize> {
        self.total
    }

    /// How many frames are left, if that is known.
    #[must_use]
    pub const fn left(&self) -> Option<usize> {
        match self.total {
            Some(total) => Some(total.saturating_sub(self.next)),
            None => None,
        }
    }

    /// The files that are read, in order.
    #[must_use]
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// Numbers that are missing in the names of the files.
    #[must_use]
    pub fn gaps(&self) -> &[Gap] {
        &self.gaps
    }

    /// What people should know of the sequence, taken out: after opening it, and again when it is over.
    pub fn take_notes(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notes)
    }

    /// Pass over so many frames. Files and pages are not read; a video is.
    pub fn pass(&mut self, count: usize) {
        let mut left = count;
        while left > 0 {
            let Some(source) = self.sources.get_mut(self.current) else {
                return;
            };
            match source {
                Source::File(_) => self.current += 1,
                Source::Pages(pages, page) if *page < pages.count() => *page += 1,
                Source::Pages(..) => {
                    self.current += 1;
                    continue;
                }
                Source::Video(_) | Source::Stream(..) => {
                    if self.read().is_none() {
                        return;
                    }
                }
            }
            self.next += 1;
            left -= 1;
        }
    }

    /// The next frame as it is, and what it is called.
    fn read(&mut self) -> Option<(String, Result<Picture, String>)> {
        loop {
            match self.sources.get_mut(self.current)? {
                Source::File(path) => {
                    let name = listing::name_of(path);
                    let read = Picture::load_as(path, &self.reading)
                        .map_err(|error| without(&error, path));
                    self.current += 1;
                    return Some((name, read));
                }
                Source::Pages(pages, page) if *page < pages.count() => {
                    *page += 1;
                    let name = format!("{} page {page}", listing::name_of(pages.path()));
                    return Some((name, pages.read(*page - 1, &self.reading)));
                }
                Source::Video(path) => {
                    let (name, path) = (listing::name_of(path), path.clone());
                    match Stream::video(&path) {
                        Ok(stream) => self.sources[self.current] = Source::Stream(stream, 0),
                        Err(error) => {
                            self.current += 1;
                            return Some((name, Err(without(&error, &path))));
                        }
                    }
                }
                Source::Stream(stream, count) => {
                    if let Some(read) = stream.next(&self.reading) {
                        *count += 1;
                        let name = listing::name_of(&crate::read::called(stream.path()));
                        return Some((format!("{name} frame {count}"), read));
                    }
                    self.notes.extend(stream.take_note());
                    self.current += 1;
                }
                Source::Pages(..) => {
                    self.current += 1;
                }
            }
        }
    }

    /// A picture that is like the first, or why it cannot be used.
    fn alike(&mut self, picture: Picture) -> Frame {
        let (size, color) = (picture.size(), picture.is_color());
        let (first, colors) = *self.first.get_or_insert((size, color));
        if size != first {
            return Frame::Broken(format!(
                "has {}×{} pixels and the first frame {}×{}; one of the same size is needed",
                size.0, size.1, first.0, first.1
            ));
        }
        if color && !colors && !self.greyed {
            self.greyed = true;
            self.notes.push(format!(
                "frame {} is in color and the first is grey: grey levels are taken",
                self.next
            ));
        }
        let picture = if colors {
            picture.into_color()
        } else {
            picture.into_grey()
        };
        Frame::Picture(Box::new(picture))
    }
}

impl Iterator for Frames {
    type Item = Numbered;

    fn next(&mut self) -> Option<Numbered> {
        let (name, read) = self.read()?;
        let frame = match read {
            Ok(picture) => self.alike(picture),
            Err(reason) => Frame::Broken(reason),
        };
        let index = self.next;
        self.next += 1;
        let gap = self.gaps.iter().find(|gap| gap.before == index);
        let missing = gap.map_or(0, |gap| gap.count);
        Some(Numbered {
            index,
            name,
            missing,
            frame,
        })
    }
}

/// The pages of a file that has several, or of one that is named alone.
fn open_pages(path: &Path, channel: Option<&str>, alone: bool) -> Result<Option<Pages>, IoError> {
    match Pages::open(path, channel) {
        Ok(pages) => Ok(pages.filter(|pages| alone || pages.count() > 1)),
        Err(error) if alone => Err(error),
        // it is a broken frame when its turn comes
        Err(_) => Ok(None),
    }
}

/// What is wrong with a file, without its name.
fn without(error: &IoError, path: &Path) -> String {
    let said = error.to_string();
    let rest = said.strip_prefix(&path.display().to_string());
    rest.and_then(|rest| rest.strip_prefix(": "))
        .map_or(said.clone(), str::to_owned)
}

#[cfg(test)]
mod tests;
