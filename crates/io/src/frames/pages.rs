//! The pages of one TIFF as frames: each found at once, whichever it is, in one open file.

use std::fs::File;
use std::io::{BufRead as _, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use tiff::decoder::Decoder;

use crate::IoError;
use crate::picture::{Picture, PictureReading, PixelSize, broken, decode_tiff, pages_of_channel};

/// Pages of one file.
const MOST_PAGES: usize = 1 << 20;

/// A file whose pages are read one by one.
#[derive(Debug)]
pub(super) struct Pages {
    path: PathBuf,
    file: File,
    length: u64,
    /// Where the head of each page is.
    heads: Vec<u64>,
    /// Whether offsets have 64 bits, and whether numbers begin with their largest byte.
    wide: bool,
    big_endian: bool,
    /// Whether pages are channels, of which one was chosen.
    chosen: bool,
    /// What the first page says of all.
    pixel_size: Option<PixelSize>,
}

impl Pages {
    /// The pages of a file, of one channel where pages are channels; None if it is no TIFF.
    pub(super) fn open(path: &Path, channel: Option<&str>) -> Result<Option<Self>, IoError> {
        let refuse = |message: String| IoError::file(path, message);
        let unread =
            |error: std::io::Error| refuse(format!("cannot be read: {error}; a picture is needed"));
        let file = File::open(path).map_err(unread)?;
        let length = file.metadata().map_err(unread)?.len();
        let mut reader = BufReader::new(&file);
        let head = reader.fill_buf().map_err(unread)?;
        let heads = [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"];
        if !heads.iter().any(|known| head.starts_with(*known)) {
            return Ok(None);
        }
        let (wide, big_endian) = (head[2] == b'+' || head[3] == b'+', head[0] == b'M');
        let mut decoder = Decoder::new(&mut reader).map_err(|error| refuse(broken(error)))?;
        let (of_channel, pixel_size) = pages_of_channel(&mut decoder, channel).map_err(refuse)?;
        let mut heads = Vec::new();
        loop {
            heads.extend(decoder.ifd_pointer().map(|pointer| pointer.0));
            if !decoder.more_images() {
                break;
            }
            if heads.len() == MOST_PAGES {
                return Err(refuse(format!(
                    "has more than {MOST_PAGES} pages, which are the most"
                )));
            }
            if decoder.next_image().is_err() {
                // what follows is lost, and what was there is not
                heads.push(u64::MAX);
                break;
            }
        }
        if let Some((first, step)) = of_channel {
            heads = heads.into_iter().skip(first).step_by(step).collect();
        }
        let (path, chosen) = (path.to_owned(), of_channel.is_some());
        Ok(Some(Self {
            path,
            file,
            length,
            heads,
            wide,
            big_endian,
            chosen,
            pixel_size,
        }))
    }

    pub(super) const fn count(&self) -> usize {
        self.heads.len()
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// The picture of a page, from 0.
    pub(super) fn read(&mut self, page: usize, rule: &PictureReading) -> Result<Picture, String> {
        let head = self
            .heads
            .get(page)
            .copied()
            .filter(|&head| head < self.length);
        let head = head.ok_or("the file is cut or broken here; a whole one is needed")?;
        let mut offset = [0; 8];
        let (at, width) = if self.wide { (8, 8) } else { (4, 4) };
        if self.big_endian {
            offset = head.to_be_bytes();
            offset.rotate_left(8 - width);
        } else {
            offset[..width].copy_from_slice(&head.to_le_bytes()[..width]);
        }
        let view = View {
            file: &mut self.file,
            place: 0,
            patch: (at, &offset[..width]),
        };
        let mut view = BufReader::new(view);
        view.rewind()
            .map_err(|error| format!("cannot be read: {error}"))?;
        let channel = rule.channel.clone().filter(|_| !self.chosen);
        let rule = PictureReading {
            page: Some(1),
            channel,
            ..rule.clone()
        };
        let mut picture = decode_tiff(&mut view, self.length, &rule)?;
        picture.take_pixel_size(self.pixel_size.as_ref());
        Ok(picture)
    }
}

/// A file whose head leads to another page than its first.
#[derive(Debug)]
struct View<'a> {
    file: &'a mut File,
    place: u64,
    /// Where bytes are others than those of the file, and which.
    patch: (u64, &'a [u8]),
}

impl View<'_> {
    /// Put the patch into bytes that stand at the place.
    fn patched(&self, bytes: &mut [u8]) {
        let (begin, patch) = self.patch;
        for (at, byte) in (begin..).zip(patch) {
            let own = at
                .checked_sub(self.place)
                .and_then(|at| usize::try_from(at).ok());
            if let Some(old) = own.and_then(|at| bytes.get_mut(at)) {
                *old = *byte;
            }
        }
    }
}

impl Read for View<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.file.read(buffer)?;
        self.patched(&mut buffer[..count]);
        self.place += count as u64;
        Ok(count)
    }
}

impl Seek for View<'_> {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.place = self.file.seek(to)?;
        Ok(self.place)
    }
}
