//! What is open: nothing, a scene, or pictures.

use crate::pictures::Pictures;
use crate::sandbox::Sandbox;

/// What is open.
#[derive(Debug, Clone, Default)]
pub(crate) enum Stage {
    /// Nothing yet.
    #[default]
    Empty,
    /// A scene in motion.
    Scene(Box<Sandbox>),
    /// A picture or a sequence with outlines.
    Pictures(Box<Pictures>),
}

impl Stage {
    /// One step of all that moves; false where nothing does.
    pub(crate) fn step(&mut self) -> bool {
        match self {
            Self::Empty => false,
            Self::Scene(scene) => scene.step(),
            Self::Pictures(pictures) => pictures.step(),
        }
    }

    /// Whether a step would change anything.
    pub(crate) fn moves(&self) -> bool {
        match self {
            Self::Empty => false,
            Self::Scene(scene) => scene.end().is_none(),
            Self::Pictures(pictures) => pictures.moves(),
        }
    }

    /// Steps in a second of looking.
    pub(crate) fn pace(&self) -> f64 {
        match self {
            Self::Empty => 1.0,
            Self::Scene(scene) => scene.pace(),
            Self::Pictures(pictures) => pictures.pace(),
        }
    }

    /// The word for it.
    pub(crate) const fn kind(&self) -> &'static str {
        match self {
            Self::Empty => "empty",
            Self::Scene(_) => "scene",
            Self::Pictures(_) => "picture",
        }
    }

    /// Everything that tells two states apart, as bytes.
    pub(crate) fn bytes(&self) -> Vec<u8> {
        let mut out = self.kind().as_bytes().to_vec();
        match self {
            Self::Empty => {}
            Self::Scene(scene) => scene.bytes(&mut out),
            Self::Pictures(pictures) => pictures.bytes(&mut out),
        }
        out
    }
}
