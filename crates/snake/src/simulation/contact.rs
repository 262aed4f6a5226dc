//! Snakes that touch: a stiff layer with damping and friction around every curve.

use glam::DVec2;
use outline::{Near, Neighbours};

use super::glue::Glue;
use super::kick::{Half, Turn, brake, push};
use super::passage::{Passage, Tally};
use super::{Member, RuleKey, SimulationError};

/// What happens where curves meet.
///
/// ```text
/// E = ½ k Σ h d²,   d = gap − (distance to the other curve, negative inside) > 0
/// ```
///
/// over the nodes of either curve; the push on a node is taken back from the two nodes of the edge it meets, by
/// its lever, so momentum is kept, and angular momentum too but for friction across a gap. A single node of speed v goes
/// in by at most `v √(μ/k)`; with a body behind it it goes deeper, until at `stop` an impulse takes all that is left of the
/// approach. So the overlap stays below `stop` by more than the way of one step only where more bodies push
/// than a few rounds of impulses can settle.
///
/// *Adhesion* makes curves share a border: either side has the energy `φ` per length of curve as it is,
///
/// ```text
/// φ = −W/2 (1 − u²)²,   u = (distance − gap) / range, at least 0            E = Σ l φ
/// ```
///
/// so at rest they lie a gap apart, and the tension of a shared border is less by W than that of both curves alone. Where two equal
/// bags of tension T part, each is bent by θ from the border with `cos θ = 1 − W / 2T` (Young's equation, \[young05\]).
/// A node near several curves adheres to the one that holds it most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// k. M T⁻².
    pub stiffness: f64,
    /// c: takes energy from approach and parting. M T⁻¹.
    pub damping: f64,
    /// Coulomb's coefficient between curves. 0, the usual value: they slip without loss.
    pub friction: f64,
    /// Coulomb's coefficient at walls that push back ([`WallLaw::Penalty`](crate::WallLaw::Penalty)).
    pub wall_friction: f64,
    /// How stiffly friction holds before it slips, as a share of what holds the normal apart: 0 to 1. 0: friction
    /// brakes slip alone, and what should stick creeps.
    pub stick: f64,
    /// Curves push each other from this distance on. L. Open ones, which have no inside, need some.
    pub gap: f64,
    /// W: energy that two curves gain per length of border that they share. They are drawn to each other within the range
    /// beyond the gap. M L² T⁻².
    pub adhesion: f64,
    /// How far beyond the gap adhesion reaches. L.
    pub range: f64,
    /// Overlap at which the approach ends. L.
    pub stop: f64,
    /// Whether far stretches of the same curve push each other too, from the gap on.
    pub own: bool,
}

/// How many times as deep as the stop a node is still found.
const FOUND: f64 = 4.0;

/// Rounds of impulses between curves that are too deep in each other.
const ROUNDS: usize = 8;

/// A node and the edge it meets.
#[derive(Debug, Clone, Copy)]
pub(super) struct Meeting {
    pub curve: usize,
    pub node: usize,
    pub other: usize,
    /// The edge's two nodes and the share of the second.
    pub ends: [usize; 2],
    pub along: f64,
    /// Above 0.
    pub depth: f64,
    /// How much of the depth pushes: all but what came by a jump.
    pub felt: f64,
    /// From the edge to where the node should be.
    pub way: DVec2,
    /// From the point of the edge to the node.
    pub apart: DVec2,
    /// ξ: how far friction has been stretched, along `way.perp()`.
    pub slip: f64,
}

/// All meetings of a moment.
#[derive(Debug, Clone, Default)]
pub(super) struct Meetings {
    neighbours: Neighbours,
    found: Vec<Near>,
    list: Vec<Meeting>,
    /// The list of the step before, in the same order: by curve, node and other curve.
    before: Vec<Meeting>,
    kicked: Vec<bool>,
    glue: Glue,
    push: Vec<Vec<DVec2>>,
    /// Where the nodes were when last looked for, if what happens since is counted.
    places: Option<Vec<Vec<DVec2>>>,
}

