//! Curves whose ends grow, a node at a time.

use super::{EventKind, Simulation, SimulationError, lightest};
use crate::rest::{Verdict, Watch};

impl Simulation {
    /// Let the ends grow that are due; whether any curve has other nodes now. What that does to the energy is booked
    /// under `upkeep`.
    pub(super) fn grow(&mut self) -> Result<bool, SimulationError> {
        let mut changed = false;
        for k in 0..self.members.len() {
            let member = &mut self.members[k];
            let (id, grows) = (member.id, member.grows());
            let Some((tips, every)) = &mut member.tips else {
                continue;
            };
            if !grows || !self.step.is_multiple_of(*every) {
                continue;
            }
            let before = tips.growing();
            let grown = tips.grow(&member.snake, &member.state)?;
            let after = tips.growing();
            let over = !after.contains(&true);
            if let Some((mut snake, state)) = grown {
                snake.stay(&member.snake);
                snake.note();
                let begun = self.pace_of(k, &mut snake, &state);
                let (pace, cuts) = begun.map_err(|error| error.of(id))?;
                let member = &mut self.members[k];
                (member.snake, member.state) = (snake, state);
                (member.pace, member.cuts) = (pace, cuts);
                (member.watch, member.verdict) = (None, Verdict::Moving);
                member.lightest = lightest(&member.snake);
                member.told = member.snake.edits;
                if let Some(ledger) = &mut member.ledger {
                    let (scheme, start) = (self.stepping.scheme, self.stepping.start);
                    let renewed = ledger.renew(&mut member.snake, &member.state, scheme, start);
                    renewed.map_err(|fault| SimulationError::Fault { member: id, fault })?;
                }
                changed = true;
            }
            if over && let Some(rest) = self.rest {
                let member = &mut self.members[k];
                member.watch = Some(Watch::new(rest, &mut member.snake, &member.state));
            }
            let nodes = self.members[k].state.len();
            for end in 0..2 {
                if before[end] && !after[end] {
                    let head = end == 0;
                    self.log(id, EventKind::Grown { head, nodes });
                }
            }
        }
        Ok(changed)
    }
}
