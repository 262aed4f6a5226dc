//! A bouncing ring that dents for good.

use crate::prelude::*;

/// When it is drawn, besides the end.
const SHOWN: [f64; 5] = [0.0, 1.7, 2.2, 3.0, 4.0];

/// A ring that yields, and one that does not.
pub(crate) const DENT: Experiment = Experiment {
    id: "soft-dent",
    title: "A ring that dents for good",
    place: "beyond",
    question: "A ring falls on the floor and bounces. Where an edge is strained beyond the yield strain its rest shape \
               gives way: does it keep the dent, where the elastic ring does not?",
    claims: &[
        claim("the shape at rest is no circle any more [plastic flow]").when(&[
            above("plastic: width over height of the rest shape", 1.1),
            near("elastic: width over height of the rest shape", 1.0, 1e-12),
        ]),
        claim("denting takes energy from the bounce [plastic flow]").when(&[less(
            "plastic: height of the first bounce",
            0.9,
            "elastic: height of the first bounce",
        )]),
    ],
    run,
    draw,
};

fn run() -> Result {
    let mut record = Record::default();
    for name in ["plastic", "elastic"] {
        let mut scene = scene_with("dented-ring", &[])?;
        if name == "elastic"
            && let Some(company) = &mut scene.company
        {
            company.upkeep.plastic = None;
        }
        let (steps, dt) = (scene.plan.until.steps, scene.plan.dt);
        let mut group = group(&scene)?;
        let every: Vec<u64> = (0..=steps / 50).map(|k| 50 * k).collect();
        let mut seen = watch(&mut group, steps, 10, &every)?;
        seen.note(&mut record, name, 1e-3);
        let rest = &group.members()[0].snake().body().rest;
        let wide = |k: usize| {
            let (low, high) = range(rest.iter().map(|p| p[k]), 0.0);
            high - low
        };
        let shape = format!("{name}: width over height of the rest shape");
        record.note(shape, wide(0) / wide(1), share(0.01));
        // how high its center is, over time; the first bounce is the highest after the lowest of the fall
        let frames = seen.run.frames.iter();
        let way = frames.map(|frame| (frame.t, elastic::center(&frame.curves[0].nodes, None).y));
        let way: Vec<(f64, f64)> = way.collect();
        let turn = way.windows(2).position(|pair| pair[1].1 > pair[0].1);
        let rise = most(way[turn.unwrap_or(0)..].iter().map(|p| p.1));
        let bounce = format!("{name}: height of the first bounce [px]");
        record.note(bounce, rise, share(0.01));
        let center = if name == "plastic" {
            "center-plastic"
        } else {
            "center-elastic"
        };
        record.keep(Table::raw(center).pairs("t [s]", "y [px]", &way));
        let shown = SHOWN.map(|t| real_steps(steps_in(t, dt)));
        let shown = |t: f64| {
            shown
                .iter()
                .chain([&real_steps(steps)])
                .any(|&step| (step * dt - t).abs() < 25.0 * dt)
        };
        seen.run.frames.retain(|frame| shown(frame.t));
        record.keep_run(name, seen.run);
    }
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let mut figure = Figure::new("A bouncing ring that dents for good", 1000.0);
    let mut height = plot(
        "height of the center",
        ("t / s", 0.0, 16.0),
        ("y / px", 0.0, 12.0),
    );
    for (name, center, color) in [
        ("plastic", "center-plastic", Color::RED),
        ("elastic", "center-elastic", Color::BLUE),
    ] {
        let panels = record.run(name)?.frames.iter().map(|frame| {
            let title = format!("{name}, t = {:.1} s", frame.t);
            picture(title, &frame.curves, [-4.6, -0.5, 4.6, 12.5], &|_| color)
                .with(wall((-4.6, 0.0), (4.6, 0.0)))
        });
        figure = figure.with(230.0, panels.collect());
        height = height.with(line(record.points(center, "t", "y")?, color).named(name));
    }
    let terms = [
        ("kinetic", "kinetic", Color::BLUE),
        ("elastic", "elastic", Color::GREEN),
        ("outside", "gravity", Color::GREY),
        ("between", "between", Color::YELLOW),
        ("damping", "lost to damping", Color::ORANGE),
        ("contact", "lost on the floor", Color::RED),
        ("upkeep", "lost by yielding", Color::PURPLE),
    ];
    let kept = account(
        record,
        "plastic",
        "the account of the ring that yields",
        &terms,
    )?;
    Artefact::only(
        "Above: the ring that yields, and below it the elastic one. Last: how high they bounce, and where the energy goes.",
        figure.with(270.0, vec![height, kept]),
    )
}