impl Contact {
    /// Check every number.
    pub(super) fn validate(&self) -> Result<(), SimulationError> {
        let least = f64::MIN_POSITIVE;
        RuleKey::Stiffness.check(least, "above 0", self.stiffness)?;
        for (key, value) in [
            (RuleKey::Damping, self.damping),
            (RuleKey::Friction, self.friction),
            (RuleKey::WallFriction, self.wall_friction),
            (RuleKey::Adhesion, self.adhesion),
            (RuleKey::Range, self.range),
            (RuleKey::Gap, self.gap),
        ] {
            key.check(0.0, "at least 0", value)?;
        }
        let (bound, stick) = ("from 0 to 1", self.stick);
        RuleKey::Stick.check(0.0, bound, stick)?;
        if stick > 1.0 {
            let (key, value) = (RuleKey::Stick, stick);
            return Err(SimulationError::Rule { key, bound, value });
        }
        RuleKey::Stop.check(least, "above 0", self.stop)
    }

    /// Push of a layer that feels this depth, per length of curve.
    pub(super) fn press(&self, felt: f64) -> f64 {
        self.stiffness * felt
    }

    /// How far friction of that coefficient stretches at a depth before it slips.
    pub(super) fn holds(&self, friction: f64, depth: f64) -> f64 {
        if self.stick > 0.0 {
            friction * depth / self.stick
        } else {
            0.0
        }
    }

    /// The largest step where no node has less mass than `least` and no edge is longer than `stretch` times its
    /// spacing: a node pushed from two sides, by its own layer and the other's, on both.
    pub(super) fn step_limit(&self, least: f64, stretch: f64) -> f64 {
        let glue = if self.adheres() {
            4.0 * self.adhesion * stretch / (self.range * self.range)
        } else {
            0.0
        };
        // half a kick twice a step is the leapfrog: dt² k/μ < 4, with k up to eight times as large; what sticks is
        // no stiffer, across
        (4.0 * least / (8.0 * (self.stiffness + glue))).sqrt()
    }
}

