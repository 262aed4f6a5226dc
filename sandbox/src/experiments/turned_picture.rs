//! Report §5.2: an ellipse turned by a picture that rotates.

use super::motion::{Frames, changed_scene, keep_frames, to_the_end};
use crate::demand::{judged, less, near};
use crate::draw::{Axis, Color, Corner, Figure, Layer, Line, Panel};
use crate::{Artefact, Claim, Experiment, Record, SandboxError, Table, Tolerance};
use glam::DVec2;

const ID: &str = "sec-5-2-picture";
const NAMES: [(&str, &str, &str, Color); 2] = [
    ("turning", "curve-turning", "over-turning", Color::GREEN),
    (
        "translating",
        "curve-translating",
        "over-translating",
        Color::RED,
    ),
];
/// How fast the picture turns.
const RATE: f64 = 0.01;

/// An oval in a picture that rotates.
pub(crate) const PICTURE: Experiment = Experiment {
    id: ID,
    title: "Turned by its picture",
    place: "§5.2",
    question: "A picture of an oval rotates once around; a snake with the oval's shape at rest sits on its border. What does the frame of the body \
               change, if the rest shape turns with it?",
    claims: &[
        Claim {
            says: "the turning frame follows with next to no deformation, the translating one does not",
            source: "report §5.2",
            judge: |r| {
                judged(
                    r,
                    &[less(
                        "turning: largest deformation",
                        0.1,
                        "translating: largest deformation",
                    )],
                )
            },
        },
        Claim {
            says: "so the outline stays right",
            source: "report §5.2",
            judge: |r| {
                judged(
                    r,
                    &[less(
                        "turning: largest distance from the border",
                        0.25,
                        "translating: largest distance from the border",
                    )],
                )
            },
        },
        Claim {
            says: "after a whole turn it has turned once",
            source: "report §5.2",
            judge: |r| judged(r, &[near("turning: angle behind the picture", 0.0, 0.2)]),
        },
    ],
    run,
    draw,
};

/// How far `p` is from the border of the oval at time `t`, by its gradient.
fn off(p: DVec2, t: f64) -> f64 {
    let q = DVec2::from_angle(-RATE * t).rotate(p - DVec2::splat(63.5));
    let scaled = q / DVec2::new(40.0, 24.0);
    let level = scaled.length();
    let slope = (scaled / DVec2::new(40.0, 24.0)).length() / level;
    (level - 1.0) / slope
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    for (name, curves, over, _) in NAMES {
        let frame = format!("frame = \"{name}\"");
        let mut scene = changed_scene(ID, "turned-oval", &[("frame = \"turning\"", &frame)])?;
        let done = to_the_end(ID, &mut scene)?;
        let (mut deformed, mut away) = (0.0_f64, 0.0_f64);
        let mut e = vec![DVec2::ZERO; scene.snake.body().len()];
        let (mut times, mut largest, mut distance) = (Vec::new(), Vec::new(), Vec::new());
        for frame in &done.frames {
            scene.snake.deformation_into(frame.nodes(), &mut e);
            let now = e.iter().map(|e| e.length()).fold(0.0, f64::max);
            let far = frame
                .nodes()
                .iter()
                .map(|&p| off(p, frame.t).abs())
                .fold(0.0, f64::max);
            times.push(frame.t);
            largest.push(now);
            distance.push(far);
            deformed = deformed.max(now);
            away = away.max(far);
        }
        let close = Tolerance::Relative(1e-3);
        record.note(
            format!("{name}: largest deformation"),
            deformed,
            "px",
            close,
        );
        record.note(
            format!("{name}: largest distance from the border"),
            away,
            "px",
            close,
        );
        if let Some(last) = done.frames.last() {
            let behind = RATE * last.t - scene.snake.angle(last.nodes());
            let behind = behind - std::f64::consts::TAU * (behind / std::f64::consts::TAU).round();
            record.note(
                format!("{name}: angle behind the picture"),
                behind,
                "rad",
                Tolerance::Absolute(1e-3),
            );
        }
        record.keep(
            Table::raw(over)
                .with("t", "s", Tolerance::EXACT, times)
                .with("deformation", "px", Tolerance::EXACT, largest)
                .with("distance", "px", Tolerance::EXACT, distance),
        );
        keep_frames(&mut record, curves, &done);
    }
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let mut figure = Figure::new("§5.2  An oval turned by a picture that rotates", 1000.0);
    for (name, curves, _, color) in NAMES {
        let frames = Frames::of(record, curves)?;
        let mut row = Vec::new();
        for eighth in [0.0, 1.0, 2.0, 3.0] {
            let t = eighth * std::f64::consts::FRAC_PI_4 / RATE;
            let frame = frames.nearest(t);
            let t = frames.t(frame);
            let border =
                elastic::ellipse(DVec2::splat(63.5), DVec2::new(40.0, 24.0), RATE * t, 120);
            let border = border.iter().map(|p| (p.x, p.y)).collect();
            row.push(
                Panel::pixels(format!("{name}, t = {t:.0}"), 128, 128)
                    .with(Line::new(border, Color::GREY).closed().weighing(2.5))
                    .with(frames.ring(frame, color).weighing(1.0))
                    .with(Layer::Dots {
                        points: frames.curve(frame)[..1].to_vec(),
                        radius: 3.0,
                        color: Color::INK,
                        label: String::new(),
                    })
                    .bare(),
            );
        }
        figure = figure.with(235.0, row);
    }
    let end = 630.0;
    let mut panels = Vec::new();
    for (column, title) in [
        ("deformation", "largest deformation / px"),
        ("distance", "largest distance from the border / px"),
    ] {
        let most = NAMES
            .iter()
            .map(|(_, _, table, _)| record.column(table, column));
        let most = most.collect::<Result<Vec<_>, _>>()?.concat();
        let top = 1.4 * most.into_iter().fold(0.0, f64::max);
        let mut panel = Panel::new(title, Axis::new("t", 0.0, end), Axis::new("px", 0.0, top))
            .legend_at(Corner::TopRight);
        for (name, _, table, color) in NAMES {
            panel = panel.with(Line::new(record.points(table, "t", column)?, color).named(name));
        }
        panels.push(panel);
    }
    Ok(vec![Artefact::figure(
        "Grey: the border of the oval in the picture as it rotates; the dot is the first node. Above, the rest shape turns with the body; below it keeps its direction and pulls the curve off the border.",
        figure.with(250.0, panels),
    )])
}
