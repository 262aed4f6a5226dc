//! Report §3.4.3: how large a step, and what a small one costs.

use crate::draw::{Axis, Color, Corner, Figure, Layer, Line, Panel};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use banded::Operator;
use elastic::{End, Material, Profile, Topology, rms, stiffness};
use glam::DVec2;
use integrator::problems::Springs;
use integrator::{Scheme, Start, State};

const ID: &str = "sec-3-4-3";
const NODES: usize = 30;
const SPACING: f64 = 1.288;
const SCHEMES: [(Scheme, Start); 2] = [
    (Scheme::Report, Start::FirstOrder),
    (Scheme::Leapfrog, Start::SecondOrder),
];
/// How far the shape is bent at the start, in pixels.
const BEND: f64 = 4.0;
/// At rest: deformation below this share of the first.
const REST: f64 = 1e-3;

/// Time to rest and instability against the step.
pub(crate) const TIME_STEP: Experiment = Experiment {
    id: ID,
    title: "The time parameter",
    place: "§3.4.3",
    question: "How large may Δt be, and what does a small one cost? A snake of 30 nodes as the report's program \
               builds it (ω = 0.1, 10, 10; h = 1.288; μ = 1; γ = 4) is let go from a bent and jagged shape, with \
               the report's scheme and with centred damping, at steps from a hundredth of the limit to beyond it.",
    claims: &[
        Claim {
            says: "a large Δt leads to instability, beyond a limit known before the run",
            source: "report §3.4.3, D24",
            judge: |r| {
                let (found, limit) = (
                    r.number("report: measured limit")?,
                    r.number("report: predicted limit")?,
                );
                Ok(Finding::new(
                    (found / limit - 1.0).abs() < 2e-3,
                    format!("predicted {limit:.5} s, measured {found:.5} s"),
                ))
            },
        },
        Claim {
            says: "the limit holds for every damping, and for centred damping too",
            source: "theory",
            judge: |r| {
                let worst = r.number("worst share of a measured limit off its prediction")?;
                let count = r.told_column("limits", "damping")?.len() * 2;
                Ok(Finding::new(
                    worst < 2e-3,
                    format!("{count} limits, the worst off by {:.2} %", 100.0 * worst),
                ))
            },
        },
        Claim {
            says: "a small Δt slows the way to equilibrium: so many more steps",
            source: "report §3.4.3",
            judge: |r| {
                let slope = r.number("report: slope of log steps over log dt")?;
                let (small, large) = (
                    r.told("report: steps to rest; smallest dt")?,
                    r.told("report: fewest steps to rest")?,
                );
                Ok(Finding::new(
                    (slope + 1.0).abs() < 0.03,
                    format!(
                        "{small} steps at the smallest, {large} at best; steps ∝ Δt^{slope:.2}"
                    ),
                ))
            },
        },
        Claim {
            says: "time to rest itself hardly depends on Δt",
            source: "theory",
            judge: |r| {
                let spread =
                    r.number("report: spread of the time to rest below 0.8 of the limit")?;
                let time = r.told("report: time to rest; smallest dt")?;
                Ok(Finding::new(
                    spread < 0.05,
                    format!("{time:.0} s, within {:.1} %", 100.0 * spread),
                ))
            },
        },
        Claim {
            says: "damping lowers the limit of the report's scheme, not that of centred damping",
            source: "D18",
            judge: |r| {
                let report = r.column("limits", "report measured")?;
                let leapfrog = r.column("limits", "leapfrog measured")?;
                let (Some(last), Some(first)) = (report.last(), report.first()) else {
                    return Ok(Finding::new(false, "no limits"));
                };
                let steady = leapfrog
                    .iter()
                    .all(|dt| (dt / leapfrog[0] - 1.0).abs() < 1e-3);
                Ok(Finding::new(
                    steady && *last < 0.2 * first,
                    format!(
                        "{first:.4} s without damping, {last:.4} s at γ = 100; centred {:.4} s",
                        leapfrog[0]
                    ),
                ))
            },
        },
    ],
    run,
    draw,
};

/// The snake, bent by `bend` pixels and jagged by a twentieth of one.
fn snake(damping: f64, bend: f64) -> Result<(Springs, State), SandboxError> {
    let material = Material {
        tether: Profile::Uniform(0.1),
        tension: Profile::Uniform(10.0),
        rigidity: Profile::Uniform(10.0),
        higher: Vec::new(),
    };
    let k = stiffness(Topology::open(End::Anchored), &material, SPACING, NODES)
        .map_err(SandboxError::refused(ID))?;
    let mut system = Springs::new(Operator::from(k), 1.0, damping);
    system.rest = (0..NODES)
        .map(|i| DVec2::new(SPACING * real(i), 0.0))
        .collect();
    let start = system
        .rest
        .iter()
        .enumerate()
        .map(|(i, rest)| {
            let s = real(i) / real(NODES - 1);
            let jag = if i % 2 == 0 { 0.05 } else { -0.05 };
            *rest + DVec2::new(0.0, bend * (std::f64::consts::PI * s).sin() + jag)
        })
        .collect();
    Ok((system, State::at_rest(start)))
}

