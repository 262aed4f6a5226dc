//! How much a file may ask for, in one place, each with its reason.
//!
//! A program that is handed a file by a stranger must not be talked into hours or gigabytes. Every
//! bound is far above what the work needs, and the message of a refusal says what it is.

/// Nodes a snake may have, and points a contour: more than twenty for every pixel of the outline of
/// the largest picture.
pub const MOST_NODES: usize = 1 << 20;

/// Coordinates go so far from zero, either way: a thousandth of where a run counts as blown up, and
/// far below where the square of a length overflows.
pub const FARTHEST: f64 = 1e9;

/// Pixels a picture of 8 or 16 bits may have, 23170 × 23170: kept as they came, 1 to 3 bytes each.
pub const MOST_PIXELS: u64 = 1 << 29;

/// Pixels a picture may have to be worked on as a whole, or with floats or deep colors, 11585 ×
/// 11585: all stages of a force together hold about a hundred bytes a pixel, so some 13 GB.
pub const MOST_WHOLE: u64 = 1 << 27;

/// Bytes of a picture that comes through a pipe and is read in any order.
pub(crate) const MOST_STREAM: u64 = 1 << 30;

/// Bytes of a contour file, enough for the most points at 17 digits with columns to spare.
pub(crate) const MOST_CONTOUR_BYTES: u64 = 256 << 20;

/// Points that the outlines of one file may have together, but for tables: 256 MiB of them.
pub(crate) const MOST_POINTS: usize = 1 << 24;

/// Outlines and rings of outlines in one file.
pub(crate) const MOST_SHAPES: usize = 1 << 21;

/// Pixels that the masks of one file may have together.
pub(crate) const MOST_TRACED: u64 = 1 << 29;

/// Values of a JSON, numbers in lists of numbers not counted: an outline takes ten to twenty.
pub(crate) const MOST_VALUES: usize = 1 << 24;

/// Refuse what there is no memory for, before any is filled: so many bytes are asked for and given
/// back.
///
/// # Errors
///
/// What they take, as the end of a sentence.
pub fn room(bytes: u64) -> Result<(), String> {
    let there = usize::try_from(bytes).is_ok_and(|bytes| {
        let mut list: Vec<u8> = Vec::new();
        list.try_reserve_exact(bytes).is_ok() && list.capacity() >= bytes
    });
    if there {
        return Ok(());
    }
    Err(format!(
        "takes {} MiB, more than there is room for",
        bytes >> 20
    ))
}
