//! Report chapter 1 and §5.2: a snake with mass in the force of drawn frames, of which some are empty.

use std::ops::ControlFlow::Continue;
use std::sync::Arc;

use field::{EdgeForce, Smoothing, drawn};
use snake::{Edit, ImageForce, Sampling, Until, World};

use crate::prelude::*;

/// What is changed in a scene.
type Changed = &'static [(&'static str, &'static str)];

/// Name, color, and what is changed in the scene of the turned oval.
const BODIES: [(&str, &str, Color, Changed); 3] = [
    ("turning", "of-turning", Color::GREEN, &[]),
    (
        "translating",
        "of-translating",
        Color::RED,
        &[("frame = \"turning\"", "frame = \"translating\"")],
    ),
    (
        "no inertia",
        "of-no-inertia",
        Color::BLUE,
        &[("mass = 1.0", "mass = 0.02"), ("dt = 0.1", "dt = 0.02")],
    ),
];

/// Frames, those of them that are empty, and how long each lasts.
const FRAMES: usize = 60;
const EMPTY: std::ops::Range<usize> = 36..40;
const LASTS: f64 = 1.0;

/// The oval's drift in a frame, its turn, and how much its axes breathe.
const DRIFT: DVec2 = DVec2::new(1.2, 0.4);
const TURN: f64 = 0.05;
const BREATH: f64 = 0.1;

/// Sizes of the frames, and the smoothing of the edge force.
const SIZE: (usize, usize) = (150, 210);
const SIGMA: f64 = 4.0;

/// An oval that drifts, turns and breathes.
pub(crate) const FRAMES_DRAWN: Experiment = Experiment {
    id: "sec-5-2-frames",
    title: "Through drawn frames",
    place: "chapter 1, §5.2",
    question: "An oval drifts, turns and breathes through 60 drawn frames, of which four in the middle are empty. A snake with its shape at rest lies in the \
               edge force of each frame for a while. What do the frame of the body and its mass give?",
    claims: &[
        claim("the rotation is indispensable: with a frame that only translates the outline is pulled off [report §5.2]").when(&[
            less("turning: mean distance", 0.6, "translating: mean distance"),
            below("turning: mean distance", 1.5),
        ]),
        claim("the turning frame follows the turn: its angle behind the oval in the last frame").when(&[near(
            "turning: angle behind the oval",
            0.0,
            0.1,
        )]),
        claim("through empty frames only a body with mass flies on [report chapter 1]").when(&[
            less("turning: way behind in the last empty frame", 0.6, "no inertia: way behind in the last empty frame"),
        ]),
    ],
    run,
    draw,
};

/// The oval's middle, half axes and angle in a frame.
fn oval(frame: f64) -> (DVec2, DVec2, f64) {
    let breath = BREATH * (0.2 * frame).sin();
    (
        DVec2::splat(63.5) + frame * DRIFT,
        DVec2::new(40.0 * (1.0 + breath), 24.0 * (1.0 - breath)),
        TURN * frame,
    )
}

fn picture(frame: usize) -> field::Grid {
    let (middle, axes, angle) = oval(real(frame));
    let inside = |p: DVec2| {
        let q = DVec2::from_angle(-angle).rotate(p - middle) / axes;
        q.length_squared() <= 1.0 && !EMPTY.contains(&frame)
    };
    drawn::covered(SIZE, inside, (200.0, 60.0))
}

/// The edge force of a frame.
fn world(frame: usize) -> Result<World> {
    let usual = EdgeForce::as_strong_as_the_report().gain;
    let rule = EdgeForce {
        smoothing: Smoothing::Gaussian(SIGMA),
        gain: 1.5 * usual * SIGMA * SIGMA / 10.0,
    };
    let field = field::edge_force(&picture(frame), &rule)?;
    Ok(World::default().with(ImageForce::new(Arc::new(field), Sampling::Bilinear)))
}

/// How far a point is from the oval, by its gradient.
fn off(p: DVec2, frame: f64) -> f64 {
    let (middle, axes, angle) = oval(frame);
    let q = DVec2::from_angle(-angle).rotate(p - middle);
    let level = (q / axes).length();
    let slope = (q / axes / axes).length() / level;
    (level - 1.0) / slope
}

