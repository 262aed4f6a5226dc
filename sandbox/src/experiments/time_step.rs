//! Report §3.4.3: how large a step, and what a small one costs.

use crate::prelude::*;
use banded::Operator;
use elastic::{End, Material, Topology, rms, stiffness};
use integrator::problems::Springs;
use integrator::{Scheme, Start, State};

const NODES: usize = 30;
const SPACING: f64 = 1.288;
const SCHEMES: [(Scheme, Start); 2] = [
    (Scheme::Report, Start::FirstOrder),
    (Scheme::Leapfrog, Start::SecondOrder),
];
/// How far the shape is bent at the start, in pixels.
const BEND: f64 = 4.0;
/// Steps about the limit that are looked at closely, as shares of it.
const ABOUT: [f64; 5] = [0.9, 0.99, 1.001, 1.01, 1.1];
/// At rest: deformation below this share of the first.
const REST: f64 = 1e-3;

/// Time to rest and instability against the step.
pub(crate) const TIME_STEP: Experiment = Experiment {
    id: "sec-3-4-3",
    title: "The time parameter",
    place: "§3.4.3",
    question: "How large may Δt be, and what does a small one cost? A snake of 30 nodes as the report's program \
               builds it (ω = 0.1, 10, 10; h = 1.288; μ = 1; γ = 4) is let go from a bent and jagged shape, with \
               the report's scheme and with centred damping, at steps from a hundredth of the limit to beyond it.",
    claims: &[
        claim("a large Δt leads to instability, beyond a limit known before the run [report §3.4.3, D24]")
            .when(&[like("report: measured limit", "report: predicted limit", 2e-3)]),
        claim("the limit holds for every damping, and for centred damping too [theory]")
            .when(&[below("worst share of a measured limit off its prediction", 2e-3)]),
        claim("a small Δt slows the way to equilibrium: so many more steps [report §3.4.3]")
            .when(&[near("report: slope of log steps over log dt", -1.0, 0.03)]),
        claim("time to rest itself hardly depends on Δt [theory]")
            .when(&[below("report: spread of the time to rest below 0.8 of the limit", 0.05)]),
        claim("damping lowers the limit of the report's scheme, not that of centred damping [D18]")
            .judged(|r| {
                let report = r.column("limits", "report measured")?;
                let leapfrog = r.column("limits", "leapfrog measured")?;
                let (first, last) = (report[0], report[report.len() - 1]);
                let steady = leapfrog.iter().all(|dt| (dt / leapfrog[0] - 1.0).abs() < 1e-3);
                Ok(Finding::new(
                    steady && last < 0.2 * first,
                    format!(
                        "{first:.4} s without damping, {last:.4} s at γ = 100; centred {:.4} s",
                        leapfrog[0]
                    ),
                ))
            }),
    ],
    run,
    draw,
};

/// The snake, bent by `bend` pixels and jagged by a twentieth of one.
fn snake(damping: f64, bend: f64) -> Result<(Springs, State)> {
    let material = Material::uniform(0.1, 10.0, 10.0);
    let k = stiffness(Topology::open(End::Anchored), &material, SPACING, NODES)?;
    let mut system = Springs::new(Operator::from(k), 1.0, damping);
    system.rest = (0..NODES)
        .map(|i| DVec2::new(SPACING * real(i), 0.0))
        .collect();
    let moved = system.rest.iter().enumerate().map(|(i, rest)| {
        let s = real(i) / real(NODES - 1);
        let jag = if i % 2 == 0 { 0.05 } else { -0.05 };
        *rest + DVec2::new(0.0, bend * (std::f64::consts::PI * s).sin() + jag)
    });
    let state = State::at_rest(moved.collect());
    Ok((system, state))
}