/// The rms deformation after every step, until `steps` or until it is beyond recognition.
fn deformations(
    scheme: (Scheme, Start),
    (damping, bend): (f64, f64),
    dt: f64,
    steps: usize,
    until: f64,
) -> Result<Vec<f64>, SandboxError> {
    let (mut system, mut state) = snake(damping, bend)?;
    let size = |system: &Springs, state: &State| {
        let e: Vec<DVec2> = state
            .x
            .iter()
            .zip(&system.rest)
            .map(|(x, r)| *x - *r)
            .collect();
        rms(&e)
    };
    let first = size(&system, &state);
    let mut stepper = scheme
        .0
        .start(&mut system, &state, dt, scheme.1)
        .map_err(SandboxError::refused(ID))?;
    let mut out = vec![first];
    for _ in 0..steps {
        if stepper.step(&mut system, &mut state).is_err() {
            out.push(f64::INFINITY);
            break;
        }
        let now = size(&system, &state);
        out.push(now);
        if now > 1e6 * first || now < until * first {
            break;
        }
    }
    Ok(out)
}

/// The largest step with which nothing grows, by bisection on runs from a jagged shape.
fn measured_limit(
    scheme: (Scheme, Start),
    damping: f64,
    predicted: f64,
) -> Result<f64, SandboxError> {
    let (mut low, mut high) = (0.9 * predicted, 1.1 * predicted);
    while high - low > 2e-4 * predicted {
        let dt = f64::midpoint(low, high);
        let sizes = deformations(scheme, (damping, 0.0), dt, 20_000, 0.0)?;
        let largest = |part: &[f64]| part.iter().copied().fold(0.0, f64::max);
        let grows =
            sizes.len() <= 20_000 || largest(&sizes[15_000..]) > 1.5 * largest(&sizes[..10_000]);
        if grows {
            high = dt;
        } else {
            low = dt;
        }
    }
    Ok(f64::midpoint(low, high))
}

fn predicted(scheme: Scheme, damping: f64) -> Result<f64, SandboxError> {
    let (system, _) = snake(damping, BEND)?;
    Ok(scheme.step_limit(&system).unwrap_or(f64::INFINITY))
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    limits(&mut record)?;
    time_to_rest(&mut record)?;
    let limit = predicted(Scheme::Report, 4.0)?;
    let mut growth =
        Table::new("growth").with("step", "", Tolerance::EXACT, (0..=400).map(real).collect());
    for (name, share) in [
        ("0.9", 0.9),
        ("0.99", 0.99),
        ("1.001", 1.001),
        ("1.01", 1.01),
        ("1.1", 1.1),
    ] {
        let sizes = deformations(SCHEMES[0], (4.0, BEND), share * limit, 400, 0.0)?;
        growth = growth.with(
            format!("{name} of the limit"),
            "px",
            Tolerance::Relative(1e-6),
            sizes,
        );
    }
    record.keep(growth);
    Ok(record)
}

fn limits(record: &mut Record) -> Result<(), SandboxError> {
    let dampings = vec![0.0, 2.0, 4.0, 10.0, 20.0, 40.0, 100.0];
    let mut worst = 0.0_f64;
    let mut table = Table::new("limits").with("damping", "M/T", Tolerance::EXACT, dampings.clone());
    for scheme in SCHEMES {
        let (mut theory, mut runs) = (Vec::new(), Vec::new());
        for &damping in &dampings {
            let limit = predicted(scheme.0, damping)?;
            let found = measured_limit(scheme, damping, limit)?;
            worst = worst.max((found / limit - 1.0).abs());
            theory.push(limit);
            runs.push(found);
        }
        let name = scheme.0.name();
        record.note(
            format!("{name}: predicted limit"),
            theory[2],
            "s",
            Tolerance::ROUNDING,
        );
        record.note(
            format!("{name}: measured limit"),
            runs[2],
            "s",
            Tolerance::Relative(1e-3),
        );
        table = table
            .with(
                format!("{name} predicted"),
                "s",
                Tolerance::ROUNDING,
                theory,
            )
            .with(
                format!("{name} measured"),
                "s",
                Tolerance::Relative(1e-3),
                runs,
            );
    }
    record.note(
        "worst share of a measured limit off its prediction",
        worst,
        "",
        Tolerance::Relative(0.5),
    );
    record.keep(table);
    Ok(())
}

