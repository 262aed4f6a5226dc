//! A rubber rope with a pinned end, against the string's own solution.

use super::course::{account, advance, crowd_of, keep_shots, picture, shots, times, watch};
use crate::demand::{above, at_most, below, judged};
use crate::draw::{Axis, Color, Figure, Layer, Line, Panel};
use crate::experiments::motion::changed_scene;
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use elastic::{End, Topology};

const ID: &str = "soft-rope";

/// The rope, and the same without its pin.
pub(crate) const ROPE: Experiment = Experiment {
    id: ID,
    title: "A rope with a pinned end",
    place: "beyond",
    question: "A rubber rope is let go from level, one end pinned. It obeys the wave equation of a string with one fixed \
               and one free end, which is solved: does it?",
    claims: &[
        Claim {
            says: "it comes to hang as long as g μ L² / 2 ω₁ says",
            source: "the hanging string",
            judge: |r| {
                let (found, exact) = (r.number("length it hangs with")?, r.number("exact length")?);
                Ok(Finding::new(
                    (found / exact - 1.0).abs() < 0.01,
                    format!("{found:.3} px, exactly {exact:.3} px for nodes of that spacing"),
                ))
            },
        },
        Claim {
            says: "its free end swings with the period 4 L √(μ/ω₁)",
            source: "the wave equation",
            judge: |r| {
                let (found, exact) = (r.number("period")?, r.number("exact period")?);
                Ok(Finding::new(
                    (found / exact - 1.0).abs() < 0.02,
                    format!("{found:.3} s, exactly {exact:.3} s"),
                ))
            },
        },
        Claim {
            says: "the pinned end does not move, and the account closes to rounding",
            source: "the ledger",
            judge: |r| {
                judged(
                    r,
                    &[
                        below("rope: gap of the account", 1e-9),
                        at_most("pin moved", 0.0),
                    ],
                )
            },
        },
        Claim {
            says: "without the pin it shrinks and falls",
            source: "the same run without",
            judge: |r| judged(r, &[above("fall without the pin in 6 s", 20.0)]),
        },
    ],
    run,
    draw,
};

