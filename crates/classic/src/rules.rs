//! The parameters of a snake, by the names other programs have for them.

use crate::ClassicError;

/// What an end of an open snake does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Border {
    /// It moves, and nothing bends it.
    Free,
    /// It stays.
    Fixed,
}

/// Whether a snake is closed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Ends {
    /// The last point is beside the first.
    #[default]
    Periodic,
    /// It has a head and a tail.
    Open(Border, Border),
}

impl Ends {
    /// The ends of this name: `periodic`, `free`, `fixed`, or two of the latter with a hyphen between.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let border = |word: &str| match word {
            "free" => Some(Border::Free),
            "fixed" => Some(Border::Fixed),
            _ => None,
        };
        if name == "periodic" {
            return Some(Self::Periodic);
        }
        let (head, tail) = name.split_once('-').unwrap_or((name, name));
        Some(Self::Open(border(head)?, border(tail)?))
    }
}

/// How a snake moves. The default is that of scikit-image's `active_contour`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rules {
    /// Tension: how fast it shrinks. Levels.
    pub alpha: f64,
    /// Rigidity: how smooth it is. Levels.
    pub beta: f64,
    /// Weight of the level: above 0 bright places attract. 1.
    pub w_line: f64,
    /// Weight of the size of the Sobel gradient: above 0 edges attract. 1.
    pub w_edge: f64,
    /// The inverse of the step in time. Levels a pixel².
    pub gamma: f64,
    /// The longest way of a point in a step along each axis. Pixels.
    pub max_px_move: f64,
    /// Steps at most.
    pub max_num_iter: u64,
    /// A snake no point of which has moved farther in ten steps may be at rest. Pixels.
    pub convergence: f64,
    /// Whether it is closed.
    pub ends: Ends,
}

impl Default for Rules {
    fn default() -> Self {
        Self {
            alpha: 0.01,
            beta: 0.1,
            w_line: 0.0,
            w_edge: 1.0,
            gamma: 0.01,
            max_px_move: 1.0,
            max_num_iter: 2500,
            convergence: 0.1,
            ends: Ends::Periodic,
        }
    }
}

impl Rules {
    pub(crate) fn check(&self) -> Result<(), ClassicError> {
        let finite = [
            ("alpha", self.alpha),
            ("beta", self.beta),
            ("w_line", self.w_line),
            ("w_edge", self.w_edge),
        ];
        for (name, got) in finite {
            if !got.is_finite() {
                let needed = "finite";
                return Err(ClassicError::Rule { name, needed, got });
            }
        }
        for (name, got) in [("gamma", self.gamma), ("max_px_move", self.max_px_move)] {
            if !(got.is_finite() && got > 0.0) {
                let needed = "finite and above 0";
                return Err(ClassicError::Rule { name, needed, got });
            }
        }
        if self.convergence.is_nan() || self.convergence < 0.0 {
            let (name, needed, got) = ("convergence", "at least 0", self.convergence);
            return Err(ClassicError::Rule { name, needed, got });
        }
        Ok(())
    }
}