/// The rms deformation after every step, until `steps` or until it is beyond recognition.
fn deformations(
    (scheme, start): (Scheme, Start),
    (damping, bend): (f64, f64),
    dt: f64,
    steps: usize,
    until: f64,
) -> Result<Vec<f64>> {
    let (mut system, mut state) = snake(damping, bend)?;
    let size = |system: &Springs, state: &State| {
        let e = state.x.iter().zip(&system.rest).map(|(x, r)| *x - *r);
        rms(&e.collect::<Vec<DVec2>>())
    };
    let first = size(&system, &state);
    let mut stepper = scheme.start(&mut system, &state, dt, start)?;
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
fn measured_limit(scheme: (Scheme, Start), damping: f64, predicted: f64) -> Result<f64> {
    let (mut low, mut high) = (0.9 * predicted, 1.1 * predicted);
    while high - low > 2e-4 * predicted {
        let dt = f64::midpoint(low, high);
        let sizes = deformations(scheme, (damping, 0.0), dt, 20_000, 0.0)?;
        let largest = |part: &[f64]| most(part.iter().copied());
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

fn predicted(scheme: Scheme, damping: f64) -> Result<f64> {
    let (system, _) = snake(damping, BEND)?;
    Ok(scheme.step_limit(&system).unwrap_or(f64::INFINITY))
}

fn run() -> Result {
    let mut record = Record::default();
    limits(&mut record)?;
    time_to_rest(&mut record)?;
    let limit = predicted(Scheme::Report, 4.0)?;
    let mut growth = Table::new("growth").exact("step", (0..=400).map(real));
    for share_of_limit in ABOUT {
        let sizes = deformations(SCHEMES[0], (4.0, BEND), share_of_limit * limit, 400, 0.0)?;
        let name = format!("{share_of_limit} of the limit [px]");
        growth = growth.with(name, share(1e-6), sizes);
    }
    record.keep(growth);
    Ok(record)
}

fn limits(record: &mut Record) -> Result<()> {
    let dampings = [0.0, 2.0, 4.0, 10.0, 20.0, 40.0, 100.0];
    let mut worst = 0.0_f64;
    let mut table = Table::new("limits").exact("damping [M/T]", dampings);
    for scheme in SCHEMES {
        let (mut theory, mut runs) = (Vec::new(), Vec::new());
        for damping in dampings {
            let limit = predicted(scheme.0, damping)?;
            let found = measured_limit(scheme, damping, limit)?;
            worst = worst.max((found / limit - 1.0).abs());
            theory.push(limit);
            runs.push(found);
        }
        let name = scheme.0.name();
        let mut own = record.under(name);
        own.note("predicted limit [s]", theory[2], ROUNDING);
        own.note("measured limit [s]", runs[2], share(1e-3));
        table = table
            .with(format!("{name} predicted [s]"), ROUNDING, theory)
            .with(format!("{name} measured [s]"), share(1e-3), runs);
    }
    record.note(
        "worst share of a measured limit off its prediction",
        worst,
        share(0.5),
    );
    record.keep(table);
    Ok(())
}

fn time_to_rest(record: &mut Record) -> Result<()> {
    let shares = [
        0.01, 0.02, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 0.9, 0.95, 0.98, 0.99, 0.999,
    ];
    let mut table = Table::new("rest").exact("share of the limit", shares);
    for scheme in SCHEMES {
        let name = scheme.0.name();
        let limit = predicted(scheme.0, 4.0)?;
        let steps = shares.map(|share| share * limit);
        let counts = steps.map(|dt| deformations(scheme, (4.0, BEND), dt, 200_000, REST));
        let counts = counts.into_iter().map(|sizes| Ok(real(sizes?.len() - 1)));
        let counts = counts.collect::<Result<Vec<f64>>>()?;
        let times: Vec<f64> = counts
            .iter()
            .zip(steps)
            .map(|(count, dt)| count * dt)
            .collect();
        let calm = || times[..8].iter().copied();
        let spread = most(calm()) / least(calm()) - 1.0;
        let slope = (counts[6] / counts[0]).ln() / (steps[6] / steps[0]).ln();
        let fewest = least(counts.iter().copied());
        let mut own = record.under(name);
        own.note("steps to rest; smallest dt", counts[0], 1.0);
        own.note("fewest steps to rest", fewest, 1.0);
        own.note("slope of log steps over log dt", slope, 1e-3);
        own.note("time to rest; smallest dt [s]", times[0], share(1e-3));
        let of_time = "spread of the time to rest below 0.8 of the limit";
        own.note(of_time, spread, share(0.3));
        table = table
            .with(format!("{name} dt [s]"), ROUNDING, steps)
            .with(format!("{name} steps"), 1.0, counts)
            .with(format!("{name} time [s]"), share(1e-3), times);
    }
    record.keep(table);
    Ok(())
}

fn draw(record: &Record) -> Drawn {
    let (x, y) = (Axis::log("Δt / s", 1e-3, 1.0), Axis::log("steps", 1e2, 1e6));
    let mut steps = plot("steps until at rest", x, y).legend_at(Corner::BottomLeft);
    let (x, y) = (("damping γ / (M/T)", 0.0, 105.0), ("Δt / s", 0.0, 0.36));
    let mut limit = plot("largest stable step", x, y);
    let named = [
        ("report's scheme", Color::BLUE),
        ("centred damping", Color::GREEN),
    ];
    for ((scheme, _), (name, color)) in SCHEMES.into_iter().zip(named) {
        let id = scheme.name();
        let points = record.points("rest", &format!("{id} dt"), &format!("{id} steps"))?;
        let border = record.number(&format!("{id}: predicted limit"))?;
        let border = line([(border, 1e2), (border, 1e6)], color)
            .dashed()
            .weighing(0.7);
        steps = steps
            .with(line(points.clone(), color).named(name))
            .with(dots(points, 1.8, color))
            .with(border.named("its limit"));
        let mut theory = record.points("limits", "damping", &format!("{id} predicted"))?;
        let found = record.points("limits", "damping", &format!("{id} measured"))?;
        if scheme == Scheme::Report {
            // between the rows the border is smooth: λ dt² + 2 γ dt = 4 μ
            let stiff = 4.0 / (theory[0].1 * theory[0].1);
            let dampings = (0..=200).map(|i| real(i) * 0.5);
            let smooth = dampings.map(|g| (g, 4.0 / (g + (g * g + 4.0 * stiff).sqrt())));
            theory = smooth.collect();
        }
        limit = limit
            .with(line(theory, color).named(format!("{name}, predicted")))
            .with(dots(found, 1.8, color).named("measured"));
    }
    let (x, y) = (
        ("step", 0.0, 400.0),
        Axis::log("rms deformation / px", 1e-2, 1e4),
    );
    let mut growth = plot("the report's scheme at multiples of its limit", x, y);
    let colors = [
        Color::BLUE,
        Color::SKY,
        Color::ORANGE,
        Color::RED,
        Color::PURPLE,
    ];
    for (share, color) in ABOUT.into_iter().zip(colors) {
        let name = format!("{share} of the limit");
        growth = growth.with(line(record.points("growth", "step", &name)?, color).named(name));
    }
    Artefact::only(
        "Left: the price of small steps, and the border. Middle: what happens about the border. Right: the border \
         for each damping; dots from bisection on runs.",
        Figure::new("§3.4.3  The time parameter", 960.0).with(330.0, vec![steps, growth, limit]),
    )
}
