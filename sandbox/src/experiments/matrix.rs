//! Report §3.2: the elastic matrix as printed, and as it should be.

use crate::prelude::*;
use banded::{Band, Operator};
use elastic::{End, Material, Topology, rms, stiffness, stiffness_as_printed};
use integrator::problems::Springs;
use integrator::{Scheme, Start, State};
use std::f64::consts::PI;

const NODES: usize = 30;
const WEIGHTS: [f64; 3] = [0.1, 10.0, 10.0];
const DAMPING: f64 = 4.0;
const SECONDS: f64 = 30.0;

/// The matrix of §3.2 as printed against the right one.
pub(crate) const MATRIX: Experiment = Experiment {
    id: "sec-3-2",
    title: "The elastic matrix as printed, and as it should be",
    place: "§3.2",
    question: "The text prints K = (ω₀ − 2ω₁ + 6ω₂) I + (ω₁ − 4ω₂) J + ω₂ L; from Eq. 3.2 follows \
               (ω₀ + 2ω₁ + 6ω₂) I − (ω₁ + 4ω₂) J + ω₂ L, and so does the program. Does it matter?",
    claims: &[
        claim("the right matrix resists every wave, the printed one feeds some [D1]").when(&[
            above("right: least of the symbol", 0.0),
            below("printed: least of the symbol", 0.0),
        ]),
        claim("the printed one is indefinite once ω₁² > 4 ω₀ ω₂, by ω₀ − ω₁²/(4ω₂) [D1]").when(&[
            close(
                "printed: least of the symbol",
                "printed: predicted least",
                1e-3,
            ),
        ]),
        claim("a snake with the printed matrix grows without bound, whatever the step [D1]").when(
            &[like(
                "printed: growth rate at dt = *",
                "printed: predicted growth rate",
                0.02,
            )],
        ),
        claim("with the right one it comes back to its shape [report Eq. 3.2]")
            .when(&[below("right: deformation left; share of the first", 0.5)]),
    ],
    run,
    draw,
};

fn right() -> Result<Band> {
    let [tether, tension, rigidity] = WEIGHTS;
    let material = Material::uniform(tether, tension, rigidity);
    Ok(stiffness(
        Topology::open(End::Anchored),
        &material,
        1.0,
        NODES,
    )?)
}

