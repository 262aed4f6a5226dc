//! A million steps without damping: who keeps the energy?

use super::chart::color;
use integrator::{Scheme, Start, System, kinetic_energy, problems};
use sandbox::prelude::*;

const NODES: usize = 32;
const STEPS: usize = 1_000_000;
/// Enough to see that energy does not drift.
const STEPS_IN_SHORT: usize = 50_000;
/// Windows between the first step and the last, each a tenth of a decade.
const WINDOWS: usize = 60;

/// Those that claim to keep energy, and two that do not.
const KEEPERS: [Scheme; 4] = [
    Scheme::Leapfrog,
    Scheme::Newmark,
    Scheme::Gauss4,
    Scheme::Exact,
];
const OTHERS: [Scheme; 2] = [Scheme::Rk4, Scheme::Report];

pub(crate) const DRIFT: Experiment = Experiment {
    id: "drift",
    title: "A million steps without damping",
    place: "§3.4",
    question: "A ring of 32 nodes swings for ever, at half the largest step of leapfrog. What is its energy after a \
               million steps?",
    claims: &[
        claim("leapfrog's energy wavers and does not drift: the last tenth is within what the first was \
               [[hairer03]]")
            .when(&[less(
                "leapfrog: largest change in the last tenth",
                1.1,
                "leapfrog: largest change in the first tenth",
            )]),
        claim("Newmark's, Gauss's and the exact scheme change it by rounding only [theory]").when(&[
            below("newmark: largest change in the last tenth", 1e-8),
            below("gauss-4: largest change in the last tenth", 1e-8),
            below("exact: largest change in the last tenth", 1e-8),
        ]),
    ],
    run: || run(STEPS),
    draw,
};

/// The same claims after fewer steps.
pub(crate) const DRIFT_SHORT: Experiment = Experiment {
    run: || run(STEPS_IN_SHORT),
    ..DRIFT
};

/// `|E/E₀ − 1|` at its largest in each window of steps.
fn changes(scheme: Scheme, steps: usize) -> Result<Vec<f64>> {
    let problem = problems::ring(NODES, 1.0, 0.0, [1.0, 20.0, 60.0])?;
    let (mut system, mut state) = (problem.system, problem.state);
    let limit = Scheme::Leapfrog.step_limit(&system).unwrap_or(1.0);
    let mut stepper = scheme.start(&mut system, &state, 0.5 * limit, Start::SecondOrder)?;
    let rest = system.rest.clone();
    let mut bent = vec![DVec2::ZERO; NODES];
    let mut energy = |system: &dyn System, state: &integrator::State| {
        for (e, (x, r)) in bent.iter_mut().zip(state.x.iter().zip(&rest)) {
            *e = *x - *r;
        }
        0.5 * system.stiffness().band().quadratic(&bent) + kinetic_energy(system, state)
    };
    let first = energy(&system, &state);
    let mut out = vec![0.0_f64; WINDOWS];
    for step in 1..=steps {
        if stepper.step(&mut system, &mut state).is_err() {
            break;
        }
        let window = window(step, steps);
        // energy is looked at often at first, later every hundredth step
        if step < 1000 || step % 101 == 0 || step + 101 > steps {
            out[window] = out[window].max((energy(&system, &state) / first - 1.0).abs());
        }
    }
    Ok(out)
}

/// Which window a step is in: equal shares of a logarithmic axis.
fn window(step: usize, steps: usize) -> usize {
    let border = |w: usize| real(steps).powf(real(w + 1) / real(WINDOWS));
    (0..WINDOWS)
        .find(|&w| real(step) <= border(w) * (1.0 + 1e-9))
        .unwrap_or(WINDOWS - 1)
}

fn run(steps: usize) -> Result {
    let ends = (1..=WINDOWS).map(|w| real(steps).powf(real(w) / real(WINDOWS)));
    let mut table = Table::raw("energy").exact("step", ends);
    let mut record = Record::default();
    for scheme in KEEPERS.into_iter().chain(OTHERS) {
        let seen = changes(scheme, steps)?;
        let largest = |part: &[f64]| part.iter().copied().fold(0.0, f64::max);
        let (first, last) = (&seen[..WINDOWS * 5 / 6], &seen[WINDOWS - 1..]);
        let name = scheme.name();
        for (when, part) in [("first", first), ("last", last)] {
            let name = format!("{name}: largest change in the {when} tenth");
            record.note(name, largest(part), share(1.0));
        }
        table = table.exact(name, seen);
    }
    record.keep(table);
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let change = Axis::log("|E / E₀ − 1|, largest up to there", 1e-16, 1e1).with_ticks(9);
    let mut panel = plot("", Axis::log("step", 1.0, real(STEPS)), change);
    for scheme in KEEPERS.into_iter().chain(OTHERS) {
        let mut so_far = 0.0_f64;
        let points = record.points("energy", "step", scheme.name())?;
        let points = points.into_iter().map(|(x, y)| {
            so_far = so_far.max(y);
            (x, so_far.max(1e-17))
        });
        panel = panel.with(line(points, color(scheme)).named(scheme.name()));
    }
    Artefact::only(
        "Each at half of leapfrog's largest step. Those that claim to keep energy do; a classical method of order 4 loses \
         it, and so does the start of the report's scheme.",
        Figure::new("Energy over a million steps, no damping", 820.0)
            .with(430.0, vec![panel.legend_at(Corner::BottomRight)]),
    )
}
