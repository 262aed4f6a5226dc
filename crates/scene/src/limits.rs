//! How much a scene may ask for, in one place, each with its reason; what a file may ask for stands
//! in [`io::limits`].
//!
//! A program that is handed a text by a stranger must not be talked into hours or gigabytes. Every
//! bound is far above what the work needs, and the message of a refusal says what it is.

pub(crate) use io::limits::{FARTHEST, MOST_NODES};

/// Snakes of a scene.
pub(crate) const MOST_SNAKES: usize = 10_000;

/// Nodes of all snakes of a scene together, some hundred bytes each.
pub(crate) const MOST_IN_ALL: usize = 1 << 21;

/// Snakes times forces and walls of each: every snake has its own list of them.
pub(crate) const MOST_FORCES: usize = 1 << 20;

/// Pixels up to which a scene's field is made as a whole, in doubles, unless it says otherwise: 2048 × 2048.
pub(crate) const USUALLY_WHOLE: u64 = 1 << 22;

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
