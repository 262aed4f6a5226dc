//! Report §3.4.1: parameters as functions of s, and of time.

use super::ball::frequency;
use crate::prelude::*;
use std::f64::consts::{PI, TAU};

/// The ball's schedule changes between these times.
const CHANGE: (f64, f64) = (5.0, 5.5);

/// A strip that stiffens along s, a ball that hardens in time.
pub(crate) const PROFILES: Experiment = Experiment {
    id: "sec-3-4-1-profiles",
    title: "Parameters along s and in time",
    place: "§3.4.1",
    question: "The report would like the elastic parameters to be functions of s and to change through time. What does \
               a strip do whose rigidity grows along it, and a ball that hardens in flight?",
    claims: &[
        claim("where the strip is less rigid, it bends more [report §3.4.1]").when(&[more(
            "stiffening: turn in the first quarter",
            2.0,
            "stiffening: turn in the last quarter",
        )]),
        claim("a uniform strip bends the same on both sides [report §3.4.1]").when(&[close(
            "uniform: turn in the first quarter",
            "uniform: turn in the last quarter",
            1e-6,
        )]),
        claim("a ball that is four times as stiff rings twice as fast [report §3.4.1, errata §7]")
            .when(&[
                like("ringing before", "ringing before: predicted", 0.01),
                like("ringing after", "ringing after: predicted", 0.01),
            ]),
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

fn run() -> Result {
    let mut record = Record::default();
    let close = 1e-6;
    for (scene, name) in [
        ("whole-strip", "uniform"),
        ("stiffening-strip", "stiffening"),
    ] {
        let (_, run) = ran(scene, &[])?;
        let nodes = last(&run);
        let quarter = nodes.len() / 4;
        let (head, tail) = (&nodes[..=quarter], &nodes[nodes.len() - 1 - quarter..]);
        let mut own = record.under(name);
        own.note("turn in the first quarter [°]", turned(head), close);
        own.note("turn in the last quarter [°]", turned(tail), close);
        record.keep(Table::new(name).xy("px", close, nodes));
    }
    let (scene, run) = ran("hardening-ball", &[("every = 50", "every = 10")])?;
    let (snake, body) = (&scene.snake, scene.snake.body());
    let n = body.len();
    let times: Vec<f64> = run.frames.iter().map(|frame| frame.t).collect();
    let mut e = vec![DVec2::ZERO; n];
    let once = |i: usize| (TAU * real(i) / real(n)).cos();
    let mode = run.frames.iter().map(|frame| {
        snake.deformation_into(frame.nodes(), &mut e);
        let sum: f64 = e.iter().enumerate().map(|(i, e)| e.x * once(i)).sum();
        2.0 * sum / real(n)
    });
    let mode: Vec<f64> = mode.collect();
    let touches = |frame: &scene::Frame| frame.nodes().iter().any(|p| p.x <= 0.0);
    let free = run
        .frames
        .iter()
        .rposition(touches)
        .map_or(0.0, |i| times[i]);
    record.note("last contact [s]", free, 0.011);
    let wave = (2.0 * (PI / real(n)).sin() / body.spacing).powi(2);
    let material = &body.material;
    let stiffness = material.tether.at(0)
        + material.tension.at(0) * wave
        + material.rigidity.at(0) * wave * wave;
    let (mass, decay) = (
        body.mass.at(0),
        body.damping.at(0) / (2.0 * body.mass.at(0)),
    );
    for (name, between, factor) in [
        ("before", (free, CHANGE.0), 1.0),
        ("after", (CHANGE.1, f64::INFINITY), 4.0),
    ] {
        let found = frequency(&times, &mode, between, 2).unwrap_or(f64::NAN);
        record.note(format!("ringing {name} [rad/s]"), found, 1e-4);
        let right = (factor * stiffness / mass - decay * decay).sqrt();
        record.note(
            format!("ringing {name}: predicted [rad/s]"),
            right,
            ROUNDING,
        );
    }
    let schedule = body.schedules.rigidity.as_ref();
    let factor: Vec<f64> = times
        .iter()
        .map(|&t| schedule.map_or(1.0, |f| f.at(t)))
        .collect();
    let ball = Table::raw("ball").exact("t [s]", times).exact("mode", mode);
    record.keep(ball.exact("factor", factor));
    record.keep_run("curves", &run);
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let uniform = line(record.xy("uniform")?, Color::GREY).dashed();
    let growing = line(record.xy("stiffening")?, Color::BLUE);
    let title = "along s: rigidity 2 at the left end, 400 at the right";
    let strip = plot(title, ("x / px", -1.0, 41.0), ("y / px", -8.8, 5.0))
        .equal()
        .with(uniform.named("60 everywhere"))
        .with(growing.named("growing along s"));
    let frames = record.run("curves")?;
    let title = "in time: a ball that hardens in flight";
    let mut ball = plot(title, ("x", -0.3, 8.0), ("y", 4.0, 9.2))
        .equal()
        .with(wall((0.0, 4.0), (0.0, 9.2)));
    for frame in frames.each(0.6) {
        let hard = ((frames.t(frame) - CHANGE.0) / (CHANGE.1 - CHANGE.0)).clamp(0.0, 1.0);
        ball = ball.with(
            frames
                .ring(frame, Color::SKY.mix(Color::RED, hard))
                .weighing(0.7),
        );
    }
    let time = ("t / s", 0.0, 9.0);
    let ringing = plot("its first mode", time, ("amplitude", -0.65, 0.2))
        .legend_at(Corner::BottomRight)
        .with(line(record.points("ball", "t", "mode")?, Color::BLUE).weighing(0.8));
    let factor = plot("its schedule", time, ("factor of ω₀, ω₁, ω₂", 0.0, 4.5))
        .with(line(record.points("ball", "t", "factor")?, Color::RED).weighing(0.8));
    Artefact::only(
        "Left: the strip bends where it is soft. Right: the ball is soft (blue) until 5 s, and four times as stiff (red) \
         from 5.5 s on; it rings twice as fast then.",
        Figure::new("§3.4.1  Parameters as functions of s and of time", 900.0)
            .with(270.0, vec![strip, ball])
            .with(220.0, vec![factor, ringing]),
    )
}