fn run() -> Result {
    let mut record = Record::default();
    for (name, table, _, changes) in BODIES {
        let mut all: Vec<(&str, &str)> = vec![("damping = 0.3", "damping = 0.02")];
        all.extend(changes);
        let scene = scene_with("turned-oval", &all)?;
        let mut simulation = scene.simulation()?;
        let id = simulation.members()[0].id();
        let dt = if all.iter().any(|(from, _)| *from == "dt = 0.1") {
            0.02
        } else {
            0.1
        };
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "some hundred steps"
        )]
        let steps = (LASTS / dt).round() as u64;
        let (mut away, mut behind) = (Vec::new(), Vec::new());
        for frame in 0..FRAMES {
            simulation.edit(id, Edit::World(world(frame)?))?;
            simulation.run(&Until::steps(steps), &mut |_| Continue(()))?;
            let nodes = &simulation.members()[0].state().x;
            away.push(mean(nodes.iter().map(|p| off(*p, real(frame)).abs())));
            behind.push(
                elastic::centroid(nodes)
                    .unwrap_or_default()
                    .distance(oval(real(frame)).0),
            );
            if [12, 35, 39, 59].contains(&frame) {
                record.keep(Table::raw(shot(name, frame)).xy("px", EXACT, nodes));
            }
        }
        let seen = |frame: &usize| *frame > 4 && !EMPTY.contains(frame);
        let mut own = record.under(name);
        own.note(
            "mean distance [px]",
            mean((0..FRAMES).filter(seen).map(|frame| away[frame])),
            share(1e-3),
        );
        own.note(
            "way behind in the last empty frame [px]",
            behind[EMPTY.end - 1],
            share(1e-3),
        );
        if name == "turning" {
            let member = &simulation.members()[0];
            let angle = member.snake().angle(&member.state().x);
            let whole = std::f64::consts::TAU;
            let left = oval(real(FRAMES - 1)).2 - angle;
            own.note(
                "angle behind the oval [rad]",
                left - whole * (left / whole).round(),
                1e-3,
            );
        }
        record.keep(
            Table::raw(table)
                .exact("frame", (0..FRAMES).map(real))
                .exact("distance [px]", away)
                .exact("behind [px]", behind),
        );
    }
    Ok(record)
}

/// The name of an outline in a frame.
fn shot(name: &str, frame: usize) -> &'static str {
    let column = usize::from(frame > 12) + usize::from(frame > 35) + usize::from(frame > 39);
    let row = BODIES.iter().position(|body| body.0 == name).unwrap_or(0);
    [
        ["turning 12", "turning 35", "turning 39", "turning 59"],
        [
            "translating 12",
            "translating 35",
            "translating 39",
            "translating 59",
        ],
        ["still 12", "still 35", "still 39", "still 59"],
    ][row][column]
}

fn draw(record: &Record) -> Drawn {
    let mut figure = Figure::new("§5.2  Through drawn frames, four of them empty", 1000.0);
    for (name, _, color, _) in BODIES {
        let mut row = Vec::new();
        for frame in [12, 35, 39, 59] {
            let (middle, axes, angle) = oval(real(frame));
            let border = elastic::ellipse(middle, axes, angle, 120);
            let empty = if EMPTY.contains(&frame) {
                ", empty"
            } else {
                ""
            };
            row.push(
                Panel::pixels(format!("{name}, frame {frame}{empty}"), SIZE.1, SIZE.0)
                    .with(line(pairs(&border), Color::GREY).closed().weighing(2.5))
                    .with(line(record.xy(shot(name, frame))?, color).closed())
                    .bare(),
            );
        }
        figure = figure.with(190.0, row);
    }
    let mut panels = Vec::new();
    for (column, title) in [
        ("distance", "mean distance from the oval / px"),
        ("behind", "middle behind that of the oval / px"),
    ] {
        let mut panel = plot(title, ("frame", 0.0, 60.0), ("px", 0.0, 0.0));
        for (name, table, color, _) in BODIES {
            let points = record.points(table, "frame", column)?;
            panel.y.to = points
                .iter()
                .fold(panel.y.to, |most, p| most.max(1.2 * p.1));
            panel = panel.with(line(points, color).named(name));
        }
        panels.push(panel);
    }
    Artefact::only(
        "Grey: the oval of each frame, also where the frame is empty. A frame that only translates keeps its rest shape's direction; without inertia the curve \
         stays where the last frame left it.",
        figure.with(230.0, panels),
    )
}
