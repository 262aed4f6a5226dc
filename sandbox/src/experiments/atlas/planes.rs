//! The three planes.

use super::plane::{LEFT_OUT, Plane};
use super::regime::{NODES, Point, SPACING};
use crate::prelude::*;
use integrator::Scheme;

const ON_THEIR_GROUND: Claim = claim(
    "every measured dot that is not within 2 % of a border lies on the ground predicted for it \
     [theory, errata §7]",
)
.when(&[
    below("*: dots off their prediction", 0.5),
    // who left most dots out could not be wrong
    below("*: dots within 2 % of a border", LEFT_OUT),
]);

/// The ring of all planes, unless the plane says otherwise.
const RING: Point = Point {
    mass: 1.0,
    damping: 2.0,
    material: [0.5, 10.0, 4.0],
    dt: 0.05,
};

const MASS_PLANE: Plane = Plane {
    title: "Mass and damping: the ring at Δt = 0.05 s",
    x: ("mass μ / M", 0.02, 20.0),
    y: ("damping γ / (M/T)", 0.2, 2000.0),
    at: |mass, damping| Point {
        mass,
        damping,
        ..RING
    },
    borders: &[
        (
            "γ = 2 √(μ λ), slowest mode",
            |mass| critical(mass, RING.stiffness()[0]),
            None,
        ),
        (
            "γ = 2 √(μ λ), fastest mode",
            |mass| critical(mass, RING.stiffness()[1]),
            None,
        ),
    ],
    caption: "Ground: what the roots of one step say. Dots: what a run of the whole ring did. Lines: the equation of \
              motion itself. On the left, more damping ends in a blow-up (D18); on the right it never does.",
};

/// 2 √(μ λ).
fn critical(mass: f64, stiffness: f64) -> f64 {
    integrator::critical_damping(mass, stiffness)
}

/// Regimes over mass and damping.
pub(crate) const MASS: Experiment = Experiment {
    id: "atlas-mass",
    title: "Regimes over mass and damping",
    place: "§3.4.2, §3.4.3",
    question: "For which masses and dampings does a snake swing, creep, or blow up? The report's advice is to \
               add damping when it swings.",
    claims: &[
        ON_THEIR_GROUND,
        claim("under the report's scheme more damping ends in a blow-up; under centred damping it has \
               no say [D18]")
            .judged(|r| {
                let [weak, strong] = blow_ups(r, Scheme::Report)?;
                let [least, most] = blow_ups(r, Scheme::Leapfrog)?;
                let found = format!(
                    "of 15 masses {weak} blow up at the weakest damping and {strong} at the strongest, \
                     centred {least} and {most}"
                );
                Ok(Finding::new(strong > weak && least == most, found))
            }),
        claim("between 2 √(μ λ) of the slowest mode and of the fastest, some modes ring while others \
               creep [D23]")
            .when(&[above("leapfrog: slow modes creep; fast ones ring", 10.0)]),
    ],
    run: || MASS_PLANE.run(),
    draw: |record| MASS_PLANE.draw(record),
};

/// Blow-ups among the dots of the lowest row of the first plane, and of the highest.
fn blow_ups(record: &Record, scheme: Scheme) -> Result<[usize; 2]> {
    let y = record.column(scheme.name(), MASS_PLANE.y.0)?;
    let found = record.column(scheme.name(), "measured")?;
    let row = |end: f64| {
        let dots = y.iter().zip(found);
        let row = dots.filter(|(y, _)| (**y / end - 1.0).abs() < 1e-9);
        row.filter(|(_, found)| **found > 3.5).count()
    };
    Ok([row(least(y.iter().copied())), row(most(y.iter().copied()))])
}

