//! Runs of a curve whose ends grow.

use std::ops::ControlFlow;

use integrator::State;
use snake::{Ledger, Outcome, Tips, Until};

use crate::SceneError;
use crate::record::{Frame, Record};
use crate::scene::{Scene, refused};

impl Scene {
    /// Run by turns: so many steps, then a node more at every tip that goes on; to the end when none does. What growth does to the energy is
    /// booked under `upkeep`.
    pub(crate) fn run_growing(
        &mut self,
        mut tips: Tips,
        every: u64,
        observer: &mut dyn FnMut(&State) -> ControlFlow<()>,
    ) -> Result<Record, SceneError> {
        let plan = self.plan.clone();
        let keep = &plan.recording.sorted();
        let (mut snake, mut state) = (self.snake.clone(), self.start.clone());
        let begun = |fault| SceneError::key("snake.start", fault);
        let mut ledger = if keep.energies {
            let ledger = Ledger::begin(&mut snake, &state).map_err(begun)?;
            let under = ledger.under(plan.scheme, plan.start_rule, &mut snake);
            Some(under.map_err(begun)?)
        } else {
            None
        };
        let mut record = Record::of(self);
        record
            .frames
            .push(Frame::of(&mut snake, &state, keep, ledger.as_ref()));
        let frames = &mut record.frames;
        let begin = state.step;
        let outcome = loop {
            let growing = tips.growing().contains(&true);
            let left = plan.until.steps - (state.step - begin);
            let until = if growing {
                Until::steps(every.min(left))
            } else {
                Until {
                    steps: left,
                    ..plan.until
                }
            };
            let mut stepper = plan
                .scheme
                .start(&mut snake, &state, plan.dt, plan.start_rule)
                .map_err(|error| refused(&error))?;
            let outcome = snake::run(
                &mut snake,
                &mut *stepper,
                &mut state,
                &until,
                &mut |snake, state| {
                    // a place without force ends the run at the next step, with its own outcome
                    if let Some(ledger) = &mut ledger {
                        let _ = ledger.book(snake, state);
                    }
                    if keep.keeps(state.step) {
                        frames.push(Frame::of(snake, state, keep, ledger.as_ref()));
                    }
                    observer(state)
                },
            );
            let step = state.step;
            if !growing
                || step - begin >= plan.until.steps
                || !matches!(outcome, Outcome::Finished { .. })
            {
                break outcome;
            }
            let before = tips.growing();
            let grown = tips
                .grow(&snake, &state)
                .map_err(|e| SceneError::key("tips", e))?;
            if let Some((larger, at)) = grown {
                (snake, state) = (larger, at);
            }
            // the scheme begins again, on the curve as it is now
            if let Some(ledger) = &mut ledger {
                ledger
                    .renew(&mut snake, &state, plan.scheme, plan.start_rule)
                    .map_err(begun)?;
            }
            for (end, name) in ["head", "tail"].into_iter().enumerate() {
                if before[end] && !tips.growing()[end] {
                    let n = state.len();
                    record
                        .events
                        .push(format!("step {step}: the {name} has stopped, {n} nodes"));
                }
            }
        };
        if frames.last().is_none_or(|frame| frame.step != state.step) {
            frames.push(Frame::of(&mut snake, &state, keep, ledger.as_ref()));
        }
        record.outcome = outcome;
        Ok(record)
    }
}
