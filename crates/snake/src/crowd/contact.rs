//! Snakes that touch: a stiff layer with damping and friction around every curve.

use glam::DVec2;
use integrator::System;
use outline::{Near, Neighbours};

use super::{CrowdError, Member};
use crate::SnakeError;
use crate::error::finite_at_least;

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
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// k. M T⁻².
    pub stiffness: f64,
    /// c: takes energy from approach and parting. M T⁻¹.
    pub damping: f64,
    /// Coulomb's coefficient between curves.
    pub friction: f64,
    /// Curves push each other from this distance on. L. Open ones, which have no inside, need some.
    pub gap: f64,
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
struct Meeting {
    curve: usize,
    node: usize,
    other: usize,
    /// The edge's two nodes and the share of the second.
    ends: [usize; 2],
    along: f64,
    /// Above 0.
    depth: f64,
    /// How much of the depth pushes: all but what came by a jump.
    felt: f64,
    /// From the edge to where the node should be.
    way: DVec2,
}

/// All meetings of a moment.
#[derive(Debug, Default)]
pub(super) struct Meetings {
    neighbours: Neighbours,
    found: Vec<Near>,
    list: Vec<Meeting>,
    /// The list of the step before, in the same order: by curve, node and other curve.
    before: Vec<Meeting>,
    kicked: Vec<bool>,
    push: Vec<DVec2>,
}

impl Contact {
    /// Check every number.
    pub(super) fn validate(&self) -> Result<(), SnakeError> {
        finite_at_least(
            "the stiffness of contacts",
            f64::MIN_POSITIVE,
            "above 0",
            self.stiffness,
        )?;
        for (name, value) in [
            ("the damping of contacts", self.damping),
            ("the friction of contacts", self.friction),
            ("the gap of contacts", self.gap),
        ] {
            finite_at_least(name, 0.0, "at least 0", value)?;
        }
        let name = "the stop of contacts";
        finite_at_least(name, f64::MIN_POSITIVE, "above 0", self.stop).map(|_| ())
    }

    /// The largest step: a node pushed from two sides, by its own layer and the other's, on both.
    pub(super) fn step_limit(&self, members: &[Member]) -> f64 {
        let masses = members.iter().flat_map(|member| member.snake.mass());
        let least = masses.copied().fold(f64::INFINITY, f64::min);
        // half a kick twice a step is the leapfrog: dt² k/μ < 4, with k up to eight times as large
        (4.0 * least / (8.0 * self.stiffness)).sqrt()
    }
}

