//! Keeping curves fit to go on: spacing, crossings, and rest shapes that give way or grow.
//!
//! Everything here happens between two steps. What it does to energy is booked under `upkeep`.

use elastic::{Profile, Topology};
use glam::DVec2;
use integrator::State;
use outline::{Between, Lengths, Plan, Removal, Totals};

use super::run::around;
use super::{Entry, Member, RuleKey, Simulation, SimulationError, lightest};
use crate::rest::Verdict;
use crate::{Body, Snake, SnakeError};

/// What is looked after, and how often.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Upkeep {
    /// Steps between two looks; 0: never look.
    pub every: u64,
    /// Nodes are spaced anew when an edge is longer than this many times the spacing it began with, or
    /// shorter than one over it. At least 1.5. None: they stay.
    pub stretch: Option<f64>,
    /// Crossings of a closed curve are cut out, and pieces below this area dropped. L². None: they stay.
    pub least_area: Option<f64>,
    /// Closed curves deeper in each other than this become one. L. None: they stay two.
    pub merge: Option<f64>,
    /// Rest shapes that give way.
    pub plastic: Option<Plastic>,
    /// Rest shapes that grow: relative growth of length a unit of time. T⁻¹.
    pub growth: f64,
}

/// A rest shape that gives way, edge by edge.
///
/// Where an edge differs from its edge at rest by more than the yield strain, the rest shape follows:
///
/// ```text
/// ṙ' = rate · (|u − r'| − yield |r'|)⁺ · (u − r') / |u − r'|,    r' = rᵢ₊₁ − rᵢ,  u = xᵢ₊₁ − xᵢ
/// ```
///
/// and the edges are joined to a shape again, the gap of a closed one spread evenly. `yield` 0 is creep: all
/// memory fades with `rate`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plastic {
    /// Strain that leaves no trace. 1.
    pub yields_at: f64,
    /// How fast what is beyond it is forgotten. T⁻¹.
    pub rate: f64,
}

/// Something that happened to a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// When. T.
    pub t: f64,
    /// After so many steps.
    pub step: u64,
    /// To which snake.
    pub member: usize,
    /// What.
    pub kind: EventKind,
}

/// What can happen to a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum EventKind {
    /// It has another number of nodes, or they slid along it.
    Respaced {
        /// Nodes before.
        from: usize,
        /// Nodes after.
        to: usize,
    },
    /// Its nodes came closer together or farther apart, and from now on its steps are made in so many sub-steps each.
    Cut {
        /// Sub-steps of a step.
        cuts: u64,
    },
    /// A loop of it was cut off and dropped.
    LoopRemoved {
        /// Its signed area. L².
        area: f64,
    },
    /// It fell apart; the largest piece keeps the number.
    Split {
        /// Pieces.
        pieces: usize,
    },
    /// Another snake was taken into it.
    Merged {
        /// Which.
        with: usize,
    },
    /// Nothing of it is left.
    Vanished,
    /// One of its ends has stopped growing.
    Grown {
        /// Whether it is the head, the first node, or else the tail.
        head: bool,
        /// How many nodes the curve has.
        nodes: usize,
    },
}

impl Default for Upkeep {
    /// None at all.
    fn default() -> Self {
        Self {
            every: 0,
            stretch: None,
            least_area: None,
            merge: None,
            plastic: None,
            growth: 0.0,
        }
    }
}

impl Upkeep {
    pub(super) const fn is_due(&self, step: u64) -> bool {
        self.every > 0 && step.is_multiple_of(self.every)
    }

    pub(super) fn validate(&self) -> Result<(), SimulationError> {
        if let Some(stretch) = self.stretch {
            RuleKey::Stretch.check(1.5, "at least 1.5", stretch)?;
        }
        let least = "at least 0";
        if let Some(area) = self.least_area {
            RuleKey::LeastArea.check(0.0, least, area)?;
        }
        if let Some(depth) = self.merge {
            RuleKey::Merge.check(0.0, least, depth)?;
        }
        if let Some(plastic) = self.plastic {
            RuleKey::YieldsAt.check(0.0, least, plastic.yields_at)?;
            RuleKey::FlowRate.check(0.0, least, plastic.rate)?;
        }
        RuleKey::Growth.check(f64::MIN, "a rate", self.growth)
    }
}

