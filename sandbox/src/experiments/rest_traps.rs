//! The traps of stop tests: slow is not at rest, and a sparse curve need not collapse.

use crate::demand::{above, judged};
use crate::draw::{Axis, Color, Figure, Layer, Line, Panel};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use elastic::{Material, Topology};
use field::{EdgeForce, ForceField, Grid, Smoothing};
use glam::DVec2;
use integrator::{Scheme, State};
use snake::{Body, Outcome, Rest, Sampling, Simulation, Snake, Stepping, Until, World};
use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::sync::Arc;

const ID: &str = "rest-traps";
const MIDDLE: DVec2 = DVec2::new(127.5, 127.5);

/// Damping, and the share of the longest step.
const SLOW: [(&str, f64, f64); 3] = [("γ 0.5", 0.5, 0.5), ("γ 5", 5.0, 0.3), ("γ 20", 20.0, 0.2)];

/// Numbers of nodes of the curve that only its picture holds open.
const COUNTS: [usize; 5] = [25, 50, 100, 200, 400];

/// What a test on pixels per step calls rest: ten steps together move no node by more. L.
const PIXELS: f64 = 0.1;

/// A disc of radius 60, approached from 75.
pub(crate) const REST: Experiment = Experiment {
    id: ID,
    title: "Slow is not at rest",
    place: "beyond",
    question: "A circle of radius 75 is let go around a disc of radius 60. When does a test on pixels per step call it at \
               rest, when does one on balance, travel and energy together? And where do few nodes end?",
    claims: &[
        Claim {
            says: "under heavy damping a test on pixels per step stops at its first look, with the whole way to go",
            source: "measured on scikit-image 0.26.0: 74.84 to 74.98 of 75",
            judge: |r| {
                judged(
                    r,
                    &[above("γ 20: radius where pixels per step says rest", 74.0)],
                )
            },
        },
        Claim {
            says: "the test on balance, travel and energy stops at the edge, under each damping and step",
            source: "report §3.4.2",
            judge: |r| {
                let ends = SLOW
                    .iter()
                    .map(|(name, ..)| r.number(&format!("{name}: radius at rest")))
                    .collect::<Result<Vec<f64>, SandboxError>>()?;
                let off = ends.iter().map(|e| (e - 60.0).abs()).fold(0.0, f64::max);
                Ok(Finding::new(off < 1.0, format!("radii {ends:.2?}")))
            },
        },
        Claim {
            says: "parameters are densities along the curve: a sparse one ends where a dense one does",
            source: "measured on scikit-image 0.26.0: 50 nodes collapse to a point, 100 to 800 end at 58.99 to 59.84",
            judge: |r| {
                let ends = COUNTS
                    .iter()
                    .map(|n| r.number(&format!("{n} nodes: radius at rest")))
                    .collect::<Result<Vec<f64>, SandboxError>>()?;
                let off = ends[1..]
                    .iter()
                    .map(|e| (e - ends[4]).abs())
                    .fold(0.0, f64::max);
                Ok(Finding::new(
                    off < 0.1 && (ends[0] - ends[4]).abs() < 0.3,
                    format!("radii {ends:.3?} for {COUNTS:?} nodes"),
                ))
            },
        },
    ],
    run,
    draw,
};

fn disc() -> Result<Arc<ForceField>, SandboxError> {
    let image = Grid::from_shape_fn((256, 256), |(y, x)| {
        let out = DVec2::new(real(x), real(y)).distance(MIDDLE) - 60.0;
        140.0 / (1.0 + (out / 3.0).exp())
    });
    let rule = EdgeForce {
        smoothing: Smoothing::Gaussian(8.0),
        gain: 400.0 / 140.0,
    };
    let field = field::edge_force(&image, &rule).map_err(SandboxError::refused(ID))?;
    Ok(Arc::new(field))
}

/// What one run showed.
struct Way {
    /// Time and mean radius.
    points: Vec<(f64, f64)>,
    /// Time and radius where a test on pixels per step would have stopped.
    pixels: Option<(f64, f64)>,
    /// At the end.
    radius: f64,
    outcome: Outcome,
}

fn radius(x: &[DVec2]) -> f64 {
    x.iter().map(|p| p.distance(MIDDLE)).sum::<f64>() / real(x.len())
}

/// A circle of radius 75 let go; `held` curves would be that circle, others would be a point.
fn way(
    field: Arc<ForceField>,
    n: usize,
    gamma: f64,
    share: f64,
    held: bool,
) -> Result<Way, SandboxError> {
    let circle = elastic::circle(MIDDLE, 75.0, n);
    let mut body = Body::of(&circle, Topology::Closed, 1.0)
        .map_err(SandboxError::refused(ID))?
        .with_material(Material::uniform(0.0, 2.0, 5.0))
        .with_damping(gamma);
    if !held {
        body.rest = elastic::circle(DVec2::ZERO, 1e-6, n);
    }
    let world = World::default().with_image(field, Sampling::Bilinear);
    let snake = Snake::new(body, world).map_err(SandboxError::refused(ID))?;
    let limit = Scheme::Leapfrog.step_limit(&snake).unwrap_or(0.5).min(0.5);
    let mut points = vec![(0.0, 75.0)];
    let mut last: VecDeque<Vec<DVec2>> = VecDeque::new();
    let mut pixels = None;
    let until = Until::at_rest(Rest::default(), 200_000);
    let stepping = Stepping::of(Scheme::Leapfrog, share * limit);
    let begun = Simulation::of(snake, State::at_rest(circle), stepping);
    let mut simulation = begun.map_err(SandboxError::refused(ID))?;
    let outcome = simulation.run(&until, &mut |simulation| {
        let state = simulation.members()[0].state();
        if pixels.is_none() {
            let away = |then: &Vec<DVec2>| {
                let ways = then.iter().zip(&state.x).map(|(a, b)| a.distance(*b));
                ways.fold(0.0, f64::max)
            };
            // as the test is: after ten steps, and against any of them
            if last.len() == 10 && away(&last[0]) < PIXELS {
                pixels = Some((state.t, radius(&state.x)));
            }
            last.push_back(state.x.clone());
            if last.len() > 10 {
                last.pop_front();
            }
        }
        if state.step.is_multiple_of(20) {
            points.push((state.t, radius(&state.x)));
        }
        ControlFlow::Continue(())
    });
    let outcome = outcome.map_err(SandboxError::refused(ID))?;
    let state = simulation.members()[0].state();
    points.push((state.t, radius(&state.x)));
    Ok(Way {
        points,
        pixels,
        radius: radius(&state.x),
        outcome,
    })
}

