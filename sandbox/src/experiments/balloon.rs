//! Report §5.4: pressure inside the curve, by every law, and what it cannot do.

use super::pixels::grey;
use crate::demand::{below, judged};
use crate::draw::{Axis, Color, Corner, Figure, Line, Panel, Picture};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use elastic::{Material, Topology};
use field::{EdgeForce, Grid, Smoothing, TwoRegions, edge_force};
use glam::DVec2;
use integrator::{Scheme, State};
use snake::{
    Acting, Body, ImageForce, Pressure, RegionForce, Rest, Sampling, Schedule, Simulation, Snake,
    Stepping, Until, World,
};
use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Arc;

const ID: &str = "sec-5-4-balloon";
const MIDDLE: DVec2 = DVec2::splat(60.0);
/// Pressure at its strongest.
const PUSH: f64 = 1.2;
/// Radius of the weak ring and of the strong one.
const RINGS: [f64; 2] = [22.0, 40.0];
const CASES: [&str; 8] = [
    "no pressure",
    "constant",
    "fades with time",
    "gas",
    "area target",
    "sign found - from inside",
    "sign found - from outside",
    "narrow channel",
];
const TABLES: [&str; 8] = [
    "curve-none",
    "curve-constant",
    "curve-fading",
    "curve-gas",
    "curve-area",
    "curve-inside",
    "curve-outside",
    "curve-channel",
];

/// Balloons.
pub(crate) const BALLOON: Experiment = Experiment {
    id: ID,
    title: "A balloon",
    place: "§5.4",
    question: "A small circle starts far inside a ring that is all it should find; a weaker ring lies between. Pressure by every law: what is passed, \
               what stops it, and where does it fail?",
    claims: &[
        Claim {
            says: "without pressure the circle stays small: the edge is out of reach",
            source: "report §5.4",
            judge: |r| judged(r, &[below("no pressure: farthest node", 16.0)]),
        },
        Claim {
            says: "a constant pressure passes the weak edge, and the strong one stops it",
            source: "report §5.4",
            judge: |r| {
                let (near, far) = (
                    r.number("constant: nearest node")?,
                    r.number("constant: farthest node")?,
                );
                Ok(Finding::new(
                    near > RINGS[1] - 3.0 && far < RINGS[1] + 1.0,
                    format!(
                        "from {near:.2} to {far:.2} px, the ring is at {:.0}",
                        RINGS[1]
                    ),
                ))
            },
        },
        Claim {
            says: "one that fades once it has arrived leaves the curve where the edge alone holds it",
            source: "report §5.4",
            judge: |r| {
                let (held, pushed) = (
                    r.number("fades with time: mean radius")?,
                    r.number("constant: mean radius")?,
                );
                Ok(Finding::new(
                    held < pushed && held > RINGS[1] - 3.0,
                    format!("mean radius {held:.2} px, {pushed:.2} px under lasting pressure"),
                ))
            },
        },
        Claim {
            says: "a gas loses its pressure as it grows and stops at the weak edge already",
            source: "p V = const",
            judge: |r| {
                let far = r.number("gas: farthest node")?;
                Ok(Finding::new(
                    far < RINGS[0] + 1.0 && r.number("gas: nearest node")? > RINGS[0] - 3.0,
                    format!("{far:.2} px at most, the weak ring is at {:.0}", RINGS[0]),
                ))
            },
        },
        Claim {
            says: "an area target stops between the rings: beyond the weak edge, short of its area by what tension asks",
            source: "report §5.4",
            judge: |r| {
                let (area, target) = (r.number("area target: area")?, PI * 31.0 * 31.0);
                Ok(Finding::new(
                    area > PI * RINGS[0] * RINGS[0] && area < target,
                    format!("{area:.0} px² of {target:.0}"),
                ))
            },
        },
        Claim {
            says: "the sign can be found: from inside it inflates, from outside it deflates, to the same outline",
            source: "report §5.4",
            judge: |r| {
                let (a, b) = (
                    r.number("sign found - from inside: mean radius")?,
                    r.number("sign found - from outside: mean radius")?,
                );
                Ok(Finding::new(
                    (a - b).abs() < 1.5,
                    format!("mean radii {a:.2} and {b:.2} px"),
                ))
            },
        },
        Claim {
            says: "its weakness: into a narrow part of a shape that is not convex it does not go",
            source: "report §5.4",
            judge: |r| {
                let far = r.number("narrow channel: farthest node")? - 30.0;
                Ok(Finding::new(
                    far < 8.0,
                    format!("{far:.1} px into a channel 20 px long"),
                ))
            },
        },
    ],
    run,
    draw,
};

