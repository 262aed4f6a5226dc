//! What contacts do on the way from one moment to the next: their work along the straight way of every node, from their forces.
//!
//! A contact's force is C⁰ on the way: a node enters a layer, passes from one edge to the next, or from one
//! partner to another. Simpson's rule is halved there until nothing changes but rounding, so none of these leaves anything over.

use glam::DVec2;
use outline::nearest_of;

use super::contact::Meeting;
use super::glue::Stuck;
use super::{Contact, Member};

/// What contacts have done, and what was taken.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Tally {
    /// Work of the forces of contacts.
    pub work: f64,
    /// Energy that is gone.
    pub lost: f64,
}

impl std::ops::AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.work += other.work;
        self.lost += other.lost;
    }
}

/// Between two moments.
pub(super) struct Passage<'a> {
    pub contact: &'a Contact,
    pub members: &'a [Member],
    /// Where the nodes were.
    pub from: &'a [Vec<DVec2>],
    /// Which curves run the other way round.
    pub turned: &'a [bool],
    /// How many nodes away the same curve counts as another.
    pub apart: &'a [usize],
}

/// Edges further apart than this are two places of a curve, and none between them is looked at.
const TOGETHER: usize = 6;

/// A node on its way, and the edges of another curve that it may meet on it.
struct Track<'a> {
    passage: &'a Passage<'a>,
    curve: usize,
    node: usize,
    other: usize,
    edges: Vec<usize>,
}

/// Where a node is against a curve.
struct Close {
    /// With its sign, as a meeting has it.
    distance: f64,
    /// How fast the distance grows, a unit of the way.
    rate: f64,
}

impl<'a> Track<'a> {
    fn new(
        passage: &'a Passage<'a>,
        (curve, node, other): (usize, usize, usize),
        near: [Option<usize>; 2],
    ) -> Self {
        let member = &passage.members[other];
        let n = member.state.len();
        let closed = member.is_closed();
        let last = n - usize::from(!closed);
        let own = curve == other;
        let far = |node_there: usize| {
            let steps = node_there.abs_diff(node);
            let steps = if closed { steps.min(n - steps) } else { steps };
            steps > passage.apart[curve]
        };
        let mut edges = Vec::with_capacity(2 * TOGETHER);
        let mut push = |first: usize, count: usize| {
            for k in 0..count {
                let edge = first + k;
                let there = closed || (1..=last).contains(&edge);
                // counted from one before, so that none is below 0
                let edge = (edge + last - 1) % last;
                let seen = !own || far(edge) && far((edge + 1) % n);
                if there && seen && !edges.contains(&edge) {
                    edges.push(edge);
                }
            }
        };
        match near {
            [Some(a), Some(b)] if a != b => {
                let ahead = (b + last - a) % last;
                let back = (a + last - b) % last;
                if ahead <= TOGETHER && (closed || b > a) {
                    push(a, ahead + 3);
                } else if back <= TOGETHER && (closed || a > b) {
                    push(b, back + 3);
                } else {
                    push(a, 3);
                    push(b, 3);
                }
            }
            [Some(a), _] | [None, Some(a)] => push(a, 3),
            [None, None] => {}
        }
        Self {
            passage,
            curve,
            node,
            other,
            edges,
        }
    }

    /// So far on the way, from 0 to 1.
    fn at(&self, s: f64) -> Option<Close> {
        let (members, from) = (self.passage.members, self.passage.from);
        let place = |curve: usize, node: usize| {
            let (a, b) = (from[curve][node], members[curve].state.x[node]);
            if s < 1.0 { a + s * (b - a) } else { b }
        };
        let way = |curve: usize, node: usize| members[curve].state.x[node] - from[curve][node];
        let other = &members[self.other];
        let n = other.state.len();
        let p = place(self.curve, self.node);
        let closed = other.is_closed();
        let near = nearest_of(&self.edges, (n, closed), |i| place(self.other, i), p)?;
        let flip = if self.passage.turned[self.other] {
            -1.0
        } else {
            1.0
        };
        let (distance, out) = if closed && self.other != self.curve {
            (flip * near.signed(), flip * near.outward)
        } else {
            let away = p - near.at;
            (near.distance, away.try_normalize().unwrap_or(near.outward))
        };
        let (edge, along) = (near.spot.edge, near.spot.along);
        let edge_way =
            (1.0 - along) * way(self.other, edge) + along * way(self.other, (edge + 1) % n);
        Some(Close {
            distance,
            rate: out.dot(way(self.curve, self.node) - edge_way),
        })
    }