impl Meetings {
    /// Find every node within the layer of another curve, so long after the last time; None: for the first
    /// time. Linear in the nodes. Answers what was lost.
    ///
    /// A node deep inside whose nearest edge is suddenly another one, on another side, would have its energy jump.
    /// What depth it gains by more than its motion since then can explain does not push; the energy of what
    /// depth it loses so is lost.
    pub(super) fn find(
        &mut self,
        contact: &Contact,
        members: &[Member],
        since: Option<f64>,
    ) -> Result<f64, CrowdError> {
        std::mem::swap(&mut self.list, &mut self.before);
        self.list.clear();
        self.kicked.clear();
        self.kicked.resize(members.len(), false);
        let reach = contact.gap.max(FOUND * contact.stop);
        let curves = members.iter().map(|m| (&m.state.x[..], m.is_closed()));
        self.neighbours
            .rebuild(curves, reach)
            .map_err(|error| CrowdError::Outline {
                member: members.first().map_or(0, |member| member.id),
                error,
            })?;
        // a curve that runs the other way round has its outside where its neighbours see the inside
        let turned: Vec<bool> = members
            .iter()
            .map(|m| m.is_closed() && elastic::signed_area(&m.state.x) < 0.0)
            .collect();
        let mut found = std::mem::take(&mut self.found);
        for (curve, member) in members.iter().enumerate() {
            let apart = apart(contact, member);
            for node in 0..member.state.len() {
                self.neighbours
                    .near_node(curve, node, apart, reach, &mut found);
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
                    if depth > 0.0 {
                        let n = other.state.len();
                        self.list.push(Meeting {
                            curve,
                            node,
                            other: near.curve,
                            ends: [near.spot.edge, (near.spot.edge + 1) % n],
                            along: near.spot.along,
                            depth,
                            felt: depth,
                            way,
                        });
                    }
                }
            }
        }
        self.found = found;
        Ok(since.map_or(0.0, |dt| self.smooth(contact, members, dt)))
    }

    /// Take jumps out of what is felt; the energy that they took.
    fn smooth(&mut self, contact: &Contact, members: &[Member], dt: f64) -> f64 {
        let key = |m: &Meeting| (m.curve, m.node, m.other);
        let mut lost = 0.0;
        let mut old = 0;
        let energy = |m: &Meeting, felt: f64| {
            0.5 * contact.stiffness * members[m.curve].snake.body().spacing * felt * felt
        };
        for m in &mut self.list {
            while old < self.before.len() && key(&self.before[old]) < key(m) {
                lost += gone(&self.before[old], members, dt, &energy);
                old += 1;
            }
            let reach = 2.0 * dt * relative(m, members).length();
            let same = self.before.get(old).filter(|b| key(b) == key(m));
            let (felt, depth) = same.map_or((0.0, 0.0), |b| (b.felt, b.depth));
            old += usize::from(same.is_some());
            // what the depth has changed by, as far as motion explains it
            let change = (m.depth - depth).clamp(-reach, reach);
            m.felt = (felt + change).clamp(0.0, m.depth);
            let jump = felt + change - m.felt;
            if jump > 0.0 {
                lost += energy(m, m.felt + jump) - energy(m, m.felt);
            }
        }
        for m in &self.before[old..] {
            lost += gone(m, members, dt, &energy);
        }
        lost
    }

    /// Push for that long, meeting after meeting; what damping and friction take.
    ///
    /// Each sees the velocities that those before it have left, so that none turns a slip round.
    pub(super) fn kick(&mut self, contact: &Contact, members: &mut [Member], time: f64) -> f64 {
        self.kicked.fill(false);
        let mut lost = 0.0;
        for k in 0..self.list.len() {
            lost += self.push(contact, members, k, time);
        }
        for _ in 0..ROUNDS {
            for k in 0..self.list.len() {
                if self.list[k].depth > contact.gap + contact.stop {
                    lost += self.push(contact, members, k, 0.0);
                }
            }
        }
        lost
    }

    /// One meeting's push for that long; what of it is lost.
    fn push(&mut self, contact: &Contact, members: &mut [Member], k: usize, time: f64) -> f64 {
        let m = self.list[k];
        let [first, second] = m.ends;
        let shares = [1.0 - m.along, m.along];
        let lightness = |curve: usize, node: usize| {
            let member = &members[curve];
            if member.snake.held()[node] {
                0.0
            } else {
                1.0 / member.mass(node)
            }
        };
        let own = lightness(m.curve, m.node);
        let theirs = [lightness(m.other, first), lightness(m.other, second)];
        let total = own + shares[0] * shares[0] * theirs[0] + shares[1] * shares[1] * theirs[1];
        if total <= 0.0 {
            return 0.0;
        }
        let length = members[m.curve].snake.body().spacing;
        let relative = relative(&m, members);
        let normal = relative.dot(m.way);
        let push = contact.stiffness * m.felt * length * time;
        // the damper never pulls curves together, nor turns their motion round
        let damp = -contact.damping * length * time * normal;
        let most = normal.abs() / total;
        let mut damp = damp.clamp(-most, most).max(-push);
        if m.depth > contact.gap + contact.stop {
            // whatever is left of the approach
            damp = damp.max(-normal / total - push);
        }
        let slip = relative - normal * m.way;
        let speed = slip.length();
        let rub = if speed > 0.0 {
            let most = contact.friction * (push + damp);
            -slip / speed * most.min(speed / total)
        } else {
            DVec2::ZERO
        };
        let taken = damp * m.way + rub;
        let impulse = push * m.way + taken;
        members[m.curve].state.v[m.node] += own * impulse;
        for ((node, share), light) in m.ends.into_iter().zip(shares).zip(theirs) {
            members[m.other].state.v[node] -= share * light * impulse;
        }
        self.kicked[m.curve] = true;
        self.kicked[m.other] = true;
        -taken.dot(relative + 0.5 * total * impulse)
    }

    /// Whether that member was pushed by the last kick.
    pub(super) fn kicked(&self, member: usize) -> bool {
        self.kicked.get(member).copied().unwrap_or(false)
    }

    /// The push on every node of member `k`, per unit of arc length.
    pub(super) fn force_on(
        &mut self,
        contact: &Contact,
        k: usize,
        spacing: impl Fn(usize) -> f64,
        n: usize,
    ) -> &[DVec2] {
        self.push.clear();
        self.push.resize(n, DVec2::ZERO);
        for m in self.list.iter().filter(|m| m.curve == k || m.other == k) {
            let force = contact.stiffness * m.felt * m.way;
            if m.curve == k {
                self.push[m.node] += force;
            }
            if m.other == k {
                // a force of the other's length of curve, felt by this one's
                let share = spacing(m.curve) / spacing(k);
                self.push[m.ends[0]] -= share * (1.0 - m.along) * force;
                self.push[m.ends[1]] -= share * m.along * force;
            }
        }
        &self.push
    }

    /// What the layers hold.
    pub(super) fn energy(&self, contact: &Contact, members: &[Member]) -> f64 {
        let each = |m: &Meeting| members[m.curve].snake.body().spacing * m.felt * m.felt;
        0.5 * contact.stiffness * self.list.iter().map(each).sum::<f64>()
    }

    /// How deep in the layer the deepest node is.
    pub(super) fn deepest(&self) -> f64 {
        self.list.iter().map(|m| m.depth).fold(0.0, f64::max)
    }
}

/// Velocity of the node against the edge.
fn relative(m: &Meeting, members: &[Member]) -> DVec2 {
    let v = |curve: usize, node: usize| members[curve].state.v[node];
    v(m.curve, m.node) - (1.0 - m.along) * v(m.other, m.ends[0]) - m.along * v(m.other, m.ends[1])
}

/// What the end of a meeting takes: nothing if it was on its way out.
fn gone(m: &Meeting, members: &[Member], dt: f64, energy: &impl Fn(&Meeting, f64) -> f64) -> f64 {
    let reach = 2.0 * dt * relative(m, members).length();
    if m.felt > reach {
        energy(m, m.felt)
    } else {
        0.0
    }
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
