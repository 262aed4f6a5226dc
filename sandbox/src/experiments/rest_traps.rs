//! The traps of stop tests: slow is not at rest, and a sparse curve need not collapse.

use crate::prelude::*;
use elastic::{Material, Topology};
use field::{EdgeForce, ForceField, Grid, Smoothing};
use integrator::{Scheme, State};
use snake::{Body, Outcome, Rest, Sampling, Snake, Until, World};
use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::sync::Arc;

const MIDDLE: DVec2 = DVec2::new(127.5, 127.5);

/// Damping, and the share of the longest step.
const SLOW: [(&str, f64, f64); 3] = [("γ 0.5", 0.5, 0.5), ("γ 5", 5.0, 0.3), ("γ 20", 20.0, 0.2)];

/// Numbers of nodes of the curve that only its picture holds open.
const COUNTS: [usize; 5] = [25, 50, 100, 200, 400];

const DENSE: &str = "400 nodes: radius at rest";

/// What a test on pixels per step calls rest: ten steps together move no node by more. L.
const PIXELS: f64 = 0.1;

/// A disc of radius 60, approached from 75.
pub(crate) const REST: Experiment = Experiment {
    id: "rest-traps",
    title: "Slow is not at rest",
    place: "beyond",
    question: "A circle of radius 75 is let go around a disc of radius 60. When does a test on pixels per step call it at \
               rest, when does one on balance, travel and energy together? And where do few nodes end?",
    claims: &[
        claim("under heavy damping a test on pixels per step stops at its first look, with the whole way \
               to go [measured on scikit-image 0.26.0: 74.84 to 74.98 of 75]")
            .when(&[above("γ 20: radius where pixels per step says rest", 74.0)]),
        claim("the test on balance, travel and energy stops at the edge, under each damping and step \
               [report §3.4.2]")
            .when(&[near("γ *: radius at rest", 60.0, 1.0)]),
        claim("parameters are densities along the curve: a sparse one ends where a dense one does \
               [measured on scikit-image 0.26.0: 50 nodes collapse to a point, 100 to 800 end at 58.99 \
               to 59.84]")
            .when(&[
                close("25 nodes: radius at rest", DENSE, 0.3),
                close("50 nodes: radius at rest", DENSE, 0.1),
                close("100 nodes: radius at rest", DENSE, 0.1),
                close("200 nodes: radius at rest", DENSE, 0.1),
            ]),
    ],
    run,
    draw,
};

fn disc() -> Result<Arc<ForceField>> {
    let image = Grid::from_shape_fn((256, 256), |(y, x)| {
        let out = DVec2::new(real(x), real(y)).distance(MIDDLE) - 60.0;
        140.0 / (1.0 + (out / 3.0).exp())
    });
    let rule = EdgeForce {
        smoothing: Smoothing::Gaussian(8.0),
        gain: 400.0 / 140.0,
    };
    Ok(Arc::new(field::edge_force(&image, &rule)?))
}

/// What one run showed.
struct Way {
    /// Time and mean radius.
    points: Vec<(f64, f64)>,
    /// Time and radius where a test on pixels per step would have stopped.
    pixels: Option<(f64, f64)>,
    outcome: Outcome,
}

fn radius(x: &[DVec2]) -> f64 {
    mean(x.iter().map(|p| p.distance(MIDDLE)))
}

/// A circle of radius 75 let go; `held` curves would be that circle, others would be a point.
fn way(field: &Arc<ForceField>, n: usize, (gamma, share): (f64, f64), held: bool) -> Result<Way> {
    let circle = elastic::circle(MIDDLE, 75.0, n);
    let mut body = Body::of(&circle, Topology::Closed, 1.0)?
        .with_material(Material::uniform(0.0, 2.0, 5.0))
        .with_damping(gamma);
    if !held {
        body.rest = elastic::circle(DVec2::ZERO, 1e-6, n);
    }
    let world = World::default().with_image(Arc::clone(field), Sampling::Bilinear);
    let mut snake = Snake::new(body, world)?;
    let mut state = State::at_rest(circle);
    let limit = Scheme::Leapfrog.step_limit(&snake).unwrap_or(0.5).min(0.5);
    let mut points = vec![(0.0, 75.0)];
    let mut ten: VecDeque<Vec<DVec2>> = VecDeque::new();
    let mut pixels = None;
    let until = Until::at_rest(Rest::default(), 200_000);
    let by = (Scheme::Leapfrog, share * limit);
    let outcome = moved(&mut snake, &mut state, by, &until, &mut |state| {
        if pixels.is_none() {
            let away =
                |then: &Vec<DVec2>| most(then.iter().zip(&state.x).map(|(a, b)| a.distance(*b)));
            // as the test is: after ten steps, and against any of them
            if ten.len() == 10 && away(&ten[0]) < PIXELS {
                pixels = Some((state.t, radius(&state.x)));
            }
            ten.push_back(state.x.clone());
            if ten.len() > 10 {
                ten.pop_front();
            }
        }
        if state.step.is_multiple_of(20) {
            points.push((state.t, radius(&state.x)));
        }
        ControlFlow::Continue(())
    })?;
    points.push((state.t, radius(&state.x)));
    Ok(Way {
        points,
        pixels,
        outcome,
    })
}

