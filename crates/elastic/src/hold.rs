//! What a node may do: anything, slide along a line, or nothing.
//!
//! Energy, force and matrix say what a deformation costs; they do not say what may move. A line that a node
//! must stay on (the border of the image, the tangent of another curve) changes no elastic number, for K acts on x
//! and y alike; it takes one of the two directions away. Whoever moves the nodes therefore
//!
//! 1. projects the force and the velocity of the node before each step, and so cannot leave the line;
//! 2. puts the node back on the line after the step if the line is curved, and turns the direction;
//! 3. in an implicit step adds one unknown a sliding node, the push of the line along its normal ν. With `u`
//!    the solution of `A u = 1` at that node and `x` that of the free step, the push is
//!    `−(ν·x) / u[i]`, and `x` gains it times `u ν`: one more solve with the factor one has.
//!
//! A line projects without friction; rubbing against it is not here yet.

use crate::{End, Topology};
use glam::DVec2;

/// What a node may do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Hold {
    /// Move.
    Free,
    /// Slide along a line of this direction, of any length; a direction of no length holds still.
    Along(DVec2),
    /// Stay.
    Still,
}

impl Hold {
    /// The part of a force, velocity or displacement that the node is left with.
    ///
    /// ```text
    /// v,   d (d·v) / (d·d),   0
    /// ```
    ///
    /// Twice is once: the orthogonal projection onto what may move. The part taken away is the push of the
    /// constraint, square to the motion, so that it does no work.
    ///
    /// ```
    /// use elastic::Hold;
    /// use glam::DVec2;
    ///
    /// let border = Hold::Along(DVec2::new(0.0, 7.0));
    /// assert_eq!(border.project(DVec2::new(3.0, -2.0)), DVec2::new(0.0, -2.0));
    /// ```
    #[must_use]
    pub fn project(self, v: DVec2) -> DVec2 {
        match self {
            Self::Free => v,
            Self::Along(direction) => {
                // by its larger part first: squares of huge and tiny numbers are no numbers
                let size = direction.abs().max_element();
                if size == 0.0 {
                    return DVec2::ZERO;
                }
                let unit = (direction / size).normalize();
                unit.dot(v) * unit
            }
            Self::Still => DVec2::ZERO,
        }
    }
}

impl From<End> for Hold {
    /// What an end does to its own node: [pinned](End::Pinned) and [clamped](End::Clamped) ends hold it still.
    fn from(end: End) -> Self {
        match end {
            End::Free | End::Anchored => Self::Free,
            End::Pinned | End::Clamped => Self::Still,
        }
    }
}

impl Topology {
    /// What the ends do to the first and the last node: the two-dimensional word for
    /// [`held`](Self::held).
    #[must_use]
    pub fn holds(self) -> (Hold, Hold) {
        match self {
            Self::Closed => (Hold::Free, Hold::Free),
            Self::Open { head, tail } => (head.into(), tail.into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_keeps_what_is_along_it_whatever_its_length_and_side() {
        for scale in [1.0, -3.0, 1e-200, 1e200] {
            let slide = Hold::Along(scale * DVec2::new(3.0, 4.0));
            let kept = slide.project(DVec2::new(5.0, 10.0));
            // (3·5 + 4·10)/5 = 11 along (0.6, 0.8)
            assert!((kept - DVec2::new(6.6, 8.8)).length() < 1e-14, "{kept}");
            assert!((slide.project(kept) - kept).length() < 1e-14);
        }
        assert_eq!(Hold::Along(DVec2::ZERO).project(DVec2::ONE), DVec2::ZERO);
        assert_eq!(Hold::Still.project(DVec2::ONE), DVec2::ZERO);
        assert_eq!(Hold::Free.project(DVec2::ONE), DVec2::ONE);
    }

    #[test]
    fn what_the_ends_hold_is_what_the_mask_says() {
        for end in [End::Free, End::Anchored, End::Pinned, End::Clamped] {
            let topology = Topology::Open {
                head: end,
                tail: End::Free,
            };
            assert_eq!(topology.holds().0 == Hold::Still, topology.held(3)[0]);
            assert_eq!(topology.holds().1, Hold::Free);
        }
        assert_eq!(Topology::Closed.holds(), (Hold::Free, Hold::Free));
    }
}
