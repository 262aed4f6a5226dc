//! One experiment a problem: scan every scheme, note what it takes to come within 1e-3 and 1e-6.

use super::chart::draw;
use super::effort::to_real;
use super::judge;
use super::trial::Trial;
use super::{Effort, apple, edge, least_steps, ring, scan, wall};
use integrator::Scheme;
use sandbox::prelude::*;

/// Distances from the truth that are asked for, px.
pub(super) const TARGETS: [(f64, &str); 2] = [(1e-3, "1e-3"), (1e-6, "1e-6")];

/// Every scheme that solves the equation of motion; the gradient flow solves another one.
pub(super) fn schemes() -> impl Iterator<Item = Scheme> {
    Scheme::ALL
        .iter()
        .copied()
        .filter(|&scheme| scheme != Scheme::GradientFlow)
}

fn try_all(trial: Result<Trial>) -> Result {
    let mut trial = trial?;
    let mut record = Record::default();
    if let Some((_, end)) = trial.truth.last() {
        let moved = end.iter().zip(&trial.start.x).map(|(a, b)| a.distance(*b));
        record.note("way made by the fastest node [px]", most(moved), LOOSE);
    }
    for scheme in schemes() {
        let seen = scan(&mut trial, scheme);
        let name = scheme.name();
        for (target, words) in TARGETS {
            let found = least_steps(&mut trial, scheme, &seen, target);
            type Read = fn(&Effort) -> f64;
            let read: [(&str, &str, Read); 4] = [
                ("steps", "", |run| to_real(run.steps)),
                ("forces", "", |run| to_real(run.forces)),
                ("time", "µs", |run| 1e6 * run.seconds),
                ("time of its steps", "µs", |run| 1e6 * run.stepping),
            ];
            for (what, unit, read) in read {
                // what is never reached takes for ever
                let value = found.as_ref().map_or(f64::INFINITY, read);
                record.note(format!("{name}: {what} to {words} [{unit}]"), value, LOOSE);
            }
        }
        record.keep(
            Table::raw(name)
                .exact("steps", seen.iter().map(|run| to_real(run.steps)))
                .exact("forces", seen.iter().map(|run| to_real(run.forces)))
                .exact("time [µs]", seen.iter().map(|run| 1e6 * run.seconds))
                .exact("error [px]", seen.iter().map(|run| run.error)),
        );
    }
    let limit = Scheme::Report
        .step_limit(&*trial.system)
        .unwrap_or(f64::NAN);
    let steps = (trial.until / limit).ceil();
    record.note("report: steps at its largest stable step", steps, LOOSE);
    Ok(record)
}

/// Nothing here is compared with `expected/`.
const LOOSE: Tolerance = Tolerance::RelativeOrInfinite(1.0);

const EXACT_IN_ONE: Claim =
    claim("the exact scheme is within 1e-9 in one step [theory]").judged(|r| {
        let error = r.column(Scheme::Etd2.name(), "error")?[0];
        let words = format!("{error:.1e} px after one step of 5 s");
        Ok(Finding::new(error < 1e-9, words))
    });

const CENTRED: Claim = claim(
    "centred damping needs fewer forces than the report's scheme for 1e-3 [D18, D21]",
)
.when(&[less(
    "leapfrog: forces to 1e-3",
    1.0,
    "report: forces to 1e-3",
)]);

const CHOSEN: Claim = claim(
    "where a force has a kink, steps chosen by their error are the cheapest way to 1e-6 [theory]",
)
.judged(|r| judge::fewest_of_all(r, "dormand-prince", "1e-6"));

const HUNDREDTH: Claim = claim(
    "1e-3 in a hundredth of the steps of the report's scheme at its largest stable step [theory]",
)
.judged(|r| judge::share_of_report(r, 1e-2));

const THOUSANDTH: Claim = claim(
    "1e-3 in a thousandth of the steps of the report's scheme at its largest stable step [theory]",
)
.judged(|r| judge::share_of_report(r, 1e-3));

const LEAPFROG_FIRST: Claim = claim(
    "centred damping needs fewer forces than the report's scheme for 1e-6 [D18, D21]",
)
.when(&[less(
    "leapfrog: forces to 1e-6",
    1.0,
    "report: forces to 1e-6",
)]);

