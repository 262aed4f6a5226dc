//! Report §5.4: pressure inside the curve, by every law, and what it cannot do.

use crate::prelude::*;
use elastic::{Material, Topology};
use field::{EdgeForce, Grid, Smoothing, TwoRegions, edge_force};
use integrator::{Scheme, State};
use snake::{
    Acting, Body, ImageForce, Pressure, RegionForce, Rest, Sampling, Schedule, Snake, Until, World,
};
use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Arc;

const MIDDLE: DVec2 = DVec2::splat(60.0);
/// Pressure at its strongest.
const PUSH: f64 = 1.2;
/// Radius of the weak ring and of the strong one.
const RINGS: [f64; 2] = [22.0, 40.0];
/// The area that is asked for.
const TARGET: f64 = PI * 31.0 * 31.0;
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

/// Balloons.
pub(crate) const BALLOON: Experiment = Experiment {
    id: "sec-5-4-balloon",
    title: "A balloon",
    place: "§5.4",
    question: "A small circle starts far inside a ring that is all it should find; a weaker ring lies between. Pressure by every law: what is passed, \
               what stops it, and where does it fail?",
    claims: &[
        claim("without pressure the circle stays small: the edge is out of reach [report §5.4]")
            .when(&[below("no pressure: farthest node", 16.0)]),
        claim("a constant pressure passes the weak edge, and the strong one stops it [report §5.4]").when(&[
            above("constant: nearest node", RINGS[1] - 3.0),
            below("constant: farthest node", RINGS[1] + 1.0),
        ]),
        claim("one that fades once it has arrived leaves the curve where the edge alone holds it [report §5.4]")
            .when(&[
                less("fades with time: mean radius", 1.0, "constant: mean radius"),
                above("fades with time: mean radius", RINGS[1] - 3.0),
            ]),
        claim("a gas loses its pressure as it grows and stops at the weak edge already [p V = const]").when(&[
            below("gas: farthest node", RINGS[0] + 1.0),
            above("gas: nearest node", RINGS[0] - 3.0),
        ]),
        claim("an area target stops between the rings: beyond the weak edge, short of its area by what \
               tension asks [report §5.4]")
            .when(&[
                above("area target: area", PI * RINGS[0] * RINGS[0]),
                below("area target: area", TARGET),
            ]),
        claim("the sign can be found: from inside it inflates, from outside it deflates, to the same \
               outline [report §5.4]")
            .when(&[close(
                "sign found - from inside: mean radius",
                "sign found - from outside: mean radius",
                1.5,
            )]),
        claim("its weakness: it goes less than 8 px into a channel that is narrow and 20 px long [report §5.4]")
            .when(&[below("narrow channel: farthest node", 38.0)]),
    ],
    run,
    draw,
};

/// A picture by the place from its middle.
fn drawn(level: impl Fn(DVec2) -> f64) -> Grid {
    Grid::from_shape_fn((121, 121), |(y, x)| {
        level(DVec2::new(real(x), real(y)) - MIDDLE)
    })
}

/// The two rings, the weak and the strong.
fn rings() -> Grid {
    drawn(|q| {
        let ring = |radius: f64| (2.5 - (q.length() - radius).abs()).clamp(0.0, 1.0);
        5.0 * ring(RINGS[0]) + 100.0 * ring(RINGS[1])
    })
}

/// A disc with a channel out of it.
fn channel() -> Grid {
    drawn(|q| {
        let way_out = (5.5 - q.y.abs()).min(50.5 - q.x).min(q.x);
        100.0 * (30.5 - q.length()).max(way_out).clamp(0.0, 1.0)
    })
}

fn disc() -> Grid {
    drawn(|q| 100.0 * (RINGS[1] + 0.5 - q.length()).clamp(0.0, 1.0))
}

/// The picture, the pressure, the radius of the start and the tension of a case.
fn case(name: &str) -> Result<(&'static str, Option<Acting>, f64, f64)> {
    let constant = || Acting::new(Pressure::constant(PUSH));
    let judge = RegionForce::new(Arc::new(TwoRegions::new(&disc(), 1e-3)?));
    let found = || Acting::new(Pressure::automatic(PUSH, judge.clone()));
    let gas = Pressure::gas(PUSH, PI * 144.0);
    let target = Pressure::area(2.0 * PUSH, TARGET);
    let fades = Schedule::new(vec![(0.0, 1.0), (60.0, 1.0), (90.0, 0.0)])?;
    Ok(match name {
        "no pressure" => ("rings", None, 12.0, 2.0),
        "constant" => ("rings", Some(constant()), 12.0, 2.0),
        "fades with time" => ("rings", Some(constant().scheduled(fades)), 12.0, 2.0),
        "gas" => ("rings", Some(Acting::new(gas)), 12.0, 2.0),
        "area target" => ("rings", Some(Acting::new(target)), 12.0, 2.0),
        "sign found - from inside" => ("disc", Some(found()), 12.0, 2.0),
        "sign found - from outside" => ("disc", Some(found()), 54.0, 2.0),
        _ => (
            "channel",
            Some(Acting::new(Pressure::constant(2.0))),
            12.0,
            5.0,
        ),
    })
}

