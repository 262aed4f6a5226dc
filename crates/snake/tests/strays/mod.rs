//! How far an account strays in a run.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use integrator::{Scheme, Start, State};
use snake::{Energies, Ledger, Snake};

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
    for _ in 0..steps {
        stepper.step(snake, &mut state).unwrap();
        ledger.book(snake, &state).unwrap();
        let energies = ledger.energies(snake, &state);
        gap = gap.max((energies.total() - first).abs());
        largest = energies
            .values()
            .iter()
            .fold(largest, |a, e| a.max(e.abs()));
    }
    (gap / largest, ledger.energies(snake, &state))
}