    /// How far all of it moves, and how large its places are: what rounding is measured by.
    fn sizes(&self) -> (f64, f64) {
        let (members, from) = (self.passage.members, self.passage.from);
        let of = |curve: usize, node: usize| {
            let (a, b) = (from[curve][node], members[curve].state.x[node]);
            (a.distance(b), a.length().max(b.length()))
        };
        let (mut way, size) = of(self.curve, self.node);
        let n = members[self.other].state.len();
        let mut most = 0.0_f64;
        for &edge in &self.edges {
            most = most.max(of(self.other, edge).0);
            most = most.max(of(self.other, (edge + 1) % n).0);
        }
        way += most;
        (way, size)
    }
}

impl Passage<'_> {
    /// What one node and one curve have done that met before, or meet now, or both.
    pub(super) fn meeting(&self, before: Option<&Meeting>, now: Option<&Meeting>) -> Tally {
        let Some(m) = now.or(before) else {
            return Tally::default();
        };
        let mut tally = self.hold(before, now);
        let key = (m.curve, m.node, m.other);
        let track = Track::new(self, key, [before, now].map(|m| m.map(|m| m.ends[0])));
        let gap = self.contact.gap;
        let spacing = self.members[m.curve].snake.body().spacing;
        let scale = self.contact.stiffness * spacing;
        let felt = before.map_or(0.0, |b| b.felt);
        let after = now.map_or(0.0, |m| m.felt);
        let start = track.at(0.0).map_or(0.0, |close| gap - close.distance);
        // what of the depth is not felt
        let hidden = match before {
            Some(_) => start - felt,
            None => start.max(0.0),
        };
        let press = |close: &Close| (gap - close.distance - hidden).max(0.0);
        let end = track.at(1.0).map_or(felt, |close| press(&close));
        let (way, size) = track.sizes();
        let passed = along(
            |s| {
                let close = track.at(s);
                let felt = close.as_ref().map_or(0.0, press);
                Sample {
                    level: felt,
                    energy: 0.5 * scale * felt * felt,
                    power: close
                        .map_or(0.0, |close| spacing * self.contact.press(felt) * close.rate),
                }
            },
            &Fineness {
                steep: way,
                noise: rounding(size + gap),
                most: rounding(scale * way * (size + gap)),
            },
        );
        tally.work += passed.work;
        tally.lost += 0.5 * scale * (end * end - after * after) - passed.jumped;
        tally
    }

    /// What friction that holds has done: its force straight from what it was to what it is, over the way that it was stretched.
    fn hold(&self, before: Option<&Meeting>, now: Option<&Meeting>) -> Tally {
        let Some(b) = before else {
            return Tally::default();
        };
        let across = now.unwrap_or(b).way.perp();
        let other = &self.members[b.other].state.x;
        let point = (1.0 - b.along) * other[b.ends[0]] + b.along * other[b.ends[1]];
        let apart = self.members[b.curve].state.x[b.node] - point;
        let slid = b.slip + (apart - b.apart).dot(across);
        let spacing = self.members[b.curve].snake.body().spacing;
        let stiffness = self.contact.stick * self.contact.stiffness * spacing;
        held(stiffness, b.slip, slid, now.map_or(0.0, |m| m.slip))
    }

    /// What adhesion has done to one node that adhered before, or does now, or both.
    pub(super) fn adhesion(
        &self,
        (curve, node): (usize, usize),
        before: Option<&Stuck>,
        now: Option<&Stuck>,
    ) -> Tally {
        let edge = |stuck: Option<&Stuck>| stuck.map(|s| (s.other, s.ends[0]));
        let mut tracks = Vec::with_capacity(2);
        match (edge(before), edge(now)) {
            (Some((a, one)), Some((b, two))) if a == b => {
                tracks.push(Track::new(self, (curve, node, a), [Some(one), Some(two)]));
            }
            (one, two) => {
                for (other, edge) in [one, two].into_iter().flatten() {
                    tracks.push(Track::new(self, (curve, node, other), [Some(edge), None]));
                }
            }
        }
        let length = |s: f64| self.own_length(curve, node, s).0;
        let longest = length(0.0).max(length(1.0));
        // the slope of the energy is steepest at u = 1/√3
        let full = 0.5 * self.contact.adhesion;
        let law = full * (1.6 * longest / self.contact.range + 1.0);
        // the node's own neighbours move too
        let spread = full * self.own_length(curve, node, 1.0).2;
        let mut fine = Fineness::default();
        for track in &tracks {
            let (way, size) = track.sizes();
            fine.steep = fine.steep.max(law * way + spread);
            fine.noise = fine.noise.max(rounding(law * size));
            fine.most = fine
                .most
                .max(rounding((law * way + spread) * size / self.contact.range));
        }
        let energy = |s: f64| self.adhering(&tracks, curve, node, s);
        let (start, end) = (energy(0.0).0, energy(1.0).0);
        let passed = along(
            |s| {
                let (energy, power) = energy(s);
                Sample {
                    level: energy,
                    energy,
                    power,
                }
            },
            &fine,
        );
        let stored =
            |stuck: Option<&Stuck>, s: f64| stuck.map_or(0.0, |stuck| stuck.energy * length(s));
        Tally {
            work: passed.work,
            lost: (end - start) - (stored(now, 1.0) - stored(before, 0.0)) - passed.jumped,
        }
    }

    /// Energy of a node that adheres to the best of these, and the power of what holds it.
    fn adhering(&self, tracks: &[Track<'_>], curve: usize, node: usize, s: f64) -> (f64, f64) {
        let mut best = (0.0, 0.0, 0.0);
        for close in tracks.iter().filter_map(|track| track.at(s)) {
            let (energy, slope) = self.contact.side(close.distance - self.contact.gap);
            if energy < best.0 {
                best = (energy, slope, close.rate);
            }
        }
        let (energy, slope, rate) = best;
        let (length, growth, _) = self.own_length(curve, node, s);
        (energy * length, -(energy * growth + length * slope * rate))
    }

    /// Half the length of both edges at a node, how fast it grows on the way, and how fast it could at most.
    fn own_length(&self, curve: usize, node: usize, s: f64) -> (f64, f64, f64) {
        let (member, from) = (&self.members[curve], &self.from[curve]);
        let (x, n, closed) = (&member.state.x, member.state.len(), member.is_closed());
        let mut sum = (0.0, 0.0, 0.0);
        let mut add = |other: usize| {
            let (a, b) = (from[other] - from[node], x[other] - x[node]);
            let edge = if s < 1.0 { a + s * (b - a) } else { b };
            sum.0 += 0.5 * edge.length();
            sum.1 += 0.5 * edge.normalize_or_zero().dot(b - a);
            sum.2 += 0.5 * a.distance(b);
        };
        if closed || node + 1 < n {
            add((node + 1) % n);
        }
        if closed || node > 0 {
            add((node + n - 1) % n);
        }
        sum
    }
}

