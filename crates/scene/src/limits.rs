//! How much a text or a file may ask for, in one place, each with its reason.
//!
//! A program that is handed a file by a stranger must not be talked into hours or gigabytes. Every
//! bound is far above what the work needs, and the message of a refusal says what it is.

/// Snakes of a scene.
pub(crate) const MOST_SNAKES: usize = 10_000;

/// Nodes a snake may have, and points a contour: more than twenty for every pixel of the outline of
/// the largest picture.
pub(crate) const MOST_NODES: usize = 1 << 20;

/// Nodes of all snakes of a scene together, some hundred bytes each.
pub(crate) const MOST_IN_ALL: usize = 1 << 21;

/// Snakes times forces and walls of each: every snake has its own list of them.
pub(crate) const MOST_FORCES: usize = 1 << 20;

/// Coordinates go so far from zero, either way: a thousandth of where a run counts as blown up, and
/// far below where the square of a length overflows.
pub(crate) const FARTHEST: f64 = 1e9;

/// Pixels a picture of 8 or 16 bits may have, 23170 × 23170: kept as they came, 1 to 3 bytes each.
pub(crate) const MOST_PIXELS: u64 = 1 << 29;

/// Pixels a picture may have to be worked on as a whole, or with floats or deep colors, 11585 × 11585: all stages of a force
/// together hold about a hundred bytes a pixel, so some 13 GB.
pub(crate) const MOST_WHOLE: u64 = 1 << 27;

/// Pixels up to which a scene's field is made as a whole, in doubles, unless it says otherwise: 2048 × 2048.
pub(crate) const USUALLY_WHOLE: u64 = 1 << 22;

/// Bytes of a picture that comes through a pipe and is read in any order.
pub(crate) const MOST_STREAM: u64 = 1 << 30;

/// Refuse what there is no memory for, before any is filled: so many bytes are asked for and given back.
pub(crate) fn room(bytes: u64) -> Result<(), String> {
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

/// Pixels a drawn picture may have, 2048 × 2048: as large as any experiment asks for, and a few bytes
/// of text cost a second at most.
pub(crate) const MOST_DRAWN: u64 = 1 << 22;

/// Corners of a drawn road: each pixel asks every stretch.
pub(crate) const MOST_CORNERS: usize = 64;

/// Steps of a run: days of work for the smallest snake.
pub(crate) const MOST_STEPS: u64 = 1_000_000_000;

/// Sub-steps between two outputs: minutes of work.
pub(crate) const MOST_SUBSTEPS: u64 = 10_000_000;

/// Points and velocities a record may keep: 2 GiB.
pub(crate) const MOST_KEPT: u64 = 1 << 27;

/// Bytes of a scene's text, enough to write every node of the largest snake out.
pub(crate) const MOST_SCENE_BYTES: u64 = 64 << 20;

/// Values of a scene's text: nodes of the largest snake, each a list of two numbers.
pub(crate) const MOST_VALUES: usize = 1 << 22;

/// Bytes of a contour file, enough for the most points at 17 digits with columns to spare.
pub(crate) const MOST_CONTOUR_BYTES: u64 = 256 << 20;
