//! Report §3.4.1: parameters as functions of s, and of time.

use crate::draw::{Axis, Color, Corner, Figure, Line, Panel};
use crate::experiments::motion::{Frames, changed_scene, keep_frames, to_the_end};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use glam::DVec2;
use std::f64::consts::{PI, TAU};

const ID: &str = "sec-3-4-1-profiles";
/// The ball's schedule changes between these times.
const CHANGE: (f64, f64) = (5.0, 5.5);

/// A strip that stiffens along s, a ball that hardens in time.
pub(crate) const PROFILES: Experiment = Experiment {
    id: ID,
    title: "Parameters along s and in time",
    place: "§3.4.1",
    question: "The report would like the elastic parameters to be functions of s and to change through time. What does \
               a strip do whose rigidity grows along it, and a ball that hardens in flight?",
    claims: &[
        Claim {
            says: "where the strip is less rigid, it bends more",
            source: "report §3.4.1",
            judge: |r| {
                let (head, tail) = (
                    r.number("stiffening: turn in the first quarter")?,
                    r.number("stiffening: turn in the last quarter")?,
                );
                Ok(Finding::new(
                    head > 2.0 * tail,
                    format!("turns by {head:.1}° in its first quarter, by {tail:.1}° in its last"),
                ))
            },
        },
        Claim {
            says: "a uniform strip bends the same on both sides",
            source: "report §3.4.1",
            judge: |r| {
                let (head, tail) = (
                    r.number("uniform: turn in the first quarter")?,
                    r.number("uniform: turn in the last quarter")?,
                );
                Ok(Finding::new(
                    (head - tail).abs() < 1e-6,
                    format!("by {head:.1}° and {tail:.1}°"),
                ))
            },
        },
        Claim {
            says: "a ball that is four times as stiff rings twice as fast",
            source: "report §3.4.1, errata §7",
            judge: |r| {
                let (soft, hard) = (r.number("ringing before")?, r.number("ringing after")?);
                let (soft_right, hard_right) = (
                    r.number("ringing before: predicted")?,
                    r.number("ringing after: predicted")?,
                );
                Ok(Finding::new(
                    (soft / soft_right - 1.0).abs() < 0.01
                        && (hard / hard_right - 1.0).abs() < 0.01,
                    format!(
                        "{soft:.3} rad/s before, {hard:.3} after; predicted {soft_right:.3} and {hard_right:.3}"
                    ),
                ))
            },
        },
    ],
    run,
    draw,
};

/// How much a strip turns over a range of its nodes, in degrees.
fn turned(nodes: &[DVec2]) -> f64 {
    let edges: Vec<DVec2> = nodes.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let turns = edges
        .windows(2)
        .map(|pair| elastic::turning_angle(pair[0], pair[1]));
    turns.sum::<f64>().to_degrees().abs()
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let close = Tolerance::Absolute(1e-6);
    for (scene, name) in [
        ("whole-strip", "uniform"),
        ("stiffening-strip", "stiffening"),
    ] {
        let run = to_the_end(ID, &mut changed_scene(ID, scene, &[])?)?;
        let nodes = run
            .last()
            .map(|frame| frame.nodes().to_vec())
            .unwrap_or_default();
        let quarter = nodes.len() / 4;
        let tail = nodes.len() - 1 - quarter;
        record.note(
            format!("{name}: turn in the first quarter"),
            turned(&nodes[..=quarter]),
            "°",
            close,
        );
        record.note(
            format!("{name}: turn in the last quarter"),
            turned(&nodes[tail..]),
            "°",
            close,
        );
        record.keep(
            Table::new(name)
                .with("x", "px", close, nodes.iter().map(|p| p.x).collect())
                .with("y", "px", close, nodes.iter().map(|p| p.y).collect()),
        );
    }
    let mut scene = changed_scene(ID, "hardening-ball", &[("every = 50", "every = 10")])?;
    let snake = scene.snake.clone();
    let n = snake.body().len();
    let run = to_the_end(ID, &mut scene)?;
    let mut times = Vec::new();
    let mut mode = Vec::new();
    let mut e = vec![DVec2::ZERO; n];
    for frame in &run.frames {
        snake.deformation_into(frame.nodes(), &mut e);
        let once = e.iter().enumerate();
        let sum: f64 = once
            .map(|(i, e)| e.x * (TAU * real(i) / real(n)).cos())
            .sum();
        times.push(frame.t);
        mode.push(2.0 * sum / real(n));
    }
    let touching = run
        .frames
        .iter()
        .rposition(|frame| frame.nodes().iter().any(|p| p.x <= 0.0));
    let free = touching.map_or(0.0, |i| run.frames[i].t);
    record.note("last contact", free, "s", Tolerance::Absolute(0.011));
    let body = snake.body();
    let angle = PI / real(n);
    let h = body.spacing;
    let wave = (2.0 * angle.sin() / h).powi(2);
    let material = &body.material;
    let stiffness = material.tether.at(0)
        + material.tension.at(0) * wave
        + material.rigidity.at(0) * wave * wave;
    let decay = body.damping.at(0) / (2.0 * body.mass.at(0));
    for (name, from, to, factor) in [
        ("before", free, CHANGE.0, 1.0),
        ("after", CHANGE.1, f64::INFINITY, 4.0),
    ] {
        let found = frequency(&times, &mode, from, to).unwrap_or(f64::NAN);
        record.note(
            format!("ringing {name}"),
            found,
            "rad/s",
            Tolerance::Absolute(1e-4),
        );
        let right = (factor * stiffness / body.mass.at(0) - decay * decay).sqrt();
        record.note(
            format!("ringing {name}: predicted"),
            right,
            "rad/s",
            Tolerance::ROUNDING,
        );
    }
    let factor = body.schedules.rigidity.as_ref();
    record.keep(
        Table::raw("ball")
            .with("t", "s", Tolerance::ROUNDING, times.clone())
            .with("mode", "", close, mode)
            .with(
                "factor",
                "",
                close,
                times
                    .iter()
                    .map(|&t| factor.map_or(1.0, |f| f.at(t)))
                    .collect(),
            ),
    );
    keep_frames(&mut record, "curves", &run);
    Ok(record)
}

