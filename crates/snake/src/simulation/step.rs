//! One step of everything: what was changed is told, contacts push, every snake steps, contacts push again.

use std::ops::ControlFlow;

use integrator::{Fault, FaultKind, Scheme};

use super::kick::Half;
use super::member::astray;
use super::{Simulation, SimulationError};
use crate::Outcome;

impl Simulation {
    /// Move everything one step on. It breaks where that cannot be done: a snake has left its picture or is no longer
    /// anywhere.
    ///
    /// # Errors
    ///
    /// A snake whose scheme cannot move what an edit has made of it, or whose curve could not be kept in order.
    pub fn step(&mut self) -> Result<ControlFlow<Outcome>, SimulationError> {
        match self.advance() {
            Ok(()) => Ok(ControlFlow::Continue(())),
            Err(SimulationError::Fault { fault, .. }) => {
                Ok(ControlFlow::Break(Outcome::of_fault(fault, self.step)))
            }
            Err(error) => Err(error),
        }
    }

    fn advance(&mut self) -> Result<(), SimulationError> {
        if self.step > self.begin.1 && self.grow()? {
            self.meet(None)?;
        }
        for k in 0..self.members.len() {
            if self.members[k].told != self.members[k].snake.edits {
                self.tell(k)?;
            }
        }
        self.divide()?;
        for part in 1..=self.parts {
            self.go(part)?;
        }
        self.step += 1;
        if self.upkeep.is_due(self.step) {
            self.keep_up()?;
        }
        self.look();
        Ok(())
    }

    /// Tell the scheme and the account of a snake that it has been changed.
    fn tell(&mut self, k: usize) -> Result<(), SimulationError> {
        let member = &mut self.members[k];
        let id = member.id;
        if let Some(ledger) = &mut member.ledger {
            let caught_up = ledger.catch_up(&mut member.snake);
            caught_up.map_err(|fault| SimulationError::Fault { member: id, fault })?;
        }
        if member.terms.is_some() {
            // its frame is made from the snake as it was
            let (mut snake, state) = (member.snake.clone(), member.state.clone());
            let begun = self.pace_of(k, &mut snake, &state);
            let (pace, cuts) = begun.map_err(|error| error.of(id))?;
            let member = &mut self.members[k];
            (member.pace, member.cuts) = (pace, cuts);
        } else {
            let stepper = member.pace.stepper();
            stepper.resume(&mut member.snake, &member.state);
        }
        let member = &mut self.members[k];
        member.told = member.snake.edits;
        Ok(())
    }

    /// Move everything on by one part of the step.
    fn go(&mut self, part: u64) -> Result<(), SimulationError> {
        let half = 0.5 * self.part();
        self.kick(half, Half::First)?;
        // counted, not added up, unless the report's clock is asked for (D20)
        let (begin, first) = self.begin;
        let share = (self.step - first) as f64 + part as f64 / self.parts as f64;
        let t = begin + share * self.stepping.dt;
        let own = self.stepping.each || self.stepping.relax.is_some();
        let counted = self.stepping.scheme != Scheme::Report && !own;
        for member in &mut self.members {
            let id = member.id;
            let fault = |fault| SimulationError::Fault { member: id, fault };
            for cut in 1..=member.cuts {
                let stepper = member.pace.stepper();
                stepper
                    .step(&mut member.snake, &mut member.state)
                    .map_err(fault)?;
                if counted && cut == member.cuts {
                    member.state.t = t;
                }
                if let Some(node) = astray(&member.state.x) {
                    // the step is made, and led nowhere
                    self.step += 1;
                    return Err(fault(Fault {
                        node,
                        at: member.state.x[node],
                        kind: FaultKind::NotFinite,
                    }));
                }
                if let Some(ledger) = &mut member.ledger {
                    // a place without force ends the run at the next step, with its own outcome
                    let _ = ledger.book(&mut member.snake, &member.state);
                }
            }
        }
        self.t = self.members.first().map_or(self.t, |member| member.state.t);
        self.meet(Some(self.part()))?;
        self.deepest = self.deepest.max(self.deepest());
        self.kick(half, Half::Second)
    }

    /// Find who touches whom, so long after the last time.
    pub(super) fn meet(&mut self, since: Option<f64>) -> Result<(), SimulationError> {
        if let Some(contact) = &self.contact {
            let mut tally = self.meetings.find(contact, &self.members, since)?;
            tally += self.footings.find(contact, &self.members, since.is_none());
            self.books.passed(tally);
        }
        Ok(())
    }

    /// Let the contacts push for that long.
    fn kick(&mut self, time: f64, half: Half) -> Result<(), SimulationError> {
        let Some(contact) = &self.contact else {
            return Ok(());
        };
        let mut tally = self.meetings.kick(contact, &mut self.members, time, half);
        tally += self.footings.kick(contact, &mut self.members, time, half);
        self.books.kicked(tally);
        for (k, member) in self.members.iter_mut().enumerate() {
            if self.meetings.kicked(k) || self.footings.kicked(k) {
                member.kicked()?;
            }
        }
        Ok(())
    }
}
