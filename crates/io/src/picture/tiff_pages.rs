//! How many pages a picture file has.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use tiff::decoder::Decoder;

use super::decode::broken;
use super::{Picture, tiff_size};
use crate::IoError;

/// Pages that are counted at most; those of longer stacks are read one by one.
const MOST_PAGES: usize = 1 << 16;

impl Picture {
    /// How many pages a file has for [`PictureReading::page`](super::PictureReading::page): those of a TIFF, of one
    /// channel where a channel is asked for and its pages are channels; 1 of any other file.
    ///
    /// # Errors
    ///
    /// A file that cannot be opened, a TIFF that is broken, or has more than 65536 pages.
    pub fn pages(path: &Path, channel: Option<&str>) -> Result<usize, IoError> {
        let refuse = |message: String| IoError::file(path, message);
        let file = File::open(path)
            .map_err(|error| refuse(format!("cannot be read: {error}; a picture is needed")))?;
        let mut file = BufReader::new(file);
        if !is_tiff(&mut file).map_err(|error| refuse(format!("cannot be read: {error}")))? {
            return Ok(1);
        }
        let mut decoder = Decoder::new(&mut file).map_err(|error| refuse(broken(error)))?;
        let channels = tiff_size::said(&mut decoder).channels.len().max(1);
        let mut pages = 1;
        while decoder.more_images() {
            if pages == MOST_PAGES {
                return Err(refuse(format!(
                    "has more than {MOST_PAGES} pages, which are the most"
                )));
            }
            decoder
                .next_image()
                .map_err(|error| refuse(broken(error)))?;
            pages += 1;
        }
        Ok(match channel {
            Some(_) => (pages / channels).max(1),
            None => pages,
        })
    }
}

fn is_tiff(file: &mut BufReader<File>) -> std::io::Result<bool> {
    use std::io::BufRead as _;
    let head = file.fill_buf()?;
    let heads = [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"];
    Ok(heads.iter().any(|known| head.starts_with(*known)))
}