/// A curve on its new nodes.
struct Renewed {
    body: Body,
    state: State,
    plan: Plan,
}

impl Simulation {
    /// Look after every curve once.
    pub(super) fn keep_up(&mut self) -> Result<(), SimulationError> {
        let before = if self.books.kept {
            self.energies().total()
        } else {
            0.0
        };
        let (upkeep, kept) = (self.upkeep, self.books.kept);
        if upkeep.plastic.is_some() || upkeep.growth.abs() > 0.0 {
            let time = self.stepping.dt * upkeep.every as f64;
            for member in &mut self.members {
                member.flow(&upkeep, time)?;
                member.resume()?;
            }
        }
        let mut changed = false;
        if let Some(least_area) = upkeep.least_area {
            changed |= self.untangle(least_area)?;
        }
        if let Some(depth) = upkeep.merge {
            changed |= self.merge(depth)?;
        }
        if let Some(stretch) = upkeep.stretch
            && self.respace(stretch)?
        {
            changed = true;
            // what is drawn through other nodes may cross where the old ones only came near
            if let Some(least_area) = upkeep.least_area {
                self.untangle(least_area)?;
            }
        }
        if changed {
            self.meet(None)?;
        }
        if kept {
            self.books.upkeep += before - self.energies().total();
        }
        Ok(())
    }

    pub(super) fn log(&mut self, member: usize, kind: EventKind) {
        let (t, step) = (self.t, self.step);
        self.events.push(Event {
            t,
            step,
            member,
            kind,
        });
    }

    /// Space the nodes of curves anew that have become too long or too short for theirs.
    fn respace(&mut self, stretch: f64) -> Result<bool, SimulationError> {
        let mut changed = false;
        for k in 0..self.members.len() {
            let member = &self.members[k];
            let (id, from) = (member.id, member.state.len());
            let Some(count) = member.wanted(stretch) else {
                continue;
            };
            let wrong = |error| SimulationError::Outline { member: id, error };
            let closed = member.is_closed();
            let plan = outline::slide(&member.state.x, closed, count, Between::Cubic);
            let plan = plan.map_err(wrong)?;
            let renewed = member.renewed(plan, Totals::Kept).map_err(wrong)?;
            self.put(k, renewed)?;
            self.log(id, EventKind::Respaced { from, to: count });
            changed = true;
        }
        Ok(changed)
    }

    /// Cut crossings out of closed curves.
    fn untangle(&mut self, least_area: f64) -> Result<bool, SimulationError> {
        let mut changed = false;
        let mut k = 0;
        while k < self.members.len() {
            let member = &self.members[k];
            let id = member.id;
            let wrong = |error| SimulationError::Outline { member: id, error };
            if !member.is_closed() {
                k += 1;
                continue;
            }
            let crossed = !outline::crossings(&member.state.x, true)
                .map_err(wrong)?
                .is_empty();
            if !crossed && elastic::signed_area(&member.state.x) >= least_area {
                k += 1;
                continue;
            }
            changed = true;
            let resolved = outline::resolve(&member.state.x, least_area).map_err(wrong)?;
            let mut pieces = Vec::new();
            for piece in &resolved.pieces {
                let plan = piece.plan(&[member.state.len()]).map_err(wrong)?;
                let totals = Totals::Handed;
                if plan.len() >= Topology::Closed.least_nodes() {
                    pieces.push(member.renewed(plan, totals).map_err(wrong)?);
                }
            }
            for event in &resolved.events {
                if let outline::Event::LoopRemoved { area, why } = *event
                    && why != Removal::Hole
                {
                    self.log(id, EventKind::LoopRemoved { area });
                }
            }
            if pieces.len() > 1 {
                self.log(
                    id,
                    EventKind::Split {
                        pieces: pieces.len(),
                    },
                );
                // what held the whole in shape says nothing of the parts
                for piece in &mut pieces {
                    piece.forget()?;
                }
            }
            let world = self.members[k].snake.world().clone();
            let mut pieces = pieces.into_iter();
            let Some(largest) = pieces.next() else {
                self.log(id, EventKind::Vanished);
                self.retire(k);
                continue;
            };
            self.put(k, largest)?;
            for piece in pieces {
                let mut world = world.clone();
                for acting in &mut world.forces {
                    acting.carry(&piece.plan);
                }
                self.join(Entry::new(Snake::new(piece.body, world)?, piece.state))?;
            }
            k += 1;
        }
        Ok(changed)
    }