/// What a spring of friction has done that was stretched by `before`, then by `slid`, and slipped back to `after`.
pub(super) fn held(stiffness: f64, before: f64, slid: f64, after: f64) -> Tally {
    let mean = 0.5 * stiffness * (before + after);
    Tally {
        work: -mean * (slid - before),
        lost: mean * (slid - after),
    }
}

/// What rounding makes of what is formed from numbers as large as that.
fn rounding(size: f64) -> f64 {
    16.0 * f64::EPSILON * size
}

/// A contact somewhere on the way.
#[derive(Debug, Clone, Copy)]
struct Sample {
    /// What cannot change faster than things move.
    level: f64,
    energy: f64,
    /// Power of its forces, a unit of the way.
    power: f64,
}

/// How fine a way is looked at.
#[derive(Debug, Clone, Copy, Default)]
struct Fineness {
    /// How fast the level can change: faster is a jump.
    steep: f64,
    /// What rounding does to the level.
    noise: f64,
    /// What the work may be off by.
    most: f64,
}

/// What a way has come to.
#[derive(Debug, Clone, Copy, Default)]
struct Passed {
    work: f64,
    /// By how much the energy has jumped, with no force for it: where a curve that crosses itself has its inside elsewhere.
    jumped: f64,
}

/// Halvings at most: below this a piece of the way is shorter than rounding.
const HALVINGS: u32 = 52;

