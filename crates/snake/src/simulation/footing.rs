//! Friction at walls that push back: the law of [`Contact`] with a wall in place of the other curve.

use glam::DVec2;
use integrator::System;

use super::kick::{Half, Turn};
use super::passage::{Tally, held};
use super::{Contact, Member};
use crate::{Wall, WallLaw};

/// A node behind a wall.
#[derive(Debug, Clone, Copy)]
struct Footing {
    curve: usize,
    node: usize,
    wall: usize,
    /// Where it is along the wall.
    place: f64,
    /// ξ: how far friction has been stretched.
    slip: f64,
}

/// All nodes behind walls that push back, in the order of curve, node and wall.
#[derive(Debug, Clone, Default)]
pub(super) struct Footings {
    list: Vec<Footing>,
    before: Vec<Footing>,
    kicked: Vec<bool>,
}

/// A wall that pushes, with the direction along it and its stiffness.
fn pushing(member: &Member, wall: usize) -> Option<(&Wall, DVec2, f64)> {
    let wall = member.snake.world().walls.get(wall)?;
    match wall.law() {
        WallLaw::Penalty { stiffness, .. } => Some((wall, wall.normal().perp(), stiffness)),
        WallLaw::Clamp | WallLaw::Impact { .. } => None,
    }
}

/// What a stretched hold has: `½ s k h ξ²`.
fn stored(contact: &Contact, members: &[Member], footing: &Footing) -> f64 {
    0.5 * share(contact, members, footing) * footing.slip * footing.slip
}

/// `s k h`.
fn share(contact: &Contact, members: &[Member], footing: &Footing) -> f64 {
    let member = &members[footing.curve];
    let stiffness = pushing(member, footing.wall).map_or(0.0, |(.., k)| k);
    let spacing = member.snake.body().spacing;
    contact.stick * stiffness * spacing
}

/// What a hold has done that ended since, all of it lost.
fn ended(contact: &Contact, members: &[Member], footing: &Footing) -> Tally {
    let member = &members[footing.curve];
    let x = member.state.x[footing.node];
    let slid =
        pushing(member, footing.wall).map_or(0.0, |(_, along, _)| x.dot(along) - footing.place);
    let stiffness = share(contact, members, footing);
    held(stiffness, footing.slip, footing.slip + slid, 0.0)
}

impl Footings {
    /// Find every node behind a wall; what holds have done since the last time. With `fresh` all take hold anew.
    pub(super) fn find(&mut self, contact: &Contact, members: &[Member], fresh: bool) -> Tally {
        std::mem::swap(&mut self.list, &mut self.before);
        self.list.clear();
        self.kicked.clear();
        self.kicked.resize(members.len(), false);
        if contact.wall_friction <= 0.0 {
            return Tally::default();
        }
        let (mut old, mut tally) = (0, Tally::default());
        let key = |f: &Footing| (f.curve, f.node, f.wall);
        for (curve, member) in members.iter().enumerate() {
            for (node, &x) in member.state.x.iter().enumerate() {
                for index in 0..member.snake.world().walls.len() {
                    let Some((wall, along, _)) = pushing(member, index) else {
                        continue;
                    };
                    let depth = -wall.distance(x);
                    if depth <= 0.0 {
                        continue;
                    }
                    let mut new = Footing {
                        curve,
                        node,
                        wall: index,
                        place: x.dot(along),
                        slip: 0.0,
                    };
                    if !fresh {
                        while old < self.before.len() && key(&self.before[old]) < key(&new) {
                            tally += ended(contact, members, &self.before[old]);
                            old += 1;
                        }
                        let mut before = 0.0;
                        if let Some(b) = self.before.get(old).filter(|b| key(b) == key(&new)) {
                            before = b.slip;
                            new.slip = b.slip + new.place - b.place;
                            old += 1;
                        }
                        let most = contact.holds(contact.wall_friction, depth);
                        let slid = new.slip;
                        new.slip = slid.max(-most).min(most);
                        tally += held(share(contact, members, &new), before, slid, new.slip);
                    }
                    self.list.push(new);
                }
            }
        }
        if !fresh {
            for f in &self.before[old..] {
                tally += ended(contact, members, f);
            }
        }
        tally
    }

    /// Hold and brake for that long; what holding does and braking takes.
    pub(super) fn kick(
        &mut self,
        contact: &Contact,
        members: &mut [Member],
        time: f64,
        half: Half,
    ) -> Tally {
        self.kicked.fill(false);
        let mut tally = Tally::default();
        for turn in half.turns() {
            for f in &self.list {
                let member = &mut members[f.curve];
                let Some((wall, along, stiffness)) = pushing(member, f.wall) else {
                    continue;
                };
                if member.snake.held()[f.node] {
                    continue;
                }
                // all per length of curve
                let mass = member.snake.mass()[f.node];
                let hold = -contact.stick * stiffness * f.slip * time;
                let (x, v) = (member.state.x[f.node], member.state.v[f.node]);
                let slip = v.dot(along);
                let length = member.snake.body().spacing;
                let energy = |given: f64| length * given * (slip + 0.5 * given / mass);
                let given = match turn {
                    Turn::Push => {
                        tally.work += energy(hold);
                        hold
                    }
                    Turn::Brake => {
                        let most = contact.wall_friction * wall.force(x, v).length() * time;
                        let rub = if contact.stick > 0.0 {
                            let brake = (contact.damping * time).min(mass);
                            (hold - brake * slip).clamp(-most, most) - hold
                        } else {
                            -(mass * slip).clamp(-most, most)
                        };
                        tally.lost -= energy(rub);
                        rub
                    }
                };
                member.state.v[f.node] += given / mass * along;
                self.kicked[f.curve] = true;
            }
        }
        tally
    }

    /// Whether that member was kicked the last time.
    pub(super) fn kicked(&self, member: usize) -> bool {
        self.kicked.get(member).copied().unwrap_or(false)
    }

    /// Add what holds the nodes of every member, per unit of arc length.
    pub(super) fn add_forces(
        &self,
        contact: &Contact,
        members: &[Member],
        forces: &mut [Vec<DVec2>],
    ) {
        for f in &self.list {
            if let Some((_, along, stiffness)) = pushing(&members[f.curve], f.wall) {
                forces[f.curve][f.node] -= contact.stick * stiffness * f.slip * along;
            }
        }
    }

    /// What all holds have.
    pub(super) fn energy(&self, contact: &Contact, members: &[Member]) -> f64 {
        let each = |f: &Footing| stored(contact, members, f);
        self.list.iter().map(each).sum()
    }
}
