//! Nodes spaced anew, outlines that divide, and results that do not hang on the number of nodes.

use super::course::{advance, group, keep_shots, picture, shots, times, watch};
use crate::demand::{above, below, judged, near};
use crate::draw::{Axis, Color, Figure, Layer, Line, Panel};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Tolerance, real};
use elastic::{Material, Topology};
use field::{EdgeForce, ForceField, Grid, Smoothing};
use glam::DVec2;
use integrator::{Scheme, State, System};
use snake::{Body, EventKind, Rest, Sampling, Simulation, Snake, Upkeep, World};
use std::sync::Arc;

const ID: &str = "soft-respacing";
const COUNTS: [usize; 4] = [50, 100, 200, 400];
const MIDDLE: DVec2 = DVec2::new(63.5, 47.5);

/// The same start with few and many nodes; growth with and without new nodes; a waist that parts.
pub(crate) const RESPACING: Experiment = Experiment {
    id: ID,
    title: "Nodes that come and go",
    place: "beyond",
    question: "Does the end of a run hang on the number of nodes? What do mass, momentum and spin do when a growing curve \
               gets new ones? And what becomes of an outline whose waist has passed through itself?",
    claims: &[
        Claim {
            says: "50, 100, 200 and 400 nodes end within a tenth of a pixel of each other",
            source: "parameters are densities along the curve",
            judge: |r| {
                let mut off = 0.0_f64;
                for n in &COUNTS[..3] {
                    off = off.max(r.number(&format!("{n} nodes: farthest from 400 nodes"))?);
                }
                Ok(Finding::new(
                    off < 0.1,
                    format!("farthest apart {off:.4} px"),
                ))
            },
        },
        Claim {
            says: "a curve that grows to twice its size keeps mass, momentum and angular momentum when it gets new nodes",
            source: "the plan of an outline",
            judge: |r| {
                judged(
                    r,
                    &[
                        below("mass off", 1e-12),
                        below("momentum off", 1e-9),
                        below("angular momentum off", 1e-6),
                    ],
                )
            },
        },
        Claim {
            says: "an outline pinched through itself becomes two, each simple and of positive area",
            source: "kept in order",
            judge: |r| {
                judged(
                    r,
                    &[
                        near("pieces", 2.0, 0.5),
                        above("least area of a piece", 0.5),
                        below("curves without upkeep", 1.5),
                    ],
                )
            },
        },
    ],
    run,
    draw,
};

/// A bright ellipse of semi-axes 40 and 25.
fn ellipse() -> Result<Arc<ForceField>, SandboxError> {
    let image = Grid::from_shape_fn((96, 128), |(y, x)| {
        let p = DVec2::new(real(x), real(y)) - MIDDLE;
        let out = ((p / DVec2::new(40.0, 25.0)).length() - 1.0) * 31.0;
        120.0 / (1.0 + out.exp())
    });
    let rule = EdgeForce {
        smoothing: Smoothing::Gaussian(4.0),
        gain: 6.0,
    };
    let field = field::edge_force(&image, &rule).map_err(SandboxError::refused(ID))?;
    Ok(Arc::new(field))
}

/// Where a circle of that many nodes comes to rest.
fn settled(field: &Arc<ForceField>, n: usize) -> Result<Vec<DVec2>, SandboxError> {
    let nodes = elastic::ellipse(MIDDLE, DVec2::new(46.0, 31.0), 0.0, n);
    let body = Body::of(&nodes, Topology::Closed, 1.0)
        .map_err(SandboxError::refused(ID))?
        .with_material(Material::uniform(0.0, 4.0, 4.0))
        .with_damping(1.0);
    let world = World::default().with_image(Arc::clone(field), Sampling::Bilinear);
    let snake = Snake::new(body, world).map_err(SandboxError::refused(ID))?;
    let limit = Scheme::Leapfrog.step_limit(&snake).unwrap_or(0.2);
    let snakes = vec![(snake, State::at_rest(nodes))];
    let mut crowd = group(ID, snakes, (0.7 * limit).min(0.1), Upkeep::default())?;
    crowd.watch(Rest::default());
    while crowd.steps() < 40_000 && !crowd.is_at_rest() {
        advance(ID, &mut crowd)?;
    }
    Ok(crowd.members()[0].state().x.clone())
}

/// Distance of a point from a closed polygon.
fn away(p: DVec2, polygon: &[DVec2]) -> f64 {
    let n = polygon.len();
    let each = (0..n).map(|i| {
        let (a, b) = (polygon[i], polygon[(i + 1) % n]);
        let along = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        p.distance(a + along * (b - a))
    });
    each.fold(f64::INFINITY, f64::min)
}

fn free(body: Body, state: State) -> Result<Vec<(Snake, State)>, SandboxError> {
    let snake = Snake::new(body, World::default()).map_err(SandboxError::refused(ID))?;
    Ok(vec![(snake, state)])
}