    /// Make one of closed curves that are deep in each other.
    fn merge(&mut self, depth: f64) -> Result<bool, SimulationError> {
        let mut changed = false;
        let mut a = 0;
        let mut boxes: Vec<_> = self.members.iter().map(|m| around(&m.state.x)).collect();
        while a < self.members.len() {
            let mut b = a + 1;
            while b < self.members.len() {
                // curves whose boxes do not meet are not in each other
                let ((low, high), (least, most)) = (boxes[a], boxes[b]);
                if low.cmpgt(most).any() || least.cmpgt(high).any() {
                    b += 1;
                    continue;
                }
                let (one, two) = (&self.members[a], &self.members[b]);
                let id = one.id;
                let wrong = |error| SimulationError::Outline { member: id, error };
                let merged = if one.is_closed() && two.is_closed() {
                    outline::merge(&one.state.x, &two.state.x, depth).map_err(wrong)?
                } else {
                    None
                };
                let Some(piece) = merged.and_then(|resolved| resolved.pieces.into_iter().next())
                else {
                    b += 1;
                    continue;
                };
                let plan = piece
                    .plan(&[one.state.len(), two.state.len()])
                    .map_err(wrong)?;
                let mut renewed = one.joined(two, plan).map_err(wrong)?;
                renewed.forget()?;
                let with = two.id;
                self.put(a, renewed)?;
                self.log(id, EventKind::Merged { with });
                self.retire(b);
                boxes.remove(b);
                boxes[a] = around(&self.members[a].state.x);
                changed = true;
            }
            a += 1;
        }
        Ok(changed)
    }

    /// Put a renewed curve in the place of member `k`.
    fn put(&mut self, k: usize, renewed: Renewed) -> Result<(), SimulationError> {
        self.remember(k);
        let member = &self.members[k];
        let mut world = member.snake.world().clone();
        for acting in &mut world.forces {
            acting.carry(&renewed.plan);
        }
        let mut body = renewed.body;
        // drawn from other nodes its mean is no longer exactly zero
        body.recenter()?;
        let mut snake = Snake::new(body, world)?;
        snake.follow(&member.snake, &renewed.plan)?;
        let id = member.id;
        let pace = self.pace_of(k, &mut snake, &renewed.state);
        let (pace, cuts) = pace.map_err(|error| error.of(id))?;
        let before = self.members[k].cuts;
        if cuts != before {
            self.log(id, EventKind::Cut { cuts });
        }
        let member = &mut self.members[k];
        member.lightest = lightest(&snake);
        (member.snake, member.state) = (snake, renewed.state);
        (member.pace, member.cuts) = (pace, cuts);
        (member.watch, member.verdict) = (None, Verdict::Moving);
        member.resume()
    }

    /// Take member `k` out; what its ledger has booked stays in the simulation's.
    pub(super) fn retire(&mut self, k: usize) -> Member {
        self.remember(k);
        let member = self.members.remove(k);
        if let Some(ledger) = &member.ledger {
            self.books.retire(&ledger.booked());
        }
        member
    }
}

