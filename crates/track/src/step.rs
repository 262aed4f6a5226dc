//! What an object is followed into, and what that has said of it.

use field::Pixels;
use flow::Pyramid;

use crate::predict::Prediction;

/// A frame: its pixels and the sizes in which flow sees it and the one before.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Frame<'a> {
    pub pixels: &'a dyn Pixels,
    pub pyramid: &'a Pyramid,
    pub before: Option<&'a Pyramid>,
}

/// How an object is known in a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum State {
    /// It was seen.
    Seen,
    /// Part of it was seen: the rest goes on as the shape that is remembered.
    Partly,
    /// It was not seen and goes on as it was going.
    Coasting,
    /// It has left the frame and is waited for where it left.
    Left,
}

impl State {
    /// Whether anything of it was seen.
    #[must_use]
    pub const fn is_seen(self) -> bool {
        matches!(self, Self::Seen | Self::Partly)
    }
}

/// What a frame has said of an object.
#[derive(Debug, Clone)]
pub(crate) struct Step {
    pub prediction: Prediction,
    /// Evidence against the reference.
    pub confidence: f64,
    pub state: State,
    /// Whether the number of nodes has changed.
    pub remeshed: bool,
}

/// What is said of an object that has begun.
impl Step {
    pub(crate) const fn begun() -> Self {
        Self {
            prediction: Prediction::Still,
            confidence: 1.0,
            state: State::Seen,
            remeshed: false,
        }
    }
}
