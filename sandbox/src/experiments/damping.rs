//! Report §3.4.2: one damped spring, three kinds of motion.

use crate::demand::{below, judged, near};
use crate::draw::{Axis, Color, Corner, Figure, Layer, Line, Panel};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use integrator::problems::{damped_spring, spring_motion};
use integrator::{Scheme, Start, report_critical_damping};

const ID: &str = "sec-3-4-2";
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
    id: ID,
    title: "Underdamped, overdamped, critical",
    place: "§3.4.2",
    question: "A spring with m = k = 1 is let go at u = 1. How does it come to rest for c = 0.3, c = 4 and at \
               critical damping, and does the scheme of Eq. 3.5 follow the exact solutions?",
    claims: &[
        Claim {
            says: "underdamping produces lots of oscillations",
            source: "report §3.4.2",
            judge: |r| {
                let count = r.number("underdamped; c = 0.3: crossings of zero")?;
                let rest = r.told("underdamped; c = 0.3: time to rest")?;
                Ok(Finding::new(
                    count > 5.5,
                    format!("{count} crossings of zero in 25 s, within 2 % after {rest:.1} s"),
                ))
            },
        },
        Claim {
            says: "overdamping does not oscillate, but is slow, as in molasses",
            source: "report §3.4.2",
            judge: |r| {
                let count = r.number("overdamped; c = 4: crossings of zero")?;
                let slow = r.number("overdamped; c = 4: time to rest")?;
                let fast = r.number("critical; c = 2: time to rest")?;
                Ok(Finding::new(
                    count < 0.5 && slow > 2.0 * fast,
                    format!(
                        "no crossing; within 2 % after {slow:.1} s, critical after {fast:.1} s"
                    ),
                ))
            },
        },
        Claim {
            says: "critical damping goes straight to rest, first of all that do not overshoot",
            source: "report §3.4.2",
            judge: |r| {
                judged(
                    r,
                    &[
                        near("first to rest without overshoot", 2.0, 0.011),
                        below("critical; c = 2: crossings of zero", 0.5),
                    ],
                )
            },
        },
        Claim {
            says: "it is c = 2; the report's \"critical damping (c = 4)\" is a slip",
            source: "D22",
            judge: |r| {
                let critical = r.number("critical damping of m = k = 1")?;
                let slow = r.told("overdamped; c = 4: time to rest")?;
                Ok(Finding::new(
                    (critical - 2.0).abs() < 1e-12,
                    format!(
                        "2 √(m k) = {critical}; c = 4 would be the overdamped curve again, {slow:.1} s"
                    ),
                ))
            },
        },
        Claim {
            says: "the report's scheme follows within its first order, centred damping within its second",
            source: "report Eq. 3.5, D18",
            judge: |r| {
                let (first, second) = (
                    r.number("report's scheme off by")?,
                    r.number("leapfrog off by")?,
                );
                Ok(Finding::new(
                    first < DT && second < DT * DT,
                    format!("off by {first:.1e} and {second:.1e} at dt = 0.01"),
                ))
            },
        },
        Claim {
            says: "the scheme itself is critically damped at 2 √(μλ) − λ dt",
            source: "D23",
            judge: |r| {
                let (found, predicted) = (
                    r.number("scheme at dt = 0.1: least damping without overshoot")?,
                    r.number("scheme at dt = 0.1: predicted")?,
                );
                Ok(Finding::new(
                    (found - predicted).abs() < 2e-3,
                    format!("c = {found:.4} at dt = 0.1, predicted {predicted:.4}"),
                ))
            },
        },
    ],
    run,
    draw,
};

/// The first node's motion, one value a step, the start included.
fn motion(
    scheme: Scheme,
    start: Start,
    c: f64,
    dt: f64,
    steps: usize,
) -> Result<Vec<f64>, SandboxError> {
    let mut spring = damped_spring(1.0, c, 1.0).map_err(SandboxError::refused(ID))?;
    let mut state = spring.state.clone();
    let mut stepper = scheme
        .start(&mut spring.system, &state, dt, start)
        .map_err(SandboxError::refused(ID))?;
    let mut out = vec![state.x[0].x];
    for _ in 0..steps {
        stepper
            .step(&mut spring.system, &mut state)
            .map_err(SandboxError::refused(ID))?;
        out.push(state.x[0].x);
    }
    Ok(out)
}

fn exact(c: f64, t: f64) -> f64 {
    spring_motion(1.0, c, 1.0, t)[0].0
}

fn crossings(values: &[f64]) -> usize {
    values
        .windows(2)
        .filter(|pair| (pair[0] < 0.0) != (pair[1] < 0.0))
        .count()
}

/// The last time further from rest than [`NEAR`], by fine sampling of the exact motion.
fn time_to_rest(c: f64) -> f64 {
    let far = (0..60_000)
        .rev()
        .map(|i| f64::from(i) * 0.005)
        .find(|&t| exact(c, t).abs() > NEAR);
    far.unwrap_or(0.0)
}