fn time_to_rest(record: &mut Record) -> Result<(), SandboxError> {
    let shares = [
        0.01, 0.02, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 0.9, 0.95, 0.98, 0.99, 0.999,
    ];
    let mut table =
        Table::new("rest").with("share of the limit", "", Tolerance::EXACT, shares.to_vec());
    for scheme in SCHEMES {
        let name = scheme.0.name();
        let limit = predicted(scheme.0, 4.0)?;
        let mut counts = Vec::new();
        for share in shares {
            let sizes = deformations(scheme, (4.0, BEND), share * limit, 200_000, REST)?;
            counts.push(real(sizes.len() - 1));
        }
        let steps: Vec<f64> = shares.iter().map(|share| share * limit).collect();
        let times: Vec<f64> = counts
            .iter()
            .zip(&steps)
            .map(|(count, dt)| count * dt)
            .collect();
        let calm = &times[..8];
        let (least, most) = calm
            .iter()
            .fold((f64::INFINITY, 0.0_f64), |(a, b), &t| (a.min(t), b.max(t)));
        let slope = (counts[6] / counts[0]).ln() / (steps[6] / steps[0]).ln();
        let fewest = counts.iter().copied().fold(f64::INFINITY, f64::min);
        record.note(
            format!("{name}: steps to rest; smallest dt"),
            counts[0],
            "",
            Tolerance::Absolute(1.0),
        );
        record.note(
            format!("{name}: fewest steps to rest"),
            fewest,
            "",
            Tolerance::Absolute(1.0),
        );
        record.note(
            format!("{name}: slope of log steps over log dt"),
            slope,
            "",
            Tolerance::Absolute(1e-3),
        );
        record.note(
            format!("{name}: time to rest; smallest dt"),
            times[0],
            "s",
            Tolerance::Relative(1e-3),
        );
        record.note(
            format!("{name}: spread of the time to rest below 0.8 of the limit"),
            most / least - 1.0,
            "",
            Tolerance::Relative(0.3),
        );
        table = table
            .with(format!("{name} dt"), "s", Tolerance::ROUNDING, steps)
            .with(
                format!("{name} steps"),
                "",
                Tolerance::Absolute(1.0),
                counts,
            )
            .with(
                format!("{name} time"),
                "s",
                Tolerance::Relative(1e-3),
                times,
            );
    }
    record.keep(table);
    Ok(())
}

fn dots(points: Vec<(f64, f64)>, color: Color, label: &str) -> Layer {
    Layer::Dots {
        points,
        radius: 1.8,
        color,
        label: label.to_owned(),
    }
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let colors = [Color::BLUE, Color::GREEN];
    let names = ["report's scheme", "centred damping"];
    let mut steps = Panel::new(
        "steps until at rest",
        Axis::log("Δt / s", 1e-3, 1.0),
        Axis::log("steps", 1e2, 1e6),
    );
    let mut limit = Panel::new(
        "largest stable step",
        Axis::new("damping γ / (M/T)", 0.0, 105.0),
        Axis::new("Δt / s", 0.0, 0.36),
    );
    for ((scheme, color), name) in SCHEMES.into_iter().zip(colors).zip(names) {
        let id = scheme.0.name();
        let points = record.points("rest", &format!("{id} dt"), &format!("{id} steps"))?;
        let border = record.number(&format!("{id}: predicted limit"))?;
        steps = steps
            .with(Line::new(points.clone(), color).named(name))
            .with(dots(points, color, ""))
            .with(
                Line::new(vec![(border, 1e2), (border, 1e6)], color)
                    .dashed()
                    .weighing(0.7)
                    .named("its limit"),
            );
        let theory = record.points("limits", "damping", &format!("{id} predicted"))?;
        let found = record.points("limits", "damping", &format!("{id} measured"))?;
        let line = if scheme.0 == Scheme::Report {
            // between the rows the border is smooth: λ dt² + 2 γ dt = 4 μ
            let stiff = 4.0 / (theory[0].1 * theory[0].1);
            (0..=200)
                .map(|i| real(i) * 0.5)
                .map(|g| (g, 4.0 / (g + (g * g + 4.0 * stiff).sqrt())))
                .collect()
        } else {
            theory
        };
        limit = limit
            .with(Line::new(line, color).named(format!("{name}, predicted")))
            .with(dots(found, color, "measured"));
    }
    let mut growth = Panel::new(
        "the report's scheme at multiples of its limit",
        Axis::new("step", 0.0, 400.0),
        Axis::log("rms deformation / px", 1e-2, 1e4),
    );
    let palette = [
        Color::BLUE,
        Color::SKY,
        Color::ORANGE,
        Color::RED,
        Color::PURPLE,
    ];
    for (name, color) in ["0.9", "0.99", "1.001", "1.01", "1.1"]
        .into_iter()
        .zip(palette)
    {
        let points = record.points("growth", "step", &format!("{name} of the limit"))?;
        growth = growth.with(Line::new(points, color).named(format!("{name} of the limit")));
    }
    let figure = Figure::new("§3.4.3  The time parameter", 960.0).with(
        330.0,
        vec![
            steps.legend_at(Corner::BottomLeft),
            growth.legend_at(Corner::TopRight),
            limit.legend_at(Corner::TopRight),
        ],
    );
    Ok(vec![Artefact::figure(
        "Left: the price of small steps, and the border. Middle: what happens about the border. Right: the border \
         for each damping; dots from bisection on runs.",
        figure,
    )])
}