fn printed() -> Result<Band> {
    let [w0, w1, w2] = WEIGHTS;
    Ok(stiffness_as_printed(w0, w1, w2, NODES).map(Band::from)?)
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

fn motion(k: &Band, dt: f64) -> Result<Motion> {
    let mut system = Springs::new(Operator::from(k.clone()), 1.0, DAMPING);
    system.rest = (0..NODES).map(|i| DVec2::new(real(i), 0.0)).collect();
    let bend = |i: usize| (PI * real(i) / real(NODES - 1)).sin();
    let bent = (0..NODES).map(|i| system.rest[i] + DVec2::new(0.0, bend(i)));
    let mut state = State::at_rest(bent.collect());
    let mut stepper = Scheme::Report.start(&mut system, &state, dt, Start::FirstOrder)?;
    let mut sizes = Vec::new();
    let every = 0.5;
    while state.t < SECONDS + 0.5 * dt {
        if state.t >= every * real(sizes.len()) - 0.5 * dt {
            let e = state.x.iter().zip(&system.rest).map(|(x, r)| *x - *r);
            sizes.push((every * real(sizes.len()), rms(&e.collect::<Vec<DVec2>>())));
        }
        stepper.step(&mut system, &mut state)?;
    }
    let last = state.x;
    Ok(Motion { sizes, last })
}

fn run() -> Result {
    let mut record = Record::default();
    let (good, bad) = (right()?, printed()?);
    let angles: Vec<f64> = (0..=360).map(|i| PI * real(i) / 360.0).collect();
    let mut table = Table::new("symbol").with("theta [rad]", ROUNDING, angles.clone());
    let mut shapes =
        Table::new("shape").with("x at the start [px]", ROUNDING, (0..NODES).map(real));
    let mut sizes = Table::new("deformation");
    for (name, k) in [("right", &good), ("printed", &bad)] {
        let values: Vec<f64> = angles.iter().map(|&theta| symbol(k, theta)).collect();
        let lowest = least(values.iter().copied());
        record.note(
            format!("{name}: least of the symbol [M/T²]"),
            lowest,
            ROUNDING,
        );
        table = table.with(format!("{name} [M/T²]"), ROUNDING, values);
        let moved = motion(k, 0.01)?;
        if name == "right" {
            sizes = sizes.with("t [s]", ROUNDING, moved.sizes.iter().map(|p| p.0));
            let left = moved.sizes[moved.sizes.len() - 1].1 / moved.sizes[0].1;
            record.note(
                "right: deformation left; share of the first",
                left,
                share(1e-6),
            );
        } else {
            record.note(
                "printed: growth rate at dt = 0.01 [1/s]",
                rate(&moved.sizes),
                1e-6,
            );
        }
        let size = moved.sizes.iter().map(|p| p.1);
        sizes = sizes.with(format!("{name} [px]"), share(1e-6), size);
        let heights = moved.last.iter().map(|x| x.y);
        shapes = shapes.with(format!("{name}: y at the end [px]"), share(1e-5), heights);
    }
    let fine = rate(&motion(&bad, 0.001)?.sizes);
    record.note("printed: growth rate at dt = 0.001 [1/s]", fine, 1e-6);
    let [w0, w1, w2] = WEIGHTS;
    let predicted = w0 - w1 * w1 / (4.0 * w2);
    record.note("printed: predicted least [M/T²]", predicted, ROUNDING);
    let lowest = least(bad.dense().eigen()?.values);
    record.note("printed: least eigenvalue [M/T²]", lowest, ROUNDING);
    let growth = f64::midpoint(-DAMPING, (DAMPING * DAMPING - 4.0 * lowest).sqrt());
    record.note("printed: predicted growth rate [1/s]", growth, ROUNDING);
    for table in [table, sizes, shapes] {
        record.keep(table);
    }
    Ok(record)
}

/// The e-fold rate of growth over the last third.
fn rate(sizes: &[(f64, f64)]) -> f64 {
    let (from, to) = (sizes[sizes.len() * 2 / 3], sizes[sizes.len() - 1]);
    (to.1 / from.1).ln() / (to.0 - from.0)
}

fn draw(record: &Record) -> Drawn {
    let own = |table: &str, x: &str, y: &str| -> Result<Line> {
        let color = if y == "right" {
            Color::GREEN
        } else {
            Color::RED
        };
        Ok(line(record.points(table, x, y)?, color))
    };
    let zero = line([(0.0, 0.0), (PI, 0.0)], Color::GREY).weighing(0.5);
    let theta = ("turn from node to node θ / rad", 0.0, PI);
    let symbol = plot(
        "stiffness of a wave",
        theta,
        ("λ(θ) / (M/T²)", -20.0, 210.0),
    )
    .legend_at(Corner::TopLeft)
    .with(zero.clone())
    .with(own("symbol", "theta", "right")?.named("right"))
    .with(own("symbol", "theta", "printed")?.named("as printed"));
    let theta = ("θ / rad", 0.0, PI / 2.0);
    let near = plot("the same, near zero", theta, ("λ(θ) / (M/T²)", -4.0, 4.0))
        .legend_at(Corner::BottomRight)
        .with(zero)
        .with(own("symbol", "theta", "right")?)
        .with(own("symbol", "theta", "printed")?.named("negative: it grows"));
    let size = Axis::log("rms deformation / px", 1e-1, 1e5);
    let growth = plot("a bent snake, let go", ("t / s", 0.0, SECONDS), size)
        .legend_at(Corner::TopLeft)
        .with(own("deformation", "t", "right")?.named("right"))
        .with(own("deformation", "t", "printed")?.named("as printed"));
    Artefact::only(
        "Left and middle: how each matrix answers to a wave along the snake. Right: 30 nodes bent once, γ = 4, by \
         the report's scheme.",
        Figure::new("§3.2  The elastic matrix, ω = 0.1, 10, 10, h = 1", 960.0)
            .with(310.0, vec![symbol, near, growth]),
    )
}