impl Member {
    /// How many nodes it should have, if its edges ask for other than it has.
    fn wanted(&self, stretch: f64) -> Option<usize> {
        let (x, closed) = (&self.state.x, self.is_closed());
        let n = x.len();
        let edges = if closed { n } else { n - 1 };
        let lengths = (0..edges).map(|i| x[i].distance(x[(i + 1) % n]));
        let (short, long, total) = lengths.fold((f64::INFINITY, 0.0_f64, 0.0), |(a, b, sum), l| {
            (a.min(l), b.max(l), sum + l)
        });
        if long <= stretch * self.spacing && short >= self.spacing / stretch {
            return None;
        }
        let nodes = total / self.spacing + if closed { 0.0 } else { 1.0 };
        let least = self.snake.body().topology.least_nodes().max(8);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped to a range of counts first"
        )]
        let count = nodes.round().clamp(least as f64, 1e6) as usize;
        // as many as there are, unevenly: only worth a slide where that evens them out
        let even = total / edges as f64;
        let uneven = long > stretch * even || short < even / stretch;
        (count != n || uneven).then_some(count)
    }

    /// The curve on the nodes of `plan`: density, momentum and spin carried over, the rest shape drawn
    /// with the same weights, so that a stretch of material stays the same stretch.
    fn renewed(&self, plan: Plan, totals: Totals) -> Result<Renewed, outline::OutlineError> {
        let old = self.snake.body();
        let (n, count) = (self.state.len(), plan.len());
        let mut body = old.clone();
        let edges = |n: usize| if self.is_closed() { n } else { n - 1 } as f64;
        if totals == Totals::Kept {
            // the length at rest is that of the material, however many nodes stand for it
            body.spacing = old.spacing * edges(n) / edges(count);
        }
        body.rest = plan.draw(&old.rest)?;
        if totals == Totals::Handed {
            // as much of the length that the whole has at rest as its rest shape has of the whole's
            let rule = elastic::SpacingRule::Closed;
            let length = |rest: &[DVec2]| elastic::spacing(rest, self.is_closed(), rule);
            let share = length(&body.rest) / length(&old.rest);
            if share > 0.0 && share.is_finite() {
                body.spacing = old.spacing * share;
            }
        }
        let density = old.mass.to_vec(n);
        let from = outline::Body {
            positions: &self.state.x,
            velocities: &self.state.v,
            density: &density,
            lengths: Lengths::Even(old.spacing),
        };
        let (x, v);
        if density.iter().any(|&m| m > 0.0) {
            let carried = plan.carry(&from, Lengths::Even(body.spacing), totals)?;
            body.mass = match old.mass {
                Profile::Uniform(mass) => Profile::Uniform(mass * carried.mass_factor),
                Profile::PerNode(_) => Profile::PerNode(carried.density),
            };
            (x, v) = (carried.positions, carried.velocities);
        } else {
            (x, v) = (plan.draw(&self.state.x)?, plan.draw(&self.state.v)?);
        }
        let lower = [
            &mut body.material.tether,
            &mut body.material.tension,
            &mut body.material.rigidity,
            &mut body.damping,
        ];
        for profile in lower.into_iter().chain(&mut body.material.higher) {
            if let Profile::PerNode(values) = profile {
                *values = plan.pour(values)?;
            }
        }
        let state = State {
            x,
            v,
            ..self.state.clone()
        };
        Ok(Renewed { body, state, plan })
    }

    /// This curve and another on the nodes of one outline. What they are made of is this one's.
    fn joined(&self, other: &Self, plan: Plan) -> Result<Renewed, outline::OutlineError> {
        let both = |a: &[DVec2], b: &[DVec2]| -> Vec<DVec2> { [a, b].concat() };
        let state = State {
            x: plan.draw(&both(&self.state.x, &other.state.x))?,
            v: plan.draw(&both(&self.state.v, &other.state.v))?,
            ..self.state.clone()
        };
        let (a, b) = (self.snake.body(), other.snake.body());
        let mut body = a.clone();
        let (n, m) = (a.len(), b.len());
        // mass and damping per length as it is, not as it was at rest: what is left of either curve keeps its own
        let rule = elastic::SpacingRule::Closed;
        let rate = |member: &Self| {
            let present = elastic::spacing(&member.state.x, true, rule);
            member.snake.body().spacing / present
        };
        let (one, two) = (rate(self), rate(other));
        body.mass = a.mass.scaled(one);
        body.damping = a.damping.scaled(one);
        let (mass, damping) = (b.mass.scaled(two), b.damping.scaled(two));
        // an order that only one of them has weighs nothing in the other
        let mut other_higher = b.material.higher.clone();
        let orders = body.material.higher.len().max(other_higher.len());
        body.material.higher.resize(orders, Profile::Uniform(0.0));
        other_higher.resize(orders, Profile::Uniform(0.0));
        let lower = [
            (&mut body.material.tether, &b.material.tether),
            (&mut body.material.tension, &b.material.tension),
            (&mut body.material.rigidity, &b.material.rigidity),
            (&mut body.mass, &mass),
            (&mut body.damping, &damping),
        ];
        let higher = body.material.higher.iter_mut().zip(&other_higher);
        for (profile, more) in lower.into_iter().chain(higher) {
            if *profile != *more || !profile.is_uniform() {
                let values = [profile.to_vec(n), more.to_vec(m)].concat();
                *profile = Profile::PerNode(plan.pour(&values)?);
            }
        }
        body.rest.clone_from(&state.x);
        body.spacing = elastic::spacing(&state.x, true, rule);
        Ok(Renewed { body, state, plan })
    }

    /// Let the rest shape give way and grow, for that long.
    fn flow(&mut self, upkeep: &Upkeep, time: f64) -> Result<(), SimulationError> {
        let body = self.snake.body();
        let closed = self.is_closed();
        let n = body.len();
        let mut rest = body.rest.clone();
        if let Some(plastic) = upkeep.plastic {
            // the exact answer of ṙ' = rate · excess over that time, for edges that stay where they are
            let share = -(-plastic.rate * time).exp_m1();
            let edges = if closed { n } else { n - 1 };
            let mut drawn = Vec::with_capacity(edges);
            for i in 0..edges {
                let j = (i + 1) % n;
                let at_rest = rest[j] - rest[i];
                let off = self.state.x[j] - self.state.x[i] - at_rest;
                let free = plastic.yields_at * at_rest.length();
                let beyond = (off.length() - free).max(0.0);
                drawn.push(at_rest + share * beyond * off.normalize_or_zero());
            }
            let gap: DVec2 = if closed {
                drawn.iter().sum()
            } else {
                DVec2::ZERO
            };
            let mut place = rest[0];
            for i in 1..n {
                place += drawn[i - 1] - gap / edges as f64;
                rest[i] = place;
            }
        }
        let factor = (upkeep.growth * time).exp();
        if upkeep.growth.abs() > 0.0 {
            rest.iter_mut().for_each(|r| *r *= factor);
        }
        self.snake.set_rest(rest)?;
        Ok(())
    }
}

impl Renewed {
    /// Let its present shape be its rest shape. Each node keeps its mass and its damping.
    fn forget(&mut self) -> Result<(), SnakeError> {
        let closed = self.body.topology.is_closed();
        self.body.rest.clone_from(&self.state.x);
        let rule = elastic::SpacingRule::Closed;
        let spacing = elastic::spacing(&self.state.x, closed, rule);
        // densities are per length at rest, which is another one now
        let factor = self.body.spacing / spacing;
        self.body.mass = self.body.mass.scaled(factor);
        self.body.damping = self.body.damping.scaled(factor);
        self.body.spacing = spacing;
        self.body.recenter()
    }
}
