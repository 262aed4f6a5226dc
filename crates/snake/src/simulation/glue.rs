//! Adhesion: curves that gain energy by a shared border.

use glam::DVec2;
use integrator::System;
use outline::Near;

use super::passage::{Passage, Tally};
use super::{Contact, Member};

/// A node within the range of another curve.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stuck {
    node: usize,
    pub other: usize,
    pub ends: [usize; 2],
    along: f64,
    way: DVec2,
    /// Energy per length of curve as it is, below 0, and its slope outwards.
    pub energy: f64,
    slope: f64,
}

/// All that adheres at a moment: forces on nodes, not per length, and the energy.
#[derive(Debug, Clone, Default)]
pub(super) struct Glue {
    /// Of the member looked at last.
    stuck: Vec<Stuck>,
    /// Of all of them, by curve and node; and of the moment before.
    all: Vec<(usize, Stuck)>,
    before: Vec<(usize, Stuck)>,
    of_node: Vec<f64>,
    forces: Vec<Vec<DVec2>>,
    energy: f64,
}

impl Contact {
    /// Energy of one side of a border, so far from where it begins, and its slope.
    pub(super) fn side(&self, beyond: f64) -> (f64, f64) {
        let full = -0.5 * self.adhesion;
        if beyond <= 0.0 {
            return (full, 0.0);
        }
        let u = beyond / self.range;
        if u >= 1.0 {
            return (0.0, 0.0);
        }
        let rest = 1.0 - u * u;
        (full * rest * rest, -4.0 * full * rest * u / self.range)
    }

    /// Whether anything adheres.
    pub(super) fn adheres(&self) -> bool {
        self.adhesion > 0.0 && self.range > 0.0
    }
}

impl Glue {
    /// Forget all; there are so many members.
    pub(super) fn clear(&mut self, members: &[Member]) {
        self.energy = 0.0;
        self.forces.resize_with(members.len(), Vec::new);
        for (force, member) in self.forces.iter_mut().zip(members) {
            force.clear();
            force.resize(member.state.len(), DVec2::ZERO);
        }
        self.stuck.clear();
        std::mem::swap(&mut self.all, &mut self.before);
        self.all.clear();
    }

    /// A node of the present member near another curve; of several the one that holds it most counts.
    pub(super) fn see(
        &mut self,
        contact: &Contact,
        node: usize,
        near: &Near,
        ends: [usize; 2],
        distance: f64,
        way: DVec2,
    ) {
        let (energy, slope) = contact.side(distance - contact.gap);
        if energy >= 0.0 {
            return;
        }
        let new = Stuck {
            node,
            other: near.curve,
            ends,
            along: near.spot.along,
            way,
            energy,
            slope,
        };
        match self.stuck.last_mut() {
            Some(last) if last.node == node => {
                if energy < last.energy {
                    *last = new;
                }
            }
            _ => self.stuck.push(new),
        }
    }

    /// Add up what holds member `k`, of whom all nodes were seen.
    ///
    /// ```text
    /// E = Σ lᵢ φᵢ,   lᵢ = ½ (|eᵢ₋₁| + |eᵢ|)
    /// ```
    ///
    /// so a node is drawn to the border by lᵢ φ', and φ is a tension of the edges, below 0.
    pub(super) fn gather(&mut self, k: usize, members: &[Member]) {
        if self.stuck.is_empty() {
            return;
        }
        let (x, closed) = (&members[k].state.x, members[k].is_closed());
        let n = x.len();
        let edges = if closed { n } else { n - 1 };
        self.of_node.clear();
        self.of_node.resize(n, 0.0);
        for stuck in &self.stuck {
            self.of_node[stuck.node] = stuck.energy;
        }
        for i in 0..edges {
            let j = (i + 1) % n;
            let edge = x[j] - x[i];
            let length = edge.length();
            let mean = 0.5 * (self.of_node[i] + self.of_node[j]);
            self.energy += mean * length;
            let pull = mean * edge.normalize_or_zero();
            self.forces[k][i] += pull;
            self.forces[k][j] -= pull;
        }
        self.all.extend(self.stuck.iter().map(|&stuck| (k, stuck)));
        for stuck in self.stuck.drain(..) {
            let i = stuck.node;
            let mut length = 0.0;
            if closed || i + 1 < n {
                length += 0.5 * x[i].distance(x[(i + 1) % n]);
            }
            if closed || i > 0 {
                length += 0.5 * x[i].distance(x[(i + n - 1) % n]);
            }
            let force = -length * stuck.slope * stuck.way;
            self.forces[k][i] += force;
            let other = &mut self.forces[stuck.other];
            other[stuck.ends[0]] -= (1.0 - stuck.along) * force;
            other[stuck.ends[1]] -= stuck.along * force;
        }
    }

    /// What adhesion has done since the moment before.
    pub(super) fn passed(&self, passage: &Passage<'_>) -> Tally {
        let key = |(curve, stuck): &(usize, Stuck)| (*curve, stuck.node);
        let (mut tally, mut old) = (Tally::default(), 0);
        let gone = |b: &(usize, Stuck)| passage.adhesion(key(b), Some(&b.1), None);
        for now in &self.all {
            while old < self.before.len() && key(&self.before[old]) < key(now) {
                tally += gone(&self.before[old]);
                old += 1;
            }
            let same = self.before.get(old).filter(|b| key(b) == key(now));
            tally += passage.adhesion(key(now), same.map(|b| &b.1), Some(&now.1));
            old += usize::from(same.is_some());
        }
        for b in &self.before[old..] {
            tally += gone(b);
        }
        tally
    }

    /// Pull for that long; the work of it.
    pub(super) fn kick(&self, members: &mut [Member], time: f64, kicked: &mut [bool]) -> f64 {
        let mut work = 0.0;
        for ((force, member), kicked) in self.forces.iter().zip(members).zip(kicked) {
            for (i, force) in force.iter().enumerate() {
                if *force != DVec2::ZERO && !member.snake.held()[i] {
                    let mass = member.mass(i);
                    let given = time * *force;
                    work += given.dot(member.state.v[i] + 0.5 / mass * given);
                    member.state.v[i] += time / mass * *force;
                    *kicked = true;
                }
            }
        }
        work
    }

    /// Add the pull on every node of every member, per unit of arc length.
    pub(super) fn add_forces(&self, members: &[Member], forces: &mut [Vec<DVec2>]) {
        for ((own, all), member) in self.forces.iter().zip(forces).zip(members) {
            let spacing = member.snake.body().spacing;
            for (all, own) in all.iter_mut().zip(own) {
                *all += *own / spacing;
            }
        }
    }

    /// What all borders have gained, below 0.
    pub(super) const fn energy(&self) -> f64 {
        self.energy
    }
}
