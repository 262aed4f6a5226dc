//! Nodes spaced anew, outlines that divide, and results that do not hang on the number of nodes.

use crate::prelude::*;
use elastic::{Material, Topology};
use field::{EdgeForce, ForceField, Grid, Smoothing};
use integrator::{Scheme, State, System};
use snake::{Body, EventKind, Rest, Sampling, Snake, Upkeep, World};
use std::sync::Arc;

const COUNTS: [usize; 4] = [50, 100, 200, 400];
const MIDDLE: DVec2 = DVec2::new(63.5, 47.5);

/// The same start with few and many nodes; growth with and without new nodes; a waist that parts.
pub(crate) const RESPACING: Experiment = Experiment {
    id: "soft-respacing",
    title: "Nodes that come and go",
    place: "beyond",
    question: "Does the end of a run hang on the number of nodes? What do mass, momentum and spin do when a growing curve \
               gets new ones? And what becomes of an outline whose waist has passed through itself?",
    claims: &[
        claim("50, 100 and 200 nodes end within a tenth of a pixel of where 400 do \
               [parameters are densities along the curve]")
            .when(&[below("* nodes: farthest from 400 nodes", 0.1)]),
        claim("a curve that grows to twice its size keeps mass, momentum and angular momentum when it \
               gets new nodes [the plan of an outline]")
            .when(&[
                below("mass off", 1e-12),
                below("momentum off", 1e-9),
                below("angular momentum off", 1e-6),
            ]),
        claim("an outline pinched through itself becomes two, each simple and of positive area [kept in order]")
            .when(&[
                near("pieces", 2.0, 0.5),
                above("least area of a piece", 0.5),
                below("curves without upkeep", 1.5),
            ]),
    ],
    run,
    draw,
};

/// A bright ellipse of semi-axes 40 and 25.
fn ellipse() -> Result<Arc<ForceField>> {
    let image = Grid::from_shape_fn((96, 128), |(y, x)| {
        let p = DVec2::new(real(x), real(y)) - MIDDLE;
        let out = ((p / DVec2::new(40.0, 25.0)).length() - 1.0) * 31.0;
        120.0 / (1.0 + out.exp())
    });
    let smoothing = Smoothing::Gaussian(4.0);
    Ok(Arc::new(field::edge_force(
        &image,
        &EdgeForce {
            smoothing,
            gain: 6.0,
        },
    )?))
}

/// Where a circle of that many nodes comes to rest.
fn settled(field: &Arc<ForceField>, n: usize) -> Result<Vec<DVec2>> {
    let nodes = elastic::ellipse(MIDDLE, DVec2::new(46.0, 31.0), 0.0, n);
    let body = Body::of(&nodes, Topology::Closed, 1.0)?
        .with_material(Material::uniform(0.0, 4.0, 4.0))
        .with_damping(1.0);
    let world = World::default().with_image(Arc::clone(field), Sampling::Bilinear);
    let snake = Snake::new(body, world)?;
    let limit = Scheme::Leapfrog.step_limit(&snake).unwrap_or(0.2);
    let dt = (0.7 * limit).min(0.1);
    let mut group = group_of(snake, State::at_rest(nodes), dt, Upkeep::default())?;
    group.watch(Rest::default());
    while group.steps() < 40_000 && !group.is_at_rest() {
        advance(&mut group)?;
    }
    Ok(group.members()[0].state().x.clone())
}

fn grow(record: &mut Record, stretch: Option<f64>, name: &str) -> Result<()> {
    let nodes = elastic::circle(DVec2::ZERO, 3.0, 30);
    let material = Material::uniform(0.0, 20.0, 4.0);
    let mut body = Body::of(&nodes, Topology::Closed, 1.0)?.with_material(material);
    body.frame = snake::Frame::turning();
    body.rest.iter_mut().for_each(|r| *r *= 2.0);
    let mut state = State::at_rest(nodes);
    for (v, x) in state.v.iter_mut().zip(&state.x) {
        *v = DVec2::new(1.0, -0.5) + 0.4 * x.perp();
    }
    let upkeep = Upkeep {
        every: 10,
        stretch,
        ..Upkeep::default()
    };
    let mut group = group_of(Snake::new(body, World::default())?, state, 1e-3, upkeep)?;
    let mass = |group: &Group| {
        let member = &group.members()[0];
        member.snake().mass().iter().sum::<f64>() * member.snake().body().spacing
    };
    let (m, p, l) = (mass(&group), group.momentum(), group.angular_momentum());
    let seen = watch(&mut group, 1200, 100, &[0, 400, 800, 1200])?;
    record.keep_run(name, seen.run);
    if stretch.is_some() {
        let count = real(group.members()[0].state().len());
        record.note("nodes at the end", count, EXACT);
        record.note("mass off", (mass(&group) / m - 1.0).abs(), ROUNDING);
        let off = group.momentum().distance(p) / p.length();
        record.note("momentum off", off, ROUNDING);
        let off = (group.angular_momentum() / l - 1.0).abs();
        record.note("angular momentum off", off, 1e-7);
    }
    Ok(())
}