fn run() -> Result<Record, SandboxError> {
    let scene = changed_scene(ID, "rope", &[])?;
    let (steps, dt) = (scene.plan.until.steps, scene.plan.dt);
    let body = scene.snake.body().clone();
    let (n, h) = (body.len(), body.spacing);
    let (mass, tension) = (body.mass.at(0), body.material.tension.at(0));
    let mut record = Record::default();
    let second = |t: f64| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a few thousand"
        )]
        let step = (t / dt).round() as u64;
        step
    };
    let chosen: Vec<u64> = (0..=12).map(|k| second(0.5 * f64::from(k))).collect();
    let mut all = chosen.clone();
    all.push(steps);
    let mut crowd = crowd_of(ID, &scene)?;
    let pin = scene.start.x[0];
    let course = watch(ID, &mut crowd, steps, 10, &all)?;
    course.note(&mut record, "rope", 1e-6);
    let end = &crowd.members()[0].state().x;
    // node i of n pulls up all below it: n - i pieces of weight h μ g, the last a whole one as every node
    let g = 2.0;
    let weight = |i: usize| real(n - 1 - i) * h * mass * g;
    let exact: f64 = (0..n - 1).map(|i| h * weight(i) / tension).sum();
    let close = Tolerance::Relative(1e-4);
    record.note("length it hangs with", pin.y - end[n - 1].y, "px", close);
    record.note("exact length", exact, "px", close);
    record.note("pin moved", end[0].distance(pin), "px", Tolerance::EXACT);
    course.keep(&mut record, "account", "rope");

    // the swing of the free end, without damping and gravity: it passes the pin's upright twice a period
    let still = changed_scene(
        ID,
        "rope",
        &[("damping = 0.15", "damping = 0.0"), ("-2.0]", "0.0]")],
    )?;
    let mut crowd = crowd_of(ID, &still)?;
    let mut tail = vec![(0.0, still.start.x[n - 1].x)];
    for _ in 0..second(40.0) {
        advance(ID, &mut crowd)?;
        tail.push((crowd.t(), crowd.members()[0].state().x[n - 1].x));
    }
    let offset = h * real(n - 1);
    let mut crossings = Vec::new();
    for pair in tail.windows(2) {
        let (a, b) = (pair[0].1 - offset, pair[1].1 - offset);
        if a * b < 0.0 {
            crossings.push(pair[0].0 + dt * a / (a - b));
        }
    }
    let last = crossings.len() - 1;
    let period = 2.0 * (crossings[last] - crossings[0]) / real(last);
    record.note("period", period, "s", close);
    record.note(
        "exact period",
        4.0 * h * real(n - 1) * (mass / tension).sqrt(),
        "s",
        close,
    );
    record.keep(
        Table::raw("tail")
            .with(
                "t",
                "s",
                Tolerance::EXACT,
                tail.iter().map(|p| p.0).collect(),
            )
            .with(
                "x",
                "px",
                Tolerance::EXACT,
                tail.iter().map(|p| p.1).collect(),
            ),
    );

    let mut loose = scene.clone();
    let mut free = body;
    free.topology = Topology::open(End::Free);
    loose
        .snake
        .set_body(free)
        .map_err(SandboxError::refused(ID))?;
    let mut crowd = crowd_of(ID, &loose)?;
    let fallen = watch(ID, &mut crowd, second(6.0), steps, &chosen)?;
    let head = crowd.members()[0].state().x[0];
    record.note("fall without the pin in 6 s", pin.y - head.y, "px", close);
    keep_shots(&mut record, "loose", &fallen.shots);
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let mut row = Vec::new();
    for (table, title, window) in [
        (
            "rope",
            "every half second, and at rest",
            [-11.0, -16.0, 11.0, 2.0],
        ),
        (
            "loose",
            "the same without the pin",
            [-1.0, -37.0, 43.0, 2.0],
        ),
    ] {
        let all = shots(record, table)?;
        let times = times(&all);
        let mut panel = picture(title, &[], 0.0, window, &|_| Color::INK);
        for (k, shot) in all.iter().enumerate() {
            let share = real(k) / real(times.len() - 1);
            let color = Color::BLUE.mix(Color::RED, share);
            panel = panel.with(Line::new(shot.points.clone(), color).weighing(0.8));
        }
        if table == "rope" {
            panel = panel.with(Layer::Dots {
                points: vec![(0.0, 0.0)],
                radius: 2.5,
                color: Color::INK,
                label: String::new(),
            });
        }
        row.push(panel);
    }
    let tail = record.points("tail", "t", "x")?;
    let period = record.number("exact period")?;
    // the solved string of length L let go stretched: the free end goes to and fro in a triangle
    let triangle = |t: f64| {
        let turn = (t / period).fract();
        10.0 * (4.0 * (turn - 0.5).abs() - 1.0)
    };
    let exact = tail
        .iter()
        .map(|p| (p.0, 0.1 + 0.99 * triangle(p.0)))
        .collect();
    let swing = Panel::new(
        "its free end without gravity and damping",
        Axis::new("t / s", 0.0, 40.0),
        Axis::new("x / px", -11.0, 15.0),
    )
    .with(Line::new(tail, Color::BLUE).named("41 nodes"))
    .with(
        Line::new(exact, Color::GREEN)
            .dashed()
            .weighing(0.7)
            .named("solved"),
    );
    let kept = account(
        record,
        "account",
        "the account",
        &[
            ("kinetic", "kinetic", Color::BLUE),
            ("elastic", "elastic", Color::GREEN),
            ("outside", "gravity", Color::GREY),
            ("damping", "lost to damping", Color::ORANGE),
        ],
    )?;
    let figure = Figure::new("A rubber rope with a pinned end", 1000.0)
        .with(330.0, row)
        .with(270.0, vec![swing, kept]);
    Ok(vec![Artefact::figure(
        "Above: from blue to orange. Below: the free end against the solution of the wave equation, and where the energy goes.",
        figure,
    )])
}