fn run() -> Result<Record, SandboxError> {
    let steps = 2500;
    let mut record = Record::default();
    let rows = (0..=100).map(|row| real(row) * 0.25);
    let mut table =
        Table::new("motion").with("t", "s", Tolerance::ROUNDING, rows.clone().collect());
    let (mut first, mut second) = (0.0_f64, 0.0_f64);
    for (name, c) in CASES {
        let report = motion(Scheme::Report, Start::FirstOrder, c, DT, steps)?;
        let leapfrog = motion(Scheme::Leapfrog, Start::SecondOrder, c, DT, steps)?;
        for step in 0..=steps {
            let right = exact(c, real(step) * DT);
            first = first.max((report[step] - right).abs());
            second = second.max((leapfrog[step] - right).abs());
        }
        record.note(
            format!("{name}: crossings of zero"),
            real(crossings(&report)),
            "",
            Tolerance::EXACT,
        );
        record.note(
            format!("{name}: time to rest"),
            time_to_rest(c),
            "s",
            Tolerance::Absolute(0.006),
        );
        table = table
            .with(
                format!("exact {name}"),
                "",
                Tolerance::ROUNDING,
                rows.clone().map(|t| exact(c, t)).collect(),
            )
            .with(
                format!("scheme {name}"),
                "",
                Tolerance::ROUNDING,
                report.iter().copied().step_by(25).collect(),
            );
    }
    record.note("report's scheme off by", first, "", Tolerance::ROUNDING);
    record.note("leapfrog off by", second, "", Tolerance::ROUNDING);
    record.note(
        "critical damping of m = k = 1",
        integrator::critical_damping(1.0, 1.0),
        "",
        Tolerance::ROUNDING,
    );
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
    record.note(
        "first to rest without overshoot",
        best,
        "",
        Tolerance::ROUNDING,
    );
    record.keep(
        Table::new("rest")
            .with("c", "", Tolerance::EXACT, dampings)
            .with("time to rest", "s", Tolerance::Absolute(0.006), rests),
    );

    let (mut low, mut high) = (1.0, 3.0);
    while high - low > 1e-4 {
        let middle = f64::midpoint(low, high);
        let swings = motion(Scheme::Report, Start::FirstOrder, middle, 0.1, 6000)?;
        if swings.iter().any(|&u| u < 0.0) {
            low = middle;
        } else {
            high = middle;
        }
    }
    record.note(
        "scheme at dt = 0.1: least damping without overshoot",
        high,
        "",
        Tolerance::Absolute(1e-4),
    );
    record.note(
        "scheme at dt = 0.1: predicted",
        report_critical_damping(1.0, 1.0, 0.1),
        "",
        Tolerance::ROUNDING,
    );
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let colors = [Color::BLUE, Color::RED, Color::GREEN];
    let time = || Axis::new("t / s", 0.0, SECONDS);
    let mut panels = Vec::new();
    let mut together = Panel::new("the three together", time(), Axis::new("u", -0.8, 1.1));
    for ((name, c), color) in CASES.into_iter().zip(colors) {
        let scheme = record.points("motion", "t", &format!("scheme {name}"))?;
        let fine = (0..=1000)
            .map(|i| real(i) * SECONDS / 1000.0)
            .map(|t| (t, exact(c, t)))
            .collect();
        let title = name.replace(';', ",");
        panels.push(
            Panel::new(title.clone(), time(), Axis::new("u", -0.8, 1.1))
                .with(Line::new(vec![(0.0, 0.0), (SECONDS, 0.0)], Color::GREY).weighing(0.5))
                .with(Line::new(fine, color).named("exact"))
                .with(Layer::Dots {
                    points: scheme.iter().copied().step_by(2).collect(),
                    radius: 1.2,
                    color: Color::INK,
                    label: "Eq. 3.5, dt = 0.01 s".to_owned(),
                }),
        );
        let near = (0..=600)
            .map(|i| real(i) * SECONDS / 600.0)
            .map(|t| (t, exact(c, t)))
            .collect();
        together = together.with(Line::new(near, color).named(title));
    }
    let rest = record.points("rest", "c", "time to rest")?;
    let marks: Vec<(f64, f64)> = rest
        .iter()
        .copied()
        .filter(|p| CASES.iter().any(|(_, c)| (p.0 - c).abs() < 1e-9))
        .collect();
    let scan = Panel::new(
        "how long until within 2 % for good",
        Axis::new("damping c", 0.0, 6.0),
        Axis::new("time to rest / s", 0.0, 40.0),
    )
    .legend_at(Corner::TopRight)
    .with(Line::new(rest, Color::INK))
    .with(
        Line::new(vec![(2.0, 0.0), (2.0, 40.0)], Color::GREEN)
            .dashed()
            .named("critical, c = 2"),
    )
    .with(
        Line::new(vec![(4.0, 0.0), (4.0, 40.0)], Color::RED)
            .dashed()
            .named("the report's \"critical\", c = 4"),
    )
    .with(Layer::Dots {
        points: marks,
        radius: 2.0,
        color: Color::BLUE,
        label: String::new(),
    });
    let figure = Figure::new("§3.4.2  A damped spring, m = k = 1", 900.0)
        .with(250.0, panels)
        .with(280.0, vec![together, scan]);
    Ok(vec![Artefact::figure(
        "Above: the report's three unnumbered figures, dots from its scheme, lines exact. Below: the same together, \
         and the time to rest for every damping. Below c = 2 the motion overshoots, which a 2 % rule forgives.",
        figure,
    )])
}