fn pinch(record: &mut Record, least_area: Option<f64>, name: &str) -> Result<()> {
    let nodes = elastic::circle(DVec2::ZERO, 4.0, 60);
    let mut body = Body::of(&nodes, Topology::Closed, 1.0)?
        .with_damping(4.0)
        .with_material(Material::uniform(20.0, 0.0, 0.0));
    // a rest shape whose waist has passed through itself
    for r in &mut body.rest {
        r.y *= (r.x / 4.0).powi(2) * 1.6 - 0.25;
    }
    let upkeep = Upkeep {
        every: 5,
        stretch: least_area.map(|_| 2.0),
        least_area,
        ..Upkeep::default()
    };
    let snake = Snake::new(body, World::default())?;
    let mut group = group_of(snake, State::at_rest(nodes), 5e-3, upkeep)?;
    let seen = watch(&mut group, 800, 200, &[0, 40, 80, 800])?;
    record.keep_run(name, seen.run);
    let pieces = real(group.members().len());
    if least_area.is_none() {
        record.note("curves without upkeep", pieces, EXACT);
        return Ok(());
    }
    record.note("pieces", pieces, EXACT);
    let areas = group
        .members()
        .iter()
        .map(|m| elastic::signed_area(&m.state().x));
    record.note("least area of a piece [px²]", least(areas), share(1e-3));
    let split = group
        .events()
        .iter()
        .find(|e| matches!(e.kind, EventKind::Split { .. }));
    record.note(
        "time of the split [s]",
        split.map_or(f64::NAN, |e| e.t),
        0.03,
    );
    Ok(())
}

fn run() -> Result {
    let mut record = Record::default();
    let field = ellipse()?;
    let ends = COUNTS
        .iter()
        .map(|&n| settled(&field, n))
        .collect::<Result<Vec<_>>>()?;
    for (n, end) in COUNTS.iter().zip(&ends).take(3) {
        let off = most(end.iter().map(|p| outline::distance(&ends[3], true, *p)));
        record.note(
            format!("{n} nodes: farthest from 400 nodes [px]"),
            off,
            share(0.1),
        );
    }
    let ends = ends.into_iter().map(|end| Frame::closed(0.0, end));
    record.keep_run("ends", ends.collect::<Vec<_>>());
    grow(&mut record, Some(1.5), "grown")?;
    grow(&mut record, None, "grown, left alone")?;
    pinch(&mut record, Some(0.5), "pinched")?;
    pinch(&mut record, None, "pinched, left alone")?;
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let ends = record.run("ends")?;
    let title = "50, 100, 200, 400 nodes at rest on an ellipse";
    let mut whole = plot(title, ("x / px", 18.0, 109.0), ("y / px", 78.0, 17.0)).equal();
    let mut close = plot("close", ("x / px", 101.0, 105.5), ("y / px", 51.0, 44.0)).equal();
    for (k, (color, n)) in Color::SERIES.into_iter().zip(COUNTS).enumerate() {
        let end = ends.ring(k, color).weighing(0.7);
        let nodes = dots(end.points.clone(), 1.2, color);
        whole = whole.with(end.clone());
        close = close.with(end.named(format!("{n}"))).with(nodes);
    }
    close.share = 0.8;
    let mut figure = Figure::new("Nodes that come and go", 1000.0).with(330.0, vec![whole, close]);
    for (what, window) in [
        ("grown", [-7.5, -8.0, 8.5, 7.5]),
        ("pinched", [-4.6, -5.4, 4.6, 5.4]),
    ] {
        let alone = format!("{what}, left alone");
        let kept = record.run(what)?.frames.iter().map(|frame| (what, frame));
        let last = record
            .run(&alone)?
            .frames
            .last()
            .map(|frame| (&*alone, frame));
        let row = kept.chain(last).map(|(name, frame)| {
            let color = |snake: usize| Color::SERIES[snake % 6];
            let title = format!("{name}, t = {:.1} s", frame.t);
            let panel = picture(title, &frame.curves, window, &color);
            frame.curves.iter().fold(panel, |panel, curve| {
                panel.with(dots(curve.points(), 1.0, Color::INK))
            })
        });
        figure = figure.with(220.0, row.collect());
    }
    Artefact::only(
        "Above: the same start with few nodes and many. Middle: a ring that grows and spins gets new nodes, and at the right does not. \
         Below: an outline pinched through itself is cut in two, and at the right is left alone.",
        figure,
    )
}
