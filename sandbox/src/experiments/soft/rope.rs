//! A rubber rope with a pinned end, against the string's own solution.

use crate::prelude::*;
use elastic::{End, Topology};

/// The rope, and the same without its pin.
pub(crate) const ROPE: Experiment = Experiment {
    id: "soft-rope",
    title: "A rope with a pinned end",
    place: "beyond",
    question: "A rubber rope is let go from level, one end pinned. It obeys the wave equation of a string with one fixed \
               and one free end, which is solved: does it?",
    claims: &[
        claim("it comes to hang as long as g μ L² / 2 ω₁ says [the hanging string]").when(&[like(
            "length it hangs with",
            "exact length",
            0.01,
        )]),
        claim("its free end swings with the period 4 L √(μ/ω₁) [the wave equation]").when(&[like(
            "period",
            "exact period",
            0.02,
        )]),
        claim("the pinned end does not move [the pin]").when(&[at_most("pin moved", 0.0)]),
        claim("without the pin it shrinks and falls [the same run without]")
            .when(&[above("fall without the pin in 6 s", 20.0)]),
    ],
    run,
    draw,
};

fn run() -> Result {
    let scene = scene_with("rope", &[])?;
    let (steps, dt) = (scene.plan.until.steps, scene.plan.dt);
    let mut body = scene.snake.body().clone();
    let (n, h) = (body.len(), body.spacing);
    let (mass, tension) = (body.mass.at(0), body.material.tension.at(0));
    let (length, close) = (h * real(n - 1), share(1e-4));
    let mut record = Record::default();
    let mut chosen: Vec<u64> = (0..=12).map(|k| steps_in(0.5 * f64::from(k), dt)).collect();
    chosen.push(steps);
    let mut rope = group(&scene)?;
    let pin = scene.start.x[0];
    let seen = watch(&mut rope, steps, 10, &chosen)?;
    seen.note(&mut record, "rope", 1e-6);
    let end = &rope.members()[0].state().x;
    // node i of n pulls up all below it: n - i pieces of weight h μ g, the last a whole one as every node
    let g = 2.0;
    let weight = |i: usize| real(n - 1 - i) * h * mass * g;
    let exact: f64 = (0..n - 1).map(|i| h * weight(i) / tension).sum();
    record.note("length it hangs with [px]", pin.y - end[n - 1].y, close);
    record.note("exact length [px]", exact, close);
    record.note("pin moved [px]", end[0].distance(pin), EXACT);
    record.keep_run("rope", seen.run);

    // the swing of the free end, without damping and gravity: it passes the pin's upright twice a period
    let changes = [("damping = 0.15", "damping = 0.0"), ("-2.0]", "0.0]")];
    let mut still = group(&scene_with("rope", &changes)?)?;
    let mut tail = vec![(0.0, still.members()[0].state().x[n - 1].x)];
    for _ in 0..steps_in(40.0, dt) {
        advance(&mut still)?;
        tail.push((still.t(), still.members()[0].state().x[n - 1].x));
    }
    let mut crossings = Vec::new();
    for pair in tail.windows(2) {
        let (a, b) = (pair[0].1 - length, pair[1].1 - length);
        if a * b < 0.0 {
            crossings.push(pair[0].0 + dt * a / (a - b));
        }
    }
    let last = crossings.len() - 1;
    let period = 2.0 * (crossings[last] - crossings[0]) / real(last);
    record.note("period [s]", period, close);
    record.note(
        "exact period [s]",
        4.0 * length * (mass / tension).sqrt(),
        close,
    );
    record.keep(Table::raw("tail").pairs("t [s]", "x [px]", &tail));

    let mut loose = scene.clone();
    body.topology = Topology::open(End::Free);
    loose.snake.set_body(body)?;
    let mut falling = group(&loose)?;
    let fallen = watch(&mut falling, steps_in(6.0, dt), steps, &chosen)?;
    let head = falling.members()[0].state().x[0];
    record.note("fall without the pin in 6 s [px]", pin.y - head.y, close);
    record.keep_run("loose", fallen.run);
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let mut row = Vec::new();
    for (name, title, window) in [
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
        let run = record.run(name)?;
        let mut panel = picture(title, &[], window, &|_| Color::INK);
        for k in 0..run.len() {
            let color = Color::BLUE.mix(Color::RED, real(k) / real(run.len() - 1));
            panel = panel.with(line(run.pairs(k), color).weighing(0.8));
        }
        if name == "rope" {
            panel = panel.with(dots([(0.0, 0.0)], 2.5, Color::INK));
        }
        row.push(panel);
    }
    let tail = record.points("tail", "t", "x")?;
    let period = record.told("exact period")?;
    // the solved string of length L let go stretched: the free end goes to and fro in a triangle
    let triangle = |t: f64| 10.0 * (4.0 * ((t / period).fract() - 0.5).abs() - 1.0);
    let exact = tail.iter().map(|p| (p.0, 0.1 + 0.99 * triangle(p.0)));
    let exact = line(exact, Color::GREEN).dashed().weighing(0.7);
    let title = "its free end without gravity and damping";
    let swing = plot(title, ("t / s", 0.0, 40.0), ("x / px", -11.0, 15.0))
        .with(line(tail, Color::BLUE).named("41 nodes"))
        .with(exact.named("solved"));
    let terms = [
        ("kinetic", "kinetic", Color::BLUE),
        ("elastic", "elastic", Color::GREEN),
        ("outside", "gravity", Color::GREY),
        ("damping", "lost to damping", Color::ORANGE),
    ];
    Artefact::only(
        "Above: from blue to orange. Below: the free end against the solution of the wave equation, and where the energy goes.",
        Figure::new("A rubber rope with a pinned end", 1000.0)
            .with(330.0, row)
            .with(
                270.0,
                vec![swing, account(record, "rope", "the account", &terms)?],
            ),
    )
}