fn run() -> Result<Record, SandboxError> {
    let field = disc()?;
    let mut record = Record::default();
    let close = Tolerance::Absolute(1e-3);
    for ((name, gamma, share), table) in SLOW.into_iter().zip(["slow-0", "slow-1", "slow-2"]) {
        let way = way(Arc::clone(&field), 100, gamma, share, true)?;
        let end = way.points.last().copied().unwrap_or((0.0, 0.0)).0;
        let settled = f64::from(u8::from(matches!(way.outcome, Outcome::Settled { .. })));
        record.note(format!("{name}: radius at rest"), way.radius, "px", close);
        record.note(
            format!("{name}: came to rest"),
            settled,
            "",
            Tolerance::EXACT,
        );
        record.note(
            format!("{name}: time to rest"),
            end,
            "s",
            Tolerance::Relative(1e-3),
        );
        let (t, radius) = way.pixels.unwrap_or((f64::NAN, f64::NAN));
        record.note(
            format!("{name}: radius where pixels per step says rest"),
            radius,
            "px",
            close,
        );
        record.note(
            format!("{name}: time where pixels per step says rest"),
            t,
            "s",
            close,
        );
        let columns = |f: fn(&(f64, f64)) -> f64| way.points.iter().map(f).collect();
        record.keep(
            Table::raw(table)
                .with("t", "s", Tolerance::EXACT, columns(|p| p.0))
                .with("radius", "px", Tolerance::EXACT, columns(|p| p.1)),
        );
    }
    for n in COUNTS {
        let way = way(Arc::clone(&field), n, 1.0, 0.5, false)?;
        record.note(
            format!("{n} nodes: radius at rest"),
            way.radius,
            "px",
            close,
        );
    }
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let mut panel = Panel::new(
        "radius of a circle let go around a disc",
        Axis::log("t / s", 0.1, 2e4),
        Axis::new("radius / px", 56.0, 82.0),
    )
    .with(
        Line::new(vec![(0.1, 60.0), (2e4, 60.0)], Color::GREY)
            .dashed()
            .named("the edge"),
    );
    let (mut early, mut right) = (Vec::new(), Vec::new());
    for (((name, ..), table), color) in SLOW
        .into_iter()
        .zip(["slow-0", "slow-1", "slow-2"])
        .zip(Color::SERIES)
    {
        let points = record.points(table, "t", "radius")?;
        panel = panel.with(Line::new(points, color).named(name));
        let stop = record.number(&format!("{name}: time where pixels per step says rest"))?;
        if stop.is_finite() {
            early.push((
                stop,
                record.number(&format!("{name}: radius where pixels per step says rest"))?,
            ));
        }
        let end = record.number(&format!("{name}: time to rest"))?;
        right.push((end, record.number(&format!("{name}: radius at rest"))?));
    }
    panel = panel
        .with(Layer::Dots {
            points: early,
            radius: 3.0,
            color: Color::RED,
            label: "stops on pixels per step".to_owned(),
        })
        .with(Layer::Dots {
            points: right,
            radius: 3.0,
            color: Color::INK,
            label: "at rest".to_owned(),
        });
    let ends = COUNTS
        .iter()
        .map(|&n| {
            Ok((
                real(n),
                record.number(&format!("{n} nodes: radius at rest"))?,
            ))
        })
        .collect::<Result<Vec<(f64, f64)>, SandboxError>>()?;
    let mut sparse = Panel::new(
        "where a curve without a shape of its own ends",
        Axis::log("nodes", 10.0, 1000.0),
        Axis::new("radius / px", 0.0, 80.0),
    )
    .with(
        Line::new(vec![(10.0, 60.0), (1000.0, 60.0)], Color::GREY)
            .dashed()
            .named("the edge"),
    )
    .with(Line::new(ends.clone(), Color::BLUE))
    .with(Layer::Dots {
        points: ends,
        radius: 2.5,
        color: Color::BLUE,
        label: "densities along the curve".to_owned(),
    })
    .with(Layer::Dots {
        points: vec![
            (50.0, 0.0),
            (100.0, 59.84),
            (200.0, 58.99),
            (400.0, 59.29),
            (800.0, 59.17),
        ],
        radius: 2.5,
        color: Color::RED,
        label: "scikit-image 0.26.0 on such a disc".to_owned(),
    });
    sparse.share = 0.8;
    let figure = Figure::new("Slow is not at rest", 1000.0).with(340.0, vec![panel, sparse]);
    Ok(vec![Artefact::figure(
        "Left: a stop test on pixels per step ends where nodes are slow, one on balance, travel and energy where they are at rest. \
         Right: with few nodes, parameters that are weights a node let a curve collapse.",
        figure,
    )])
}