fn run() -> Result {
    let field = disc()?;
    let mut record = Record::default();
    let close = Tolerance::Absolute(1e-3);
    for (name, gamma, step) in SLOW {
        let way = way(&field, 100, (gamma, step), true)?;
        let (end, radius) = way.points[way.points.len() - 1];
        let settled = flag(matches!(way.outcome, Outcome::Settled { .. }));
        let (t, early) = way.pixels.unwrap_or((f64::NAN, f64::NAN));
        for (what, value, tolerance) in [
            ("radius at rest [px]", radius, close),
            ("came to rest", settled, EXACT.into()),
            ("time to rest [s]", end, share(1e-3)),
            ("radius where pixels per step says rest [px]", early, close),
            ("time where pixels per step says rest [s]", t, close),
        ] {
            record.note(format!("{name}: {what}"), value, tolerance);
        }
        record.keep(Table::raw(name).pairs("t [s]", "radius [px]", &way.points));
    }
    for n in COUNTS {
        let way = way(&field, n, (1.0, 0.5), false)?;
        let end = way.points[way.points.len() - 1].1;
        record.note(format!("{n} nodes: radius at rest [px]"), end, close);
    }
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let title = "radius of a circle let go around a disc";
    let (time, size) = (Axis::log("t / s", 0.1, 2e4), ("radius / px", 56.0, 82.0));
    let edge = line([(0.1, 60.0), (2e4, 60.0)], Color::GREY).dashed();
    let mut panel = plot(title, time, size).with(edge.named("the edge"));
    let (mut early, mut right) = (Vec::new(), Vec::new());
    for ((name, ..), color) in SLOW.into_iter().zip(Color::SERIES) {
        panel = panel.with(line(record.points(name, "t", "radius")?, color).named(name));
        let number = |what: &str| record.told(&format!("{name}: {what}"));
        let stop = number("time where pixels per step says rest")?;
        early.push((stop, number("radius where pixels per step says rest")?));
        right.push((number("time to rest")?, number("radius at rest")?));
    }
    early.retain(|p| p.0.is_finite());
    panel = panel
        .with(dots(early, 3.0, Color::RED).named("stops on pixels per step"))
        .with(dots(right, 3.0, Color::INK).named("at rest"));
    let end = |&n: &usize| Ok((real(n), record.told(&format!("{n} nodes: radius at rest"))?));
    let ends = COUNTS
        .iter()
        .map(end)
        .collect::<Result<Vec<(f64, f64)>>>()?;
    let other = [
        (50.0, 0.0),
        (100.0, 59.84),
        (200.0, 58.99),
        (400.0, 59.29),
        (800.0, 59.17),
    ];
    let title = "where a curve without a shape of its own ends";
    let edge = line([(10.0, 60.0), (1000.0, 60.0)], Color::GREY).dashed();
    let mut sparse = plot(
        title,
        Axis::log("nodes", 10.0, 1000.0),
        ("radius / px", 0.0, 80.0),
    )
    .with(edge.named("the edge"))
    .with(line(ends.clone(), Color::BLUE))
    .with(dots(ends, 2.5, Color::BLUE).named("densities along the curve"))
    .with(dots(other, 2.5, Color::RED).named("scikit-image 0.26.0 on such a disc"));
    sparse.share = 0.8;
    Artefact::only(
        "Left: a stop test on pixels per step ends where nodes are slow, one on balance, travel and energy where they are at rest. \
         Right: with few nodes, parameters that are weights a node let a curve collapse.",
        Figure::new("Slow is not at rest", 1000.0).with(340.0, vec![panel, sparse]),
    )
}
