//! What the wall does (D66, D67): three laws for the same ball, and friction with a floor.

use super::course::{self, STEPS};
use super::draw;
use crate::demand::{above, judged};
use crate::draw::{Axis, Color, Corner, Figure, Line, Panel};
use crate::experiments::motion::{Frames, changed_scene, keep_energies, keep_frames, range};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance};

/// Scene and name of each law.
const LAWS: [(&str, &str, &str); 3] = [
    ("rigid-ball", "clamp", "energy-clamp"),
    ("rigid-ball-penalty", "penalty", "energy-penalty"),
    ("rigid-ball-impact", "impact", "energy-impact"),
];

/// Three wall laws, one ball.
pub(crate) const WALLS: Experiment = Experiment {
    id: "sec-2-5-walls",
    title: "Three walls",
    place: "§2.5",
    question: "The report does not give its wall's law (D66). How much of the rigid ball's story depends on it?",
    claims: &[
        Claim {
            says: "every wall throws the ball back, also one that takes all normal momentum of a touching node",
            source: "errata §6",
            judge: |r| {
                let kept = [kept(r, "clamp")?, kept(r, "penalty")?, kept(r, "impact")?];
                Ok(Finding::new(
                    kept.iter().all(|k| *k > 0.7),
                    format!(
                        "of its speed the ball keeps {:.3} (clamp), {:.3} (penalty), {:.3} (impact)",
                        kept[0], kept[1], kept[2]
                    ),
                ))
            },
        },
        Claim {
            says: "only the penalty wall is entered",
            source: "errata §6",
            judge: |r| {
                let depth = |law: &str| r.number(&format!("{law}: depth"));
                let (clamp, penalty, impact) =
                    (depth("clamp")?, depth("penalty")?, depth("impact")?);
                Ok(Finding::new(
                    clamp <= 0.0 && impact <= 0.0 && penalty > 0.01,
                    format!("{penalty:.3} deep, {clamp} and {impact} for the others"),
                ))
            },
        },
        Claim {
            says: "the way and the ringing are nearly the same: the story does not hang on the law",
            source: "D66",
            judge: |r| {
                let end = |law: &str| r.number(&format!("{law}: center at the end: x"));
                let (a, b, c) = (end("clamp")?, end("penalty")?, end("impact")?);
                let ring = |law: &str| r.number(&format!("{law}: ringing: measured"));
                let (f, g, h) = (ring("clamp")?, ring("penalty")?, ring("impact")?);
                Ok(Finding::new(
                    (a - b).abs() < 0.3
                        && (a - c).abs() < 0.6
                        && (f - g).abs() < 0.02
                        && (f - h).abs() < 0.02,
                    format!(
                        "at the end at x = {a:.2}, {b:.2}, {c:.2}; ringing at {f:.3}, {g:.3}, {h:.3} rad/s"
                    ),
                ))
            },
        },
    ],
    run: || {
        let id = "sec-2-5-walls";
        let mut record = Record::default();
        let mut fine = Table::raw("fine");
        for (scene, law, energy) in LAWS {
            let (course, run) = course::follow(id, &mut changed_scene(id, scene, &[])?)?;
            course::sum_up(&mut record, &format!("{law}: "), &course);
            let least = course.least_x.iter().fold(0.0_f64, |a, &b| a.min(b));
            record.note(format!("{law}: depth"), (-least).max(0.0), "", STEPS);
            keep_energies(&mut record, energy, &run);
            let rows: Vec<usize> = (0..course.t.len()).step_by(10).collect();
            let pick = |values: &[f64]| rows.iter().map(|&i| values[i]).collect();
            if fine.columns.is_empty() {
                fine = fine.with("t", "s", Tolerance::ROUNDING, pick(&course.t));
            }
            let x: Vec<f64> = course.center.iter().map(|c| c.x).collect();
            fine = fine
                .with(format!("center {law}"), "", STEPS, pick(&x))
                .with(format!("least x {law}"), "", STEPS, pick(&course.least_x))
                .with(format!("deformation {law}"), "", STEPS, pick(&course.rms));
        }
        record.keep(fine);
        Ok(record)
    },
    draw: draw_walls,
};

fn kept(r: &Record, law: &str) -> Result<f64, SandboxError> {
    let towards = r.number(&format!("{law}: speed towards the wall"))?;
    Ok(r.number(&format!("{law}: speed away from it"))? / towards)
}

fn draw_walls(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let time = |from: f64, to: f64| Axis::new("t / s", from, to);
    let mut way = Panel::new(
        "way of the center, difference from the clamp's",
        time(0.0, 7.0),
        Axis::new("x", -0.05, 0.08),
    );
    let clamp = record.column("fine", "center clamp")?;
    let mut near = Panel::new(
        "the node furthest left",
        time(1.6, 2.7),
        Axis::new("least x", -0.06, 0.16),
    );
    let mut shape = Panel::new(
        "deformation",
        time(0.0, 7.0),
        Axis::new("rms of e", 0.0, 0.26),
    );
    let mut energy = Panel::new(
        "sum of all energies",
        time(0.0, 7.0),
        Axis::new("energy", 0.0, 1.0),
    );
    let mut totals = Vec::new();
    for ((_, law, table), color) in LAWS.into_iter().zip(Color::SERIES) {
        let line = |what: &str| record.points("fine", "t", &format!("{what} {law}"));
        let apart = line("center")?
            .into_iter()
            .zip(clamp)
            .map(|((t, x), c)| (t, x - c))
            .collect();
        way = way.with(Line::new(apart, color).weighing(0.8).named(law));
        near = near.with(Line::new(line("least x")?, color).weighing(0.8).named(law));
        shape = shape.with(
            Line::new(line("deformation")?, color)
                .weighing(0.8)
                .named(law),
        );
        let total = record.points(table, "t", "total")?;
        totals.extend(total.iter().map(|p| p.1));
        energy = energy.with(Line::new(total, color).weighing(0.8).named(law));
    }
    (energy.y.from, energy.y.to) = range(totals, 0.05);
    let figure = Figure::new("§2.5  The rigid ball and three wall laws", 900.0)
        .with(260.0, vec![way, near.legend_at(Corner::TopLeft)])
        .with(260.0, vec![shape, energy]);
    Ok(vec![Artefact::figure(
        "Clamp: a node that passed is set back (the report's program). Penalty: a stiff damped spring. Impact: the \
         normal velocity turns round, times a restitution of 0.5.",
        figure,
    )])
}

