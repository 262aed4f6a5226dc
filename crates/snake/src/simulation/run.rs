//! A run, and how it ends.

use std::ops::ControlFlow;

use glam::DVec2;

use super::{Member, Simulation, SimulationError};
use crate::rest::Verdict;
use crate::{Outcome, Until};

/// A run that has begun: when it is to stop.
#[derive(Debug, Clone, Copy)]
pub struct Run {
    until: Until,
    /// Steps made before it.
    begin: u64,
}

impl Simulation {
    /// Move everything until `until`, showing the simulation to `observer` after every step.
    ///
    /// It ends where the observer breaks, with a snake that has left its picture or blown up, when every snake is at
    /// rest or never will be, or after the steps. Where not all are at rest, the end is that of the first that is lost,
    /// else of one that has collapsed or turned over, else of one that goes to and fro. Curves that push each other and
    /// lie in each other deeper than twice [`Contact::stop`](crate::Contact), or have done so, are an outcome as well.
    /// The observer may edit the simulation.
    ///
    /// # Errors
    ///
    /// As [`Simulation::step`]. A fault of a force or of a number is an outcome.
    pub fn run(
        &mut self,
        until: &Until,
        observer: &mut dyn FnMut(&mut Self) -> ControlFlow<()>,
    ) -> Result<Outcome, SimulationError> {
        let run = self.start(until);
        loop {
            if let Some(outcome) = self.go_on(&run, u64::MAX, observer)? {
                return Ok(outcome);
            }
        }
    }

    /// Begin a run that is made in parts, with pauses between them: rest is watched for from here on.
    pub fn start(&mut self, until: &Until) -> Run {
        match until.rest {
            Some(rest) => self.watch(rest),
            None => self.rest = None,
        }
        Run {
            until: *until,
            begin: self.step,
        }
    }

    /// Go on with a run by at most so many steps; None where it has not ended. In parts or at once it is the same to
    /// the last bit.
    ///
    /// # Errors
    ///
    /// As [`Simulation::run`].
    pub fn go_on(
        &mut self,
        run: &Run,
        steps: u64,
        observer: &mut dyn FnMut(&mut Self) -> ControlFlow<()>,
    ) -> Result<Option<Outcome>, SimulationError> {
        let Run { until, begin } = *run;
        let over = |t: f64| until.time.is_some_and(|end| t >= end);
        let paused = self.step.saturating_add(steps);
        while self.step - begin < until.steps && !over(self.t) {
            if self.step >= paused {
                return Ok(None);
            }
            if let ControlFlow::Break(outcome) = self.step()? {
                return Ok(Some(outcome));
            }
            let step = self.step;
            let stopped = observer(self).is_break();
            if self.members.is_empty() {
                return Ok(Some(Outcome::Collapsed { step }));
            }
            if stopped {
                return Ok(Some(Outcome::Stopped { step }));
            }
            let moves = |member: &Member| member.verdict == Verdict::Moving;
            if until.rest.is_some() && !self.members.iter().any(moves) {
                return Ok(Some(self.end(Outcome::Settled { step })));
            }
        }
        Ok(Some(self.end(Outcome::Finished { step: self.step })))
    }

    /// What makes of this end a bad one, if anything does.
    fn end(&self, good: Outcome) -> Outcome {
        let step = self.step;
        let turned = self.members.iter().filter_map(|member| {
            let watch = member.watch.as_ref()?;
            watch.turned(&member.snake, &member.state)
        });
        let verdicts = self.members.iter().map(|member| member.verdict);
        let rank = |verdict: &Verdict| match verdict {
            Verdict::Lost => 0,
            Verdict::Collapsed => 1,
            Verdict::TurnedOver => 2,
            Verdict::Cycle { .. } => 3,
            Verdict::Rest | Verdict::Moving => 4,
        };
        let bad = verdicts.chain(turned).filter(|verdict| rank(verdict) < 4);
        if let Some(outcome) = bad.min_by_key(rank).and_then(|v| v.outcome(step)) {
            return outcome;
        }
        match &self.contact {
            // curves that are to become one may lie in each other
            Some(contact) if self.upkeep.merge.is_none() => {
                match self.overlap().max(self.deepest) {
                    depth if depth > 2.0 * contact.stop => Outcome::Overlaps { step, depth },
                    _ => good,
                }
            }
            _ => good,
        }
    }

    /// How deep the deepest node is inside another closed curve, wherever that is. O(n m) for curves whose boxes meet.
    #[must_use]
    pub fn overlap(&self) -> f64 {
        let boxes: Vec<(DVec2, DVec2)> = self.members.iter().map(|m| around(&m.state.x)).collect();
        let mut order: Vec<usize> = (0..boxes.len()).collect();
        order.sort_by(|&a, &b| boxes[a].0.x.total_cmp(&boxes[b].0.x));
        let mut deepest = 0.0_f64;
        for (k, &a) in order.iter().enumerate() {
            for &b in &order[k + 1..] {
                if boxes[b].0.x > boxes[a].1.x {
                    break;
                }
                let apart = boxes[b].0.y > boxes[a].1.y || boxes[a].0.y > boxes[b].1.y;
                if !apart {
                    let (one, two) = (&self.members[a], &self.members[b]);
                    deepest = deepest.max(within(one, two)).max(within(two, one));
                }
            }
        }
        deepest
    }
}

/// The box around some points.
pub(super) fn around(x: &[DVec2]) -> (DVec2, DVec2) {
    let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    x.iter().fold(none, |(a, b), p| (a.min(*p), b.max(*p)))
}

/// How deep the deepest node of one curve is in another closed one.
fn within(curve: &Member, other: &Member) -> f64 {
    if !other.is_closed() {
        return 0.0;
    }
    let border = &other.state.x;
    let (low, high) = around(border);
    let near = |p: &&DVec2| p.cmpge(low).all() && p.cmple(high).all();
    let nodes = curve.state.x.iter().filter(near);
    let inside = nodes.filter(|p| outline::winding(border, **p).is_some_and(|turns| turns != 0));
    inside
        .map(|p| outline::distance(border, true, *p))
        .fold(0.0, f64::max)
}