/// Pieces at most, where a way is rougher than rounding.
const PIECES: usize = 2000;

/// ∫ of the power from 0 to 1 by Simpson's rule, halved until two rules agree and nothing jumps.
fn along(f: impl Fn(f64) -> Sample, fine: &Fineness) -> Passed {
    let rule = |a: &Sample, m: &Sample, b: &Sample, width: f64| {
        width / 6.0 * (a.power + 4.0 * m.power + b.power)
    };
    let mut todo = vec![(0.0, 1.0, [f(0.0), f(0.5), f(1.0)], 0)];
    let (mut passed, mut asked) = (Passed::default(), 0);
    while let Some((from, width, [a, m, b], depth)) = todo.pop() {
        let (left, right) = (f(from + 0.25 * width), f(from + 0.75 * width));
        let (half, whole) = (0.5 * width, rule(&a, &m, &b, width));
        let halves = rule(&a, &left, &m, half) + rule(&m, &right, &b, half);
        let pairs = [(&a, &left), (&left, &m), (&m, &right), (&right, &b)];
        let reach = 0.25 * width * fine.steep + fine.noise;
        let jumps = |(a, b): &(&Sample, &Sample)| (a.level - b.level).abs() > reach;
        let torn = pairs.iter().any(jumps);
        asked += 1;
        // a kink's share falls by the square of the width, noise with it
        let agree = (whole - halves).abs() <= fine.most * width.max(1e-3);
        if agree && !torn || depth >= HALVINGS || asked > PIECES {
            passed.work += halves + (halves - whole) / 15.0;
            if torn {
                passed.jumped += b.energy - a.energy;
            }
        } else {
            todo.push((from + half, half, [m, right, b], depth + 1));
            todo.push((from, half, [a, left, m], depth + 1));
        }
    }
    passed
}

#[cfg(test)]
mod tests {
    use super::*;

    fn passed(level: impl Fn(f64) -> f64, power: impl Fn(f64) -> f64) -> Passed {
        let sample = |s: f64| Sample {
            level: level(s),
            energy: 0.5 * level(s) * level(s),
            power: power(s),
        };
        let fine = Fineness {
            steep: 3.0,
            noise: 1e-15,
            most: 1e-15,
        };
        along(sample, &fine)
    }

    #[test]
    fn a_spring_that_sets_in_on_the_way_has_done_what_its_energy_says() {
        // depth 2 s − 0.7391, felt above 0
        let felt = |s: f64| (2.0 * s - 0.7391).max(0.0);
        let found = passed(felt, |s| -2.0 * felt(s));
        assert!((found.work + 0.5 * 1.2609 * 1.2609).abs() < 1e-14);
        assert!(found.jumped.abs() < f64::MIN_POSITIVE);
    }

    #[test]
    fn what_jumps_is_no_work() {
        let felt = |s: f64| if s < 0.3217 { 0.4 } else { 0.4 + s };
        let found = passed(felt, |s| if s < 0.3217 { 0.0 } else { -felt(s) });
        let (before, after) = (0.5 * 0.4 * 0.4, 0.5 * 0.7217 * 0.7217);
        assert!((found.jumped - (after - before)).abs() < 1e-12);
        let work = after - 0.5 * 1.4 * 1.4;
        assert!((found.work - work).abs() < 1e-12, "{found:?} {work}");
    }
}
