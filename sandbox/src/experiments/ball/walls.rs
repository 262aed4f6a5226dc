//! What the wall does (D66, D67): three laws for the same ball, and friction with a floor.

use super::course::{self, STEPS};
use crate::prelude::*;

/// Scene and name of each law.
const LAWS: [(&str, &str); 3] = [
    ("rigid-ball", "clamp"),
    ("rigid-ball-penalty", "penalty"),
    ("rigid-ball-impact", "impact"),
];

/// Three wall laws, one ball.
pub(crate) const WALLS: Experiment = Experiment {
    id: "sec-2-5-walls",
    title: "Three walls",
    place: "§2.5",
    question: "The report does not give its wall's law (D66). How much of the rigid ball's story depends on it?",
    claims: &[
        claim(
            "every wall throws the ball back, also one that takes all normal momentum [errata §6]",
        )
        .when(&[more(
            "*: speed away from it",
            0.7,
            "*: speed towards the wall",
        )]),
        claim("only the penalty wall is entered [errata §6]").when(&[
            at_most("clamp: depth", 0.0),
            at_most("impact: depth", 0.0),
            above("penalty: depth", 0.01),
        ]),
        claim(
            "the way and the ringing are nearly the same: the story does not hang on the law [D66]",
        )
        .when(&[
            close(
                "penalty: center at the end: x",
                "clamp: center at the end: x",
                0.3,
            ),
            close(
                "impact: center at the end: x",
                "clamp: center at the end: x",
                0.6,
            ),
            close(
                "penalty: ringing: measured",
                "clamp: ringing: measured",
                0.02,
            ),
            close(
                "impact: ringing: measured",
                "clamp: ringing: measured",
                0.02,
            ),
        ]),
    ],
    run: run_walls,
    draw: draw_walls,
};

fn run_walls() -> Result {
    let mut record = Record::default();
    let mut fine = Table::raw("fine");
    for (scene, law) in LAWS {
        let (course, run) = course::follow(scene, &[])?;
        course::sum_up(&mut record, &format!("{law}: "), &course);
        let deepest = least(course.least_x.iter().copied());
        let mut own = record.under(law);
        own.note("depth", (-deepest).max(0.0), STEPS);
        record.keep_run(law, &run);
        let rows = || (0..course.t.len()).step_by(10);
        if fine.columns.is_empty() {
            fine = fine.exact("t [s]", rows().map(|i| course.t[i]));
        }
        fine = fine
            .exact(format!("center {law}"), rows().map(|i| course.center[i].x))
            .exact(format!("least x {law}"), rows().map(|i| course.least_x[i]))
            .exact(format!("deformation {law}"), rows().map(|i| course.rms[i]));
    }
    record.keep(fine);
    Ok(record)
}

fn draw_walls(record: &Record) -> Drawn {
    let time = ("t / s", 0.0, 7.0);
    let clamp = record.column("fine", "center clamp")?;
    let title = "way of the center, difference from the clamp's";
    let mut way = plot(title, time, ("x", -0.05, 0.08));
    let mut near = plot(
        "the node furthest left",
        ("t / s", 1.6, 2.7),
        ("least x", -0.06, 0.16),
    );
    let mut shape = plot("deformation", time, ("rms of e", 0.0, 0.26));
    let mut energy = plot("sum of all energies", time, ("energy", 0.0, 1.0));
    let mut totals = Vec::new();
    for ((_, law), color) in LAWS.into_iter().zip(Color::SERIES) {
        let over_time = |what: &str| record.points("fine", "t", &format!("{what} {law}"));
        let own = |points: Vec<(f64, f64)>| line(points, color).weighing(0.8).named(law);
        let apart = over_time("center")?.into_iter().zip(clamp);
        way = way.with(own(apart.map(|((t, x), c)| (t, x - c)).collect()));
        near = near.with(own(over_time("least x")?));
        shape = shape.with(own(over_time("deformation")?));
        let total = record.run(law)?.energy("total")?;
        totals.extend(total.iter().map(|p| p.1));
        energy = energy.with(own(total));
    }
    (energy.y.from, energy.y.to) = range(totals, 0.05);
    Artefact::only(
        "Clamp: a node that passed is set back (the report's program). Penalty: a stiff damped spring. Impact: the \
         normal velocity turns round, times a restitution of 0.5.",
        Figure::new("§2.5  The rigid ball and three wall laws", 900.0)
            .with(260.0, vec![way, near.legend_at(Corner::TopLeft)])
            .with(260.0, vec![shape, energy]),
    )
}