/// Circular frequency by the zero crossings between two times.
fn frequency(t: &[f64], value: &[f64], from: f64, to: f64) -> Option<f64> {
    let crossings: Vec<f64> = (0..t.len() - 1)
        .filter(|&i| t[i] > from && t[i + 1] < to && (value[i] < 0.0) != (value[i + 1] < 0.0))
        .map(|i| t[i] + (t[i + 1] - t[i]) * value[i] / (value[i] - value[i + 1]))
        .collect();
    let (first, last) = (crossings.first()?, crossings.last()?);
    (crossings.len() > 1).then(|| PI * real(crossings.len() - 1) / (last - first))
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let strip = Panel::new(
        "along s: rigidity 2 at the left end, 400 at the right",
        Axis::new("x / px", -1.0, 41.0),
        Axis::new("y / px", -8.8, 5.0),
    )
    .equal()
    .legend_at(Corner::TopRight)
    .with(
        Line::new(record.points("uniform", "x", "y")?, Color::GREY)
            .dashed()
            .named("60 everywhere"),
    )
    .with(Line::new(record.points("stiffening", "x", "y")?, Color::BLUE).named("growing along s"));
    let frames = Frames::of(record, "curves")?;
    let mut ball = Panel::new(
        "in time: a ball that hardens in flight",
        Axis::new("x", -0.3, 8.0),
        Axis::new("y", 4.0, 9.2),
    )
    .equal()
    .with(Line::new(vec![(0.0, 4.0), (0.0, 9.2)], Color::INK).weighing(1.4));
    for frame in frames.each(0.6) {
        let hard = ((frames.t(frame) - CHANGE.0) / (CHANGE.1 - CHANGE.0)).clamp(0.0, 1.0);
        ball = ball.with(
            frames
                .ring(frame, Color::SKY.mix(Color::RED, hard))
                .weighing(0.7),
        );
    }
    let ringing = Panel::new(
        "its first mode",
        Axis::new("t / s", 0.0, 9.0),
        Axis::new("amplitude", -0.65, 0.2),
    )
    .legend_at(Corner::BottomRight)
    .with(Line::new(record.points("ball", "t", "mode")?, Color::BLUE).weighing(0.8));
    let factor = Panel::new(
        "its schedule",
        Axis::new("t / s", 0.0, 9.0),
        Axis::new("factor of ω₀, ω₁, ω₂", 0.0, 4.5),
    )
    .with(Line::new(record.points("ball", "t", "factor")?, Color::RED).weighing(0.8));
    let figure = Figure::new("§3.4.1  Parameters as functions of s and of time", 900.0)
        .with(270.0, vec![strip, ball])
        .with(220.0, vec![factor, ringing]);
    Ok(vec![Artefact::figure(
        "Left: the strip bends where it is soft. Right: the ball is soft (blue) until 5 s, and four times as stiff (red) \
         from 5.5 s on; it rings twice as fast then.",
        figure,
    )])
}
