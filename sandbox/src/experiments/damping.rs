//! Report §3.4.2: one damped spring, three kinds of motion.

use crate::prelude::*;
use integrator::problems::{damped_spring, spring_motion};
use integrator::{Scheme, Start, report_critical_damping};

/// The report's three dampings, in its order. Its text gives the third as 4 too (D22).
const CASES: [(&str, f64); 3] = [
    ("underdamped; c = 0.3", 0.3),
    ("overdamped; c = 4", 4.0),
    ("critical; c = 2", 2.0),
];
const DT: f64 = 0.01;
const SECONDS: f64 = 25.0;
/// At rest means within this share of the start, for good.
const NEAR: f64 = 0.02;

/// Three kinds of damping against their exact solutions.
pub(crate) const DAMPING: Experiment = Experiment {
    id: "sec-3-4-2",
    title: "Underdamped, overdamped, critical",
    place: "§3.4.2",
    question: "A spring with m = k = 1 is let go at u = 1. How does it come to rest for c = 0.3, c = 4 and at \
               critical damping, and does the scheme of Eq. 3.5 follow the exact solutions?",
    claims: &[
        claim("underdamping produces lots of oscillations [report §3.4.2]")
            .when(&[above("underdamped; c = 0.3: crossings of zero", 5.5)]),
        claim("overdamping does not oscillate, but is slow, as in molasses [report §3.4.2]").when(&[
            below("overdamped; c = 4: crossings of zero", 0.5),
            more("overdamped; c = 4: time to rest", 2.0, "critical; c = 2: time to rest"),
        ]),
        claim("critical damping goes straight to rest, first of all that do not overshoot [report §3.4.2]")
            .when(&[
                near("first to rest without overshoot", 2.0, 0.011),
                below("critical; c = 2: crossings of zero", 0.5),
            ]),
        claim("it is c = 2; the report's \"critical damping (c = 4)\" is a slip [D22]")
            .when(&[near("critical damping of m = k = 1", 2.0, 1e-12)]),
        claim("the report's scheme follows to its first order, centred damping to its second [report Eq. 3.5, D18]")
            .when(&[below("report's scheme off by", DT), below("leapfrog off by", DT * DT)]),
        claim("the scheme itself is critically damped at 2 √(μλ) − λ dt [D23]").when(&[close(
            "scheme at dt = 0.1: least damping without overshoot",
            "scheme at dt = 0.1: predicted",
            2e-3,
        )]),
    ],
    run,
    draw,
};

/// The first node's motion, one value a step, the start included.
fn motion(scheme: Scheme, start: Start, (c, dt): (f64, f64), steps: usize) -> Result<Vec<f64>> {
    let mut spring = damped_spring(1.0, c, 1.0)?;
    let mut state = spring.state.clone();
    let mut stepper = scheme.start(&mut spring.system, &state, dt, start)?;
    let mut out = vec![state.x[0].x];
    for _ in 0..steps {
        stepper.step(&mut spring.system, &mut state)?;
        out.push(state.x[0].x);
    }
    Ok(out)
}

fn exact(c: f64, t: f64) -> f64 {
    spring_motion(1.0, c, 1.0, t)[0].0
}

fn crossings(values: &[f64]) -> usize {
    let turns = |pair: &&[f64]| (pair[0] < 0.0) != (pair[1] < 0.0);
    values.windows(2).filter(turns).count()
}

/// The last time further from rest than [`NEAR`], by fine sampling of the exact motion.
fn time_to_rest(c: f64) -> f64 {
    let mut times = (0..60_000).rev().map(|i| f64::from(i) * 0.005);
    times.find(|&t| exact(c, t).abs() > NEAR).unwrap_or(0.0)
}

/// The exact motion as so many edges.
fn exact_line(c: f64, edges: usize) -> impl Iterator<Item = (f64, f64)> {
    let times = (0..=edges).map(move |i| real(i) * SECONDS / real(edges));
    times.map(move |t| (t, exact(c, t)))
}

