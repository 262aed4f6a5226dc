//! How many pages a picture file has.

use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, Seek};
use std::path::Path;

use tiff::decoder::Decoder;

use super::decode::broken;
use super::{Picture, PixelSize, tiff_size};
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
        let file = File::open(path).map_err(|error| {
            IoError::file(
                path,
                format!("cannot be read: {error}; a picture is needed"),
            )
        })?;
        count(BufReader::new(file), channel).map_err(|message| IoError::file(path, message))
    }

    /// [`Picture::pages`] from the bytes of a file of that name, for messages.
    ///
    /// # Errors
    ///
    /// As [`Picture::pages`].
    pub fn pages_named(bytes: &[u8], name: &Path, channel: Option<&str>) -> Result<usize, IoError> {
        count(Cursor::new(bytes), channel).map_err(|message| IoError::file(name, message))
    }
}

/// How many pages there are.
fn count(mut file: impl BufRead + Seek, channel: Option<&str>) -> Result<usize, String> {
    if !is_tiff(&mut file).map_err(|error| format!("cannot be read: {error}"))? {
        return Ok(1);
    }
    let mut decoder = Decoder::new(&mut file).map_err(broken)?;
    let channels = tiff_size::said(&mut decoder).channels.len().max(1);
    let mut pages = 1;
    while decoder.more_images() {
        if pages == MOST_PAGES {
            return Err(format!(
                "has more than {MOST_PAGES} pages, which are the most"
            ));
        }
        decoder.next_image().map_err(broken)?;
        pages += 1;
    }
    Ok(match channel {
        Some(_) => (pages / channels).max(1),
        None => pages,
    })
}

/// The first page of a channel and the step from one to the next, where pages are channels.
pub(crate) type Own = Option<(usize, usize)>;

/// Which pages are those of a channel, as the first and the step from one to the next where pages are channels; and
/// how large a pixel is.
///
/// # Errors
///
/// Pages without heads of their own; pages of several channels of which none is chosen, or of several slices at
/// several moments.
pub(crate) fn pages_of_channel<R: BufRead + Seek>(
    decoder: &mut Decoder<R>,
    channel: Option<&str>,
) -> Result<(Own, Option<PixelSize>), String> {
    let said = tiff_size::said(decoder);
    if said.images > 1 && !decoder.more_images() {
        return Err(format!(
            "holds {} pages behind one head, as ImageJ writes what is larger than 4 GiB; needed: a file with a head for \
             each page, or the frames as files",
            said.images
        ));
    }
    let (slices, moments) = said.stack;
    if slices > 1 && moments > 1 {
        return Err(format!(
            "holds {slices} slices at each of {moments} moments; needed: a file of one slice at each"
        ));
    }
    let of = match (said.channels.len(), channel) {
        (0, _) => None,
        (count, None) => {
            return Err(format!(
                "holds pages of {count} channels, {}; the name or the number of one is needed",
                crate::text::clip(&said.channels.join(", "))
            ));
        }
        (count, Some(wanted)) => Some((super::tiff_file::channel(wanted, &said.channels)?, count)),
    };
    Ok((of, said.pixel_size))
}

fn is_tiff(file: &mut impl BufRead) -> std::io::Result<bool> {
    let head = file.fill_buf()?;
    let heads = [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"];
    Ok(heads.iter().any(|known| head.starts_with(*known)))
}
