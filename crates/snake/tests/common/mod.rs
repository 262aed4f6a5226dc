//! What several tests share: a plain loop over a stepper, and crowds under rules.
#![allow(dead_code, reason = "no test uses all of it")]

use std::ops::ControlFlow;

use integrator::{Fault, State, Stepper};
use snake::{
    Contact, Entry, Outcome, Rules, Simulation, SimulationError, Snake, Stepping, Until, Upkeep,
};

/// Steps of a stepper in a plain loop, each shown to `observer`, which may change the snake: the twin of
/// [`Simulation::run`] without rest.
pub(crate) fn run(
    snake: &mut Snake,
    stepper: &mut dyn Stepper,
    state: &mut State,
    steps: u64,
    observer: &mut dyn FnMut(&mut Snake, &State) -> ControlFlow<()>,
) -> Result<(), Fault> {
    for _ in 0..steps {
        stepper.step(snake, state)?;
        let edits = snake.edits();
        if observer(snake, state).is_break() {
            break;
        }
        if snake.edits() != edits {
            stepper.resume(snake, state);
        }
    }
    Ok(())
}

/// Snakes under these rules, with an account of energies or without.
pub(crate) fn simulation(
    snakes: Vec<(Snake, State)>,
    stepping: Stepping,
    (contact, upkeep): (Option<Contact>, Upkeep),
    energies: bool,
) -> Result<Simulation, SimulationError> {
    let rules = Rules {
        contact,
        upkeep,
        energies,
    };
    let entries = snakes.into_iter();
    let entries = entries.map(|(snake, state)| Entry::new(snake, state));
    Simulation::new(entries.collect(), stepping, &rules)
}

/// The end of a lone snake: how, and where.
pub(crate) fn end(
    snake: &Snake,
    state: &State,
    stepping: Stepping,
    until: &Until,
) -> (Outcome, State) {
    let begun = Simulation::of(snake.clone(), state.clone(), stepping);
    let mut simulation = begun.unwrap_or_else(|error| unreachable!("{error}"));
    let outcome = simulation.run(until, &mut |_| ControlFlow::Continue(()));
    let outcome = outcome.unwrap_or_else(|error| unreachable!("{error}"));
    (outcome, simulation.members()[0].state().clone())
}
