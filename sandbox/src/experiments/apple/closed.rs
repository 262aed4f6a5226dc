//! A closed snake around the same apple.

use super::draw::{animation, frame_panel, over_picture, snake_on};
use super::story::{Story, Truth, share, top, truth_of};
use crate::demand::{above, below, judged};
use crate::draw::{Axis, Color, Figure, Layer, Line, Panel};
use crate::experiments::motion::{Frames, pair};
use crate::experiments::over_time::over_time;
use crate::{
    Artefact, Body, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real,
};

const ID: &str = "sec-4-3-closed";
/// Positions: a longer run with weak edges.
const PLACE: Tolerance = Tolerance::Absolute(0.02);

/// The whole outline.
pub(crate) const CLOSED: Experiment = Experiment {
    id: ID,
    title: "A closed snake around the apple",
    place: "§4.3",
    question: "The whole outline from a start drawn by hand around it, stem included: how near does a closed snake come?",
    claims: &[
        Claim {
            says: "it comes within 2 px of the contour in the mean, outside the boxes of what disturbs",
            source: "our aim",
            judge: |r| {
                let (mean, count) = (
                    r.number("mean distance at the end")?,
                    r.told("nodes outside the boxes at the end")?,
                );
                let start = r.told("mean distance at the start")?;
                Ok(Finding::new(
                    mean < 2.0,
                    format!(
                        "{mean:.2} px over {count} of 160 nodes, from {start:.1} px at the start"
                    ),
                ))
            },
        },
        Claim {
            says: "it lets go of the stem too",
            source: "report §4.3",
            judge: |r| {
                judged(
                    r,
                    &[
                        below("top at the start", 8.0),
                        above("top at the end", 50.0),
                    ],
                )
            },
        },
        Claim {
            says: "what is left is inside the boxes: the lobe at the foot and the weak right side",
            source: "errata §5",
            judge: |r| {
                let (inside, outside) = (
                    r.number("largest distance at the end inside the boxes")?,
                    r.number("largest distance at the end outside the boxes")?,
                );
                Ok(Finding::new(
                    inside > 2.0 * outside && outside < 6.0,
                    format!(
                        "at most {outside:.1} px outside the boxes, up to {inside:.1} px inside"
                    ),
                ))
            },
        },
    ],
    run,
    draw,
};

fn run() -> Result<Record, SandboxError> {
    let story = Story::of(ID, "apple-closed", &[], Truth::apple(ID)?)?;
    let mut record = Record::default();
    let nodes = story.last();
    let (mean, count) = story.truth.mean_distance(nodes);
    record.note(
        "mean distance at the start",
        story.truth.mean_distance(story.at(0.0)).0,
        "px",
        PLACE,
    );
    record.note("mean distance at the end", mean, "px", PLACE);
    record.note(
        "nodes outside the boxes at the end",
        real(count),
        "",
        Tolerance::Absolute(1.0),
    );
    record.note(
        "stuck at the end",
        share(&story.truth.stuck(nodes)),
        "of the nodes",
        Tolerance::Absolute(0.03),
    );
    record.note("top at the start", top(story.at(0.0)).y, "px", PLACE);
    record.note("top at the end", top(nodes).y, "px", PLACE);
    for (name, wanted) in [("outside", true), ("inside", false)] {
        let kept = nodes.iter().filter(|&&p| story.truth.counts(p) == wanted);
        let most = kept.fold(0.0_f64, |a, &p| a.max(story.truth.distance(p)));
        record.note(
            format!("largest distance at the end {name} the boxes"),
            most,
            "px",
            Tolerance::Absolute(0.2),
        );
    }
    record.keep(
        Table::raw("distance")
            .with(
                "node",
                "",
                Tolerance::EXACT,
                (0..nodes.len()).map(real).collect(),
            )
            .with(
                "distance",
                "px",
                PLACE,
                nodes.iter().map(|&p| story.truth.distance(p)).collect(),
            )
            .with(
                "counts",
                "",
                Tolerance::EXACT,
                nodes
                    .iter()
                    .map(|&p| f64::from(u8::from(story.truth.counts(p))))
                    .collect(),
            ),
    );
    story.keep(&mut record, Some(10), PLACE);
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let frames = Frames::of(record, "curves")?;
    let truth = truth_of(record)?;
    let contour: Vec<(f64, f64)> = truth.contour.iter().map(|&p| pair(p)).collect();
    let mut last = over_picture(record, "the end; green: the contour by hand", true)?
        .with(Line::new(contour, Color::GREEN).closed().weighing(0.6));
    last = snake_on(last, &frames, frames.len() - 1, &truth, true, 1.0);
    let mut strip = Vec::new();
    for (letter, t) in ["a", "b", "c"].into_iter().zip([0.0, 40.0, 140.0]) {
        strip.push(frame_panel(record, letter, t, true)?);
    }
    let distance = record.points("distance", "node", "distance")?;
    let counts = record.column("distance", "counts")?;
    let only = |wanted: bool| -> Vec<(f64, f64)> {
        let kept = distance
            .iter()
            .zip(counts)
            .filter(|(_, c)| (**c > 0.5) == wanted);
        kept.map(|(p, _)| *p).collect()
    };
    let along = Panel::new(
        "distance to the contour at the end",
        Axis::new("node", 0.0, 160.0),
        Axis::new("px", 0.0, 18.0),
    )
    .with(Layer::Dots {
        points: only(true),
        radius: 1.2,
        color: Color::BLUE,
        label: "outside the boxes".to_owned(),
    })
    .with(Layer::Dots {
        points: only(false),
        radius: 1.2,
        color: Color::ORANGE,
        label: "inside".to_owned(),
    });
    let mean = over_time(
        record,
        "fine",
        &[("distance", "", Color::RED)],
        "mean distance outside the boxes",
        "px",
    )?;
    let stuck = over_time(
        record,
        "fine",
        &[("stuck", "", Color::GREEN)],
        "part within 4 px of the contour",
        "of the nodes",
    )?;
    let mut row = strip;
    row.push(last);
    let figure = Figure::new("§4.3  A closed snake around the apple", 900.0)
        .with(440.0, row[..2].to_vec())
        .with(440.0, row[2..].to_vec())
        .with(230.0, vec![along, mean, stuck]);
    let shown: Vec<usize> = (0..60).chain((60..150).step_by(5)).collect();
    Ok(vec![
        Artefact::figure(
            "Yellow: the snake; blue: its part within 4 px of the contour. The right side has almost no contrast, and the \
             lobe at the foot is filled by the table's shadow.",
            figure,
        ),
        Artefact::further(
            "moving",
            "The same in motion.",
            Body::Animation(animation(record, true, &shown, 300)?),
        ),
    ])
}