fn run() -> Result {
    let mut record = Record::default();
    for (name, grid) in [("rings", rings()), ("disc", disc()), ("channel", channel())] {
        record.keep_grid(name, grid);
    }
    let rule = EdgeForce {
        smoothing: Smoothing::Gaussian(1.5),
        gain: 4.0,
    };
    for name in CASES {
        let (picture, pressure, radius, tension) = case(name)?;
        let field = Arc::new(edge_force(record.grid(picture)?, &rule)?);
        let mut world = World::default().with(ImageForce::new(field, Sampling::Bilinear));
        if let Some(pressure) = pressure {
            world = world.with_acting(pressure);
        }
        let x = elastic::circle(MIDDLE, radius, 120);
        let mut body = Body::of(&x, Topology::Closed, 1.0)?
            .with_material(Material::uniform(0.0, tension, 0.0))
            .with_damping(3.0);
        // a membrane, which pulls together whatever its size
        body.rest = elastic::circle(DVec2::ZERO, 1e-6, 120);
        let mut snake = Snake::new(body, world)?;
        let mut state = State::at_rest(x);
        let until = match name {
            "fades with time" => Until::steps(3200),
            _ => Until::at_rest(Rest::default(), 4000),
        };
        let look = |state: &State| (state.t, elastic::signed_area(&state.x));
        let mut frames = vec![Frame::closed(0.0, state.x.clone())];
        let mut sizes = vec![look(&state)];
        moved(
            &mut snake,
            &mut state,
            (Scheme::Leapfrog, 0.05),
            &until,
            &mut |state| {
                if state.step.is_multiple_of(20) {
                    sizes.push(look(state));
                }
                if state.step.is_multiple_of(100) && frames.len() < 9 {
                    frames.push(Frame::closed(state.t, state.x.clone()));
                }
                // a leak ends at the border of the picture
                match state.x.iter().any(|p| p.distance(MIDDLE) > 58.0) {
                    true => ControlFlow::Break(()),
                    false => ControlFlow::Continue(()),
                }
            },
        )?;
        frames.push(Frame::closed(state.t, state.x.clone()));
        sizes.push(look(&state));
        let radii = || state.x.iter().map(|p| p.distance(MIDDLE));
        let mut own = record.under(name);
        own.note("nearest node [px]", least(radii()), 0.01);
        own.note("farthest node [px]", most(radii()), 0.01);
        own.note("mean radius [px]", mean(radii()), 0.01);
        own.note("area [px²]", look(&state).1, share(1e-3));
        record.keep_run(name, frames);
        record.keep(Table::raw(name).pairs("t", "area", &sizes));
    }
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let mut panels = Vec::new();
    for name in CASES {
        let grid = record.grid(case(name)?.0)?;
        // a weak ring should be seen too
        let shown = grid.mapv(|level| 40.0 + 9.0 * level.sqrt() + 0.5 * level);
        let frames = record.run(name)?;
        let last = frames.len() - 1;
        let ground = Picture::new(grey(&shown));
        let mut panel = Panel::pixels(name, 121, 121).bare().with(ground);
        for frame in 0..last {
            let color = Color::YELLOW.mix(Color::RED, real(frame) / real(last.max(1)));
            panel = panel.with(frames.ring(frame, color).weighing(0.5));
        }
        panels.push(panel.with(frames.ring(last, Color::SKY).weighing(1.6)));
    }
    let below = panels.split_off(4);
    let mut areas = plot("area enclosed", ("t", 0.0, 160.0), ("px²", 0.0, 7600.0));
    for (case, name, color) in [
        ("constant", "constant", Color::BLUE),
        ("fades with time", "fades from t = 60 to 90", Color::PURPLE),
        ("gas", "gas", Color::GREEN),
        ("area target", "area target", Color::ORANGE),
    ] {
        areas = areas.with(line(record.points(case, "t", "area")?, color).named(name));
    }
    for radius in RINGS {
        let area = PI * radius * radius;
        areas = areas.with(line([(0.0, area), (160.0, area)], Color::GREY).dashed());
    }
    Artefact::only(
        "Yellow to red: every hundred steps; blue: the end. The inner ring is a twentieth as bright as the outer one. Dashed: the areas inside the two rings.",
        Figure::new("§5.4  Balloons", 1000.0)
            .with(240.0, panels)
            .with(240.0, below)
            .with(230.0, vec![areas]),
    )
}
