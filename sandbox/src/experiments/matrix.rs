//! Report §3.2: the elastic matrix as printed, and as it should be.

use crate::demand::{above, below, judged};
use crate::draw::{Axis, Color, Corner, Figure, Line, Panel};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use banded::{Band, Operator};
use elastic::{End, Material, Profile, Topology, rms, stiffness, stiffness_as_printed};
use glam::DVec2;
use integrator::problems::Springs;
use integrator::{Scheme, Start, State};
use std::f64::consts::PI;

const ID: &str = "sec-3-2";
const NODES: usize = 30;
const WEIGHTS: [f64; 3] = [0.1, 10.0, 10.0];
const DAMPING: f64 = 4.0;
const SECONDS: f64 = 30.0;

/// The matrix of §3.2 as printed against the right one.
pub(crate) const MATRIX: Experiment = Experiment {
    id: ID,
    title: "The elastic matrix as printed, and as it should be",
    place: "§3.2",
    question: "The text prints K = (ω₀ − 2ω₁ + 6ω₂) I + (ω₁ − 4ω₂) J + ω₂ L; from Eq. 3.2 follows \
               (ω₀ + 2ω₁ + 6ω₂) I − (ω₁ + 4ω₂) J + ω₂ L, and so does the program. Does it matter?",
    claims: &[
        Claim {
            says: "the right matrix resists every wave, the printed one feeds some",
            source: "D1",
            judge: |r| {
                judged(
                    r,
                    &[
                        above("right: least of the symbol", 0.0),
                        below("printed: least of the symbol", 0.0),
                    ],
                )
            },
        },
        Claim {
            says: "the printed one is indefinite once ω₁² > 4 ω₀ ω₂, by ω₀ − ω₁²/(4ω₂)",
            source: "D1",
            judge: |r| {
                let (found, least) = (
                    r.number("printed: least of the symbol")?,
                    r.number("printed: predicted least")?,
                );
                Ok(Finding::new(
                    (found - least).abs() < 1e-3,
                    format!("least {found:.4}, predicted {least:.4}"),
                ))
            },
        },
        Claim {
            says: "a snake with the printed matrix grows without bound, whatever the step",
            source: "D1",
            judge: |r| {
                let (coarse, fine, theory) = (
                    r.number("printed: growth rate at dt = 0.01")?,
                    r.number("printed: growth rate at dt = 0.001")?,
                    r.number("printed: predicted growth rate")?,
                );
                Ok(Finding::new(
                    (coarse / theory - 1.0).abs() < 0.02 && (fine / theory - 1.0).abs() < 0.02,
                    format!(
                        "e-fold rate {coarse:.3}/s at dt = 0.01, {fine:.3}/s at 0.001, predicted {theory:.3}/s"
                    ),
                ))
            },
        },
        Claim {
            says: "with the right one it comes back to its shape",
            source: "report Eq. 3.2",
            judge: |r| {
                judged(
                    r,
                    &[below("right: deformation left; share of the first", 0.5)],
                )
            },
        },
    ],
    run,
    draw,
};

fn right() -> Result<Band, SandboxError> {
    let [tether, tension, rigidity] = WEIGHTS.map(Profile::Uniform);
    let material = Material {
        tether,
        tension,
        rigidity,
        higher: Vec::new(),
    };
    stiffness(Topology::open(End::Anchored), &material, 1.0, NODES)
        .map_err(SandboxError::refused(ID))
}

fn printed() -> Result<Band, SandboxError> {
    let [w0, w1, w2] = WEIGHTS;
    stiffness_as_printed(w0, w1, w2, NODES)
        .map(Band::from)
        .map_err(SandboxError::refused(ID))
}

/// The stiffness of the wave that turns by θ from node to node, read off a row in the middle.
fn symbol(k: &Band, theta: f64) -> f64 {
    let row = NODES / 2;
    (row - 2..=row + 2)
        .map(|j| k.entry(row, j) * (theta * (real(j) - real(row))).cos())
        .sum()
}

struct Motion {
    sizes: Vec<(f64, f64)>,
    last: Vec<DVec2>,
}