fn grow(
    record: &mut Record,
    stretch: Option<f64>,
    table: &'static str,
) -> Result<(), SandboxError> {
    let nodes = elastic::circle(DVec2::ZERO, 3.0, 30);
    let mut body = Body::of(&nodes, Topology::Closed, 1.0)
        .map_err(SandboxError::refused(ID))?
        .with_material(Material::uniform(0.0, 20.0, 4.0));
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
    let mut crowd = group(ID, free(body, state)?, 1e-3, upkeep)?;
    let mass = |crowd: &Simulation| {
        let member = &crowd.members()[0];
        member.snake().mass().iter().sum::<f64>() * member.snake().body().spacing
    };
    let (m, p, l) = (mass(&crowd), crowd.momentum(), crowd.angular_momentum());
    let course = watch(ID, &mut crowd, 1200, 100, &[0, 400, 800, 1200])?;
    keep_shots(record, table, &course.shots);
    if stretch.is_some() {
        record.note(
            "nodes at the end",
            real(crowd.members()[0].state().len()),
            "",
            Tolerance::EXACT,
        );
        record.note(
            "mass off",
            (mass(&crowd) / m - 1.0).abs(),
            "",
            Tolerance::ROUNDING,
        );
        let off = crowd.momentum().distance(p) / p.length();
        record.note("momentum off", off, "", Tolerance::ROUNDING);
        let off = (crowd.angular_momentum() / l - 1.0).abs();
        record.note("angular momentum off", off, "", Tolerance::Absolute(1e-7));
    }
    Ok(())
}

fn pinch(
    record: &mut Record,
    least_area: Option<f64>,
    table: &'static str,
) -> Result<(), SandboxError> {
    let nodes = elastic::circle(DVec2::ZERO, 4.0, 60);
    let mut body = Body::of(&nodes, Topology::Closed, 1.0)
        .map_err(SandboxError::refused(ID))?
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
    let snakes = free(body, State::at_rest(nodes))?;
    let mut crowd = group(ID, snakes, 5e-3, upkeep)?;
    let course = watch(ID, &mut crowd, 800, 200, &[0, 40, 80, 800])?;
    keep_shots(record, table, &course.shots);
    let pieces = real(crowd.members().len());
    if least_area.is_some() {
        record.note("pieces", pieces, "", Tolerance::EXACT);
        let areas = crowd
            .members()
            .iter()
            .map(|m| elastic::signed_area(&m.state().x));
        let least = areas.fold(f64::INFINITY, f64::min);
        record.note(
            "least area of a piece",
            least,
            "px²",
            Tolerance::Relative(1e-3),
        );
        let split = crowd
            .events()
            .iter()
            .find(|e| matches!(e.kind, EventKind::Split { .. }));
        let when = split.map_or(f64::NAN, |e| e.t);
        record.note("time of the split", when, "s", Tolerance::Absolute(0.03));
    } else {
        record.note("curves without upkeep", pieces, "", Tolerance::EXACT);
    }
    Ok(())
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let field = ellipse()?;
    let ends = COUNTS
        .iter()
        .map(|&n| settled(&field, n))
        .collect::<Result<Vec<_>, SandboxError>>()?;
    for (n, end) in COUNTS.iter().zip(&ends).take(3) {
        let off = end.iter().map(|p| away(*p, &ends[3])).fold(0.0, f64::max);
        record.note(
            format!("{n} nodes: farthest from 400 nodes"),
            off,
            "px",
            Tolerance::Relative(0.1),
        );
    }
    let kept: Vec<(f64, usize, bool, Vec<DVec2>)> = ends
        .into_iter()
        .enumerate()
        .map(|(k, end)| (0.0, k, true, end))
        .collect();
    keep_shots(&mut record, "ends", &kept);
    grow(&mut record, Some(1.5), "grown")?;
    grow(&mut record, None, "grown-without")?;
    pinch(&mut record, Some(0.5), "pinched")?;
    pinch(&mut record, None, "pinched-without")?;
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let ends = shots(record, "ends")?;
    let mut whole = Panel::new(
        "50, 100, 200, 400 nodes at rest on an ellipse",
        Axis::new("x / px", 18.0, 109.0),
        Axis::new("y / px", 78.0, 17.0),
    )
    .equal();
    let mut close = Panel::new(
        "close",
        Axis::new("x / px", 101.0, 105.5),
        Axis::new("y / px", 51.0, 44.0),
    )
    .equal();
    for (shot, (color, n)) in ends.iter().zip(Color::SERIES.into_iter().zip(COUNTS)) {
        let line = || Line::new(shot.points.clone(), color).weighing(0.7);
        whole = whole.with(line());
        close = close.with(line().named(format!("{n}"))).with(Layer::Dots {
            points: shot.points.clone(),
            radius: 1.2,
            color,
            label: String::new(),
        });
    }
    close.share = 0.8;
    let mut figure = Figure::new("Nodes that come and go", 1000.0).with(330.0, vec![whole, close]);
    for (with, without, window, what) in [
        ("grown", "grown-without", [-7.5, -8.0, 8.5, 7.5], "grown"),
        (
            "pinched",
            "pinched-without",
            [-4.6, -5.4, 4.6, 5.4],
            "pinched",
        ),
    ] {
        let mut row = Vec::new();
        for (table, words) in [(with, ""), (without, ", left alone")] {
            let all = shots(record, table)?;
            let times = times(&all);
            let chosen = if words.is_empty() {
                &times[..]
            } else {
                &times[times.len() - 1..]
            };
            for &t in chosen {
                let color = |snake: usize| Color::SERIES[snake % 6];
                let mut panel = picture(
                    format!("{what}{words}, t = {t:.1} s"),
                    &all,
                    t,
                    window,
                    &color,
                );
                for shot in all.iter().filter(|shot| shot.t.to_bits() == t.to_bits()) {
                    panel = panel.with(Layer::Dots {
                        points: shot.points.clone(),
                        radius: 1.0,
                        color: Color::INK,
                        label: String::new(),
                    });
                }
                row.push(panel);
            }
        }
        figure = figure.with(220.0, row);
    }
    Ok(vec![Artefact::figure(
        "Above: the same start with few nodes and many. Middle: a ring that grows and spins gets new nodes, and at the right does not. \
         Below: an outline pinched through itself is cut in two, and at the right is left alone.",
        figure,
    )])
}
