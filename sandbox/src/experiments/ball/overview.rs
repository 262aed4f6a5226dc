//! The five balls of §2.5 beside each other.

use super::course::{self, STEPS};
use super::draw;
use crate::draw::{Axis, Color, Figure, Line, Panel};
use crate::experiments::motion::{Frames, changed_scene, keep_frames};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance};

const ID: &str = "sec-2-5-balls";
/// Scene, short name and figure of each ball.
const BALLS: [(&str, &str, &str); 5] = [
    ("very-soft-ball", "very soft", "2.2"),
    ("soft-ball", "soft", "2.3"),
    ("rigid-ball", "rigid", "2.4"),
    ("hard-ball", "hard", "2.5"),
    ("very-hard-ball", "very hard", "2.6"),
];
/// Table of each ball's frames.
const CURVES: [&str; 5] = ["curves-1", "curves-2", "curves-3", "curves-4", "curves-5"];

/// Five balls, one row.
pub(crate) const OVERVIEW: Experiment = Experiment {
    id: ID,
    title: "Five balls",
    place: "§2.5",
    question: "From very soft to very hard: how far is each ball squeezed, how long does it stay, how fast does it \
               leave, and when is it in shape again?",
    claims: &[
        Claim {
            says: "the harder the ball, the less its area falls",
            source: "report §2.5",
            judge: |r| falling_or_rising(r, "least area", 1.0),
        },
        Claim {
            says: "the harder the ball, the shorter it stays at the wall",
            source: "errata §6",
            judge: |r| {
                let last = r.column("balls", "last contact")?;
                let first = r.column("balls", "first contact")?;
                let stays: Vec<f64> = last.iter().zip(first).map(|(l, f)| l - f).collect();
                Ok(Finding::new(
                    stays.windows(2).all(|pair| pair[1] < pair[0]),
                    format!("{stays:.2?} s"),
                ))
            },
        },
        Claim {
            says: "the harder the ball, the more of its speed it keeps",
            source: "errata §6",
            judge: |r| {
                let away = r.column("balls", "speed away from it")?;
                let towards = r.column("balls", "speed towards the wall")?;
                let kept: Vec<f64> = away.iter().zip(towards).map(|(a, t)| a / t).collect();
                Ok(Finding::new(
                    kept.windows(2).all(|pair| pair[1] > pair[0]),
                    format!("{kept:.2?} of it"),
                ))
            },
        },
    ],
    run,
    draw: drawn,
};

fn falling_or_rising(r: &Record, column: &str, sign: f64) -> Result<Finding, SandboxError> {
    let values = r.column("balls", column)?;
    Ok(Finding::new(
        values
            .windows(2)
            .all(|pair| sign * (pair[1] - pair[0]) > 0.0),
        format!("{values:.3?}"),
    ))
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let mut notes = Vec::new();
    let mut courses = Vec::new();
    for ((scene, _, _), table) in BALLS.into_iter().zip(CURVES) {
        let (course, run) = course::follow(ID, &mut changed_scene(ID, scene, &[])?)?;
        let mut one = Record::default();
        course::sum_up(&mut one, "", &course);
        notes.push(one);
        keep_frames(&mut record, table, &run);
        courses.push(course);
    }
    let mut table = Table::new("balls");
    for number in notes[0]
        .numbers
        .iter()
        .filter(|n| !n.name.starts_with("ringing"))
    {
        let values: Result<Vec<f64>, SandboxError> =
            notes.iter().map(|one| one.number(&number.name)).collect();
        table = table.with(number.name.clone(), number.unit, number.tolerance, values?);
    }
    record.keep(table);
    let rows: Vec<usize> = (0..courses[0].t.len()).step_by(20).collect();
    let mut fine = Table::raw("fine").with(
        "t",
        "s",
        Tolerance::ROUNDING,
        rows.iter().map(|&i| courses[0].t[i]).collect(),
    );
    for ((_, name, _), course) in BALLS.into_iter().zip(&courses) {
        let pick = |values: &[f64]| rows.iter().map(|&i| values[i]).collect();
        let area: Vec<f64> = course.area.iter().map(|a| a / course.area[0]).collect();
        fine = fine
            .with(format!("deformation {name}"), "", STEPS, pick(&course.rms))
            .with(format!("area {name}"), "", STEPS, pick(&area))
            .with(
                format!("x {name}"),
                "",
                STEPS,
                rows.iter().map(|&i| course.center[i].x).collect(),
            )
            .with(
                format!("y {name}"),
                "",
                STEPS,
                rows.iter().map(|&i| course.center[i].y).collect(),
            );
    }
    record.keep(fine);
    Ok(record)
}

fn drawn(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let mut strip = Vec::new();
    for ((_, name, figure), table) in BALLS.into_iter().zip(CURVES) {
        let frames = Frames::of(record, table)?;
        let right = if name == "very hard" { 13.0 } else { 8.2 };
        let mut panel = Panel::new(
            format!("{figure}  {name}"),
            Axis::new("", -0.3, right),
            Axis::new("", -1.9, 9.4),
        )
        .equal()
        .bare()
        .with(Line::new(vec![(0.0, -1.9), (0.0, 9.4)], Color::INK).weighing(1.6));
        panel.share = right + 0.6;
        let way = record.points("fine", &format!("x {name}"), &format!("y {name}"))?;
        strip.push(
            draw::snapshots(panel, &frames, &frames.each(0.5), 0.55)
                .with(Line::new(way, Color::INK).dashed().weighing(0.6)),
        );
    }
    let time = || Axis::new("t / s", 0.0, 7.0);
    let mut shape = Panel::new(
        "deformation from its shape",
        time(),
        Axis::log("rms of e", 1e-5, 3.0),
    );
    let mut area = Panel::new("area", time(), Axis::new("of the start", 0.0, 1.25));
    for ((_, name, _), color) in BALLS.into_iter().zip(Color::SERIES) {
        let line = |what: &str| record.points("fine", "t", &format!("{what} {name}"));
        shape = shape.with(
            Line::new(line("deformation")?, color)
                .weighing(0.8)
                .named(name),
        );
        area = area.with(Line::new(line("area")?, color).weighing(0.8).named(name));
    }
    let figure = Figure::new(
        "Figures 2.2 to 2.6  Five balls against the wall x = 0",
        1000.0,
    )
    .with(265.0, strip)
    .with(270.0, vec![draw::legend_low(shape), draw::legend_low(area)]);
    Ok(vec![Artefact::figure(
        "Each ball as the report draws it, a snapshot every 0.5 s, at one scale. Below: how far each is from its shape, \
         and its area.",
        figure,
    )])
}