fn motion(k: &Band, dt: f64) -> Result<Motion, SandboxError> {
    let mut system = Springs::new(Operator::from(k.clone()), 1.0, DAMPING);
    system.rest = (0..NODES).map(|i| DVec2::new(real(i), 0.0)).collect();
    let bend = |i: usize| (PI * real(i) / real(NODES - 1)).sin();
    let start = (0..NODES)
        .map(|i| system.rest[i] + DVec2::new(0.0, bend(i)))
        .collect();
    let mut state = State::at_rest(start);
    let mut stepper = Scheme::Report
        .start(&mut system, &state, dt, Start::FirstOrder)
        .map_err(SandboxError::refused(ID))?;
    let mut sizes = Vec::new();
    let every = 0.5;
    while state.t < SECONDS + 0.5 * dt {
        if state.t >= every * real(sizes.len()) - 0.5 * dt {
            let e: Vec<DVec2> = state
                .x
                .iter()
                .zip(&system.rest)
                .map(|(x, r)| *x - *r)
                .collect();
            sizes.push((every * real(sizes.len()), rms(&e)));
        }
        stepper
            .step(&mut system, &mut state)
            .map_err(SandboxError::refused(ID))?;
    }
    Ok(Motion {
        sizes,
        last: state.x,
    })
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let (good, bad) = (right()?, printed()?);
    let angles: Vec<f64> = (0..=360).map(|i| PI * real(i) / 360.0).collect();
    let mut table = Table::new("symbol").with("theta", "rad", Tolerance::ROUNDING, angles.clone());
    let mut shapes = Table::new("shape").with(
        "x at the start",
        "px",
        Tolerance::ROUNDING,
        (0..NODES).map(real).collect(),
    );
    let mut sizes = Table::new("deformation");
    for (name, k) in [("right", &good), ("printed", &bad)] {
        let values: Vec<f64> = angles.iter().map(|&theta| symbol(k, theta)).collect();
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        record.note(
            format!("{name}: least of the symbol"),
            least,
            "M/T²",
            Tolerance::ROUNDING,
        );
        table = table.with(name, "M/T²", Tolerance::ROUNDING, values);
        let moved = motion(k, 0.01)?;
        if name == "right" {
            let (times, values) = moved.sizes.iter().copied().unzip();
            sizes = sizes.with("t", "s", Tolerance::ROUNDING, times).with(
                name,
                "px",
                Tolerance::Relative(1e-6),
                values,
            );
            let left = moved.sizes[moved.sizes.len() - 1].1 / moved.sizes[0].1;
            record.note(
                "right: deformation left; share of the first",
                left,
                "",
                Tolerance::Relative(1e-6),
            );
        } else {
            let values = moved.sizes.iter().map(|p| p.1).collect();
            sizes = sizes.with(name, "px", Tolerance::Relative(1e-6), values);
            record.note(
                "printed: growth rate at dt = 0.01",
                rate(&moved.sizes),
                "1/s",
                Tolerance::Absolute(1e-6),
            );
        }
        let heights = moved.last.iter().map(|x| x.y).collect();
        shapes = shapes.with(
            format!("{name}: y at the end"),
            "px",
            Tolerance::Relative(1e-5),
            heights,
        );
    }
    let fine = motion(&bad, 0.001)?;
    record.note(
        "printed: growth rate at dt = 0.001",
        rate(&fine.sizes),
        "1/s",
        Tolerance::Absolute(1e-6),
    );
    let [w0, w1, w2] = WEIGHTS;
    record.note(
        "printed: predicted least",
        w0 - w1 * w1 / (4.0 * w2),
        "M/T²",
        Tolerance::ROUNDING,
    );
    let eigen = bad.dense().eigen().map_err(SandboxError::refused(ID))?;
    let least = eigen.values.iter().copied().fold(f64::INFINITY, f64::min);
    record.note(
        "printed: least eigenvalue",
        least,
        "M/T²",
        Tolerance::ROUNDING,
    );
    let growth = f64::midpoint(-DAMPING, (DAMPING * DAMPING - 4.0 * least).sqrt());
    record.note(
        "printed: predicted growth rate",
        growth,
        "1/s",
        Tolerance::ROUNDING,
    );
    record.keep(table);
    record.keep(sizes);
    record.keep(shapes);
    Ok(record)
}

/// The e-fold rate of growth over the last third.
fn rate(sizes: &[(f64, f64)]) -> f64 {
    let (from, to) = (sizes[sizes.len() * 2 / 3], sizes[sizes.len() - 1]);
    (to.1 / from.1).ln() / (to.0 - from.0)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let line = |table: &str, x: &str, y: &str, color: Color| -> Result<Line, SandboxError> {
        Ok(Line::new(record.points(table, x, y)?, color))
    };
    let zero = Line::new(vec![(0.0, 0.0), (PI, 0.0)], Color::GREY).weighing(0.5);
    let symbol = Panel::new(
        "stiffness of a wave",
        Axis::new("turn from node to node θ / rad", 0.0, PI),
        Axis::new("λ(θ) / (M/T²)", -20.0, 210.0),
    )
    .legend_at(Corner::TopLeft)
    .with(zero.clone())
    .with(line("symbol", "theta", "right", Color::GREEN)?.named("right"))
    .with(line("symbol", "theta", "printed", Color::RED)?.named("as printed"));
    let near = Panel::new(
        "the same, near zero",
        Axis::new("θ / rad", 0.0, PI / 2.0),
        Axis::new("λ(θ) / (M/T²)", -4.0, 4.0),
    )
    .legend_at(Corner::BottomRight)
    .with(zero)
    .with(line("symbol", "theta", "right", Color::GREEN)?)
    .with(line("symbol", "theta", "printed", Color::RED)?.named("negative: it grows"));
    let growth = Panel::new(
        "a bent snake, let go",
        Axis::new("t / s", 0.0, SECONDS),
        Axis::log("rms deformation / px", 1e-1, 1e5),
    )
    .legend_at(Corner::TopLeft)
    .with(line("deformation", "t", "right", Color::GREEN)?.named("right"))
    .with(line("deformation", "t", "printed", Color::RED)?.named("as printed"));
    let figure = Figure::new("§3.2  The elastic matrix, ω = 0.1, 10, 10, h = 1", 960.0)
        .with(310.0, vec![symbol, near, growth]);
    Ok(vec![Artefact::figure(
        "Left and middle: how each matrix answers to a wave along the snake. Right: 30 nodes bent once, γ = 4, by \
         the report's scheme.",
        figure,
    )])
}