/// The two rings, the weak and the strong.
fn rings() -> Grid {
    Grid::from_shape_fn((121, 121), |(y, x)| {
        let away = (DVec2::new(real(x), real(y)) - MIDDLE).length();
        let ring = |radius: f64| (2.5 - (away - radius).abs()).clamp(0.0, 1.0);
        5.0 * ring(RINGS[0]) + 100.0 * ring(RINGS[1])
    })
}

/// A disc with a channel out of it.
fn channel() -> Grid {
    Grid::from_shape_fn((121, 121), |(y, x)| {
        let q = DVec2::new(real(x), real(y)) - MIDDLE;
        let way_out = (5.5 - q.y.abs()).min(50.5 - q.x).min(q.x);
        100.0 * (30.5 - q.length()).max(way_out).clamp(0.0, 1.0)
    })
}

fn disc() -> Grid {
    Grid::from_shape_fn((121, 121), |(y, x)| {
        let away = (DVec2::new(real(x), real(y)) - MIDDLE).length();
        100.0 * (RINGS[1] + 0.5 - away).clamp(0.0, 1.0)
    })
}

/// The picture, the pressure, the radius of the start and the tension of a case.
fn case(name: &str) -> Result<(Grid, Option<Acting>, f64, f64), SandboxError> {
    let constant = || Acting::new(Pressure::constant(PUSH));
    let judge = TwoRegions::new(&disc(), 1e-3).map_err(SandboxError::refused(ID))?;
    let judge = RegionForce::new(Arc::new(judge));
    let found = || Acting::new(Pressure::automatic(PUSH, judge.clone()));
    Ok(match name {
        "no pressure" => (rings(), None, 12.0, 2.0),
        "constant" => (rings(), Some(constant()), 12.0, 2.0),
        "fades with time" => {
            let fades = Schedule::new(vec![(0.0, 1.0), (60.0, 1.0), (90.0, 0.0)])
                .map_err(SandboxError::refused(ID))?;
            (rings(), Some(constant().scheduled(fades)), 12.0, 2.0)
        }
        "gas" => (
            rings(),
            Some(Acting::new(Pressure::gas(PUSH, PI * 144.0))),
            12.0,
            2.0,
        ),
        "area target" => (
            rings(),
            Some(Acting::new(Pressure::area(2.0 * PUSH, PI * 31.0 * 31.0))),
            12.0,
            2.0,
        ),
        "sign found - from inside" => (disc(), Some(found()), 12.0, 2.0),
        "sign found - from outside" => (disc(), Some(found()), 54.0, 2.0),
        _ => (
            channel(),
            Some(Acting::new(Pressure::constant(2.0))),
            12.0,
            5.0,
        ),
    })
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    record.keep_grid("rings", rings());
    record.keep_grid("disc", disc());
    record.keep_grid("channel", channel());
    for (name, table) in CASES.into_iter().zip(TABLES) {
        let (picture, pressure, radius, tension) = case(name)?;
        let recipe = EdgeForce {
            smoothing: Smoothing::Gaussian(1.5),
            gain: 4.0,
        };
        let field = edge_force(&picture, &recipe).map_err(SandboxError::refused(ID))?;
        let mut world = World::default().with(ImageForce::new(Arc::new(field), Sampling::Bilinear));
        if let Some(pressure) = pressure {
            world = world.with_acting(pressure);
        }
        let x = elastic::circle(MIDDLE, radius, 120);
        let mut body = Body::of(&x, Topology::Closed, 1.0)
            .map_err(SandboxError::refused(ID))?
            .with_material(Material::uniform(0.0, tension, 0.0))
            .with_damping(3.0);
        // a membrane, which pulls together whatever its size
        body.rest = elastic::circle(DVec2::ZERO, 1e-6, 120);
        let snake = Snake::new(body, world).map_err(SandboxError::refused(ID))?;
        let state = State::at_rest(x);
        let dt = 0.05;
        let (mut curves, mut course) = (
            vec![state.x.clone()],
            vec![(0.0, elastic::signed_area(&state.x))],
        );
        let until = if name == "fades with time" {
            Until::steps(3200)
        } else {
            Until::at_rest(Rest::default(), 4000)
        };
        let begun = Simulation::of(snake, state, Stepping::of(Scheme::Leapfrog, dt));
        let mut simulation = begun.map_err(SandboxError::refused(ID))?;
        let outcome = simulation.run(&until, &mut |simulation| {
            let state = simulation.members()[0].state();
            if state.step.is_multiple_of(20) {
                course.push((state.t, elastic::signed_area(&state.x)));
            }
            if state.step.is_multiple_of(100) && curves.len() < 9 {
                curves.push(state.x.clone());
            }
            // a leak ends at the border of the picture
            if state.x.iter().any(|p| p.distance(MIDDLE) > 58.0) {
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        });
        outcome.map_err(SandboxError::refused(ID))?;
        let state = simulation.members()[0].state().clone();
        curves.push(state.x.clone());
        course.push((state.t, elastic::signed_area(&state.x)));
        let radii: Vec<f64> = state.x.iter().map(|p| p.distance(MIDDLE)).collect();
        let close = Tolerance::Absolute(0.01);
        record.note(
            format!("{name}: nearest node"),
            radii.iter().copied().fold(f64::INFINITY, f64::min),
            "px",
            close,
        );
        record.note(
            format!("{name}: farthest node"),
            radii.iter().copied().fold(0.0, f64::max),
            "px",
            close,
        );
        record.note(
            format!("{name}: mean radius"),
            radii.iter().sum::<f64>() / real(radii.len()),
            "px",
            close,
        );
        let area = elastic::signed_area(&state.x);
        record.note(
            format!("{name}: area"),
            area,
            "px²",
            Tolerance::Relative(1e-3),
        );
        let nodes = || {
            curves
                .iter()
                .enumerate()
                .flat_map(|(k, x)| x.iter().map(move |p| (real(k), *p)))
        };
        record.keep(
            Table::raw(table)
                .with("t", "", Tolerance::EXACT, nodes().map(|n| n.0).collect())
                .with("x", "", Tolerance::EXACT, nodes().map(|n| n.1.x).collect())
                .with("y", "", Tolerance::EXACT, nodes().map(|n| n.1.y).collect()),
        );
        let over = match table {
            "curve-constant" => "area-constant",
            "curve-fading" => "area-fading",
            "curve-gas" => "area-gas",
            "curve-area" => "area-area",
            _ => continue,
        };
        record.keep(
            Table::raw(over)
                .with(
                    "t",
                    "",
                    Tolerance::EXACT,
                    course.iter().map(|c| c.0).collect(),
                )
                .with(
                    "area",
                    "",
                    Tolerance::EXACT,
                    course.iter().map(|c| c.1).collect(),
                ),
        );
    }
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let mut panels = Vec::new();
    for (k, (name, table)) in CASES.into_iter().zip(TABLES).enumerate() {
        let grid = record.grid(match k {
            5 | 6 => "disc",
            7 => "channel",
            _ => "rings",
        })?;
        // a weak ring should be seen too
        let shown = grid.mapv(|level| 40.0 + 9.0 * level.sqrt() + 0.5 * level);
        let frames = super::motion::Frames::of(record, table)?;
        let last = frames.len() - 1;
        let mut panel = Panel::pixels(name, 121, 121)
            .bare()
            .with(Picture::new(grey(&shown)));
        for frame in 0..last {
            let share = real(frame) / real(last.max(1));
            panel = panel.with(
                frames
                    .ring(frame, Color::YELLOW.mix(Color::RED, share))
                    .weighing(0.5),
            );
        }
        panels.push(panel.with(frames.ring(last, Color::SKY).weighing(1.6)));
    }
    let below = panels.split_off(4);
    let mut areas = Panel::new(
        "area enclosed",
        Axis::new("t", 0.0, 160.0),
        Axis::new("px²", 0.0, 7600.0),
    )
    .legend_at(Corner::TopRight);
    for (table, name, color) in [
        ("area-constant", "constant", Color::BLUE),
        ("area-fading", "fades from t = 60 to 90", Color::PURPLE),
        ("area-gas", "gas", Color::GREEN),
        ("area-area", "area target", Color::ORANGE),
    ] {
        areas = areas.with(Line::new(record.points(table, "t", "area")?, color).named(name));
    }
    for radius in RINGS {
        let area = PI * radius * radius;
        areas = areas.with(Line::new(vec![(0.0, area), (160.0, area)], Color::GREY).dashed());
    }
    Ok(vec![Artefact::figure(
        "Yellow to red: every hundred steps; blue: the end. The inner ring is a twentieth as bright as the outer one. Dashed: the areas inside the two rings.",
        Figure::new("§5.4  Balloons", 1000.0)
            .with(240.0, panels)
            .with(240.0, below)
            .with(230.0, vec![areas]),
    )])
}