impl Meetings {
    /// Find every node within the layer of another curve, so long after the last time; None: for the first
    /// time. Linear in the nodes. Answers what the contacts have done since then, if that is counted.
    ///
    /// A node deep inside whose nearest edge is suddenly another one, on another side, would have its energy jump.
    /// What depth it gains by more than its motion since then can explain does not push.
    pub(super) fn find(
        &mut self,
        contact: &Contact,
        members: &[Member],
        since: Option<f64>,
    ) -> Result<Tally, SimulationError> {
        std::mem::swap(&mut self.list, &mut self.before);
        self.list.clear();
        self.kicked.clear();
        self.kicked.resize(members.len(), false);
        let mut reach = contact.gap.max(FOUND * contact.stop);
        if contact.adheres() {
            reach = reach.max(contact.gap + contact.range);
            self.glue.clear(members);
        }
        let curves = members.iter().map(|m| (&m.state.x[..], m.is_closed()));
        self.neighbours
            .rebuild(curves, reach)
            .map_err(|error| SimulationError::Outline {
                member: members.first().map_or(0, |member| member.id),
                error,
            })?;
        // a curve that runs the other way round has its outside where its neighbours see the inside
        let turned: Vec<bool> = members
            .iter()
            .map(|m| m.is_closed() && elastic::signed_area(&m.state.x) < 0.0)
            .collect();
        let apart: Vec<usize> = members.iter().map(|m| apart(contact, m)).collect();
        let mut found = std::mem::take(&mut self.found);
        for (curve, member) in members.iter().enumerate() {
            for node in 0..member.state.len() {
                self.neighbours
                    .near_node(curve, node, apart[curve], reach, &mut found);
                outline::keep_nearest(&mut found);
                for near in &found {
                    let own = near.curve == curve;
                    if own && !contact.own {
                        continue;
                    }
                    let other = &members[near.curve];
                    let one_sided = other.is_closed() && !own;
                    let flip = if turned[near.curve] { -1.0 } else { 1.0 };
                    let (distance, way) = if one_sided {
                        (flip * near.signed(), flip * near.outward)
                    } else {
                        let away = member.state.x[node] - near.at;
                        (near.distance, away.try_normalize().unwrap_or(near.outward))
                    };
                    let depth = contact.gap - distance;
                    let n = other.state.len();
                    if contact.adheres() && !own {
                        let ends = [near.spot.edge, (near.spot.edge + 1) % n];
                        self.glue.see(contact, node, near, ends, distance, way);
                    }
                    if depth > 0.0 {
                        self.list.push(Meeting {
                            curve,
                            node,
                            other: near.curve,
                            ends: [near.spot.edge, (near.spot.edge + 1) % n],
                            along: near.spot.along,
                            depth,
                            felt: depth,
                            way,
                            apart: member.state.x[node] - near.at,
                            slip: 0.0,
                        });
                    }
                }
            }
            if contact.adheres() {
                self.glue.gather(curve, members);
            }
        }
        self.found = found;
        if let Some(dt) = since {
            self.smooth(contact, members, dt);
        }
        let places = self.places.take();
        let mut tally = Tally::default();
        if let (Some(from), Some(_)) = (&places, since) {
            let passage = Passage {
                contact,
                members,
                from,
                turned: &turned,
                apart: &apart,
            };
            tally = self.passed(&passage);
            if contact.adheres() {
                tally += self.glue.passed(&passage);
            }
        }
        self.places = places.map(|mut places| {
            places.resize_with(members.len(), Vec::new);
            for (place, member) in places.iter_mut().zip(members) {
                place.clone_from(&member.state.x);
            }
            places
        });
        Ok(tally)
    }

    /// Count what contacts do from the next search on, or no longer.
    pub(super) fn count(&mut self, counts: bool) {
        self.places = counts.then(Vec::new);
    }

    /// What all meetings of this moment and the one before have done in between.
    fn passed(&self, passage: &Passage<'_>) -> Tally {
        let key = |m: &Meeting| (m.curve, m.node, m.other);
        let (mut tally, mut old) = (Tally::default(), 0);
        for m in &self.list {
            while old < self.before.len() && key(&self.before[old]) < key(m) {
                tally += passage.meeting(Some(&self.before[old]), None);
                old += 1;
            }
            let same = self.before.get(old).filter(|b| key(b) == key(m));
            tally += passage.meeting(same, Some(m));
            old += usize::from(same.is_some());
        }
        for gone in &self.before[old..] {
            tally += passage.meeting(Some(gone), None);
        }
        tally
    }

    /// Take jumps out of what is felt, and let friction slip that is stretched too far.
    fn smooth(&mut self, contact: &Contact, members: &[Member], dt: f64) {
        let key = |m: &Meeting| (m.curve, m.node, m.other);
        let mut old = 0;
        for m in &mut self.list {
            while old < self.before.len() && key(&self.before[old]) < key(m) {
                old += 1;
            }
            let reach = 2.0 * dt * relative(m, members).length();
            let same = self.before.get(old).filter(|b| key(b) == key(m));
            let (felt, depth) = same.map_or((0.0, 0.0), |b| (b.felt, b.depth));
            if let Some(b) = same {
                let now = members[m.curve].state.x[m.node] - point(b, members);
                m.slip = b.slip + (now - b.apart).dot(m.way.perp());
            }
            old += usize::from(same.is_some());
            // what the depth has changed by, as far as motion explains it
            let change = (m.depth - depth).clamp(-reach, reach);
            m.felt = (felt + change).clamp(0.0, m.depth);
            let held = contact.holds(contact.friction, m.felt);
            m.slip = m.slip.max(-held).min(held);
        }
    }

