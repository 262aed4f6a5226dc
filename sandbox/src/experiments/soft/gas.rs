//! A bag with gas, and the same bag empty.

use crate::prelude::*;
use snake::{Acting, Pressure, World};

/// The scene gas-bag, with and without gas, and in empty space.
pub(crate) const GAS: Experiment = Experiment {
    id: "soft-gas",
    title: "A bag with gas",
    place: "beyond",
    question: "A skin under tension holds a gas, falls on the floor and bounces. Does it come to rest where its forces balance, \
               and what does the skin do without the gas?",
    claims: &[
        claim("at rest the gas on an upright cut is held by the skin above and below it [p H = T₁ + T₂]")
            .when(&[like("p H at rest", "T₁ + T₂ at rest", 0.01)]),
        claim("thrown into empty space it keeps its momentum [the push of a gas has no sum]")
            .when(&[below("momentum lost without walls", 1e-12)]),
        claim("without gas the skin shrinks to nothing [the same run without]")
            .when(&[below("area without gas after 40 s", 0.2)]),
    ],
    run,
    draw,
};

fn run() -> Result {
    let scene = scene_with("gas-bag", &[])?;
    let (steps, dt) = (scene.plan.until.steps, scene.plan.dt);
    let gas = |acting: &Acting| acting.downcast::<Pressure>().is_some();
    let mut record = Record::default();
    let mut bag = group(&scene)?;
    let full = elastic::signed_area(&scene.start.x);
    let at = |t: f64| steps_in(t, dt);
    let every: Vec<u64> = (0..=steps / 10).map(|k| 10 * k).collect();
    let mut seen = watch(&mut bag, steps, 5, &every)?;
    seen.note(&mut record, "gas", 1e-3);
    let size = |frame: &Frame| (frame.t, elastic::signed_area(&frame.curves[0].nodes) / full);
    let sizes: Vec<(f64, f64)> = seen.run.frames.iter().map(size).collect();
    record.keep(Table::raw("area").pairs("t [s]", "share", &sizes));
    let member = &bag.members()[0];
    let (x, body) = (&member.state().x, member.snake().body());
    // where the skin meets the upright through the center, and its tension there
    let axis = elastic::center(x, None).x;
    let edges = (0..x.len()).map(|i| (i, x[i], x[(i + 1) % x.len()]));
    let cut = edges.filter(|(_, a, b)| (a.x < axis) != (b.x < axis));
    let pull = |i| body.material.tension.at(i) / body.spacing;
    let cut: Vec<(f64, f64)> = cut
        .map(|(i, a, b)| (0.5 * (a + b).y, pull(i) * a.distance(b)))
        .collect();
    let height = (cut[0].0 - cut[1].0).abs();
    let pressure = scene
        .snake
        .world()
        .forces
        .iter()
        .find_map(|acting| acting.downcast::<Pressure>());
    let area = elastic::signed_area(x);
    // what it was given with: its pressure at the area of the start
    let p = pressure.map_or(0.0, |p| p.at(area));
    record.note("area at rest [of the start]", area / full, share(1e-3));
    record.note("p H at rest", p * height, share(1e-3));
    record.note("T₁ + T₂ at rest", cut[0].1 + cut[1].1, share(1e-3));
    let shown = [0.0, 2.2, 2.8, 3.6, 60.0].map(|t| real_steps(at(t)) * dt);
    let is_shown = |frame: &Frame| shown.iter().any(|t| (frame.t - t).abs() < 0.5 * dt);
    seen.run.frames.retain(is_shown);
    record.keep_run("gas", seen.run);

    // the same without gas
    let mut empty = scene.clone();
    let mut world = empty.snake.world().clone();
    world.forces.retain(|acting| !gas(acting));
    empty.snake.set_world(world)?;
    let mut skin = group(&empty)?;
    let pictures = [0.0, 2.2, 2.8, 3.6, 40.0].map(at);
    let without = watch(&mut skin, at(40.0), steps, &pictures)?;
    let left = elastic::signed_area(&skin.members()[0].state().x).abs() / full;
    record.note(
        "area without gas after 40 s [of the start]",
        left,
        share(0.3),
    );
    record.keep_run("no gas", without.run);

    // and thrown into empty space, wobbling
    let mut thrown = scene.clone();
    let mut world = World::default();
    let forces = scene.snake.world().forces.iter();
    world
        .forces
        .extend(forces.filter(|acting| gas(acting)).cloned());
    thrown.snake.set_world(world)?;
    let body = thrown.snake.body().clone().with_damping(0.0);
    thrown.snake.set_body(body)?;
    let center = elastic::center(&thrown.start.x, None);
    for (v, x) in thrown.start.v.iter_mut().zip(&thrown.start.x) {
        *v = DVec2::new(0.7, 0.3) + 0.3 * (*x - center) * DVec2::new(1.0, -1.0);
    }
    let flight = watch(&mut group(&thrown)?, steps, 100, &[])?;
    let off = flight.momentum.1 / flight.momentum.0.length();
    record.note("momentum lost without walls [of itself]", off, 1e-12);
    flight.note(&mut record, "thrown", 1e-2);
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let mut figure = Figure::new("A bag with gas", 1000.0);
    for (name, color) in [("gas", Color::BLUE), ("no gas", Color::RED)] {
        let panels = record.run(name)?.frames.iter().map(|frame| {
            let title = format!("{name}, t = {:.1} s", frame.t);
            picture(title, &frame.curves, [-5.2, -0.5, 5.2, 11.5], &|_| color)
                .with(wall((-5.2, 0.0), (5.2, 0.0)))
        });
        figure = figure.with(230.0, panels.collect());
    }
    let (time, share) = (("t / s", 0.0, 30.0), ("share of the start", 0.3, 1.3));
    let area = plot("its area", time, share);
    let area = area.with(line(record.points("area", "t", "share")?, Color::BLUE));
    let terms = [
        ("kinetic", "kinetic", Color::BLUE),
        ("elastic", "skin", Color::GREEN),
        ("outside", "gravity and gas", Color::GREY),
        ("damping", "lost to damping", Color::ORANGE),
        ("wall", "floor", Color::YELLOW),
        ("contact", "lost on the floor", Color::RED),
    ];
    Artefact::only(
        "Above: the bag bounces on its gas, and below it the same skin without. Last: its area, and where the energy goes.",
        figure.with(
            270.0,
            vec![area, account(record, "gas", "the account", &terms)?],
        ),
    )
}
