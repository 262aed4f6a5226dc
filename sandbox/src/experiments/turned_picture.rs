//! Report §5.2: an ellipse turned by a picture that rotates.

use crate::prelude::*;
use std::f64::consts::TAU;

const NAMES: [(&str, &str, Color); 2] = [
    ("turning", "over-turning", Color::GREEN),
    ("translating", "over-translating", Color::RED),
];
/// How fast the picture turns.
const RATE: f64 = 0.01;

/// An oval in a picture that rotates.
pub(crate) const PICTURE: Experiment = Experiment {
    id: "sec-5-2-picture",
    title: "Turned by its picture",
    place: "§5.2",
    question: "A picture of an oval rotates once around; a snake with the oval's shape at rest sits on its border. What does the frame of the body \
               change, if the rest shape turns with it?",
    claims: &[
        claim(
            "the turning frame follows with next to no deformation, the translating one does not \
               [report §5.2]",
        )
        .when(&[less(
            "turning: largest deformation",
            0.1,
            "translating: largest deformation",
        )]),
        claim("so the outline stays right [report §5.2]").when(&[less(
            "turning: largest distance from the border",
            0.25,
            "translating: largest distance from the border",
        )]),
        claim("after a whole turn it has turned once [report §5.2]").when(&[near(
            "turning: angle behind the picture",
            0.0,
            0.2,
        )]),
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

fn run() -> Result {
    let mut record = Record::default();
    for (name, table, _) in NAMES {
        let frame = format!("frame = \"{name}\"");
        let (scene, run) = ran("turned-oval", &[("frame = \"turning\"", &frame)])?;
        let mut e = vec![DVec2::ZERO; scene.snake.body().len()];
        let deformed = run.frames.iter().map(|frame| {
            scene.snake.deformation_into(frame.nodes(), &mut e);
            most(e.iter().map(|e| e.length()))
        });
        let deformed: Vec<f64> = deformed.collect();
        let far = |frame: &scene::Frame| most(frame.nodes().iter().map(|&p| off(p, frame.t).abs()));
        let away: Vec<f64> = run.frames.iter().map(far).collect();
        let largest = most(deformed.iter().copied());
        let mut own = record.under(name);
        own.note("largest deformation [px]", largest, share(1e-3));
        let largest = most(away.iter().copied());
        own.note(
            "largest distance from the border [px]",
            largest,
            share(1e-3),
        );
        if let Some(last) = run.frames.last() {
            let behind = RATE * last.t - scene.snake.angle(last.nodes());
            let behind = behind - TAU * (behind / TAU).round();
            own.note("angle behind the picture [rad]", behind, 1e-3);
        }
        record.keep(
            Table::raw(table)
                .exact("t [s]", run.frames.iter().map(|frame| frame.t))
                .exact("deformation [px]", deformed)
                .exact("distance [px]", away),
        );
        record.keep_run(name, &run);
    }
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let mut figure = Figure::new("§5.2  An oval turned by a picture that rotates", 1000.0);
    for (name, _, color) in NAMES {
        let frames = record.run(name)?;
        let row = [0.0, 1.0, 2.0, 3.0].map(|eighth| {
            let frame = frames.nearest(eighth * std::f64::consts::FRAC_PI_4 / RATE);
            let t = frames.t(frame);
            let (middle, axes) = (DVec2::splat(63.5), DVec2::new(40.0, 24.0));
            let border = elastic::ellipse(middle, axes, RATE * t, 120);
            Panel::pixels(format!("{name}, t = {t:.0}"), 128, 128)
                .with(line(pairs(&border), Color::GREY).closed().weighing(2.5))
                .with(frames.ring(frame, color))
                .with(dots([frames.pairs(frame)[0]], 3.0, Color::INK))
                .bare()
        });
        figure = figure.with(235.0, row.to_vec());
    }
    let mut panels = Vec::new();
    for (column, title) in [
        ("deformation", "largest deformation / px"),
        ("distance", "largest distance from the border / px"),
    ] {
        let mut panel = plot(title, ("t", 0.0, 630.0), ("px", 0.0, 0.0));
        for (name, table, color) in NAMES {
            let points = record.points(table, "t", column)?;
            panel.y.to = points
                .iter()
                .fold(panel.y.to, |most, p| most.max(1.4 * p.1));
            panel = panel.with(line(points, color).named(name));
        }
        panels.push(panel);
    }
    Artefact::only(
        "Grey: the border of the oval in the picture as it rotates; the dot is the first node. Above, the rest shape turns with the body; below it keeps its direction and pulls the curve off the border.",
        figure.with(250.0, panels),
    )
}