/// D67: spreading needs something that couples x and y.
pub(crate) const FRICTION: Experiment = Experiment {
    id: "sec-2-5-friction",
    title: "A rough wall and a floor",
    place: "§2.5",
    question: "The very soft ball of Figure 2.2 slides down the wall without ever changing its height. What does it \
               take to deform it in y?",
    claims: &[
        Claim {
            says: "on a smooth wall, without a floor, y is never deformed",
            source: "D67",
            judge: |r| {
                let across = r.number("smooth: largest deformation in y")?;
                Ok(Finding::new(across < 1e-7, format!("at most {across:.1e}")))
            },
        },
        Claim {
            says: "a rough wall deforms the ball along it, and spreads it",
            source: "D67",
            judge: |r| {
                judged(
                    r,
                    &[
                        above("rough: largest deformation in y", 0.2),
                        above("rough: height at the end", 2.1),
                    ],
                )
            },
        },
        Claim {
            says: "with a floor the sheet piles up on it",
            source: "D67",
            judge: |r| {
                let (height, smooth) = (
                    r.number("rough with a floor: height at the end")?,
                    r.number("smooth: height at the end")?,
                );
                Ok(Finding::new(
                    (smooth - 2.0).abs() < 1e-6 && height < 1.5,
                    format!("{height:.2} high at the end, {smooth:.2} without"),
                ))
            },
        },
    ],
    run: run_friction,
    draw: draw_friction,
};

const FLOOR: &str = "[[world.wall]]\npoint = [0.0, 4.0]\nnormal = [0.0, 1.0]\nlaw = { impact = { restitution = 0.2, friction = 0.3 } }\n";

/// Name, scene, changes, table of frames.
type Case = (
    &'static str,
    &'static str,
    &'static [(&'static str, &'static str)],
    &'static str,
);

fn run_friction() -> Result<Record, SandboxError> {
    let id = "sec-2-5-friction";
    let mut record = Record::default();
    let rough = "very-soft-ball-friction";
    let mut heights = Table::raw("height");
    let cases: [Case; 3] = [
        ("smooth", "very-soft-ball", &[], "curves-smooth"),
        ("rough", rough, &[(FLOOR, "")], "curves-rough"),
        ("rough with a floor", rough, &[], "curves-floor"),
    ];
    for (name, scene, changes, table) in cases {
        let (course, run) = course::follow(id, &mut changed_scene(id, scene, changes)?)?;
        course::sum_up(&mut record, &format!("{name}: "), &course);
        let end = run
            .last()
            .map(|frame| frame.nodes().to_vec())
            .unwrap_or_default();
        let (low, high) = range(end.iter().map(|p| p.y), 0.0);
        record.note(format!("{name}: height at the end"), high - low, "", STEPS);
        keep_frames(&mut record, table, &run);
        let tall = |frame: &scene::Frame| {
            let (low, high) = range(frame.nodes().iter().map(|p| p.y), 0.0);
            high - low
        };
        if heights.columns.is_empty() {
            let times = run.frames.iter().map(|frame| frame.t).collect();
            heights = heights.with("t", "s", Tolerance::ROUNDING, times);
        }
        heights = heights.with(name, "", STEPS, run.frames.iter().map(tall).collect());
    }
    record.keep(heights);
    Ok(record)
}

fn draw_friction(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let mut panels = Vec::new();
    for (title, table, floor) in [
        ("smooth wall", "curves-smooth", false),
        ("rough wall", "curves-rough", false),
        ("rough wall and a floor", "curves-floor", true),
    ] {
        let frames = Frames::of(record, table)?;
        let mut panel = Panel::new(title, Axis::new("x", -0.2, 3.2), Axis::new("y", 0.3, 8.6))
            .equal()
            .with(Line::new(vec![(0.0, 0.3), (0.0, 8.6)], Color::INK).weighing(1.4));
        if floor {
            panel = panel.with(Line::new(vec![(0.0, 4.0), (3.2, 4.0)], Color::INK).weighing(1.4));
        }
        let chosen: Vec<usize> = frames
            .each(0.4)
            .into_iter()
            .filter(|&i| frames.t(i) > 1.5)
            .collect();
        panels.push(draw::snapshots(panel, &frames, &chosen, 0.7));
    }
    let mut height = Panel::new(
        "height of the ball",
        Axis::new("t / s", 0.0, 7.0),
        Axis::new("largest y less least y", 0.0, 6.0),
    )
    .legend_at(Corner::TopLeft);
    for (name, color) in ["smooth", "rough", "rough with a floor"]
        .into_iter()
        .zip(Color::SERIES)
    {
        height = height.with(Line::new(record.points("height", "t", name)?, color).named(name));
    }
    height.share = 1.6;
    panels.push(height);
    let figure =
        Figure::new("§2.5  Spreading needs friction or a floor", 1000.0).with(420.0, panels);
    Ok(vec![Artefact::figure(
        "The very soft ball from 1.6 s on, a snapshot every 0.4 s, from blue to orange; right: its height.",
        figure,
    )])
}
