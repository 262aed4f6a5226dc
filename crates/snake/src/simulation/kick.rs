//! What one meeting does to velocities: its springs, and what brakes.

use glam::DVec2;
use integrator::System;

use super::contact::{Meeting, relative};
use super::{Contact, Member};

/// What a meeting acts on.
struct Lever {
    /// Velocities a unit impulse gives to the node and, per share, to the edge's.
    own: f64,
    theirs: [f64; 2],
    shares: [f64; 2],
    /// Change of the relative velocity by a unit impulse.
    total: f64,
    /// Length of curve that the node stands for.
    length: f64,
}

impl Lever {
    /// None where nothing can move.
    fn of(m: &Meeting, members: &[Member]) -> Option<Self> {
        let lightness = |curve: usize, node: usize| {
            let member = &members[curve];
            if member.snake.held()[node] {
                0.0
            } else {
                1.0 / member.mass(node)
            }
        };
        let shares = [1.0 - m.along, m.along];
        let own = lightness(m.curve, m.node);
        let theirs = m.ends.map(|node| lightness(m.other, node));
        let total = own + shares[0] * shares[0] * theirs[0] + shares[1] * shares[1] * theirs[1];
        let length = members[m.curve].snake.body().spacing;
        (total > 0.0).then_some(Self {
            own,
            theirs,
            shares,
            total,
            length,
        })
    }

    fn give(&self, m: &Meeting, members: &mut [Member], impulse: DVec2) {
        members[m.curve].state.v[m.node] += self.own * impulse;
        for k in 0..2 {
            members[m.other].state.v[m.ends[k]] -= self.shares[k] * self.theirs[k] * impulse;
        }
    }
}

/// The springs of one meeting, for that long; their work.
pub(super) fn push(contact: &Contact, members: &mut [Member], m: &Meeting, time: f64) -> f64 {
    let Some(lever) = Lever::of(m, members) else {
        return 0.0;
    };
    let hold = contact.stick * contact.stiffness * m.slip * m.way.perp();
    let given = time * lever.length * (contact.press(m.felt) * m.way - hold);
    let relative = relative(m, members);
    lever.give(m, members, given);
    given.dot(relative + 0.5 * lever.total * given)
}

/// Damping and friction of one meeting for that long, or the end of an approach at once; what they take.
pub(super) fn brake(contact: &Contact, members: &mut [Member], m: &Meeting, time: f64) -> f64 {
    let Some(lever) = Lever::of(m, members) else {
        return 0.0;
    };
    let (total, length) = (lever.total, lever.length);
    let relative = relative(m, members);
    let normal = relative.dot(m.way);
    let push = contact.press(m.felt) * length * time;
    // the damper never pulls curves together, nor turns their motion round
    let damp = -contact.damping * length * time * normal;
    let most = normal.abs() / total;
    let mut damp = damp.clamp(-most, most).max(-push);
    if m.depth > contact.gap + contact.stop {
        // whatever is left of the approach
        damp = damp.max(-normal / total);
    }
    let across = m.way.perp();
    let slip = relative.dot(across);
    let most = contact.friction * (push + damp);
    let rub = if contact.stick > 0.0 && time > 0.0 {
        let hold = -contact.stick * contact.stiffness * m.slip * length * time;
        let brake = (contact.damping * length * time).min(1.0 / total);
        (hold - brake * slip).clamp(-most, most) - hold
    } else {
        -slip.clamp(-most * total, most * total) / total
    };
    let taken = damp * m.way + rub * across;
    lever.give(m, members, taken);
    -taken.dot(relative + 0.5 * total * taken)
}

/// Which half of the pushes around a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Half {
    First,
    Second,
}

/// What is done in a half.
#[derive(Debug, Clone, Copy)]
pub(super) enum Turn {
    Push,
    Brake,
}

impl Half {
    /// The second half is the first backwards.
    pub(super) const fn turns(self) -> [Turn; 2] {
        match self {
            Self::First => [Turn::Brake, Turn::Push],
            Self::Second => [Turn::Push, Turn::Brake],
        }
    }
}