fn run() -> Result {
    let steps = 2500;
    let mut record = Record::default();
    let rows = || (0..=100).map(|row| real(row) * 0.25);
    let mut table = Table::new("motion").with("t [s]", ROUNDING, rows());
    let (mut first, mut second) = (0.0_f64, 0.0_f64);
    for (name, c) in CASES {
        let report = motion(Scheme::Report, Start::FirstOrder, (c, DT), steps)?;
        let leapfrog = motion(Scheme::Leapfrog, Start::SecondOrder, (c, DT), steps)?;
        for step in 0..=steps {
            let right = exact(c, real(step) * DT);
            first = first.max((report[step] - right).abs());
            second = second.max((leapfrog[step] - right).abs());
        }
        let count = real(crossings(&report));
        let mut own = record.under(name);
        own.note("crossings of zero", count, EXACT);
        own.note("time to rest [s]", time_to_rest(c), 0.006);
        table = table
            .with(
                format!("exact {name}"),
                ROUNDING,
                rows().map(|t| exact(c, t)),
            )
            .with(
                format!("scheme {name}"),
                ROUNDING,
                report.into_iter().step_by(25),
            );
    }
    record.note("report's scheme off by", first, ROUNDING);
    record.note("leapfrog off by", second, ROUNDING);
    let critical = integrator::critical_damping(1.0, 1.0);
    record.note("critical damping of m = k = 1", critical, ROUNDING);
    record.keep(table);

    let dampings: Vec<f64> = (10..=600)
        .map(|hundredth| f64::from(hundredth) / 100.0)
        .collect();
    let rests: Vec<f64> = dampings.iter().map(|&c| time_to_rest(c)).collect();
    let overshoots = |c: f64| (0..4000).any(|i| exact(c, f64::from(i) * 0.05) < 0.0);
    let straight = dampings
        .iter()
        .zip(&rests)
        .filter(|(c, _)| !overshoots(**c));
    let best = straight
        .min_by(|a, b| a.1.total_cmp(b.1))
        .map_or(f64::NAN, |(c, _)| *c);
    record.note("first to rest without overshoot", best, ROUNDING);
    let table = Table::new("rest").exact("c", dampings);
    record.keep(table.with("time to rest [s]", 0.006, rests));

    let (mut low, mut high) = (1.0, 3.0);
    while high - low > 1e-4 {
        let middle = f64::midpoint(low, high);
        let swings = motion(Scheme::Report, Start::FirstOrder, (middle, 0.1), 6000)?;
        if swings.iter().any(|&u| u < 0.0) {
            low = middle;
        } else {
            high = middle;
        }
    }
    record.note(
        "scheme at dt = 0.1: least damping without overshoot",
        high,
        1e-4,
    );
    let predicted = report_critical_damping(1.0, 1.0, 0.1);
    record.note("scheme at dt = 0.1: predicted", predicted, ROUNDING);
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let colors = [Color::BLUE, Color::RED, Color::GREEN];
    let (time, place) = (("t / s", 0.0, SECONDS), ("u", -0.8, 1.1));
    let mut panels = Vec::new();
    let mut together = plot("the three together", time, place);
    for ((name, c), color) in CASES.into_iter().zip(colors) {
        let scheme = record.points("motion", "t", &format!("scheme {name}"))?;
        let scheme = dots(scheme.into_iter().step_by(2), 1.2, Color::INK);
        let title = name.replace(';', ",");
        panels.push(
            plot(title.clone(), time, place)
                .with(line([(0.0, 0.0), (SECONDS, 0.0)], Color::GREY).weighing(0.5))
                .with(line(exact_line(c, 1000), color).named("exact"))
                .with(scheme.named("Eq. 3.5, dt = 0.01 s")),
        );
        together = together.with(line(exact_line(c, 600), color).named(title));
    }
    let rest = record.points("rest", "c", "time to rest")?;
    let case = |p: &(f64, f64)| CASES.iter().any(|(_, c)| (p.0 - c).abs() < 1e-9);
    let marks: Vec<(f64, f64)> = rest.iter().copied().filter(case).collect();
    let upright = |c: f64, color| line([(c, 0.0), (c, 40.0)], color).dashed();
    let (x, y) = (("damping c", 0.0, 6.0), ("time to rest / s", 0.0, 40.0));
    let scan = plot("how long until within 2 % for good", x, y)
        .with(line(rest, Color::INK))
        .with(upright(2.0, Color::GREEN).named("critical, c = 2"))
        .with(upright(4.0, Color::RED).named("the report's \"critical\", c = 4"))
        .with(dots(marks, 2.0, Color::BLUE));
    Artefact::only(
        "Above: the report's three unnumbered figures, dots from its scheme, lines exact. Below: the same together, \
         and the time to rest for every damping. Below c = 2 the motion overshoots, which a 2 % rule forgives.",
        Figure::new("§3.4.2  A damped spring, m = k = 1", 900.0)
            .with(250.0, panels)
            .with(280.0, vec![together, scan]),
    )
}
