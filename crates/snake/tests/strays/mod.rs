//! How far an account strays in a run.

use std::ops::ControlFlow;

use integrator::{Scheme, Start, State};
use snake::{Energies, Ledger, Snake, Until, run};

/// Largest change of the sum of all terms, against the largest of them, over a time of 4; and the energies at its end.
pub(crate) fn over_four(
    snake: &mut Snake,
    mut ledger: Ledger,
    start: &State,
    scheme: Scheme,
    dt: f64,
) -> (f64, Energies) {
    let mut state = start.clone();
    let mut stepper = scheme.start(snake, &state, dt, Start::SecondOrder).unwrap();
    let first = ledger.energies(snake, &state).total();
    let (mut gap, mut largest) = (0.0_f64, 0.0_f64);
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a few hundred"
    )]
    let steps = (4.0 / dt).round() as u64;
    let outcome = run(
        snake,
        &mut *stepper,
        &mut state,
        &Until::steps(steps),
        &mut |snake, state| {
            ledger.book(snake, state).unwrap();
            let energies = ledger.energies(snake, state);
            gap = gap.max((energies.total() - first).abs());
            largest = energies
                .values()
                .iter()
                .fold(largest, |a, e| a.max(e.abs()));
            ControlFlow::Continue(())
        },
    );
    assert!(outcome.is_good());
    (gap / largest, ledger.energies(snake, &state))
}