/// D67: spreading needs something that couples x and y.
pub(crate) const FRICTION: Experiment = Experiment {
    id: "sec-2-5-friction",
    title: "A rough wall and a floor",
    place: "§2.5",
    question: "The very soft ball of Figure 2.2 slides down the wall without ever changing its height. What does it \
               take to deform it in y?",
    claims: &[
        claim("on a smooth wall, without a floor, y is never deformed [D67]")
            .when(&[below("smooth: largest deformation in y", 1e-7)]),
        claim("a rough wall deforms the ball along it, and spreads it [D67]").when(&[
            above("rough: largest deformation in y", 0.2),
            above("rough: height at the end", 2.1),
        ]),
        claim("with a floor the sheet piles up on it [D67]").when(&[
            near("smooth: height at the end", 2.0, 1e-6),
            below("rough with a floor: height at the end", 1.5),
        ]),
    ],
    run: run_friction,
    draw: draw_friction,
};

const FLOOR: &str = "[[world.wall]]\npoint = [0.0, 4.0]\nnormal = [0.0, 1.0]\nlaw = { impact = { restitution = 0.2, friction = 0.3 } }\n";

/// What is tried: the scene, and what is left out of it.
const TRIED: [(&str, &str, Changes); 3] = [
    ("smooth", "very-soft-ball", &[]),
    ("rough", "very-soft-ball-friction", &[(FLOOR, "")]),
    ("rough with a floor", "very-soft-ball-friction", &[]),
];

/// How high a ball is from its lowest node to its highest.
fn height(nodes: &[DVec2]) -> f64 {
    let (low, high) = range(nodes.iter().map(|p| p.y), 0.0);
    high - low
}

fn run_friction() -> Result {
    let mut record = Record::default();
    let mut heights = Table::raw("height");
    for (name, scene, changes) in TRIED {
        let (course, run) = course::follow(scene, changes)?;
        course::sum_up(&mut record, &format!("{name}: "), &course);
        let mut own = record.under(name);
        own.note("height at the end", height(last(&run)), STEPS);
        if heights.columns.is_empty() {
            heights = heights.exact("t [s]", run.frames.iter().map(|frame| frame.t));
        }
        heights = heights.exact(name, run.frames.iter().map(|frame| height(frame.nodes())));
        record.keep_run(name, &run);
    }
    record.keep(heights);
    Ok(record)
}

fn draw_friction(record: &Record) -> Drawn {
    let mut panels = Vec::new();
    let titles = ["smooth wall", "rough wall", "rough wall and a floor"];
    let mut heights = plot(
        "height of the ball",
        ("t / s", 0.0, 7.0),
        ("largest y less least y", 0.0, 6.0),
    )
    .legend_at(Corner::TopLeft);
    heights.share = 1.6;
    for (((name, ..), title), color) in TRIED.into_iter().zip(titles).zip(Color::SERIES) {
        let frames = record.run(name)?;
        let mut panel = plot(title, ("x", -0.2, 3.2), ("y", 0.3, 8.6)).equal();
        panel = panel.with(wall((0.0, 0.3), (0.0, 8.6)));
        if name == "rough with a floor" {
            panel = panel.with(wall((0.0, 4.0), (3.2, 4.0)));
        }
        let mut chosen = frames.each(0.4);
        chosen.retain(|&i| frames.t(i) > 1.5);
        panels.push(snapshots(panel, frames, &chosen, 0.7));
        heights = heights.with(line(record.points("height", "t", name)?, color).named(name));
    }
    panels.push(heights);
    Artefact::only(
        "The very soft ball from 1.6 s on, a snapshot every 0.4 s, from blue to orange; right: its height.",
        Figure::new("§2.5  Spreading needs friction or a floor", 1000.0).with(420.0, panels),
    )
}