const IMPLICIT_FIRST: Claim = claim(
    "one solve a step needs fewer steps than any explicit scheme of order 2 or less [theory]",
)
.when(&[
    less("newmark: steps to 1e-3", 1.0, "report: steps to 1e-3"),
    less("newmark: steps to 1e-3", 1.0, "leapfrog: steps to 1e-3"),
]);

const RING: &str = "A damped ring of 200 nodes in gravity, bent in waves of 2, 3, 5 and 10: μ = γ = ω₀ = g = 1, 5 s. Truth: \
                    each wave's own closed formula.";
const EDGE: &str = "A light stiff ring (μ = 0.01, γ = ω₀ = 1) caught by a smooth round edge, 5 s, judged half way and \
                    at the end. Truth: Dormand and Prince at 1e-12.";

const fn problem(
    id: &'static str,
    title: &'static str,
    question: &'static str,
    claims: &'static [Claim],
    run: fn() -> Result,
) -> Experiment {
    Experiment {
        id,
        title,
        place: "§3.4",
        question,
        claims,
        run,
        draw,
    }
}

pub(crate) const RING_2: Experiment = problem(
    "ring-1e2",
    "Ring, stiffness ratio 1e2",
    RING,
    &[EXACT_IN_ONE, LEAPFROG_FIRST],
    || try_all(ring(1e2, 1.0)),
);

pub(crate) const RING_4: Experiment = problem(
    "ring-1e4",
    "Ring, stiffness ratio 1e4",
    RING,
    &[EXACT_IN_ONE, LEAPFROG_FIRST],
    || try_all(ring(1e4, 1.0)),
);

pub(crate) const RING_6: Experiment = problem(
    "ring-1e6",
    "Ring, stiffness ratio 1e6",
    RING,
    &[EXACT_IN_ONE, LEAPFROG_FIRST, IMPLICIT_FIRST],
    || try_all(ring(1e6, 1.0)),
);

pub(crate) const EDGE_4: Experiment = problem(
    "edge-1e4",
    "Ring on an edge, stiffness ratio 1e4",
    EDGE,
    &[HUNDREDTH],
    || try_all(edge(1e4)),
);

pub(crate) const EDGE_6: Experiment = problem(
    "edge-1e6",
    "Ring on an edge, stiffness ratio 1e6",
    EDGE,
    &[THOUSANDTH],
    || try_all(edge(1e6)),
);

pub(crate) const WALL: Experiment = problem(
    "wall",
    "The rigid ball against a stiff wall",
    "The ball of figure 2.4 flies into a wall that is a spring, and back: 7 s, 40 nodes. Judged half way and at the \
     end; truth: Dormand and Prince at 1e-12. Where a node meets the wall the force has a kink.",
    &[CENTRED, CHOSEN],
    || try_all(wall()),
);

pub(crate) const APPLE: Experiment = problem(
    "apple",
    "The apple",
    "The snake of figures 4.6 to 4.8 in its picture, 80 nodes, the first 20 s. Judged half way and at the end; truth: \
     Dormand and Prince at 1e-11. Between pixels the force is bilinear: kinked at every pixel's border.",
    &[LEAPFROG_FIRST],
    || try_all(apple()),
);

/// The same problem, of which only forces are counted.
macro_rules! counted {
    ($name:ident, $of:ident, $trial:expr) => {
        pub(crate) const $name: Experiment = Experiment {
            run: || try_all($trial.map(Trial::counted)),
            ..$of
        };
    };
}

counted!(RING_2_COUNTED, RING_2, ring(1e2, 1.0));
counted!(RING_4_COUNTED, RING_4, ring(1e4, 1.0));
counted!(RING_6_COUNTED, RING_6, ring(1e6, 1.0));
counted!(EDGE_4_COUNTED, EDGE_4, edge(1e4));
counted!(EDGE_6_COUNTED, EDGE_6, edge(1e6));
counted!(WALL_COUNTED, WALL, wall());
counted!(APPLE_COUNTED, APPLE, apple());
