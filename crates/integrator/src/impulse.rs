//! What a touch does to the velocity of one node, and how velocities and positions of a scheme belong together.

use glam::DVec2;

use crate::{Response, Touch};

/// The end of a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moment {
    /// Its time.
    pub(crate) t: f64,
    /// How long the step was.
    pub(crate) dt: f64,
    /// How far the velocities are behind the positions.
    pub(crate) pace: Pace,
}

impl Moment {
    /// How far the velocities are behind the positions.
    pub(crate) fn lag(self) -> f64 {
        match self.pace {
            Pace::Together { .. } => 0.0,
            Pace::Catching | Pace::Late => 0.5 * self.dt,
        }
    }

    /// How far a node is moved in a step by a force that changes its velocity by 1.
    pub(crate) fn way(self) -> f64 {
        match self.pace {
            Pace::Together { way } => way * self.dt,
            Pace::Catching | Pace::Late => self.dt,
        }
    }
}

/// How velocities and positions of a scheme belong together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Pace {
    /// At the same time. A constant force that changes the velocity by Δv in a step has moved the node
    /// by `way · dt · Δv`: ½, or 1 in Euler's methods.
    Together { way: f64 },
    /// The velocity is half a step late, and receives the second half of the forces after the touch.
    Catching,
    /// The velocity is always half a step late.
    Late,
}

/// What friction does to a velocity, for an impulse across of `pressed`.
pub(crate) fn friction(touch: &Touch, v: DVec2, pressed: f64) -> DVec2 {
    let Response::Impact { friction, .. } = touch.response else {
        return DVec2::ZERO;
    };
    let along = v - touch.normal * v.dot(touch.normal);
    let slip = along.length();
    if friction > 0.0 && pressed > 0.0 && slip > 0.0 {
        -along * ((friction * pressed).min(slip) / slip)
    } else {
        DVec2::ZERO
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn touch(restitution: f64, friction: f64) -> Touch {
        Touch {
            node: 0,
            position: DVec2::ZERO,
            normal: DVec2::X,
            response: Response::Impact {
                restitution,
                friction,
            },
        }
    }

    #[test]
    fn friction_takes_its_share_of_the_impulse_across() {
        // from −4 to 2 across: an impulse of 6, friction at most 0.6 of it, 3.0 − 0.6
        let v = DVec2::new(-4.0, 3.0);
        let after = v + friction(&touch(0.5, 0.1), v, 6.0);
        assert!((after - DVec2::new(-4.0, 2.4)).length() < 1e-14);
    }

    #[test]
    fn friction_counts_the_impulse_that_was_given_and_not_the_one_asked_for() {
        // the speed away was lowered to 1: the impulse is 5
        let v = DVec2::new(-4.0, 3.0);
        let after = v + friction(&touch(0.5, 0.1), v, 5.0);
        assert!((after - DVec2::new(-4.0, 2.5)).length() < 1e-14);
    }

    #[test]
    fn strong_friction_stops_the_slip_and_does_not_turn_it_round() {
        let v = DVec2::new(-4.0, 3.0);
        let after = v + friction(&touch(0.0, 5.0), v, 4.0);
        assert!((after - DVec2::new(-4.0, 0.0)).length() < 1e-15);
    }

    #[test]
    fn a_node_that_leaves_already_keeps_its_velocity() {
        let v = DVec2::new(4.0, 3.0);
        assert_eq!(friction(&touch(0.5, 0.1), v, 0.0), DVec2::ZERO);
    }
}
