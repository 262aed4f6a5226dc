//! What can be asked of the engine: actions, which change what is there and are kept, and questions, which do not.

mod body;
mod outline;
mod question;

use serde::{Deserialize, Serialize};

pub use body::Body;
pub use outline::{Drawn, Outline};
pub use question::Question;

/// A place or a way: x and y.
pub type Pair = [f64; 2];

/// A change of what is open. Every one is kept, and a session is a list of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Action {
    /// Run.
    Play,
    /// Stand still.
    Pause,
    /// Make so many steps.
    Step {
        /// How many.
        steps: u32,
    },
    /// Go back by so many steps.
    Back {
        /// How many.
        steps: u32,
    },
    /// Run so many times as fast as usual.
    Speed {
        /// From 1/64 to 64.
        factor: f64,
    },
    /// Take the last change back.
    Undo,
    /// Make it again.
    Redo,
    /// Return to the start.
    Reset,
    /// Open a scene: a shipped one by its name, or one of one's own by its text. The files that a text names come with
    /// the message, one behind the other.
    Scene {
        /// Its name.
        name: String,
        /// Its text in TOML; None for a shipped scene.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        text: Option<String>,
        /// Names of those files as the text has them, and how many bytes each is long.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        files: Vec<(String, usize)>,
    },
    /// Open a picture, the bytes of whose file come with the message.
    Picture {
        /// The name of its file.
        name: String,
        /// Whether it is one more frame of the sequence that is open.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        frame: bool,
    },
    /// A change of a scene.
    Body(Body),
    /// A change of outlines in a picture.
    Outline(Outline),
    /// A change of a sequence.
    Frames(Frames),
}

impl Action {
    /// Open a shipped scene.
    #[must_use]
    pub fn shipped(name: &str) -> Self {
        Self::Scene {
            name: name.to_owned(),
            text: None,
            files: Vec::new(),
        }
    }
}

/// A change of a sequence of frames.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Frames {
    /// Show a frame.
    Go {
        /// Its number, from 0.
        frame: usize,
    },
    /// Follow the outlines of the frame that is shown into the frames behind it.
    Track {
        /// Whether objects may divide, and new ones appear: for cells and the like.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        births: bool,
    },
    /// Follow no further.
    Stop,
}

const fn yes() -> bool {
    true
}