const STIFFNESS_PLANE: Plane = Plane {
    title: "Tension and rigidity: the ring with μ = 1 M, γ = 12 M/T at Δt = 0.05 s",
    x: ("tension ω₁ / (M px²/T²)", 0.1, 3000.0),
    y: ("rigidity ω₂ / (M px⁴/T²)", 0.01, 1000.0),
    at: |tension, rigidity| Point {
        damping: 12.0,
        material: [RING.material[0], tension, rigidity],
        ..RING
    },
    borders: &[
        (
            "λ = γ²/4μ, slowest mode",
            |tension| rigidity_for(36.0, tension, 1),
            None,
        ),
        (
            "λ = γ²/4μ, fastest mode",
            |tension| rigidity_for(36.0, tension, NODES / 2),
            None,
        ),
        (
            "λ Δt² + 2 γ Δt = 4 μ, fastest mode",
            |tension| rigidity_for(1120.0, tension, NODES / 2),
            Some(Scheme::Report),
        ),
        (
            "λ Δt² = 4 μ, fastest mode",
            |tension| rigidity_for(1600.0, tension, NODES / 2),
            Some(Scheme::Leapfrog),
        ),
    ],
    caption: "Ground: what the roots of one step say. Dots: what a run of the whole ring did. The borders are straight \
              lines of 4 ω₁ s/h² + 16 ω₂ s²/h⁴ = λ − ω₀ in linear axes: stiffness of either kind ends in the same blow-up.",
};

/// The rigidity that gives mode `k` the stiffness `lambda` beside a tension.
fn rigidity_for(lambda: f64, tension: f64, k: usize) -> f64 {
    let s = (std::f64::consts::PI * real(k) / real(NODES)).sin().powi(2);
    let left = lambda - RING.material[0] - 4.0 * tension * s / SPACING.powi(2);
    left * SPACING.powi(4) / (16.0 * s * s)
}

/// Regimes over tension and rigidity.
pub(crate) const STIFFNESS: Experiment = Experiment {
    id: "atlas-stiffness",
    title: "Regimes over tension and rigidity",
    place: "§3.2, §3.4",
    question: "How stiff may a snake be, in tension and in rigidity, and when does stiffness make it swing?",
    claims: &[
        ON_THEIR_GROUND,
        claim("the report's scheme blows up before centred damping does [D18]").when(&[more(
            "report: blows up",
            1.0,
            "leapfrog: blows up",
        )]),
    ],
    run: || STIFFNESS_PLANE.run(),
    draw: |record| STIFFNESS_PLANE.draw(record),
};

const STEP_PLANE: Plane = Plane {
    title: "Step and damping: the ring with μ = 1 M",
    x: ("Δt / s", 0.003, 1.0),
    y: ("damping γ / (M/T)", 0.3, 300.0),
    at: |dt, damping| Point {
        dt,
        damping,
        ..RING
    },
    borders: &[
        (
            "γ = 2 √(μ λ), fastest mode",
            |_| critical(1.0, RING.stiffness()[1]),
            None,
        ),
        (
            "λ Δt² + 2 γ Δt = 4 μ, fastest mode",
            |dt| (4.0 - RING.stiffness()[1] * dt * dt) / (2.0 * dt),
            Some(Scheme::Report),
        ),
    ],
    caption: "Ground: what the roots of one step say. Dots: what a run of the whole ring did. Between creeping and \
              blowing up lies a strip where a mode changes sides at every step: stable, and wrong.",
};

/// Regimes over step and damping.
pub(crate) const STEP: Experiment = Experiment {
    id: "atlas-step",
    title: "Regimes over step and damping",
    place: "§3.4.3",
    question: "\"If Δt is too large, the program will be unstable\": where, and what happens just before?",
    claims: &[
        ON_THEIR_GROUND,
        claim("before it blows up a creeping snake zigzags: stable, and wrong [theory]").when(&[
            above("report: a mode zigzags", 0.5),
            above("leapfrog: a mode zigzags", 3.0),
        ]),
        claim("centred damping allows one and the same step at any damping [D18]").judged(|r| {
            let x = r.column("leapfrog", STEP_PLANE.x.0)?;
            let found = r.column("leapfrog", "measured")?;
            let limit = 2.0 / RING.stiffness()[1].sqrt();
            let mut dots = x.iter().zip(found);
            let apart = dots.all(|(x, found)| (*x > limit) == (*found > 3.5));
            Ok(Finding::new(
                apart,
                format!("Δt = {limit:.4} s parts them all"),
            ))
        }),
    ],
    run: || STEP_PLANE.run(),
    draw: |record| STEP_PLANE.draw(record),
};
