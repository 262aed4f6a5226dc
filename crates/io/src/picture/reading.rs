//! How pictures are read.

/// How to read a picture. The default is its first page, upright, in all its colors.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct PictureReading {
    /// What becomes of pixels that are no finite numbers.
    pub invalid: Invalid,
    /// The page of a file of several, from 1.
    pub page: Option<usize>,
    /// The channel that is read alone: by its number from 1; as `red`, `green`, `blue` or `alpha`;
    /// or by the name that an OME-TIFF gives it. In a TIFF whose channels are pages (`ImageJ`, OME),
    /// pages are those of one channel.
    pub channel: Option<String>,
    /// Whether the picture is left as it is stored, however it says it is to be looked at.
    pub as_stored: bool,
}

/// What becomes of pixels that are no finite numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Invalid {
    /// The picture is refused.
    #[default]
    Refuse,
    /// They do not count.
    Mask,
}