    /// Push and brake for that long; what the pushes do and damping and friction take.
    ///
    /// The springs of all meetings act at once, damping and friction one meeting after the other, each on the velocities
    /// that those before it have left, so that none turns a slip round. At the start of a step braking comes first and at its
    /// end last: it sees the velocities between two steps, and nothing is lost where nothing moves.
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
            if matches!(turn, Turn::Push) && contact.adheres() {
                tally.work += self.glue.kick(members, time, &mut self.kicked);
            }
            for m in &self.list {
                match turn {
                    Turn::Push => tally.work += push(contact, members, m, time),
                    Turn::Brake => tally.lost += brake(contact, members, m, time),
                }
                self.kicked[m.curve] = true;
                self.kicked[m.other] = true;
            }
        }
        for _ in 0..ROUNDS {
            for m in &self.list {
                if m.depth > contact.gap + contact.stop {
                    tally.lost += brake(contact, members, m, 0.0);
                }
            }
        }
        tally
    }

    /// Whether that member was pushed by the last kick.
    pub(super) fn kicked(&self, member: usize) -> bool {
        self.kicked.get(member).copied().unwrap_or(false)
    }

    /// The push on every node of every member, per unit of arc length.
    pub(super) fn forces(&mut self, contact: &Contact, members: &[Member]) -> &mut [Vec<DVec2>] {
        self.push.resize_with(members.len(), Vec::new);
        for (push, member) in self.push.iter_mut().zip(members) {
            push.clear();
            push.resize(member.state.len(), DVec2::ZERO);
        }
        let spacing = |k: usize| members[k].snake.body().spacing;
        for m in &self.list {
            let hold = contact.stick * m.slip * m.way.perp();
            let force = contact.press(m.felt) * m.way - contact.stiffness * hold;
            self.push[m.curve][m.node] += force;
            // a force of one's length of curve, felt by the other's
            let share = spacing(m.curve) / spacing(m.other);
            self.push[m.other][m.ends[0]] -= share * (1.0 - m.along) * force;
            self.push[m.other][m.ends[1]] -= share * m.along * force;
        }
        if contact.adheres() {
            self.glue.add_forces(members, &mut self.push);
        }
        &mut self.push
    }

    /// What the layers hold.
    pub(super) fn energy(&self, contact: &Contact, members: &[Member]) -> f64 {
        let each = |m: &Meeting| {
            let held = contact.stick * m.slip * m.slip;
            members[m.curve].snake.body().spacing * (m.felt * m.felt + held)
        };
        let glue = if contact.adheres() {
            self.glue.energy()
        } else {
            0.0
        };
        0.5 * contact.stiffness * self.list.iter().map(each).sum::<f64>() + glue
    }

    /// How deep in the layer the deepest node is.
    pub(super) fn deepest(&self) -> f64 {
        self.list.iter().map(|m| m.depth).fold(0.0, f64::max)
    }
}

/// Velocity of the node against the edge.
pub(super) fn relative(m: &Meeting, members: &[Member]) -> DVec2 {
    let v = |curve: usize, node: usize| members[curve].state.v[node];
    v(m.curve, m.node) - (1.0 - m.along) * v(m.other, m.ends[0]) - m.along * v(m.other, m.ends[1])
}

/// The point of the edge that a meeting is at, where it is now.
fn point(m: &Meeting, members: &[Member]) -> DVec2 {
    let x = &members[m.other].state.x;
    (1.0 - m.along) * x[m.ends[0]] + m.along * x[m.ends[1]]
}

/// How many nodes away the same curve counts as another: twice what lies within the gap.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to a small positive range first"
)]
fn apart(contact: &Contact, member: &Member) -> usize {
    let within = contact.gap / member.snake.body().spacing;
    (2.0 * within).ceil().clamp(2.0, 1e6) as usize + 1
}
